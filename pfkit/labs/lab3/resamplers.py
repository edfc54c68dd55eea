"""Q4 and Q5: three resamplers, and who survives them."""

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
from pfkit.labs.statistics import rng_of, z_of_share

MUTANT = MUTANTS["lab3"]

# -- Q4 ------------------------------------------------------------------------------------------


def systematic(w, rng):
    """A comb with one random offset."""
    M = len(w)
    points = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), points, side="right"), M - 1)


def residual(w, rng):
    """floor(M w) copies for certain, the rest by chance in proportion to what is missing."""
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    rest = np.clip(M * w - copies, 0, None)
    left = M - copies.sum()
    drawn = rng.choice(M, left, p=rest / rest.sum()) if left else np.zeros(0, dtype=int)
    return np.concatenate([np.repeat(np.arange(M), copies), drawn])


def select(state, w, ancestors):
    """The new set: copied columns, equal weights."""
    n = len(ancestors)
    return state[:, ancestors], np.full(n, 1 / n)


W = np.array([0.40, 0.25, 0.15, 0.12, 0.08])
W8 = np.array([0.02, 0.31, 0.09, 0.14, 0.05, 0.11, 0.21, 0.07])


class Counting:
    """A random generator that counts the random numbers it hands out."""

    def __init__(self, seed: int) -> None:
        self._rng, self.count = rng_of(seed), 0

    def __getattr__(self, name):
        method = getattr(self._rng, name)

        def counted(*args, **kwargs):
            out = method(*args, **kwargs)
            self.count += np.size(out)
            return out

        return counted


def _counts(scheme, w, runs, seed=0):
    rng = rng_of(seed)
    found = [np.asarray(scheme(w.copy(), rng)) for _ in range(runs)]
    for ancestors in found:
        if ancestors.dtype.kind not in "iu" or ancestors.shape != w.shape:
            raise ValueError(f"expected {len(w)} whole numbers, got {ancestors!r:.60}")
    return np.stack([np.bincount(a, minlength=len(w)) for a in found])


def _unbiased(scheme, w, runs=1500):
    """Every mean number of copies within 5 standard errors of M w."""
    c = _counts(scheme, w, runs)
    bound = 5 * np.maximum(c.std(axis=0), 0.05) / np.sqrt(runs)
    off = np.abs(c.mean(0) - len(w) * w) > bound
    return not off.any() or f"particle {off.argmax()}: {c.mean(0)[off][0]:.2f} copies on average"


def _floor_or_ceil(scheme, w):
    c, expected = _counts(scheme, w, 200), len(w) * w
    return bool(((c >= np.floor(expected - 1e-9)) & (c <= np.ceil(expected + 1e-9))).all())


def _uses(scheme, w):
    rng = Counting(3)
    scheme(w.copy(), rng)
    return rng.count == 1 or f"it used {rng.count}"


def _fingerprint(scheme):
    """Mean and variance of the copies, and how far two particles vary together."""
    c = np.concatenate([_counts(scheme, w, 600, seed=7) for w in (W, W8)], axis=1)
    return [*c.mean(0), *(2 * c.var(0)), 2 * np.cov(c[:, 0], c[:, 1])[0, 1]]


_INDICES = Property(
    "M whole numbers between 0 and M - 1",
    lambda f: bool((_counts(f, W, 20).sum(axis=1) == 5).all()),
)

Q4 = Question(
    "q4",
    "Random numbers, and the resamplers",
    (
        Numeric(
            id="q4a",
            title="Random numbers used for w = (.40, .25, .15, .12, .08): multinomial, "
            "stratified, systematic, residual",
            key=(5.0, 5.0, 1.0, 2.0),
            tol=0.01,
            names=("multinomial", "stratified", "systematic", "residual"),
            hints=(
                "How many decisions of each scheme are left to chance?",
                "Residual copies floor(M w) particles for certain; count what is left.",
                "Residual: 5 - (2 + 1 + 0 + 0 + 0).",
            ),
            misconceptions=(
                Misconception(
                    "stratified-is-systematic",
                    "takes stratified for systematic",
                    (
                        "In stratified resampling, is the offset the same in each stratum?",
                        "Each of the M strata draws its own point.",
                        "Stratified uses M numbers.",
                    ),
                    (5, 1, 1, 2),
                ),
                Misconception(
                    "residual-all",
                    "lets residual draw all particles",
                    (
                        "Which copies does residual make without chance?",
                        "floor(M w) = (2, 1, 0, 0, 0) are certain.",
                        "Residual draws only the rest.",
                    ),
                    (5, 5, 1, 5),
                ),
                Misconception(
                    "residual-certain",
                    "gives the number of certain copies for residual",
                    (
                        "You counted what is *not* drawn.",
                        "5 particles in all, 3 of them certain.",
                        "Residual draws M minus the certain copies.",
                    ),
                    (5, 5, 1, 3),
                ),
            ),
        ),
        Code(
            id="q4b",
            title="Systematic resampling",
            points=4,
            reference=systematic,
            hints=(
                "Lay the weights end to end: np.cumsum(w). Then hold a comb against them.",
                "The comb has M teeth, 1/M apart; only its offset is random.",
                "np.searchsorted(np.cumsum(w), (np.arange(M) + rng.random()) / M).",
            ),
            properties=(
                _INDICES,
                Property("one random number per call", lambda f: _uses(f, W)),
                Property(
                    "each particle gets floor(M w) or ceil(M w) copies",
                    lambda f: _floor_or_ceil(f, W) and _floor_or_ceil(f, W8),
                ),
                Property("M w copies on average", lambda f: _unbiased(f, W8)),
            ),
            fingerprint=_fingerprint,
            atol=0.3,
            misconceptions=MUTANT["q4b"],
        ),
        Code(
            id="q4c",
            title="Residual resampling",
            points=3,
            reference=residual,
            hints=(
                "First the certain copies: floor(M w).",
                "Then draw the missing ones, in proportion to what each still has to get.",
                "rest = M w - floor(M w); rng.choice(M, left, p=rest / rest.sum()).",
            ),
            properties=(
                _INDICES,
                Property(
                    "at least floor(M w) copies of each",
                    lambda f: bool((_counts(f, W8, 100) >= np.floor(8 * W8)).all()),
                ),
                Property("M w copies on average", lambda f: _unbiased(f, W)),
            ),
            fingerprint=_fingerprint,
            atol=0.3,
            misconceptions=MUTANT["q4c"],
        ),
        Code(
            id="q4d",
            title="From ancestors to the new set",
            reference=select,
            hints=(
                "The ancestors are column numbers of the state.",
                "What does a copy weigh?",
                "return state[:, ancestors], np.full(n, 1 / n).",
            ),
            properties=(
                Property(
                    "states are copied by column",
                    lambda f: np.array_equal(
                        f(np.arange(6.0).reshape(2, 3), np.ones(3) / 3, np.array([2, 2, 0]))[0],
                        [[2, 2, 0], [5, 5, 3]],
                    ),
                ),
                Property(
                    "weights are equal",
                    lambda f: np.ptp(f(np.zeros((2, 5)), W, np.array([0, 0, 1, 2, 3]))[1]) < 1e-12,
                ),
                Property(
                    "weights sum to one",
                    lambda f: np.isclose(
                        np.sum(f(np.zeros((2, 5)), W, np.array([0, 0, 1, 2, 3]))[1]), 1
                    ),
                ),
            ),
            fingerprint=lambda f: np.concatenate(
                [
                    np.ravel(x)
                    for x in f(rng_of(1).normal(size=(2, 5)), W, np.array([0, 0, 1, 4, 3]))
                ]
            ),
            misconceptions=MUTANT["q4d"],
        ),
    ),
)

# -- Q5 ------------------------------------------------------------------------------------------


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
    return np.stack([f(scheme, w, rng, runs) for scheme, w in CASES], axis=1)


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
    return bool(np.allclose([float(pair[0]), float(pair[1])], [a, b]))


def _one_heavy(w):
    weights = np.full(100, (1 - w) / 99)
    weights[0] = w
    return weights


def _others_kept(w):
    weights = np.full(100, 0.02)
    weights[0] = w
    return weights / weights.sum()


QUESTIONS = (
    Q4,
    Q5,
)
