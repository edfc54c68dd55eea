"""Beliefs as weighted particles: log-weight identities, ESS, priors."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import pfkit as pf

log_weights = arrays(float, st.integers(1, 40), elements=st.floats(-700, 700))


def rng(seed=0):
    return np.random.default_rng(seed)


@given(log_weights)
def test_normalised_weights_sum_to_one(log_w):
    normal, log_sum = pf.normalise(log_w)
    assert np.exp(normal).sum() == pytest.approx(1)
    np.testing.assert_allclose(normal + log_sum, log_w, atol=1e-9)


@given(log_weights, st.floats(-1e5, 1e5))
def test_a_common_factor_goes_into_the_sum_only(log_w, factor):
    (a, sum_a), (b, sum_b) = pf.normalise(log_w), pf.normalise(log_w + factor)
    np.testing.assert_allclose(a, b, atol=1e-8)
    assert sum_b - sum_a == pytest.approx(factor, abs=1e-8)


@given(log_weights)
def test_normalising_twice_changes_nothing(log_w):
    once, _ = pf.normalise(log_w)
    twice, log_sum = pf.normalise(once)
    np.testing.assert_allclose(once, twice, atol=1e-12)
    assert log_sum == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("shift", [-1e300, -1e4, 0.0, 1e4])
def test_the_scale_may_be_far_outside_exp(shift):
    log_w, log_sum = pf.normalise(np.log([1.0, 3.0]) + shift)
    assert log_sum == pytest.approx(np.log(4) + shift)
    if abs(shift) < 1e300:  # beyond, the input itself cannot tell 1 from 3
        np.testing.assert_allclose(np.exp(log_w), [0.25, 0.75], rtol=1e-9)


def test_weights_of_zero_stay_zero_and_rows_are_separate():
    log_w, log_sum = pf.normalise(np.array([[0.0, -np.inf], [5.0, 5.0]]))
    np.testing.assert_allclose(np.exp(log_w), [[1, 0], [0.5, 0.5]], rtol=1e-15)
    np.testing.assert_allclose(log_sum, [0, 5 + np.log(2)])


@pytest.mark.parametrize(
    "log_w, words",
    [
        ([-np.inf, -np.inf], "every particle has weight 0"),
        ([0.0, np.nan], "a log-weight is nan"),
        ([np.inf, 0.0], "a log-weight is inf"),
        ([[0.0, 0.0], [-np.inf, -np.inf]], "every particle has weight 0"),
    ],
)
def test_weights_that_cannot_be_normalised_are_named(log_w, words):
    with pytest.raises(pf.DegenerateWeightsError, match=words):
        pf.normalise(np.array(log_w))


@given(log_weights)
def test_ess_identities(log_w):
    normal, _ = pf.normalise(log_w)
    M, w = normal.size, np.exp(normal)
    value = float(pf.ess(normal))
    assert 1 - 1e-9 <= value <= M + 1e-9
    assert value == pytest.approx(M / (1 + w.var() / w.mean() ** 2))
    assert pf.ess(np.concatenate((normal, normal))) == pytest.approx(2 * value)
    assert pf.ess(np.append(normal, -np.inf)) == pytest.approx(value)
    assert pf.ess(normal[::-1]) == pytest.approx(value)


def test_ess_of_equal_and_of_one():
    assert pf.ess(pf.equal_log_weights(50)) == pytest.approx(50)
    assert pf.ess(np.log([1.0]) + 3) == pytest.approx(1)
    np.testing.assert_allclose(pf.ess(pf.equal_log_weights((4, 7))), [7] * 4)


def test_a_set_knows_its_weights():
    bel = pf.from_weights(np.arange(6.0).reshape(3, 2), [1, 3])
    np.testing.assert_allclose(bel.w, [0.25, 0.75])
    assert bel.M == 2 and bel.ess == pytest.approx(1.6)
    assert repr(bel) == "Particles(2 of dimension 3, ESS 1.6)"
    batch = pf.from_weights(np.zeros((3, 4, 5)))
    assert batch.M == 5 and batch.ess.shape == (4,)
    assert repr(batch) == "Particles(4 x 5 of dimension 3, ESS 5.0)"


def test_a_particle_set_reads_lists():
    bel = pf.Particles([[0, 1], [2, 3]], [0.0, -np.inf])
    assert bel.state.dtype == bel.log_w.dtype == float


WORLD = pf.LandmarkMap(np.array([[0.0, 10.0], [0.0, 4.0]]), bounds=(-1, 11, 0, 4))


def test_the_uniform_prior_fills_the_box_evenly():
    x, y, theta = pf.uniform_prior(40_000, WORLD, rng()).state
    for values, low, high in ((x, -1, 11), (y, 0, 4), (theta, -np.pi, np.pi)):
        assert values.min() >= low and values.max() <= high
        counts, _ = np.histogram(values, 20, (low, high))
        chi2 = ((counts - 2000) ** 2 / 2000).sum()
        assert chi2 < 50  # 19 degrees of freedom: false-fail 1e-4, and the seed is fixed
    assert np.abs(np.corrcoef((x, y, theta))[np.triu_indices(3, 1)]).max() < 0.02


def test_the_gaussian_prior_has_its_moments():
    Sigma = np.array(((1.0, 0.3, 0.0), (0.3, 0.5, -0.1), (0.0, -0.1, 0.04)))
    bel = pf.gaussian_prior(60_000, (5.0, -2.0, 0.4), Sigma, rng())
    np.testing.assert_allclose(bel.state.mean(axis=1), (5.0, -2.0, 0.4), atol=0.02)
    np.testing.assert_allclose(np.cov(bel.state), Sigma, atol=0.02)
    assert bel.ess == pytest.approx(60_000)


def test_the_gaussian_prior_wraps_headings_only():
    bel = pf.gaussian_prior(1000, (0.0, 50.0, np.pi), (0, 0, 0.5), rng())
    assert np.abs(bel.state[2]).max() <= np.pi and (bel.state[2] < 0).any()
    np.testing.assert_array_equal(bel.state[1], 50.0)
    line = pf.gaussian_prior(10, (0.0, 0.0, 9.0), (0, 0, 0), rng(), heading=False)
    np.testing.assert_array_equal(line.state[2], 9.0)
    assert pf.gaussian_prior((2, 5), (0.0, 0.0), (1, 1), rng()).state.shape == (2, 2, 5)


@pytest.mark.parametrize("Sigma", [[[1, 2], [2, 1]], [[1, 0.5], [0, 1]]])
def test_a_matrix_that_is_no_covariance_is_named(Sigma):
    with pytest.raises(pf.ParameterError, match="eigenvalues"):
        pf.gaussian_prior(5, (0.0, 0.0), Sigma, rng())


def test_a_batch_of_one_prior_is_a_single_one():
    for draw in (
        lambda M: pf.uniform_prior(M, WORLD, rng(1)),
        lambda M: pf.gaussian_prior(M, (0.0, 1.0, 2.0), (1, 1, 1), rng(1)),
    ):
        np.testing.assert_array_equal(draw((1, 30)).state[:, 0], draw(30).state)


def test_a_set_without_particles_is_refused():
    with pytest.raises(pf.ShapeError, match="M >= 1"):
        pf.Particles(np.zeros((3, 0)), np.zeros(0))
