"""The grid itself: cells and metres, free space, thresholds."""

import math

import numpy as np
import pytest

import pfkit as pf

WALLS = np.array([[1, 1, 1, 1, 1], [1, 0, 0, 1, 1], [1, 0, 0, 0, 1], [1, 1, 1, 1, 1]], dtype=bool)
ASKEW = pf.OccupancyGrid(WALLS, 0.5, (3.0, -1.0, 0.7))


def test_cells_and_metres_are_inverse_and_the_origin_is_a_pose():
    i, j = np.random.default_rng(0).uniform(-2, 8, (2, 50))
    x, y = ASKEW.from_cells(i, j)
    np.testing.assert_allclose(ASKEW.to_cells(x, y), (i, j), atol=1e-12)
    corner = pf.compose(ASKEW.origin, np.stack((0.5 * i, 0.5 * j, np.zeros(50))))
    np.testing.assert_allclose((x, y), corner[:2], atol=1e-12)


def test_free_and_contains_agree_cell_by_cell():
    for j in range(-1, 5):
        for i in range(-1, 6):
            on_map = 0 <= j < 4 and 0 <= i < 5
            expected = on_map and not WALLS[j, i]
            assert ASKEW.contains(*ASKEW.from_cells(i + 0.5, j + 0.5)) == expected


def test_poses_are_uniform_over_free_cells():
    """Chi-square over the 5 free cells and 4 quarters each, and over headings: far below 1e-4."""
    M = 40_000
    pose = ASKEW.sample_poses(M, np.random.default_rng(1))
    assert pose.shape == (3, M) and ASKEW.contains(*pose[:2]).all()
    assert (pose[2] > -np.pi).all() and (pose[2] <= np.pi).all()
    quarter = np.floor(2 * ASKEW.to_cells(*pose[:2]))
    _, counts = np.unique(quarter, axis=1, return_counts=True)
    assert counts.size == 20
    assert ((counts - M / 20) ** 2 / (M / 20)).sum() < 60  # 19 degrees of freedom
    turns, _ = np.histogram(pose[2], 20, (-np.pi, np.pi))
    assert ((turns - M / 20) ** 2 / (M / 20)).sum() < 60


def test_a_batch_of_poses_and_a_uniform_prior():
    rng = np.random.default_rng(2)
    assert ASKEW.sample_poses((4, 7), rng).shape == (3, 4, 7)
    bel = pf.uniform_prior(100, ASKEW, rng)
    assert ASKEW.contains(*bel.state[:2]).all()


def test_bounds_hold_the_turned_map():
    x0, x1, y0, y1 = ASKEW.bounds
    x, y = ASKEW.from_cells(*np.random.default_rng(3).uniform((0, 0), (5, 4), (500, 2)).T)
    assert (x0 <= x).all() and (x <= x1).all() and (y0 <= y).all() and (y <= y1).all()
    upright = pf.OccupancyGrid(WALLS, 0.5, (3.0, -1.0, 0.0))
    np.testing.assert_allclose(upright.bounds, (3.0, 5.5, -1.0, 1.0))
    assert x1 - x0 == pytest.approx(2.5 * math.cos(0.7) + 2.0 * math.sin(0.7))


def test_between_the_thresholds_nobody_knows():
    world = pf.OccupancyGrid([[0.0, 0.196, 0.4, 0.65, 0.66]], 1.0)
    np.testing.assert_array_equal(world.free, [[True, False, False, False, False]])
    np.testing.assert_array_equal(world.occupied, [[False, False, False, False, True]])
    assert repr(world) == "OccupancyGrid(5 x 1 cells, 5 m x 1 m)"


@pytest.mark.parametrize(
    "make, error, match",
    [
        (lambda: pf.OccupancyGrid([0.0, 1.0], 1.0), pf.ShapeError, "rows, columns"),
        (lambda: pf.OccupancyGrid(np.empty((0, 3)), 1.0), pf.ShapeError, "rows, columns"),
        (lambda: pf.OccupancyGrid([[2.0]], 1.0), pf.ParameterError, r"\[0, 1\], got 2.0"),
        (lambda: pf.OccupancyGrid([[math.nan]], 1.0), pf.ParameterError, r"\[0, 1\], got nan"),
        (lambda: pf.OccupancyGrid([[0.0]], 0.0), pf.ParameterError, "resolution"),
        (lambda: pf.OccupancyGrid([[0.0]], 1.0, (0, 0)), pf.ShapeError, "origin"),
        (lambda: ASKEW.contains(math.nan, 0.0), pf.ParameterError, "x must be finite"),
        (lambda: ASKEW.sample_poses(3, 7), AttributeError, "integers"),
        (lambda: pf.OccupancyGrid([[0.0]], 1.0, free_thresh=0.9), pf.ParameterError, "thresholds"),
    ],
)
def test_bad_grids_are_named(make, error, match):
    with pytest.raises(error, match=match):
        make()


def test_a_map_without_free_cells_cannot_be_sampled():
    with pytest.raises(pf.ParameterError, match="no free cell"):
        pf.OccupancyGrid([[1.0]], 1.0).sample_poses(3, np.random.default_rng(4))
