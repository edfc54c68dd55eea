r"""Data association: which landmark was it?

A measurement of a landmark with a name finds its place in the map by itself: *known
association*, what all landmark sensors assume. Without a name each measurement must be
matched to a landmark first. Maximum likelihood matches it to the one that explains it best,

.. math:: \hat c_k = \arg\max_c\; p(z_k \mid x, m_c), \qquad
          p(z_k \mid x) \leftarrow p(z_k \mid x, m_{\hat c_k}) .

A Kalman filter decides once, for its one guess of the pose, and a wrong match is for good. In
a particle filter every particle decides for itself: those that match wrongly predict the next
measurements badly and die out. So the set as a whole keeps several matchings alive for a while.

The price is K times L densities per particle instead of K, and a likelihood with more modes: a
pose one landmark further on explains a row of equal posts nearly as well.

To ignore what fits no landmark, put a gate about it:
``Gate(MaximumLikelihood(sensor), threshold)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.models.landmark_sensors import LandmarkSensor
from pfkit.models.sensors import Sensor

Array = NDArray[np.float64]


@dataclass(frozen=True)
class MaximumLikelihood(Sensor):
    """Measure landmarks without names: the rows of `sensor` except its last, the identity.

    Parameters
    ----------
    sensor : Range, Bearing or RangeBearing
        The model for a landmark once it is known, and the map.

    Raises
    ------
    ParameterError
        If the sensor does not measure landmarks by identity.

    Notes
    -----
    The likelihood is a maximum over landmarks, so as a function of z it integrates to more than
    one; the log evidence is too large, by at most log L per measurement.
    Source: Probabilistic Robotics, section 7.5 and Table 7.3, for each particle by itself.
    """

    sensor: LandmarkSensor

    @property
    def components(self) -> int:  # type: ignore[override]
        """Rows of a measurement: those of the sensor without the identity."""
        return self.sensor.components - 1

    @property
    def angles(self) -> tuple[int, ...]:  # type: ignore[override]
        """Rows of a measurement that are angles, those of the sensor."""
        return self.sensor.angles

    def sample(self, pose: Array, rng: np.random.Generator, **which: Any) -> Array:
        """Noisy measurements, without their names: (n, K, ...)."""
        return self.sensor.sample(pose, rng, **which)[:-1]

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log density under the landmark that explains zk best, at each pose: shape (...)."""
        ids = self.sensor.world.ids
        best = self._given(ids[0], zk, pose)
        for s in ids[1:]:
            best = np.maximum(best, self._given(s, zk, pose))
        return best

    def _given(self, s: np.int64, zk: Array, pose: Array) -> Array:
        named = np.concatenate((zk, np.full_like(zk[:1], s)))
        return np.asarray(self.sensor.log_density(named, pose))
