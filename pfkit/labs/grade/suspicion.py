"""Does an answer reach for the checker? Reading its text finds the plain attempts.

A reason here never costs points. It gives the status ``review``: a person looks, and decides.
"""

import ast
from collections.abc import Iterator
from types import ModuleType
from typing import Any

from pfkit.labs.grade.cells import parsed, root
from pfkit.labs.lab import Lab

# What opens the way to the checker, and what no answer of these labs needs.
MODULES = {
    "builtins", "ctypes", "gc", "importlib", "inspect", "linecache", "marshal",
    "mock", "pickle", "runpy", "trace", "unittest",
}  # fmt: skip
FUNCTIONS = {
    "__builtins__", "__import__", "__loader__", "compile", "delattr", "eval", "exec", "globals",
    "setattr", "vars",
}  # fmt: skip
SYSTEM = {"_current_frames", "_getframe", "addaudithook", "modules", "setprofile", "settrace"}
OURS = {"np", "pf", "plt", "lab", "plotting"}


def doubts(item: str, source: str, lab: Lab, module: ModuleType) -> list[str]:
    """Reasons to look at an answer cell, each a sentence; empty for nearly all.

    Parameters
    ----------
    item : str
        The item it answers, for the sentence.
    source : str
        The text of the cell. What is no Python is not looked at: it cannot run either.
    lab : Lab
    module : module
        What a student imports as ``lab``.
    """
    found = (r for node in ast.walk(parsed(source)) for r in _reasons(node, lab, module))
    return [f"{item}: {reason}" for reason in dict.fromkeys(found)]


def _reasons(node: ast.AST, lab: Lab, module: ModuleType) -> Iterator[str]:
    if isinstance(node, ast.Import | ast.ImportFrom):
        yield from _imports(node, lab)
    elif isinstance(node, ast.Attribute):
        yield from _attributes(node, lab, module)
    elif isinstance(node, ast.Name):
        if node.id in FUNCTIONS:
            yield f"uses {node.id}"
        if node.id in OURS and not isinstance(node.ctx, ast.Load):
            yield f"gives {node.id} another meaning"
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        hidden = node.value.startswith("__") and node.value not in ("__", "__main__")
        if hidden or "pfkit.labs" in node.value:
            yield f"holds the text {node.value[:40]!r}"


def _imports(node: ast.Import | ast.ImportFrom, lab: Lab) -> Iterator[str]:
    within = getattr(node, "module", None) or ""
    for alias in node.names:
        full = f"{within}.{alias.name}" if within else alias.name
        if full.startswith("pfkit.labs") and full != f"pfkit.labs.{lab.name}":
            yield f"imports {full}"
        elif full.split(".")[0] in MODULES:
            yield f"imports {full.split('.')[0]}"
        elif alias.asname in OURS and full.split(".")[0] not in ("numpy", "matplotlib", "pfkit"):
            yield f"gives {alias.asname} another meaning"


def _attributes(node: ast.Attribute, lab: Lab, module: ModuleType) -> Iterator[str]:
    base = root(node)
    if node.attr.startswith("__") and node.attr not in ("__name__", "__doc__"):
        yield f"uses {node.attr}"
    if base in OURS and not isinstance(node.ctx, ast.Load) and base != "plt":
        yield f"changes {ast.unparse(node)}"
    if base == "lab" and isinstance(node.value, ast.Name) and _private(node.attr, lab, module):
        yield f"uses lab.{node.attr}"
    if base == "pf" and node.attr == "labs":
        yield "uses pfkit.labs"
    if base == "sys" and node.attr in SYSTEM:
        yield f"uses sys.{node.attr}"


def _private(name: str, lab: Lab, module: ModuleType) -> bool:
    """The lab's inside: its items, solutions, submodules, and what would hand out a solution."""
    value: Any = getattr(module, name, None)
    if name == "use" or name.startswith("_") or value is lab or isinstance(value, ModuleType):
        return True
    return callable(value) and any(value is i.solution() for i in lab.items.values())
