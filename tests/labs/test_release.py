"""Releasing a lab: pristine and pinned, or refused."""

import json

import pytest
import submissions

import pfkit
from pfkit.labs import catalogue, release
from pfkit.labs.grade.notebook import find


def test_a_release_is_the_pristine_notebook_and_its_versions(tmp_path, capsys):
    assert release.main(["lab3", str(tmp_path / "out")]) == 0
    out = tmp_path / "out"
    name = "lab3_particle_filter.ipynb"
    assert json.loads((out / name).read_text()) == submissions.LAB3
    assert (out / "requirements.txt").read_text().startswith(f"pfkit=={pfkit.__version__}\nnumpy==")
    about = json.loads((out / "release.json").read_text())
    assert about["lab"] == "lab3" and about["version"].startswith(pfkit.__version__)
    assert release.main(["lab3", str(out), "--pfkit", "git+https://x@v1"]) == 2, "not overwritten"
    assert "exists and differs" in capsys.readouterr().err


@pytest.mark.parametrize("name", catalogue.names())
def test_every_lab_can_be_released(name):
    assert release.faults(find(name)) == []


def spoilt(tmp_path, change, answers=None):
    path = tmp_path / "lab.ipynb"
    path.write_text(json.dumps(submissions.notebook(answers or {}, change)))
    return find("lab3", path)


def store_verdict(book):
    cell = next(c for c in book["cells"] if c["metadata"].get("check") == "p1a")
    cell["outputs"] = [{"output_type": "stream", "text": "p1a: passed 1/1"}]


def solution_markers(book):
    submissions.cell_of(book, "p2b")["source"] += "\n# BEGIN SOLUTION"


@pytest.mark.parametrize(
    ("change", "answers", "told"),
    [
        (None, {"p1a": 'p1a = "c"'}, "p1a is answered"),
        (store_verdict, {}, "stored with its verdict"),
        (solution_markers, {}, "holds a solution"),
        (submissions.twice("p1a = ..."), {}, "each once"),
    ],
)
def test_what_is_not_pristine_is_refused(tmp_path, change, answers, told):
    with pytest.raises(ValueError, match=told):
        release.release(spoilt(tmp_path, change, answers), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_unknown_labs_and_lost_cells_are_named(tmp_path, capsys):
    assert release.main(["lab99", str(tmp_path)]) == 2
    assert "there is no lab 'lab99'" in capsys.readouterr().err
    with pytest.raises(ValueError, match="no answer and check cell for p1b"):
        spoilt(tmp_path, submissions.drop("p1b"))
