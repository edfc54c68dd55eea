"""Sphinx extension: what the theme leaves to be mended in every page of this book.

* One `h1` a page: the theme repeats the title for print as a second one.
* Names of buttons that begin with what is seen on them, so that voice control finds them.
* Tables scroll by themselves on a narrow screen instead of pushing the page wide.
* Search from a folder on disk lists results without summaries: a browser does not let a page read
  its neighbours there.
* Text does not wait for scripts: icons need none, search is loaded by its own page, the rest comes
  after the text. Without JavaScript a line says what is missing.
* The front page sits in book/, so the top of the site forwards to it.

It works on the finished HTML, because the theme offers no setting for these; each mend is a pattern
that must still be found (`Mend.expected`), so that a new theme version cannot silently undo it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

from sphinx.application import Sphinx
from sphinx.config import Config
from sphinx.util import logging

logger = logging.getLogger(__name__)

NO_SUMMARY_ON_DISK = (
    'if (location.protocol === "file:") DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;'
)
NO_SCRIPT = (
    '<noscript><p class="no-script">This page is whole without JavaScript: text, formulas, code '
    "and pictures. Not here without it: search, explorables that move, and answers that are "
    "checked.</p></noscript>"
)
FORWARD = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="refresh" content="0; url={target}">
<title>{title}</title>
</head>
<body><main><h1>{title}</h1><p><a href="{target}">Open the book</a></p></main></body>
</html>
"""
# Scripts that wait for the document anyway, or for a key.
LATER = (
    "(?:doctools|sphinx_highlight|clipboard|copybutton|togglebutton|design-tabs"
    "|scripts/sphinx-book-theme|searchtools|language_data|searchindex)"
)
# What every page but the search page loads of it; there the links stand between.
SEARCHING = (
    r'(?:\s*<script src="[^"]*(?:searchtools|language_data|searchindex)\.js"></script>){3}'
    r"(?=\s*</head>)"
)


class Mend(NamedTuple):
    """A pattern in the finished page, what replaces it, and whether every page must have it."""

    pattern: re.Pattern[str]
    replacement: str
    expected: bool = True


MENDS = (
    Mend(
        re.compile(r'(<div id="jb-print-docs-body" class="onlyprint">\s*)<h1>(.*?)</h1>', re.S),
        r'\1<p class="print-title">\2</p>',
        expected=False,
    ),
    Mend(
        re.compile(r'(<button class="btn search-button-field[^>]*?) aria-label="[^"]*"'),
        r"\1",
    ),
    Mend(
        re.compile(r'(<i class="theme-switch [^>]*?)\s+title="[^"]*"'),
        r'\1 aria-hidden="true"',
    ),
    Mend(re.compile(r'(<summary) aria-label="Toggle hidden content"'), r"\1", expected=False),
    Mend(re.compile(r'<div role="list" (class="citation-list")'), r"<div \1", expected=False),
    # The list of modules puts lists into lists without an item around them; it reads well flat.
    Mend(re.compile(r"(?<=</li>)\s*<ul>(?=\s*<li>)"), "", expected=False),
    Mend(re.compile(r"</ul>\s*(?=<li>)"), "", expected=False),
    Mend(re.compile(r"(</ul>)(?:\s*</ul>)+"), r"\1", expected=False),
    Mend(
        re.compile(r'<summary>(?=<span class="toctree-toggle")'),
        '<summary aria-label="Pages of this section">',
        expected=False,
    ),
    Mend(re.compile(r'="Color mode"'), '="Colour mode"'),
    Mend(re.compile(r'(<article class="bd-article"[^>]*>)'), rf"\1\n{NO_SCRIPT}", expected=False),
    # What makes text wait: a script that draws icons (icons.py shows them by style), scripts that
    # can run after the text, a search index that only the search page reads.
    Mend(re.compile(r'<script defer src="[^"]*/fontawesome\.js[^>]*></script>\n?'), ""),
    Mend(re.compile(r'<link rel="preload" as="script"[^>]*>\n?'), ""),
    Mend(re.compile(SEARCHING), "", expected=False),
    Mend(re.compile(rf'<script (?=[^>]*src="(?:[^"]*/)?{LATER}\.)'), "<script defer "),
    Mend(
        re.compile(r'(<table class="[^"]*\bdocutils\b.*?</table>)', re.S),
        r'<div class="wide-table" tabindex="0" role="region" aria-label="Table">\1</div>',
        expected=False,
    ),
)


def mend(html: str) -> tuple[str, list[str]]:
    """Apply every mend to a page; return it and the expected patterns that were not there."""
    missing = []
    for pattern, replacement, expected in MENDS:
        html, count = pattern.subn(replacement, html)
        if expected and not count:
            missing.append(pattern.pattern)
    return html, missing


def mend_pages(app: Sphinx, error: Exception | None) -> None:
    """Mend all pages of a finished HTML build and write the forwarding page at the top."""
    if error is not None or app.builder.name != "html":
        return
    top = Path(app.outdir)
    for path in sorted(top.rglob("*.html")):
        name = path.relative_to(top).as_posix()
        if name.startswith("_static/") or (name == "index.html" and "/" in app.config.root_doc):
            continue
        html, missing = mend(path.read_text(encoding="utf-8"))
        path.write_text(html, encoding="utf-8", newline="\n")
        for pattern in missing:
            logger.warning("%s: the theme no longer has %s; see course_page.py", name, pattern)
    root = app.config.root_doc
    if "/" in root:
        forward = FORWARD.format(target=f"{root}.html", title=app.config.html_title)
        (top / "index.html").write_text(forward, encoding="utf-8", newline="\n")


def unnumbered(app: Sphinx, config: Config) -> None:
    """Figures bear no number, since nothing refers to one; sphinx_proof would have them do."""
    config.numfig = False


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the mends."""
    app.connect("config-inited", unnumbered, priority=900)
    app.add_js_file(None, body=NO_SUMMARY_ON_DISK)
    app.add_js_file("scroll.js", defer="defer")
    app.connect("build-finished", mend_pages, priority=900)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
