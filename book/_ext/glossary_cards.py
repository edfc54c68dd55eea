"""Sphinx extension: what a term means, on a card beside each link to the glossary.

The definitions are read from the finished glossary and written to `_static/glossary.js`, which
book/theme/cards.js loads when a reader first rests on such a link; a script, because a page that
was opened from a folder may not fetch anything else.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

from sphinx.application import Sphinx
from sphinx.util import logging

logger = logging.getLogger(__name__)
GLOSSARY = "book/glossary.html"
ENTRY = re.compile(r"((?:<dt[^>]*>.*?</dt>\s*)+)<dd>(.*?)</dd>", re.S)
NAME = re.compile(r'<dt id="(term-[^"]+)">(.*?)</dt>', re.S)
LINK = re.compile(r"</?a\b[^>]*>")
PERMALINK = re.compile(r'<a class="headerlink".*?</a>', re.S)


def cards(html: str) -> dict[str, str]:
    """The card of each term, by the id of its entry; what was a link on it is plain text."""
    found = {}
    for names, meaning in ENTRY.findall(html):
        for ident, name in NAME.findall(names):
            title = LINK.sub("", PERMALINK.sub("", name)).strip()
            found[ident] = f"<p><strong>{title}</strong></p>{LINK.sub('', meaning).strip()}"
    return found


def write(app: Sphinx, error: Exception | None) -> None:
    """Write all cards into one script."""
    page = Path(app.outdir) / GLOSSARY
    if error is not None or app.builder.name != "html" or not page.exists():
        return
    found = cards(page.read_text(encoding="utf-8"))
    if not found:
        logger.warning("glossary_cards: no entry found in %s", GLOSSARY)
    text = json.dumps(found, ensure_ascii=False, sort_keys=True)
    target = page.parents[1] / "_static" / "glossary.js"
    target.write_text(f"window.pfGlossary = {text};\n", encoding="utf-8", newline="\n")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the script of the page and the step after the build."""
    app.add_js_file("cards.js", defer="defer")
    app.connect("build-finished", write)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
