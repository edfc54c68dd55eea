"""The comb of `resampling` for many particles: the same answer, in half the time.

Nothing is learnt here. Adding floats takes a processor four times as long as adding whole numbers,
so the weights become ticks, 2^bits to a stratum. Those add exactly, and nothing is searched. From
about five thousand particles on it pays: at 100,000 the comb takes 0.5 to 0.6 of the time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def comb(w: Array, n: int, u: Array) -> Indices:
    """Ancestors for a comb with one tooth in each of n equal strata, a share u into each.

    Teeth stand at k ticks + tooth, so an edge has (edge + ticks - 1 - tooth) // ticks of them
    before it: none before the edge 0 of a particle that has no weight.
    """
    bits = 62 - n.bit_length()
    ticks = 1 << bits
    edges = np.empty(w.shape, dtype=np.int64)  # written in place: fresh memory costs more than sums
    np.multiply(w, n * ticks / w.sum(axis=-1, keepdims=True), out=edges, casting="unsafe")
    np.cumsum(edges, axis=-1, out=edges)
    tooth = (u * ticks).astype(np.int64)
    last = tooth[..., -1:]  # rounding must not leave it beyond the last edge
    np.minimum(last, edges[..., -1:] - (n - 1) * ticks - 1, out=last)
    if u.shape[-1] > 1:
        tooth = np.take_along_axis(tooth, np.minimum(edges >> bits, n - 1), axis=-1)
    edges += ticks - 1 - tooth
    return owners(np.right_shift(edges, bits, out=edges), n)


def owners(before: Indices, n: int) -> Indices:
    """Whose are the n teeth? The first particle's with more than k teeth before its edge.

    `before` (M,) or (B, M) counts the teeth before each particle's edge.
    """
    if before.ndim == 1:
        counts = np.bincount(before, minlength=n)[:n]
    else:  # one long ruler for the whole batch, with n + 1 bins for each row
        rows = np.minimum(before, n).reshape(-1, before.shape[-1])
        rows += (n + 1) * np.arange(len(rows), dtype=np.int64)[:, None]
        counts = np.bincount(rows.ravel(), minlength=len(rows) * (n + 1))
        counts = counts.reshape(*before.shape[:-1], n + 1)[..., :n]
    counts = counts.astype(np.int64, copy=False)
    return np.cumsum(counts, axis=-1, out=counts)
