"""P5: when is the average a bad summary?"""

from __future__ import annotations

import math

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Choice,
    Code,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import rng_of

MUTANT = MUTANTS["lab3"]


def two_places(rng):
    return np.concatenate([rng.normal(-10, 1, 200), rng.normal(10, 1, 200)])


def height_at_mean(x: np.ndarray, h: float = 1.0) -> float:
    """Density at the mean as a share of the highest density; kernels of sd ``h``."""
    x = np.asarray(x, dtype=float)

    def density(at):
        return np.exp(-0.5 * ((np.atleast_1d(at)[:, None] - x) / h) ** 2).mean(axis=1)

    return float(density(x.mean())[0] / density(x).max())


def _enough(f):
    x = np.asarray(f(rng_of(1)), dtype=float)
    fine = x.ndim == 1 and 100 <= x.size <= 10_000 and np.isfinite(x).all()
    return bool(fine) or f"the shape is {x.shape}"


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
                Property("between 100 and 10,000 finite numbers, one dimension", _enough),
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


QUESTIONS = (P5,)
