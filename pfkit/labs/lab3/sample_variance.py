"""P7 and P8: the luck of resampling, and how many particles are enough."""

from __future__ import annotations

import math

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Choice,
    Experiment,
    Misconception,
    Numeric,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.target import around, target_log

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]

# -- P7 ------------------------------------------------------------------------------------------

W5 = np.array([0.40, 0.25, 0.15, 0.12, 0.08])


def copies(scheme, w, rng, runs):
    """How many copies each particle got in each run: (runs, M)."""
    return np.stack([np.bincount(scheme(w, rng), minlength=len(w)) for _ in range(runs)])


def final_error(threshold, rng, runs):
    """Error in x after 50 frames that say little: 100 particles, multinomial resampling."""
    bel = around(HOME, (runs, 100), rng, sigma=20.0)
    motion, sensor = pf.FixedTarget(0.0), pf.Position(300.0)
    for _, u, z, _ in FILM[:50]:
        bel, _ = pf.step(bel, u, z, motion, sensor, rng, pf.multinomial, threshold)
    return pf.mean_pose(bel)[0] - HOME[0]


def _copies(f, rng, runs):
    return np.stack([f(s, W5, rng, runs) for s in (pf.multinomial, pf.systematic)], axis=1)


def _thresholds(f, rng, runs):
    return np.stack([f(threshold, rng, runs) for threshold in (1.0, 0.5)], axis=1)


def _multinomial_variance(x):
    """Each variance within 30 % of M w (1 - w): five standard errors for 1,000 runs."""
    ratio = x[:, 0].var(axis=0, ddof=1) / (5 * W5 * (1 - W5))
    return bool((np.abs(ratio - 1) < 0.3).all())


P7 = Question(
    "p7",
    "Sample variance",
    (
        Experiment(
            id="p7a",
            title="Variance of the number of copies",
            points=2,
            claim="both schemes give M w copies on average; the variance is M w (1 - w) for "
            "multinomial and at most 1/4 for systematic",
            test="means within 5 standard errors, variances within 30 %, systematic at most .26",
            runs=1000,
            margin="5 standard errors in 15 comparisons: 1e-5",
            measure=_copies,
            reference=copies,
            hints=(
                "Count how often each index occurs in the result of scheme(w, rng).",
                "np.bincount counts; minlength keeps particles that got no copy.",
                "np.bincount(scheme(w, rng), minlength=len(w)), once per run, stacked.",
            ),
            properties=(
                Property(
                    "mean number of copies is M w, both schemes",
                    lambda x: bool(
                        (
                            np.abs(x.mean(0) - 5 * W5)
                            <= 5 * x.std(0, ddof=1) / math.sqrt(len(x)) + 1e-12
                        ).all()
                    ),
                ),
                Property("multinomial variance is M w (1 - w)", _multinomial_variance),
                Property(
                    "systematic variance is at most 1/4",
                    lambda x: x[:, 1].var(axis=0, ddof=1).max() <= 0.26,
                ),
            ),
            misconceptions=(
                Misconception(
                    "shares",
                    "gives shares of the set, not numbers of copies",
                    (
                        "Your row sums are 1. How many particles are there?",
                        "Copies are whole numbers that sum to M.",
                        "Do not divide by M.",
                    ),
                    lambda s, w, rng, runs: copies(s, w, rng, runs) / len(w),
                    lambda x: bool(np.allclose(x.sum(axis=-1), 1)),
                ),
                Misconception(
                    "yes-or-no",
                    "tells only whether a particle survived",
                    (
                        "Can a particle have two copies in your table?",
                        "Survival is 0 or 1; copies are 0, 1, 2, ...",
                        "Count with np.bincount(scheme(w, rng), minlength=len(w)).",
                    ),
                    lambda s, w, rng, runs: (copies(s, w, rng, runs) > 0).astype(float),
                    lambda x: x.max() == 1 and x.sum(axis=-1).max() > 1,
                ),
                Misconception(
                    "one-call",
                    "calls the scheme once and repeats the result",
                    (
                        "All your rows are equal.",
                        "Each run needs a call of its own.",
                        "Put scheme(w, rng) inside the loop over runs.",
                    ),
                    lambda s, w, rng, runs: np.tile(copies(s, w, rng, 1), (runs, 1)),
                    lambda x: bool((x == x[0]).all()),
                ),
            ),
        ),
        Experiment(
            id="p7b",
            title="Resample always, or only when the ESS is low?",
            points=2,
            claim="with measurements that say little, resampling at every frame makes the final "
            "estimate more than twice as variable as resampling below ESS = M/2",
            test="ratio of the variances over runs > 2",
            runs=100,
            margin="ratio 45, sd of its logarithm .2: 15 standard errors above 2",
            measure=_thresholds,
            reference=final_error,
            hints=(
                "One number per run: the mean of x at the end, minus the true x.",
                "pf.step has the arguments scheme and threshold.",
                "Loop over lab.film[:50] with pf.step(..., pf.multinomial, threshold).",
            ),
            properties=(
                Property(
                    "the errors average out: mean within 5 standard errors of 0",
                    lambda x: bool(
                        (np.abs(x.mean(0)) < 5 * x.std(0, ddof=1) / math.sqrt(len(x)) + 0.1).all()
                    ),
                ),
                Property(
                    "always resampling: more than twice the variance",
                    lambda x: (
                        x[:, 0].var() > 2 * x[:, 1].var() or f"variances {x.var(0).round(1)} px^2"
                    ),
                ),
            ),
            misconceptions=(
                Misconception(
                    "threshold-unused",
                    "does not use the threshold: both cases are alike",
                    (
                        "Your two variances agree. Where does threshold enter?",
                        "pf.step resamples if ESS < threshold * M.",
                        "Pass threshold as the last argument of pf.step.",
                    ),
                    lambda threshold, rng, runs: final_error(0.5, rng, runs),
                    lambda x: 0.5 < x[:, 0].var() / x[:, 1].var() < 2,
                ),
                Misconception(
                    "absolute-error",
                    "returns distances, whose mean is not zero",
                    (
                        "Can your errors be negative?",
                        "The variance of an estimate needs the signed error.",
                        "Return the mean of x minus the true x, without abs or hypot.",
                    ),
                    lambda threshold, rng, runs: np.abs(final_error(threshold, rng, runs)),
                    lambda x: x.min() >= 0,
                ),
            ),
        ),
        Choice(
            id="p7c",
            title="Which schemes never make an estimate more variable than multinomial?",
            key="c",
            options={
                "a": "Systematic, because its numbers of copies vary least",
                "b": "All schemes that are unbiased",
                "c": "Stratified and residual",
                "d": "None: it depends on the particles",
            },
            feedback={
                "a": "Its teeth are linked; with alternating weights it was 333 times worse.",
                "b": "Unbiased says nothing about variance, and multinomial is unbiased too.",
                "c": "Yes, this is proved for both; systematic is often better still, not always.",
                "d": "It does for systematic; for stratified and residual there is a proof.",
            },
        ),
    ),
)

# -- P8 ------------------------------------------------------------------------------------------


def success(side, M, rng, runs):
    """Is one of M particles, uniform over a square of this side, within 30 px of its centre?"""
    x, y = side * (rng.random((2, runs, M)) - 0.5)
    return (np.hypot(x, y) < 30).any(axis=-1)


SIDES, LADDER = (120.0, 240.0, 480.0), (5, 10, 20, 40, 80, 160, 320, 640)


def _ladder(f, rng, runs):
    rows = [np.stack([f(side, M, rng, runs) for M in LADDER], axis=1) for side in SIDES]
    return np.stack(rows, axis=1)


def slope_of_need(x: np.ndarray) -> float:
    """Slope of log N at 90 % success against log area, from outcomes (runs, sides, ladder)."""
    needed = []
    for share in np.asarray(x, dtype=float).mean(0):
        share = np.maximum.accumulate(share) + 1e-9 * np.arange(len(LADDER))
        needed.append(np.interp(0.9, share, np.log(LADDER)))
    return float(np.polyfit(2 * np.log(SIDES), needed, 1)[0])


P8 = Question(
    "p8",
    "Pose uncertainty and number of particles",
    (
        Numeric(
            id="p8a",
            title="KLD bound for k = 100 bins, error .05 nats, probability .99",
            key=1347.0,
            tol=1.5,
            unit="particles",
            hints=(
                "Put k - 1 = 99 into the formula of the text.",
                "z is the point below which a standard normal lies with probability .99: 2.326.",
                "n = (k-1)/(2 eps) (1 - a + sqrt(a) z)^3 with a = 2/(9 (k-1)).",
            ),
            misconceptions=(
                Misconception(
                    "two-sided",
                    "takes the two-sided quantile 2.576",
                    (
                        "Which probability lies below your z?",
                        "The bound is one-sided.",
                        "z = 2.326 for .99.",
                    ),
                    1390.1,
                    lambda x: abs(x - _kld(100, 0.05, 2.5758)) < 2,
                ),
                Misconception(
                    "k-not-k-minus-1",
                    "uses k = 100 where the formula has k - 1",
                    (
                        "A table of k bins has k - 1 degrees of freedom.",
                        "Replace k by k - 1 everywhere.",
                        "Put 99 in both places.",
                    ),
                    1358.1,
                    lambda x: abs(x - _kld(101, 0.05, 2.32635)) < 2,
                ),
                Misconception(
                    "missing-half",
                    "forgets the 2 in 2 eps",
                    (
                        "Your number is twice too large.",
                        "Look at the denominator of the first factor.",
                        "The first factor is (k-1)/(2 eps).",
                    ),
                    2694.0,
                    lambda x: abs(x - 2 * 1347.0) < 4,
                ),
                Misconception(
                    "lower-quantile",
                    "takes the quantile with the wrong sign",
                    (
                        "Should more certainty need more or fewer particles?",
                        "z belongs to .99, not to .01.",
                        "z is +2.326.",
                    ),
                    692.1,
                    lambda x: abs(x - _kld(100, 0.05, -2.32635)) < 2,
                ),
            ),
        ),
        Experiment(
            id="p8b",
            title="Particles needed against the area of the prior",
            points=2,
            claim="the number needed grows in proportion to the area",
            test="slope of log N against log area between .7 and 1.3",
            runs=400,
            margin="slope 1.04, sd .035: 7 standard errors",
            measure=_ladder,
            reference=success,
            hints=(
                "One True or False per run: is a particle within 30 px of the centre?",
                "Draw x and y uniformly over the square, shape (runs, M).",
                "(np.hypot(x, y) < 30).any(axis=-1) with x, y between -side/2 and side/2.",
            ),
            properties=(
                Property(
                    "True or False, more often True with more particles",
                    lambda x: (
                        bool(np.isin(x, (0, 1)).all())
                        and x[:, :, -1].mean() > x[:, :, 0].mean() + 0.1
                    ),
                ),
                Property(
                    "slope between .7 and 1.3",
                    lambda x: 0.7 < slope_of_need(x) < 1.3 or f"slope {slope_of_need(x):.2f}",
                ),
            ),
            misconceptions=(
                Misconception(
                    "diagonal",
                    "moves x and y together, so particles lie on a line",
                    (
                        "Plot your particles: do they fill the square?",
                        "x and y need draws of their own.",
                        "rng.random((2, runs, M)): two numbers per particle.",
                    ),
                    lambda side, M, rng, runs: (
                        np.abs(side * (rng.random((runs, M)) - 0.5)) * math.sqrt(2) < 30
                    ).any(axis=-1),
                    lambda x: 0.3 < slope_of_need(x) < 0.7,
                ),
                Misconception(
                    "side-ignored",
                    "does not depend on the side of the square",
                    (
                        "Your answer is the same for every side.",
                        "Scale the draws by the side.",
                        "x = side * (rng.random((runs, M)) - .5).",
                    ),
                    lambda side, M, rng, runs: success(240.0, M, rng, runs),
                    lambda x: abs(slope_of_need(x)) < 0.2,
                ),
            ),
        ),
        Choice(
            id="p8c",
            title="Which way does the cause run?",
            key="b",
            options={
                "a": "More particles make the pose more uncertain",
                "b": "A more uncertain pose needs more particles for the same quality",
                "c": "More particles make the pose more certain",
                "d": "The two are not related",
            },
            feedback={
                "a": "Particles describe the belief; their number does not widen it.",
                "b": "Yes: a wider belief has more places to cover.",
                "c": "They describe the same belief more precisely; the belief stays as wide.",
                "d": "You have just measured a slope near 1.",
            },
        ),
    ),
)


def _kld(k: int, eps: float, z: float) -> float:
    """Number of particles that keeps the KL distance below eps (Fox 2003)."""
    a = 2 / (9 * (k - 1))
    return (k - 1) / (2 * eps) * (1 - a + math.sqrt(a) * z) ** 3


QUESTIONS = (
    P7,
    P8,
)
