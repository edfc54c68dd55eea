"""Q15: what moves a gate."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Numeric, Prediction, Question, experiment
from pfkit.labs.lab4 import given as lab
from pfkit.labs.response import same_mean, same_scatter

Q15 = Question("What moves the detector?")


def _gates(rng):
    """Believed variances, thresholds and particles: some, some, none, all rejected."""
    variance = 10 ** rng.uniform([-2.1, -1.5, 0.7, 0.0], [-1.8, -1.2, 1.3, 0.0])
    threshold = 10 ** rng.uniform([-4.3, -2.3, -4.5, -4.5], [-3.9, -1.8, -4.0, -4.0])
    variance[3] = rng.uniform(1.3, 2.0) / (2 * np.pi * threshold[3])  # its peak is too low
    M = rng.integers([30, 100, 60, 60], [50, 160, 100, 100])
    chosen = zip(variance, threshold, M, strict=True)
    return [(float(f"{v:.3g}"), float(f"{t:.2g}"), int(m)) for v, t, m in chosen]


q15a = Prediction("""Rejected share of honest frames as the believed sensor variance grows
    a  It falls: a modest sensor forgives
    b  It rises
    c* It falls from nearly all to none, then jumps to all
    d  It does not depend on it""")


@experiment(
    """A U-shape
    lab.track(..., gate=threshold).rejected is True where the gate was closed.
    One number per run: the mean over frames.
    pf.Position(np.sqrt(variance)).""",
    id="q15b",
    after=q15a,
    points=2,
    claim="the rejected share follows the believed variance, the threshold and the particles",
    test="mean share within 5 standard errors of a right experiment's at each of four settings, "
    "scatter within a factor of 8 where there is any",
    runs=24,
    pool=900,
    settings=_gates,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, four means and their sum: 1e-4 by Student's law",
)
def rejected(variance, threshold, M, rng, runs):
    """Share of rejected frames, one per run."""
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=1.0)
    motion, sensor = pf.FixedTarget(1.4), pf.Position(np.sqrt(variance))
    run = lab.track(lab.film[:120], bel, motion, sensor, rng, gate=threshold)
    return run.rejected.mean(axis=0)


rejected.holds("the share follows variance, threshold and M", same_mean(5.0))
rejected.holds("the runs scatter as independent filters do", same_scatter(8.0))


@rejected.wrong("""counts frames, where a share is asked for
    A share lies between 0 and 1.
    Divide by the number of frames.
    run.rejected.mean(axis=0), not sum.""")
def counts(variance, threshold, M, rng, runs):
    return 120 * rejected(variance, threshold, M, rng, runs)


@rejected.wrong("""gives the share that is accepted
    Your curve is upside down.
    rejected is True where the gate was closed.
    run.rejected.mean(axis=0), without one minus.""")
def accepted(variance, threshold, M, rng, runs):
    return 1 - rejected(variance, threshold, M, rng, runs)


def _share(bel, variance, threshold, rng, noise=1.4):
    motion, sensor = pf.FixedTarget(noise), pf.Position(np.sqrt(variance))
    return lab.track(lab.film[:120], bel, motion, sensor, rng, gate=threshold).rejected.mean(axis=0)


@rejected.wrong("""starts anywhere, where the mean likelihood is about 1/area for any sensor
    How likely is any measurement if you know nothing?
    1/area is 3.3e-6, far below the threshold.
    Start around the truth: lab.around(lab.film.start[:2], (runs, M), rng).""")
def from_anywhere(variance, threshold, M, rng, runs):
    bel = lab.anywhere((runs, M), rng)
    return _share(bel, variance, threshold, rng)


@rejected.wrong("""passes the variance where a standard deviation is wanted
    For which variance would that make no difference?
    pf.Position wants a standard deviation; you get a variance.
    pf.Position(np.sqrt(variance)).""")
def variance_as_sd(variance, threshold, M, rng, runs):
    return rejected(variance**2, threshold, M, rng, runs)


@rejected.wrong("""has a gate that is never closed
    You reject nothing at any variance.
    Which argument of lab.track sets the threshold?
    gate=threshold.""")
def no_gate(variance, threshold, M, rng, runs):
    return rejected(variance, 0.0, M, rng, runs)


@rejected.wrong("""has a gate at 1e-4, whatever it is asked
    Does your function use the threshold?
    The check chooses where the gate closes.
    gate=threshold.""")
def always_1e_4(variance, threshold, M, rng, runs):
    return rejected(variance, 1e-4, M, rng, runs)


@rejected.wrong("""has 300 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.around(lab.film.start[:2], (runs, M), rng).""")
def always_300(variance, threshold, M, rng, runs):
    return rejected(variance, threshold, 300, rng, runs)


@rejected.refuses("a sensor believed a third wider than it is asked")
def wider_sensor(variance, threshold, M, rng, runs):
    return rejected(1.69 * variance, threshold, M, rng, runs)


@rejected.refuses("the shares of the text")
def told(variance, threshold, M, rng, runs):
    at, share = [-4, -2, 0, 3, 3.3], [1.0, 0.122, 0.0, 0.0, 1.0]
    return np.full(runs, np.interp(np.log10(variance), at, share))


@rejected.refuses("none in between, all beyond the peak, and a guess below")
def by_the_peak(variance, threshold, M, rng, runs):
    beyond = 1 / (2 * np.pi * variance) < threshold
    guess = np.clip(0.12 * 0.01 / variance + 0.02 * rng.standard_normal(runs), 0, 1)
    return guess if variance < 0.1 else np.full(runs, float(beyond))


@rejected.refuses("always half")
def half(variance, threshold, M, rng, runs):
    return np.full(runs, 0.5)


@rejected.refuses("random in range")
def guessed(variance, threshold, M, rng, runs):
    return rng.random(runs)


@rejected.refuses("one run, repeated")
def one_run(variance, threshold, M, rng, runs):
    return np.repeat(rejected(variance, threshold, M, rng, 1), runs)


@rejected.refuses("half as many particles")
def half_as_many(variance, threshold, M, rng, runs):
    return rejected(variance, threshold, M // 2, rng, runs)


@rejected.refuses("a target without process noise")
def no_process_noise(variance, threshold, M, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=1.0)
    return _share(bel, variance, threshold, rng, noise=0.0)


@rejected.refuses("the last frame only")
def last_frame(variance, threshold, M, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=1.0)
    motion, sensor = pf.FixedTarget(1.4), pf.Position(np.sqrt(variance))
    return lab.track(lab.film[:120], bel, motion, sensor, rng, gate=threshold).rejected[-1]


q15c = Numeric(
    """Variance at which even a perfect hit has a density of {gate} per px^2
    What is the highest value of the density in two dimensions?
    The peak is 1/(2 pi variance).
    variance = 1/(2 pi {gate}).""",
    lambda gate: 1 / (2 * np.pi * gate),
    tol=5.0,
    unit="px^2",
    world={"gate": 1e-4},
    draw=lambda rng: {"gate": int(rng.integers(10, 50)) / 1e5},
)
q15c.wrong("""one-dimension: uses the peak of a one-dimensional Gaussian
    The measurement has two components.
    In two dimensions the peak is 1/(2 pi variance), without a root.
    variance = 1/(2 pi {gate}).""")(lambda gate: 1 / (2 * np.pi * gate**2))
q15c.wrong("""deviation: is a standard deviation
    Square your number.
    The unit asked for is px^2.
    variance = 1/(2 pi {gate}).""")(lambda gate: np.sqrt(1 / (2 * np.pi * gate)))
q15c.wrong("""no-two-pi: leaves 2 pi out
    Write the constant of the density down.
    The peak is 1/(2 pi variance).
    variance = 1/(2 pi {gate}).""")(lambda gate: 1 / gate)
q15c.wrong("""root-of-two-pi: has the root of 2 pi, as in one dimension
    The measurement has two components: a factor for each.
    In two dimensions the constant is 2 pi itself.
    variance = 1/(2 pi {gate}).""")(lambda gate: 1 / (np.sqrt(2 * np.pi) * gate))
q15c.wrong("""no-two: has pi where the peak has 2 pi
    Write the constant of the density down.
    The peak is 1/(2 pi variance).
    variance = 1/(2 pi {gate}).""")(lambda gate: 1 / (np.pi * gate))
