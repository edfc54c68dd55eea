"""Stored notebooks are what executing them would give, and are well formed."""

from __future__ import annotations

import copy

import prose_numbers
import pytest
import stamps

import notebooks

ROOT = stamps.ROOT
ALL = notebooks.find([])
FRESH = [path for path in ALL if not stamps.why_stale(stamps.read(path))]


def name(path):
    return path.relative_to(ROOT).as_posix()


@pytest.mark.parametrize("path", ALL, ids=name)
def test_outputs_are_up_to_date(path):
    assert stamps.why_stale(stamps.read(path)) == "", "run make notebooks"


@pytest.mark.parametrize("path", ALL, ids=name)
def test_notebook_is_well_formed(path):
    assert notebooks.faults(stamps.read(path)) == []


@pytest.mark.parametrize("path", prose_numbers.pages(), ids=name)
def test_numbers_in_the_prose_come_from_cells(path):
    assert prose_numbers.check(path) == []


@pytest.mark.parametrize("path", FRESH[:1], ids=name)
def test_an_edit_of_a_real_notebook_or_of_what_it_uses_is_seen(path, tmp_path):
    stored = stamps.read(path)
    edited = copy.deepcopy(stored)
    stamps.code_cells(edited)[0]["source"] += "\nsigma = 0.9"
    assert "changed" in stamps.why_stale(edited)
    for used in stored["metadata"]["pfkit"]["files"]:
        target = tmp_path / used
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes((ROOT / used).read_bytes())
    assert stamps.why_stale(stored, tmp_path) == ""
    target.write_bytes(target.read_bytes() + b"\nx = 1\n")
    assert "changed" in stamps.why_stale(stored, tmp_path)
