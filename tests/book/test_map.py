"""The map of the course shows what there is, and says of the rest that it is to come."""

from __future__ import annotations

import json
import re
import sys

import pytest
from browser import ROOT

sys.path.insert(0, str(ROOT / "tools"))

import chapter_numbers

MAP = (ROOT / chapter_numbers.MAP).read_text(encoding="utf-8")
NUMBERS = {topic: n for topic, n in chapter_numbers.numbers().items() if n}
COMING = {n for n, row in enumerate(chapter_numbers.map_rows(), 1) if "| to come |" in row}


def last_section(topic):
    """What a chapter says of itself when it ends."""
    cells = json.loads(chapter_numbers.chapters()[topic].read_text(encoding="utf-8"))["cells"]
    prose = "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "markdown")
    return prose.partition("## What you can now say")[2].partition("\n## ")[0]


def test_what_is_linked_is_ready_and_the_rest_is_to_come():
    rows = [line.split("|") for line in MAP.splitlines() if line.startswith("| ")]
    states = {title.strip(): state.strip() for _, _, title, state, *_ in rows}
    heads = {title for title, state in states.items() if state == "state"}
    assert len(states) - len(heads) > len(chapter_numbers.map_rows())
    for title in states.keys() - heads:
        assert states[title] == ("ready" if title.startswith("[") else "to come"), title


def test_every_chapter_and_lab_is_on_it_once():
    linked = re.findall(r"^\|[^|]*\| \[[^\]]*\]\(\.\./(notebooks/\S+)\) \|", MAP, flags=re.M)
    pages = {p.relative_to(ROOT).as_posix() for p in ROOT.glob("notebooks/**/*_*.ipynb")}
    before = {p for p in pages if "/00_" in p}
    assert sorted(linked) == sorted(pages - before)


def test_rows_are_numbered_as_files():
    rows = chapter_numbers.map_rows()
    assert [int(row.split("|")[1]) for row in rows] == [*range(1, len(rows) + 1)]
    assert {*range(1, len(rows) + 1)} == COMING | {*NUMBERS.values()}
    assert not COMING & {*NUMBERS.values()}


@pytest.mark.parametrize("topic", NUMBERS)
def test_a_chapter_before_a_gap_says_so_and_no_other(topic):
    gap = NUMBERS[topic] + 1 in COMING
    assert ("(../book/map.md)" in last_section(topic)) == gap
