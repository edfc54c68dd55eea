"""The distance field against brute force."""

import numpy as np
import pytest

import pfkit as pf


def brute_force(occupied):
    """Loop twin: every cell against every occupied cell."""
    walls = np.argwhere(occupied)
    field = np.empty(occupied.shape)
    for cell in np.ndindex(occupied.shape):
        field[cell] = np.sqrt(((walls - cell) ** 2).sum(axis=1).min())
    return field


@pytest.mark.parametrize("density", [0.005, 0.05, 0.5, 0.99])
@pytest.mark.parametrize("shape", [(23, 31), (40, 7), (1, 30), (30, 1)])
def test_it_is_exact_on_random_maps(shape, density):
    rng = np.random.default_rng(0)
    occupied = rng.random(shape) < density
    occupied[rng.integers(shape[0]), rng.integers(shape[1])] = True
    np.testing.assert_array_equal(pf.distance_field(occupied), brute_force(occupied))


def test_one_wall_in_a_corner_and_the_unit():
    occupied = np.zeros((4, 5), dtype=bool)
    occupied[0, 0] = True
    field = pf.distance_field(occupied, resolution=0.1)
    assert field[3, 4] == pytest.approx(0.5) and field[0, 0] == 0


def test_without_walls_it_is_infinite():
    assert np.isinf(pf.distance_field(np.zeros((3, 4), dtype=bool))).all()


def test_turning_the_map_turns_the_field():
    occupied = np.random.default_rng(1).random((19, 26)) < 0.02
    for turn in (np.fliplr, np.flipud, np.transpose):
        np.testing.assert_array_equal(
            pf.distance_field(turn(occupied)), turn(pf.distance_field(occupied))
        )


def test_bad_input_is_named():
    with pytest.raises(pf.ShapeError, match="rows, columns"):
        pf.distance_field([True, False])
    with pytest.raises(pf.ShapeError, match="booleans"):
        pf.distance_field([[0.1, 0.9]])
    with pytest.raises(pf.ParameterError, match="resolution"):
        pf.distance_field([[True]], resolution=-1.0)
