r"""Sensing now and then, in step with others.

A single robot that does not see a landmark records nothing about it. B robots that are
simulated side by side see different landmarks, and arrays have no holes. `Masked` adds
a row to the measurement that is 1 where something was measured and 0 where not; a column
with a 0 says nothing about the pose:

.. math:: p(z_k, s_k \mid x) = p(z_k \mid x)^{s_k} .

Not seeing a landmark would itself be a hint (it must be far, or hidden). Like most filters
in use, this one leaves that hint alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.models.sensors import Sensor

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Masked(Sensor):
    """A sensor whose columns carry one more row: 1 measured, 0 not.

    Parameters
    ----------
    sensor : Sensor
        The model of a column that was measured.
    """

    sensor: Sensor

    @property
    def components(self) -> int:  # type: ignore[override]
        """Rows of a measurement: one more than the wrapped sensor's."""
        return self.sensor.components + 1

    @property
    def angles(self) -> tuple[int, ...]:  # type: ignore[override]
        """Rows of a measurement that are angles, those of the wrapped sensor."""
        return self.sensor.angles

    def sample(self, pose: Array, rng: np.random.Generator, **which: Any) -> Array:
        """Noisy measurement with every column seen: (n + 1, K, ...)."""
        z = self.sensor.sample(pose, rng, **which)  # type: ignore[attr-defined]
        return np.concatenate((z, np.ones_like(z[:1])))

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one column where it was measured, else 0: shape (...)."""
        return np.where(zk[-1] > 0, self.sensor.log_density(zk[:-1], pose), 0.0)
