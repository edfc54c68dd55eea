"""Lab 3, part 1: what a particle filter is, before one is run. Questions P1 to P8."""

from __future__ import annotations

import math

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Choice,
    Code,
    Experiment,
    Misconception,
    Numeric,
    Prediction,
    Property,
    Text,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import z_of_fall, z_of_share
from pfkit.labs.target import anywhere, around, target_log, track

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]
MUTANT = MUTANTS["lab3"]


def rng_of(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


# -- P1: what are the particles? -------------------------------------------------------------

P1 = Question(
    "p1",
    "What are the particles?",
    (
        Choice(
            id="p1a",
            title="What a particle set is",
            key="c",
            options={
                "a": "The last M measurements",
                "b": "The M cells of a grid over the room",
                "c": "Weighted samples that together stand for the belief bel(x_t)",
                "d": "M robots, of which one is real",
            },
            feedback={
                "a": "Measurements give particles their weights; they are not particles.",
                "b": "Cells stay where they are; particles move, and crowd where belief is high.",
                "c": "Yes: where particles are dense or heavy, the belief is high.",
                "d": "None of them need be right: together they say how probable each place is.",
            },
        ),
        Numeric(
            id="p1b",
            title="Probability that room A is empty, for 1, 4 and 10 particles over 4 rooms",
            key=(0.75, 0.75**4, 0.75**10),
            tol=0.002,
            names=("1 particle", "4 particles", "10 particles"),
            hints=(
                "What is the probability that one particle misses room A?",
                "All must miss it, and they are drawn independently.",
                "(3/4) to the power of the number of particles.",
            ),
            misconceptions=(
                Misconception(
                    "complement",
                    "is the probability that somebody is in the room",
                    (
                        "Should an empty room become more or less likely with more particles?",
                        "You computed the opposite event.",
                        "Take one minus your values.",
                    ),
                    (0.25, 1 - 0.75**4, 1 - 0.75**10),
                ),
                Misconception(
                    "power-of-quarter",
                    "is the probability that all particles are in room A",
                    (
                        "Which event has probability 1/4 for one particle?",
                        "Empty means that each particle is in one of the other three rooms.",
                        "The base of the power is 3/4.",
                    ),
                    (0.25, 0.25**4, 0.25**10),
                ),
                Misconception(
                    "linear",
                    "takes a quarter away for each particle",
                    (
                        "With 4 particles, is it certain that room A has one? Throw a die 6 times.",
                        "Probabilities of independent misses multiply; they do not subtract.",
                        "(3/4) to the power of the number of particles.",
                    ),
                    (0.75, 0.0, 0.0),
                ),
            ),
        ),
    ),
)

# -- P2: target, proposal, weights -----------------------------------------------------------


def estimate(values, target, proposal):
    """Self-normalised importance sampling estimate of the mean under the target."""
    w = target / proposal
    return np.sum(w * values) / np.sum(w)


def _toy(seed):
    rng = rng_of(seed)
    values, target, proposal = rng.normal(size=30), rng.random(30) + 0.1, rng.random(30) + 0.1
    return values, target, proposal


def _estimates_normal_mean(f):
    """Samples of N(0, 2^2), target N(1, 1): the estimate lies within 4 standard errors of 1."""
    errors = []
    for seed in range(40):
        x = 2 * rng_of(seed).standard_normal(400)
        errors.append(f(x, np.exp(-0.5 * (x - 1) ** 2), np.exp(-0.5 * (x / 2) ** 2)) - 1)
    se = np.std(errors, ddof=1) / math.sqrt(len(errors))
    return True if abs(np.mean(errors)) < 4 * se else f"off by {np.mean(errors):.2f}"


P2 = Question(
    "p2",
    "Target, proposal, weights",
    (
        Numeric(
            id="p2a",
            title="Weights for target (.5, .3, .2) and proposal (.2, .3, .5)",
            key=(2.5, 1.0, 0.4),
            tol=0.005,
            hints=(
                "Which place does the proposal visit too seldom? It must weigh more.",
                "A weight says how many times more the target wants a place.",
                "w = target / proposal, place by place.",
            ),
            misconceptions=(
                Misconception(
                    "inverse",
                    "is proposal over target: upside down",
                    (
                        "The first place is drawn too seldom. Should its samples count for less?",
                        "Weight times proposal must give the target back.",
                        "w = target / proposal.",
                    ),
                    (0.4, 1.0, 2.5),
                ),
                Misconception(
                    "product",
                    "is target times proposal",
                    (
                        "If target and proposal agree, all weights must be equal.",
                        "Weight times proposal must give the target back.",
                        "w = target / proposal.",
                    ),
                    (0.10, 0.09, 0.10),
                ),
                Misconception(
                    "normalised",
                    "is right up to a factor: you divided by the sum, which is not asked here",
                    (
                        "Ratios of your values are right. Compare their sum with 2.5 + 1 + .4.",
                        "The question asks for the weights before they are normalised.",
                        "w = target / proposal, nothing more.",
                    ),
                    (2.5 / 3.9, 1 / 3.9, 0.4 / 3.9),
                ),
                Misconception(
                    "difference",
                    "is target minus proposal",
                    (
                        "A weight is never negative.",
                        "Weights multiply the density of the samples.",
                        "w = target / proposal.",
                    ),
                    (0.3, 0.0, -0.3),
                ),
            ),
        ),
        Code(
            id="p2b",
            title="Estimate a mean under the target from samples of the proposal",
            points=2,
            reference=estimate,
            hints=(
                "Give each sample a weight first.",
                "The estimate is a weighted mean.",
                "sum(w * values) / sum(w) with w = target / proposal.",
            ),
            properties=(
                Property(
                    "equal densities give the plain mean",
                    lambda f: np.isclose(f(np.array([1.0, 2, 6]), np.ones(3), np.ones(3)), 3),
                ),
                Property(
                    "a factor on the target changes nothing",
                    lambda f: np.isclose(f(*_toy(1)), f(_toy(1)[0], 7 * _toy(1)[1], _toy(1)[2])),
                ),
                Property(
                    "three samples by hand: (1, 2, 6), target (.5, .3, .2), proposal (.2, .3, .5)",
                    lambda f: np.isclose(
                        f(
                            np.array([1.0, 2, 6]),
                            np.array([0.5, 0.3, 0.2]),
                            np.array([0.2, 0.3, 0.5]),
                        ),
                        6.9 / 3.9,
                    ),
                ),
                Property("within 4 standard errors over 40 repetitions", _estimates_normal_mean),
            ),
            fingerprint=lambda f: [f(*_toy(s)) for s in range(4)],
            misconceptions=MUTANT["p2b"],
        ),
        Choice(
            id="p2c",
            title="Why the weight is just p(z | x)",
            key="b",
            options={
                "a": "Because target and proposal are both normalised",
                "b": "Because the proposal is the motion prediction and earlier weights were reset",
                "c": "Because p(z | x) equals the belief bel(x)",
                "d": "Because measurements are independent of the pose",
            },
            feedback={
                "a": "Normalised or not, their ratio need not be the likelihood.",
                "b": "Yes: bel / bel_bar = eta p(z | x); another proposal needs another weight.",
                "c": "The likelihood scores one measurement; the belief holds all of them.",
                "d": "If they were, measuring would be useless; they are independent given the pose.",
            },
        ),
    ),
)

# -- P3: deprivation -------------------------------------------------------------------------


def deprived(M, rng, runs):
    """After ten frames from anywhere: is no particle within 30 px of the truth?"""
    bel = anywhere((runs, M), rng)
    bel = track(FILM[:10], bel, pf.FixedTarget(1.0), pf.Position(10.0), rng).bel
    x, y = bel.state
    return (np.hypot(x - HOME[0], y - HOME[1]) > 30).all(axis=-1)


SIZES = (25, 100, 400)


def _deprivation(f, rng, runs):
    found = np.stack([np.asarray(f(M, rng, runs)) for M in SIZES], axis=1)
    if not np.isin(found, (0, 1)).all():
        raise ValueError("each run must give True or False")
    return found


P3 = Question(
    "p3",
    "Deprivation",
    (
        Experiment(
            id="p3a",
            title="Share of runs without a particle near the truth",
            points=2,
            claim="the share falls with the number of particles",
            test="two-proportion z > 3 from 25 to 100 and from 100 to 400 particles",
            runs=400,
            margin="z is 14.6 and 7.8 on average, sd .6: 8 standard errors above 3",
            measure=_deprivation,
            reference=deprived,
            hints=(
                "One True or False per run: is nobody near the truth?",
                "Take the distance of every particle, then ask whether all are far.",
                "(distance > 30).all(axis=-1), shape (runs,).",
            ),
            properties=(
                Property(
                    "fewer runs are deprived with 100 particles than with 25",
                    lambda x: z_of_fall(x[:, 0], x[:, 1]) > 3 or f"shares {x.mean(0).round(3)}",
                ),
                Property(
                    "fewer still with 400",
                    lambda x: z_of_fall(x[:, 1], x[:, 2]) > 3 or f"shares {x.mean(0).round(3)}",
                ),
            ),
            misconceptions=(
                Misconception(
                    "somebody-far",
                    "asks whether some particle is far, which is nearly always true",
                    (
                        "Is a set deprived when one of its particles is lost?",
                        "Deprived means that not one particle is near the truth.",
                        "Use .all(axis=-1) where you have .any(axis=-1).",
                    ),
                    lambda M, rng, runs: _deprived_any(M, rng, runs),
                    lambda x: x.mean(0).min() > 0.9,
                ),
                Misconception(
                    "somebody-near",
                    "counts the runs that are well, not those that are deprived",
                    (
                        "Your share rises with the number of particles. Should it?",
                        "You answer the opposite question.",
                        "Negate it: True means that nobody is near.",
                    ),
                    lambda M, rng, runs: ~deprived(M, rng, runs),
                    lambda x: z_of_fall(x[:, 2], x[:, 0]) > 4,
                ),
            ),
        ),
        Choice(
            id="p3b",
            title="What causes deprivation",
            key="d",
            options={
                "a": "Only resampling when nothing new was measured",
                "b": "Only too few particles",
                "c": "A wrong map",
                "d": "Few particles, a sharp likelihood, little process noise, needless resampling",
            },
            feedback={
                "a": "That is one cause; you have just seen another, with every frame informative.",
                "b": "That is one cause; 400 particles die out too if resampled without need.",
                "c": "A wrong map misleads any filter; deprivation happens with a right one.",
                "d": "Yes: each makes it likelier that the last particle near the truth is lost.",
            },
        ),
        Text(
            id="p3c",
            title="Why deprivation is dangerous",
            points=2,
            rubric=(
                "says that no particle is near the truth, so resampling cannot bring one back (1)",
                "says that the spread of the cloud shows confidence, so nothing warns us (1)",
            ),
            model=(
                "No particle is left near the truth, and resampling only copies what is there. "
                "The cloud is narrow, so the filter is sure and wrong, and its spread does not "
                "warn us."
            ),
        ),
    ),
)


def _deprived_any(M, rng, runs):
    bel = track(
        FILM[:10], anywhere((runs, M), rng), pf.FixedTarget(20.0), pf.Position(30.0), rng
    ).bel
    return (np.hypot(bel.state[0] - HOME[0], bel.state[1] - HOME[1]) > 30).any(axis=-1)


# -- P4: why resample? -----------------------------------------------------------------------


def ess_history(resample, rng, runs):
    """ESS before each resampling decision: 50 frames, 1,000 particles around a known start."""
    bel = around(HOME, (runs, 1000), rng, sigma=5.0)
    scheme = pf.systematic if resample else None
    return track(FILM[:50], bel, pf.FixedTarget(1.0), pf.Position(3.0), rng, scheme).ess


def _histories(f, rng, runs):
    with_, without = (np.asarray(f(r, rng, runs), dtype=float) for r in (True, False))
    if with_.shape != (50, runs) or without.shape != (50, runs):
        raise ValueError(f"expected two arrays of shape (50, {runs}), got {with_.shape}")
    return np.stack([with_.T, without.T], axis=1)


P4 = Question(
    "p4",
    "Why resample at all?",
    (
        Prediction(
            id="p4a",
            title="ESS after 50 frames without resampling, of 1,000 particles",
            key="c",
            options={
                "a": "It stays near 1,000",
                "b": "It settles near 500",
                "c": "It falls to a few particles",
                "d": "It goes up and down without trend",
            },
        ),
        Experiment(
            id="p4b",
            after="p4a",
            title="ESS with and without resampling",
            points=2,
            claim="without resampling the ESS ends at 3 or less on average; "
            "with it, it keeps a median between 800 and 950",
            test="mean over runs of the last ESS < 3; median over frames 5 to 50 in the band",
            runs=10,
            margin="last ESS 1.7, sd .22: 6 standard errors below 3; median 892, sd .8",
            measure=_histories,
            reference=ess_history,
            hints=(
                "Return the ESS before the decision to resample, one row per frame.",
                "lab.track(...).ess has this shape: frames by runs.",
                "Pass scheme=pf.systematic or scheme=None.",
            ),
            properties=(
                Property(
                    "without resampling it ends at 3 or less",
                    lambda x: x[:, 1, -1].mean() < 3 or f"it ends at {x[:, 1, -1].mean():.1f}",
                ),
                Property(
                    "with resampling its median lies between 800 and 950",
                    lambda x: (
                        800 < np.median(x[:, 0, 5:]) < 950
                        or f"the median is {np.median(x[:, 0, 5:]):.0f}"
                    ),
                ),
            ),
            misconceptions=(
                Misconception(
                    "after-resampling",
                    "measures the ESS after resampling, when all weights are equal",
                    (
                        "Your ESS with resampling is always the number of particles. Why?",
                        "Equal weights have ESS M, whatever happened before.",
                        "Take the ESS after the update and before the resampling.",
                    ),
                    lambda r, rng, runs: (
                        np.full((50, runs), 1000.0) if r else ess_history(False, rng, runs)
                    ),
                    lambda x: np.median(x[:, 0]) > 999,
                ),
                Misconception(
                    "never-resampled",
                    "does not resample in either case",
                    (
                        "Your two curves look alike.",
                        "Does your function use its first argument?",
                        "scheme = pf.systematic if resample else None.",
                    ),
                    lambda r, rng, runs: ess_history(False, rng, runs),
                    lambda x: x[:, 0, -1].mean() < 10,
                ),
                Misconception(
                    "always-resampled",
                    "resamples in both cases",
                    (
                        "Your two curves look alike.",
                        "Does your function use its first argument?",
                        "scheme = pf.systematic if resample else None.",
                    ),
                    lambda r, rng, runs: ess_history(True, rng, runs),
                    lambda x: x[:, 1, -1].mean() > 100,
                ),
            ),
        ),
    ),
)

# -- P5: when is the average a bad summary? --------------------------------------------------


def two_places(rng):
    return np.concatenate([rng.normal(-10, 1, 200), rng.normal(10, 1, 200)])


def height_at_mean(x: np.ndarray, h: float = 1.0) -> float:
    """Density at the mean as a share of the highest density; kernels of sd ``h``."""
    x = np.asarray(x, dtype=float)

    def density(at):
        return np.exp(-0.5 * ((np.atleast_1d(at)[:, None] - x) / h) ** 2).mean(axis=1)

    return float(density(x.mean())[0] / density(x).max())


def circular_mean(theta, w):
    return np.arctan2(np.sum(w * np.sin(theta)), np.sum(w * np.cos(theta)))


def _same_angle(a, b):
    return bool(abs(pf.wrap(np.asarray(a, dtype=float) - b)) < 1e-9)


def _turned(f):
    rng = rng_of(3)
    theta, w = rng.normal(0.5, 0.4, 20), rng.random(20)
    for turn in (1.0, 2.5, -2.0):
        if not _same_angle(f(pf.wrap(theta + turn), w), f(theta, w) + turn):
            return f"turning the set by {turn} rad does not turn the mean by {turn} rad"
    return True


P5 = Question(
    "p5",
    "When is the average a bad summary?",
    (
        Code(
            id="p5a",
            title="A set whose mean is a bad place",
            reference=two_places,
            hints=(
                "Think of a robot that is in one of two rooms.",
                "The mean of two places lies between them.",
                "Half of the samples near -10, half near +10.",
            ),
            properties=(
                Property(
                    "between 100 and 10,000 finite numbers",
                    lambda f: (
                        100 <= np.size(f(rng_of(1))) <= 10_000
                        and np.ndim(f(rng_of(1))) == 1
                        and np.isfinite(f(rng_of(1))).all()
                    ),
                ),
                Property(
                    "density at the mean below 1 % of the highest",
                    lambda f: (
                        height_at_mean(f(rng_of(1))) < 0.01
                        or f"it is {100 * height_at_mean(f(rng_of(1))):.1f} %"
                    ),
                ),
            ),
            misconceptions=MUTANT["p5a"],
        ),
        Code(
            id="p5b",
            title="Circular mean",
            points=2,
            reference=circular_mean,
            hints=(
                "Add arrows, not numbers.",
                "Sum the weighted sines and cosines.",
                "arctan2(sum(w sin), sum(w cos)).",
            ),
            properties=(
                Property(
                    "359 and 1 degree have the mean 0",
                    lambda f: _same_angle(f(np.deg2rad([359.0, 1.0]), np.array([0.5, 0.5])), 0),
                ),
                Property(
                    "weights count: 0 and 90 degrees with weights .9 and .1 give 6.3 degrees",
                    lambda f: _same_angle(
                        f(np.array([0.0, np.pi / 2]), np.array([0.9, 0.1])), math.atan2(1, 9)
                    ),
                ),
                Property("turning all headings turns the mean", _turned),
            ),
            fingerprint=lambda f: [
                f(rng_of(s).uniform(1.7, 4.0, 9), rng_of(s + 9).random(9)) for s in range(4)
            ],
            misconceptions=MUTANT["p5b"],
        ),
        Choice(
            id="p5c",
            title="What to report for a belief with four hills",
            key="a",
            options={
                "a": "The hills: cluster the particles, or take the highest point",
                "b": "The mean, after stratified resampling",
                "c": "The mean of more particles",
                "d": "The median of x and the median of y",
            },
            feedback={
                "a": "Yes: a list of hypotheses with their weights, or the mode if one is needed.",
                "b": "Stratified sampling changes which copies are made, not what the mean is.",
                "c": "More particles find the same bad mean more precisely.",
                "d": "The medians of four corners can lie where no particle is, too.",
            },
        ),
    ),
)

# -- P6: between the particles ---------------------------------------------------------------


def kde(x, samples, h):
    d = (x[:, None] - samples[None, :]) / h
    return np.mean(np.exp(-0.5 * d**2), axis=1) / (np.sqrt(2 * np.pi) * h)


def fit_scores(train, test):
    """Mean log density of ``test`` under a Gaussian, a histogram and a KDE fit to ``train``."""
    mu, sd = train.mean(), train.std()
    gaussian = -0.5 * ((test - mu) / sd) ** 2 - np.log(sd * np.sqrt(2 * np.pi))
    edges = np.linspace(-15, 15, 31)
    counts = np.histogram(train, edges)[0] + 0.5  # half a particle more, so that no cell is empty
    heights = counts / counts.sum() / np.diff(edges)
    histogram = np.log(heights[np.clip(np.searchsorted(edges, test) - 1, 0, 29)])
    smooth = np.log(kde(test, train, 0.6))
    return gaussian.mean(), histogram.mean(), smooth.mean()


def bimodal_cloud(rng: np.random.Generator, n: int = 100) -> np.ndarray:
    """n numbers, about half near -4 and half near +4, sd 1, within (-15, 15)."""
    return np.where(rng.random(n) < 0.5, -4.0, 4.0) + rng.standard_normal(n)


def _ranked(f, rng, runs):
    return [f(bimodal_cloud(rng), bimodal_cloud(rng)) for _ in range(runs)]


def _above(x, better, worse):
    d = x[:, better] - x[:, worse]
    z = d.mean() / (d.std(ddof=1) / math.sqrt(len(d)) + 1e-12)
    return True if z > 3 else f"mean scores {x.mean(0).round(2)}"


P6 = Question(
    "p6",
    "Inference between the particles",
    (
        Code(
            id="p6a",
            title="Kernel density estimate",
            points=2,
            reference=kde,
            hints=(
                "Put a small Gaussian of sd h on every sample.",
                "The density is the mean of these Gaussians.",
                "mean over samples of exp(-(x - s)^2 / (2 h^2)) / (h sqrt(2 pi)).",
            ),
            properties=(
                Property(
                    "integrates to one for h = .5 and h = 2",
                    lambda f: all(abs(_integral(f, h) - 1) < 1e-3 for h in (0.5, 2.0)),
                ),
                Property(
                    "one sample gives a Gaussian of sd h",
                    lambda f: np.allclose(
                        f(np.array([0.0, 2.0, 4.0]), np.zeros(1), 2.0)
                        / f(np.zeros(1), np.zeros(1), 2.0),
                        np.exp([0, -0.5, -2]),
                    ),
                ),
                Property(
                    "one number per x",
                    lambda f: np.shape(f(np.zeros(7), np.zeros(4), 1.0)) == (7,),
                ),
            ),
            fingerprint=lambda f: f(np.linspace(-3, 3, 9), rng_of(2).normal(size=6), 0.7),
            misconceptions=MUTANT["p6a"],
        ),
        Experiment(
            id="p6b",
            title="Which density predicts fresh particles best?",
            points=2,
            claim="on a belief with two hills: KDE above histogram above Gaussian",
            test="paired z of the mean held-out log score > 3, over 30 clouds",
            runs=30,
            margin="z is 44 (sd 7) and 17 (sd 2.4): 5.7 standard errors above 3",
            measure=_ranked,
            reference=fit_scores,
            hints=(
                "Fit on train, score on test: the mean of the log density.",
                "An empty cell has log density -inf: add half a particle to every cell.",
                "Return three numbers: Gaussian, histogram, KDE.",
            ),
            properties=(
                Property("three scores per cloud", lambda x: x.ndim == 2 and x.shape[1] == 3),
                Property("histogram above Gaussian", lambda x: _above(x, 1, 0)),
                Property("KDE above histogram", lambda x: _above(x, 2, 1)),
            ),
            misconceptions=(
                Misconception(
                    "scored-in-sample",
                    "scores the particles that the density was fitted to",
                    (
                        "A curve through all points would win your contest. Would it predict?",
                        "A score must use particles that the fit has not seen.",
                        "Evaluate the densities at test, not at train.",
                    ),
                    lambda train, test: _in_sample(train),
                    lambda x: x[:, 1].mean() > -1.99 and x[:, 2].mean() < x[:, 1].mean(),
                ),
                Misconception(
                    "order",
                    "returns the scores in another order",
                    (
                        "Which place has the score of the Gaussian in your result?",
                        "The order asked for is: Gaussian, histogram, KDE.",
                        "return gaussian.mean(), histogram.mean(), kde.mean().",
                    ),
                    lambda train, test: fit_scores(train, test)[::-1],
                    lambda x: x[:, 0].mean() > x[:, 1].mean() > x[:, 2].mean(),
                ),
            ),
        ),
    ),
)


def _integral(f, h):
    x = np.linspace(-30, 30, 3001)
    return float(np.sum(f(x, rng_of(1).normal(size=20), h)) * (x[1] - x[0]))


def _in_sample(train):
    mu, sd = train.mean(), train.std()
    gaussian = -0.5 * ((train - mu) / sd) ** 2 - np.log(sd * np.sqrt(2 * np.pi))
    edges = np.linspace(-15, 15, 301)
    counts = np.histogram(train, edges)[0]
    histogram = np.log(counts[np.searchsorted(edges, train) - 1] / len(train) / 0.1)
    return gaussian.mean(), histogram.mean(), np.log(kde(train, train, 0.6)).mean()


# -- P7: sample variance ---------------------------------------------------------------------

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
    """Each variance within 5 standard errors of M w (1 - w)."""
    c, n = x[:, 0], len(x)
    expected = 5 * W5 * (1 - W5)
    spread = ((c - c.mean(0)) ** 2).std(axis=0, ddof=1) / math.sqrt(n)
    return bool((np.abs(c.var(axis=0, ddof=1) - expected) < 5 * spread).all())


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
            test="means and variances within 5 standard errors; systematic variance <= .26",
            runs=1000,
            margin="5 standard errors, 15 comparisons",
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
                "c": "Yes, this is proved for both; systematic is usually better still, not always.",
                "d": "It does for systematic; for stratified and residual there is a proof.",
            },
        ),
    ),
)

# -- P8: uncertainty and number of particles -------------------------------------------------


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
            test="slope of log N against log area between .6 and 1.4",
            runs=200,
            margin="slope 1.04, sd .05: 7 standard errors",
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
                    "slope between .6 and 1.4",
                    lambda x: 0.6 < slope_of_need(x) < 1.4 or f"slope {slope_of_need(x):.2f}",
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
                    lambda x: 0.3 < slope_of_need(x) < 0.6,
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
                "c": "They describe the same belief more precisely; the belief itself stays as wide.",
                "d": "You have just measured a slope near 1.",
            },
        ),
    ),
)


def _kld(k: int, eps: float, z: float) -> float:
    """Number of particles that keeps the KL distance below eps (Fox 2003)."""
    a = 2 / (9 * (k - 1))
    return (k - 1) / (2 * eps) * (1 - a + math.sqrt(a) * z) ** 3


QUESTIONS = (P1, P2, P3, P4, P5, P6, P7, P8)
__all__ = ["QUESTIONS", "bimodal_cloud", "height_at_mean", "z_of_share"]
