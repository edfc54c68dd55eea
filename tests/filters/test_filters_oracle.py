"""The particle filter against two exact answers: Kalman's, and the grid's.

A particle filter's error shrinks as 1 / sqrt(M), so every bound here is a Monte-Carlo bound: the
mean over a batch of independent filters must be within 4 of its own standard errors (two-sided
false-fail rate below 1e-4 each), plus the bias of order 1 / M that is stated beside it.
"""

from functools import cache

import numpy as np
import pytest

import pfkit as pf

B, M = 200, 400


def rng(seed=0):
    return np.random.default_rng(seed)


def within(values, exact, bias=0.0):
    """The mean over filters is exact up to 4 standard errors and a stated bias."""
    error = np.mean(values) - exact
    return abs(error) <= 4 * np.std(values) / np.sqrt(len(values)) + bias


class LinearMotion:
    """x' = F x + u + root noise, for a state of two."""

    F = np.array([[1.0, 0.5], [0.0, 0.9]])
    root = np.array([[0.5, 0.0], [0.2, 0.4]])

    def mean(self, state, u):
        return np.tensordot(self.F, state, axes=1) + u.reshape(2, *(1,) * (state.ndim - 1))

    def sample(self, state, u, rng):
        return self.mean(state, u) + np.tensordot(
            self.root, rng.standard_normal(state.shape), axes=1
        )


SIGMA_Z = np.diag((0.5, 0.3))
U = np.array([[0.3, -0.2, 0.5, 0.1, 0.0, -0.4], [0.1, 0.2, -0.3, 0.0, 0.2, 0.1]])
Z = np.array([[1.5, 1.2, 2.6, 2.0, 2.9, 1.6], [-0.8, 0.4, -0.9, 0.6, 0.1, 0.3]])
PRIOR = pf.Gaussian((1.0, -1.0), [[2.0, 0.3], [0.3, 1.0]])


@cache
def kalman():
    """Mean, covariance and total log evidence of the linear world."""
    bel, total, motion = PRIOR, 0.0, LinearMotion()
    for u, z in zip(U.T, Z.T, strict=True):
        bel = pf.kalman_predict(bel, motion.F, motion.root @ motion.root.T, u)
        bel, log_evidence, _ = pf.kalman_update(bel, z, np.eye(2), SIGMA_Z)
        total += log_evidence
    return bel, total


@cache
def particle_filters(scheme, threshold):
    bel = pf.gaussian_prior((B, M), PRIOR.mean, PRIOR.Sigma, rng(1))
    log = pf.Log(np.arange(6.0), U, [z[:, None] for z in Z.T])
    sensor = pf.Position(np.sqrt(np.diag(SIGMA_Z)))
    return pf.run(log, bel, LinearMotion(), sensor, rng(2), scheme, threshold)


SETTINGS = pytest.mark.parametrize(
    "scheme, threshold",
    [
        (pf.systematic, 0.5),
        (pf.stratified, 1.0),
        (pf.residual, 1.0),
        (pf.multinomial, 1.0),
        (pf.systematic, 0.0),
    ],
    ids=lambda value: getattr(value, "__name__", value),
)


@SETTINGS
def test_mean_is_kalmans(scheme, threshold):
    exact, history = kalman()[0], particle_filters(scheme, threshold)
    for d in range(2):  # self-normalised weights: bias of order 1 / ESS
        assert within(history.estimate[d, -1], exact.mean[d], bias=3 / M)


@SETTINGS
def test_covariance_is_kalmans(scheme, threshold):
    exact, history = kalman()[0], particle_filters(scheme, threshold)
    for i, j in ((0, 0), (0, 1), (1, 1)):  # a sample variance is low by a factor 1 - 1 / ESS
        bias = 6 * abs(exact.Sigma[i, j]) / M + 3 / M
        assert within(history.covariance[i, j, -1], exact.Sigma[i, j], bias)


@SETTINGS
def test_evidence_is_unbiased_and_is_kalmans(scheme, threshold):
    """Not the log: the mean of the product of step evidences is the exact one."""
    ratio = np.exp(particle_filters(scheme, threshold).log_evidence.sum(axis=0) - kalman()[1])
    assert within(ratio, 1.0)


def test_error_falls_as_one_over_root_m():
    """RMS error of the mean at M = 100 and 1600 differs by a factor near 4."""
    log = pf.Log(np.arange(6.0), U, [z[:, None] for z in Z.T])
    errors = []
    for m in (100, 1600):
        bel = pf.gaussian_prior((B, m), PRIOR.mean, PRIOR.Sigma, rng(3))
        history = pf.run(log, bel, LinearMotion(), pf.Position(np.sqrt(np.diag(SIGMA_Z))), rng(4))
        errors.append(np.sqrt(np.mean((history.estimate[0, -1] - kalman()[0].mean[0]) ** 2)))
    assert 2.8 < errors[0] / errors[1] < 5.6


WORLD = pf.worlds.arena()
START = pf.worlds.ARENA_START
MOTION = pf.VelocityMotion((0.05, 0.02, 0.02, 0.05, 0.02, 0.02))
SENSOR = pf.RangeBearing(WORLD, 0.5, 0.3)
BOUNDS = (0.0, 9.0, -1.0, 6.0)


@cache
def small_drive():
    """Three steps of 0.75 m, one landmark measured at each."""
    generator, pose, z = rng(0), START, []
    u = pf.worlds.arena_route()[:, :3] * np.array([[1.0], [1.0], [3.0]])
    for k in range(3):
        pose = MOTION.sample(pose, u[:, k], generator)
        z.append(SENSOR.sample(pose, generator)[:, [k]])
    return pf.Log(np.arange(3.0), u, z)


def run_grid(shape):
    """The grid's posterior after the drive, and its total log evidence."""
    grid = pf.gaussian_grid(shape, BOUNDS, START, (0.4, 0.4, 0.3))
    generator, total = rng(3), 0.0
    for _, u, z, _ in small_drive():
        grid = pf.predict_by_convolution(grid, u, MOTION, generator)
        grid, log_evidence = pf.update_grid(grid, z, SENSOR)
        total += log_evidence
    return grid, total


@cache
def oracle():
    """The finer grid, how far halving the cells moved it, and its log evidence extrapolated to
    cells of size zero."""
    (coarse, before), (grid, after) = (run_grid(shape) for shape in ((27, 21, 27), (54, 42, 54)))
    moved = pf.refinement(coarse, grid)
    return grid, moved, after + (after - before) / 3, abs(after - before) / 3


@cache
def clouds(m):
    bel = pf.gaussian_prior((100, m), START, (0.4, 0.4, 0.3), rng(5))
    return pf.run(small_drive(), bel, MOTION, SENSOR, rng(6), threshold=0.5)


def test_grid_has_converged():
    grid, moved, _, _ = oracle()
    assert moved <= 0.01 and grid.lost < 1e-3


def test_divergence_from_the_grid_is_within_the_monte_carlo_bound():
    """KL(cloud || grid) is chance and the grid's own error, and falls with M."""
    grid, moved, _, _ = oracle()
    means = []
    for m in (500, 4000):
        d = pf.kl_divergence(clouds(m).bel, grid, bins=32)
        means.append(d.kl.mean())
        # resampled particles are not independent: allow as much again as counting noise brings
        assert d.kl.mean() < 2 * d.bias.mean() + 2 * moved
    assert means[1] < 0.5 * means[0]


def test_mean_and_spread_are_the_grids():
    cells, bel = oracle()[0].particles(), clouds(4000).bel
    for d in range(3):
        assert within(pf.mean_pose(bel)[d], pf.mean_pose(cells)[d], bias=0.02)
        sd = np.sqrt(pf.covariance(bel)[d, d])
        assert within(sd, np.sqrt(pf.covariance(cells)[d, d]), bias=0.03)


def test_evidence_is_the_grids():
    _, _, exact, error = oracle()
    ratio = np.exp(clouds(4000).log_evidence.sum(axis=0) - exact)
    assert within(ratio, 1.0, bias=2 * error)


def test_a_wrong_model_is_seen():
    """The same test must fail for a filter that is wrong: bearings read with the wrong sign."""
    grid = oracle()[0]
    z = [zk * np.array([[1.0], [-1.0], [1.0]]) for zk in small_drive().z]
    log = pf.Log(np.arange(3.0), small_drive().u, z)
    bel = pf.gaussian_prior((20, 2000), START, (0.4, 0.4, 0.3), rng(5))
    wrong = pf.run(log, bel, MOTION, SENSOR, rng(6))
    assert pf.kl_divergence(wrong.bel, grid, bins=32).low.min() > 0.1


def test_gaussian_filters_agree_with_the_grid_where_the_world_is_nearly_linear():
    grid, _, exact, _ = oracle()
    for transform in (pf.linearise, pf.unscented):
        history = pf.run_gaussian(
            small_drive(), pf.Gaussian(START, (0.4, 0.4, 0.3)), MOTION, SENSOR, transform
        )
        assert history.log_evidence.sum() == pytest.approx(exact, abs=0.4)
        assert history.estimate[:, -1] == pytest.approx(pf.mean_pose(grid.particles()), abs=0.15)
