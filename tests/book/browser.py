"""What it takes to look at a page of the built book as a reader's browser does.

The checks are plain functions that return a list of complaints, so that they can be tried on pages
that are broken on purpose (test_page_checks.py) as well as on the book (test_pages.py).
"""

from __future__ import annotations

import functools
import gzip
import http.server
import os
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
HTML = ROOT / "_build" / "html"
AXE = ROOT / ".cache" / "npm" / "node_modules" / "axe-core" / "axe.min.js"
FLAGS = (
    "--no-sandbox --disable-gpu --disable-quic --disable-background-networking "
    "--disable-component-update --disable-sync --no-first-run"
).split()
WIDE, NARROW = {"width": 1280, "height": 900}, {"width": 390, "height": 844}
SETTLE = 400  # ms: the theme waits before it reacts to a new width
PATIENCE = 120_000  # ms: a busy machine is slow, not wrong
LARGEST_PAGE = 600_000  # bytes beyond what all pages share, before gzip; formulas are among them
SHARED = ("/_static/", "/live/", "/searchindex.js")  # what all pages, or all that compute, load
LARGEST_VISIT = 900_000  # bytes of a first visit before any click, as hosts serve them
PACKED = (".html", ".js", ".css", ".svg", ".json")  # what hosts send with gzip
FORWARDS = 'http-equiv="refresh"'
NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")

OUTLINE = "[...document.querySelectorAll('h1,h2,h3,h4,h5,h6')].map(h => +h.tagName[1])"
# Alt texts that say nothing: none, a file name, the hash Sphinx gives a picture.
NO_ALT = r"""[...document.querySelectorAll('img, svg[role=img]:not([aria-hidden])')].filter(i => {
  const alt = i.tagName == 'IMG' ? i.getAttribute('alt')
    : i.getAttribute('aria-label') || i.getAttribute('aria-labelledby');
  const silent = alt === '' && i.getAttribute('role') == 'presentation';
  const bare = /^(\.\.|_images|[0-9a-f]{16,}|\S+\.(png|svg|jpg)$)/;
  return !silent && (!(alt || '').trim() || bare.test(alt));
}).map(i => i.outerHTML.slice(0, 120))"""
# Formulas are typeset when the book is built: no source of one may stand in a page.
MATH_ERRORS = r"""[...document.querySelectorAll('mjx-merror, .math')]
  .filter(e => e.matches('mjx-merror') || !e.querySelector('mjx-container'))
  .map(e => e.textContent.slice(0, 80))"""
# A colour on its way from one theme to the other has no contrast to judge.
SETTLED = """() => Promise.all(document.getAnimations()
  .filter(a => Number.isFinite(a.effect?.getComputedTiming().endTime))
  .map(a => a.finished.catch(() => 0)))"""
# What axe-core looks for: all of it; the colours; all but these, which a width does not change.
EVERYTHING: dict[str, Any] = {}
COLOURS: dict[str, Any] = {"runOnly": ["color-contrast"]}
BUT_COLOURS: dict[str, Any] = {"rules": {"color-contrast": {"enabled": False}}}
SEVERE = """(which) => axe.run(document, {resultTypes: ['violations'], ...which})
  .then(r => r.violations
  .filter(v => ['serious', 'critical'].includes(v.impact))
  .map(v => `${v.id} (${v.impact}) x${v.nodes.length}: ${v.nodes[0].html.slice(0, 150)}`))"""


def find_browser() -> str | None:
    """Return the path of Debian's Chromium or a relative; PFKIT_BROWSER names another."""
    named = os.environ.get("PFKIT_BROWSER")
    return named or next(filter(None, map(shutil.which, NAMES)), None)


def pages(root: Path = HTML) -> list[str]:
    """Return every page of the book, from its top folder."""
    found = [path for path in root.rglob("*.html") if "_static" not in path.parts]
    full = (path for path in found if FORWARDS not in path.read_text(encoding="utf-8"))
    return sorted(path.relative_to(root).as_posix() for path in full)


def chapter(topic: str) -> str:
    """Return the page of a chapter, whatever its number."""
    (source,) = ROOT.glob(f"notebooks/[0-9][0-9]_{topic}.ipynb")
    return f"notebooks/{source.stem}.html"


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *args: Any) -> None:
        pass

    def copyfile(self, source: Any, outputfile: Any) -> None:
        try:
            super().copyfile(source, outputfile)
        except (BrokenPipeError, ConnectionResetError):
            pass  # the page was closed before the file was through


@contextmanager
def served(root: Path) -> Iterator[str]:
    """Serve a folder on this machine; yield its address."""
    handler = functools.partial(_Quiet, directory=str(root))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()


@dataclass
class Visit:
    """What happened while a page loaded."""

    base: str
    complaints: list[str] = field(default_factory=list)
    own_bytes: int = 0
    responses: list[Any] = field(default_factory=list)

    def listen(self, tab: Any) -> None:
        """Note errors, failures and requests that leave the book."""
        tab.on("pageerror", lambda error: self.complaints.append(f"script error: {error}"[:200]))
        tab.on("requestfailed", lambda r: self.complaints.append(f"failed: {r.url[-100:]}"))
        tab.on("request", self._request)
        tab.on("response", self._response)

    def _request(self, request: Any) -> None:
        if not request.url.startswith((self.base, "data:", "blob:")):
            self.complaints.append(f"outside request: {request.url[:120]}")

    def _response(self, response: Any) -> None:
        if response.status >= 400:
            self.complaints.append(f"{response.status}: {response.url[-100:]}")
        if response.url.startswith("http"):
            self.responses.append(response)
            if not any(part in response.url for part in SHARED):
                self.own_bytes += int(response.headers.get("content-length") or 0)

    def weight(self) -> int:
        """Bytes that came so far, those of text as gzip makes them."""
        total = 0
        for response in self.responses:
            packed = response.url.split("?")[0].endswith(PACKED)
            total += len(gzip.compress(response.body()) if packed else response.body())
        return total


def check_outline(tab: Any) -> list[str]:
    """One h1, and no level skipped on the way down."""
    levels = tab.evaluate(OUTLINE)
    found = [] if levels.count(1) == 1 else [f"{levels.count(1)} h1 headings"]
    jumps = [f"h{a} to h{b}" for a, b in pairwise(levels) if b > a + 1]
    return found + [f"heading jump: {jump}" for jump in jumps]


def check_content(tab: Any) -> list[str]:
    """Alt texts, mathematics, headings."""
    found = [f"no alt text: {image}" for image in tab.evaluate(NO_ALT)]
    found += [f"mathematics is not typeset: {text}" for text in tab.evaluate(MATH_ERRORS)]
    return found + check_outline(tab)


def check_width(tab: Any) -> list[str]:
    """No sideways scrolling."""
    excess = tab.evaluate("document.documentElement.scrollWidth - window.innerWidth")
    return [f"scrolls sideways by {excess} px"] if excess > 2 else []


def check_access(tab: Any, which: dict[str, Any] = EVERYTHING) -> list[str]:
    """No axe-core violation of level serious or critical."""
    if not tab.evaluate("'axe' in window"):
        tab.evaluate(AXE.read_text(encoding="utf-8"))
    tab.evaluate(SETTLED)
    return [f"axe: {text}" for text in tab.evaluate(SEVERE, which)]


def look(
    tab: Any,
    base: str,
    page: str,
    wide: dict[str, Any] | None = EVERYTHING,
    narrow: dict[str, Any] | None = EVERYTHING,
) -> list[str]:
    """Open a page wide and narrow; return everything that is wrong with it.

    `wide` and `narrow` say what axe-core looks for at that width; None: it is not asked.
    """
    visit = Visit(base)
    visit.listen(tab)
    tab.set_viewport_size(WIDE)
    tab.goto(base + page, wait_until="load")
    found = check_content(tab)
    if visit.weight() > LARGEST_VISIT:
        found.append(f"{visit.weight() // 1000} kB before any click, more than 900 kB")
    for size, which in ((WIDE, wide), (NARROW, narrow)):
        tab.set_viewport_size(size)
        at_this_width = check_width(tab)
        if which is not None:
            tab.wait_for_timeout(SETTLE if size == NARROW else 0)
            at_this_width += check_access(tab, which)
        found += [f"{text} at {size['width']} px" for text in at_this_width]
    if visit.own_bytes > LARGEST_PAGE:
        found.append(f"{visit.own_bytes // 1000} kB of its own, more than 600 kB")
    return visit.complaints + found


def require_nothing(complaints: list[str]) -> None:
    """Fail with one complaint a line, each once."""
    assert not complaints, "\n" + "\n".join(dict.fromkeys(complaints))
