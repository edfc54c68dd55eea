"""Encoders: the odometry of a loop twin, squares that close, and wheels found again."""

import math

import numpy as np
import pytest

import pfkit as pf

BOOKS = pf.WheelGeometry(0.1, 0.1, 0.5)
SIDE = 4.0


def rolled(turns, wheels, n=400):
    """Loop twin: both wheels roll in many tiny straight moves."""
    x = y = theta = 0.0
    for left, right in turns.T:
        for _ in range(n):
            d_l, d_r = wheels.r_l * left / n, wheels.r_r * right / n
            turn = (d_r - d_l) / wheels.L
            x += (d_l + d_r) / 2 * math.cos(theta + turn / 2)
            y += (d_l + d_r) / 2 * math.sin(theta + turn / 2)
            theta += turn
    return np.array((x, y, math.remainder(theta, 2 * math.pi)))


def ends_of(drives, wheels):
    return np.stack([pf.encoder_odometry(t, wheels)[:2, -1] for t in drives], axis=1)


def both_ways(side=SIDE):
    return [pf.square_turns(side, BOOKS, clockwise) for clockwise in (True, False)]


def test_odometry_is_what_rolling_wheels_do():
    turns = np.random.default_rng(1).normal(2, 3, (2, 8))
    uneven = pf.WheelGeometry(0.09, 0.11, 0.6)
    path = pf.encoder_odometry(turns, uneven)
    assert path.shape == (3, 8)
    np.testing.assert_allclose(path[:, -1], rolled(turns, uneven), atol=1e-5)


def test_odometry_is_the_differential_drive_row_by_row():
    turns = np.random.default_rng(2).normal(size=(2, 30))
    robot, pose = pf.DifferentialDrive(0.1, 0.5, alpha=0.0), np.array((1.0, 2.0, 3.0))
    path = pf.encoder_odometry(turns, BOOKS, pose)
    for k, (left, right) in enumerate(turns.T):
        pose = robot.mean(pose, (left, right, 1.0))
        np.testing.assert_allclose(path[:, k], pose, atol=1e-12)


def test_a_batch_of_drives_is_each_of_them():
    turns = np.random.default_rng(3).normal(size=(2, 6, 5))
    path = pf.encoder_odometry(turns, BOOKS, (1.0, 0.0, 0.5))
    for b in range(5):
        np.testing.assert_allclose(
            path[..., b], pf.encoder_odometry(turns[..., b], BOOKS, (1.0, 0.0, 0.5))
        )


@pytest.mark.parametrize("clockwise", [True, False])
def test_a_square_visits_its_corners_and_comes_home(clockwise):
    path = pf.encoder_odometry(pf.square_turns(SIDE, BOOKS, clockwise), BOOKS)
    side = -1 if clockwise else 1
    corners = [(SIDE, 0), (SIDE, side * SIDE), (0, side * SIDE), (0, 0)]
    np.testing.assert_allclose(path[:2, 19::40].T, corners, atol=1e-12)
    np.testing.assert_allclose(path[:, -1], 0, atol=1e-12)


def test_wheels_are_found_again():
    true = pf.WheelGeometry(0.0993, 0.1007, 0.52)
    drives = both_ways()
    found = pf.calibrate_wheels(drives, ends_of(drives, true), BOOKS)
    np.testing.assert_allclose((found.r_l, found.r_r, found.L), (0.0993, 0.1007, 0.52), rtol=1e-9)


def test_the_square_that_was_calibrated_comes_home_in_both_directions():
    true = pf.WheelGeometry(0.0993, 0.1007, 0.52)
    drives = both_ways()
    found = pf.calibrate_wheels(drives, ends_of(drives, true), BOOKS)
    for clockwise in (True, False):
        turns = pf.square_turns(SIDE, found, clockwise)
        np.testing.assert_allclose(pf.encoder_odometry(turns, true)[:2, -1], 0, atol=1e-8)


def test_small_errors_are_those_of_the_closed_form():
    """Each corner turns too far by delta, each side bends by beta: x = 2 l (delta +- beta)."""
    e, k = 2e-5, 1 + 3e-5
    true = pf.WheelGeometry(0.1 * (1 - e / 2), 0.1 * (1 + e / 2), 0.5 * k)
    delta, beta = np.pi / 2 * (1 / k - 1), e * SIDE / true.L
    (x_cw, x_ccw), (y_cw, y_ccw) = ends_of(both_ways(), true)
    np.testing.assert_allclose((x_ccw + x_cw) / (4 * SIDE), delta, rtol=1e-3)
    np.testing.assert_allclose((x_ccw - x_cw) / (4 * SIDE), beta, rtol=1e-3)
    np.testing.assert_allclose((-y_ccw, y_cw), (x_ccw, x_cw), rtol=1e-3)


def test_tape_errors_average_out():
    """Twenty noisy ends each way: within 5 standard errors of the truth, false-fail 2e-6."""
    true, rng = pf.WheelGeometry(0.0998, 0.1002, 0.505), np.random.default_rng(4)
    drives = both_ways() * 20
    ends = ends_of(drives, true) + 0.02 * rng.standard_normal((2, 40))
    found = pf.calibrate_wheels(drives, ends, BOOKS)
    se = 0.02 / (4 * SIDE) / math.sqrt(20)  # of delta and beta, from x and y of both ways
    assert abs(found.L / true.L - 1) < 5 * se / (np.pi / 2)
    uneven = (found.r_r - found.r_l) / 0.1
    assert abs(uneven - 0.004) < 5 * se * 0.5 / SIDE


def test_a_larger_robot_drives_a_larger_square_that_closes_as_well():
    true = pf.WheelGeometry(0.11, 0.11, 0.55)
    np.testing.assert_allclose(ends_of(both_ways(), true), 0, atol=1e-12)


@pytest.mark.parametrize("n", [1, 5])
@pytest.mark.parametrize("clockwise", [True, False])
def test_one_direction_is_refused(clockwise, n):
    drives = [pf.square_turns(SIDE, BOOKS, clockwise)] * n
    with pytest.raises(pf.DataError, match="both directions"):
        pf.calibrate_wheels(drives, np.full((2, n), 0.1), BOOKS)


def test_an_end_is_missing():
    with pytest.raises(pf.ShapeError, match=r"\(2, 2\)"):
        pf.calibrate_wheels(both_ways(), np.zeros((2, 3)), BOOKS)
