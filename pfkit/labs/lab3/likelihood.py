"""Q3: the constant in the likelihood."""

from __future__ import annotations

import numpy as np

from pfkit.labs.items import (
    Choice,
    Code,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import rng_of

MUTANT = MUTANTS["lab3"]


def log_likelihood(z, state, sigma):
    """log N(z; (x, y), sigma^2 I) at every state: two dimensions, full constant."""
    d2 = (z[0] - state[0]) ** 2 + (z[1] - state[1]) ** 2
    return -d2 / (2 * sigma**2) - np.log(2 * np.pi * sigma**2)


def weights_of(log_l):
    """Normalised weights from log-likelihoods, equal weights before."""
    w = np.exp(log_l - np.max(log_l))
    return w / w.sum()


_LOGS = np.array([-1.0, -3.0, -2.5, -0.2])


def _fix(seed):
    rng = rng_of(seed)
    return rng.normal(0, 2, 2), rng.normal(0, 2, (2, 12)), 1.7


def _integral(f, sigma):
    axis = np.arange(-40.0, 40.0, 0.5)
    grid = np.stack(np.meshgrid(axis, axis)).reshape(2, -1)
    return float(np.exp(f(np.zeros(2), grid, sigma)).sum() * 0.25)


Q3 = Question(
    "q3",
    "The constant in the likelihood",
    (
        Choice(
            id="q3a",
            title="Leave the constant out: what happens to the normalised weights?",
            key="a",
            options={
                "a": "Nothing",
                "b": "They become larger",
                "c": "They no longer sum to one",
                "d": "Particles far away gain weight",
            },
            feedback={
                "a": "Yes: every particle has the same factor, and normalising divides it out.",
                "b": "All likelihoods do, by the same factor; then the weights are normalised.",
                "c": "They are divided by their sum, whatever it is.",
                "d": "A common factor changes no ratio between particles.",
            },
        ),
        Choice(
            id="q3b",
            title="Where does it matter, then?",
            key="d",
            options={
                "a": "Nowhere in a particle filter",
                "b": "In the mean of the particles",
                "c": "In the effective sample size",
                "d": "In a gate on the likelihood, in a mixture with outliers, in the evidence",
            },
            feedback={
                "a": "It cancels in the weights; some steps use likelihoods not yet normalised.",
                "b": "The mean uses normalised weights.",
                "c": "The ESS uses normalised weights.",
                "d": "Yes: there likelihoods are compared with a number, or with each other.",
            },
        ),
        Code(
            id="q3c",
            title="Log-likelihood of a position, with its constant",
            points=3,
            reference=log_likelihood,
            hints=(
                "Write down the density of a Gaussian in two dimensions, then take its logarithm.",
                "The logarithm of exp(a) is a: no exp is needed.",
                "-(dx^2 + dy^2)/(2 sigma^2) - log(2 pi sigma^2).",
            ),
            properties=(
                Property(
                    "one number per particle",
                    lambda f: np.shape(f(*_fix(0))) == (12,),
                ),
                Property(
                    "a distance of one sigma costs 1/2",
                    lambda f: np.isclose(
                        f(np.zeros(2), np.zeros((2, 1)), 3.0)[0]
                        - f(np.array([3.0, 0]), np.zeros((2, 1)), 3.0)[0],
                        0.5,
                    ),
                ),
                Property(
                    "x and y errors add up: (3, 4) px costs as much as (5, 0)",
                    lambda f: np.isclose(
                        f(np.array([3.0, 4]), np.zeros((2, 1)), 2.0)[0],
                        f(np.array([5.0, 0]), np.zeros((2, 1)), 2.0)[0],
                    ),
                ),
                Property(
                    "the density integrates to one",
                    lambda f: (
                        abs(_integral(f, 3.0) - 1) < 1e-3 or f"it gives {_integral(f, 3.0):.3g}"
                    ),
                ),
                Property(
                    "finite and ordered at 5,000 and 10,000 sigma",
                    lambda f: bool(
                        -np.inf
                        < f(np.array([1e4, 0.0]), np.zeros((2, 1)), 1.0)[0]
                        < f(np.array([5e3, 0.0]), np.zeros((2, 1)), 1.0)[0]
                    ),
                ),
            ),
            fingerprint=lambda f: [*f(*_fix(1)), *f(np.array([60.0, 0]), np.zeros((2, 1)), 1.0)],
            misconceptions=MUTANT["q3c"],
        ),
        Code(
            id="q3d",
            title="Weights from log-likelihoods",
            reference=weights_of,
            hints=(
                "A constant added to all logarithms cancels when you normalise. Add a good one.",
                "Subtract the largest logarithm before exp: then the best particle has exp(0) = 1.",
                "w = np.exp(log_l - log_l.max()); w / w.sum().",
            ),
            properties=(
                Property(
                    "they sum to one, in the right proportions",
                    lambda f: np.allclose(f(_LOGS), np.exp(_LOGS) / np.exp(_LOGS).sum()),
                ),
                Property(
                    "a constant added to all changes nothing: the factor cancels",
                    lambda f: np.allclose(f(_LOGS - np.log(2 * np.pi * 9.0)), f(_LOGS)),
                ),
                Property(
                    "20,000 below zero they are still right",
                    lambda f: np.allclose(f(_LOGS - 2e4), weights_of(_LOGS)),
                ),
            ),
            fingerprint=lambda f: [*f(_LOGS), *np.nan_to_num(f(_LOGS - 2e4), nan=-1.0)],
            misconceptions=MUTANT["q3d"],
        ),
    ),
)


QUESTIONS = (Q3,)
