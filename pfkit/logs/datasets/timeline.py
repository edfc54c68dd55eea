"""One clock for three streams: commands, measurements and truth.

Wheels, camera and referee each keep a diary of their own. A filter wants one list of
instants. We take every instant at which somebody spoke, hold each command until the next
one arrives, file each measurement under its own instant and interpolate the truth - the
heading on the circle, and not across gaps: where the referee looked away there is no truth.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.geometry import wrap
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap

Array = NDArray[np.float64]
BLIND = 0.5  # seconds from the nearest sample beyond which there is no truth


def interpolate_poses(t: Array, t_truth: Array, poses: Array) -> Array:
    """Poses (3, T) at times t from samples; NaN further than 0.5 s from every sample.

    Parameters
    ----------
    t : array (T,), seconds
    t_truth : array (N,), seconds, never decreasing
    poses : array (3, N), metres and radians
    """
    unwrapped = np.vstack((poses[:2], np.unwrap(poses[2])))
    result = np.stack([np.interp(t, t_truth, row) for row in unwrapped])
    result[2] = wrap(result[2])
    after = np.clip(np.searchsorted(t_truth, t), 1, len(t_truth) - 1) if len(t_truth) > 1 else 0
    before = np.maximum(after - 1, 0)
    distance = np.minimum(np.abs(t - t_truth[before]), np.abs(t - t_truth[after]))
    result[:, distance > BLIND] = np.nan
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
    command: Array,
    measured: Array,
    truth: Array | None,
    world: LandmarkMap,
    source: str,
    start: float,
    false: NDArray[np.bool_] | None = None,
) -> Log:
    """Build a `Log` from three streams.

    Parameters
    ----------
    command : array (3, N): time, v, omega
        What is measured before the first or after the last command is left out: nobody says
        how the robot moved then.
    measured : array (1 + n, N_z): time, then the rows of z
    truth : array (4, N_x): time, x, y, theta; or None where nobody filmed
    world : LandmarkMap
    source : str
    start : float
        The time that becomes t = 0, seconds.
    false : bool array (N_z,), optional
        Labels of false measurements, where they are known.
    """
    t_command, t_z = command[0] - start, measured[0] - start
    inside = (t_command[0] <= t_z) & (t_z <= t_command[-1])
    z, t_z = measured[1:, inside], t_z[inside]
    t = np.union1d(t_command, t_z)
    poses = None if truth is None else interpolate_poses(t, truth[0] - start, truth[1:])
    return Log(
        t,
        held_controls(t, t_command, *command[1:]),
        group_measurements(t, t_z, z),
        truth=poses,
        start=None if poses is None or np.isnan(poses[:, 0]).any() else poses[:, 0],
        world=world,
        source=source,
        outlier=None if false is None else group_measurements(t, t_z, false[inside]),
        scored=np.isin(t, t_command),
    )
