"""The beam model: its four parts, its integral, its samples, its fit."""

import math
from dataclasses import replace

import numpy as np
import pytest

import pfkit as pf
from pfkit.models.beams import normal_cdf

WALLS = np.ones((22, 32), dtype=bool)
WALLS[1:-1, 1:-1] = False
WALLS[5:8, 20:24] = True
ROOM = pf.OccupancyGrid(WALLS, 0.2, (1.0, -1.0, 0.3))
DIRECTIONS = np.linspace(-2, 2, 5)
LASER = pf.BeamModel(ROOM, DIRECTIONS, 5.0, 0.15, 0.6, 0.6, 0.2, 0.05, 0.15)


@pytest.mark.parametrize("length", [0.05, 0.4, 2.0, 4.95, 5.1, 9.0, np.inf])
def test_densities_and_the_probability_of_the_maximum_sum_to_one(length):
    r = (np.arange(200_000) + 0.5) * 5.0 / 200_000
    density = LASER.parts(r, length).sum(axis=1) * 5.0 / 200_000
    event = LASER.parts(5.0, length)
    np.testing.assert_allclose(density + event, 1.0, atol=2e-4)


def test_the_parts_are_those_of_the_book():
    """Loop twin of Table 6.1, away from 0 and r_max, where the truncations do not matter."""
    for r, length in ((1.0, 1.1), (2.0, 1.9), (0.5, 3.0), (3.0, 2.0)):
        hit = math.exp(-0.5 * ((r - length) / 0.15) ** 2) / (0.15 * math.sqrt(2 * math.pi))
        eta = 1 / (1 - math.exp(-0.6 * length))
        short = eta * 0.6 * math.exp(-0.6 * r) if r <= length else 0.0
        np.testing.assert_allclose(LASER.parts(r, length), (hit, short, 0, 0.2), rtol=1e-12)
    np.testing.assert_allclose(LASER.parts(5.0, 2.0), (0, 0, 1, 0), atol=1e-12)
    np.testing.assert_allclose(LASER.parts(5.0, np.inf), (1, math.exp(-3), 1, 0))
    np.testing.assert_allclose(LASER.parts(5.0, 5.0)[0], 0.5, rtol=1e-12)


def test_the_likelihood_multiplies_over_beams():
    rng = np.random.default_rng(0)
    pose = ROOM.sample_poses(20, rng)
    z = LASER.sample(pose[:, 0], rng)
    total = np.zeros(20)
    for r, phi in z.T:
        length = pf.RayCaster(ROOM).cast(pose, [phi], 100.0)[0]
        total += np.log(LASER.shares @ LASER.parts(r, length))
    np.testing.assert_allclose(LASER.log_likelihood(z, pose), total)
    each = sum(LASER.log_density(zk, pose) for zk in z.T)
    np.testing.assert_allclose(each, total)


def test_a_batch_with_readings_for_each_filter():
    rng = np.random.default_rng(1)
    pose = ROOM.sample_poses((3, 6), rng)
    z = LASER.sample(pose[:, :, :1], rng)
    assert z.shape == (2, 5, 3, 1) and LASER.expected(pose).shape == (2, 5, 3, 6)
    batch = LASER.log_likelihood(z, pose)
    for b in range(3):
        one = LASER.log_likelihood(z[:, :, b, 0], pose[:, b])
        np.testing.assert_allclose(batch[b], one)


def test_moving_map_and_robot_together_changes_nothing():
    rng, g = np.random.default_rng(2), (3.0, -2.0, 0.8)
    there = replace(LASER, world=pf.OccupancyGrid(WALLS, 0.2, tuple(pf.compose(g, ROOM.origin))))
    pose = ROOM.sample_poses(50, rng)
    z = LASER.sample(pose[:, 0], rng)
    np.testing.assert_allclose(
        there.log_likelihood(z, pf.compose(g, pose)), LASER.log_likelihood(z, pose), atol=1e-6
    )


@pytest.mark.parametrize(("back", "low", "high"), [(0.0, 1.0, 4.5), (0.1, 0.0999, 0.1001)])
def test_samples_follow_the_distribution(back, low, high):
    """Kolmogorov's distance of 20,000 readings from the integral; false-fail below 1e-4.

    Once in the open, and once so near the wall that a quarter of the hits would lie behind the
    sensor.
    """
    M = 20_000
    laser, pose = replace(LASER, directions=(0.4,)), np.array((4.0, 2.0, 0.5))
    if back:  # stand this far before the wall
        ahead = float(laser.lengths(pose)[0]) - back
        pose[:2] += ahead * np.array((math.cos(0.9), math.sin(0.9)))
    pose = np.tile(pose[:, None], M)
    length = float(laser.lengths(pose[:, 0])[0])
    assert low < length < high
    z = np.sort(laser.sample(pose, np.random.default_rng(3))[0, 0])
    r = (np.arange(50_000) + 0.5) * 5.0 / 50_000
    cdf = np.cumsum(laser.shares @ laser.parts(r, length)) * 5.0 / 50_000
    below = z < 5.0
    gap = np.abs(np.interp(z[below], r, cdf) - np.arange(below.sum()) / M).max()
    assert gap < 2.3 / math.sqrt(M)
    top = float(laser.shares @ laser.parts(5.0, length))
    assert abs((~below).mean() - top) < 5 * math.sqrt(top / M)


def readings(laser, n, rng):
    pose = ROOM.sample_poses(n // len(DIRECTIONS), rng)
    return laser.sample(pose, rng)[0].ravel(), laser.lengths(pose).ravel()


def test_the_fit_finds_the_parameters_again():
    """Each within 5 deviations of the estimates over 12 data sets, and unbiased within that."""
    rng = np.random.default_rng(4)
    start = replace(
        LASER, sigma_hit=0.5, lambda_short=2.0, z_hit=0.25, z_short=0.25, z_max=0.25, z_rand=0.25
    )
    found = []
    for _ in range(12):
        fitted = pf.fit_beams(start, *readings(LASER, 2_000, rng))
        found.append((*fitted.shares, fitted.sigma_hit, fitted.lambda_short))
    mean, sd = np.mean(found, axis=0), np.std(found, axis=0, ddof=1)
    truth = (*LASER.shares, LASER.sigma_hit, LASER.lambda_short)
    assert (np.abs(mean - truth) < 5 * sd / math.sqrt(12)).all()
    np.testing.assert_allclose(mean, truth, rtol=0.15)


def test_every_turn_of_the_fit_explains_the_readings_better():
    rng = np.random.default_rng(5)
    r, length = readings(LASER, 1_000, rng)
    keep = (length < 4.0) & (length > 1.0)
    r, length = r[keep], length[keep]
    model = replace(LASER, sigma_hit=0.6, lambda_short=3.0)
    scores = []
    for _ in range(30):
        scores.append(np.log(model.shares @ model.parts(r, length)).sum())
        model = pf.fit_beams(model, r, length, iterations=1)
    assert (np.diff(scores) > -1e-9).all() and scores[-1] > scores[0] + 10


def test_the_exponential_is_not_fooled_by_near_walls():
    """The book's formula, n / sum r, would double lambda in a small room."""
    rng = np.random.default_rng(6)
    length = np.full(20_000, 1.5)
    unit = rng.random(length.size)
    r = -np.log1p(unit * np.expm1(-0.6 * length)) / 0.6
    only = replace(LASER, z_hit=0.0, z_short=1.0, z_max=0.0, z_rand=0.0)
    assert pf.fit_beams(only, r, length, 500).lambda_short == pytest.approx(0.6, abs=0.1)
    assert 1 / r.mean() > 1.2


def test_a_filter_finds_the_robot_by_its_beams():
    rng = np.random.default_rng(7)
    truth = np.array((5.0, 1.5, 1.0))
    bel = pf.gaussian_prior(4_000, truth, (0.5, 0.5, 0.3), rng)
    z = LASER.sample(truth, rng)
    after, log_evidence = pf.update(bel, z, pf.Tempered(LASER, 0.7))
    assert np.isfinite(log_evidence) and after.ess < bel.ess
    spread = [np.trace(pf.covariance(b)[:2, :2]) for b in (bel, after)]
    assert spread[1] < spread[0]


def test_in_a_large_hall_people_out_of_reach_count_too():
    """Readings cut off at r_max: lambda is still found (5 deviations over 12 data sets)."""
    rng = np.random.default_rng(8)
    only = replace(LASER, z_hit=0.0, z_short=1.0, z_max=0.0, z_rand=0.0, lambda_short=1.5)
    found = []
    for _ in range(12):
        length = rng.uniform(4.0, 30.0, 1_500)
        unit = rng.random(length.size)
        r = np.minimum(-np.log1p(unit * np.expm1(-0.3 * length)) / 0.3, 5.0)
        found.append(pf.fit_beams(only, r, length, 500).lambda_short)
    assert abs(np.mean(found) - 0.3) < 5 * np.std(found, ddof=1) / math.sqrt(12)


def test_the_normal_distribution_function():
    np.testing.assert_allclose(
        normal_cdf([-np.inf, -1.959963984540054, 0.0, 1.0, 40.0]),
        (0.0, 0.025, 0.5, 0.8413447460685429, 1.0),
    )


@pytest.mark.parametrize(
    "make, error, match",
    [
        (lambda: replace(LASER, directions=()), pf.ShapeError, "directions"),
        (lambda: replace(LASER, r_max=0.0), pf.ParameterError, "r_max"),
        (lambda: replace(LASER, sigma_hit=-1.0), pf.ParameterError, "sigma_hit"),
        (lambda: replace(LASER, z_hit=0.9), pf.ParameterError, "must be 1"),
        (lambda: replace(LASER, z_hit=1.4, z_short=-0.6), pf.ParameterError, r"\[0, 1\]"),
        (lambda: LASER.log_likelihood([[-1.0], [0.0]], np.zeros((3, 2))), pf.DataError, ">= 0"),
        (lambda: LASER.log_likelihood([[np.inf], [0.0]], np.zeros((3, 2))), pf.DataError, "z"),
        (lambda: replace(LASER, world=WALLS), AttributeError, "'p'"),
        (lambda: LASER.parts(1.0, math.nan), pf.DataError, ">= 0"),
        (lambda: pf.fit_beams(None, [1.0], [1.0]), AttributeError, "shares"),
        (
            lambda: pf.fit_beams(LASER, [1.0, 2.0], [1.0]),
            pf.ShapeError,
            r"length must have shape \(2,\)",
        ),
        (lambda: pf.fit_beams(LASER, [-1.0], [1.0]), pf.DataError, ">= 0"),
        (
            lambda: pf.fit_beams(
                replace(LASER, sigma_hit=0.05, z_hit=0.75, z_rand=0.0), [4.5], [1.0]
            ),
            pf.DataError,
            "impossible",
        ),
    ],
)
def test_bad_input_is_named(make, error, match):
    with pytest.raises(error, match=match):
        make()
