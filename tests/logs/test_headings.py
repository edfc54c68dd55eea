"""A truth that does not look where it goes is turned or refused because of what was measured."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf

DATA = Path(__file__).parents[2] / "data"


@pytest.fixture(scope="module")
def log():
    return pf.load_mrclam(DATA / "mrclam_twin")[:4000]


def turned(log, angle):
    truth = np.vstack((log.truth[:2], pf.wrap(log.truth[2] + angle)))
    return replace(log, truth=truth, start=truth[:, 0])


@pytest.mark.parametrize("degrees", [180, 39.6, -90, 0, 4])
def test_a_truth_is_turned_by_what_was_measured_and_it_is_said(log, degrees):
    faced = pf.face_course(turned(log, np.radians(degrees)))
    error = pf.wrap(faced.truth[2] - log.truth[2])
    if abs(degrees) < 10:  # small enough for a marker: left alone
        np.testing.assert_allclose(error, np.radians(degrees), atol=1e-9)
        assert faced.notes == log.notes
    else:
        np.testing.assert_allclose(error, 0, atol=np.radians(4))
        np.testing.assert_allclose(faced.start, faced.truth[:, 0])
        assert "heading was turned by" in faced.notes[-1]


def test_a_robot_in_reverse_looks_the_other_way_and_is_right(log):
    backwards = replace(log, u=log.u * [[-1], [1], [1]], truth=turned(log, np.pi).truth)
    assert pf.face_course(backwards).notes == log.notes


def test_a_heading_of_something_else_is_taken_as_unknown(log):
    noise = np.random.default_rng(0).uniform(-np.pi, np.pi, len(log))
    spoiled = pf.face_course(replace(log, truth=np.vstack((log.truth[:2], noise))))
    assert np.isnan(spoiled.truth[2]).all()
    np.testing.assert_array_equal(spoiled.truth[:2], log.truth[:2])
    assert "nothing to do with its course" in spoiled.notes[-2]


def test_positions_only_give_a_start_whose_heading_is_fitted(log):
    truth = np.vstack((log.truth[:2], np.full(len(log), np.nan)))
    found = pf.face_course(replace(log, truth=truth, start=None))
    assert "fitted to the first third" in found.notes[-1]
    np.testing.assert_array_equal(found.start[:2], log.truth[:2, 0])
    best = pf.rmse(pf.dead_reckoning(found)[:2, :1300], log.truth[:2, :1300])
    for angle in (-0.3, 0.3):
        other = pf.dead_reckoning(found, start=found.start + np.array((0, 0, angle)))
        assert best < pf.rmse(other[:2, :1300], log.truth[:2, :1300])


def test_a_plaza_folder_whose_heading_is_right_loads_right(tmp_path):
    log = pf.load_plaza(DATA / "plaza2")
    assert "180 degrees" in log.notes[0]
    shutil.copytree(DATA / "plaza2", tmp_path / "p")
    path = tmp_path / "p" / "truth.txt"
    rows = np.loadtxt(path)
    rows[:, 3] = pf.wrap(rows[:, 3] + np.pi)
    np.savetxt(path, rows, "%.8f")
    right = pf.load_plaza(tmp_path / "p")
    np.testing.assert_allclose(pf.wrap(right.truth[2] - log.truth[2]), 0, atol=1e-4)
    assert right.notes == ()
