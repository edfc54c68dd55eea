"""Q16: outliers that nobody detects."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, experiment
from pfkit.labs.lab4 import given as lab
from pfkit.labs.response import same_mean, same_scatter

Q16 = Question("Outliers that nobody detects")


def _filters(rng):
    """Numbers of particles, sensor noises and thresholds.

    The last sensor is so blunt that mixture and gate take other measurements for honest.
    """
    M = rng.integers([40, 60, 60], [60, 90, 90])
    sigma = rng.uniform([3.0, 4.5, 24.0], [4.0, 5.5, 27.0])
    gate = 10 ** rng.uniform([-4.3, -2.7, -4.05], [-4.0, -2.6, -3.95])
    chosen = zip(M, sigma, gate, strict=True)
    return [(int(m), float(f"{s:.2g}"), float(f"{g:.2g}")) for m, s, g in chosen]


@experiment(
    """Naive, mixture, gate from a known start, gate from anywhere
    Four rows of medians over frames, one number per run in each.
    Only the sensor, the gate and the start differ.
    np.median(lab.track(...).error, axis=0) for each.""",
    id="q16a",
    points=2,
    claim="all four errors follow the particles, the sensor noise and the gate",
    test="four means within 5 standard errors of a right experiment's at each of three settings, "
    "scatter within a factor of 10",
    runs=40,
    pool=900,
    settings=_filters,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, twelve means and their sum: 2e-4 by Student's law",
)
def four_filters(M, sigma, gate, rng, runs):
    """Median errors in px of four filters: shape (4, runs)."""
    film, motion, sensor = lab.half_false[:120], pf.FixedTarget(1.4), pf.Position(sigma)
    mixed = pf.OutlierMixture(sensor, 0.5, 1 / lab.AREA)
    known = lab.around(lab.half_false.start[:2], (runs, M), rng, sigma=5.0)
    lost = lab.anywhere((runs, M), rng)
    tracks = [
        lab.track(film, known, motion, sensor, rng),
        lab.track(film, known, motion, mixed, rng),
        lab.track(film, known, motion, sensor, rng, gate=gate),
        lab.track(film, lost, motion, sensor, rng, gate=gate),
    ]
    return np.array([np.median(t.error, axis=0) for t in tracks])


four_filters.holds("all four errors follow M, sigma and gate", same_mean(5.0))
four_filters.holds("the runs scatter as independent filters do", same_scatter(10.0))


@four_filters.wrong("""has a gate that is never closed
    Your gate from a known start is as bad as no gate.
    Which argument of lab.track sets the threshold?
    gate=gate.""")
def no_gate(M, sigma, gate, rng, runs):
    return four_filters(M, sigma, 0.0, rng, runs)


@four_filters.wrong("""returns the rows in another order: mixture and gates first
    Which of your rows is above 100 px? It belongs at the end.
    Naive, mixture, gate from a known start, gate from anywhere.
    Return the rows in the order of the list in the question.""")
def order(M, sigma, gate, rng, runs):
    return four_filters(M, sigma, gate, rng, runs)[[0, 2, 3, 1]]


@four_filters.wrong("""returns the rows in reverse order
    Which of your rows is above 100 px? It belongs at the end.
    Naive, mixture, gate from a known start, gate from anywhere.
    Return the rows in the order of the list in the question.""")
def reverse(M, sigma, gate, rng, runs):
    return four_filters(M, sigma, gate, rng, runs)[::-1]


@four_filters.wrong("""has mixture and gate in each other's row
    Which of your rows comes from pf.OutlierMixture?
    Naive, mixture, gate from a known start, gate from anywhere.
    Return the rows in the order of the list in the question.""")
def two_exchanged(M, sigma, gate, rng, runs):
    return four_filters(M, sigma, gate, rng, runs)[[0, 2, 1, 3]]


@four_filters.wrong("""starts the last filter near the truth, too
    Your last two filters are the same.
    What does a gate see if the filter does not know where the target is?
    lab.anywhere((runs, M), rng) for the last one.""")
def known_start_always(M, sigma, gate, rng, runs):
    return four_filters(M, sigma, gate, rng, runs)[[0, 1, 2, 2]]


@four_filters.wrong("""has a sensor sd of 5 px, whatever it is asked
    Does your function use sigma?
    The check chooses the noise of the sensor.
    pf.Position(sigma).""")
def always_five(M, sigma, gate, rng, runs):
    return four_filters(M, 5.0, gate, rng, runs)


@four_filters.wrong("""has 200 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.around(lab.half_false.start[:2], (runs, M), rng, sigma=5.0).""")
def always_200(M, sigma, gate, rng, runs):
    return four_filters(200, sigma, gate, rng, runs)


TOLD = np.array([[29.3], [0.71], [0.70], [202.6]])


@four_filters.refuses("the errors of the text")
def told(M, sigma, gate, rng, runs):
    return np.tile(TOLD, runs)


@four_filters.refuses("the errors of the text, with scatter")
def told_with_scatter(M, sigma, gate, rng, runs):
    return TOLD * (1 + 0.05 * rng.standard_normal((4, runs)))


@four_filters.refuses("random in range")
def guessed(M, sigma, gate, rng, runs):
    return rng.uniform([[20], [0.4], [0.4], [180]], [[40], [1], [1], [230]], (4, runs))


@four_filters.refuses("means over the frames in place of medians")
def means(M, sigma, gate, rng, runs):
    film, motion, sensor = lab.half_false[:120], pf.FixedTarget(1.4), pf.Position(sigma)
    mixed = pf.OutlierMixture(sensor, 0.5, 1 / lab.AREA)
    known = lab.around(lab.half_false.start[:2], (runs, M), rng, sigma=5.0)
    lost = lab.anywhere((runs, M), rng)
    tracks = [
        lab.track(film, known, motion, sensor, rng),
        lab.track(film, known, motion, mixed, rng),
        lab.track(film, known, motion, sensor, rng, gate=gate),
        lab.track(film, lost, motion, sensor, rng, gate=gate),
    ]
    return np.array([t.error.mean(axis=0) for t in tracks])


@four_filters.refuses("half as many particles")
def half_as_many(M, sigma, gate, rng, runs):
    return four_filters(M // 2, sigma, gate, rng, runs)


@four_filters.refuses("one run, repeated")
def one_run(M, sigma, gate, rng, runs):
    return np.repeat(four_filters(M, sigma, gate, rng, 1), runs, axis=1)


@four_filters.refuses("makes the first and guesses the others")
def first_only(M, sigma, gate, rng, runs):
    found = TOLD * (1 + 0.05 * rng.standard_normal((4, runs)))
    found[0] = four_filters(M, sigma, gate, rng, runs)[0]
    return found


@four_filters.refuses("the naive filter in place of the gate")
def naive_twice(M, sigma, gate, rng, runs):
    return four_filters(M, sigma, gate, rng, runs)[[0, 1, 0, 3]]


@four_filters.refuses("the naive filter in place of the mixture")
def no_mixture(M, sigma, gate, rng, runs):
    return four_filters(M, sigma, gate, rng, runs)[[0, 0, 2, 3]]


q16b = Choice("""A gate that works from a known start locks the filter out from anywhere.
         What would you build in?
    a  A lower threshold, found by trial
       = It must lie below 1/area at the start and above it later: no constant does.
    b  No gate at all
       = Then half of the measurements drag the filter away.
    c  More particles
       = The mean likelihood from anywhere is about 1/area for any number.
    d* A mixture in the likelihood, which needs no threshold and lets a lost filter listen
       = Yes: (1 - epsilon) N + epsilon / area, with both constants from the sensor.""")
