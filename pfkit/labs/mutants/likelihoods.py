"""Likelihoods averaged, underflowing, or with the wrong width; gates and mixtures."""

import numpy as np

from pfkit.labs.items import Misconception


def _d2(z, state):
    return (z[0] - state[0]) ** 2, (z[1] - state[1]) ** 2


def averaged(z, state, sigma):
    dx, dy = _d2(z, state)
    one = 1 / (np.sqrt(2 * np.pi) * sigma)
    return np.log((one * np.exp(-dx / 2 / sigma**2) + one * np.exp(-dy / 2 / sigma**2)) / 2)


def sigma_for_variance(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / (2 * sigma) - np.log(2 * np.pi * sigma)


def constant_of_one_dimension(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / (2 * sigma**2) - np.log(np.sqrt(2 * np.pi) * sigma)


def no_constant(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / (2 * sigma**2)


def log_of_exp(z, state, sigma):
    dx, dy = _d2(z, state)
    return np.log(np.exp(-(dx + dy) / (2 * sigma**2)) / (2 * np.pi * sigma**2))


def hidden_floor(z, state, sigma):
    dx, dy = _d2(z, state)
    return np.log(np.exp(-(dx + dy) / (2 * sigma**2)) / (2 * np.pi * sigma**2) + 1e-300)


def no_half(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / sigma**2 - np.log(2 * np.pi * sigma**2)


def not_the_logarithm(z, state, sigma):
    dx, dy = _d2(z, state)
    return np.exp(-(dx + dy) / (2 * sigma**2)) / (2 * np.pi * sigma**2)


LIKELIHOOD = (
    Misconception(
        "no-half",
        "lacks the 1/2 in the exponent",
        (
            "Integrate your density over the image. You get one half.",
            "Compare your exponent with the one in the question, factor by factor.",
            "Exponent: -(dx^2 + dy^2) / (2 sigma^2).",
        ),
        no_half,
    ),
    Misconception(
        "no-logarithm",
        "returns the density itself, not its logarithm",
        (
            "Far away your value is 0. What should a logarithm be there?",
            "The question asks for log p, which is negative and large far away.",
            "Take the logarithm on paper: -(dx^2 + dy^2)/(2 sigma^2) - log(2 pi sigma^2).",
        ),
        not_the_logarithm,
    ),
    Misconception(
        "averaged",
        "behaves like an average of the two likelihoods, where both must hold at once",
        (
            "Put a particle right in x and 100 px wrong in y. Is it half right?",
            "Independent measurements multiply: p(zx, zy | x) = p(zx | x) p(zy | x).",
            "In logarithms: add the two terms, with no division by two.",
        ),
        averaged,
    ),
    Misconception(
        "sigma-for-variance",
        "uses sigma where the density has sigma squared",
        (
            "Check the units: px^2 in the exponent must be divided by px^2.",
            "sigma is a standard deviation; the Gaussian divides by its square.",
            "Exponent: -(dx^2 + dy^2) / (2 sigma^2).",
        ),
        sigma_for_variance,
    ),
    Misconception(
        "constant-1d",
        "has the normalising constant of one dimension",
        (
            "Integrate your density over the image. Do you get 1?",
            "Two independent components bring their constant twice.",
            "The constant is 1/(2 pi sigma^2).",
        ),
        constant_of_one_dimension,
    ),
    Misconception(
        "no-constant",
        "leaves the normalising constant out",
        (
            "It cancels in the weights. This item asks for the density itself.",
            "Integrate your density over the image. Do you get 1?",
            "Subtract log(2 pi sigma^2).",
        ),
        no_constant,
    ),
    Misconception(
        "underflow",
        "takes the logarithm of an exponential, which is 0 far away, so you get -inf",
        (
            "What is np.exp(-1000)? And its logarithm?",
            "Write the logarithm of the formula down, and let exp and log cancel on paper.",
            "log p = -(dx^2 + dy^2)/(2 sigma^2) - log(2 pi sigma^2), without any exp.",
        ),
        log_of_exp,
    ),
    Misconception(
        "floor",
        "hides the underflow behind a small added number",
        (
            "Two particles at 50 and at 5,000 sigma: does yours still prefer the nearer one?",
            "The floor makes all far particles equal, and the filter then resamples at random.",
            "Stay with logarithms; then no floor is needed.",
        ),
        hidden_floor,
    ),
)


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

MUTANTS = {"lab3": {"q3c": LIKELIHOOD}, "lab4": {"q13a": GATE, "q13b": MIXTURE}}
