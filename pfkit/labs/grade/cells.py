"""What the source of a cell says: the names it reads and binds, the calls of the lab's verbs.

A cell that is no Python reads and binds nothing.
"""

import ast
from collections.abc import Iterator
from typing import Any

from pfkit.labs.names import UNREADABLE, bound_and_used

VERBS = {"check", "predict", "answer"}
MODULES = {"np", "pf", "plt", "lab", "plotting"}  # a call of theirs changes no name of the cell


def parsed(source: str) -> ast.Module:
    try:
        return ast.parse(source)
    except UNREADABLE:
        return ast.Module([], [])


def code_cells(book: dict[str, Any]) -> list[tuple[str, str]]:
    """Return (item id or "", source) of each code cell."""
    return [
        (c.get("metadata", {}).get("answer", ""), "".join(c["source"]))
        for c in book["cells"]
        if c["cell_type"] == "code"
    ]


def labs_imported(source: str) -> dict[str, str]:
    """``{"lab3": "lab"}`` of a cell that holds ``from pfkit.labs import lab3 as lab``."""
    nodes = ast.walk(parsed(source))
    return {
        alias.name: alias.asname or alias.name
        for node in nodes
        if isinstance(node, ast.ImportFrom) and node.module == "pfkit.labs"
        for alias in node.names
    }


def lab_calls(source: str, lab: str = "lab") -> list[tuple[str, str, str]]:
    """Return (verb, item, answer expression) of each call such as ``lab.check("q1", q1)``."""
    return [
        (node.func.attr, str(node.args[0].value), ast.unparse(node.args[1]))
        for node in ast.walk(parsed(source))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and isinstance(node.func.value, ast.Name)
        and node.func.value.id == lab
        and len(node.args) == 2
        and isinstance(node.args[0], ast.Constant)
    ]


def said(source: str, verb: str, lab: str = "lab") -> list[tuple[Any, ...]]:
    """Return the arguments of each call of a verb in which all are literals, in order.

    ``lab.student("jo", term="spring")`` says ``("jo", "spring")``, ``lab.tick("p3c", 1, 2)`` says
    ``("p3c", 1, 2)``.
    """
    found = []
    for node in ast.walk(parsed(source)):
        if isinstance(node, ast.Call) and ast.unparse(node.func) == f"{lab}.{verb}":
            values = [*node.args, *(k.value for k in node.keywords)]
            if all(isinstance(v, ast.Constant) for v in values):
                found.append(tuple(v.value for v in values if isinstance(v, ast.Constant)))
    return found


def names_changed(source: str) -> set[str]:
    """Names a cell binds, or changes: ``x.y = 1``, ``x[0] = 1`` and ``x.sort()`` change x."""
    found = bound_and_used(source)[0]
    for node in parsed(source).body:
        for part in ast.walk(node):
            if isinstance(part, ast.Attribute | ast.Subscript) and isinstance(part.ctx, ast.Store):
                found.add(root(part))
        call = node.value if isinstance(node, ast.Expr) else None
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute):
            found |= {root(call.func)} - MODULES
    return found - {""}


def root(node: ast.expr) -> str:
    """``x`` of ``x.y[0].z``, or "" if it does not start with a name."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def surely_bound(source: str) -> set[str]:
    """Names that are new after this cell, so that earlier bindings no longer matter."""
    return set[str]().union(*map(_new_after, parsed(source).body))


def _new_after(node: ast.stmt) -> set[str]:
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return {node.name}
    return _stored(*node.targets) if isinstance(node, ast.Assign) else set()


def _stored(*targets: ast.expr) -> set[str]:
    names = (part for t in targets for part in ast.walk(t) if isinstance(part, ast.Name))
    return {name.id for name in names if isinstance(name.ctx, ast.Store)}


def names_needed(source: str) -> set[str]:
    """Names that a cell reads before it surely binds them."""
    return set(_needed(parsed(source).body, set()))


def _needed(body: list[ast.stmt], bound: set[str]) -> Iterator[str]:
    for node in body:
        if isinstance(node, ast.For):
            yield from bound_and_used(ast.unparse(node.iter))[1] - bound
            yield from _needed(node.body + node.orelse, bound | _stored(node.target))
        else:
            yield from bound_and_used(ast.unparse(node))[1] - bound
        bound = bound | _new_after(node)
