"""Sphinx extension: code that only sets up or draws folds away under a line that says so.

A cell is folded when more than half of its lines import, or when more than half draw: a line draws
if its statement speaks of a figure, of axes or of `plotting`. Answer cells and what checks them
stay open, and so does a cell with the tag `show-input`. A cell that a notebook folds itself
(`hide-input`) gets such a line as well; `hide-cell` stays as it is.
"""

from __future__ import annotations

import ast
import re

from docutils import nodes
from sphinx.application import Sphinx

DRAWS = re.compile(r"fig|figure|ax|axes|plt|plotting|panels")
STAYS = {"show-input"}
PROMPTS = {"imports": ("Show what is imported", "Hide what is imported"),
           "drawing": ("Show the code that draws", "Hide the code that draws"),
           "": ("Show the code", "Hide the code")}  # fmt: skip


def imports(statement: ast.stmt) -> bool:
    """Whether a statement imports, or sets the look of figures."""
    call = statement.value if isinstance(statement, ast.Expr) else None
    style = isinstance(call, ast.Call) and ast.unparse(call.func) == "plotting.use_style"
    return style or isinstance(statement, ast.Import | ast.ImportFrom)


def draws(statement: ast.stmt) -> bool:
    """Whether a statement speaks of figures; an import does not."""
    names = [node.id for node in ast.walk(statement) if isinstance(node, ast.Name)]
    names += [node.arg for node in ast.walk(statement) if isinstance(node, ast.arg)]
    return any(DRAWS.fullmatch(name) for name in names)


def lines(statements: list[ast.stmt]) -> int:
    """How many lines they take."""
    return sum((s.end_lineno or s.lineno) - s.lineno + 1 for s in statements)


def kind(source: str) -> str:
    """Say what a cell is that folds: "imports" or "drawing"; "" for all others."""
    try:
        body = ast.parse(source).body
    except SyntaxError:
        return ""  # a cell for Jupyter alone, or one that is broken on purpose
    for name, of_kind in (("imports", imports), ("drawing", draws)):
        if 2 * lines([s for s in body if of_kind(s)]) > lines(body):
            return name
    return ""


def fold(app: Sphinx, doctree: nodes.document) -> None:
    """Mark the cells of a notebook that fold."""
    for cell in doctree.findall(nodes.container):
        if cell.get("nb_element") != "cell_code" or not cell.children:
            continue
        by_tag = cell.get("hide_mode", "")
        about = cell.get("cell_metadata", {})
        if STAYS & set(about.get("tags", [])) or {"answer", "check"} & set(about):
            continue
        source = cell.children[0]
        if source.get("nb_element") != "cell_code_source" or by_tag not in ("", "input"):
            continue
        found = kind(source.astext())
        if found or by_tag:
            cell["hide_mode"] = "input"
            cell["prompt_show"], cell["prompt_hide"] = PROMPTS[found]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the step."""
    app.connect("doctree-read", fold)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
