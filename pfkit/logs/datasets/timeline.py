"""One clock for three streams: odometry, measurements and truth.

Wheels, sensor and referee each keep a diary of their own. A filter wants one list of
instants. We take every instant at which somebody spoke, file each measurement under its own
instant and interpolate the truth - the heading on the circle, and not across gaps: where the
referee looked away there is no truth. A speed holds until the next one arrives; poses that the
wheels have added up are interpolated, and what counts is the motion between two of them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.geometry import wrap
from pfkit.logs.headings import face_course
from pfkit.models.increments import increments
from pfkit.worlds.log import Log
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
BLIND = 0.5  # seconds from the nearest sample beyond which there is no truth


def interpolate_poses(t: Array, t_truth: Array, poses: Array, blind: float = BLIND) -> Array:
    """Poses (3, T) at times t from samples; NaN further than `blind` seconds from every sample.

    Parameters
    ----------
    t : array (T,), seconds
    t_truth : array (N,), seconds, never decreasing
    poses : array (3, N), metres and radians; a heading may be NaN
    blind : float, seconds
    """
    unwrapped = np.vstack((poses[:2], np.unwrap(poses[2])))
    result = np.stack([np.interp(t, t_truth, row) for row in unwrapped])
    result[2] = wrap(result[2])
    after = np.clip(np.searchsorted(t_truth, t), 1, len(t_truth) - 1) if len(t_truth) > 1 else 0
    before = np.maximum(after - 1, 0)
    distance = np.minimum(np.abs(t - t_truth[before]), np.abs(t - t_truth[after]))
    result[:, distance > blind] = np.nan
    return result


def held_controls(t: Array, t_command: Array, v: Array, omega: Array) -> Array:
    """Controls u = (v, omega, dt), shape (3, T): each command holds until the next.

    Step k carries the robot from t[k-1] to t[k]; step 0 takes no time.

    Parameters
    ----------
    t : array (T,), seconds; holds every time of `t_command`
    t_command : array (N,), seconds, never decreasing, t_command[0] <= t[0]
    v, omega : array (N,), m/s and rad/s
    """
    active = np.searchsorted(t_command, t[:-1], side="right") - 1
    u = np.zeros((3, len(t)))
    u[:, 1:] = v[active], omega[active], np.diff(t)
    return u


def group_measurements(t: Array, t_z: Array, z: NDArray[Any]) -> list[NDArray[Any]]:
    """Measurements (..., N) filed under instants t (T,): a list of T arrays (..., K)."""
    first = np.searchsorted(t_z, t, side="left")
    last = np.searchsorted(t_z, t, side="right")
    nothing = z[..., :0]
    return [z[..., i:j] if i < j else nothing for i, j in zip(first, last, strict=True)]


def merge(
    moved: Array,
    measured: Array,
    truth: Array | None,
    world: Any,
    source: str,
    start: float,
    rig: Rig,
    false: NDArray[np.bool_] | None = None,
    notes: list[str] | None = None,
) -> Log:
    """Build a `Log` from three streams.

    Parameters
    ----------
    moved : array (3, N): time, v, omega; or (4, N): time and the odometer's pose
        As the rig says: speeds or increments. What is measured before the first or after the
        last row is left out: nobody says how the robot moved then.
    measured : array (1 + n, N_z): time, then the rows of z
    truth : array (4, N_x): time, x, y, theta (NaN if unknown); or None where nobody filmed
    world : map
    source : str
    start : float
        The time that becomes t = 0, seconds.
    rig : Rig
    false : bool array (N_z,), optional
        Labels of false measurements, where they are known.
    notes : list of str, optional
        What the reader of the files has to say.

    Raises
    ------
    DataError
        If no measurement falls into the odometry's time: a clock is off.
    """
    t_moved, t_z = moved[0] - start, measured[0] - start
    inside = (t_moved[0] <= t_z) & (t_z <= t_moved[-1])
    said = [*(notes or []), *_clocks(source, moved[0], measured[0], inside, truth)]
    z, t_z = measured[1:, inside], t_z[inside]
    t = np.union1d(t_moved, t_z)
    poses = None if truth is None else interpolate_poses(t, truth[0] - start, truth[1:])
    if rig.odometry == "increments":
        u = increments(interpolate_poses(t, t_moved, moved[1:], np.inf))
    else:
        u = held_controls(t, t_moved, *moved[1:])
    log = Log(
        t,
        u,
        group_measurements(t, t_z, z),
        truth=poses,
        start=None if poses is None or np.isnan(poses[:, 0]).any() else poses[:, 0],
        world=world,
        source=source,
        outlier=None if false is None else group_measurements(t, t_z, false[inside]),
        scored=np.isin(t, t_moved),
        rig=rig,
        notes=tuple(said),
    )
    return face_course(log)


def _clocks(
    source: str, t: Array, t_z: Array, inside: NDArray[np.bool_], truth: Array | None
) -> list[str]:
    """Whether the three streams speak of the same time; `DataError` if two cannot."""
    if t_z.size and not inside.any():
        raise DataError(
            f"{source}: the clocks do not agree: odometry runs from {t[0]:.10g} to "
            f"{t[-1]:.10g} s, measurements from {t_z[0]:.10g} to {t_z[-1]:.10g} s, "
            f"{t_z[0] - t[0]:+.10g} s apart at the start; shift one clock by what "
            "is known (a time zone is a multiple of 3600 s)"
        )
    notes = []
    out = int((~inside).sum())
    if out > 0.01 * t_z.size:
        notes.append(
            f"{out:,} of {t_z.size:,} measurements lie outside the odometry's time and are left "
            "out; is a clock off?"
        )
    if truth is not None and not ((t[0] <= truth[0]) & (truth[0] <= t[-1])).any():
        notes.append(
            f"the truth is of another time, {truth[0, 0] - t[0]:+.10g} s apart at the start; "
            "nothing can be compared with it"
        )
    return notes
