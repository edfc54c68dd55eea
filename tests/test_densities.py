"""Chi-square values against tables and draws."""

import math

import numpy as np
import pytest

import pfkit as pf


def rng(seed=0):
    return np.random.default_rng(seed)


@pytest.mark.parametrize(
    ("p", "k", "x"),
    [
        (0.95, 1, 3.841459),
        (0.95, 2, 5.991465),
        (0.95, 3, 7.814728),
        (0.99, 4, 13.276704),
        (0.025, 10, 3.246973),
        (0.5, 100, 99.334129),
        (0.975, 600, 669.769),
    ],
)
def test_chi2_quantiles_are_those_of_the_tables(p, k, x):
    assert pf.chi2_quantile(p, k) == pytest.approx(x, abs=2e-3 if k == 600 else 2e-6)
    assert pf.chi2_tail(pf.chi2_quantile(p, k), k) == pytest.approx(1 - p, abs=1e-9)


def test_chi2_agrees_with_draws_and_knows_its_limits():
    x = (rng().standard_normal((5, 20_000)) ** 2).sum(axis=0)
    for level in (1.0, 4.0, 9.0):
        p = pf.chi2_tail(level, 5)
        assert abs(np.mean(x > level) - p) < 4.5 * math.sqrt(p * (1 - p) / x.size)
    assert pf.chi2_tail(-1.0, 3) == 1.0
    assert [pf.chi2_tail(math.inf, k) for k in (1, 2, 3, 8)] == [0.0] * 4
    assert pf.chi2_quantile(0.0, 3) == pytest.approx(0.0, abs=1e-9)
    with pytest.raises(pf.ParameterError):
        pf.chi2_quantile(1.0, 3)
    with pytest.raises(pf.ParameterError):
        pf.chi2_tail(math.nan, 3)
