"""Drift: keys follow from what the package's robots do."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import drift

ITEMS = drift.LAB.items


def test_keys_follow_from_the_package():
    v, omega = pf.DifferentialDrive(0.1, 0.5).body_speed(8, 12)
    assert np.allclose((v, omega, v / omega), ITEMS["wheels"].key)
    rot1, trans, rot2 = pf.odometry_control((2, 1, np.pi / 2), (1, 2, np.radians(-150)))
    assert np.allclose((np.degrees(rot1), trans, np.degrees(rot2)), ITEMS["odometry"].key)


def test_the_odometer_is_that_of_the_package():
    ticks = np.random.default_rng(1).integers(-200, 300, (2, 50))
    path = pf.encoder_odometry(2 * np.pi * ticks / 1000, pf.WheelGeometry(0.05, 0.05, 0.3))
    assert np.allclose(drift.odometer(ticks, 1000, 0.05, 0.3), path[:, -1])


def test_the_printed_equation_forgets_where_the_robot_was():
    x, y, theta = 5.0, 5.0, np.pi / 2
    for _ in range(3):
        x, y, theta = np.cos(theta), np.sin(theta), 0.0  # v = 1, omega = 0, no noise
    assert np.allclose((x, y, np.degrees(theta)), ITEMS["printed"].key)


@pytest.mark.parametrize("student", range(10))
def test_a_robot_with_the_keys_errors_ends_where_the_tape_says(student):
    """square: wheels with that delta and beta, driven by the books, miss as printed."""
    item = ITEMS["square"].personal(np.random.default_rng(student))
    delta, beta = np.radians(item.key)
    side = float(item.title.split("sides of ")[1].split()[0])
    ccw, cw = _ends(item.title)
    books, L = pf.WheelGeometry(0.1, 0.1, 0.5), 0.5 / (1 + delta / (np.pi / 2))
    uneven = beta * 0.1 * L / side
    robot = pf.WheelGeometry(0.1 - uneven / 2, 0.1 + uneven / 2, L)
    for x, clockwise in ((ccw, False), (cw, True)):
        end = pf.encoder_odometry(pf.square_turns(side, books, clockwise), robot)[0, -1]
        assert end == pytest.approx(x, abs=4 * side * (abs(delta) + abs(beta)) ** 2)


def _ends(title):
    """x of both squares, as a student reads them."""
    return [float(part.split()[0]) for part in title.split("x = ")[1:]]


def test_the_crossover_is_where_bias_and_slip_are_equal():
    rng, e, s, step = np.random.default_rng(2), 0.02, 0.12, 0.5
    n = round(ITEMS["crossover"].key / step)
    ends = step * (1 + s * rng.standard_normal((4000, n))).sum(axis=1)
    assert ends.std() == pytest.approx(n * step * e, rel=5 / np.sqrt(2 * 4000))


def test_the_drift_is_the_scatter_of_robots():
    n, sd, rng = 10, 0.02, np.random.default_rng(3)
    heading = np.cumsum(sd * rng.standard_normal((n, 20_000)), axis=0)
    sideways = np.sin(heading).sum(axis=0)
    assert sideways.std() == pytest.approx(ITEMS["drift"].key, rel=0.03)
