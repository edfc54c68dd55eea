"""Clouds summarised by a density of the wrong width or the wrong total, or by a bad mean."""

import numpy as np

from pfkit.labs.items import Misconception


def _d(x, samples):
    return x[:, None] - samples[None, :]


def no_bandwidth(x, samples, h):
    return np.mean(np.exp(-0.5 * (_d(x, samples) / h) ** 2), axis=1) / np.sqrt(2 * np.pi)


def summed(x, samples, h):
    return np.sum(np.exp(-0.5 * (_d(x, samples) / h) ** 2), axis=1) / (np.sqrt(2 * np.pi) * h)


def h_as_variance(x, samples, h):
    return np.mean(np.exp(-0.5 * _d(x, samples) ** 2 / h), axis=1) / np.sqrt(2 * np.pi * h)


def no_half(x, samples, h):
    return np.mean(np.exp(-((_d(x, samples) / h) ** 2)), axis=1) / (np.sqrt(2 * np.pi) * h)


def wrong_axis(x, samples, h):
    return np.mean(np.exp(-0.5 * (_d(x, samples) / h) ** 2), axis=0) / (np.sqrt(2 * np.pi) * h)


KDE = (
    Misconception(
        "wrong-axis",
        "averages over x instead of over the samples",
        (
            "How many numbers come back for 7 places and 4 samples?",
            "At each place, average over the samples.",
            "With x[:, None] - samples, take the mean over axis 1.",
        ),
        wrong_axis,
    ),
    Misconception(
        "no-bandwidth",
        "does not divide by the bandwidth, so it integrates to h",
        (
            "Integrate it numerically for h = .5 and for h = 2.",
            "A wider kernel must be lower.",
            "Divide by h sqrt(2 pi).",
        ),
        no_bandwidth,
    ),
    Misconception(
        "summed",
        "adds the kernels without dividing by their number",
        (
            "Integrate it. You get the number of samples.",
            "Each sample holds a share 1/M of the belief.",
            "Take the mean over the samples, not the sum.",
        ),
        summed,
    ),
    Misconception(
        "h-as-variance",
        "uses h as a variance",
        (
            "Take one sample at 0 and h = 2. Where has the density fallen to 61 %?",
            "h is a standard deviation, in the unit of x.",
            "Exponent: -(x - s)^2 / (2 h^2).",
        ),
        h_as_variance,
    ),
    Misconception(
        "no-half",
        "lacks the 1/2 in the exponent",
        (
            "Integrate it. You get .707.",
            "Compare your exponent with the Gaussian's, factor by factor.",
            "Exponent: -(x - s)^2 / (2 h^2).",
        ),
        no_half,
    ),
)


def one_hill(rng):
    return rng.normal(0, 1, 400)


def hills_too_close(rng):
    return np.concatenate([rng.normal(-3.5, 1, 200), rng.normal(3.5, 1, 200)])


def a_hill_and_a_stray(rng):
    return np.concatenate([rng.normal(0, 1, 399), [30.0]])


def three_hills(rng):
    return np.concatenate([rng.normal(m, 1, 200) for m in (-15, 0, 15)])


def spread_evenly(rng):
    return rng.uniform(0, 100, 400)


BAD_MEAN = (
    Misconception(
        "even",
        "is spread evenly: the mean is as good a place as any other",
        (
            "How high is your density at the mean, compared with elsewhere?",
            "A wide belief alone does not make the mean a bad place.",
            "Leave a gap around the mean: half of the samples near -10, half near +10.",
        ),
        spread_evenly,
        lambda f: _even(f) and _low_at_mean(f) > 0.3,
    ),
    Misconception(
        "one-hill",
        "is a single hill, and its mean is its best point",
        (
            "Where is the mean of one symmetric hill?",
            "Let the belief hold two places at once.",
            "Half of the samples near -10, half near +10.",
        ),
        one_hill,
        lambda f: _modes(f) == 1 and not _stray(f) and _low_at_mean(f) > 0.01,
    ),
    Misconception(
        "too-close",
        "has hills that still overlap at the mean",
        (
            "How high is the density half way between your hills?",
            "Move them apart: the valley must fall below one hundredth of the top.",
            "Hills of sd 1 at -10 and +10 leave nothing at 0.",
        ),
        hills_too_close,
        lambda f: _modes(f) == 2 and _low_at_mean(f) > 0.01,
    ),
    Misconception(
        "stray",
        "is one hill with strays; they move the mean only a little",
        (
            "How far can one particle in 400 pull the mean?",
            "The second place must hold a good part of the weight.",
            "Half of the samples near -10, half near +10.",
        ),
        a_hill_and_a_stray,
        lambda f: _modes(f) == 1 and _stray(f) and _low_at_mean(f) > 0.01,
    ),
    Misconception(
        "middle-hill",
        "puts a hill where the mean lies",
        (
            "Mark the mean in your picture: is anything there?",
            "An odd number of symmetric hills has one in the middle.",
            "Leave the middle hill out.",
        ),
        three_hills,
        lambda f: _modes(f) >= 3 and _low_at_mean(f) > 0.01,
    ),
)


def _modes(f):
    """How many hills a histogram of unit cells shows, valleys at half height."""
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    grid = np.linspace(np.percentile(x, 0.5) - 3, np.percentile(x, 99.5) + 3, 400)
    height = np.exp(-0.5 * (grid[:, None] - x) ** 2).sum(1)
    high = height > 0.6 * height.max()
    return int(np.sum(np.diff(high.astype(int)) == 1) + high[0])


def _even(f):
    """Is the sd that of a uniform law over the range, range / sqrt(12)?"""
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    return abs(x.std() / np.ptp(x) - 12**-0.5) < 0.03


def _low_at_mean(f):
    """Density at the mean over the highest; kernels of sd 1."""
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    at = np.append(x, x.mean())
    height = np.exp(-0.5 * (at[:, None] - x) ** 2).sum(axis=1)
    return height[-1] / height.max()


def _stray(f):
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    return bool(np.abs(x - np.median(x)).max() > 8 * np.median(np.abs(x - np.median(x))))


MUTANTS = {"lab3": {"p5a": BAD_MEAN, "p6a": KDE}}
