"""From a cloud to an answer.

A filter's output is the cloud. Whoever asks "where is the robot?" wants one pose, and which
one depends on what an error costs. The weighted mean has the smallest expected squared
error. For a cloud in two halves it lies between them, perhaps inside a wall: then the mode
of the heavier half is the better answer, and "two hypotheses" the honest one.

Headings are averaged on the circle.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pfkit.geometry import circular_mean, wrap
from pfkit.particles import Particles, require_particles


def mean_pose(bel: Particles) -> NDArray[np.float64]:
    r"""Weighted mean of position and circular mean of heading.

    .. math:: \bar x = \sum_m w_m x_m, \qquad
              \bar\theta = \mathrm{atan2}(\sum_m w_m \sin\theta_m, \sum_m w_m \cos\theta_m)

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M); row 2, if present, is a heading

    Returns
    -------
    array (D,) or (D, B), metres and radians

    Raises
    ------
    ParameterError
        If `bel` is not a particle set.
    """
    w = require_particles(bel).w
    mean = np.einsum("d...m,...m->d...", bel.state, w)
    if bel.state.shape[0] >= 3:
        mean[2] = circular_mean(bel.state[2], w)
    return mean


def covariance(bel: Particles) -> NDArray[np.float64]:
    r"""Weighted covariance about `mean_pose`, heading differences wrapped.

    .. math:: \Sigma = \sum_m w_m\, d_m d_m^T

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M)

    Returns
    -------
    array (D, D) or (D, D, B), in the products of the state's units

    Raises
    ------
    ParameterError
        If `bel` is not a particle set.
    """
    deviation = bel.state - mean_pose(bel)[..., None]
    if bel.state.shape[0] >= 3:
        deviation[2] = wrap(deviation[2])
    return np.einsum("i...m,j...m,...m->ij...", deviation, deviation, bel.w)
