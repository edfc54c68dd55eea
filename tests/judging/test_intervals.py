"""Intervals cover as often as they say, with few runs and with runs that share a world."""

from __future__ import annotations

import math

import numpy as np
import pytest

import pfkit as pf


@pytest.mark.parametrize(
    "level, freedom, tabled",
    [(0.95, 1, 12.706), (0.95, 2, 4.303), (0.95, 4, 2.776), (0.95, 9, 2.262), (0.95, 30, 2.042),
     (0.99, 3, 5.841), (0.9, 10, 1.812), (0.5, 1, 1.0)],
)  # fmt: skip
def test_quantiles_are_those_of_the_tables(level, freedom, tabled):
    assert pf.t_quantile(level, freedom) == pytest.approx(tabled, abs=6e-4)


def test_with_many_runs_it_is_the_normal_quantile():
    assert pf.t_quantile(0.95, 100_000) == pytest.approx(1.95996, abs=1e-4)


def test_five_runs_are_covered_as_often_as_claimed_and_a_normal_interval_falls_short():
    """4,000 tries: standard error .0035 at 95 %, so the bands are 4.5 of them wide."""
    rng, covered, normal = np.random.default_rng(1), 0, 0
    for x in rng.normal(3, 2, (4000, 5)):
        value, low, high = pf.t_interval(x)
        covered += low <= 3 <= high
        normal += abs(value - 3) <= 1.96 * x.std(ddof=1) / math.sqrt(5)
    assert abs(covered / 4000 - 0.95) < 0.016
    assert abs(normal / 4000 - 0.878) < 0.025


def test_clusters_are_covered_and_ignoring_them_is_not():
    """Worlds differ by 1, runs within a world by 0.3; ten runs in each of six worlds."""
    rng, covered, ignoring = np.random.default_rng(2), 0, 0
    of = np.repeat(np.arange(6), 10)
    for _ in range(2000):
        x = rng.normal(0, 1, 6)[of] + rng.normal(0, 0.3, 60)
        covered += abs(pf.cluster_interval(x, of).value) <= pf.cluster_interval(x, of).half
        ignoring += abs(x.mean()) <= pf.t_interval(x).half
    assert abs(covered / 2000 - 0.95) < 0.022
    assert ignoring / 2000 < 0.6


def test_one_run_a_cluster_is_students_interval():
    x = np.random.default_rng(3).normal(size=8)
    by_hand = pf.t_quantile(0.95, 7) * x.std(ddof=1) / math.sqrt(8)
    for interval in (pf.t_interval(x), pf.cluster_interval(x, list("abcdefgh"))):
        assert interval.value == pytest.approx(x.mean())
        assert interval.half == pytest.approx(by_hand)


@pytest.mark.parametrize("x, clusters", [([1.0], ["a"]), ([1.0, 2.0], ["a", "a"])])
def test_one_world_cannot_say_how_worlds_differ(x, clusters):
    with pytest.raises(pf.ParameterError, match=r"clusters .* whole number >= 2, got 1"):
        pf.cluster_interval(x, clusters)


def test_each_run_belongs_to_a_cluster():
    with pytest.raises(pf.ShapeError, match=r"x must have shape \(3,\), got \(2,\)"):
        pf.cluster_interval([1.0, 2.0], ["a", "b", "c"])
