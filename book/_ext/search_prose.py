"""Sphinx extension: search ranks prose over code.

Sphinx indexes every word of a page alike. Here `_static/code_words.js` lists the words that a page
has in its code or its outputs only; the search page loads it, and scorer.js counts such a find for
less, and a find in the API pages for less than one in a chapter.
"""

from __future__ import annotations

import json
from collections import defaultdict
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx

SCRIPT = "code_words.js"


def words(node: nodes.Node, lang: Any) -> set[str]:
    """The stems of a text, as Sphinx indexes them."""
    stems = (lang.stem(word.lower()) for word in lang.split(node.astext()))
    return {stem for stem in stems if lang.word_filter(stem)}


def code_words(doctree: nodes.document, lang: Any) -> set[str]:
    """The words that stand in code or output, and nowhere in the prose."""
    code: set[str] = set()
    prose: set[str] = set()
    for node in doctree.findall(nodes.Text):
        parent: Any = node.parent
        while parent is not None and not isinstance(parent, nodes.literal_block):
            parent = parent.parent
        (prose if parent is None else code).update(words(node, lang))
    return code - prose


def write(app: Sphinx, error: Exception | None) -> None:
    """Write the list for the search page."""
    indexer = getattr(app.builder, "indexer", None)
    if error is not None or app.builder.name != "html" or indexer is None:
        return
    found = defaultdict(list)
    for name in sorted(app.env.found_docs):
        for word in sorted(code_words(app.env.get_doctree(name), indexer.lang)):
            found[word].append(name)
    text = json.dumps(found, ensure_ascii=False, separators=(",", ":"))
    target = Path(app.outdir) / "_static" / SCRIPT
    target.write_text(f"window.pfCodeWords = {text};\n", encoding="utf-8", newline="\n")


def load(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Load it on the search page, and there alone."""
    if page == "search":
        app.add_js_file(SCRIPT)


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the list; `html_search_scorer: book/theme/scorer.js` makes use of it."""
    app.connect("html-page-context", load)
    app.connect("build-finished", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
