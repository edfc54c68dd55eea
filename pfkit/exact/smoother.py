r"""A Gaussian filter along a log, and back again.

A filter may look only at the past. When the whole log is at hand, the future helps too: a
landmark seen now says where the robot must have been a second ago. The Rauch-Tung-Striebel
smoother walks back through the filter's results and hands each correction on:

.. math:: G_k &= C_{k+1} \bar\Sigma_{k+1}^{-1} \\
          \mu^s_k &= \mu_k + G_k (\mu^s_{k+1} - \bar\mu_{k+1}) \\
          \Sigma^s_k &= \Sigma_k + G_k (\Sigma^s_{k+1} - \bar\Sigma_{k+1}) G_k^T

with C the covariance of the states before and after a motion. It needs no measurement again,
and it is no filter: nobody can drive a robot by it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from pfkit.exact.gaussian import Transform, gaussian_predict, gaussian_update, linearise
from pfkit.exact.kalman import Gaussian, angles_of, wrap_rows
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import Sensor
from pfkit.worlds.log import Log

Array = NDArray[np.float64]


@dataclass(frozen=True)
class GaussianHistory:
    """What a Gaussian filter said along a log.

    Parameters
    ----------
    t : array (T,), seconds
    estimate : array (D, T), the means
    covariance : array (D, D, T)
    log_evidence : array (T,), of the measurements that passed the gate
    rejected : int64 array (T,), how many did not
    truth : array (3, T), or None
    predicted, predicted_covariance : arrays (D, T), (D, D, T), before each update
    cross : array (D, D, T), covariance of the states before and after each motion
    bel : Gaussian, the last belief
    """

    t: Array
    estimate: Array
    covariance: Array
    log_evidence: Array
    rejected: NDArray[np.int64]
    truth: Array | None
    predicted: Array
    predicted_covariance: Array
    cross: Array
    bel: Gaussian

    @property
    def position_sd(self) -> Array:
        """Root of the summed position variances, metres: (T,)."""
        return np.sqrt(self.covariance[0, 0] + self.covariance[1, 1])

    def __repr__(self) -> str:
        return f"GaussianHistory({len(self.t)} steps, {int(self.rejected.sum())} rejected)"


def run_gaussian(
    log: Log,
    bel: Gaussian,
    motion: MotionModel,
    sensor: Sensor,
    transform: Transform = linearise,
    gate: float = math.inf,
) -> GaussianHistory:
    """Run an EKF or UKF along a log.

    Parameters
    ----------
    log : Log, of one drive
    bel : Gaussian, the belief before the first control
    motion, sensor, transform, gate
        As in `gaussian_predict` and `gaussian_update`.

    Returns
    -------
    GaussianHistory

    Raises
    ------
    ParameterError, ShapeError, DataError
        As `gaussian_predict` and `gaussian_update`.
    """
    T, D = len(log), bel.mean.size
    estimate, predicted = np.empty((D, T)), np.empty((D, T))
    spread, predicted_spread, cross = (np.empty((D, D, T)) for _ in range(3))
    log_evidence, rejected = np.empty(T), np.zeros(T, dtype=np.int64)
    for k, (_, u, z, _) in enumerate(log):
        bel, cross[..., k] = gaussian_predict(bel, u, motion, transform)
        predicted[:, k], predicted_spread[..., k] = bel.mean, bel.Sigma
        bel, log_evidence[k], rejected[k] = gaussian_update(bel, z, sensor, transform, gate)
        estimate[:, k], spread[..., k] = bel.mean, bel.Sigma
    return GaussianHistory(
        log.t,
        estimate,
        spread,
        log_evidence,
        rejected,
        log.truth,
        predicted,
        predicted_spread,
        cross,
        bel,
    )


def rts_smooth(history: GaussianHistory) -> GaussianHistory:
    r"""Let the future correct the past.

    .. math:: \mu^s_k = \mu_k + G_k (\mu^s_{k+1} - \bar\mu_{k+1})

    Parameters
    ----------
    history : GaussianHistory, from `run_gaussian`

    Returns
    -------
    GaussianHistory with smoothed `estimate` and `covariance`

    Raises
    ------
    ParameterError
        If `history` is not that of a Gaussian filter.

    Notes
    -----
    Source: H. E. Rauch, F. Tung and C. T. Striebel, AIAA Journal 3 (1965). A state without any
    uncertainty in some direction is handled by the pseudo-inverse: nothing to correct there.
    """
    estimate, spread = history.estimate.copy(), history.covariance.copy()
    angles = angles_of(estimate)
    for k in range(len(history.t) - 2, -1, -1):
        ahead = history.predicted_covariance[..., k + 1]
        G = history.cross[..., k + 1] @ np.linalg.pinv(ahead, hermitian=True)
        change = wrap_rows(estimate[:, k + 1] - history.predicted[:, k + 1], angles)
        estimate[:, k] = wrap_rows(estimate[:, k] + G @ change, angles)
        spread[..., k] += G @ (spread[..., k + 1] - ahead) @ G.T
    return replace(history, estimate=estimate, covariance=spread)
