r"""Sensors that measure landmarks: range, bearing, or both.

A landmark with a name (a bar code, a radio's number) tells the robot which point of the map
it measured. Each range is a circle about the landmark on which the robot must be; each
bearing a line of sight that ties position to heading. Range and bearing to *one* landmark
leave the robot free to circle about it: turn robot and heading together about the landmark
and nothing that was measured changes. It takes a second landmark to stop that.

The identity s travels in the last row of z, so that each measurement finds its landmark. If
the robot cannot tell its landmarks apart, see `pfkit.association`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import (
    ParameterError,
    require_components,
    require_finite,
    require_method,
    require_positive,
)
from pfkit.geometry import _wrap, wrap
from pfkit.maps import LandmarkMap
from pfkit.sensors import Sensor, draw_errors, error_density, require_nu

Array = NDArray[np.float64]


def _seen(world: LandmarkMap, ids: ArrayLike | None, pose: Array) -> tuple[Array, Array]:
    """Vectors (2, K, ...) from poses to landmarks, and their ids (K, ...)."""
    ids = world.ids if ids is None else np.asarray(ids)
    column = (slice(None), slice(None), *(None,) * (pose.ndim - 1))
    s = np.broadcast_to(ids.reshape(-1, *(1,) * (pose.ndim - 1)), (ids.size, *pose.shape[1:]))
    return world.locate(ids)[column] - pose[:2, None], s


@dataclass(frozen=True)
class RangeBearing(Sensor):
    r"""Distance and direction to landmarks of known identity: columns z_k = (r, phi, s).

    .. math:: \hat r = \sqrt{(m_x - x)^2 + (m_y - y)^2}, \qquad
              \hat\phi = \mathrm{atan2}(m_y - y,\, m_x - x) - \theta

    .. math:: p(z \mid x) = \mathcal N(r - \hat r;\, 0, \sigma_r^2)\;
                            \mathcal N(\mathrm{wrap}(\phi - \hat\phi);\, 0, \sigma_\phi^2)

    Parameters
    ----------
    world : LandmarkMap
    sigma_r : float, metres, > 0
    sigma_phi : float, radians, > 0
    nu : float
        Degrees of freedom of a Student t with these scales; inf is the Gaussian above.
    bias_phi : float, radians
        Constant error of the bearing (a camera that is mounted askew): measured minus true.

    Raises
    ------
    ParameterError
        If a sigma or nu is not positive.

    Notes
    -----
    Source: Probabilistic Robotics, Table 6.4 (landmark_model_known_correspondence).
    """

    world: LandmarkMap
    sigma_r: float
    sigma_phi: float
    nu: float = math.inf
    bias_phi: float = 0.0
    components: ClassVar[int] = 3
    angles: ClassVar[tuple[int, ...]] = (1,)
    broadcasts: ClassVar[bool] = True

    def __post_init__(self) -> None:
        require_method("world", self.world, "locate")
        require_positive("sigma_r", self.sigma_r)
        require_positive("sigma_phi", self.sigma_phi)
        require_finite("bias_phi", self.bias_phi)
        require_nu(self.nu)

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free measurement of landmarks (all if `ids` is left out): (3, K, ...)."""
        pose = require_components("pose", pose, 3)
        (dx, dy), s = _seen(self.world, ids, pose)
        bearing = wrap(np.arctan2(dy, dx) - pose[2] + self.bias_phi)
        return np.stack((np.hypot(dx, dy), bearing, s))

    def sample(self, pose: Array, rng: np.random.Generator, ids: ArrayLike | None = None) -> Array:
        """Noisy measurement of landmarks (all if `ids` is left out): (3, K, ...)."""
        z = self.expected(pose, ids)
        z[0] += draw_errors(self.sigma_r, self.nu, z[0].shape, rng)
        z[1] = wrap(z[1] + draw_errors(self.sigma_phi, self.nu, z[1].shape, rng))
        return z

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement (r, phi, s) at poses (3, ...): shape (...)."""
        r, phi, s = zk
        x, y, theta = pose
        mx, my = self.world.locate(s)
        dx, dy = mx - x, my - y
        range_error = r - np.sqrt(dx * dx + dy * dy)
        bearing_error = _wrap(phi - self.bias_phi - np.arctan2(dy, dx) + theta)
        return error_density(range_error, self.sigma_r, self.nu) + error_density(
            bearing_error, self.sigma_phi, self.nu
        )


@dataclass(frozen=True)
class Bearing(Sensor):
    r"""Direction to landmarks of known identity, from the robot's nose: columns z_k = (phi, s).

    .. math:: p(z \mid x) = \mathcal N(\mathrm{wrap}(\phi - b - \hat\phi);\,
                                       0, \sigma_\phi^2), \qquad
              \hat\phi = \mathrm{atan2}(m_y - y,\, m_x - x) - \theta

    Parameters
    ----------
    world : LandmarkMap
    sigma_phi : float, radians, > 0
    nu : float
        Degrees of freedom of a Student t with scale sigma_phi; inf is the Gaussian above.
    bias_phi : float, radians
        Constant error b of the bearing, measured minus true.

    Raises
    ------
    ParameterError
        If sigma_phi or nu is not positive, or the bias is not finite.
    """

    world: LandmarkMap
    sigma_phi: float
    nu: float = math.inf
    bias_phi: float = 0.0
    components: ClassVar[int] = 2
    angles: ClassVar[tuple[int, ...]] = (0,)
    broadcasts: ClassVar[bool] = True

    def __post_init__(self) -> None:
        require_method("world", self.world, "locate")
        require_positive("sigma_phi", self.sigma_phi)
        require_finite("bias_phi", self.bias_phi)
        require_nu(self.nu)

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free (but biased) bearings of landmarks: (2, K, ...)."""
        pose = require_components("pose", pose, 3)
        (dx, dy), s = _seen(self.world, ids, pose)
        return np.stack((wrap(np.arctan2(dy, dx) - pose[2] + self.bias_phi), s))

    def sample(self, pose: Array, rng: np.random.Generator, ids: ArrayLike | None = None) -> Array:
        """Noisy bearings of landmarks: (2, K, ...)."""
        z = self.expected(pose, ids)
        z[0] = wrap(z[0] + draw_errors(self.sigma_phi, self.nu, z[0].shape, rng))
        return z

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement (phi, s) at poses (3, ...): shape (...)."""
        phi, s = zk
        x, y, theta = pose
        mx, my = self.world.locate(s)
        error = _wrap(phi - self.bias_phi - np.arctan2(my - y, mx - x) + theta)
        return error_density(error, self.sigma_phi, self.nu)


@dataclass(frozen=True)
class Range(Sensor):
    r"""Distance to beacons of known identity: columns z_k = (r, s).

    .. math:: p(z \mid x) = \mathcal N(r - b_s - \hat r;\, 0, \sigma_r^2)

    Parameters
    ----------
    world : LandmarkMap
    sigma_r : float, metres, > 0
    bias : float or array (L,), metres
        Constant error b of the range, measured minus true: one number, or one per landmark in
        the order of ``world.ids``. Radios usually read long.
    nu : float
        Degrees of freedom of a Student t with scale sigma_r; inf is the Gaussian above.

    Raises
    ------
    ParameterError
        If sigma_r or nu is not positive, or there is not one bias per landmark.
    """

    world: LandmarkMap
    sigma_r: float
    bias: float | Array = 0.0
    nu: float = math.inf
    components: ClassVar[int] = 2
    broadcasts: ClassVar[bool] = True

    def __post_init__(self) -> None:
        require_method("world", self.world, "locate")
        require_positive("sigma_r", self.sigma_r)
        require_nu(self.nu)
        bias = require_finite("bias", self.bias)
        if bias.shape not in ((), (len(self.world),)):
            raise ParameterError(
                f"bias must be one number or one per landmark ({len(self.world)}), "
                f"got shape {bias.shape}"
            )
        biased = np.broadcast_to(bias, len(self.world))
        offsets = LandmarkMap(np.stack((biased, biased)), self.world.ids, (0.0, 1.0, 0.0, 1.0))
        object.__setattr__(self, "_offsets", offsets)

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free (but biased) ranges to landmarks: (2, K, ...)."""
        pose = require_components("pose", pose, 3)
        (dx, dy), s = _seen(self.world, ids, pose)
        return np.stack((np.hypot(dx, dy) + self._bias_of(s), s))

    def sample(self, pose: Array, rng: np.random.Generator, ids: ArrayLike | None = None) -> Array:
        """Noisy ranges to landmarks: (2, K, ...)."""
        z = self.expected(pose, ids)
        z[0] += draw_errors(self.sigma_r, self.nu, z[0].shape, rng)
        return z

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement (r, s) at poses (3, ...): shape (...)."""
        r, s = zk
        mx, my = self.world.locate(s)
        dx, dy = mx - pose[0], my - pose[1]
        error = r - self._bias_of(s) - np.sqrt(dx * dx + dy * dy)
        return error_density(error, self.sigma_r, self.nu)

    def _bias_of(self, s: ArrayLike) -> Array:
        return self._offsets.locate(s)[0]  # type: ignore[attr-defined]
