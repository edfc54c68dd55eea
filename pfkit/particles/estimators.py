"""From a cloud to an answer.

A filter's output is the cloud. Whoever asks "where is the robot?" wants one pose, and which
one depends on what an error costs. The weighted mean has the smallest expected squared
error. For a cloud in two halves it lies between them, perhaps inside a wall: then the mode
of the heavier half is the better answer, and "two hypotheses" the honest one. `kde`, in
`density`, says where the cloud is densest; `clusters`, in `modes`, names all hypotheses with
their masses.

The two estimators below that look at single weights, `map_particle` and `top_share_mean`, ask
before resampling: afterwards all weights are equal and they have nothing to go by.

Headings are averaged on the circle.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import require_number
from pfkit.geometry import direction, wrap
from pfkit.particles.particle_set import Particles, normalise


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
        The heading is NaN where the headings cancel and so have no mean. Where they nearly do, it
        is a number that the next cloud will not repeat: ask `resultant_length(bel.state[2], bel.w)`
        before you act on it.

    Raises
    ------
    ParameterError
        If `bel` is not a particle set.
    """
    w = bel.w
    mean = _average(bel.state, w)
    if bel.state.shape[0] >= 3:
        theta = bel.state[2]
        mean[2] = direction(_average(np.sin(theta), w), _average(np.cos(theta), w))
    return mean


def _average(values: NDArray[np.float64], w: NDArray[np.float64]) -> NDArray[np.float64]:
    """Weighted sums over the last axis, as products of a row and a column."""
    return np.matmul(values[..., None, :], w[..., None])[..., 0, 0]


def covariance(bel: Particles) -> NDArray[np.float64]:
    r"""Weighted covariance about `mean_pose`, heading differences wrapped.

    .. math:: \Sigma = \sum_m w_m\, d_m d_m^T

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M)

    Returns
    -------
    array (D, D) or (D, D, B), in the products of the state's units
        NaN in the rows of a heading that has no mean.

    Raises
    ------
    ParameterError
        If `bel` is not a particle set.
    """
    d = deviation(bel)
    return np.einsum("i...m,j...m,...m->ij...", d, d, bel.w)


def deviation(bel: Particles) -> NDArray[np.float64]:
    """Differences of particles to `mean_pose`, those of headings wrapped: (D, M) or (D, B, M)."""
    difference = bel.state - mean_pose(bel)[..., None]
    if bel.state.shape[0] >= 3:
        difference[2] = wrap(difference[2])
    return difference


def map_particle(bel: Particles) -> NDArray[np.float64]:
    r"""The particle of the largest weight.

    .. math:: x^{[m^*]}, \qquad m^* = \arg\max_m w_m

    The largest weight is not the largest density: a weight says how much better a particle
    explains the data than its proposal did. It comes near the maximum a posteriori only while
    particles lie evenly. The particle where `kde` is largest does not depend on that.

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M), weighted

    Returns
    -------
    array (D,) or (D, B). Of equal weights the first wins.

    Raises
    ------
    ParameterError
        If `bel` is not a particle set.
    """
    best = bel.log_w.argmax(axis=-1)
    return np.take_along_axis(bel.state, best[None, ..., None], axis=-1)[..., 0]


def top_share_mean(bel: Particles, share: float = 0.1) -> NDArray[np.float64]:
    r"""Mean pose of the heaviest particles.

    .. math:: \bar x = \frac{\sum_{m \in T} w_m x_m}{\sum_{m \in T} w_m}, \qquad
              |T| = \lceil \text{share} \cdot M \rceil

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M), weighted
    share : float in (0, 1]
        1 is `mean_pose`; towards 0 it becomes `map_particle`.

    Returns
    -------
    array (D,) or (D, B)

    Raises
    ------
    ParameterError
        If the share is not in (0, 1].
    """
    require_number("share", share, "in (0, 1]")
    n = int(np.ceil(share * bel.M))
    top = np.argsort(-bel.log_w, axis=-1, kind="stable")[..., :n]
    state = np.take_along_axis(bel.state, top[None], axis=-1)
    return mean_pose(Particles(state, normalise(np.take_along_axis(bel.log_w, top, axis=-1))[0]))
