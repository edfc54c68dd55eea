"""Calibration finds the errors that were put in."""

from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.logs.calibration import fit_bearing_bias, fit_odometry, fit_range_bias

DATA = Path(__file__).parents[2] / "data"


def drive(speed=1.0, turn=1.0, delay=0.0, T=3000, dt=0.04, seed=0, noise=0.0):
    """A log whose truth differs from its commands by the given errors."""
    rng = np.random.default_rng(seed)
    t = dt * np.arange(T)
    v, omega = 0.2 + 0.1 * np.sin(0.7 * t), 0.5 * np.sin(0.4 * t + 1)
    u = np.stack((v, omega, np.full(T, dt)))
    u[2, 0] = 0.0
    lag = round(delay / dt)
    held = np.arange(T) - lag
    pose, truth = np.zeros(3), np.empty((3, T))
    for k in range(T):
        moves = (held[k] > 0) * u[2, k]
        command = u[:2, max(held[k], 0)] * (speed, turn)
        pose = pf.VelocityMotion().mean(pose, np.array([*command, moves]))
        truth[:, k] = pose + noise * rng.standard_normal(3)
    return pf.Log(t, u, [np.empty((3, 0))] * T, truth=truth, start=np.zeros(3))


@pytest.mark.parametrize("errors", [(1, 1, 0), (0.88, 0.93, 0.24), (1.1, 0.95, 0.08), (1, 1, 0.4)])
def test_scales_and_delay_are_recovered(errors):
    fitted = fit_odometry(drive(*errors))
    assert (fitted.speed, fitted.turn, fitted.delay) == pytest.approx(errors, abs=0.01)


def test_noise_in_the_truth_does_not_bias_the_fit():
    fitted = fit_odometry(drive(0.9, 0.95, 0.2, noise=0.002))
    assert (fitted.speed, fitted.turn, fitted.delay) == pytest.approx((0.9, 0.95, 0.2), abs=0.02)


def test_a_truth_that_points_backwards_for_a_while_is_left_out():
    log = drive(0.9, 0.95, 0.2)
    log.truth[2, 800:1000] += np.pi
    log.truth[:, 2000:2100] = np.nan
    fitted = fit_odometry(log)
    assert (fitted.speed, fitted.turn, fitted.delay) == pytest.approx((0.9, 0.95, 0.2), abs=0.02)


def test_applying_the_calibration_removes_the_drift():
    log = drive(0.9, 0.95, 0.2)
    better = fit_odometry(log).apply(log)
    before = pf.rmse(pf.dead_reckoning(log, pf.VelocityMotion()), log.truth)
    after = pf.rmse(pf.dead_reckoning(better, pf.VelocityMotion()), log.truth)
    assert after < 0.05 * before


def test_no_calibration_changes_nothing():
    log = drive()
    np.testing.assert_allclose(pf.Calibration().apply(log).u[:2, 1:], log.u[:2, 1:], atol=1e-12)


def test_the_twin_is_found_out():
    log = pf.load_mrclam(DATA / "mrclam_twin")
    c = pf.calibrate(log[: len(log) // 3])
    assert c.speed == pytest.approx(0.90, abs=0.05)  # slips lower it
    assert c.turn == pytest.approx(0.95, abs=0.05)
    assert c.delay == pytest.approx(0.22, abs=0.08)
    assert c.bearing_bias == pytest.approx(-0.007, abs=0.002)


@pytest.mark.parametrize("bias", [0.0, -0.05])
def test_bearing_bias_in_spite_of_outliers(bias):
    rng = np.random.default_rng(2)
    world = pf.LandmarkMap(np.array([[3.0, 5.0], [1.0, -2.0]]))
    sensor = pf.RangeBearing(world, 0.1, 0.02, bias_phi=bias)
    truth = world.sample_poses(500, rng)
    z = [sensor.sample(x, rng) for x in truth.T]
    for k in range(0, 500, 20):
        z[k][1] += 2.0
    log = pf.Log(np.arange(500.0), np.zeros((3, 500)), z, truth=truth, world=world)
    assert fit_bearing_bias(log) == pytest.approx(bias, abs=0.003)


def test_range_bias_by_beacon_and_a_silent_one_gets_the_median():
    rng = np.random.default_rng(3)
    world = pf.LandmarkMap(np.array([[0, 50, 0, 50.0], [0, 0, 50, 50]]), ids=[7, 3, 5, 9])
    sensor = pf.Range(world, 1.5, bias=np.array([2.0, 3.0, 4.0, 9.0]))
    truth = world.sample_poses(900, rng)
    z = [sensor.sample(x, rng)[:, :3] for x in truth.T]
    log = pf.Log(np.arange(900.0), np.zeros((3, 900)), z, truth=truth, world=world)
    np.testing.assert_allclose(fit_range_bias(log), [2, 3, 4, 3], atol=0.3)


def test_a_robot_that_stands_cannot_be_calibrated():
    log = drive(T=400)
    standing = pf.Log(log.t, log.u, log.z, truth=np.zeros_like(log.truth), world=log.world)
    with pytest.raises(pf.DataError, match="less than a metre"):
        fit_odometry(standing)


def test_truth_is_needed():
    log = drive(T=400)
    with pytest.raises(pf.DataError, match="has none"):
        pf.calibrate(pf.Log(log.t, log.u, [np.ones((3, 1))] * len(log)))
