"""Composed odometry is the same model as row by row, in fewer pieces."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.logs.odometry import informative_steps

DRIFT = pf.Drift((0.02, 0.001, 1e-4), (0.05, 0.02, 1e-3))


def some_log(T=200, seed=1, every=40):
    rng = np.random.default_rng(seed)
    u = np.stack((rng.uniform(0, 0.4, T), rng.normal(0, 0.6, T), rng.uniform(0.01, 0.05, T)))
    z = [np.ones((3, int((k + 1) % every == 0))) for k in range(T)]
    return pf.Log(np.cumsum(u[2]), u, z, start=np.array([1.0, -2.0, 0.7]))


def rowwise(log, drift, M, seed):
    """The loop twin: every particle takes every row with errors of its own."""
    rng = np.random.default_rng(seed)
    a, q = drift.variances(log.u)
    x = np.zeros((3, M))
    for (v, omega, dt), a_k, q_k in zip(log.u.T, a, q, strict=True):
        early, turn = rng.normal(0, np.sqrt(q_k / 2), (2, M))
        half = omega * dt / 2
        x[2] += half + early
        d = v * dt * np.sinc(half / np.pi) + rng.normal(0, np.sqrt(a_k), M)
        x[0], x[1] = x[0] + d * np.cos(x[2]), x[1] + d * np.sin(x[2])
        x[2] += half + turn
    return x


def test_composed_means_are_those_of_the_exact_arcs():
    log = some_log()
    short = pf.preintegrate(log, DRIFT)
    long = [log.start]
    for u in log.u.T:
        long.append(pf.VelocityMotion().mean(long[-1], u))
    pose = log.start
    for u, step in zip(short.u.T, informative_steps(log), strict=True):
        pose = pf.ComposedMotion().mean(pose, u)
        np.testing.assert_allclose(pose, long[step + 1], atol=1e-12)


def test_only_informative_steps_and_the_last_are_kept():
    log = some_log(T=210)
    assert informative_steps(log).tolist() == [39, 79, 119, 159, 199, 209]
    short = pf.preintegrate(log, DRIFT)
    assert [zk.shape[1] for zk in short.z] == [1, 1, 1, 1, 1, 0]


def test_composed_covariance_agrees_with_small_steps():
    small = pf.Drift(*(tuple(0.01 * np.array(d)) for d in (DRIFT.drive, DRIFT.turn)))
    log, M = some_log(), 40_000
    motion, Sigma = pf.Preintegrated(log.u, small).between(np.array([0]), np.array([len(log)]))
    x = rowwise(log, small, M, seed=5)
    error = pf.between(motion, x)
    error[:2] = x[:2] - motion[:2]
    found = np.cov(error)
    sd = np.sqrt(np.diag(Sigma[..., 0]))
    score = (found - Sigma[..., 0]) / np.outer(sd, sd) * np.sqrt(M)
    # nine entries, variances have standard error sqrt(2): |z| < 6 is false once in 10^4 or less
    assert np.abs(score).max() < 6


def test_pieces_add_up_to_the_whole():
    log = some_log()
    odometer = pf.Preintegrated(log.u, DRIFT)
    i, j, k = np.array([10]), np.array([90]), np.array([180])
    whole, Sigma = odometer.between(i, k)
    first, A = odometer.between(i, j)
    second, B = odometer.between(j, k)
    np.testing.assert_allclose(pf.compose(first, second), whole, atol=1e-12)
    c, s = np.cos(first[2, 0]), np.sin(first[2, 0])
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    lever = R @ np.append(second[:2, 0], 0)
    F = np.array([[1, 0, -lever[1]], [0, 1, lever[0]], [0, 0, 1]])
    np.testing.assert_allclose(F @ A[..., 0] @ F.T + R @ B[..., 0] @ R.T, Sigma[..., 0], atol=1e-12)


def test_samples_have_the_composed_covariance():
    short = pf.preintegrate(some_log(), DRIFT)
    u, M = short.u[:, 1], 50_000
    L = u[3:].reshape(3, 3)
    x = pf.ComposedMotion().sample(np.zeros((3, M)), u, np.random.default_rng(2))
    Sigma, sd = L @ L.T, np.sqrt(np.diag(L @ L.T))
    assert np.abs((np.cov(x) - Sigma) / np.outer(sd, sd) * np.sqrt(M)).max() < 6
    assert np.abs((x.mean(axis=1) - u[:3]) / sd * np.sqrt(M)).max() < 5


def test_a_batch_may_have_a_motion_for_each_filter():
    short = pf.preintegrate(some_log(), DRIFT)
    pose = np.zeros((3, 2, 400))
    u = short.u[:, :2, None]
    both = pf.ComposedMotion().sample(pose, u, np.random.default_rng(3))
    assert both.shape == (3, 2, 400)
    one = pf.ComposedMotion().sample(pose, u[:, 0, 0], np.random.default_rng(3))
    np.testing.assert_allclose(both[:, 0], one[:, 0])
    assert abs(both[:, 1] - one[:, 1]).max() > 1e-3


def test_a_robot_that_stands_still_without_noise_stays():
    log = pf.Log(np.arange(3.0), np.zeros((3, 3)), [np.zeros((3, 0))] * 3)
    short = pf.preintegrate(log, DRIFT)
    x = pf.ComposedMotion().sample(np.ones((3, 5)), short.u[:, 0], np.random.default_rng(0))
    np.testing.assert_allclose(x, 1.0)


def test_filling_in_hits_the_estimates_and_follows_the_odometry():
    log = some_log()
    ends = np.append(0, informative_steps(log) + 1)
    path = pf.compose(log.start[:, None], pf.Preintegrated(log.u, DRIFT).path)
    estimate = path[:, ends, None] * np.ones(4)
    full, sd = pf.fill_in(log, DRIFT, ends, estimate, np.zeros((3, 3, len(ends), 4)))
    assert full.shape == (3, 200, 4) and sd.shape == (200, 4)
    np.testing.assert_allclose(full[..., 0], path[:, 1:], atol=1e-9)
    np.testing.assert_allclose(sd[ends[1:] - 1], 0, atol=1e-7)
    assert (sd[ends[1:-1] + 5] > 0).all()


def test_filled_in_spread_is_that_of_the_particles():
    log, M = some_log(every=1000), 20_000
    rng = np.random.default_rng(4)
    bel = pf.gaussian_prior(M, log.start, (0.3, 0.2, 0.1), rng)
    prior = pf.covariance(bel)[..., None]
    _, sd = pf.fill_in(log, DRIFT, np.array([0]), pf.mean_pose(bel)[:, None], prior)
    small = pf.preintegrate(log, DRIFT)
    moved = pf.predict(bel, small.u[:, 0], pf.ComposedMotion(), rng)
    Sigma = pf.covariance(moved)
    assert sd[-1] == pytest.approx(np.sqrt(Sigma[0, 0] + Sigma[1, 1]), rel=0.03)


@pytest.mark.parametrize("bad", [(-1, 0, 0), (np.nan, 0, 0), (0, 0)])
def test_rates_are_checked(bad):
    with pytest.raises(pf.PfkitError):
        pf.Drift(bad)
