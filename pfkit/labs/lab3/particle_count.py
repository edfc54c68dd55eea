"""P8: how many particles are enough."""

from __future__ import annotations

import math

import numpy as np

from pfkit.labs import Choice, Numeric, Question, experiment
from pfkit.labs.statistics import shaped

P8 = Question("Pose uncertainty and number of particles")

SIDES, LADDER = (120.0, 240.0, 480.0), (5, 10, 20, 40, 80, 160, 320, 640)


def _ladder(f, rng, runs):
    found = [[shaped(f(side, M, rng, runs), runs) for M in LADDER] for side in SIDES]
    return np.array(found).transpose(2, 0, 1)


def log_need(x: np.ndarray) -> np.ndarray:
    """log N at 90 % success for each side, from outcomes (runs, sides, ladder)."""
    shares = np.maximum.accumulate(np.asarray(x, dtype=float).mean(0), axis=1)
    rising = shares + 1e-9 * np.arange(len(LADDER))
    return np.array([np.interp(0.9, share, np.log(LADDER)) for share in rising])


def slope_of_need(x: np.ndarray) -> float:
    """Slope of log N against log area."""
    return float(np.polyfit(2 * np.log(SIDES), log_need(x), 1)[0])


p8a = Numeric(
    """KLD bound for k = 100 bins, error .05 nats, probability .99
    Put k - 1 = 99 into the formula of the text.
    z is the point below which a standard normal lies with probability .99: 2.326.
    n = (k-1)/(2 eps) (1 - a + sqrt(a) z)^3 with a = 2/(9 (k-1)).""",
    1347.0,
    tol=1.5,
    unit="particles",
)
p8a.wrong("""two-sided: takes the two-sided quantile 2.576
    Which probability lies below your z?
    The bound is one-sided.
    z = 2.326 for .99.""")(1390.1, when=lambda x: abs(x - _kld(100, 0.05, 2.5758)) < 2)
p8a.wrong("""k-not-k-minus-1: uses k = 100 where the formula has k - 1
    A table of k bins has k - 1 degrees of freedom.
    Replace k by k - 1 everywhere.
    Put 99 in both places.""")(1358.1, when=lambda x: abs(x - _kld(101, 0.05, 2.32635)) < 2)
p8a.wrong("""missing-half: forgets the 2 in 2 eps
    Your number is twice too large.
    Look at the denominator of the first factor.
    The first factor is (k-1)/(2 eps).""")(2694.0, when=lambda x: abs(x - 2 * 1347.0) < 4)
p8a.wrong("""lower-quantile: takes the quantile with the wrong sign
    Should more certainty need more or fewer particles?
    z belongs to .99, not to .01.
    z is +2.326.""")(692.1, when=lambda x: abs(x - _kld(100, 0.05, -2.32635)) < 2)


@experiment(
    """Particles needed against the area of the prior
    One True or False per run: is a particle within 30 px of the centre?
    Draw x and y uniformly over the square, shape (runs, M).
    (np.hypot(x, y) < 30).any(axis=-1) with x, y between -side/2 and side/2.""",
    id="p8b",
    points=2,
    claim="the number needed grows in proportion to the area; for 120 px it is below 22",
    test="slope of log N against log area between .7 and 1.3; N at 120 px below 22",
    runs=400,
    margin="slope 1.04, sd .035: 7 standard errors; N = 10.8, sd .9: 12 standard errors",
    measure=_ladder,
)
def success(side, M, rng, runs):
    """Is one of M particles, uniform over a square of this side, within 30 px of its centre?"""
    x, y = side * (rng.random((2, runs, M)) - 0.5)
    return (np.hypot(x, y) < 30).any(axis=-1)


success.holds(
    "True or False, more often True with more particles",
    lambda x: bool(np.isin(x, (0, 1)).all()) and x[:, :, -1].mean() > x[:, :, 0].mean() + 0.1,
)
success.holds(
    "slope between .7 and 1.3",
    lambda x: 0.7 < slope_of_need(x) < 1.3 or f"slope {slope_of_need(x):.2f}",
)
success.holds(
    "a side of 120 px needs fewer than 22 particles",
    lambda x: np.exp(log_need(x)[0]) < 22 or f"it needs {np.exp(log_need(x)[0]):.0f}",
)
success.wrong(
    """diagonal: moves x and y together, so particles lie on a line
    Plot your particles: do they fill the square?
    x and y need draws of their own.
    rng.random((2, runs, M)): two numbers per particle.""",
    when=lambda x: 0.3 < slope_of_need(x) < 0.7,
)(
    lambda side, M, rng, runs: (
        np.abs(side * (rng.random((runs, M)) - 0.5)) * math.sqrt(2) < 30
    ).any(axis=-1)
)
success.wrong("""side-ignored: does not depend on the side of the square
    Your answer is the same for every side.
    Scale the draws by the side.
    x = side * (rng.random((runs, M)) - .5).""")(
    lambda side, M, rng, runs: success(240.0, M, rng, runs),
    when=lambda x: abs(slope_of_need(x)) < 0.2 and 5 < np.exp(log_need(x)[1]) < 100,
)
success.wrong("""larger-square: draws from a square of twice the side, or with the centre in a
         corner
    Your N is four times too large. How far from the centre is an edge?
    A square of side s reaches s/2 to each side of its centre.
    x and y between -side/2 and side/2.""")(
    lambda side, M, rng, runs: success(2 * side, M, rng, runs),
    when=lambda x: 30 < np.exp(log_need(x)[0]) < 75,
)

p8c = Choice("""Which way does the cause run?
    a  More particles make the pose more uncertain
       = Particles describe the belief; their number does not widen it.
    b* A more uncertain pose needs more particles for the same quality
       = Yes: a wider belief has more places to cover.
    c  More particles make the pose more certain
       = They describe the same belief more precisely; the belief stays as wide.
    d  The two are not related
       = You have just measured a slope near 1.""")


def _kld(k: int, eps: float, z: float) -> float:
    """Number of particles that keeps the KL distance below eps (Fox 2003)."""
    a = 2 / (9 * (k - 1))
    return (k - 1) / (2 * eps) * (1 - a + math.sqrt(a) * z) ** 3
