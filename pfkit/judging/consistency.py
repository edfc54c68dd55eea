r"""Consistency: does the filter know how wrong it is?

A filter answers with a pose *and* a spread. The answer is consistent when the two agree: of
all its 90 % regions, 90 % contain the truth. Too large a spread is a waste; too small a one is
dangerous, because whoever plans the next move trusts it. *Confident and wrong* is the failure
that a picture of one run does not show.

The classical test normalises the squared error by the claimed covariance,

.. math:: \mathrm{NEES} = e^T \Sigma^{-1} e ,

which has mean D, and a chi-square distribution when errors are Gaussian. `nees_band` says how
far its average over some runs may stray from D, and `coverage` counts how often the ellipse
that claims 90 % held the truth.

Steps of one run share their errors. Average over independent *runs*, or the bands lie.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import chi2_quantile
from pfkit.errors import ParameterError, require_array, require_number
from pfkit.judging.comparison import Interval, wilson_interval

Array = NDArray[np.float64]


def nees(error: ArrayLike, Sigma: ArrayLike) -> Array:
    r"""Normalised estimation error squared, :math:`e^T \Sigma^{-1} e`.

    Parameters
    ----------
    error : array_like (D, ...), of `pose_error`
    Sigma : array_like (D, D, ...), the covariance that the filter claims

    Returns
    -------
    array (...), >= 0; its mean is D for a consistent filter

    Raises
    ------
    ShapeError, ParameterError
        If the shapes do not match, or a covariance is not symmetric and positive definite.

    Notes
    -----
    Source: Y. Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with Applications to Tracking
    and Navigation (2001), section 5.4.
    """
    error = require_array("error", error, ("D", ...))
    Sigma = require_array("Sigma", Sigma, (len(error), *error.shape))
    columns = np.moveaxis(error, 0, -1)[..., None]
    matrices = np.moveaxis(Sigma, (0, 1), (-2, -1))
    if not np.allclose(matrices, np.swapaxes(matrices, -2, -1)):
        raise ParameterError(f"Sigma must be symmetric, got {Sigma!r:.60}; is it a covariance?")
    root = np.linalg.cholesky(matrices)
    return np.sum(np.linalg.solve(root, columns)[..., 0] ** 2, axis=-1)


def nees_band(D: int, runs: int, level: float = 0.95) -> tuple[float, float]:
    r"""Where the average NEES of independent runs lies if the filter is consistent.

    .. math:: \tfrac1n\, [\,\chi^2_{nD}(\tfrac{1-\ell}2),\; \chi^2_{nD}(\tfrac{1+\ell}2)\,]

    Parameters
    ----------
    D : int >= 1, components of the error
    runs : int >= 1, independent runs n that are averaged
    level : float in (0, 1)

    Returns
    -------
    low, high : floats; above means confident and wrong, below means too modest

    Raises
    ------
    ParameterError
        If D or runs is not a whole number of at least 1, or the level is not in (0, 1).
    """
    require_number("level", level, "in (0, 1)")
    low, high = (chi2_quantile(0.5 + s * level / 2, D * runs) / runs for s in (-1, 1))
    return low, high


def coverage(error: ArrayLike, Sigma: ArrayLike, level: float = 0.9) -> Interval:
    r"""How often the ellipse that claims to hold the truth with this probability does.

    .. math:: \tfrac1n \#\{\, e^T \Sigma^{-1} e \le \chi^2_D(\ell) \,\}

    Parameters
    ----------
    error : array_like (D, n), one column per independent run
    Sigma : array_like (D, D, n)
    level : float in (0, 1), the claim

    Returns
    -------
    Interval, the share and its 95 % Wilson interval; the claim should lie inside

    Raises
    ------
    ParameterError, ShapeError
        If the shapes do not belong together, a number is not finite, or the level is not in (0,
        1).
    """
    distance = nees(error, Sigma)
    inside = int(np.sum(distance <= chi2_quantile(level, len(np.asarray(error)))))
    return wilson_interval(inside, distance.size)
