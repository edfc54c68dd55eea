"""A small book with every explorable and a lab, built by the book's own extension.

It does not depend on the chapters, so that a page under construction breaks no test here. What
computes comes from tools/live/build.py. Without it or without a browser these tests are skipped,
with the reason; in CI that is a failure.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import browser
import nbformat
import pytest
from reader import Page

from pfkit.explore import SCENES as SCENES_BY_NAME

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / ".cache" / "live" / "site"


CONF = """
import sys
sys.path.insert(0, {extensions!r})
extensions = ["myst_nb", "typeset", "live_page", "tasks"]
html_theme, html_title, root_doc = "sphinx_book_theme", "A small book", "index"
nb_execution_mode, nb_ipywidgets_js = "off", {{}}
html_math_renderer = "typeset"
suppress_warnings = ["myst.domains"]
myst_enable_extensions = ["dollarmath", "amsmath"]
"""
SCENES = """# Explorables

```{explorable} drive
:panel: localise
:seed: 3
```

```{explorable} comb
:seed: 7
:alt: One bar of weights and five rows of teeth.
```
"""
FILM = """# Films

```{explorable} story
:seed: 7
```

```{explorable} drive
:panel: symmetry
:caption: Four clouds, one after the other gone.
```
"""
ALL = "# All\n\n" + "\n".join(f"```{{explorable}} {name}\n```\n" for name in SCENES_BY_NAME)
CONTENTS = "scenes all film plain book/map lab afterwards".split()
LANGUAGE = {"language_info": {"name": "python", "pygments_lexer": "ipython3"}}
PAGES = {
    "index.md": "# Home\n\n```{toctree}\n" + "\n".join(CONTENTS) + "\n```\n",
    "scenes.md": SCENES,
    "all.md": ALL,
    "film.md": FILM,
    "plain.md": "# Plain\n\nNothing lives here.\n",
    "book/map.md": "# Map\n\n| page |\n|---|\n| [The lab](../lab.ipynb) |\n",
}


def require(reason: str) -> None:
    """Skip, or fail where everything must be there."""
    if os.environ.get("CI"):
        pytest.fail(f"must run in CI: {reason}")
    pytest.skip(reason)


cell, text = nbformat.v4.new_code_cell, nbformat.v4.new_markdown_cell
IMPORTS = (
    "import matplotlib.pyplot as plt\nimport numpy as np\nimport pfkit as pf\n"
    "from pfkit.labs import lab3 as lab"
)


def pair(item: str, stub: str, name: str, verb: str = "check") -> list:
    """An answer cell and the cell that checks it."""
    return [
        cell(stub, metadata={"answer": item}),
        cell(f'lab.{verb}("{item}", {name})', metadata={"check": item}),
    ]


def written(cells: list) -> str:
    """A notebook of these cells."""
    for number, one in enumerate(cells):
        one["id"] = f"c{number}"
    return nbformat.writes(nbformat.v4.new_notebook(cells=cells, metadata=LANGUAGE))


def lab_notebook() -> str:
    """A notebook of three questions of lab 3 and two cells that only this test has."""
    from pfkit.labs.lab3 import LAB

    options = LAB.items["p1a"].options
    listed = "\n".join(f"* ({letter}) {says}" for letter, says in options.items())
    cells = [
        text("# A lab"),
        cell(IMPORTS),
        text(f"What are the particles?\n\n{listed}"),
        *pair("p1a", "p1a = ...", "p1a"),
        *pair("p4a", "p4a = ...", "p4a", "predict"),
        *pair("p5b", 'def circular_mean(theta, w):\n    """Mean direction."""\n    ...',
              "circular_mean"),
        cell('circular_mean = lab.use("p5b", circular_mean)'),
        cell("print(circular_mean(np.array([3.1, -3.1]), np.array([0.5, 0.5])))"),
    ]  # fmt: skip
    return written(cells)


def afterwards_notebook() -> str:
    """A number of one's own, a text with a rubric, and a function with a worked answer."""
    stub = 'def circular_mean(theta, w):\n    """Mean direction."""\n    ...'
    cells = [
        text("# What comes after a check"),
        cell(IMPORTS),
        *pair("p1b", "p1b = ...", "p1b"),
        *pair("p3c", 'p3c = "..."', "p3c", "answer"),
        *pair("p5b", stub, "circular_mean"),
        cell('# shows the worked answer once yours passed\nlab.solution("p5b")'),
    ]
    return written(cells)


@pytest.fixture(scope="session")
def site(tmp_path_factory) -> Path:
    """The built small book."""
    done = subprocess.run(
        [sys.executable, ROOT / "tools" / "live" / "build.py"], capture_output=True, text=True
    )
    if not (SITE / "manifest.json").exists():
        require(f"Python for the page could not be built: {done.stdout} {done.stderr}")
    source = tmp_path_factory.mktemp("small_book")
    conf = CONF.format(extensions=str(ROOT / "book" / "_ext"))
    notebooks = {"lab.ipynb": lab_notebook(), "afterwards.ipynb": afterwards_notebook()}
    for name, body in {**PAGES, "conf.py": conf, **notebooks}.items():
        (source / name).parent.mkdir(exist_ok=True)
        (source / name).write_text(body, encoding="utf-8")
    out = source / "_build"
    built = subprocess.run(
        [sys.executable, "-m", "sphinx", "-q", "-W", "-b", "html", source, out],
        capture_output=True,
        text=True,
    )
    assert built.returncode == 0, built.stderr[-3000:]
    return out


@pytest.fixture(scope="session")
def address(site):
    """The small book over http."""
    with browser.served(site) as where:
        yield where


@pytest.fixture(scope="module")
def open_page(chromium, address):
    """Open a page of the small book: open_page("scenes.html", file=False, **context options)."""
    contexts = []

    def open_it(page: str, base: str = address, init: str = "", **options) -> Page:
        context = chromium.new_context(
            viewport={"width": options.pop("width", 1280), "height": options.pop("height", 900)},
            **options,
        )
        if init:
            context.add_init_script(init)
        context.set_default_timeout(90_000)
        contexts.append(context)
        return Page(context, base, page)

    yield open_it
    for context in contexts:
        context.close()
