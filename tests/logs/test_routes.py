"""Routes: open loop by arithmetic, closed loop despite noise."""

import numpy as np
import pytest

import pfkit as pf

STILL = pf.VelocityMotion((0.0,) * 4)
NOISY = pf.VelocityMotion((0.02, 0.01, 0.01, 0.02))
WORLD = pf.LandmarkMap([[0.0, 6.0, 6.0], [0.0, 0.0, 5.0]], bounds=(-1, 7, -1, 6))
SENSOR = pf.RangeBearing(WORLD, sigma_r=0.2, sigma_phi=0.1)
START = np.array([3.0, 2.0, 0.5])
TURN = np.tile(np.array([[0.5], [0.3], [0.1]]), 30)


def rng(seed=0):
    return np.random.default_rng(seed)


def test_commands_cut_time_into_steps_that_add_up():
    u = pf.commands([(0.5, 0.0, 1.0), (0.0, 0.3, 0.25)], dt=0.1)
    np.testing.assert_allclose(u[2], [0.1] * 10 + [0.1, 0.1, 0.05])
    assert u[0] @ u[2] == pytest.approx(0.5)
    assert u[1] @ u[2] == pytest.approx(0.075)


def test_command_lists_drive_the_published_figure():
    """Ahead, quarter turn right, ahead, quarter turn left, ahead: (1, -.5, 0)."""
    quarter = np.pi / 2
    u = pf.commands([(0.5, 0, 1), (0, -quarter, 1), (0.5, 0, 1), (0, quarter, 1), (0.5, 0, 1)], 0.1)
    _, truth = pf.drive(np.zeros(3), u, STILL, rng())
    np.testing.assert_allclose(truth[:, -1], [1.0, -0.5, 0.0], atol=1e-12)


def test_pure_pursuit_stays_on_the_route_despite_noise():
    points = np.array([[0.0, 6.0, 6.0, 0.0], [0.0, 0.0, 4.0, 4.0]])
    driver = pf.PurePursuit(points, v=0.5, dt=0.1, lookahead=0.4)
    _, truth = pf.drive(np.zeros((3, 5, 1)), driver, NOISY, rng(), steps=600)
    x, y = truth[:2, ..., 0]
    to_sides = np.minimum.reduce([np.abs(y), np.abs(y - 4), np.abs(x), np.abs(x - 6)])
    assert to_sides.max() < 0.4
    assert x.max() > 5.8 and y.max() > 3.8  # it went round


def test_pure_pursuit_stops_at_the_end_of_an_open_route():
    driver = pf.PurePursuit([[0.0, 2.0], [0.0, 0.0]], v=0.5, dt=0.1, closed=False)
    u, truth = pf.drive(np.zeros(3), driver, STILL, rng(), steps=60)
    assert (u[0, -15:] == 0).all()
    np.testing.assert_allclose(truth[:, -1], [2.0, 0.0, 0.0], atol=0.06)


def test_pure_pursuit_of_a_batch_is_that_of_its_robots():
    driver = pf.PurePursuit([[0.0, 6.0, 3.0], [0.0, 0.0, 4.0]], v=0.5, dt=0.1)
    poses = rng().uniform(-1, 5, size=(3, 8, 1))
    together = driver(0, poses)
    for b in range(8):
        np.testing.assert_allclose(together[:, b, 0], driver(0, poses[:, b, 0]))


def test_bad_parts_are_named():
    with pytest.raises(pf.ParameterError, match="way-points"):
        pf.PurePursuit([[0, 0, 1], [0, 0, 1]], 1, 0.1)
    with pytest.raises(pf.ParameterError, match="way-points"):
        pf.PurePursuit([[0], [0]], 1, 0.1)
    with pytest.raises(pf.ParameterError, match="last"):
        pf.commands([(1, 0, -1)], 0.1)
    with pytest.raises(pf.ShapeError, match="command"):
        pf.commands([(1, 0)], 0.1)
