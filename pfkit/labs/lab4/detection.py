"""Q13: telling false measurements from honest ones."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import pfkit as pf
from pfkit.labs import Question, code, experiment
from pfkit.labs.lab4 import given as lab
from pfkit.labs.statistics import rng_of, shaped
from pfkit.labs.target import target_log

Q13 = Question("Detecting outliers")

FALSE = target_log("fixed", "outliers")

PATHS = ("fixed", "circle")


def _films(rng):
    """Two fresh films, half of each false: one target stands still, one goes round."""
    return [target_log(path, "outliers", seed=int(rng.integers(2**31))) for path in PATHS]


def _unlabelled(film):
    """The first hundred frames, without labels, and with the start in place of the truth."""
    still = np.repeat(film.start[:, None], len(film), axis=1)
    return replace(film, outlier=None, truth=still)[:100]


def _aucs(f, rng, runs):
    """Area under the curve of the scores: (runs, films)."""
    found = []
    for film in _films(rng):
        label = np.array([bool(k[0]) for k in film.outlier[:100]])
        given = shaped(f(_unlabelled(film), 100, rng, runs), 100, runs)
        found.append([lab.auc(score, label) for score in given.T])
    return np.array(found).T


_SURE, _MIXED = np.array([1e-3, 2e-3, 4e-4]), np.array([3e-2, 1e-9, 1e-9, 1e-9])

_WIDE = np.array([1e-9, 1e-8, 1e-6, 1e-5, 1e-2, 3e-2, 1e-1])

_BOX = np.full(100, 0.01)  # a density on 100 cells of size 1


def _mean_decides(f):
    """Likelihoods over many decades, thresholds just beside their mean."""
    rng = rng_of(3)
    for M in (1, 2, 7, 200):
        x = 10 ** rng.uniform(-9, -1, M)
        if not f(x, 1.01 * x.mean()) or f(x, 0.99 * x.mean()):
            return f"not so for {M} particles"
    return True


@code(
    """A gate
    Which single number says how probable the measurement is under the belief?
    Average the likelihoods over the particles, before normalising.
    np.mean(likelihood) < threshold.""",
    id="q13a",
    fingerprint=lambda f: [
        float(bool(f(x, t)))
        for x in (_SURE, _MIXED, _WIDE, np.tile(_SURE, 50))
        for t in (1.1e-3, *np.geomspace(1e-10, 0.5, 40))
    ],
)
def gate(likelihood, threshold):
    """Reject a measurement whose mean likelihood over the particles is below the threshold."""
    return np.mean(likelihood) < threshold


gate.holds("an improbable measurement is rejected", lambda f: f(_SURE, 0.1))
gate.holds("a probable one is kept", lambda f: not f(_SURE, 1e-4))
gate.holds(
    "one lucky particle of four does not decide alone",
    lambda f: bool(f(_MIXED, 0.01)) and not f(_MIXED, 0.005),
)
gate.holds(
    "copying every particle changes nothing",
    lambda f: all(
        bool(f(np.tile(_SURE, 50), t)) == bool(f(_SURE, t)) for t in (1e-4, 1.1e-3, 2e-3, 0.1)
    ),
)
gate.holds("the mean decides, whatever the likelihoods", _mean_decides)
gate.holds("at the threshold itself it is kept", lambda f: not f(np.full(4, 0.25), 0.25))
gate.wrong("""worst-particle: asks the worst particle only
    One stray particle closes your gate on every honest measurement.
    The belief as a whole decides, not one particle of it.
    Compare the mean of the likelihoods with the threshold.""")(
    lambda likelihood, threshold: np.min(likelihood) < threshold
)
gate.wrong("""best-particle: asks the best particle only
    One lucky particle near an outlier opens your gate.
    The gate asks how probable the measurement is under the whole belief.
    Compare the mean of the likelihoods with the threshold.""")(
    lambda likelihood, threshold: np.max(likelihood) < threshold
)


@gate.wrong("""looks at normalised weights, whose mean is always 1/M
    What is the mean of M numbers that sum to one?
    Normalising divides out exactly the quantity the gate needs.
    Use the likelihoods before they are normalised.""")
def normalised(likelihood, threshold):
    w = likelihood / np.sum(likelihood)
    return np.mean(w) < threshold


gate.wrong("""wrong-way: rejects the probable measurements and keeps the others
    Which measurement is suspicious: one with a high or with a low likelihood?
    Return True for rejected.
    np.mean(likelihood) < threshold.""")(
    lambda likelihood, threshold: np.mean(likelihood) > threshold
)
gate.wrong("""sum: compares the sum, so the gate depends on the number of particles
    Copy every particle once. Should the decision change?
    Divide by the number of particles.
    Compare np.mean(likelihood) with the threshold.""")(
    lambda likelihood, threshold: np.sum(likelihood) < threshold
)


gate.wrong("""median: asks the particle in the middle
    Where is the median if 60 of 100 particles are far from the measurement?
    A few particles with a large likelihood carry the belief's probability.
    Compare the mean of the likelihoods with the threshold.""")(
    lambda likelihood, threshold: np.median(likelihood) < threshold
)
gate.wrong(
    """each-particle: decides for each particle, where one measurement is kept or rejected
    How many measurements are there to reject?
    The belief as a whole gives one number.
    np.mean(likelihood) < threshold.""",
    when=lambda f: np.array_equal(f(_MIXED, 0.01), [False, True, True, True]),
)(lambda likelihood, threshold: likelihood < threshold)
gate.wrong("""mean-of-logs: averages logarithms: one impossible particle closes the gate
    What is the mean of the logarithms if one likelihood is nearly 0?
    The probability of a measurement is a mean of probabilities.
    Compare the mean of the likelihoods with the threshold.""")(
    lambda likelihood, threshold: np.mean(np.log(likelihood)) < np.log(threshold)
)
gate.refuses("is closed at the threshold itself")(
    lambda likelihood, threshold: np.mean(likelihood) <= threshold
)
gate.refuses("leaves out the largest")(
    lambda likelihood, threshold: (
        np.mean(np.sort(likelihood)[: max(1, len(likelihood) - 1)]) < threshold
    )
)
gate.refuses("divides by M - 1")(
    lambda likelihood, threshold: np.sum(likelihood) / max(1, len(likelihood) - 1) < threshold
)
gate.refuses("a threshold of its own")(lambda likelihood, threshold: np.mean(likelihood) < 1e-3)
gate.refuses("a root of the mean square")(
    lambda likelihood, threshold: np.sqrt(np.mean(likelihood**2)) < threshold
)


@code(
    """A mixture
    Two cases: honest with probability 1 - epsilon, false with epsilon.
    A false measurement falls anywhere in the image: density 1/area.
    (1 - epsilon) * likelihood + epsilon / area.""",
    id="q13b",
    fingerprint=lambda f: f(np.array([0.0, 1e-3, 9e-3, 0.05, 0.2]), 0.3, 40.0),
)
def mixture(likelihood, epsilon, area):
    """Density of a measurement that is false with probability epsilon."""
    return (1 - epsilon) * likelihood + epsilon / area


mixture.holds("epsilon = 0 changes nothing", lambda f: np.allclose(f(_SURE, 0.0, 100.0), _SURE))
mixture.holds("epsilon = 1 knows nothing", lambda f: np.allclose(f(_SURE, 1.0, 100.0), 0.01))
mixture.holds(
    "it integrates to one over the image", lambda f: np.isclose(np.sum(f(_BOX, 0.3, 100.0)), 1.0)
)
mixture.holds(
    "it is a sum, not a choice, of the two parts",
    lambda f: np.allclose(f(np.array([0.02, 0.01]), 0.5, 100.0), [0.015, 0.01]),
)
mixture.holds(
    "an impossible measurement keeps the density of a false one",
    lambda f: np.allclose(f(np.zeros(3), 0.2, 50.0), 0.004),
)
mixture.holds(
    "each particle has a density of its own, for other shares and areas",
    lambda f: np.allclose(
        [f(_SURE, 0.1, 20.0), f(_SURE, 0.6, 3e5)],
        [0.9 * _SURE + 0.005, 0.4 * _SURE + 2e-6],
        rtol=1e-6,
        atol=0,
    ),
)
mixture.wrong("""times-area: multiplies by the area, where a uniform density divides by it
    Make the image larger. Should a false report at one place become more probable?
    A density that is the same everywhere integrates to one: 1/area.
    The outlier part is epsilon / area.""")(
    lambda likelihood, epsilon, area: (1 - epsilon) * likelihood + epsilon * area
)
mixture.wrong("""swapped: gives epsilon to the honest part
    Set epsilon to 0: nothing is ever false. What is left of your density?
    epsilon is the share of false measurements.
    (1 - epsilon) likelihood + epsilon / area.""")(
    lambda likelihood, epsilon, area: epsilon * likelihood + (1 - epsilon) / area
)
mixture.wrong("""no-area: adds a probability to a density: the outlier part lacks 1/area
    Check units: the likelihood is per px^2.
    A false measurement falls anywhere in the image with the same density.
    The outlier part is epsilon / area.""")(
    lambda likelihood, epsilon, area: (1 - epsilon) * likelihood + epsilon
)
mixture.wrong("""not-a-density: does not integrate to one: the honest part keeps its full share
    Integrate over all measurements: 1 + epsilon. What must shrink?
    Shares of a mixture sum to one.
    Multiply the likelihood by (1 - epsilon).""")(
    lambda likelihood, epsilon, area: likelihood + epsilon / area
)
mixture.wrong("""maximum: takes the larger of the two parts instead of their sum
    A measurement is false or honest; you do not know which. Total probability says?
    Sum over the two cases, each with its share.
    Add the two parts.""")(
    lambda likelihood, epsilon, area: np.maximum((1 - epsilon) * likelihood, epsilon / area)
)


mixture.wrong("""always-half: has epsilon = .5, whatever it is asked
    Does your function use epsilon?
    The share of false measurements is an argument.
    (1 - epsilon) * likelihood + epsilon / area.""")(
    lambda likelihood, epsilon, area: 0.5 * likelihood + 0.5 / area
)
mixture.refuses("the mean over the particles")(
    lambda likelihood, epsilon, area: np.full(
        len(likelihood), (1 - epsilon) * np.mean(likelihood) + epsilon / area
    )
)
mixture.refuses("normalises over the particles")(
    lambda likelihood, epsilon, area: (
        ((1 - epsilon) * likelihood + epsilon / area)
        / np.sum((1 - epsilon) * likelihood + epsilon / area)
    )
)
mixture.refuses("the area of the lab's image")(
    lambda likelihood, epsilon, area: (1 - epsilon) * likelihood + epsilon / lab.AREA
)
mixture.refuses("a floor under the likelihood")(
    lambda likelihood, epsilon, area: np.maximum(likelihood, epsilon / area)
)
mixture.refuses("its logarithm")(
    lambda likelihood, epsilon, area: np.log((1 - epsilon) * likelihood + epsilon / area)
)


@experiment(
    """A score that tells false from honest
    The mean likelihood of each frame: lab.track(...).likelihood.
    Use the mixture as the sensor, so that outliers do not carry the filter away.
    pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA), with lab.model_of('circle', 1.4).""",
    id="q13c",
    points=2,
    claim="on films that it has never seen, with the labels taken off, the score ranks honest "
    "frames above false ones: AUC above .95 in every run",
    test="smallest area under the ROC curve over runs and films, against the labels",
    runs=5,
    pool=150,
    false_fail=1e-3,
    margin="median AUC above .995 on both films, against .95",
    measure=_aucs,
)
def scores(film, M, rng, runs):
    """A score of each frame, low for false measurements: shape (frames, runs)."""
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA)
    bel = lab.start_of("circle", film, (runs, M), rng)
    return lab.track(film, bel, lab.model_of("circle", 1.4), sensor, rng).likelihood


def _worst(x):
    return bool(x.min() > 0.95) or f"it is {x.min():.3f}"


scores.holds("AUC above .95 on the film of a target that stands still", lambda x: _worst(x[:, 0]))
scores.holds("AUC above .95 on the film of a target that moves", lambda x: _worst(x[:, 1]))


@scores.wrong(
    """gives high scores to false measurements
    Your AUC is close to 0: the ranking is perfect, and upside down.
    A false measurement has a low likelihood.
    Return the likelihood itself, not its negative or inverse.""",
    when=lambda x: x.max() < 0.05,
)
def upside_down(film, M, rng, runs):
    return -scores(film, M, rng, runs)


@scores.wrong(
    """gives all frames the same score, as normalised weights do: their mean is always 1/M
    What is the mean of M weights that sum to one?
    Normalising divides out exactly what the detector needs.
    lab.track(...).likelihood is taken before the weights are normalised.""",
    when=lambda x: bool((x == 0.5).all()),
)
def all_alike(film, M, rng, runs):
    return np.full((len(film), runs), 1 / M)


@scores.wrong(
    """loses the target that moves: its model stands still
    On which of the two films does your score fail?
    The film tells speed and turn rate of the target in film.u.
    lab.start_of('circle', ...) and lab.model_of('circle', 1.4) use them.""",
)
def stands_still(film, M, rng, runs):
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA)
    bel = lab.start_of("fixed", film, (runs, M), rng)
    return lab.track(film, bel, lab.model_of("fixed", 0.1), sensor, rng).likelihood


def _no_filter(film, runs, score):
    """The same score in all runs."""
    return np.repeat(np.asarray(score, dtype=float)[: len(film), None], runs, axis=1)


@scores.refuses("the distance from the start")
def distance_from_start(film, M, rng, runs):
    z = np.stack(film.z)[:, :, 0]
    return _no_filter(film, runs, -np.hypot(*(z - film.start[:2]).T))


@scores.refuses("random scores")
def guessed(film, M, rng, runs):
    return rng.random((len(film), runs))


@scores.refuses("the effective sample size, low where a measurement is honest", named="upside-down")
def sample_size(film, M, rng, runs):
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA)
    bel = lab.start_of("circle", film, (runs, M), rng)
    return lab.track(film, bel, lab.model_of("circle", 1.4), sensor, rng).ess


@scores.refuses("the scores of a film of its own")
def own_film(film, M, rng, runs):
    return scores(lab.half_false[: len(film)], M, rng, runs)


@scores.refuses("the labels of the film in the notebook")
def copied_labels(film, M, rng, runs):
    return _no_filter(film, runs, [not k[0] for k in lab.half_false.outlier or ()])


@scores.refuses("how far the measurement lies from the one before")
def from_the_last(film, M, rng, runs):
    z = np.stack(film.z)[:, :, 0]
    return _no_filter(film, runs, -np.hypot(*np.diff(z, axis=0, prepend=z[:1]).T))


@scores.refuses("the error of the filter against the truth that the film claims")
def claimed_error(film, M, rng, runs):
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA)
    bel = lab.start_of("circle", film, (runs, M), rng)
    return lab.track(film, bel, lab.model_of("circle", 1.4), sensor, rng).error
