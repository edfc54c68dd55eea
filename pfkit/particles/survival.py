r"""Survival: the chance that a particle leaves at least one copy.

A particle whose children are all other particles' children is gone, and with it the
hypothesis that it stood for. Each resampling scheme has its own chance of sparing it,

.. math:: P(N_m \ge 1) ,

and for the four schemes of `resampling` that chance has a closed form. All four give the same
*expected* number of copies n w; they differ in how the copies clump, so they differ here:

=============  ====================================================================
multinomial    :math:`1 - (1 - w)^n`, about :math:`1 - 1/e = 0.63` for the average particle
residual       1 if :math:`n w \ge 1`, else the multinomial formula for the rest
stratified     :math:`1 - \prod_k (1 - o_k)`, with :math:`o_k` the overlap of the particle's
               stretch of the ruler with stratum k
systematic     :math:`\min(1,\, n w)`: the largest value that the expected count allows
=============  ====================================================================

No unbiased scheme can beat systematic for one particle, because a chance of survival is never
larger than the expected count n w (Markov's inequality), nor than 1. Over many resamplings with
nothing learnt between them the small differences multiply: that is why a symmetric world loses
its hypotheses sooner with one scheme than with another.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array, require_count

Array = NDArray[np.float64]


def survival_probability(w: ArrayLike, scheme: str, n: int | None = None) -> Array:
    r"""Probability that each particle leaves at least one copy in one resampling.

    .. math:: P(N_m \ge 1)

    Parameters
    ----------
    w : array_like (M,), non-negative
        Weights; need not sum to one. Their order matters for ``"stratified"``.
    scheme : {"multinomial", "residual", "stratified", "systematic"}
    n : int, optional
        Number of copies drawn; M if left out.

    Returns
    -------
    array (M,), probabilities in [0, 1]

    Raises
    ------
    ParameterError, ShapeError
        If the scheme is unknown, a weight is negative or not finite, or all are zero.

    Notes
    -----
    Source: R. Douc, O. Cappe and E. Moulines, "Comparison of resampling schemes for particle
    filtering" (2005), whose stratified and systematic draws these are. O(M).

    Examples
    --------
    >>> survival_probability([0.5, 0.3, 0.2], "systematic").round(3)
    array([1. , 0.9, 0.6])
    >>> survival_probability([0.5, 0.3, 0.2], "multinomial").round(3)
    array([0.875, 0.657, 0.488])
    """
    w = require_array("w", w, ("M",), "finite and >= 0")
    n = w.size if n is None else require_count("n", n)
    return np.minimum(_FORMULAS[scheme](w / w.sum(), n), 1.0)


def _multinomial(w: Array, n: int) -> Array:
    return 1 - (1 - np.minimum(w, 1.0)) ** n


def _systematic(w: Array, n: int) -> Array:
    return n * w


def _residual(w: Array, n: int) -> Array:
    copies = np.floor(n * w * (1 + 1e-12))
    draws = n - copies.sum()
    if draws == 0:
        return (copies > 0).astype(float)
    rest = np.maximum(n * w - copies, 0.0)
    return np.where(copies > 0, 1.0, _multinomial(rest / rest.sum(), int(draws)))


def _stratified(w: Array, n: int) -> Array:
    right = n * np.cumsum(w)
    left = right - n * w
    first, last = np.ceil(left), np.floor(right)  # the cell borders that the stretch meets
    inside = last < first  # the whole stretch lies in one stratum
    miss = np.where(inside, 1 - (right - left), (1 - (first - left)) * (1 - (right - last)))
    return 1 - np.where(last > first, 0.0, miss)  # two borders: a whole stratum, a sure copy


_FORMULAS = {
    "multinomial": _multinomial,
    "residual": _residual,
    "stratified": _stratified,
    "systematic": _systematic,
}
