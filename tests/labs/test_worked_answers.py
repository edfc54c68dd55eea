"""A worked answer can be run where the reader stands: it names nothing that the notebook lacks."""

from __future__ import annotations

import ast
import builtins
import json
import re
import symtable
from importlib import import_module
from pathlib import Path

import pytest

from pfkit.labs import catalogue

ROOT = Path(__file__).resolve().parents[2]
MAGIC = re.compile(r"^[%!].*", re.M)


def program(path: Path) -> str:
    """The code cells of a notebook, one after the other."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    return MAGIC.sub("", "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code"))


def bound(source: str) -> set[str]:
    """Every name that some source binds, wherever."""
    names = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            names |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
    return names


def needed(source: str) -> set[str]:
    """The names that some source takes from outside."""
    top = symtable.symtable(source, "answer", "exec")
    wanted = {s.get_name() for s in top.get_symbols() if s.is_referenced()}
    todo = list(top.get_children())
    while todo:
        table = todo.pop()
        todo += table.get_children()
        wanted |= {s.get_name() for s in table.get_symbols() if s.is_global()}
    own = {s.get_name() for s in top.get_symbols() if s.is_assigned()}
    return wanted - own - set(dir(builtins))


PROGRAMS = [program(path) for path in sorted((ROOT / "notebooks").rglob("*_*.ipynb"))]
CASES = [
    (lab, item)
    for lab in catalogue.names()
    for item in import_module(f"pfkit.labs.{lab}").LAB.items.values()
    if hasattr(item, "reference")
]


@pytest.mark.parametrize(("lab", "item"), CASES, ids=lambda x: getattr(x, "id", x))
def test_a_worked_answer_names_only_what_its_notebook_has(lab, item):
    (notebook,) = [p for p in PROGRAMS if f"from pfkit.labs import {lab} as lab" in p]
    assert needed(item.worked()) - bound(notebook) == set()


def test_a_name_from_elsewhere_is_seen():
    assert needed("def f(x):\n    y = x + OFFSET\n    return np.sum([g(z) for z in y])") == {
        "OFFSET",
        "np",
        "g",
    }
