"""Options in the text are the lab's, and what is not is named."""

import copy

import options
import pytest
import stamps

(PATH,) = (stamps.ROOT / "notebooks").glob("[0-9][0-9]_resampling.ipynb")
START = "<!--options of clock-->\n* (a) never, the weights are equal\n"


@pytest.fixture
def notebook():
    return stamps.read(PATH)


def change(notebook, old, new):
    """A copy in which one text is replaced, once."""
    found = copy.deepcopy(notebook)
    (cell,) = (c for c in found["cells"] if old in c["source"] and c["cell_type"] == "markdown")
    cell["source"] = cell["source"].replace(old, new, 1)
    return found


def test_the_course_has_the_options_of_its_labs(notebook):
    assert options.faults(notebook) == []


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("(a) never, the weights", "(a) never, all weights", "clock: the text has other options"),
        ("* (b) about 10\n", "", "clock: the text has other options"),
        ("options of clock", "options of clok", "clok: no item with options"),
        ("options of clock", "options of clok", "clock: its options are missing"),
        ("options of clock", "options of best", "best: listed 2 times"),
        ("<!--options of clock-->\n", "", "typed by hand, without a comment above: * (a) never"),
    ],
)
def test_each_kind_of_fault_is_found(notebook, old, new, told):
    assert told in " ".join(options.faults(change(notebook, old, new)))


def test_lists_are_written_under_their_comments(notebook):
    lab = options.lab_of(notebook)
    text = "Asked:\n\n<!--options of clock-->"
    full = options.filled(text, lab)
    assert full.startswith("Asked:\n\n" + START) and full.endswith("* (d) about 10,000")
    assert options.filled(full, lab) == full
    stale = full.replace("about 10\n", "about 11\n") + "\n\nMore.\n"
    assert options.filled(stale, lab) == full + "\n\nMore.\n"
    assert options.filled("<!--options of hand-->\n", lab) == "<!--options of hand-->\n"


def test_a_notebook_without_a_lab_has_no_options():
    assert options.faults({"cells": [{"cell_type": "code", "source": "x = 1"}]}) == []
