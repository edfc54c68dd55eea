"""Count pfkit, room by room: program, docstring, and how much of the program checks.

    python tools/count_checks.py [--most SHARE] [--modules]

An *executable line* is a statement, as in the measuring of coverage: a call that runs over four
rows is one, a docstring is none. A statement is a *check* if it is

* an ``if`` whose body does nothing but raise, with its body, or a ``raise`` anywhere else,
* a simple statement that calls ``require_...`` or ``as_numbers``, or a function as below,
* in a function named ``require_...``, or in one that only makes or raises an error,
* in a function of `pfkit.errors`.

The classes of errors are no checks, nor are imports. ``--most 0.12`` fails when a larger share of
the core's executable lines checks.
"""

from __future__ import annotations

import argparse
import ast
import runpy
import sys
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "pfkit"
TABLE = runpy.run_path(str(PACKAGE / "rooms.py"))
CHECKS = ("require_", "as_numbers", "as_path", "whole_cells")


class Count(NamedTuple):
    """Statements, rows of docstring and checks of one module or room."""

    code: int
    docstring: int
    checks: int

    def plus(self, other: Count) -> Count:
        return Count(*(a + b for a, b in zip(self, other, strict=True)))

    @property
    def share(self) -> float:
        return self.checks / self.code if self.code else 0.0


def span(node: ast.AST) -> set[int]:
    """The lines that a node occupies, decorators included."""
    first = min([node.lineno, *(d.lineno for d in getattr(node, "decorator_list", []))])
    return set(range(first, node.end_lineno + 1))


def docstring_lines(tree: ast.AST) -> set[int]:
    """The lines of every docstring, and of strings that stand alone."""
    alone = (n for n in ast.walk(tree) if isinstance(n, ast.Expr))
    return {
        line
        for node in alone
        if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
        for line in span(node)
    }


def statements(tree: ast.Module, prose: set[int]) -> list[ast.stmt]:
    """Every statement that is no docstring."""
    return [n for n in ast.walk(tree) if isinstance(n, ast.stmt) and n.lineno not in prose]


def name_of(call: ast.AST) -> str:
    """The last part of the name of the function that is called."""
    function = call.func if isinstance(call, ast.Call) else None
    return getattr(function, "attr", getattr(function, "id", ""))


def only_raises(body: list[ast.stmt], errors: set[str]) -> bool:
    """Whether a body, docstring aside, makes or raises errors and does nothing else."""

    def does(node: ast.stmt) -> bool:
        if isinstance(node, ast.If):
            return all(map(does, [*node.body, *node.orelse]))
        made = isinstance(node, ast.Return) and name_of(node.value) in errors
        return made or (isinstance(node, ast.Raise) and name_of(node.exc) in errors)

    real = [n for n in body if not (isinstance(n, ast.Expr) and isinstance(n.value, ast.Constant))]
    return bool(real) and all(map(does, real))


def calls_check(node: ast.stmt, known: set[str]) -> bool:
    """Whether a simple statement calls a check."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.If | ast.For | ast.While | ast.With |
                  ast.Try):  # fmt: skip
        return False
    names = {name_of(inner) for inner in ast.walk(node)}
    return any(n in known or n.lstrip("_").startswith(CHECKS) for n in names if n)


def check_lines(tree: ast.Module, module: str) -> set[int]:
    """The lines that check, by the rule above."""
    errors = {"PfkitError", "ValueError"}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "pfkit.errors":
            errors |= {a.name for a in node.names if a.name.endswith("Error")}
    functions = [n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)]
    known = {
        f.name
        for f in functions
        if f.name.lstrip("_").startswith(CHECKS) or only_raises(f.body, errors)
    }
    found: set[int] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            whole = module == "errors" or node.name in known
        elif isinstance(node, ast.If):
            whole = only_raises(node.body, errors)
            if whole and node.orelse:
                found |= set(range(node.lineno, node.body[-1].end_lineno + 1))
                whole = False
        elif isinstance(node, ast.Import | ast.ImportFrom):
            continue
        elif isinstance(node, ast.stmt):
            whole = isinstance(node, ast.Raise) or calls_check(node, known)
        else:
            continue
        if whole:
            found |= span(node)
    return found


def count(path: Path) -> Count:
    """Count one file."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    prose, checks = docstring_lines(tree), check_lines(tree, path.stem)
    found = statements(tree, prose)
    return Count(len(found), len(prose), sum(node.lineno in checks for node in found))


def files(module: str) -> list[Path]:
    """The files of one line of the table: a module, or a folder."""
    path = PACKAGE.joinpath(*module.split("."))
    return sorted(path.rglob("*.py")) if path.is_dir() else [path.with_suffix(".py")]


def rows(modules: list[str]) -> dict[str, Count]:
    """Module -> count."""
    found = {}
    for module in modules:
        total = Count(0, 0, 0)
        for path in files(module):
            total = total.plus(count(path))
        found[module] = total
    return found


def main() -> int:
    """Print the table; fail if the core checks more than it may."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--most", type=float, help="fail above this share of the core's lines")
    parser.add_argument("--modules", action="store_true", help="one row for each module, too")
    options = parser.parse_args()
    print(f"{'room':28} {'code':>6} {'docstring':>9} {'checks':>6} {'share':>6}")
    core = Count(0, 0, 0)

    def show(name: str, row: Count) -> None:
        print(f"{name:28} {row.code:6} {row.docstring:9} {row.checks:6} {row.share:6.1%}")

    for room, modules in TABLE["CORE"].items():
        each, total = rows(list(modules)), Count(0, 0, 0)
        for module, row in each.items():
            total = total.plus(row)
            if options.modules:
                show(f"  {module}", row)
        show(room, total)
        core = core.plus(total)
    show("core", core)
    for part, row in rows([p for p in TABLE["EDGE"] if "." not in p]).items():
        show(part, row)
    return int(options.most is not None and core.share > options.most)


if __name__ == "__main__":
    sys.exit(main())
