"""Consistency of errors whose law we choose."""

import math

import numpy as np
import pytest

import pfkit as pf


def rng(seed=0):
    return np.random.default_rng(seed)


SIGMA = np.array([[2.0, 0.5, 0.1], [0.5, 1.0, 0.2], [0.1, 0.2, 0.3]])


def errors(n, scale=1.0, seed=0):
    """Errors (3, n) of covariance scale^2 SIGMA, and the claims (3, 3, n)."""
    e = scale * np.linalg.cholesky(SIGMA) @ rng(seed).standard_normal((3, n))
    return e, np.repeat(SIGMA[..., None], n, axis=2)


def test_nees_matches_a_loop():
    e, Sigma = errors(7)
    by_hand = [e[:, i] @ np.linalg.inv(Sigma[..., i]) @ e[:, i] for i in range(7)]
    np.testing.assert_allclose(pf.nees(e, Sigma), by_hand)
    np.testing.assert_allclose(pf.nees(e[:, 0], SIGMA), by_hand[0])


def test_honest_errors_lie_in_the_band_and_confident_ones_above():
    low, high = pf.nees_band(3, 500, level=0.9999)
    assert low < 3 < high
    assert low < pf.nees(*errors(500)).mean() < high
    assert pf.nees(*errors(500, scale=1.3)).mean() > high
    assert pf.nees(*errors(500, scale=0.8)).mean() < low


def test_coverage_of_honest_and_of_confident_claims():
    honest = pf.coverage(*errors(2000), level=0.9)
    assert abs(honest.value - 0.9) < 4.5 * math.sqrt(0.09 / 2000)
    assert pf.coverage(*errors(2000, scale=1.5), level=0.9).high < 0.9


def test_credibility_of_an_exact_posterior_is_uniform():
    """Truth and cloud are drawn from one law, so the truth's rank in it is uniform."""
    B, M = 400, 300
    root = np.linalg.cholesky(SIGMA * 0.05)
    state = np.tensordot(root, rng(1).standard_normal((3, B, M)), axes=1)
    truth = root @ rng(2).standard_normal((3, B))
    c = np.sort(pf.credibility(pf.from_weights(state), truth))
    gap = np.abs(c - (np.arange(B) + 0.5) / B).max()
    assert gap < 2.2 / math.sqrt(B)  # Kolmogorov: false alarm 1e-4
    confident = np.sort(pf.credibility(pf.from_weights(0.5 * state), truth))
    assert np.abs(confident - (np.arange(B) + 0.5) / B).max() > 2.2 / math.sqrt(B)


def test_credibility_of_a_batch_is_that_of_its_runs():
    bel = pf.from_weights(rng().normal(size=(3, 4, 50)), rng(1).random((4, 50)))
    truth = rng(2).normal(size=(3, 4))
    together = pf.credibility(bel, truth)
    np.testing.assert_array_equal(together, pf.credibility(bel, truth[..., None]))
    for b in range(4):
        one = pf.from_weights(bel.state[:, b], bel.w[b])
        assert pf.credibility(one, truth[:, b]) == pytest.approx(together[b])


def test_the_centre_of_a_cloud_is_all_inside_and_a_far_truth_all_outside():
    bel = pf.from_weights(rng().normal(size=(3, 200)) * 0.1)
    assert pf.credibility(bel, pf.mean_pose(bel)) == 0.0
    assert pf.credibility(bel, [9.0, 9.0, 0.0]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda: pf.nees(np.zeros(3), np.zeros((3, 3))), pf.ParameterError),
        (lambda: pf.nees(np.zeros(3), np.eye(2)), pf.ShapeError),
        (lambda: pf.nees(np.full(3, np.nan), np.eye(3)), pf.ParameterError),
        (lambda: pf.nees_band(0, 10), pf.ParameterError),
        (lambda: pf.nees_band(3, 10, level=1.5), pf.ParameterError),
        (lambda: pf.coverage(np.zeros(3), np.eye(3)), pf.ShapeError),
        (lambda: pf.coverage(np.zeros((3, 1)), np.eye(3)[..., None], level=0), pf.ParameterError),
        (
            lambda: pf.credibility(pf.from_weights(np.ones((3, 5)) * np.arange(5)), np.zeros(2)),
            pf.ShapeError,
        ),
        (lambda: pf.credibility(pf.from_weights(np.ones((3, 5))), np.zeros(3)), pf.ParameterError),
        (lambda: pf.credibility(pf.from_weights(np.eye(3)), np.zeros((3, 4))), pf.ShapeError),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call()
