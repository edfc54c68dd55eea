"""Intervals that cover, and tests that fire as often as they say."""

import math

import numpy as np
import pytest

import pfkit as pf


def rng(seed=0):
    return np.random.default_rng(seed)


def test_bootstrap_covers_about_as_often_as_it_claims():
    source, covered, n = rng(1), 0, 300
    for _ in range(n):
        interval = pf.bootstrap_interval(source.normal(3, 1, 40), source, draws=400)
        covered += interval.low <= 3 <= interval.high
    assert 0.87 < covered / n < 0.99  # 95 % nominal, a little short at 40 runs


def test_bootstrap_takes_any_statistic_and_is_reproducible():
    x = rng().exponential(size=60)
    for statistic in (np.mean, np.median, pf.root_mean_square):
        interval = pf.bootstrap_interval(x, rng(2), statistic)
        assert interval.value == pytest.approx(statistic(x))
        assert interval.low < interval.value < interval.high
        assert interval == pf.bootstrap_interval(x, rng(2), statistic)
    constant = pf.bootstrap_interval(np.full(9, 2.0), rng())
    assert constant == (2.0, 2.0, 2.0)


def test_root_mean_square_by_hand():
    assert pf.root_mean_square([3.0, 4.0]) == pytest.approx(math.sqrt(12.5))


def test_wilson_known_values_and_limits():
    value, low, high = pf.wilson_interval(8, 10)
    assert (value, low, high) == pytest.approx((0.8, 0.4902, 0.9433), abs=1e-4)
    assert pf.wilson_interval(0, 20).low == pytest.approx(0.0, abs=1e-12)
    assert pf.wilson_interval(0, 20).high == pytest.approx(0.1611, abs=1e-4)
    assert pf.wilson_interval(20, 20).high == pytest.approx(1.0)


def test_the_paired_test_fires_as_often_as_it_says():
    source, n = rng(3), 300
    p = [
        pf.paired(source.normal(size=15), source.normal(size=15), source, draws=200).p
        for _ in range(n)
    ]
    rejected = np.mean(np.array(p) <= 0.1)
    assert abs(rejected - 0.1) < 4.5 * math.sqrt(0.09 / n)


def test_few_seeds_give_the_exact_permutation_distribution():
    """All of five differences have one sign: 2 of 32 sign patterns are as extreme."""
    c = pf.paired(np.arange(2.0, 7.0), np.zeros(5), rng(), draws=20_000)
    assert c.p == pytest.approx(2 / 32, abs=0.008)
    assert c.wins == 0 and c.difference.value == 4.0


def test_common_random_numbers_sharpen_the_comparison():
    def score(bonus):
        def run(rng):
            luck = rng.normal(0, 5)  # the drive
            return luck + bonus + rng.normal(0, 0.1)  # the filter

        return run

    together = pf.compare(score(0.0), score(0.2), seeds=40)
    assert together.p < 0.01 and together.difference.high < 0
    apart = pf.paired(together.a, np.roll(together.b, 7), rng())
    assert apart.p > 0.05
    width = together.difference.high - together.difference.low
    assert width < 0.1 * (apart.difference.high - apart.difference.low)


def test_equal_runs_differ_by_nothing():
    c = pf.compare(lambda rng: rng.normal(), lambda rng: rng.normal(), seeds=10)
    np.testing.assert_array_equal(c.a, c.b)
    assert c.p == 1.0 and c.difference == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "call",
    [
        lambda: pf.bootstrap_interval([1.0], rng()),
        lambda: pf.bootstrap_interval(np.ones((3, 3)), rng()),
        lambda: pf.bootstrap_interval([1.0, np.nan], rng()),
        lambda: pf.bootstrap_interval([1.0, 2.0], rng(), level=1.0),
        lambda: pf.wilson_interval(3, 2),
        lambda: pf.wilson_interval(1, 0),
        lambda: pf.paired([1.0, 2.0], [1.0, 2.0, 3.0], rng()),
        lambda: pf.compare(lambda r: 0.0, lambda r: 0.0, seeds=1),
    ],
)
def test_bad_input_is_named(call):
    with pytest.raises(ValueError):  # NumPy's own for series of two lengths
        call()


def test_a_comparison_says_who_won_and_how_surely():
    found = pf.paired([1.0, 2.0, 5.0, 2.0], [2.0, 4.0, 4.0, 4.0], rng())
    assert found.wins == 3
    low, high = found.difference.low, found.difference.high
    assert repr(found.difference) == f"-1 [{low:.4g}, {high:.4g}]"
    assert repr(found) == f"A - B = {found.difference!r}, p = {found.p:.2g}, A smaller on 3 of 4"
