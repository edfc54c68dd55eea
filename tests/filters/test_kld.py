"""KLD-sampling: the published bound, its promise, and the filter that adapts."""

import numpy as np
import pytest

import pfkit as pf

WORLD = pf.worlds.arena()
SENSOR = pf.RangeBearing(WORLD, 0.3, 0.1)
MOTION = pf.VelocityMotion((0.02, 0.01, 0.01, 0.02, 0.005, 0.005))


def rng(seed=0):
    return np.random.default_rng(seed)


def test_the_published_number():
    assert pf.kld_bound(100, epsilon=0.05, delta=0.01) == 1347
    assert pf.kld_bound(1) == 1


def test_bound_is_a_chi_square_quantile():
    """P(chi2_{k-1} > 2 eps n) is delta; 100,000 draws, 4 standard errors plus rounding up."""
    for k in (3, 20, 100):
        n = pf.kld_bound(k, epsilon=0.1, delta=0.05)
        above = (rng(k).chisquare(k - 1, 100_000) > 0.2 * n).mean()
        assert above < 0.05 + 4 * np.sqrt(0.05 / 100_000) + 2e-3
        assert above > 0.025


def test_bound_grows_with_cells_and_falls_with_tolerance():
    bound = pf.kld_bound(np.arange(1, 400))
    assert (np.diff(bound) > 0).all() and bound.dtype == np.int64
    assert pf.kld_bound(50, epsilon=0.1) < pf.kld_bound(50, epsilon=0.05)
    assert pf.kld_bound(50, delta=0.1) < pf.kld_bound(50, delta=0.01)


def test_the_promise_holds_for_a_known_belief():
    """k equal cells: the share of sets off by more than eps stays near delta."""
    k, epsilon, delta = 30, 0.05, 0.05
    n = pf.kld_bound(k, epsilon, delta)
    q = rng().multinomial(n, np.full(k, 1 / k), size=20_000) / n
    kl = (q * np.log(np.where(q > 0, q * k, 1.0))).sum(axis=1)
    assert 0.02 < (kl > epsilon).mean() < 0.08


def test_count_is_the_loop_of_the_table():
    state = rng().normal(0, 1.5, (3, 3000))
    cell, least = np.array((0.5, 0.5, 0.5)), 50
    seen = set()
    for n in range(1, 3001):
        seen.add(tuple(np.floor(state[:, n - 1] / cell)))
        if n >= least and n >= pf.kld_bound(len(seen), 0.4):
            break
    assert 50 < n < 3000
    assert pf.kld_count(state, cell, epsilon=0.4, least=least) == n


def test_count_ends_with_what_there_is():
    assert pf.kld_count(WORLD.sample_poses(200, rng())) == 200


def test_filter_shrinks_when_it_knows_and_carries_all_before():
    generator, sizes = rng(2), []
    bel, truth = pf.uniform_prior(20_000, WORLD, generator), pf.worlds.ARENA_START
    for k in range(8):
        u = pf.worlds.arena_route()[:, k]
        truth = MOTION.sample(truth, u, generator)
        z = SENSOR.sample(truth, generator)
        bel, info = pf.kld_step(bel, u, z, MOTION, SENSOR, generator)
        sizes.append(bel.M)
        assert info.ancestors.shape == (bel.M,)
    assert sizes[0] > 10_000 and sizes[-1] < 1500
    assert pf.position_error(pf.mean_pose(bel), truth) < 0.4


def test_first_step_estimates_the_evidence_like_the_plain_filter():
    z = SENSOR.sample(pf.worlds.ARENA_START, rng())[:, :1]
    prior = pf.gaussian_prior(5000, pf.worlds.ARENA_START, (0.5, 0.5, 0.3), rng(1))
    u = (0.5, 0.0, 1.0)
    _, info = pf.kld_step(prior, u, z, MOTION, SENSOR, rng(2), epsilon=0.02)
    _, plain = pf.step(prior, u, z, MOTION, SENSOR, rng(3))
    assert info.log_evidence == pytest.approx(plain.log_evidence, abs=0.15)


def test_without_a_measurement_the_cloud_only_moves():
    bel = pf.from_weights(WORLD.sample_poses(50, rng()), rng().random(50))
    moved, info = pf.kld_step(bel, (1, 0, 1), None, MOTION, SENSOR, rng())
    assert moved.M == 50 and not info.resampled
    np.testing.assert_array_equal(moved.log_w, bel.log_w)


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda: pf.kld_bound(0), pf.ParameterError),
        (lambda: pf.kld_bound(2.5), pf.ParameterError),
        (lambda: pf.kld_bound(5, epsilon=0.0), pf.ParameterError),
        (lambda: pf.kld_bound(5, epsilon=1e-300), pf.ParameterError),
        (lambda: pf.kld_count(np.ones((3, 5)), (1e-300, 1, 1)), pf.ParameterError),
        (lambda: pf.kld_bound(5, delta=1.0), pf.ParameterError),
        (lambda: pf.kld_count(np.ones((3, 2, 5))), pf.ShapeError),
        (lambda: pf.kld_count(np.ones((2, 5))), pf.ShapeError),
        (lambda: pf.kld_count(np.ones((3, 5)), (1, 1, 0)), pf.ParameterError),
        (
            lambda: pf.kld_step(
                pf.uniform_prior((2, 5), WORLD, rng()),
                (0, 0, 1),
                SENSOR.expected(np.zeros(3)),
                MOTION,
                SENSOR,
                rng(),
            ),
            pf.ShapeError,
        ),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call()
