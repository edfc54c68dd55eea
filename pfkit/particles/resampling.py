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
`SCHEMES` names the four. A fifth, `resampling_wheel`, is kept as a specimen in a module of its own.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DegenerateWeightsError, require_array, require_count, require_rng
from pfkit.particles import ticks

Array = NDArray[np.float64]
Indices = NDArray[np.int64]
Resampler = Callable[..., Indices]
MANY = 5000  # weights from which on whole numbers are faster than floats


def _read(w: ArrayLike, rng: np.random.Generator, n: int | None) -> tuple[Array, Array, int]:
    """Weights that are known to be usable, their sum (..., 1), and the number of draws."""
    w = require_array("weights", w, (..., "M"), ">= 0")
    require_rng(rng)
    total = w.sum(axis=-1, keepdims=True)
    if not (total.min() > 1e-280 and total.max() < 1e280):
        raise DegenerateWeightsError(
            f"the sum of weights must lie in 1e-280 to 1e280, got {total.min()} to {total.max()}; "
            "look for a likelihood of 0, keep log-weights and let normalise() scale them"
        )
    return w, total, w.shape[-1] if n is None else require_count("n", n)


def _comb(w: Array, n: int, u: Array) -> Indices:
    """Ancestors for a comb with one tooth in each of n equal strata, a share u into each.

    An edge of the cumulative weights, measured in strata, has ceil(edge - u) teeth before it. Read
    backwards, tooth k belongs to the first particle with more than k teeth before its edge.
    """
    if w.size > MANY:
        return ticks.comb(w, n, u)
    edges = np.cumsum(w, axis=-1)
    edges = edges / edges[..., -1:] * n
    u = np.minimum(u, 1 - 4e-16 * n)  # rounding must not leave a tooth beyond the last edge
    if u.shape[-1] > 1:
        u = np.take_along_axis(u, np.minimum(edges.astype(np.int64), n - 1), axis=-1)
    before = np.ceil(edges - u).astype(np.int64)
    return ticks.owners(before, n)


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
    from normalised sums of exponentials; each is then looked up in O(log M).
    """
    w, _, n = _read(w, rng, n)
    gaps = rng.standard_exponential((*w.shape[:-1], n + 1))
    points = np.cumsum(gaps, axis=-1)
    points /= points[..., -1:]
    return _find(np.cumsum(w, axis=-1), points[..., :-1])


def _find(edges: Array, u: Array) -> Indices:
    """The particle under each point u in [0, 1]: the first whose edge lies above it."""
    if edges.ndim > 1:
        rows = zip(edges.reshape(-1, edges.shape[-1]), u.reshape(-1, u.shape[-1]), strict=True)
        return np.stack([_find(row, points) for row, points in rows]).reshape(u.shape)
    edges = edges / edges[-1]
    edges[edges == 1.0] = np.inf  # a point that was rounded up to 1 still has a particle
    return np.searchsorted(edges, u, side="right").astype(np.int64, copy=False)


def stratified(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""One draw in each of n equal strata: :math:`u_k = (k + U_k)/n`.

    Parameters, returns and errors are those of `multinomial`.

    Notes
    -----
    Source: G. Kitagawa, J. Comp. Graph. Stat. 5 (1996). Its offspring variance never exceeds
    that of multinomial (R. Douc, O. Cappe and E. Moulines, 2005). O(M + n), n random numbers.
    """
    w, _, n = _read(w, rng, n)
    return _comb(w, n, rng.random((*w.shape[:-1], n)))


def systematic(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""A comb with one random offset: :math:`u_k = (k + U)/n`.

    Every particle gets :math:`\lfloor n w_m \rfloor` or :math:`\lceil n w_m \rceil` copies.

    Parameters
    ----------
    w : array_like (M,) or (B, M), non-negative
    rng : numpy.random.Generator
    n : int, optional

    Returns
    -------
    int64 array (n,) or (B, n), sorted ancestor indices

    Raises
    ------
    ParameterError, ShapeError, DegenerateWeightsError
        As `multinomial`.

    Notes
    -----
    Source: Probabilistic Robotics, Table 4.4 (low variance sampler). O(M + n), one random
    number.
    """
    w, _, n = _read(w, rng, n)
    return _comb(w, n, rng.random((*w.shape[:-1], 1)))


def residual(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""Copy :math:`\lfloor n w_m \rfloor` times, then draw the rest multinomially.

    The rest has weights :math:`n w_m - \lfloor n w_m \rfloor`: the fractional part of n w, not
    of w.

    Parameters, returns and errors are those of `multinomial`.

    Notes
    -----
    Source: J. S. Liu and R. Chen, JASA 93 (1998). O(M + n log M).
    """
    w, total, n = _read(w, rng, n)
    if w.ndim > 1:
        rows = [residual(row, rng, n) for row in w.reshape(-1, w.shape[-1])]
        return np.stack(rows).reshape(*w.shape[:-1], n)
    expected = n * (w / total)
    copies = np.floor(expected * (1 + 1e-12)).astype(np.int64)  # 3 may arrive as 2.9999999999
    kept = np.repeat(np.arange(w.size, dtype=np.int64), copies)
    if kept.size == n:
        return kept
    rest = np.maximum(expected - copies, 0.0)
    return np.sort(np.concatenate((kept, multinomial(rest, rng, n - kept.size))))


SCHEMES: dict[str, Resampler] = {
    "multinomial": multinomial,
    "stratified": stratified,
    "systematic": systematic,
    "residual": residual,
}
