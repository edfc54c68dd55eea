"""Sphinx extension: the theme's dozen icons without the two thousand that it carries.

The theme brings all of Font Awesome: as a script of 540 kB that draws the icons, and as fonts of
300 kB with 1,881 rules that show the same. Here the rules of icons that no page names are dropped
and the fonts cut to what remains; course_page.py leaves the script out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from fonts import cut
from sphinx.application import Sphinx
from sphinx.util import logging

logger = logging.getLogger(__name__)
STYLE = Path("_static/styles/pydata-sphinx-theme.css")
FONTS = Path("_static/vendor/fontawesome/webfonts")
NAMED = re.compile(r"\bfa-[a-z0-9-]+")
RULE = re.compile(r'((?:\.fa-[a-z0-9-]+:before,?)+)\{content:"([^"]*)"\}')
CODE = re.compile(r"\\([0-9a-f]{4})\b")
PRIVATE = re.compile("[\ue000-\uf8ff]")  # where such fonts keep their signs
FACE = re.compile(
    r'src:url\((\S+?)\.woff2\) format\("woff2"\),url\(\S+?\.ttf\) format\("truetype"\)'
)


def shorten(css: str, named: set[str]) -> tuple[str, set[str]]:
    """Drop the rules of icons that are not named; return the style and its signs."""

    def keep(rule: re.Match[str]) -> str:
        return rule[0] if named & set(NAMED.findall(rule[1])) else ""

    css = FACE.sub(r'src:url(\1.woff) format("woff")', RULE.sub(keep, css))
    return css, {chr(int(code, 16)) for code in CODE.findall(css)} | set(PRIVATE.findall(css))


def texts(top: Path) -> Iterator[str]:
    """Pages and scripts: whatever may name an icon."""
    for path in (*top.rglob("*.html"), *(top / "_static" / "scripts").glob("*.js")):
        if path.stem != "fontawesome":
            yield path.read_text(encoding="utf-8")


def shorten_icons(app: Sphinx, error: Exception | None) -> None:
    """Write style and fonts anew, and remove what they replace."""
    if error is not None or app.builder.name != "html":
        return
    top = Path(app.outdir)
    style = top / STYLE
    css, signs = shorten(
        style.read_text(encoding="utf-8"),
        {name for text in texts(top) for name in NAMED.findall(text)},
    )
    full = sorted((top / FONTS).glob("*.ttf"))
    if len(RULE.findall(css)) > 100 or not full or not FACE.search(style.read_text("utf-8")):
        logger.warning("icons: the theme's icons are not where they were; see icons.py")
        return
    others = "".join(p.read_text(encoding="utf-8") for p in style.parent.glob("*.css"))
    signs |= {chr(int(code, 16)) for code in CODE.findall(RULE.sub("", others))}
    style.write_text(css, encoding="utf-8", newline="\n")
    for font in full:
        cut(font, signs, font.with_suffix(".woff"))
        font.unlink()
        font.with_suffix(".woff2").unlink()
    for unused in (top / "_static" / "scripts").glob("fontawesome.js*"):
        unused.unlink()


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the step after the build."""
    app.connect("build-finished", shorten_icons)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
