"""The Labyrinth layout: what the data say of its wheels, and what is refused."""

import shutil
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf

DATA = Path(__file__).parents[2] / "data" / "labyrinth_uwb"


@pytest.fixture
def folder(tmp_path):
    shutil.copytree(DATA, tmp_path / "lab")
    return tmp_path / "lab"


def rewrite(folder, change):
    path = folder / "Indoor_UWB_Input.txt"
    path.write_text("\n".join(change(path.read_text().splitlines())) + "\n")


def test_the_shipped_log():
    log = pf.load_log(DATA)
    assert len(log) == 233 and sum(zk.shape[1] for zk in log.z) == 233
    assert log.world.ids.tolist() == [105, 107, 108, 109] and log.rig.sensor == "range"
    assert np.isnan(log.truth[2]).all() and np.isfinite(log.truth[:2]).all()
    assert "exchanged" in log.notes[0] and "2 times as far apart" in log.notes[0]
    driven = (np.abs(log.u[0]) * log.u[2]).sum()
    assert driven == pytest.approx(9.2, abs=0.3)
    assert pf.rmse(pf.dead_reckoning(log)[:2], log.truth[:2]) < 0.2


def test_without_truth_the_ranges_tell_the_same_of_the_wheels(folder):
    expected = pf.load_log(DATA)
    (folder / "Indoor_UWB_GT.txt").unlink()
    with pytest.raises(pf.DataError, match=r"point2.*--start global"):
        pf.load_log(folder)
    log = pf.load_log(folder, need_truth=False)
    assert "fits the ranges" in log.notes[0]
    np.testing.assert_allclose(log.u, expected.u)


def test_wheels_that_are_as_the_file_says_are_believed(folder):
    def repaired(lines):
        for line in lines:
            kind, *words = line.split()
            if kind == "odom2diff":
                words[1], words[2], words[4] = words[2], words[1], repr(2 * float(words[4]))
            yield " ".join((kind, *words))

    expected = pf.load_log(DATA)
    rewrite(folder, repaired)
    log = pf.load_log(folder)
    assert not any("wheel" in note for note in log.notes)
    np.testing.assert_allclose(log.u, expected.u)


BAD = {
    "a word": (lambda lines: [*lines, "range2 1.0 near 0 0 0 105 0"], "line 467: range2 must be"),
    "a short line": (lambda lines: [*lines, "odom2diff 1.0 0 0"], "line 467: odom2diff needs 8"),
    "another kind": (lambda lines: [*lines, "imu 1 2 3"], "line 467: 'imu' is none of"),
    "infinite": (lambda lines: [*lines, "range2 1.0 inf .01 0 0 105 0"], "line 467: a number"),
    "nanoseconds": (lambda lines: [*lines, "range2 1.7e18 1 .01 0 0 105 0"], "line 467: a number"),
    "negative": (lambda lines: [*lines, "range2 1.0 -1 .01 0 0 105 0"], "line 467: range must be"),
    "no wheels": (lambda lines: [x for x in lines if x[0] == "r"], "no line odom2diff"),
    "no ranges": (lambda lines: [x for x in lines if x[0] == "o"], "no line range2"),
    "a moving anchor": (lambda lines: [*lines, "range2 1 1 .01 7 7 105 0"], "anchor 105 stands in"),
    "an odd name": (lambda lines: [*lines, "range2 1 1 .01 7 7 1.5 0"], "must have whole numbers"),
}


@pytest.mark.parametrize("case", BAD)
def test_what_is_wrong_is_named(folder, case):
    change, reason = BAD[case]
    rewrite(folder, change)
    with pytest.raises(pf.DataError, match=reason):
        pf.load_log(folder)
