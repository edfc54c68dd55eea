r"""Simulation: a robot whose truth we know.

A simulated log comes from the same two densities that the filter assumes,

.. math:: x_t \sim p(x_t \mid u_t, x_{t-1}), \qquad z_t \sim p(z_t \mid x_t) ,

so that a filter with these models has no excuse. Then we take the excuses away one by one:
simulate with one model and filter with another, hide landmarks (`FieldOfView`), spoil measurements
with known labels (`Outliers`), or carry the robot off (``kidnap``).

`drive` makes the truth, `sense` the measurements along it, `simulate_log` both. Each draws
from a random stream of its own. So a change to the sensor leaves the route as it was, and two
filters or two sensors can be compared on the same drive.

B robots drive side by side when the start is ``(3, B, 1)`` (or ``batch=B``). The log then
holds truth ``(3, T, B, 1)`` and measurements ``(n, K, B, 1)``, which broadcast against B
particle sets ``(3, B, M)``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ParameterError, require_array, require_count
from pfkit.logs.driving import Driver, Kidnap, drive
from pfkit.logs.faults import Outliers
from pfkit.models.association import MaximumLikelihood
from pfkit.models.beams import BeamModel
from pfkit.models.increments import IncrementMotion
from pfkit.models.landmark_sensors import Bearing, Range, RangeBearing
from pfkit.models.masked import Masked
from pfkit.models.motion import MotionModel, VelocityMotion
from pfkit.models.mounted import Mounted
from pfkit.models.odometry_motion import OdometryMotion
from pfkit.worlds.log import Log
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
MOTIONS: dict[type, str] = {
    VelocityMotion: "speeds",
    OdometryMotion: "turns",
    IncrementMotion: "increments",
}
SENSORS: dict[type, str] = {
    RangeBearing: "range-bearing",
    Range: "range",
    Bearing: "bearing",
    BeamModel: "laser",
}


def sense(
    truth: ArrayLike,
    sensor: Any,
    rng: np.random.Generator,
    *,
    every: int = 1,
    sight: Callable[[Array], NDArray[np.bool_]] | None = None,
    outliers: Outliers | None = None,
) -> tuple[list[Array], list[NDArray[np.bool_]]]:
    r"""What the robot measured on its way: :math:`z_t \sim p(z_t \mid x_t)`.

    Parameters
    ----------
    truth : array_like (D, T) or (D, T, B, 1)
    sensor : sensor with ``sample(pose, rng)`` -> (n, K, ...), and ``components`` = n
    rng : numpy.random.Generator
    every : int >= 1
        Measure at every such step, the first time at step ``every - 1``; else K = 0.
    sight : function of poses (D, ...) to bool (K, ...), optional
        Which columns are measured, such as `FieldOfView`. A batch needs an `Masked` sensor.
    outliers : Outliers, optional

    Returns
    -------
    z : list of T arrays (n, K) or (n, K, B, 1)
    false : list of T bool arrays (K,) or (K, B, 1), the labels of the outliers

    Raises
    ------
    ShapeError, ParameterError
        If truth has the wrong shape, or a batch with `sight` has no `Masked` sensor.
    """
    truth, every = require_array("truth", truth, ("D", "T", ...)), require_count("every", every)
    if sight is not None and truth.ndim == 4 and not isinstance(sensor, Masked):
        raise ParameterError("robots of a batch see different landmarks; use Masked(sensor)")
    z, false = [], []
    for k in range(truth.shape[1]):
        pose = truth[:, k]
        if (k + 1) % every:
            zk = np.empty((sensor.components, 0, *pose.shape[1:]))
        else:
            zk = _look(sensor, pose, sight, rng)
        labels = np.zeros(zk.shape[1:], dtype=bool)
        if outliers is not None:
            zk, labels = outliers.spoil(zk, rng)
        z.append(zk)
        false.append(labels)
    return z, false


def simulate_log(
    start: ArrayLike,
    u: ArrayLike | Driver,
    motion: MotionModel,
    sensor: Any,
    rng: np.random.Generator,
    *,
    steps: int | None = None,
    batch: int | None = None,
    every: int = 1,
    sight: Callable[[Array], NDArray[np.bool_]] | None = None,
    outliers: Outliers | None = None,
    kidnap: Kidnap | None = None,
    dt: float | None = None,
    source: str = "simulated",
) -> Log:
    """Drive and measure: a log with its truth.

    Parameters
    ----------
    start, u, motion, steps, kidnap
        As in `drive`.
    sensor, every, sight, outliers
        As in `sense`.
    rng : numpy.random.Generator
        Spawns one stream for the drive and one for the measurements.
    batch : int, optional
        Drive B robots side by side, all from the one start.
    dt : float, > 0, seconds, optional
        Time of a step. If left out it is the third row of u, where velocity, wheel and bicycle
        commands keep it; odometry has none, and then it is 1 s.
    source : str, for tables and captions

    Returns
    -------
    Log with u (n, T, ...), z (n, K, ...), truth (D, T, ...), and outlier labels if asked for

    Raises
    ------
    ShapeError, ParameterError
        As `drive` and `sense`; also if the robots of a batch have different dt.
    """
    if batch is not None:
        start = require_array("start", start, ("D",))
        start = np.repeat(start[:, None, None], require_count("batch", batch), axis=1)
    world = _world_of(sensor)
    on_the_road, at_the_sensor = rng.spawn(2)
    u, truth = drive(start, u, motion, on_the_road, steps=steps, kidnap=kidnap, world=world)
    z, false = sense(truth, sensor, at_the_sensor, every=every, sight=sight, outliers=outliers)
    return Log(
        t=_times(u, motion, dt),
        u=u,
        z=z,
        truth=truth,
        start=start,  # type: ignore[arg-type]
        world=world,
        source=source,
        outlier=None if outliers is None else false,
        rig=rig_of(motion, sensor),
    )


def rig_of(motion: MotionModel, sensor: Any) -> Rig | None:
    """What models say of a robot; None where it is no robot that `Rig` knows."""
    odometry = next((kind for model, kind in MOTIONS.items() if type(motion) is model), None)
    mount, flipped, named = (0.0, 0.0, 0.0), False, True
    while not isinstance(sensor, tuple(SENSORS)) and hasattr(sensor, "sensor"):
        if isinstance(sensor, Mounted):
            mount, flipped = sensor.mount, sensor.flipped
        named = named and not isinstance(sensor, MaximumLikelihood)
        if isinstance(sensor, Masked):  # its rows are one more
            return None
        sensor = sensor.sensor
    kind = next((name for model, name in SENSORS.items() if isinstance(sensor, model)), None)
    if odometry is None or kind is None:
        return None
    return Rig(kind, odometry, named, mount, flipped, getattr(sensor, "r_max", math.inf))


def _world_of(sensor: Any) -> Any:
    """The map of a sensor, or of the sensor that it wraps; None if it has none."""
    while not hasattr(sensor, "world") and hasattr(sensor, "sensor"):
        sensor = sensor.sensor
    return getattr(sensor, "world", None)


def _look(sensor: Any, pose: Array, sight: Callable | None, rng: np.random.Generator) -> Array:
    """One measurement set, without (or with marks on) what is not seen."""
    z = sensor.sample(pose, rng)
    if sight is None:
        return z
    seen = sight(pose)
    if isinstance(sensor, Masked):
        z[-1] = seen
        return z
    return z[:, seen]


def _times(u: Array, motion: MotionModel, dt: float | None) -> Array:
    """Times (T,) at the ends of the steps, seconds."""
    T = u.shape[1]
    if dt is None and (isinstance(motion, OdometryMotion | IncrementMotion) or len(u) < 3):
        dt = 1.0
    durations = u[2] if dt is None else np.full(T, require_array("dt", dt, rule="finite and > 0"))
    if durations.ndim > 1 and (durations != durations[:, :1]).any():
        raise ParameterError("a log has one clock, but the dt in u differ over the batch; pass dt=")
    return np.cumsum(durations if durations.ndim == 1 else durations[:, 0, 0])
