"""Which cells of a notebook fold in the page."""

from __future__ import annotations

import json

import fold
import pytest
from browser import ROOT
from docutils import nodes
from docutils.utils import new_document

CELLS = {
    "imports": "import numpy as np\n\nimport pfkit as pf\nplotting.use_style()",
    "drawing": "fig, ax = plt.subplots()\nax.plot(x)\nplt.show()\nprint(x)",
    "": "x = pf.wrap(theta)\nfig = plt.figure()",  # half of it is not more than half
}


@pytest.mark.parametrize("found", CELLS)
def test_a_cell_is_told_by_more_than_half_of_its_lines(found):
    assert fold.kind(CELLS[found]) == found


def test_a_helper_that_draws_into_axes_draws():
    assert (
        fold.kind("def bars(ax, bel):\n    ax.bar(range(4), bel)\n    ax.set(ylim=(0, 1))")
        == "drawing"
    )
    assert fold.kind("def axis(bel):\n    return bel.argmax()") == ""


@pytest.mark.parametrize("source", ["%matplotlib inline", "def broken(:", "", "# nothing"])
def test_what_is_no_program_stays(source):
    assert fold.kind(source) == ""


def test_chapters_fold_between_a_fifth_and_two_thirds_of_their_code():
    for path in sorted(ROOT.glob("notebooks/0[1-9]_*.ipynb")):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code = ["".join(c["source"]) for c in cells if c["cell_type"] == "code"]
        lines = {bool(k): 0 for k in (0, 1)}
        for source in code:
            lines[bool(fold.kind(source))] += source.count("\n") + 1
        assert 0.2 < lines[True] / sum(lines.values()) < 0.67, (path.name, lines)


def cell(source: str, **attributes) -> nodes.document:
    """A document with one code cell."""
    document = new_document("")
    inner = nodes.container("", nodes.literal_block(source, source))
    inner["nb_element"] = "cell_code_source"
    document += nodes.container("", inner, nb_element="cell_code", **attributes)
    return document


@pytest.mark.parametrize(
    "mode, source, line",
    [
        ("input", "x = 1", "Show the code"),
        ("input", CELLS["drawing"], "Show the code that draws"),
        ("", CELLS["imports"], "Show what is imported"),
        ("", "x = 1", None),
        ("all", CELLS["drawing"], None),
    ],
)
def test_what_folds_says_what_it_is(mode, source, line):
    document = cell(source, **({"hide_mode": mode} if mode else {}))
    fold.fold(None, document)
    assert document.children[0].get("prompt_show") == line
