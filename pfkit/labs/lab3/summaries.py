"""P5 and P6: from a cloud to an answer, and to a density."""

from __future__ import annotations

import math

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Choice,
    Code,
    Experiment,
    Misconception,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import rng_of

MUTANT = MUTANTS["lab3"]

# -- P5 ------------------------------------------------------------------------------------------


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

# -- P6 ------------------------------------------------------------------------------------------


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


QUESTIONS = (
    P5,
    P6,
)
