"""Gates that ask the wrong number, mixtures that are no densities."""

import numpy as np

from pfkit.labs.items import Misconception


def by_the_best(likelihood, threshold):
    return np.max(likelihood) < threshold


def by_weights(likelihood, threshold):
    w = likelihood / np.sum(likelihood)
    return np.mean(w) < threshold


def wrong_way(likelihood, threshold):
    return np.mean(likelihood) > threshold


def by_the_sum(likelihood, threshold):
    return np.sum(likelihood) < threshold


def by_the_worst(likelihood, threshold):
    return np.min(likelihood) < threshold


GATE = (
    Misconception(
        "worst-particle",
        "asks the worst particle only",
        (
            "One stray particle closes your gate on every honest measurement.",
            "The belief as a whole decides, not one particle of it.",
            "Compare the mean of the likelihoods with the threshold.",
        ),
        by_the_worst,
    ),
    Misconception(
        "best-particle",
        "asks the best particle only",
        (
            "One lucky particle near an outlier opens your gate.",
            "The gate asks how probable the measurement is under the whole belief.",
            "Compare the mean of the likelihoods with the threshold.",
        ),
        by_the_best,
    ),
    Misconception(
        "normalised",
        "looks at normalised weights, whose mean is always 1/M",
        (
            "What is the mean of M numbers that sum to one?",
            "Normalising divides out exactly the quantity the gate needs.",
            "Use the likelihoods before they are normalised.",
        ),
        by_weights,
    ),
    Misconception(
        "wrong-way",
        "rejects the probable measurements and keeps the others",
        (
            "Which measurement is suspicious: one with a high or with a low likelihood?",
            "Return True for rejected.",
            "np.mean(likelihood) < threshold.",
        ),
        wrong_way,
    ),
    Misconception(
        "sum",
        "compares the sum, so the gate depends on the number of particles",
        (
            "Copy every particle once. Should the decision change?",
            "Divide by the number of particles.",
            "Compare np.mean(likelihood) with the threshold.",
        ),
        by_the_sum,
    ),
)


def epsilon_swapped(likelihood, epsilon, area):
    return epsilon * likelihood + (1 - epsilon) / area


def no_area(likelihood, epsilon, area):
    return (1 - epsilon) * likelihood + epsilon


def no_honest_share(likelihood, epsilon, area):
    return likelihood + epsilon / area


def larger_of_two(likelihood, epsilon, area):
    return np.maximum((1 - epsilon) * likelihood, epsilon / area)


def times_area(likelihood, epsilon, area):
    return (1 - epsilon) * likelihood + epsilon * area


MIXTURE = (
    Misconception(
        "times-area",
        "multiplies by the area, where a uniform density divides by it",
        (
            "Make the image larger. Should a false report at one place become more probable?",
            "A density that is the same everywhere integrates to one: 1/area.",
            "The outlier part is epsilon / area.",
        ),
        times_area,
    ),
    Misconception(
        "swapped",
        "gives epsilon to the honest part",
        (
            "Set epsilon to 0: nothing is ever false. What is left of your density?",
            "epsilon is the share of false measurements.",
            "(1 - epsilon) likelihood + epsilon / area.",
        ),
        epsilon_swapped,
    ),
    Misconception(
        "no-area",
        "adds a probability to a density: the outlier part lacks 1/area",
        (
            "Check units: the likelihood is per px^2.",
            "A false measurement falls anywhere in the image with the same density.",
            "The outlier part is epsilon / area.",
        ),
        no_area,
    ),
    Misconception(
        "not-a-density",
        "does not integrate to one: the honest part keeps its full share",
        (
            "Integrate over all measurements: 1 + epsilon. What must shrink?",
            "Shares of a mixture sum to one.",
            "Multiply the likelihood by (1 - epsilon).",
        ),
        no_honest_share,
    ),
    Misconception(
        "maximum",
        "takes the larger of the two parts instead of their sum",
        (
            "A measurement is false or honest; you do not know which. Total probability says?",
            "Sum over the two cases, each with its share.",
            "Add the two parts.",
        ),
        larger_of_two,
    ),
)

MUTANTS = {"lab4": {"q13a": GATE, "q13b": MIXTURE}}
