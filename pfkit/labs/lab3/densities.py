"""P6: what particles say about the places between them."""

from __future__ import annotations

from itertools import permutations

import numpy as np

from pfkit.labs import Question, code, experiment
from pfkit.labs.statistics import rng_of, shaped

P6 = Question("Inference between the particles")


NAMES = ("Gaussian", "histogram", "KDE", "mixture")
AS_GOOD = np.array([0.005, 0.001, 0.001, 0.02])  # nats: an sd may divide by n or by n - 1


def bimodal_cloud(
    rng: np.random.Generator, n: int, hills: tuple[float, float], share: float, sd: float
) -> np.ndarray:
    """n numbers, a share of them near the first hill and the rest near the second."""
    where = np.where(rng.random(n) < share, *hills)
    return np.clip(where + sd * rng.standard_normal(n), -14.9, 14.9)


def _cloud_pairs(rng, runs):
    """To train and to test, of one kind and of different size; each pair is of its own kind."""
    for _ in range(runs):
        kind = (-rng.uniform(3, 5), rng.uniform(3, 5)), rng.uniform(0.4, 0.6), rng.uniform(0.8, 1.2)
        yield tuple(bimodal_cloud(rng, int(rng.integers(80, 130)), *kind) for _ in range(2))


def _scored(f, rng, runs):
    """Scores of f, of the reference and of the wrong programs on the same clouds."""
    pairs = list(_cloud_pairs(rng, runs))
    programs = (fit_scores.reference, *(m.example for m in fit_scores.misconceptions))
    found = [[shaped(f(train.copy(), test.copy()), 4) for train, test in pairs]]
    found += [[shaped(g(train, test), 4) for train, test in pairs] for g in programs]
    if not np.isfinite(found[0]).all():
        name = NAMES[int((~np.isfinite(found[0])).any(axis=0).argmax())]
        raise ValueError(f"the score of the {name} is infinite or nan: is some density 0?")
    return np.stack(found, axis=-1)


def _like(name):
    """Does it score every cloud as this wrong program does?"""

    def when(x):
        k = 2 + [m.name for m in fit_scores.misconceptions].index(name)
        return (np.abs(x[..., 0] - x[..., k]) < AS_GOOD).all()

    return when


def _right(k):
    def holds(x):
        off = np.abs(x[:, k, 0] - x[:, k, 1])
        i = int(off.argmax())
        return bool(off[i] < AS_GOOD[k]) or (
            f"cloud {i + 1}: you gave {x[i, k, 0]:.3f}, a right answer {x[i, k, 1]:.3f}"
        )

    return holds


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
    """Density at each x: shape (len(x),)."""
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


def _as_reference(f):
    """Two samples, and many, near and far: relative to the density, so that tails count."""
    for x, samples, h in (
        (np.array([0.0, 1.0, 4.0, 9.0]), np.array([1.0, 3.0]), 1.0),
        (np.linspace(-6, 6, 13), rng_of(4).normal(size=30), 0.8),
    ):
        if not np.allclose(f(x, samples, h), kde(x, samples, h), rtol=1e-6, atol=0):
            return f"not for {samples.size} samples and h = {h}"
    return True


kde.holds("every sample counts alike, also far from all of them", _as_reference)
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


kde.refuses("a Gaussian of sd h at the mean of the samples")(
    lambda x, samples, h: np.exp(-0.5 * ((x - samples.mean()) / h) ** 2) / (h * np.sqrt(2 * np.pi))
)
kde.refuses("the nearest sample alone")(
    lambda x, samples, h: (
        np.exp(-0.5 * (np.abs(_d(x, samples)).min(axis=1) / h) ** 2) / (h * np.sqrt(2 * np.pi))
    )
)
kde.refuses("kernels cut off at four bandwidths")(
    lambda x, samples, h: (
        np.mean(np.exp(-0.5 * (_d(x, samples) / h) ** 2) * (np.abs(_d(x, samples)) < 4 * h), axis=1)
        / (h * np.sqrt(2 * np.pi))
    )
)
kde.refuses("box kernels")(
    lambda x, samples, h: np.mean(np.abs(_d(x, samples)) < h, axis=1) / (2 * h)
)
kde.refuses("a small number added against density 0")(
    lambda x, samples, h: kde(x, samples, h) + 1e-12
)
kde.refuses("normalises over the places that are asked for")(
    lambda x, samples, h: kde(x, samples, h) / np.sum(kde(x, samples, h))
)
kde.refuses("divides by M - 1")(
    lambda x, samples, h: kde(x, samples, h) * len(samples) / max(len(samples) - 1, 1)
)


@experiment(
    """Which density predicts fresh particles best?
    Fit on train, score on test: the mean of the log density.
    An empty cell has log density -inf: add half a particle to every cell.
    Return four numbers: Gaussian, histogram, KDE, mixture.""",
    id="p6b",
    points=2,
    claim="the four scores of every cloud are those of the four densities",
    test="on every cloud within .005 (Gaussian), .001 (histogram, KDE) and .02 nats (mixture) of "
    "a right one",
    runs=12,
    pool=240,
    margin="no chance enters; an sd that divides by n - 1 changes scores by .003 and .016 at most",
    measure=_scored,
)
def fit_scores(train, test):
    """Mean log density of test: Gaussian, histogram, KDE, mixture."""

    def normal(x, samples):
        mu, sd = samples.mean(), samples.std()
        return np.exp(-0.5 * ((x - mu) / sd) ** 2) / (sd * np.sqrt(2 * np.pi))

    edges = np.linspace(-15, 15, 31)
    counts = np.histogram(train, edges)[0] + 0.5  # half a particle more, so that no cell is empty
    heights = counts / counts.sum() / np.diff(edges)
    cells = np.searchsorted(edges, test, side="right") - 1
    parts = train[train < train.mean()], train[train >= train.mean()]
    mixture = sum(len(part) / len(train) * normal(test, part) for part in parts)
    curves = normal(test, train), heights[cells], kde(test, train, 0.6), mixture
    return [np.log(density).mean() for density in curves]


for _k, _name in enumerate(NAMES):
    fit_scores.holds(f"{_name}: the held-out score of every cloud", _right(_k))

fit_scores.wrong("""scored-in-sample: scores the particles that the density was fitted to
    A curve through all points would win your contest. Would it predict?
    A score must use particles that the fit has not seen.
    Evaluate the densities at test, not at train.""")(
    lambda train, test: fit_scores(train, train), when=_like("scored-in-sample")
)
fit_scores.wrong("""fitted-to-test: fits the densities to test and scores them at train
    Which of the two clouds may a fit look at?
    The arguments are exchanged.
    Fit to train, evaluate at test.""")(
    lambda train, test: fit_scores(test, train), when=_like("fitted-to-test")
)
fit_scores.wrong("""order: returns the scores in another order
    Which place has the score of the Gaussian in your result?
    The order asked for is: Gaussian, histogram, KDE, mixture.
    The Gaussian has the lowest score, and comes first.""")(
    lambda train, test: fit_scores(train, test)[::-1],
    when=lambda x: any(
        (np.abs(x[:, order, 0] - x[..., 1]) < AS_GOOD).all() for order in permutations(range(4))
    ),
)
fit_scores.wrong("""negated: has the sign of a loss: it is smallest for the best curve
    Is your score larger or smaller for a better curve?
    The logarithm of a density below 1 is negative.
    Return the mean log density itself, without a minus.""")(
    lambda train, test: [-s for s in fit_scores(train, test)], when=_like("negated")
)


def _at_each(train, test):
    """The four densities at every test point, (n, 4)."""
    return np.exp([fit_scores(train, point) for point in test[:, None]])


fit_scores.wrong("""not-a-logarithm: is a density, not the logarithm of one
    All your scores lie between 0 and 1. What is log .1?
    A product over fresh particles becomes a sum of logarithms.
    Take np.log of the density at each test point, then the mean.""")(
    lambda train, test: _at_each(train, test).mean(axis=0), when=_like("not-a-logarithm")
)
fit_scores.wrong("""log-of-mean: takes the logarithm after the mean
    What would one test point of density 0 do to your score? And to the right one?
    A score that forgives a density of 0 rewards bold curves.
    np.log first, then the mean over the test points.""")(
    lambda train, test: np.log(_at_each(train, test).mean(axis=0)), when=_like("log-of-mean")
)
fit_scores.wrong("""summed: adds the log densities, where their mean is asked for
    Your scores grow with the number of test points.
    A mean can be compared between clouds of different size.
    np.mean of the log densities, not np.sum.""")(
    lambda train, test: np.multiply(fit_scores(train, test), len(test)), when=_like("summed")
)
fit_scores.refuses("constants in the right order")(lambda train, test: [-2.84, -2.3, -2.2, -2.1])
fit_scores.refuses("the scores of one cloud for all")(
    lambda train, test: fit_scores(*next(_cloud_pairs(rng_of(1), 1)))
)
fit_scores.refuses("constants with the right scatter")(
    lambda train, test: rng_of(len(test)).normal([-2.84, -2.3, -2.2, -2.1], 0.1)
)
fit_scores.refuses("the Gaussian four times")(lambda train, test: [fit_scores(train, test)[0]] * 4)
fit_scores.refuses("scores half of the test points")(
    lambda train, test: fit_scores(train, test[::2])
)
fit_scores.refuses("fits to train and test together")(
    lambda train, test: fit_scores(np.concatenate([train, test]), test)
)
fit_scores.refuses("logarithms to base 10")(
    lambda train, test: np.divide(fit_scores(train, test), np.log(10))
)


def _changed(k, score):
    """The right scores but for one, such as another bandwidth."""

    def program(train, test):
        found = list(fit_scores(train, test))
        found[k] = score(train, test)
        return found

    return program


fit_scores.refuses("a bandwidth of 1 for .6")(
    _changed(2, lambda train, test: np.log(kde(test, train, 1.0)).mean())
)
fit_scores.refuses("both hills with equal shares")(
    _changed(3, lambda train, test: np.log(_two_equal_normals(test, train)).mean())
)
fit_scores.refuses("no half particle more, but a small number in empty cells")(
    _changed(1, lambda train, test: np.log(_heights(train, test) + 1e-9).mean())
)


def _two_equal_normals(x, samples):
    """Samples cut at their mean: each part is one hill of weight .5."""
    parts = samples[samples < samples.mean()], samples[samples >= samples.mean()]
    return sum(
        0.5
        * np.exp(-0.5 * ((x - part.mean()) / part.std()) ** 2)
        / (part.std() * np.sqrt(2 * np.pi))
        for part in parts
    )


def _heights(train, test):
    edges = np.linspace(-15, 15, 31)
    density = np.histogram(train, edges, density=True)[0]
    return density[np.searchsorted(edges, test, side="right") - 1]


def _integral(f, h):
    x = np.linspace(-30, 30, 3001)
    return float(np.sum(f(x, rng_of(1).normal(size=20), h)) * (x[1] - x[0]))
