"""P6: what particles say about the places between them."""

from __future__ import annotations

import math

import numpy as np

from pfkit.labs import Question, code, experiment
from pfkit.labs.statistics import rng_of, shaped

P6 = Question("Inference between the particles")


def _normal(x, samples):
    """Density at x of the Gaussian with the mean and the sd of samples."""
    mu, sd = samples.mean(), samples.std()
    return np.exp(-0.5 * ((x - mu) / sd) ** 2) / (sd * np.sqrt(2 * np.pi))


def _two_normals(x, samples):
    """Samples cut at their mean: each part is one hill, with its share, mean and sd."""
    parts = (samples[samples < samples.mean()], samples[samples >= samples.mean()])
    return sum(part.size / samples.size * _normal(x, part) for part in parts)


def bimodal_cloud(rng: np.random.Generator, n: int = 100) -> np.ndarray:
    """n numbers, about half near -4 and half near +4, sd 1, within (-15, 15)."""
    return np.where(rng.random(n) < 0.5, -4.0, 4.0) + rng.standard_normal(n)


NAMES = ("Gaussian", "histogram", "KDE", "mixture")


def _ranked(f, rng, runs):
    clouds = [(bimodal_cloud(rng), bimodal_cloud(rng)) for _ in range(runs)]
    found = np.stack([shaped(f(train, test), 4) for train, test in clouds])
    if not np.isfinite(found).all():
        name = NAMES[int((~np.isfinite(found)).any(axis=0).argmax())]
        raise ValueError(f"the score of the {name} is infinite or nan: is some density 0?")
    return found


def _above(x, better, worse):
    d = x[:, better] - x[:, worse]
    z = d.mean() / (d.std(ddof=1) / math.sqrt(len(d)) + 1e-12)
    return True if z > 3 else f"mean scores {x.mean(0).round(2)}"


@code(
    """Kernel density estimate
    Put a small Gaussian of sd h on every sample.
    The density is the mean of these Gaussians.
    mean over samples of exp(-(x - s)^2 / (2 h^2)) / (h sqrt(2 pi)).""",
    id="p6a",
    points=2,
    fingerprint=lambda f: f(np.linspace(-3, 3, 9), rng_of(2).normal(size=6), 0.7),
)
def kde(x, samples, h):
    d = (x[:, None] - samples[None, :]) / h
    return np.mean(np.exp(-0.5 * d**2), axis=1) / (np.sqrt(2 * np.pi) * h)


kde.holds(
    "integrates to one for h = .5 and h = 2",
    lambda f: all(abs(_integral(f, h) - 1) < 1e-3 for h in (0.5, 2.0)),
)
kde.holds(
    "one sample gives a Gaussian of sd h",
    lambda f: np.allclose(
        f(np.array([0.0, 2.0, 4.0]), np.zeros(1), 2.0) / f(np.zeros(1), np.zeros(1), 2.0),
        np.exp([0, -0.5, -2]),
    ),
)
kde.holds("one number per x", lambda f: np.shape(f(np.zeros(7), np.zeros(4), 1.0)) == (7,))


def _d(x, samples):
    return x[:, None] - samples[None, :]


kde.wrong("""wrong-axis: averages over x instead of over the samples
    How many numbers come back for 7 places and 4 samples?
    At each place, average over the samples.
    With x[:, None] - samples, take the mean over axis 1.""")(
    lambda x, samples, h: (
        np.mean(np.exp(-0.5 * (_d(x, samples) / h) ** 2), axis=0) / (np.sqrt(2 * np.pi) * h)
    )
)
kde.wrong("""no-bandwidth: does not divide by the bandwidth, so it integrates to h
    Integrate it numerically for h = .5 and for h = 2.
    A wider kernel must be lower.
    Divide by h sqrt(2 pi).""")(
    lambda x, samples, h: (
        np.mean(np.exp(-0.5 * (_d(x, samples) / h) ** 2), axis=1) / np.sqrt(2 * np.pi)
    )
)


@kde.wrong("""adds the kernels without dividing by their number
    Integrate it. You get the number of samples.
    Each sample holds a share 1/M of the belief.
    Take the mean over the samples, not the sum.""")
def summed(x, samples, h):
    return np.sum(np.exp(-0.5 * (_d(x, samples) / h) ** 2), axis=1) / (np.sqrt(2 * np.pi) * h)


kde.wrong("""h-as-variance: uses h as a variance
    Take one sample at 0 and h = 2. Where has the density fallen to 61 %?
    h is a standard deviation, in the unit of x.
    Exponent: -(x - s)^2 / (2 h^2).""")(
    lambda x, samples, h: (
        np.mean(np.exp(-0.5 * _d(x, samples) ** 2 / h), axis=1) / np.sqrt(2 * np.pi * h)
    )
)
kde.wrong("""no-half: lacks the 1/2 in the exponent
    Integrate it. You get .707.
    Compare your exponent with the Gaussian's, factor by factor.
    Exponent: -(x - s)^2 / (2 h^2).""")(
    lambda x, samples, h: (
        np.mean(np.exp(-((_d(x, samples) / h) ** 2)), axis=1) / (np.sqrt(2 * np.pi) * h)
    )
)


@experiment(
    """Which density predicts fresh particles best?
    Fit on train, score on test: the mean of the log density.
    An empty cell has log density -inf: add half a particle to every cell.
    Return four numbers: Gaussian, histogram, KDE, mixture.""",
    id="p6b",
    points=2,
    claim="on a belief with two hills: KDE and mixture above histogram above Gaussian",
    test="paired z of the mean held-out log score > 3; Gaussian between -3.2 and -2.5",
    runs=30,
    margin="z is 42, 17 and 16 (sd 2.5): 5 sd above 3; Gaussian -2.84, sd .01",
    measure=_ranked,
)
def fit_scores(train, test):
    """Mean log density of ``test``: Gaussian, histogram, KDE, mixture, fit to ``train``."""
    edges = np.linspace(-15, 15, 31)
    counts = np.histogram(train, edges)[0] + 0.5  # half a particle more, so that no cell is empty
    heights = counts / counts.sum() / np.diff(edges)
    histogram = np.log(heights[np.clip(np.searchsorted(edges, test) - 1, 0, 29)])
    curves = (_normal(test, train), kde(test, train, 0.6), _two_normals(test, train))
    gaussian, smooth, mixed = (np.log(density).mean() for density in curves)
    return gaussian, histogram.mean(), smooth, mixed


fit_scores.holds(
    "a mean log density: -3.2 to -2.5 for the Gaussian",
    lambda x: -3.2 < x[:, 0].mean() < -2.5 or f"it is {x[:, 0].mean():.3g}",
)
fit_scores.holds("histogram above Gaussian", lambda x: _above(x, 1, 0))
fit_scores.holds("KDE above histogram", lambda x: _above(x, 2, 1))
fit_scores.holds("mixture above histogram", lambda x: _above(x, 3, 1))
fit_scores.wrong("""scored-in-sample: scores the particles that the density was fitted to
    A curve through all points would win your contest. Would it predict?
    A score must use particles that the fit has not seen.
    Evaluate the densities at test, not at train.""")(
    lambda train, test: _in_sample(train),
    when=lambda x: -1.99 < x[:, 1].mean() < 0 and x[:, 2].mean() < x[:, 1].mean(),
)
fit_scores.wrong("""order: returns the scores in another order
    Which place has the score of the Gaussian in your result?
    The order asked for is: Gaussian, histogram, KDE, mixture.
    The Gaussian has the lowest score, and comes first.""")(
    lambda train, test: fit_scores(train, test)[::-1],
    when=lambda x: x.max() < 0 and x.mean(axis=0).argmin() > 0,
)
fit_scores.wrong("""negated: has the sign of a loss: it is smallest for the best curve
    Is your score larger or smaller for a better curve?
    The logarithm of a density below 1 is negative.
    Return the mean log density itself, without a minus.""")(
    lambda train, test: [-s for s in fit_scores(train, test)], when=lambda x: x.min() > 1
)
fit_scores.wrong("""not-a-logarithm: is a density, not the logarithm of one
    All your scores lie between 0 and 1. What is log .1?
    A product over fresh particles becomes a sum of logarithms.
    Take np.log of the density at each test point, then the mean.""")(
    lambda train, test: np.exp(fit_scores(train, test)), when=lambda x: x.min() > 0 and x.max() < 1
)
fit_scores.wrong("""summed: adds the log densities, where their mean is asked for
    Your scores grow with the number of test points.
    A mean can be compared between clouds of different size.
    np.mean of the log densities, not np.sum.""")(
    lambda train, test: [100 * s for s in fit_scores(train, test)], when=lambda x: x.max() < -100
)


def _integral(f, h):
    x = np.linspace(-30, 30, 3001)
    return float(np.sum(f(x, rng_of(1).normal(size=20), h)) * (x[1] - x[0]))


def _in_sample(train):
    gaussian, _, smooth, mixed = fit_scores(train, train)
    edges = np.linspace(-15, 15, 301)
    counts = np.histogram(train, edges)[0]
    histogram = np.log(counts[np.searchsorted(edges, train) - 1] / len(train) / 0.1)
    return gaussian, histogram.mean(), smooth, mixed
