"""Q4: random numbers, and the resamplers."""

from __future__ import annotations

import numpy as np

from pfkit.labs.items import (
    Code,
    Misconception,
    Numeric,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import rng_of

MUTANT = MUTANTS["lab3"]


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
W3 = np.array([0.32, 0.32, 0.36])
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
    return rng.count == 1 or f"it used {rng.count} of rng"


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
                    "stratified-and-systematic",
                    "takes stratified for systematic and the other way round",
                    (
                        "Which of the two moves all its points together?",
                        "Stratified: each of the M strata draws its own point.",
                        "Systematic: one number moves the whole comb.",
                    ),
                    (5, 1, 5, 2),
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
                "rest = M w - floor(M w); if left > 0: rng.choice(M, left, p=rest / rest.sum()).",
            ),
            properties=(
                _INDICES,
                Property(
                    "at least floor(M w) copies of each",
                    lambda f: bool((_counts(f, W8, 100) >= np.floor(8 * W8)).all()),
                ),
                Property("M w copies on average", lambda f: _unbiased(f, W)),
                Property(
                    "the rest is drawn one by one: sometimes a particle gets two of it",
                    lambda f: bool((_counts(f, W3, 100) >= np.floor(3 * W3) + 2).any()),
                ),
                Property(
                    "equal weights: one copy of each, nothing left to draw",
                    lambda f: bool((_counts(f, np.full(4, 0.25), 5) == 1).all()),
                ),
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
                    "weights sum to one, also for 3 ancestors of 5 particles",
                    lambda f: all(
                        np.isclose(np.sum(f(np.zeros((2, 5)), W, np.array(a))[1]), 1)
                        for a in ([0, 0, 1, 2, 3], [0, 0, 3])
                    ),
                ),
            ),
            fingerprint=lambda f: np.concatenate(
                [
                    np.ravel(x)
                    for a in ([0, 0, 1, 4, 3], [0, 0, 3])
                    for x in f(rng_of(1).normal(size=(2, 5)), W, np.array(a))
                ]
            ),
            misconceptions=MUTANT["q4d"],
        ),
    ),
)


QUESTIONS = (Q4,)
