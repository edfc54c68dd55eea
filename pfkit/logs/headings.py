r"""Does the truth look where it goes?

The heading column of a recorded truth is the one that is most often wrong: turned by half a circle,
by the angle at which a marker was glued on, or meaningless. Its positions tell. Over a second or so
the robot moves in a direction that is seen twice: by the truth, in the frame of its own heading,
and by the odometry, in the frame of the robot. The two agree if the heading is right,

.. math:: \delta = \arg(x_i \ominus x_j)_{truth} - \arg(x_i \ominus x_j)_{odometry} ,

whether the robot drives forwards, backwards or sideways. A delta that is the same all the way is
how far the truth is turned, and is taken back. A delta that is all over the circle says that the
heading column is no heading; then it is set to "unknown". Either is said aloud, in the log's notes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from pfkit.geometry import between, compose, wrap
from pfkit.logs.odometry import Drift, Preintegrated
from pfkit.worlds.log import Log

Array = NDArray[np.float64]
WINDOW = 1.0  # seconds, at least; longer where the truth comes more slowly
TOLERATED = np.radians(10)  # a marker glued on by eye; calibration sees to the rest
AGREEING = 0.6  # share of windows within 30 degrees of the usual delta that make it one
NEAR = np.radians(30)
LEAST = 8  # windows below which nobody can tell


def face_course(log: Log) -> Log:
    """The log with a truth that looks where it goes, and a note of what was done.

    A truth of positions only gets the heading of the start, fitted to the first third.

    Parameters
    ----------
    log : Log

    Returns
    -------
    Log
    """
    if log.truth is None or len(log) < 3:
        return log
    known = np.isfinite(log.truth[:2]).all(axis=0)
    if not known.any():
        return log
    if np.isnan(log.truth[2, known]).all():
        return _with_fitted_start(log)
    delta = _deltas(log)
    if delta.size < LEAST:
        return log
    turn = _usual(delta)
    share = float(np.mean(np.abs(wrap(delta - turn)) < NEAR))
    seen = f"in {share:.0%} of {delta.size} stretches of driving"
    if share < AGREEING:
        truth = np.vstack((log.truth[:2], np.full(len(log), np.nan)))
        note = (
            "the truth's heading has nothing to do with its course "
            f"(the best agreement holds {seen}); it is taken as unknown"
        )
        return _with_fitted_start(replace(log, truth=truth, start=None, notes=(*log.notes, note)))
    if abs(turn) <= TOLERATED:
        return log
    turn = np.pi if abs(turn) > np.pi - TOLERATED else turn
    note = (
        f"the truth's heading was turned by {np.degrees(turn):.0f} degrees: "
        f"it looked that far off its course {seen}"
    )
    truth = np.vstack((log.truth[:2], wrap(log.truth[2] + turn)))
    start = None if log.start is None else np.append(log.start[:2], wrap(log.start[2] + turn))
    return replace(log, truth=truth, start=start, notes=(*log.notes, note))


def _deltas(log: Log) -> Array:
    """Direction of motion by truth minus by odometry, (n,), where the robot really moved."""
    i, j = _stretches(log)
    by_truth = between(log.truth[:, i], log.truth[:, j])  # type: ignore[index]
    by_wheels, _ = Preintegrated.of(log, Drift()).between(i + 1, j + 1)
    way = np.hypot(*by_truth[:2])
    known = np.isfinite(by_truth).all(axis=0)
    if not known.any():
        return np.empty(0)
    moved = known & (np.hypot(*by_wheels[:2]) > 0) & (np.abs(by_wheels[2]) < np.pi / 4)
    moved &= way > 0.5 * np.percentile(way[known], 90)
    x, y, _ = by_truth[:, moved]
    dx, dy, _ = by_wheels[:, moved]
    return wrap(np.arctan2(y, x) - np.arctan2(dy, dx))


def _stretches(log: Log) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Steps one window apart, both (n,), the windows one after the other."""
    known = np.flatnonzero(np.isfinite(log.truth[0]))  # type: ignore[index]
    pause = float(np.median(np.diff(log.t[known]))) if known.size > 1 else WINDOW
    length = max(WINDOW, 3 * pause)
    marks = np.arange(log.t[0], log.t[-1] + length, length)
    at = np.minimum(np.searchsorted(log.t, marks), len(log) - 1)
    return at[:-1], at[1:]


def _usual(delta: Array) -> float:
    """The direction near which most lie: the mean of those near the best of 72 candidates."""
    candidates = np.radians(np.arange(-180, 180, 5))
    near = np.abs(wrap(delta - candidates[:, None])) < NEAR
    best = candidates[np.argmax(near.sum(axis=1))]
    close = delta[np.abs(wrap(delta - best)) < NEAR]
    return float(wrap(best + np.median(wrap(close - best))))


def _with_fitted_start(log: Log) -> Log:
    """Start where the truth starts, with the heading that lays the odometry over its first third.

    .. math:: \\theta = \\arg \\sum_t (p_t - \\bar p)\\, \\overline{(o_t - \\bar o)}

    for positions p and the odometry's o as complex numbers.
    """
    known = np.isfinite(log.truth[:2]).all(axis=0)  # type: ignore[index]
    part = known & (log.t <= log.t[0] + (log.t[-1] - log.t[0]) / 3)
    if not bool(known.flat[0]) or part.sum() < 2:
        return log
    path = Preintegrated.of(log, Drift()).path[:, 1:]
    p = (log.truth[0] + 1j * log.truth[1])[part]  # type: ignore[index]
    o = (path[0] + 1j * path[1])[part]
    match = np.sum((p - p.mean()) * np.conj(o - o.mean()))
    if abs(match) == 0:
        return log
    origin = np.array([log.truth[0, 0], log.truth[1, 0], np.angle(match)])  # type: ignore[index]
    start = compose(origin, np.zeros(3))
    note = f"the start's heading, {np.degrees(start[2]):.0f} degrees, was fitted to the first third"
    return replace(log, start=start, notes=(*log.notes, note))
