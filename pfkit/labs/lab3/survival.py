"""Q5: who survives a resampling."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Code,
    Experiment,
    Misconception,
    Numeric,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import shaped, z_of_share

MUTANT = MUTANTS["lab3"]


def survival(w, M):
    """Probability to survive one resampling: multinomial, systematic."""
    return 1 - (1 - w) ** M, min(1.0, M * w)


def survived(scheme, w, rng, runs):
    """Does particle 0, of weight w among 100, survive? The others share the rest."""
    weights = np.full(100, (1 - w) / 99)
    weights[0] = w
    return np.array([0 in scheme(weights, rng) for _ in range(runs)])


CASES = tuple((s, w) for s in (pf.multinomial, pf.systematic) for w in (0.012, 0.005))
CHANCES = tuple(survival(w, 100)[k] for k in (0, 1) for w in (0.012, 0.005))


def _survived(f, rng, runs):
    return np.stack([shaped(f(scheme, w, rng, runs), runs) for scheme, w in CASES], axis=1)


Q5 = Question(
    "q5",
    "Survival",
    (
        Numeric(
            id="q5a",
            title="Survival of w = .012 and w = .005 among M = 100: multinomial, systematic",
            key=CHANCES,
            tol=0.003,
            names=(
                "multinomial, w = .012",
                "multinomial, w = .005",
                "systematic, w = .012",
                "systematic, w = .005",
            ),
            hints=(
                "Multinomial: what is the probability that all 100 draws miss?",
                "Systematic: compare the stretch w with the gap 1/M of the comb.",
                "1 - (1 - w)^M, and min(1, M w).",
            ),
            misconceptions=(
                Misconception(
                    "sign-error",
                    "has the sign of epsilon wrong, as one printed solution has: "
                    "with w = 1/M + eps the miss is 1 - 1/M - eps",
                    (
                        "Should a heavier particle survive more often or less often?",
                        "1 - w = 1 - 1/M - eps.",
                        "1 - (1 - .012)^100.",
                    ),
                    (1 - 0.992**100, CHANCES[1], 1.0, 0.5),
                ),
                Misconception(
                    "complement",
                    "is the probability to die",
                    (
                        "Which of the two weights should survive more often?",
                        "(1 - w)^M is the probability of M misses.",
                        "Take one minus it.",
                    ),
                    tuple(1 - p for p in CHANCES),
                ),
                Misconception(
                    "expected-copies",
                    "is the expected number of copies M w (cut at 1) for both schemes",
                    (
                        "Two copies of one particle are one survivor.",
                        "Multinomial can miss even a heavy particle.",
                        "Multinomial: 1 - (1 - w)^M.",
                    ),
                    (1.0, 0.5, 1.0, 0.5),
                ),
                Misconception(
                    "above-one",
                    "gives a probability above 1",
                    (
                        "A probability is at most 1.",
                        "A stretch of .012 is longer than the gap of .010: it is always hit.",
                        "Systematic: min(1, M w).",
                    ),
                    (CHANCES[0], CHANCES[1], 1.2, 0.5),
                ),
                Misconception(
                    "both-multinomial",
                    "uses the multinomial formula for the comb",
                    (
                        "Can a comb with gaps of .010 miss a stretch of .012?",
                        "A stretch shorter than the gap is hit with probability w / gap.",
                        "Systematic: min(1, M w).",
                    ),
                    (CHANCES[0], CHANCES[1], CHANCES[0], CHANCES[1]),
                ),
            ),
        ),
        Code(
            id="q5b",
            title="Survival as a function",
            reference=survival,
            hints=(
                "Return two numbers: multinomial, systematic.",
                "One is a power, the other a minimum.",
                "1 - (1 - w)**M, min(1, M * w).",
            ),
            properties=(
                Property("all the weight survives for certain", lambda f: _is(f(1.0, 50), 1, 1)),
                Property("no weight, no survival", lambda f: _is(f(0.0, 50), 0, 0)),
                Property("w = .015, M = 100", lambda f: _is(f(0.015, 100), 1 - 0.985**100, 1.0)),
                Property("w = .003, M = 100", lambda f: _is(f(0.003, 100), 1 - 0.997**100, 0.3)),
            ),
            fingerprint=lambda f: [x for w in (0.015, 0.003, 0.2) for x in f(w, 100)],
            misconceptions=MUTANT["q5b"],
        ),
        Experiment(
            id="q5c",
            title="Survival, measured",
            points=2,
            claim="the measured shares agree with the closed forms",
            test="|z| < 4.5 for each share that is neither 0 nor 1; the certain one is exactly 1",
            runs=2000,
            margin="4.5 standard errors, three shares: 2e-5 by the normal law",
            measure=_survived,
            reference=survived,
            hints=(
                "One True or False per run: is index 0 among the ancestors?",
                "Give particle 0 the weight w and the other 99 the rest in equal parts.",
                "np.array([0 in scheme(weights, rng) for _ in range(runs)]).",
            ),
            properties=(
                Property("True or False", lambda x: bool(np.isin(x, (0, 1)).all())),
                Property(
                    "multinomial as computed",
                    lambda x: (
                        max(abs(z_of_share(x[:, k], CHANCES[k])) for k in (0, 1)) < 4.5
                        or f"shares {x.mean(0)[:2].round(3)}"
                    ),
                ),
                Property(
                    "systematic as computed",
                    lambda x: (
                        (x[:, 2].all() and abs(z_of_share(x[:, 3], 0.5)) < 4.5)
                        or f"shares {x.mean(0)[2:].round(3)}"
                    ),
                ),
            ),
            misconceptions=(
                Misconception(
                    "copies",
                    "counts copies, where survival is yes or no",
                    (
                        "Some of your results are 2.",
                        "A particle with two copies has survived once.",
                        "0 in scheme(weights, rng) is True or False.",
                    ),
                    lambda scheme, w, rng, runs: np.array(
                        [np.sum(scheme(_one_heavy(w), rng) == 0) for _ in range(runs)]
                    ),
                    lambda x: x.max() > 1,
                ),
                Misconception(
                    "weights-not-normalised",
                    "leaves the others at 1/100, so the weights do not sum to one",
                    (
                        "What do your weights sum to?",
                        "If particle 0 has w, the others share 1 - w.",
                        "weights = np.full(100, (1 - w) / 99); weights[0] = w.",
                    ),
                    lambda scheme, w, rng, runs: np.array(
                        [0 in scheme(_others_kept(w), rng) for _ in range(runs)]
                    ),
                    lambda x: x[:, 0].mean() < 0.6 and 0.1 < x[:, 3].mean() < 0.4,
                ),
            ),
        ),
    ),
)


def _is(pair, a, b):
    found = [float(pair[0]), float(pair[1])]
    return bool(np.allclose(found, [a, b])) or f"it gives {found[0]:.4g}, {found[1]:.4g}"


def _one_heavy(w):
    weights = np.full(100, (1 - w) / 99)
    weights[0] = w
    return weights


def _others_kept(w):
    weights = np.full(100, 0.02)
    weights[0] = w
    return weights / weights.sum()


QUESTIONS = (Q5,)
