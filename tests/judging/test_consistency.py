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


@pytest.mark.parametrize(
    ("call", "error"),
    [
        (lambda: pf.nees(np.zeros(3), np.zeros((3, 3))), np.linalg.LinAlgError),
        (lambda: pf.nees(np.zeros(3), np.eye(2)), pf.ShapeError),
        (lambda: pf.nees(np.ones(2), [[1.0, 0.9], [0.0, 1.0]]), pf.ParameterError),
        (lambda: pf.nees(np.full(3, np.nan), np.eye(3)), pf.ParameterError),
        (lambda: pf.nees_band(0, 10), pf.ParameterError),
        (lambda: pf.nees_band(3, 10, level=1.5), pf.ParameterError),
        (lambda: pf.coverage(np.zeros((3, 1)), np.eye(3)[..., None], level=1), pf.ParameterError),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call()
