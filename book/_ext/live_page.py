"""Sphinx extension: explorables and lab cells that compute in the page.

In a chapter, an explorable is a directive in a markdown cell::

    ```{explorable} comb
    :panel: comb
    :seed: 7
    :alt: One bar of weights and five rows of teeth.
    ```

`panel`, `seed` and `alt` may be left out; the scene knows good ones. Its guided missions are the
panel's own, which the scene ticks off when it sees them done. With a `caption` it is a film: the
recorded run alone, to be played and scrubbed, for the middle of a chapter. A recorded run and a
still are made here, by the scene itself, and kept in .cache/live/runs until pfkit changes. They
need neither Node nor a network. What computes (Pyodide and so on) comes from tools/live/build.py;
if that is not there, the build says so and the pages keep recordings and stills.

Cells of a notebook with the metadata ``answer`` become editors, and the check cells after them
become their Check button. A cell with ``lab.solution("id")`` gives way to the worked answer of that
item, which shows once it passed or after three hints. Nothing is written twice: the page gets the
notebook's own code cells. A question that asks for a letter (`Choice`, `Prediction`) is answered
with radio buttons; their texts are the lab's own, and they write the cell's code.

Only pages with live parts load any of it.
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
from html import escape
from importlib import import_module
from pathlib import Path
from typing import Any, ClassVar

from docutils import nodes
from docutils.parsers.rst import directives
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxDirective

import pfkit
from pfkit.errors import PfkitError
from pfkit.explore import FRONT_END
from pfkit.explore import scene as open_scene
from pfkit.explore.record import record, to_script
from pfkit.explore.still import to_svg
from pfkit.labs import catalogue
from pfkit.labs.grade.cells import VERBS, lab_calls, labs_imported, said
from pfkit.labs.guard import PAGE_LIMIT
from pfkit.labs.items import Choice, Prediction, Text
from pfkit.labs.progress import FORMER_NAMES
from pfkit.labs.spaced_review import GAP, SITTING, TIMES, reviewable

logger = logging.getLogger(__name__)
ROOT = Path(__file__).resolve().parent.parent.parent
CACHE = ROOT / ".cache" / "live"
SITE = CACHE / "site"
SCRIPTS = ("keys.js", "palette.js", "operations.js", *FRONT_END, "page.js")
# ... and store.js, which every page loads (tasks.py)
LAB_SCRIPTS = ("choices.js", "afterwards.js", "student.js", "review.js", "lab.js")
STUB = re.compile(r"^(\w+) = \.\.\.\s*(#.*)?$")  # an answer cell that waits for a letter


class explorable(nodes.General, nodes.Element):
    """A scene in the page; its children are the guided missions."""


class Explorable(SphinxDirective):
    """The directive `explorable`."""

    required_arguments = 1
    option_spec: ClassVar = {
        "panel": directives.unchanged,
        "seed": directives.nonnegative_int,
        "alt": directives.unchanged,
        "name": directives.unchanged,
        "caption": directives.unchanged,
    }

    def run(self) -> list[nodes.Node]:
        name, seed = self.arguments[0], self.options.get("seed", 1)
        try:
            about = open_scene(name, self.options.get("panel"), seed).describe()
        except PfkitError as problem:
            raise self.error(f"explorable: {problem}") from problem
        alt = self.options.get("alt") or about["alt"]
        if not alt:
            raise self.error(f"explorable {name}: give :alt:, a still needs a text")
        key = f"{name}-{about['panel']}-{seed}"
        page = _pages(self.env).setdefault(self.env.docname, {"runs": {}})
        used = page["runs"]
        ident = self.options.get("name") or f"explorable-{key}" + (
            f"-{list(used).index(key) + 2}" if key in used else ""
        )
        used[key] = [name, about["panel"], seed]
        caption = self.options.get("caption", "")
        node = explorable(
            key=key, title=about["title"], alt=alt, ident=ident, size=about["size"], caption=caption
        )
        self.set_source_info(node)
        if about["missions"] and not caption:
            page.setdefault("missions", {})[f"{name}/{about['panel']}"] = len(about["missions"])
            missions = nodes.enumerated_list(classes=["pf-missions"])
            for mission in about["missions"]:
                missions += nodes.list_item("", nodes.paragraph(text=mission["text"]))
            node += missions
        return [node]


def _pages(env: Any) -> dict[str, dict[str, Any]]:
    """What each page has that lives: its runs, and its code cells."""
    if not hasattr(env, "live_pages"):
        env.live_pages = {}
    return env.live_pages


def visit_html(writer: Any, node: explorable) -> None:
    prefix = writer.builder.get_relative_uri(writer.builder.current_docname, "live")
    prefix = prefix.removesuffix(".html")
    width, height = node["size"]
    caption = escape(node["caption"])
    film = f' data-caption="{caption}"' if caption else ""
    name = "pf-caption" if caption else "pf-title"
    writer.body.append(
        f'<div class="pf-explorable" role="group" id="{escape(node["ident"])}" '
        f'aria-label="{escape(node["title"])}" data-recording="{escape(node["key"])}"{film}>\n'
        f'<p class="{name}">{caption or escape(node["title"])}</p>\n'
        f'<img class="pf-still" src="{prefix}-runs/{escape(node["key"])}.svg" width="{width}" '
        f'height="{height}" alt="{escape(node["alt"])}">\n'
    )


def depart_html(writer: Any, node: explorable) -> None:
    writer.body.append("</div>\n")


def visit_other(writer: Any, node: explorable) -> None:
    """Other builders show the missions alone."""


def python_size(
    name: str, raw: str, text: str, line: int, inliner: Any, *rest: Any
) -> tuple[list[nodes.Node], list[nodes.Node]]:
    """The role ``python-size``: what a page loads to compute, in megabytes, as it was packed."""
    manifest = SITE / "manifest.json"
    if not manifest.exists():
        return [nodes.Text("not part of this copy")], []
    total = sum(json.loads(manifest.read_text(encoding="utf-8")).values())
    return [nodes.Text(f"{total / 1e6:.1f} {text}")], []


# ---- lab cells ------------------------------------------------------------------------------


def question(module: str, item: str, source: str) -> dict[str, Any]:
    """What the lab itself says of a question: its version, and its options or rubric, if any.

    ``worked`` tells that it has a worked answer which is no letter and no text.
    """
    found = import_module(f"pfkit.labs.{module}").LAB.items.get(item)
    if found is None:
        logger.warning(
            "live_page: pfkit.labs.%s has no item %r (cell metadata answer)", module, item
        )
        return {"version": ""}
    if isinstance(found, Text):
        return {"version": found.version, "rubric": list(found.rubric)}
    name = STUB.match(source)
    if not isinstance(found, Choice | Prediction):
        return {"version": found.version, "worked": True}
    if not name:
        return {"version": found.version}
    options = [list(pair) for pair in found.options.items()]
    choose = {"name": name[1], "options": options, "sure": isinstance(found, Prediction)}
    return {"version": found.version, "choose": choose}


def read_lab(cells: list[dict[str, Any]]) -> dict[str, Any] | None:
    """The code cells of a notebook as a page needs them; None if it has nothing to answer."""
    code = [(i, c) for i, c in enumerate(cells) if c["cell_type"] == "code"]
    sources = {i: "".join(c["source"]) for i, c in code}
    imported = {n: a for s in sources.values() for n, a in labs_imported(s).items()}
    found = next((pair for pair in imported.items() if pair[0] in catalogue.names()), None)
    if not found or not any("answer" in c["metadata"] for _, c in code):
        return None
    (module, alias), out, open_item = found, [], None
    for i, cell in code:
        entry: dict[str, Any] = {"index": i, "source": sources[i], "kind": "code"}
        item = cell["metadata"].get("answer")
        if item:
            entry.update(kind="answer", item=item, **question(module, item, sources[i]))
            open_item = item
        elif cell["metadata"].get("check") or any(
            verb in VERBS and asked == open_item for verb, asked, _ in lab_calls(sources[i], alias)
        ):
            entry.update(kind="check", item=cell["metadata"].get("check", open_item))
        elif shown := said(sources[i], "solution", alias):
            entry.update(kind="solution", item=shown[0][0])
        out.append(entry)
    here = {c["item"] for c in out if c["kind"] == "answer"}
    again = [i for i in reviewable(import_module(f"pfkit.labs.{module}").LAB) if i in here]
    return {
        "lab": module,
        "former": FORMER_NAMES.get(module),
        "alias": alias,
        "cells": out,
        "review": {"gap": GAP, "sitting": SITTING, "times": TIMES, "items": again},
    }


def find_lab_cells(app: Sphinx, doctree: nodes.document) -> None:
    """Mark the cells of a notebook page so that lab.js finds them."""
    path = Path(app.env.doc2path(app.env.docname))
    if path.suffix != ".ipynb":
        return
    lab = read_lab(json.loads(path.read_text(encoding="utf-8"))["cells"])
    if lab is None:
        return
    kinds = {c["index"]: c["kind"] for c in lab["cells"]}
    for node in doctree.findall(nodes.container):
        if node.get("nb_element") == "cell_code" and kinds.get(node["cell_index"]) != "code":
            node["classes"] += ["pf-cell", f"pf-cell-{node['cell_index']}"]
    _pages(app.env).setdefault(app.env.docname, {"runs": {}})["lab"] = lab


# ---- pages ----------------------------------------------------------------------------------


def version() -> str:
    """A short hash of everything in the live folder: the address of each file carries it."""
    stamp = CACHE / "site.stamp"
    text = stamp.read_text() if stamp.exists() else "none"
    return hashlib.sha256(text.encode()).hexdigest()[:10]


def add_scripts(app: Sphinx, pagename: str, templatename: str, context: Any, doctree: Any) -> None:
    """Load scripts and style on pages with live parts, and only there."""
    page = _pages(app.env).get(pagename)
    if not page or app.builder.name != "html" or not (SITE / "page.js").exists():
        return
    path, v = context["pathto"], version()
    live = (SITE / "manifest.json").exists()
    lab = "lab" in page and live  # without Python, cells stay as the notebook shows them
    if not (page["runs"] or lab):
        return
    styles = ["explorable.css", *(["lab.css"] if lab else [])]
    scripts = [*SCRIPTS, *(LAB_SCRIPTS if lab else ())]
    links = [
        f'<link rel="stylesheet" href="{path("live/" + name, resource=True)}?v={v}">'
        for name in styles
    ]
    context["metatags"] = context.get("metatags", "") + "\n".join(links)
    tags = [
        f'<script defer src="{path("live/" + name, resource=True)}?v={v}" '
        f'data-version="{v}" data-live="{live:d}"></script>'
        for name in scripts
    ]
    if lab:
        data = json.dumps({**page["lab"], "seconds": PAGE_LIMIT}).replace("<", "\\u003c")
        tags.insert(0, f'<script type="application/json" id="pf-lab">{data}</script>')
    context["body"] = context.get("body", "") + "\n".join(tags)


def make_run(key: str, name: str, panel: str, seed: int, folder: Path) -> None:
    """The recorded run and the still of one explorable, unless they are there."""
    script, still = folder / f"{key}.js", folder / f"{key}.svg"
    if script.exists() and still.exists():
        return
    folder.mkdir(parents=True, exist_ok=True)
    scene = open_scene(name, panel, seed)
    still_at = scene.still_at or scene.record_steps
    for _ in range(still_at):
        scene.step()
    still.write_text(to_svg(scene.frame()[0], scene.size, scene.panel.title), encoding="utf-8")
    recording = record(open_scene(name, panel, seed))
    script.write_text(to_script(recording, key), encoding="utf-8", newline="\n")


def package_hash() -> str:
    """Hash of pfkit's modules and data: recordings are made anew when one changes."""
    folder = Path(pfkit.__file__).parent
    digest = hashlib.sha256()
    for path in sorted(p for p in folder.rglob("*") if p.suffix in (".py", ".json")):
        digest.update(path.relative_to(folder).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def copy_live(app: Sphinx, error: Exception | None) -> None:
    """Carry runs and runtime into the finished book."""
    pages = [page for page in _pages(app.env).values() if page["runs"] or "lab" in page]
    if error is not None or app.builder.name != "html" or not pages:
        return
    target = Path(app.outdir) / "live"
    shutil.rmtree(target, ignore_errors=True)
    if SITE.exists():
        shutil.copytree(SITE, target)
    if not (SITE / "manifest.json").exists():
        logger.info("live parts: python tools/live/build.py has not run or could not finish;")
        logger.info("live parts: the pages keep recorded runs and pictures but cannot compute")
    runs, folder = target.with_name("live-runs"), CACHE / "runs" / package_hash()
    shutil.rmtree(runs, ignore_errors=True)
    runs.mkdir(parents=True, exist_ok=True)
    for page in pages:
        for key, (name, panel, seed) in page["runs"].items():
            make_run(key, name, panel, seed, folder)
            for suffix in (".js", ".svg"):
                shutil.copyfile(folder / (key + suffix), runs / (key + suffix))
    for old in (CACHE / "runs").iterdir() if (CACHE / "runs").exists() else ():
        if old != folder:
            shutil.rmtree(old)


def forget(app: Sphinx, env: Any, docname: str) -> None:
    _pages(env).pop(docname, None)


def merge(app: Sphinx, env: Any, docnames: set[str], other: Any) -> None:
    _pages(env).update({k: v for k, v in _pages(other).items() if k in docnames})


def setup(app: Sphinx) -> dict[str, Any]:
    """Register the directive and the steps around a page."""
    others = {name: (visit_other, visit_other) for name in ("latex", "text", "man", "texinfo")}
    app.add_node(explorable, html=(visit_html, depart_html), **others)
    app.add_directive("explorable", Explorable)
    app.add_role("python-size", python_size)
    app.connect("env-purge-doc", forget)
    app.connect("env-merge-info", merge)
    app.connect("doctree-read", find_lab_cells)
    app.connect("html-page-context", add_scripts)
    app.connect("build-finished", copy_live)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
