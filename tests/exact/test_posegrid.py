"""The block of cells: what it covers, its cell numbers, its moments."""

import numpy as np
import pytest

import pfkit as pf

BOUNDS = (0.0, 8.0, 0.0, 7.0)


def known(shape=(32, 28, 24), sigma=(0.5, 0.5, 0.4)):
    return pf.gaussian_grid(shape, BOUNDS, (3.0, 3.0, 0.3), sigma)


def test_cells_cover_the_block():
    grid = pf.uniform_grid((4, 5, 6), BOUNDS)
    assert grid.p.sum() == pytest.approx(1)
    np.testing.assert_allclose(grid.cell * (4, 5, 6), (8, 7, 2 * np.pi))
    cell, inside = grid.index(grid.poses)
    np.testing.assert_array_equal(cell.ravel(), np.arange(120))
    assert inside.all()


def test_poses_outside_get_the_nearest_cell():
    grid = pf.uniform_grid((4, 5, 6), BOUNDS)
    cell, inside = grid.index(np.array([[-3.0, 4.0], [-9.0, 2.0], [0.1, 4 * np.pi + 0.1]]))
    assert inside.tolist() == [False, True]
    assert cell[0] == 0 * 30 + 0 * 6 + 3


def test_gaussian_grid_has_its_moments():
    cells = known(sigma=(0.6, 0.5, 0.4)).particles()
    np.testing.assert_allclose(pf.mean_pose(cells), (3.0, 3.0, 0.3), atol=1e-3)
    np.testing.assert_allclose(np.sqrt(np.diag(pf.covariance(cells))), (0.6, 0.5, 0.4), rtol=1e-3)


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda: pf.uniform_grid((4, 4), BOUNDS), pf.ShapeError),
        (lambda: pf.uniform_grid((4, 4, 0), BOUNDS), ZeroDivisionError),
        (lambda: pf.uniform_grid((4, 4, 4), (0, 1, 2)), pf.ShapeError),
        (lambda: pf.uniform_grid((4, 4, 4), (1, 0, 0, 1)), pf.ParameterError),
        (lambda: pf.uniform_grid((4, 4, 4), (0, np.nan, 0, 1)), pf.ParameterError),
        (lambda: pf.PoseGrid(np.ones((3, 3)), BOUNDS), pf.ShapeError),
        (lambda: pf.gaussian_grid((4, 4, 4), BOUNDS, (0, 0), (1, 1, 1)), IndexError),
        (lambda: pf.gaussian_grid((4, 4, 4), BOUNDS, (0, 0, 0), (1, 0, 1)), pf.ParameterError),
        (lambda: known().index(np.zeros((2, 5))), pf.ShapeError),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call()


def test_a_belief_of_another_shape_is_refused():
    with pytest.raises(pf.ShapeError, match="n_theta"):
        pf.PoseGrid(np.full((2, 2), 0.25), (0.0, 1.0, 0.0, 1.0))
