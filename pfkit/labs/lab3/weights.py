"""P1 and P2: what particles are, and what they weigh."""

from __future__ import annotations

import math

import numpy as np

from pfkit.labs.items import (
    Choice,
    Code,
    Misconception,
    Numeric,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import rng_of

MUTANT = MUTANTS["lab3"]

# -- P1 ------------------------------------------------------------------------------------------

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

# -- P2 ------------------------------------------------------------------------------------------


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
                "d": "If they were, measuring were useless; they are independent given the pose.",
            },
        ),
    ),
)


QUESTIONS = (
    P1,
    P2,
)
