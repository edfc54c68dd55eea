"""Sphinx extension: the links to the previous and the next page say how long it takes to read.

Counted are the words of the prose, the lines of code that are not folded, figures and displayed
formulas. Exercises take longer; chapters say how long at their beginning.
"""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

WORDS, LINES = 200, 30  # a minute
PAUSE = 0.2  # minutes before a figure or a formula


def minutes(doctree: nodes.Node) -> int:
    """Minutes to read a page once, at least one."""
    words = lines = pauses = 0
    stack = [doctree]
    while stack:
        node = stack.pop()
        if isinstance(node, nodes.Element) and node.get("hide_mode") in ("input", "all"):
            stack += [c for c in node.children[1:] if node["hide_mode"] == "input"]
        elif isinstance(node, nodes.literal_block):
            lines += node.astext().count("\n") + 1
        elif isinstance(node, nodes.Text):
            words += len(node.split())
        elif isinstance(node, nodes.image | nodes.math_block):
            pauses += 1
        elif not isinstance(node, nodes.comment | nodes.raw):
            stack += node.children
    return max(1, round(words / WORDS + lines / LINES + PAUSE * pauses))


def count(app: Sphinx, doctree: nodes.document) -> None:
    """Keep the minutes of a page."""
    _all(app.env)[app.env.docname] = minutes(doctree)


def _all(env: Any) -> dict[str, int]:
    if not hasattr(env, "reading_minutes"):
        env.reading_minutes = {}
    return env.reading_minutes


def tell(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Write them beside the titles of the neighbours."""
    neighbours = getattr(app.builder, "relations", {}).get(page)
    for side, name in zip(("prev", "next"), (neighbours or (None, None, None))[1:], strict=True):
        if context.get(side) and (known := _all(app.env).get(name)):
            told = f'<span class="minutes">{known} min to read</span>'
            context[f"{side}_title"] = context[side]["title"] + told


def forget(app: Sphinx, env: BuildEnvironment, docname: str) -> None:
    _all(env).pop(docname, None)


def merge(app: Sphinx, env: BuildEnvironment, docnames: set[str], other: Any) -> None:
    _all(env).update({k: v for k, v in _all(other).items() if k in docnames})


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the steps; cells have been folded when a page is counted."""
    app.connect("doctree-read", count, priority=600)
    app.connect("html-page-context", tell)
    app.connect("env-purge-doc", forget)
    app.connect("env-merge-info", merge)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
