"""What a resampler does, seen from outside: which particles it copies, and how often.

Each function takes ``draw(w, rng)`` -> ancestors, a student's or a wrong one's.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.labs.statistics import rng_of

Draw = Callable[[NDArray[np.float64], np.random.Generator], Any]

FIVE = np.array([0.40, 0.25, 0.15, 0.12, 0.08])
ASTRIDE = np.array([0.1, 0.2, 0.3, 0.4])  # strata can give the second of these two copies
GAPS = np.array([0.0, 0.5, 0.0, 0.5, 0.0])
LARGEST = 120
SHORT = (49, 98, 103)  # sizes M at which np.arange(0, 1, 1 / M) has M + 1 entries


def of_size(M: int) -> NDArray[np.float64]:
    """Uneven weights of a set of M."""
    return rng_of(M).dirichlet(np.full(M, 2.0))


def counts(draw: Draw, w: NDArray[np.float64], runs: int = 100) -> NDArray[np.int64]:
    """Copies of each particle in each of many draws, shape (runs, M)."""
    M = w.size
    return np.stack(
        [np.bincount(np.asarray(draw(w.copy(), rng_of(s))), minlength=M) for s in range(runs)]
    )


def all_sizes(draw: Draw) -> bool | str:
    """M whole numbers from 0 to M - 1, for each M."""
    for M in range(1, LARGEST + 1):
        found = np.asarray(draw(of_size(M), rng_of(M)))
        if found.shape != (M,):
            return f"shape {found.shape} for {M} particles"
        if found.dtype.kind not in "iu":
            return f"numbers of type {found.dtype}"
        if found.min() < 0 or found.max() >= M:
            return f"{found.min()} to {found.max()} for {M} particles"
    return True


def fair(draw: Draw) -> bool | str:
    """M w copies on average, within 5 standard errors; two particles show where the comb starts."""
    for q in (0.1, 0.2, 0.3, 0.4, None):
        w = FIVE if q is None else np.array([q, 1 - q])
        N = counts(draw, w, 800)
        error = N.std(axis=0, ddof=1) / np.sqrt(len(N))
        if N.shape[1] != w.size or (np.abs(N.mean(0) - w.size * w) > 5 * error + 1e-9).any():
            return f"for weights {w.tolist()} on average {N.mean(0).round(2).tolist()} copies"
    return True


def floor_or_ceiling(draw: Draw) -> bool | str:
    """The whole number below or above M w, each time; so none where w is zero."""
    for w in (FIVE, ASTRIDE, GAPS):
        N = counts(draw, w)
        if N.shape[1] != w.size or (np.abs(N - w.size * w) >= 1 - 1e-9).any():
            return f"for weights {w.tolist()} up to {N.max(0).tolist()} copies"
    return True


def rough(draw: Draw) -> bool:
    """Weights that sum to one to three digits only: nobody gets a third copy."""
    w = np.full(100, 0.9997 / 100)
    N = counts(draw, w, 300)
    return bool(N.shape[1] == w.size and N.max() <= 2)


def luck_from_rng(draw: Draw) -> bool:
    """The same ``rng`` gives the same ancestors, and NumPy's global generator is left alone."""
    before = np.random.get_state()[1].copy()  # noqa: NPY002
    same = all(
        np.array_equal(draw(of_size(64), rng_of(s)), draw(of_size(64), rng_of(s))) for s in range(3)
    )
    return same and np.array_equal(before, np.random.get_state()[1])  # noqa: NPY002


def of_comb(w: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """The right ancestors."""
    return np.searchsorted(edges(w), teeth(w.size, rng))


def edges(w: NDArray[np.float64]) -> NDArray[np.float64]:
    """Summed weights, the last one beyond every tooth."""
    summed = np.cumsum(w / np.sum(w))
    summed[-1] = np.inf
    return summed


def teeth(M: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """The teeth of a comb."""
    return (np.arange(M) + rng.random()) / M


# -- usual mistakes, each as what shows it -----------------------------------------------------


def draws_as(draw: Draw, *others: Draw) -> bool:
    """Whether it gives the ancestors that one of the others does, seed by seed."""
    return any(
        all(
            np.array_equal(draw(w.copy(), rng_of(s)), other(w, rng_of(s)))
            for s in range(8)
            for w in (FIVE, of_size(12))
        )
        for other in others
    )


def is_multinomial(draw: Draw) -> bool:
    """Fair, and each particle scatters as with independent points."""
    N = counts(draw, FIVE, 1500)
    ratio = N.var(axis=0, ddof=1) / (5 * FIVE * (1 - FIVE))
    return bool((np.abs(ratio - 1) < 0.2).all() and fair(draw) is True)


def is_stratified(draw: Draw) -> bool:
    """Fair, and scatters where a particle lies astride two strata, by as much as it should."""
    N = counts(draw, ASTRIDE, 1500)
    wanted = [0.4 * 0.6, 0.4 * 0.6 + 0.2 * 0.8, 0.2 * 0.8 + 0.4 * 0.6, 0.4 * 0.6]
    return bool((np.abs(N.var(axis=0) - wanted) < 0.06).all() and fair(draw) is True)


def is_off_by_one(draw: Draw) -> bool:
    """Each ancestor is the right one's neighbour, always on the same side."""
    pairs = [(np.asarray(draw(w.copy(), rng_of(s))), of_comb(w, rng_of(s)), w.size)
             for s in range(8) for w in (FIVE, of_size(12))]  # fmt: skip
    above = all(np.isin(a, (b + 1, np.minimum(b + 1, M - 1))).all() and
                np.array_equal(np.minimum(a, M - 1), np.minimum(b + 1, M - 1))
                for a, b, M in pairs)  # fmt: skip
    below = all(np.array_equal(np.maximum(a, 0), np.maximum(b - 1, 0)) for a, b, M in pairs)
    return above or below


def has_one_too_many(draw: Draw) -> bool:
    """M + 1 ancestors where rounding lets ``np.arange(0, 1, 1 / M)`` have them, else M."""
    return all(
        np.size(draw(of_size(M), rng_of(k))) == M + (M in SHORT)
        for M in (5, 10, 50, *SHORT)
        for k in range(3)
    )


def never_varies(draw: Draw) -> bool:
    """The same copies whatever the random numbers, and each near M w."""
    N = counts(draw, FIVE, 50)
    return bool((N == N[0]).all() and (np.abs(N[0] - 5 * FIVE) < 1 - 1e-9).all())


def runs_off(draw: Draw) -> bool:
    """Right where the weights sum to one, beyond the last particle (or an IndexError) else."""
    w = np.full(100, 0.9997 / 100)
    if floor_or_ceiling(draw) is not True:
        return False
    try:
        return any(np.max(draw(w.copy(), rng_of(s))) == w.size for s in range(300))
    except IndexError:
        return True


def off_by_one(w: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """The neighbour of the particle under the tooth."""
    return np.minimum(of_comb(w, rng) + 1, w.size - 1)


def too_wide(w: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """Teeth 1 / (M - 1) apart."""
    M = w.size
    return np.searchsorted(edges(w), rng.random() / M + np.arange(M) / (M - 1))


def too_wide_throughout(w: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """Teeth 1 / (M - 1) apart, their start as well; so is U = r + m / (M - 1)."""
    return np.searchsorted(edges(w), (np.arange(w.size) + rng.random()) / (w.size - 1))


def one_too_many(w: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """Teeth from ``np.arange(0, 1, 1 / M)``."""
    M = w.size
    return np.searchsorted(edges(w), np.arange(0, 1, 1 / M) + rng.random() / M)


def in_the_middle(w: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """A comb that always starts at the same place."""
    return np.searchsorted(edges(w), (np.arange(w.size) + 0.5) / w.size)


def trusting(w: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """Trusts that the weights sum to one."""
    return np.searchsorted(np.cumsum(w), teeth(w.size, rng))
