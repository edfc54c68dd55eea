r"""A sensor that does not sit where the robot is.

A robot's pose is that of a point between its wheels. A laser sits ahead of it, a camera is turned a
little, a scanner hangs upside down under a shelf. The sensor's own pose is the robot's, and then
the mounting,

.. math:: x_{sensor} = x \oplus m, \qquad p(z \mid x) = p_{sensor}(z \mid x \oplus m) .

Whoever forgets a mounting of twenty centimetres and five degrees gets a filter that is wrong by
half a metre at ten, and sure of it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array
from pfkit.geometry import compose
from pfkit.models.sensors import Sensor

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Mounted(Sensor):
    """A sensor at a pose of its own on the robot.

    Parameters
    ----------
    sensor : Sensor of poses
    mount : (x, y, yaw), metres and radians, the sensor's pose on the robot
    flipped : bool
        It hangs upside down: what it calls left is right.

    Raises
    ------
    ParameterError, ShapeError
        If the sensor is none or the mounting is not three finite numbers.
    """

    sensor: Sensor
    mount: tuple[float, float, float]
    flipped: bool = False

    def __post_init__(self) -> None:
        mount = require_array("mount", self.mount, (3,))
        object.__setattr__(self, "mount", tuple(mount.tolist()))

    @property
    def components(self) -> int:  # type: ignore[override]
        """Rows of a measurement, those of the sensor."""
        return self.sensor.components

    @property
    def angles(self) -> tuple[int, ...]:  # type: ignore[override]
        """Rows of a measurement that are angles, those of the sensor."""
        return self.sensor.angles

    def expected(self, pose: Array) -> Array:
        """What the sensor would measure without noise: (n, K, ...)."""
        return self._turn_over(self.sensor.expected(self._seat(pose)))  # type: ignore[attr-defined]

    def sample(self, pose: Array, rng: np.random.Generator) -> Array:
        """Noisy measurement: (n, K, ...)."""
        return self._turn_over(self.sensor.sample(self._seat(pose), rng))  # type: ignore[attr-defined]

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement at poses (3, ...) of the robot: shape (...)."""
        return self.sensor.log_density(self._turn_over(zk), self._seat(pose))

    def log_likelihood(self, z: ArrayLike, pose: Array) -> Array:
        """The log-likelihood of the sensor at its own poses: shape (...)."""
        return self.sensor.log_likelihood(self._turn_over(np.asarray(z)), self._seat(pose))

    def _seat(self, pose: Array) -> Array:
        column = (slice(None), *(None,) * (np.ndim(pose) - 1))
        return compose(pose, np.array(self.mount)[column])

    def _turn_over(self, z: Array) -> Array:
        if not self.flipped:
            return z
        z = np.array(z, dtype=float)
        for row in self.angles:
            z[row] = -z[row]
        return z
