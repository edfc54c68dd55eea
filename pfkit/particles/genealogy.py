r"""Genealogy: who descends from whom.

Each resampling gives every particle a parent. Followed backwards the parents form a tree. Few
generations ago the whole cloud has only a handful of ancestors, and at some depth a single
one. All estimates of the *past* that a filter keeps rest on those few lines.

Chance alone does this. Take two clusters with equal weight and resample N particles
multinomially, again and again, without any measurement. The share of the first cluster is a
fair random walk that ends at 0 or 1. It is the Wright-Fisher model of population genetics, and
its clock is known:

.. math:: E[\text{generations until one of two equal clusters is lost}] &\approx 2 N \ln 2 , \\
          E[\text{generations back to one common ancestor}] &\approx 2 N .

Systematic resampling of equal weights copies each particle once, so its clock stands still.

An array of ancestors is ``(T, M)`` or ``(T, B, M)``: row k holds, for each particle after step
k, the index of its parent before. `Genealogy` records it while `run` runs.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ParameterError, ShapeError, require_count, require_number
from pfkit.particles.resampling import Resampler

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


class Genealogy:
    """Records parents during a run: ``pf.run(..., watch=(tree := pf.Genealogy()))``."""

    def __init__(self) -> None:
        self._rows: list[Indices] = []

    def __call__(self, k: int, bel: Any, info: Any) -> None:
        """Keep the ancestors of one step; the signature is that of ``run``'s watch."""
        self._rows.append(info.ancestors)

    @property
    def ancestors(self) -> Indices:
        """Parents (T, M) or (T, B, M) of all steps so far."""
        return np.stack(self._rows)

    def __repr__(self) -> str:
        return f"Genealogy({len(self._rows)} steps)"


def ancestry(ancestors: ArrayLike) -> Indices:
    r"""Trace every final particle back to the start.

    .. math:: b_T = (0, \ldots, M-1), \qquad b_{k} = a_k[b_{k+1}]

    Parameters
    ----------
    ancestors : int array_like (T, M) or (T, B, M)

    Returns
    -------
    int64 array (T + 1, M) or (T + 1, B, M)
        Row k: the index, within generation k, of each final particle's ancestor. Generation 0
        is the prior. Plot its columns and you see the tree.

    Notes
    -----
    O(T M).
    """
    a = _indices(ancestors)
    b = np.empty((a.shape[0] + 1, *a.shape[1:]), dtype=np.int64)
    b[-1] = np.arange(a.shape[-1])
    for k in range(a.shape[0] - 1, -1, -1):
        b[k] = np.take_along_axis(a[k], b[k + 1], axis=-1)
    return b


def founders(ancestors: ArrayLike) -> Indices:
    r"""Which particle of the prior each later particle descends from.

    .. math:: f_0 = (0, \ldots, M-1), \qquad f_{k+1} = f_k[a_k]

    Parameters
    ----------
    ancestors : int array_like (T, M) or (T, B, M)

    Returns
    -------
    int64 array (T + 1, M) or (T + 1, B, M)
        Row k: the founders of generation k. Colour a cloud by them and watch the colours die.
    """
    a = _indices(ancestors)
    f = np.empty((a.shape[0] + 1, *a.shape[1:]), dtype=np.int64)
    f[0] = np.arange(a.shape[-1])
    for k in range(a.shape[0]):
        f[k + 1] = np.take_along_axis(f[k], a[k], axis=-1)
    return f


def count_distinct(indices: ArrayLike) -> Indices:
    """How many different values each row has: (..., M) -> (...).

    Parameters
    ----------
    indices : int array_like (..., M), e.g. of `ancestry` or `founders`

    Returns
    -------
    int64 array (...): 1 means that all descend from one
    """
    rows = np.sort(_indices(indices, least=1), axis=-1)
    return 1 + np.count_nonzero(np.diff(rows, axis=-1), axis=-1).astype(np.int64)


def coalescence_time(ancestors: ArrayLike) -> Array | np.float64:
    """Generations back from the end to the most recent ancestor of the whole cloud.

    Parameters
    ----------
    ancestors : int array_like (T, M) or (T, B, M)

    Returns
    -------
    float or (B,); inf if even the prior still has several ancestors of the final cloud
    """
    one = count_distinct(ancestry(ancestors)) == 1  # once true it stays true further back
    depth = one.shape[0] - np.sum(one, axis=0, dtype=float)
    return np.where(one[0], depth, np.inf)[()]


def drift_time(N: int, share: float = 0.5) -> float:
    r"""Expected resamplings until one of two clusters is lost by chance alone, exactly.

    .. math:: t_i &= 1 + \sum_{j=1}^{N-1} \binom{N}{j} p^j (1-p)^{N-j}\, t_j, \qquad p = i/N, \\
              t &\approx -2N\,(p \ln p + (1-p) \ln (1-p))

    Parameters
    ----------
    N : int >= 2, particles of equal weight, resampled multinomially
    share : float in [0, 1], the first cluster's share of them, rounded to a whole number

    Returns
    -------
    float, a number of resamplings; about 1.39 N for equal clusters

    Raises
    ------
    ParameterError
        If N is not a whole number of at least 2, or the share is not in [0, 1].

    Notes
    -----
    Solves N - 1 linear equations: O(N^3), fine up to some thousand. Source: W. J. Ewens,
    Mathematical Population Genetics, ch. 3 (the Wright-Fisher model).
    """
    N, share = require_count("N", N, 2), require_number("share", share, "in [0, 1]")
    i = round(share * N)
    if i in (0, N):
        return 0.0
    j = np.arange(1, N)
    log_choose = np.array(
        [math.lgamma(N + 1) - math.lgamma(k + 1) - math.lgamma(N - k + 1) for k in j]
    )
    p = (j / N)[:, None]
    stay = np.exp(log_choose + j * np.log(p) + (N - j) * np.log1p(-p))
    return float(np.linalg.solve(np.eye(N - 1) - stay, np.ones(N - 1))[i - 1])


def offspring_z(
    scheme: Resampler,
    w: ArrayLike,
    rng: np.random.Generator,
    draws: int = 2000,
    n: int | None = None,
) -> Array:
    r"""Is a resampling scheme unbiased? One z-score per particle.

    .. math:: z_m = \frac{\bar N_m - n w_m}{s_m / \sqrt{draws}}

    An unbiased scheme gives standard normal scores; a biased one grows with sqrt(draws).

    Parameters
    ----------
    scheme : Resampler
    w : array_like (M,), non-negative; need not sum to one
    rng : numpy.random.Generator
    draws : int, how often the scheme is called
    n : int, optional, copies per call; M if left out

    Returns
    -------
    array (M,). A count that never varies has z = 0 if it is right and infinity if it is not.

    Raises
    ------
    ParameterError, ShapeError
        If the weights are not one set of finite numbers >= 0, or the scheme is not a function.
    """
    w = np.asarray(w, dtype=float)
    n = w.size if n is None else n
    counts = np.stack([np.bincount(scheme(w, rng, n), minlength=w.size) for _ in range(draws)])
    excess = counts.mean(axis=0) - n * w / w.sum()
    excess[np.abs(excess) < 1e-9 * n] = 0.0
    error = counts.std(axis=0, ddof=1) / np.sqrt(draws)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(excess == 0, 0.0, excess / error)


def _indices(value: ArrayLike, least: int = 2) -> Indices:
    """Whole numbers with at least this many axes and one particle; indices stay below M."""
    a = np.asarray(value)
    if a.dtype.kind not in "iu" or a.ndim < least or a.shape[-1] == 0:
        raise ShapeError(
            f"ancestors must be whole numbers (T, M) or (T, B, M), got {a.dtype} of shape {a.shape}"
        )
    if least == 2 and a.size and (a.min() < 0 or a.max() >= a.shape[-1]):
        raise ParameterError(
            f"ancestors must lie in 0..{a.shape[-1] - 1}, got {a.min()}..{a.max()}"
        )
    return a.astype(np.int64, copy=False)
