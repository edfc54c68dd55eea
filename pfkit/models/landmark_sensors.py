r"""Sensors that measure landmarks: range, bearing, or both.

A landmark with a name (a bar code, a radio's number) tells the robot which point of the map
it measured. Each range is a circle about the landmark on which the robot must be; each
bearing a line of sight that ties position to heading. Range and bearing to *one* landmark
leave the robot free to circle about it: turn robot and heading together about the landmark
and nothing that was measured changes. It takes a second landmark to stop that.

The identity s travels in the last row of z, so that each measurement finds its landmark. If
the robot cannot tell its landmarks apart, see `association`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import error_density
from pfkit.errors import require_array, require_fields
from pfkit.geometry import _wrap, wrap
from pfkit.models.sensors import Sensor, draw_errors
from pfkit.worlds.maps import LandmarkMap

Array = NDArray[np.float64]


def _seen(world: LandmarkMap, ids: ArrayLike | None, pose: Array) -> tuple[Array, Array, Array]:
    """Vectors (2, K, ...) from poses to landmarks, headings, and the landmarks' ids (K, ...)."""
    pose = require_array("pose", pose, (3, ...))
    ids = world.ids if ids is None else np.asarray(ids)
    column = (slice(None), slice(None), *(None,) * (pose.ndim - 1))
    s = np.broadcast_to(ids.reshape(-1, *(1,) * (pose.ndim - 1)), (ids.size, *pose.shape[1:]))
    return world.locate(ids)[column] - pose[:2, None], pose[2], s


class LandmarkSensor(Sensor):
    """What the three have in common: a map, and the identity in the last row of z.

    A subclass names the noise of each row before it in `scales`, and says in `expected` what a
    sensor without noise would measure.
    """

    world: LandmarkMap
    nu: float
    scales: ClassVar[tuple[str, ...]]
    broadcasts: ClassVar[bool] = True

    def __post_init__(self) -> None:
        require_fields(self, **dict.fromkeys(self.scales, "finite and > 0"), nu="> 0")

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free measurement of landmarks (all if `ids` is left out): (n, K, ...)."""
        raise NotImplementedError

    def sample(self, pose: Array, rng: np.random.Generator, ids: ArrayLike | None = None) -> Array:
        """Noisy measurement of landmarks (all if `ids` is left out): (n, K, ...)."""
        z = self.expected(pose, ids)
        for row, name in zip(z, self.scales, strict=False):  # the identity has no noise
            row += draw_errors(getattr(self, name), self.nu, row.shape, rng)
        for angle in self.angles:
            z[angle] = wrap(z[angle])
        return z


@dataclass(frozen=True)
class RangeBearing(LandmarkSensor):
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
    scales: ClassVar[tuple[str, ...]] = ("sigma_r", "sigma_phi")
    angles: ClassVar[tuple[int, ...]] = (1,)

    def __post_init__(self) -> None:
        super().__post_init__()
        require_fields(self, bias_phi="finite")

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free (but biased) ranges and bearings of landmarks: (3, K, ...)."""
        (dx, dy), theta, s = _seen(self.world, ids, pose)
        bearing = wrap(np.arctan2(dy, dx) - theta + self.bias_phi)
        return np.stack((np.hypot(dx, dy), bearing, s))

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
class Bearing(LandmarkSensor):
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
    scales: ClassVar[tuple[str, ...]] = ("sigma_phi",)
    angles: ClassVar[tuple[int, ...]] = (0,)

    def __post_init__(self) -> None:
        super().__post_init__()
        require_fields(self, bias_phi="finite")

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free (but biased) bearings of landmarks: (2, K, ...)."""
        (dx, dy), theta, s = _seen(self.world, ids, pose)
        return np.stack((wrap(np.arctan2(dy, dx) - theta + self.bias_phi), s))

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement (phi, s) at poses (3, ...): shape (...)."""
        phi, s = zk
        x, y, theta = pose
        mx, my = self.world.locate(s)
        error = _wrap(phi - self.bias_phi - np.arctan2(my - y, mx - x) + theta)
        return error_density(error, self.sigma_phi, self.nu)


@dataclass(frozen=True)
class Range(LandmarkSensor):
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
    scales: ClassVar[tuple[str, ...]] = ("sigma_r",)

    def __post_init__(self) -> None:
        super().__post_init__()
        bias = require_array("bias", self.bias, (len(self.world),) if np.ndim(self.bias) else ())
        object.__setattr__(self, "_biases", np.broadcast_to(bias, len(self.world)))

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free (but biased) ranges to landmarks: (2, K, ...)."""
        (dx, dy), _, s = _seen(self.world, ids, pose)
        return np.stack((np.hypot(dx, dy) + self._bias_of(s), s))

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement (r, s) at poses (3, ...): shape (...)."""
        r, s = zk
        mx, my = self.world.locate(s)
        dx, dy = mx - pose[0], my - pose[1]
        error = r - self._bias_of(s) - np.sqrt(dx * dx + dy * dy)
        return error_density(error, self.sigma_r, self.nu)

    def _bias_of(self, s: ArrayLike) -> Array:
        return self._biases[self.world.index(s)]  # type: ignore[attr-defined]
