"""Ray casting against a plain traversal, cell by cell."""

import math

import numpy as np
import pytest

import pfkit as pf
from pfkit.worlds.raycast import empty_squares


def traverse(occupied, x, y, direction, reach):
    """Loop twin (Amanatides and Woo): walk from cell to cell; lengths in cells."""
    rows, columns = occupied.shape
    dx, dy = math.cos(direction), math.sin(direction)
    i, j, t = math.floor(x), math.floor(y), 0.0
    step_i, step_j = (1 if dx > 0 else -1), (1 if dy > 0 else -1)
    per_x, per_y = (abs(1 / d) if d else math.inf for d in (dx, dy))
    next_x = ((i + 1 - x) if dx > 0 else (x - i)) * per_x if dx else math.inf
    next_y = ((j + 1 - y) if dy > 0 else (y - j)) * per_y if dy else math.inf
    while 0 <= i < columns and 0 <= j < rows and t < reach:
        if occupied[j, i]:
            return t
        if next_x < next_y:
            t, next_x, i = next_x, next_x + per_x, i + step_i
        else:
            t, next_y, j = next_y, next_y + per_y, j + step_j
    return reach


@pytest.mark.parametrize("density", [0.001, 0.02, 0.2, 0.6])
def test_it_agrees_with_the_traversal_on_random_maps(density):
    rng = np.random.default_rng(0)
    for shape in ((40, 60), (3, 50), (30, 1)):
        occupied = rng.random(shape) < density
        world = pf.OccupancyGrid(occupied, 0.5)
        pose = rng.uniform((0, 0, -4), (shape[1] / 2, shape[0] / 2, 4), (150, 3)).T
        angles = rng.uniform(-7, 7, 6)
        lengths = pf.RayCaster(world).cast(pose, angles, r_max=15.0)
        for k, angle in enumerate(angles):
            for m, (x, y, theta) in enumerate(pose.T):
                expected = 0.5 * traverse(occupied, 2 * x, 2 * y, theta + angle, 30.0)
                assert lengths[k, m] == pytest.approx(expected, abs=1e-9)


def test_rays_along_the_axes_and_the_diagonal():
    occupied = np.zeros((8, 9), dtype=bool)
    occupied[:, 8] = occupied[7] = occupied[0, 0] = True
    caster = pf.RayCaster(pf.OccupancyGrid(occupied, 1.0))
    angles = np.array((0.0, np.pi / 2, np.pi, -np.pi / 2, np.pi / 4, -3 * np.pi / 4))
    lengths = caster.cast(np.array((3.5, 3.5, 0.0)), angles, 100.0)
    np.testing.assert_allclose(
        lengths, (4.5, 3.5, 100.0, 100.0, 3.5 * math.sqrt(2), 2.5 * math.sqrt(2)), atol=1e-9
    )


def test_from_an_edge_the_beam_sees_what_lies_ahead():
    occupied = np.array([[False, True, False, False, True]])
    caster = pf.RayCaster(pf.OccupancyGrid(occupied, 1.0))
    pose = np.array([[2.0, 1.0, 3.0], [0.5, 0.5, 0.5], [0.0, 0.0, 0.0]])
    lengths = caster.cast(pose, np.array([0.0, np.pi]), 50.0)
    np.testing.assert_allclose(lengths, [[2.0, 0.0, 1.0], [0.0, 50.0, 1.0]], atol=1e-9)


def test_inside_a_wall_outside_the_map_and_without_limit():
    occupied = np.zeros((5, 5), dtype=bool)
    occupied[2, 2] = True
    caster = pf.RayCaster(pf.OccupancyGrid(occupied, 1.0))
    angles = np.linspace(-3, 3, 9)
    assert (caster.cast((2.3, 2.6, 0.4), angles, 9.0) == 0).all()
    for outside in ((-0.5, 2.5, 0.0), (2.5, 7.0, -1.5), (50.0, -3.0, 2.0), (5.0, 2.5, 3.1)):
        assert (caster.cast(outside, angles, 9.0) == 9.0).all()
    endless = caster.cast((0.5, 2.5, 0.0), [0.0, np.pi], np.inf)
    np.testing.assert_allclose(endless, (1.5, np.inf))


def test_unknown_cells_let_beams_pass():
    world = pf.OccupancyGrid([[0.0, 0.5, 1.0]], 1.0)
    assert pf.RayCaster(world).cast((0.5, 0.5, 0.0), [0.0], 9.0)[0] == pytest.approx(1.5)


def test_moving_map_and_robot_together_changes_nothing():
    rng = np.random.default_rng(1)
    occupied, g = rng.random((30, 40)) < 0.05, (3.0, -2.0, 0.8)
    here = pf.OccupancyGrid(occupied, 0.1, (1.0, 2.0, 0.0))
    there = pf.OccupancyGrid(occupied, 0.1, tuple(pf.compose(g, here.origin)))
    pose, angles = here.sample_poses(200, rng), np.linspace(-3, 3, 11)
    np.testing.assert_allclose(
        pf.RayCaster(there).cast(pf.compose(g, pose), angles, 5.0),
        pf.RayCaster(here).cast(pose, angles, 5.0),
        atol=1e-8,
    )


def test_shapes_blocks_and_angles_for_each_filter(monkeypatch):
    rng = np.random.default_rng(2)
    world = pf.OccupancyGrid(rng.random((30, 40)) < 0.05, 0.1)
    caster, pose = pf.RayCaster(world), world.sample_poses((4, 25), rng)
    angles = rng.uniform(-3, 3, (7, 4, 1))
    lengths = caster.cast(pose, angles, 5.0)
    assert lengths.shape == (7, 4, 25)
    for b in range(4):
        each = caster.cast(pose[:, b], angles[:, b, 0], 5.0)
        np.testing.assert_array_equal(lengths[:, b], each)
    one = caster.cast(pose[:, 1, 3], angles[:, 1, 0], 5.0)
    np.testing.assert_array_equal(one, lengths[:, 1, 3])
    monkeypatch.setattr("pfkit.worlds.raycast.BLOCK", 10)
    np.testing.assert_array_equal(caster.cast(pose, angles, 5.0), lengths)


def test_empty_squares_are_the_largest():
    """Loop twin: try every size at every cell."""
    stop = np.random.default_rng(3).random((13, 17)) < 0.1
    side = empty_squares(stop)
    for j, i in np.ndindex(stop.shape):
        sizes = range(1, min(13 - j, 17 - i) + 1)
        fits = [k for k in sizes if not stop[j : j + k, i : i + k].any()]
        assert side[j, i] == max(fits, default=0)


def test_bad_input_is_named():
    caster = pf.RayCaster(pf.OccupancyGrid([[0.0]], 1.0))
    with pytest.raises(pf.ShapeError, match="transpose it"):
        caster.cast(np.zeros((5, 3)), [0.0], 1.0)
    with pytest.raises(pf.ParameterError, match="finite"):
        caster.cast((0.5, math.nan, 0.0), [0.0], 1.0)
    with pytest.raises(pf.ShapeError, match="angles"):
        caster.cast((0.5, 0.5, 0.0), [], 1.0)
    with pytest.raises(AttributeError, match="'p'"):
        pf.RayCaster(np.zeros((3, 3)))
    with pytest.raises(pf.ParameterError, match="r_max"):
        caster.cast((0.5, 0.5, 0.0), [0.0], 0.0)
