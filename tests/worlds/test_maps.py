"""Landmark maps: names, places, the box."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pfkit as pf

POSITIONS = np.array([[0.0, 4.0, 2.0], [1.0, 3.0, -1.0]])


@given(st.lists(st.integers(-1000, 1000), min_size=1, max_size=12, unique=True), st.data())
def test_locate_finds_each_landmark_by_its_name(ids, data):
    rng = np.random.default_rng(len(ids))
    world = pf.LandmarkMap(rng.normal(size=(2, len(ids))), ids, (-9, 9, -9, 9))
    wanted = data.draw(st.lists(st.sampled_from(ids), min_size=1))
    by_hand = np.array([world.positions[:, ids.index(i)] for i in wanted]).T
    np.testing.assert_array_equal(world.locate(wanted), by_hand)
    np.testing.assert_array_equal(world.locate(np.array(wanted, dtype=float)), by_hand)
    assert world.locate(np.array(wanted).reshape(-1, 1)).shape == (2, len(wanted), 1)
    missing = data.draw(st.integers(-2000, 2000).filter(lambda i: i not in ids))
    with pytest.raises(pf.UnknownLandmarkError, match=f"landmark {missing} is not in the map"):
        world.locate([wanted[0], missing])


@pytest.mark.parametrize("bad, words", [(np.nan, "nan"), (1.5, "1.5"), ("door", "'door'")])
def test_a_name_that_is_no_name(bad, words):
    with pytest.raises(pf.UnknownLandmarkError, match=words):
        pf.LandmarkMap(POSITIONS).locate(bad)


def test_defaults_and_printing():
    world = pf.LandmarkMap(POSITIONS)
    np.testing.assert_array_equal(world.ids, [0, 1, 2])
    assert world.ids.dtype == np.int64 and len(world) == 3
    assert world.bounds == (0.0, 4.0, -1.0, 3.0)
    assert repr(world) == "LandmarkMap(3 landmarks, bounds (0.0, 4.0, -1.0, 3.0))"


@pytest.mark.parametrize(
    "arguments, error, words",
    [
        ((POSITIONS.T,), pf.ShapeError, "transpose"),
        ((np.empty((2, 0)),), pf.ShapeError, r"L >= 1, got \(2, 0\)"),
        (([[0, np.nan], [1, 2]],), pf.ParameterError, "positions must be finite, got nan"),
        ((POSITIONS, [1, 2, 1]), pf.ParameterError, r"3 different integers, got \[1, 2, 1\]"),
        ((POSITIONS, [1, 2]), pf.ShapeError, r"ids must have shape \(3,\), got \(2,\)"),
        ((POSITIONS, [1, 2, 2.5]), pf.ParameterError, "ids must be whole, got 2.5"),
        ((POSITIONS, ["a", "b", "c"]), pf.ParameterError, "real numbers, got"),
        ((POSITIONS, None, (0, 1, 2)), pf.ShapeError, r"\(4,\), got \(3,\)"),
        ((POSITIONS, None, (1, 0, 0, 1)), pf.ParameterError, "x_min"),
        ((POSITIONS, None, (0, np.inf, 0, 1)), pf.ParameterError, "bounds must be finite"),
    ],
)
def test_a_map_that_makes_no_sense_is_named(arguments, error, words):
    with pytest.raises(error, match=words):
        pf.LandmarkMap(*arguments)


def test_poses_are_drawn_inside():
    world = pf.LandmarkMap(POSITIONS, bounds=(-1, 5, -2, 4))
    x, y, theta = world.sample_poses((3, 500), np.random.default_rng(0))
    assert x.shape == (3, 500) and world.contains(x, y).all()
    assert theta.max() <= np.pi and theta.min() > -np.pi
    np.testing.assert_array_equal(world.contains([-1.1, -1.0], 0.0), [False, True])
    np.testing.assert_array_equal(world.contains(0.0, [4.0, 4.1]), [True, False])


def test_a_box_without_area_is_no_place_to_draw_from():
    with pytest.raises(pf.ParameterError, match="give bounds"):
        pf.LandmarkMap([[0.0, 4.0], [1.0, 1.0]]).sample_poses(3, np.random.default_rng(0))


def test_index_is_where_a_landmark_stands():
    world = pf.LandmarkMap([[0.0, 4.0, 2.0], [1.0, 1.0, 5.0]], ids=[7, 2, 5])
    np.testing.assert_array_equal(world.index([[5, 7], [2, 2]]), [[2, 0], [1, 1]])
