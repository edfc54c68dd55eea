"""Likelihoods averaged, underflowing, or with the wrong width."""

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

MUTANTS = {"lab3": {"q3c": LIKELIHOOD}}
