"""The smoother against one big conditioning, and both histories against the truth."""

from dataclasses import replace

import numpy as np
import pytest

import pfkit as pf

WORLD = pf.worlds.arena()
MOTION = pf.VelocityMotion((0.02, 0.01, 0.01, 0.02, 0.005, 0.005))
SENSOR = pf.RangeBearing(WORLD, 0.3, 0.1)


def drive(seed, T=40, every=5):
    rng = np.random.default_rng(seed)
    u = pf.worlds.arena_route()[:, :T]
    pose = start = pf.worlds.ARENA_START + rng.standard_normal(3) * (0.2, 0.2, 0.1)
    truth, z = [], []
    for k in range(T):
        pose = MOTION.sample(pose, u[:, k], rng)
        truth.append(pose)
        z.append(SENSOR.sample(pose, rng)[:, :2] if k % every == 0 else np.empty((3, 0)))
    t = np.arange(T) * 0.25
    return pf.Log(t, u, z, np.stack(truth, axis=1), start, WORLD)


PRIOR = pf.Gaussian(pf.worlds.ARENA_START, (0.2, 0.2, 0.1))


def nees(history):
    error = pf.pose_error(history.estimate, history.truth)
    return np.einsum("it,tij,jt->t", error, np.linalg.inv(history.covariance.T), error)


def test_smoother_equals_least_squares_on_a_linear_world():
    """A random walk in the plane: the smoothed means solve one tridiagonal system."""
    motion = pf.FixedTarget(0.3)
    sensor = pf.Position(sigma=0.5)
    z = np.random.default_rng(0).standard_normal((2, 12)).cumsum(axis=1)
    T = z.shape[1]
    log = pf.Log(np.arange(T) * 1.0, np.zeros((3, T)), [z[:, [k]] for k in range(T)])
    smooth = pf.rts_smooth(pf.run_gaussian(log, pf.Gaussian((0, 0), (2.0, 2.0)), motion, sensor))
    step = motion.sample(np.zeros((2, 200_000)), np.zeros(3), np.random.default_rng(1)).var()
    information = np.eye(T) / 0.25
    for k in range(T - 1):
        information[k : k + 2, k : k + 2] += np.array([[1, -1], [-1, 1]]) / step
    information[0, 0] += 1 / (4 + step)
    expected = np.linalg.solve(information, z.T / 0.25).T
    np.testing.assert_allclose(smooth.estimate, expected, atol=0.01)
    np.testing.assert_allclose(
        smooth.covariance[0, 0], np.diag(np.linalg.inv(information)), rtol=0.01
    )


@pytest.mark.parametrize("transform", [pf.linearise, pf.unscented])
def test_filter_and_smoother_are_consistent_and_the_smoother_is_closer(transform):
    """40 drives. Mean NEES of a right filter is 3; its mean over drives has sd below .2."""
    squares, consistency = [], []
    for seed in range(40):
        history = pf.run_gaussian(drive(seed), PRIOR, MOTION, SENSOR, transform)
        smooth = pf.rts_smooth(history)
        both = (history, smooth)
        squares.append([np.mean(pf.position_error(h.estimate, h.truth) ** 2) for h in both])
        consistency.append([nees(h).mean() for h in both])
    squares, consistency = np.array(squares), np.array(consistency)
    gain = squares[:, 0] - squares[:, 1]
    assert gain.mean() > 3 * gain.std() / np.sqrt(40)
    assert (np.abs(consistency.mean(axis=0) - 3) < 0.8).all()


def test_smoother_never_knows_less():
    history = pf.run_gaussian(drive(1), PRIOR, MOTION, SENSOR)
    smooth = pf.rts_smooth(history)
    assert (smooth.position_sd <= history.position_sd + 1e-9).all()
    np.testing.assert_array_equal(smooth.estimate[:, -1], history.estimate[:, -1])


def test_known_start_and_no_noise_smooth_to_the_path_itself():
    log = drive(2)
    still = pf.VelocityMotion((0.0, 0.0, 0.0, 0.0))
    history = pf.run_gaussian(log, pf.Gaussian(log.start, (0, 0, 0)), still, SENSOR)
    smooth = pf.rts_smooth(history)
    np.testing.assert_allclose(smooth.estimate, history.estimate)
    assert "rejected" in repr(smooth)


def test_gate_guards_a_good_belief():
    log = drive(3)
    z = [zk.copy() for zk in log.z]
    for k in range(10, 40, 10):
        z[k][0] += 4.0
    bad = replace(log, z=z)
    gated = pf.run_gaussian(bad, PRIOR, MOTION, SENSOR, gate=9.21)
    naive = pf.run_gaussian(bad, PRIOR, MOTION, SENSOR)
    assert gated.rejected.sum() >= 6
    assert pf.rmse(gated.estimate, bad.truth) < 0.5 * pf.rmse(naive.estimate, bad.truth)
