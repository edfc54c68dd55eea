"""Differential drive and bicycle: their arcs, limits and noise."""

import math

import numpy as np
import pytest

import pfkit as pf

DRIVE = pf.DifferentialDrive(r=0.1, L=0.5, alpha=0.02)
BIKE = pf.Bicycle(L=1.2, alpha=0.01, sigma_delta=0.05)


def test_wheel_speeds_agree_with_the_velocity_model():
    u_l, u_r, dt = 4.0, 6.0, 0.7
    pose = np.array((1.0, 2.0, 0.4))
    u = (0.1 * (u_l + u_r) / 2, 0.1 * (u_r - u_l) / 0.5, dt)
    np.testing.assert_allclose(
        DRIVE.mean(pose, (u_l, u_r, dt)), pf.VelocityMotion().mean(pose, u), rtol=1e-14
    )


def test_equal_wheels_go_straight_and_opposite_wheels_turn_on_the_spot():
    pose = np.array((1.0, 2.0, 0.0))
    np.testing.assert_array_equal(DRIVE.mean(pose, (5.0, 5.0, 2.0)), (2.0, 2.0, 0.0))
    np.testing.assert_allclose(DRIVE.mean(pose, (-1.0, 1.0, 1.0)), (1.0, 2.0, 0.4), rtol=1e-15)


def test_one_wheel_held_is_the_centre_of_the_circle():
    """With the left wheel at rest the robot turns about it."""
    end = DRIVE.mean(np.zeros(3), (0.0, math.pi * 0.5 / 0.1, 1.0))  # half a turn
    np.testing.assert_allclose(end[:2], (0.0, 0.5), atol=1e-15)


def test_a_slipping_wheel_spoils_speed_and_turn_together():
    """Only the right wheel turns: its slip makes errors of v and omega proportional."""
    M = 2_000
    moved = DRIVE.sample(np.zeros((3, M)), (0.0, 5.0, 0.2), np.random.default_rng(0))
    turn = 2 * np.arctan2(moved[1], moved[0])
    distance = np.hypot(moved[0], moved[1]) / np.sinc(turn / 2 / np.pi)
    np.testing.assert_allclose(distance, turn * 0.5 / 2, rtol=1e-9)  # v = omega L / 2
    slip = turn / (0.1 / 0.5 * 5.0 * 0.2) - 1
    assert slip.var() == pytest.approx(0.02, rel=5 * math.sqrt(2 / M))


def test_body_disturbances_act_at_rest_and_slip_does_not():
    rng = np.random.default_rng(1)
    pose = np.array((1.0, 2.0, 0.4))
    np.testing.assert_array_equal(DRIVE.sample(pose, (0.0, 0.0, 1.0), rng), pose)
    shaken = pf.DifferentialDrive(r=0.1, L=0.5, sigma_v=0.1, sigma_omega=0.15)
    M = 20_000
    moved = shaken.sample(np.zeros((3, M)), (0.0, 0.0, 2.0), rng)
    assert moved[2].std() == pytest.approx(0.3, rel=5 / math.sqrt(2 * M))
    chord = np.hypot(moved[0], moved[1]) / np.sinc(moved[2] / 2 / np.pi)
    assert np.sqrt(np.mean(chord**2)) == pytest.approx(0.2, rel=5 / math.sqrt(2 * M))


def test_the_bicycle_rolls_about_the_centre_that_its_axles_point_at():
    """Both axles' lines meet in the centre of the circle: radius L / tan(delta)."""
    delta = 0.3
    radius = 1.2 / math.tan(delta)
    end = BIKE.mean(np.zeros(3), (radius * math.pi, delta, 1.0))  # half the circle
    np.testing.assert_allclose(end[:2], (0.0, 2 * radius), atol=1e-12)
    front0 = np.array((1.2, 0.0))
    front1 = end[:2] + 1.2 * np.array((math.cos(end[2]), math.sin(end[2])))
    centre = np.array((0.0, radius))
    assert np.hypot(*(front1 - centre)) == pytest.approx(np.hypot(*(front0 - centre)))


def test_the_bicycle_goes_straight_and_stays_parked():
    pose = np.array((1.0, 2.0, 0.0))
    np.testing.assert_array_equal(BIKE.mean(pose, (0.5, 0.0, 2.0)), (2.0, 2.0, 0.0))
    parked = BIKE.sample(np.tile(pose[:, None], 5), (0.0, 0.4, 1.0), np.random.default_rng(2))
    np.testing.assert_array_equal(parked, np.tile(pose[:, None], 5))


def test_the_bicycles_noise_is_in_speed_and_steering():
    M = 20_000
    moved = BIKE.sample(np.zeros((3, M)), (1.0, 0.2, 0.5), np.random.default_rng(3))
    turn = 2 * np.arctan2(moved[1], moved[0])
    distance = np.hypot(moved[0], moved[1]) / np.sinc(turn / 2 / np.pi)
    delta = np.arctan(1.2 * turn / distance)
    assert (distance / 0.5).var() == pytest.approx(0.01, rel=5 * math.sqrt(2 / M))
    assert delta.std() == pytest.approx(0.05, rel=5 / math.sqrt(2 * M))
    assert abs(delta.mean() - 0.2) < 5 * 0.05 / math.sqrt(M)


@pytest.mark.parametrize("motion, u", [(DRIVE, (3.0, 5.0, 0.5)), (BIKE, (1.0, 0.3, 0.5))])
def test_shapes_and_equivariance(motion, u):
    pose, g = np.random.default_rng(4).normal(size=(3, 4, 7)), (3.0, -1.0, 2.0)
    each = np.array(u)[:, None, None] * np.ones((3, 4, 1))
    moved = motion.sample(pf.compose(g, pose), each, np.random.default_rng(5))
    same = pf.compose(g, motion.sample(pose, u, np.random.default_rng(5)))
    np.testing.assert_allclose(moved[:2], same[:2], atol=1e-13)
    np.testing.assert_allclose(pf.wrap(moved[2] - same[2]), 0.0, atol=1e-13)
    assert motion.mean(np.zeros(3), u).shape == (3,)


def test_bad_vehicles_and_bad_steering_are_named():
    with pytest.raises(pf.ParameterError, match="L must be finite and > 0"):
        pf.DifferentialDrive(r=0.1, L=0.0)
    with pytest.raises(pf.ParameterError, match="sigma_omega"):
        pf.DifferentialDrive(r=0.1, L=0.5, sigma_omega=-1.0)
    with pytest.raises(pf.ParameterError, match="sigma_delta"):
        pf.Bicycle(L=1.0, sigma_delta=-0.1)
    with pytest.raises(pf.ParameterError, match="radians"):
        BIKE.mean(np.zeros(3), (1.0, 30.0, 0.1))
