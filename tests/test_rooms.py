"""The table of rooms holds: every import is read, and what is written from the table is current.

A module of the core imports only what stands before it in `pfkit/rooms.py`, so there are no cycles
and a reader can take the package in this order. Imports for type checking count: a cycle that only
an editor sees is a cycle for a reader, too.
"""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from collections.abc import Container, Iterator
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest
import rooms

import pfkit as pf
from pfkit.rooms import CORE, EDGE, HOME, MODULES, OPTIONAL

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "pfkit"
TABLE = [module for modules in CORE.values() for module in modules]
ORDER = {name: i for i, name in enumerate([*TABLE, *EDGE])}
FOLDERS = {module.partition(".")[0] for module in TABLE if "." in module}
CONTENTS = {"", "rooms", *FOLDERS}  # the lazy package, its table, the rooms' first pages


def dotted(path: Path) -> str:
    """The name of a module below pfkit; a folder's own file has the folder's name."""
    parts = path.relative_to(PACKAGE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def longest(name: str, known: Container[str]) -> str:
    """The longest beginning of a dotted name that is known, or the name itself."""
    parts = name.split(".")
    beginnings = [".".join(parts[:n]) for n in range(len(parts), 0, -1)]
    return next((b for b in beginnings if b in known), name)


def entry(name: str) -> str:
    """The line of the table that a module belongs to."""
    return longest(name, ORDER)


def imports(source: str) -> Iterator[tuple[str, bool]]:
    """Yield each imported module of some source, and whether the import is at the top level."""
    tree = ast.parse(source)
    top = {id(node) for node in tree.body}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for name in node.names:
                yield name.name, id(node) in top
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                raise ValueError(f"line {node.lineno}: import by full name: from pfkit.x import")
            full = node.module or ""
            inside = full.startswith("pfkit") and ROOT.joinpath(*full.split(".")).is_dir()
            for name in node.names:
                yield f"{full}.{name.name}" if inside else full, id(node) in top


def violations(name: str, source: str) -> list[str]:
    """List the imports of one module that the table forbids, each with the remedy."""
    own = entry(name)
    if own not in ORDER:
        return [f"pfkit.{name} is not in the table: give it a line in pfkit/rooms.py"]
    allowed = {"numpy", "pfkit", *EDGE.get(own, ())} | sys.stdlib_module_names
    found = []
    for full, at_top in imports(source):
        first, _, used = full.partition(".")
        optional = not at_top and first in OPTIONAL.get(own, ())
        if first not in allowed and not optional:
            found.append(f"pfkit.{name} imports {first}: only NumPy and {EDGE.get(own, ())}")
        if first != "pfkit" or (own in EDGE and (not used or used in HOME or used in MODULES)):
            continue  # the edge may use the package as a reader does: import pfkit as pf
        target = entry(used)
        if target == own or (target.partition(".")[0] == own.partition(".")[0] and own in EDGE):
            continue
        if target not in ORDER or ORDER[target] > ORDER[own]:
            found.append(f"pfkit.{name} imports pfkit.{used}, which does not stand before it")
    return found


FILES = {dotted(p): p for p in sorted(PACKAGE.rglob("*.py"))}
MODULE_FILES = {name: path for name, path in FILES.items() if name not in CONTENTS}


@pytest.mark.parametrize("name", MODULE_FILES)
def test_module_imports_only_what_stands_before_it(name):
    assert violations(name, MODULE_FILES[name].read_text(encoding="utf-8")) == []


def test_the_table_names_no_module_that_is_gone():
    assert set(ORDER) <= set(MODULE_FILES)


def test_a_room_itself_imports_nothing():
    """Otherwise one module of a room would drag in all the others."""
    for name in CONTENTS:
        found = {full for full, at_top in imports(FILES[name].read_text("utf-8")) if at_top}
        assert {f for f in found if f.startswith("pfkit")} <= {"pfkit.rooms"}


def graph(sources: dict[str, str]) -> dict[str, set[str]]:
    """Module -> the modules of the same package that it imports."""
    edges = {}
    for name, source in sources.items():
        used = {full.removeprefix("pfkit.") for full, _ in imports(source)}
        edges[name] = {longest(u, sources) for u in used} & set(sources) - {name}
    return edges


def cycle(sources: dict[str, str]) -> list[str]:
    """The modules of one circle of imports, or an empty list."""
    try:
        TopologicalSorter(graph(sources)).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_no_circle_of_imports_in_the_whole_package():
    assert cycle({name: path.read_text("utf-8") for name, path in MODULE_FILES.items()}) == []


def test_a_circle_is_seen_even_when_only_a_type_checker_walks_it():
    lab = "from pfkit.labs import controls"
    controls = "if TYPE_CHECKING:\n    from pfkit.labs.lab import Lab"
    assert set(cycle({"labs.lab": lab, "labs.controls": controls})) == {"labs.lab", "labs.controls"}
    assert cycle({"labs.lab": lab, "labs.controls": "import math"}) == []


@pytest.mark.parametrize(
    ("name", "source", "expected"),
    [
        ("geometry", "from pfkit.particles.particle_set import Particles", "stand before it"),
        ("models.motion", "from pfkit.filters.history import run", "stand before it"),
        ("filters.history", "from pfkit.filters.kld import kld_step", "stand before it"),
        ("filters.history", "from pfkit.filters import kld", "stand before it"),
        ("filters.kld", "import scipy.stats", "imports scipy"),
        ("filters.kld", "import matplotlib.pyplot as plt", "imports matplotlib"),
        ("filters.kld", "def f():\n    import pandas", "imports pandas"),
        ("filters.kld", "from pfkit.plotting import cloud", "stand before it"),
        ("filters.kld", "import pfkit as pf", "stand before it"),
        ("filters.kld", "from pfkit import worlds", "stand before it"),
        ("filters.brand_new", "import numpy", "not in the table"),
        ("labs.ch01", "import ipywidgets", "imports ipywidgets"),
        ("explore.scene", "from pfkit.labs import Lab", "stand before it"),
    ],
)
def test_a_violation_is_seen(name, source, expected):
    (message,) = violations(name, source)
    assert expected in message


def test_what_the_table_allows_passes():
    source = "import math\nimport numpy as np\nfrom pfkit.models.motion import x"
    assert violations("filters.history", source) == []
    assert violations("labs.lab", "import pfkit as pf\ndef f():\n    import ipywidgets") == []
    assert violations("labs.grade.batch", "import nbformat\nfrom pfkit.labs import controls") == []


def test_a_relative_import_is_refused():
    with pytest.raises(ValueError, match="full name"):
        list(imports("from . import errors"))


def test_what_is_written_from_the_table_is_current():
    assert rooms.stale() == [], "run python tools/rooms.py"


def test_a_page_that_does_not_follow_is_noticed(monkeypatch):
    path = ROOT / "book" / "api_filters.md"
    monkeypatch.setattr(rooms, "title", lambda room: "Elsewhere")
    assert path in rooms.stale()


def test_the_contents_of_the_book_list_one_page_for_each_room_in_order():
    text = (ROOT / "_toc.yml").read_text(encoding="utf-8")
    listed = [line.split("api_")[1] for line in text.splitlines() if "book/api_" in line]
    assert listed == list(CORE)


@pytest.mark.parametrize("name", pf.__all__)
def test_a_public_name_stands_where_the_table_says(name):
    """It is defined there and nowhere else, so the table never decides what a name means."""
    value = getattr(pf, name)
    if name in MODULES:
        assert value is importlib.import_module(MODULES[name])
    else:
        assert getattr(value, "__module__", HOME[name]) == HOME[name]
        assert value is vars(pf)[name], "kept once it is loaded"


def test_no_name_is_listed_twice():
    names = [n for modules in CORE.values() for names in modules.values() for n in names.split()]
    assert len(names) == len(set(names))


def test_the_package_lists_every_public_name_before_it_loads_one():
    code = (
        "import sys, pfkit\n"
        "loaded = [m for m in sys.modules if m.startswith('pfkit')]\n"
        "assert sorted(loaded) == ['pfkit', 'pfkit.rooms'], loaded\n"
        "assert set(pfkit.__all__) <= set(dir(pfkit))\n"
        "from pfkit import *\n"
        "assert step is pfkit.step and worlds.arena().bounds == (0.0, 10.0, 0.0, 8.0)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)


def test_a_name_that_does_not_exist_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'kld_stop'"):
        _ = pf.kld_stop
    with pytest.raises(AttributeError, match="no attribute 'areena'"):
        _ = pf.worlds.areena
