r"""How wrong is the answer, and when?

A simulated robot knows its truth, and so does a filmed one. Then the error of a filter is a
number, and a good habit is to say *which* number. Position and heading have different units,
so they get one figure each. A heading error is an angle and is wrapped before it is squared:
359 degrees off is 1 degree off.

The usual summary of a drive is the root of the mean squared position error,

.. math:: \mathrm{RMSE} = \sqrt{\tfrac1T \sum_t (\hat x_t - x_t)^2 + (\hat y_t - y_t)^2} .

It says nothing about when the error was large. `settling_time` does: the moment after which it
stays small. And it says nothing without a rival. The cheapest one is `dead_reckoning`: follow
the odometer, ignore every measurement. A filter that does not beat it does not work.

One run is an anecdote. `comparison` puts intervals on many, `consistency` asks
whether the filter *knows* how wrong it is, `genealogy` who descends from whom.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, require_array, require_number
from pfkit.filters.history import History
from pfkit.geometry import wrap
from pfkit.judging.table import Table, tabulate
from pfkit.models.increments import IncrementMotion
from pfkit.models.motion import MotionModel, VelocityMotion
from pfkit.models.odometry_motion import OdometryMotion
from pfkit.worlds.log import Log

Array = NDArray[np.float64]
MOTIONS: dict[str, MotionModel] = {
    "speeds": VelocityMotion(),
    "turns": OdometryMotion(),
    "increments": IncrementMotion(),
}


def pose_error(estimate: ArrayLike, truth: ArrayLike) -> Array:
    r"""Estimate minus truth; the third component, a heading, is wrapped.

    .. math:: e = (\hat x - x,\; \hat y - y,\; \mathrm{wrap}(\hat\theta - \theta))

    Parameters
    ----------
    estimate : array_like (D, ...), metres and radians, e.g. (3, T) or (3, T, B)
    truth : array_like (D, ...), with the same leading axes; one truth (3, T) serves a batch
        NaN where it is not known, as in the gaps of a real log.

    Returns
    -------
    array (D, ...), of the estimate's shape; NaN where the truth is not known

    Raises
    ------
    ShapeError, DataError
        If the shapes do not belong together, the estimate is not finite or the truth infinite.
    """
    estimate = require_array("estimate", estimate, ("D", ...), error=DataError)
    truth = require_array("truth", truth, ("D", ...), None, DataError)
    if truth.ndim == estimate.ndim + 1 and truth.shape[-1] == 1:
        truth = truth[..., 0]  # the truths of a batched log are (D, T, B, 1)
    truth = require_array("truth", truth, estimate.shape[: truth.ndim], None)
    error = estimate - truth.reshape(truth.shape + (1,) * (estimate.ndim - truth.ndim))
    if error.shape[0] >= 3:
        known = ~np.isnan(error[2])
        error[2, known] = wrap(error[2, known])
    return error


def position_error(estimate: ArrayLike, truth: ArrayLike) -> Array:
    r"""Distance between the estimated and the true position.

    .. math:: \sqrt{(\hat x - x)^2 + (\hat y - y)^2}

    Parameters
    ----------
    estimate, truth : array_like (D, ...), as in `pose_error`

    Returns
    -------
    array (...), metres; NaN where the truth is not known
    """
    return np.hypot(*pose_error(estimate, truth)[:2])


def rmse(estimate: ArrayLike, truth: ArrayLike) -> Array | np.float64:
    r"""Root mean square of the position error over the steps whose truth is known.

    .. math:: \sqrt{\tfrac1T \sum_t (\hat x_t - x_t)^2 + (\hat y_t - y_t)^2}

    Parameters
    ----------
    estimate, truth : array_like (D, T) or (D, T, B), as in `pose_error`

    Returns
    -------
    float, or (B,) with one number per run, metres

    Raises
    ------
    ShapeError, DataError
        As `pose_error`; also if there is no step with a known truth.
    """
    return _root_mean_square(position_error(estimate, truth))


def heading_rmse(estimate: ArrayLike, truth: ArrayLike) -> Array | np.float64:
    r"""Root mean square of the wrapped heading error over the steps whose truth is known.

    .. math:: \sqrt{\tfrac1T \sum_t \mathrm{wrap}(\hat\theta_t - \theta_t)^2}

    Parameters
    ----------
    estimate, truth : array_like (3, T) or (3, T, B), as in `pose_error`

    Returns
    -------
    float, or (B,) with one number per run, radians

    Raises
    ------
    ShapeError, DataError
        As `rmse`.
    """
    return _root_mean_square(pose_error(estimate, truth)[2])


def _root_mean_square(error: Array) -> Array | np.float64:
    known = ~np.isnan(error)
    steps = known.sum(axis=0)
    return np.sqrt(np.sum(np.where(known, error, 0.0) ** 2, axis=0) / steps)


def settling_time(t: ArrayLike, error: ArrayLike, limit: float) -> Array | np.float64:
    """The first time after which the error stays below a limit, to the end of the log.

    Parameters
    ----------
    t : array_like (T,), seconds
    error : array_like (T,) or (T, B), e.g. of `position_error`, metres
    limit : float, > 0, metres

    Returns
    -------
    float or (B,), seconds; inf if the error does not end below the limit

    Raises
    ------
    ParameterError, ShapeError
        If the shapes do not match, a number is not finite, or the limit is not positive.
    """
    t = require_array("t", t, ("T",))
    error = require_array("error", error, (t.size, ...))
    require_number("limit", limit, "> 0")
    late = np.cumprod((error < limit)[::-1], axis=0).sum(axis=0)  # steps of the good ending
    return np.append(t, np.inf)[len(t) - late]


def dead_reckoning(
    log: Log, motion: MotionModel | None = None, start: ArrayLike | None = None
) -> Array:
    r"""Follow the controls without noise and without measurements.

    .. math:: \hat x_t = E[x_t \mid u_t, \hat x_{t-1}]

    Parameters
    ----------
    log : Log
    motion : MotionModel, optional
        What the log's rig says if left out; without a rig the arcs of u = (v, omega, dt).
    start : array_like (D,) or (D, B, 1), optional
        The pose before the first control; the log's own start if left out.

    Returns
    -------
    array (D, T) or (D, T, B, 1), the path it believes it drove

    Raises
    ------
    ParameterError
        If neither the argument nor the log says where the robot started.
    """
    if start is None:
        start = log.start
    pose: Any = start
    if motion is None:
        motion = MOTIONS["speeds" if log.rig is None else log.rig.odometry]
    path = []
    for u in np.moveaxis(log.u, 1, 0):
        pose = motion.mean(pose, u)
        path.append(pose)
    return np.stack(path, axis=1) if path else np.empty((len(pose), 0))


def trace(history: History) -> Table:
    """One row per step: what happened, ready for a table, a plot or a CSV file.

    Parameters
    ----------
    history : History of one run

    Returns
    -------
    structured array (T,)
        Fields step, t (s), ess, log_evidence, resampled, position_sd (m) and error (m; NaN if
        the truth is not known).

    Raises
    ------
    ShapeError
        If the history holds a batch.
    """
    T = len(history.t)
    columns = {
        "step": np.arange(T, dtype=np.int64),
        "t": history.t,
        "ess": history.ess,
        "log_evidence": history.log_evidence,
        "resampled": history.resampled,
        "position_sd": history.position_sd,
        "error": np.full(T, np.nan)
        if history.truth is None
        else position_error(history.estimate, history.truth),
    }
    return tabulate(columns)
