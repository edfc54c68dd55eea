r"""Resampling: from weights to copies.

Resampling replaces a weighted set by an equally weighted one in which particle m appears
N_m times, with the one property that every honest scheme shares: it is *unbiased*,

.. math:: E[N_m] = n\, w^{[m]} .

What differs is the variance of N_m, the luck that is added on top. All schemes here draw
points u in [0, 1) and pick the particle whose stretch of the cumulative weights holds the
point. Multinomial throws n independent points. Stratified throws one into each of n equal
strata. Systematic throws a single one and repeats it as a comb: each particle then gets the
floor or the ceiling of n w. Residual copies floor(n w) times and throws only for the rest.

Stratified and residual never have a larger offspring variance than multinomial. Systematic
usually has the smallest, but a smaller offspring variance does not imply a smaller error of
an *estimate*: the teeth of the comb are correlated, and a cloud whose weights alternate in
step with the comb is sampled badly.

Each scheme is a plain function ``scheme(w, rng, n=None)`` that returns ancestor indices
(int64). Weights may be ``(M,)`` or a batch ``(B, M)``; the result is ``(n,)`` or ``(B, n)``.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import (
    DegenerateWeightsError,
    ParameterError,
    ShapeError,
    require_count,
    require_finite,
)

Indices = NDArray[np.int64]
Resampler = Callable[..., Indices]


def _check(w: ArrayLike, n: int | None) -> tuple[NDArray[np.float64], int]:
    """Weights as normalised floats, and the number of draws."""
    w = require_finite("weights", w)
    if w.ndim == 0 or w.shape[-1] == 0:
        raise ShapeError(f"weights must have shape (M,) or (B, M) with M >= 1, got {w.shape}")
    if (w < 0).any():
        raise ParameterError(f"weights must be >= 0, got {w.min()}")
    total = w.sum(axis=-1, keepdims=True)
    if not (total > 0).all():
        raise DegenerateWeightsError("all weights are 0: nothing to copy; check the likelihood")
    return w / total, w.shape[-1] if n is None else require_count("n", n)


def _pick(w: NDArray[np.float64], u: NDArray[np.float64]) -> Indices:
    """The particle under each point: first i with cumulative weight > u. Points are sorted.

    Counting the points below each cumulative weight is a merge of two sorted lists: O(M + n).
    """
    M, n = w.shape[-1], u.shape[-1]
    if w.ndim > 1:
        flat_w, flat_u = w.reshape(-1, M), u.reshape(-1, n)
        rows = [_pick(row, points) for row, points in zip(flat_w, flat_u, strict=True)]
        return np.stack(rows).reshape(*w.shape[:-1], n)
    edges = np.cumsum(w)
    # rounding can leave the last edge below 1: the last particle with weight > 0 takes the rest
    edges[np.flatnonzero(w)[-1] :] = np.inf
    return np.searchsorted(edges, u, side="right").astype(np.int64)


def multinomial(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""n independent draws: the reference, and the noisiest.

    .. math:: \mathrm{Var}[N_m] = n\, w_m (1 - w_m)

    Parameters
    ----------
    w : array_like (M,) or (B, M), non-negative
        Need not sum to one.
    rng : numpy.random.Generator
    n : int, optional
        Number of draws; M if left out.

    Returns
    -------
    int64 array (n,) or (B, n), sorted ancestor indices

    Raises
    ------
    ParameterError, ShapeError, DegenerateWeightsError
        On NaN or negative weights, an empty set, or weights that are all zero.

    Notes
    -----
    Source: N. Gordon, D. Salmond and A. Smith, IEE Proc. F 140 (1993). Sorted uniforms come
    from normalised sums of exponentials, so the cost is O(M + n).
    """
    w, n = _check(w, n)
    gaps = rng.standard_exponential((*w.shape[:-1], n + 1))
    sums = np.cumsum(gaps, axis=-1)
    return _pick(w, sums[..., :-1] / sums[..., -1:])


def stratified(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""One draw in each of n equal strata: :math:`u_k = (k + U_k)/n`.

    Parameters, returns and errors are those of `multinomial`.

    Notes
    -----
    Source: G. Kitagawa, J. Comp. Graph. Stat. 5 (1996). Its offspring variance never exceeds
    that of multinomial (R. Douc, O. Cappe and E. Moulines, 2005). O(M + n), n random numbers.
    """
    w, n = _check(w, n)
    return _pick(w, (np.arange(n) + rng.random((*w.shape[:-1], n))) / n)


def systematic(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""A comb with one random offset: :math:`u_k = (k + U)/n`.

    Every particle gets :math:`\lfloor n w_m \rfloor` or :math:`\lceil n w_m \rceil` copies.
    Parameters, returns and errors are those of `multinomial`.

    Notes
    -----
    Source: Probabilistic Robotics, Table 4.4 (low variance sampler). O(M + n), one random
    number. We count the teeth below each cumulative weight instead of searching for each.
    """
    w, n = _check(w, n)
    offset = rng.random((*w.shape[:-1], 1))
    below = np.ceil(np.cumsum(w, axis=-1) * n - offset).astype(np.int64)
    below[..., -1] = n
    np.clip(below, 0, n, out=below)
    return _expand(w, below, n)


def _expand(w: NDArray[np.float64], below: Indices, n: int) -> Indices:
    """Turn "teeth up to and including particle m" into ancestor indices."""
    if w.ndim == 1:
        if w[-1] == 0:  # a tooth lost to rounding belongs to the last particle with weight > 0
            below[np.flatnonzero(w)[-1] :] = n
        return np.repeat(np.arange(w.size, dtype=np.int64), np.diff(below, prepend=0))
    rows = zip(w.reshape(-1, w.shape[-1]), below.reshape(-1, w.shape[-1]), strict=True)
    return np.stack([_expand(row, b, n) for row, b in rows]).reshape(*w.shape[:-1], n)


def residual(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""Copy :math:`\lfloor n w_m \rfloor` times, then draw the rest multinomially.

    The rest has weights :math:`n w_m - \lfloor n w_m \rfloor`: the fractional part of n w, not
    of w. Parameters, returns and errors are those of `multinomial`.

    Notes
    -----
    Source: J. S. Liu and R. Chen, JASA 93 (1998). O(M + n).
    """
    w, n = _check(w, n)
    if w.ndim > 1:
        rows = [residual(row, rng, n) for row in w.reshape(-1, w.shape[-1])]
        return np.stack(rows).reshape(*w.shape[:-1], n)
    expected = n * w
    copies = np.floor(expected + 1e-12 * n).astype(np.int64)  # 3.0 may arrive as 2.9999999999
    rest = np.maximum(expected - copies, 0.0)
    kept = np.repeat(np.arange(w.size, dtype=np.int64), copies)
    if kept.size >= n:
        return kept[:n]
    return np.sort(np.concatenate((kept, multinomial(rest, rng, n - kept.size))))


SCHEMES: dict[str, Resampler] = {
    "multinomial": multinomial,
    "stratified": stratified,
    "systematic": systematic,
    "residual": residual,
}
