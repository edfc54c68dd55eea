"""Sphinx extension: what there is to do on each page, so that the page can say what is done.

`live/tasks.js` lists, page by page, the questions (with the version of each) and the guided
missions. What a reader has done lies in the reader's browser; store.js knows where, and progress.js
counts it in the menu and on the map.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from live_page import SITE, version
from sphinx.application import Sphinx

SCRIPTS = ("store.js", "tasks.js", "progress.js")


def tasks(page: dict[str, Any]) -> dict[str, Any]:
    """Questions and missions of one page, from what live_page found on it."""
    out: dict[str, Any] = {}
    if "lab" in page:
        cells = [c for c in page["lab"]["cells"] if c["kind"] == "answer"]
        out = {"lab": page["lab"]["lab"], "items": [[c["item"], c["version"]] for c in cells]}
    out["missions"] = sorted(map(list, page.get("missions", {}).items()))
    return out


def course(app: Sphinx) -> list[dict[str, Any]]:
    """The pages that have something to do, in the order of the menu."""
    found = getattr(app.env, "live_pages", {})
    names = [n for n in app.builder.relations if n in found]  # type: ignore[attr-defined]
    pages = [{"page": n, "title": app.env.titles[n].astext(), **tasks(found[n])} for n in names]
    return [p for p in pages if p.get("items") or p["missions"]]


def write(app: Sphinx, error: Exception | None) -> None:
    """Write the list beside the scripts of the living pages, once those are there."""
    target = Path(app.outdir) / "live"
    if error is not None or app.builder.name != "html" or not target.exists():
        return
    text = json.dumps(course(app), ensure_ascii=False)
    (target / "tasks.js").write_text(f"window.pfTasks = {text};\n", "utf-8", newline="\n")


def load(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: Any) -> None:
    """Load the counting scripts on every page."""
    if app.builder.name != "html" or not (SITE / "store.js").exists():
        return
    path = context["pathto"]
    tags = [
        f'<script defer src="{path("live/" + name, resource=True)}?v={version()}"></script>'
        for name in SCRIPTS
    ]
    context["body"] = "\n".join(tags) + context.get("body", "")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the steps, after those of live_page."""
    app.connect("html-page-context", load, priority=600)
    app.connect("build-finished", write, priority=600)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
