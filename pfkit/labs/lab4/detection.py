"""Q13: telling false measurements from honest ones."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Code,
    Experiment,
    Misconception,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import shaped
from pfkit.labs.target import AREA, around, target_log, track

MUTANT = MUTANTS["lab4"]
FALSE = target_log("fixed", "outliers")
HOME = target_log("fixed", "low").start[:2]
IS_FALSE = np.array([bool(k[0]) for k in FALSE.outlier or ()])


def gate(likelihood, threshold):
    """Reject a measurement whose mean likelihood over the particles is below the threshold."""
    return bool(np.mean(likelihood) < threshold)


def mixture(likelihood, epsilon, area):
    """Density of a measurement that is false with probability epsilon."""
    return (1 - epsilon) * likelihood + epsilon / area


def likelihoods(rng, runs):
    """Mean likelihood of each of 200 frames, (200, runs), from a filter that expects outliers."""
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / AREA)
    bel = around(HOME, (runs, 200), rng, sigma=5.0)
    return track(FALSE[:200], bel, pf.FixedTarget(1.4), sensor, rng).likelihood


def auc(score: np.ndarray, label: np.ndarray) -> float:
    """Probability that a random false measurement has a lower score than a random honest one."""
    bad, good = score[label][:, None], score[~label][None, :]
    return float(np.mean((bad < good) + 0.5 * (bad == good)))


def _aucs(f, rng, runs):
    found = shaped(f(rng, runs), 200, runs)
    return np.array([auc(found[:, k], IS_FALSE[:200]) for k in range(runs)])


_SURE, _MIXED = np.array([1e-3, 2e-3, 4e-4]), np.array([3e-2, 1e-9, 1e-9, 1e-9])

Q13 = Question(
    "q13",
    "Detecting outliers",
    (
        Code(
            id="q13a",
            title="A gate",
            reference=gate,
            hints=(
                "Which single number says how probable the measurement is under the belief?",
                "Average the likelihoods over the particles, before normalising.",
                "np.mean(likelihood) < threshold.",
            ),
            properties=(
                Property("an improbable measurement is rejected", lambda f: bool(f(_SURE, 0.1))),
                Property("a probable one is kept", lambda f: not f(_SURE, 1e-4)),
                Property(
                    "one lucky particle of four does not decide alone",
                    lambda f: bool(f(_MIXED, 0.01)) and not f(_MIXED, 0.005),
                ),
                Property(
                    "copying every particle changes nothing",
                    lambda f: all(
                        bool(f(np.tile(_SURE, 50), t)) == bool(f(_SURE, t))
                        for t in (1e-4, 1.1e-3, 2e-3, 0.1)
                    ),
                ),
            ),
            fingerprint=lambda f: [
                float(bool(f(x, t)))
                for x in (_SURE, _MIXED, np.tile(_SURE, 50))
                for t in (1e-6, 1e-4, 1.1e-3, 3e-3, 1e-2, 0.2, 0.3, 0.5)
            ],
            misconceptions=MUTANT["q13a"],
        ),
        Code(
            id="q13b",
            title="A mixture",
            reference=mixture,
            hints=(
                "Two cases: honest with probability 1 - epsilon, false with epsilon.",
                "A false measurement falls anywhere in the image: density 1/area.",
                "(1 - epsilon) * likelihood + epsilon / area.",
            ),
            properties=(
                Property(
                    "epsilon = 0 changes nothing",
                    lambda f: np.allclose(f(_SURE, 0.0, 100.0), _SURE),
                ),
                Property(
                    "epsilon = 1 knows nothing",
                    lambda f: np.allclose(f(_SURE, 1.0, 100.0), 0.01),
                ),
                Property(
                    "it integrates to one over the image",
                    lambda f: np.isclose(np.sum(f(_BOX, 0.3, 100.0)), 1.0),
                ),
                Property(
                    "it is a sum, not a choice, of the two parts",
                    lambda f: np.allclose(f(np.array([0.02, 0.01]), 0.5, 100.0), [0.015, 0.01]),
                ),
            ),
            fingerprint=lambda f: f(np.array([0.0, 1e-3, 0.05, 0.2]), 0.3, 40.0),
            misconceptions=MUTANT["q13b"],
        ),
        Experiment(
            id="q13c",
            title="Does the mean likelihood tell false from honest?",
            points=2,
            claim="the mean likelihood ranks honest frames above false ones: AUC above .95",
            test="median over runs of the area under the ROC curve, against the known labels",
            runs=5,
            margin="AUC .9996, sd below .001: over 40 standard errors",
            measure=_aucs,
            reference=likelihoods,
            hints=(
                "lab.track(...).likelihood has one row per frame.",
                "Use the mixture as the sensor, so that outliers do not carry the filter away.",
                "pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA).",
            ),
            properties=(
                Property(
                    "AUC above .95",
                    lambda x: np.median(x) > 0.95 or f"it is {np.median(x):.3f}",
                ),
            ),
            misconceptions=(
                Misconception(
                    "upside-down",
                    "gives high scores to false measurements",
                    (
                        "Your AUC is close to 0: the ranking is perfect, and upside down.",
                        "A false measurement has a low likelihood.",
                        "Return the likelihood itself, not its negative or inverse.",
                    ),
                    lambda rng, runs: -likelihoods(rng, runs),
                    lambda x: np.median(x) < 0.05,
                ),
                Misconception(
                    "normalised",
                    "does not depend on the measurement: normalised weights have the mean 1/M",
                    (
                        "All your scores are alike. What is the mean of M weights that sum to one?",
                        "Normalising divides out exactly what the detector needs.",
                        "lab.track(...).likelihood is taken before the weights are normalised.",
                    ),
                    lambda rng, runs: np.full((200, runs), 1 / 200),
                    lambda x: abs(np.median(x) - 0.5) < 0.1,
                ),
            ),
        ),
    ),
)

_BOX = np.full(100, 0.01)  # a density on 100 cells of size 1


QUESTIONS = (Q13,)
