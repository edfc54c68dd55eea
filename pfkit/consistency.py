r"""Consistency: does the filter know how wrong it is?

A filter answers with a pose *and* a spread. The answer is consistent when the two agree: of
all its 90 % regions, 90 % contain the truth. Too large a spread is a waste; too small a one is
dangerous, because whoever plans the next move trusts it. *Confident and wrong* is the failure
that a picture of one run does not show.

The classical test normalises the squared error by the claimed covariance,

.. math:: \mathrm{NEES} = e^T \Sigma^{-1} e ,

which has mean D, and a chi-square distribution when errors are Gaussian. A particle cloud can
do without the Gaussian: the `credibility` of the truth is the share of the cloud that lies
nearer to its centre than the truth does, and must be uniform between 0 and 1.

Steps of one run share their errors. Average over independent *runs*, or the bands lie.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.chi2 import chi2_quantile
from pfkit.comparison import Interval, wilson_interval
from pfkit.errors import (
    ParameterError,
    ShapeError,
    require_components,
    require_count,
    require_finite,
    require_instance,
    require_number,
)
from pfkit.estimators import covariance, mean_pose
from pfkit.geometry import wrap
from pfkit.particles import Particles

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
        If the shapes do not match, or a covariance is not positive definite.

    Notes
    -----
    Source: Y. Bar-Shalom, X. R. Li, T. Kirubarajan, Estimation with Applications to Tracking
    and Navigation (2001), section 5.4.
    """
    error, Sigma = require_finite("error", error), require_finite("Sigma", Sigma)
    if error.ndim == 0 or Sigma.shape != (len(error), *error.shape):
        raise ShapeError(f"error (D, ...) needs Sigma (D, D, ...): {error.shape}, {Sigma.shape}")
    columns = np.moveaxis(error, 0, -1)[..., None]
    matrices = np.moveaxis(Sigma, (0, 1), (-2, -1))
    try:
        root = np.linalg.cholesky(matrices)
    except np.linalg.LinAlgError:
        raise ParameterError(
            "Sigma must be positive definite, but a cloud has collapsed; skip such steps or "
            "add process noise"
        ) from None
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
    D, runs = require_count("D", D), require_count("runs", runs)
    if not 0 < require_number("level", level) < 1:
        raise ParameterError(f"level must be in (0, 1), got {level}; 0.95 is usual")
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
    if distance.ndim != 1:
        raise ShapeError(f"coverage counts runs: error must be (D, n), got {np.shape(error)}")
    if not 0 < require_number("level", level) < 1:
        raise ParameterError(f"level must be in (0, 1), got {level}")
    inside = int(np.sum(distance <= chi2_quantile(level, len(np.asarray(error)))))
    return wilson_interval(inside, distance.size)


def credibility(bel: Particles, truth: ArrayLike) -> Array | np.float64:
    r"""Share of the cloud that lies nearer to its centre than the truth.

    .. math:: c = \sum_m w_m\, [\,d(x_m) < d(x)\,] + \tfrac12 \sum_m w_m\, [\,d(x_m) = d(x)\,],
              \qquad d(x) = (x - \bar x)^T \Sigma^{-1} (x - \bar x)

    The truth lies in the cloud's 90 % region if c <= 0.9. Over runs of a consistent filter c
    is uniform: sort the values and plot them against (i - 1/2)/n, the calibration plot. A pile
    near 1 is confident and wrong.

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M), not collapsed to a point
    truth : array_like (D,), (D, B) or (D, B, 1)

    Returns
    -------
    float or (B,), between 0 and 1

    Raises
    ------
    ParameterError, ShapeError
        If `bel` is not a particle set, or the truth is not one pose (per filter).
    """
    require_instance("bel", bel, Particles)
    D, batch = bel.state.shape[0], bel.log_w.shape[:-1]
    truth = require_finite("truth", require_components("truth", truth, D))
    if truth.shape not in ((D,), (D, *batch), (D, *batch, 1)):
        raise ShapeError(f"truth must be (D,) or (D, B), got {truth.shape} for {bel}")
    truth = (
        truth.reshape(D, -1)[:, 0]
        if not batch
        else np.broadcast_to(truth.reshape(D, -1), (D, *batch))
    )
    centre, Sigma = mean_pose(bel), covariance(bel)
    points = np.concatenate((truth[..., None], bel.state), axis=-1) - centre[..., None]
    if D >= 3:
        points[2] = wrap(points[2])
    d = nees(points, np.broadcast_to(Sigma[..., None], (D, *points.shape)))
    own, others = d[..., :1], d[..., 1:]
    return np.sum(bel.w * ((others < own) + 0.5 * (others == own)), axis=-1)
