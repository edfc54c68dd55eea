"""What the source of a cell says: the names it reads and binds, the calls of the lab's verbs.

A cell that is no Python reads and binds nothing.
"""

import ast
from types import CodeType
from typing import Any


def parsed(source: str) -> ast.Module:
    try:
        return ast.parse(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], [])


def code_cells(book: dict[str, Any]) -> list[tuple[str, str]]:
    """Return (item id or "", source) of each code cell."""
    return [
        (c.get("metadata", {}).get("answer", ""), "".join(c["source"]))
        for c in book["cells"]
        if c["cell_type"] == "code"
    ]


def labs_imported(source: str) -> set[str]:
    """Modules of questions that a cell imports: ``from pfkit.labs import lab3 as lab``."""
    nodes = ast.walk(parsed(source))
    return {
        alias.name
        for node in nodes
        if isinstance(node, ast.ImportFrom) and node.module == "pfkit.labs"
        for alias in node.names
    }


def lab_calls(source: str) -> list[tuple[str, str, str]]:
    """Return (verb, item, answer expression) of each call such as ``lab.check("q1", q1)``."""
    return [
        (node.func.attr, str(node.args[0].value), ast.unparse(node.args[1]))
        for node in ast.walk(parsed(source))
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Attribute)
        and isinstance(node.func.value, ast.Name)
        and node.func.value.id == "lab"
        and len(node.args) == 2
        and isinstance(node.args[0], ast.Constant)
    ]


def bound_at_top(source: str) -> set[str]:
    """Names that the statements of a cell bind, functions not looked into."""
    names = set[str]()
    for node in parsed(source).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            stored = (n for n in ast.walk(node) if isinstance(n, ast.Name))
            names |= {n.id for n in stored if isinstance(n.ctx, ast.Store)}
        elif isinstance(node, ast.Import | ast.ImportFrom):
            names |= {(a.asname or a.name).split(".")[0] for a in node.names}
    return names


def names_read(source: str) -> set[str]:
    """Names a cell may look up outside itself: module level, and globals of its functions."""
    try:
        todo: list[CodeType] = [compile(source, "<cell>", "exec", dont_inherit=True)]
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    found = set[str]()
    while todo:
        code = todo.pop()
        found |= set(code.co_names)
        todo += [c for c in code.co_consts if isinstance(c, CodeType)]
    return found


def names_bound(source: str) -> set[str]:
    """Names a cell binds at module level, or changes: ``x.y = 1`` and ``x.sort()`` change x."""
    tree, found, modules = parsed(source), set[str](), set[str]()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store | ast.Del):
            found.add(node.id)
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
        elif isinstance(node, ast.Import | ast.ImportFrom):
            modules |= {(a.asname or a.name).split(".")[0] for a in node.names}
        elif isinstance(node, ast.Attribute | ast.Subscript) and isinstance(node.ctx, ast.Store):
            found.add(root(node))
        elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
            if isinstance(node.value.func, ast.Attribute):
                found.add(root(node.value.func))
    return found - {"np", "pf", "plt", "lab", "plotting"} | modules - {""}


def root(node: ast.expr) -> str:
    """``x`` of ``x.y[0].z``, or "" if it does not start with a name."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def surely_bound(source: str) -> set[str]:
    """Names that are new after this cell, so that earlier bindings no longer matter."""
    tree = parsed(source)
    names = set[str]()
    for node in tree.body:
        if isinstance(node, ast.Assign):
            names |= {t.id for t in node.targets if isinstance(t, ast.Name)}
    return names
