"""Q13: telling false measurements from honest ones."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Question, code, experiment
from pfkit.labs.statistics import shaped
from pfkit.labs.target import AREA, around, target_log, track

Q13 = Question("Detecting outliers")

FALSE = target_log("fixed", "outliers")
HOME = target_log("fixed", "low").start[:2]
IS_FALSE = np.array([bool(k[0]) for k in FALSE.outlier or ()])


def auc(score: np.ndarray, label: np.ndarray) -> float:
    """Probability that a random false measurement has a lower score than a random honest one."""
    bad, good = score[label][:, None], score[~label][None, :]
    return float(np.mean((bad < good) + 0.5 * (bad == good)))


def _aucs(f, rng, runs):
    found = shaped(f(rng, runs), 200, runs)
    return np.array([auc(found[:, k], IS_FALSE[:200]) for k in range(runs)])


_SURE, _MIXED = np.array([1e-3, 2e-3, 4e-4]), np.array([3e-2, 1e-9, 1e-9, 1e-9])


@code(
    """A gate
    Which single number says how probable the measurement is under the belief?
    Average the likelihoods over the particles, before normalising.
    np.mean(likelihood) < threshold.""",
    id="q13a",
    fingerprint=lambda f: [
        float(bool(f(x, t)))
        for x in (_SURE, _MIXED, np.tile(_SURE, 50))
        for t in (1e-6, 1e-4, 1.1e-3, 3e-3, 1e-2, 0.2, 0.3, 0.5)
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


@code(
    """A mixture
    Two cases: honest with probability 1 - epsilon, false with epsilon.
    A false measurement falls anywhere in the image: density 1/area.
    (1 - epsilon) * likelihood + epsilon / area.""",
    id="q13b",
    fingerprint=lambda f: f(np.array([0.0, 1e-3, 0.05, 0.2]), 0.3, 40.0),
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


@experiment(
    """Does the mean likelihood tell false from honest?
    lab.track(...).likelihood has one row per frame.
    Use the mixture as the sensor, so that outliers do not carry the filter away.
    pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA).""",
    id="q13c",
    points=2,
    claim="the mean likelihood ranks honest frames above false ones: AUC above .95",
    test="median over runs of the area under the ROC curve, against the known labels",
    runs=5,
    pool=250,
    margin="AUC .9996, sd below .001: over 40 standard errors",
    measure=_aucs,
)
def likelihoods(rng, runs):
    """Mean likelihood of each of 200 frames, (200, runs), from a filter that expects outliers."""
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / AREA)
    bel = around(HOME, (runs, 200), rng, sigma=5.0)
    return track(FALSE[:200], bel, pf.FixedTarget(1.4), sensor, rng).likelihood


likelihoods.holds("AUC above .95", lambda x: np.median(x) > 0.95 or f"it is {np.median(x):.3f}")
likelihoods.wrong("""upside-down: gives high scores to false measurements
    Your AUC is close to 0: the ranking is perfect, and upside down.
    A false measurement has a low likelihood.
    Return the likelihood itself, not its negative or inverse.""")(
    lambda rng, runs: -likelihoods(rng, runs), when=lambda x: np.median(x) < 0.05
)
likelihoods.wrong("""normalised: does not depend on the measurement: normalised weights have the
         mean 1/M
    All your scores are alike. What is the mean of M weights that sum to one?
    Normalising divides out exactly what the detector needs.
    lab.track(...).likelihood is taken before the weights are normalised.""")(
    lambda rng, runs: np.full((200, runs), 1 / 200), when=lambda x: abs(np.median(x) - 0.5) < 0.1
)

_BOX = np.full(100, 0.01)  # a density on 100 cells of size 1
