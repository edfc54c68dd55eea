r"""Faults: what a simulated robot does not see, and what it sees wrongly.

A landmark is measured only when it is near enough and in front of the robot (`FieldOfView`). A
measurement may be false: a reflection, somebody's leg, a wrong bar code. `Outliers` replaces
honest measurements by draws that know nothing of the pose, and keeps the labels. With labels a
detector of outliers can be scored; on real data nobody knows them.

Missing and false are different faults. A filter that gets no measurement stays as unsure as its
motion made it, and does nothing wrong. A filter that gets a false one is lied to: if it multiplies
a Gaussian density into its weights, one lie outvotes all that it knew. The first needs no remedy;
for the second there are three in `robust`. What is hidden is hidden after the draw: the
same seed gives the same measurements to a robot that sees farther.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import ParameterError, ShapeError, require_array, require_fields, require_rng
from pfkit.geometry import wrap
from pfkit.worlds.maps import LandmarkMap

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FieldOfView:
    """Which landmarks a robot can see: near enough, and in front of it.

    Parameters
    ----------
    world : LandmarkMap
    r_max : float, > 0, metres
    fov : float, in (0, 2 pi], radians
        Full width of the field of view, centred on the nose.
    """

    world: LandmarkMap
    r_max: float = np.inf
    fov: float = 2 * np.pi

    def __post_init__(self) -> None:
        require_fields(self, r_max="> 0", fov="> 0")
        if self.fov > 2 * np.pi + 1e-9:
            raise ParameterError(f"fov must be in (0, 2 pi] radians, got {self.fov}")

    def __call__(self, pose: Array) -> NDArray[np.bool_]:
        """Whether each landmark is seen from poses (3, ...): (K, ...), in the map's order."""
        x, y, theta = pose
        mx, my = self.world.positions.reshape(2, -1, *(1,) * np.ndim(x))
        dx, dy = mx - x, my - y
        bearing = wrap(np.arctan2(dy, dx) - theta)
        return (dx * dx + dy * dy <= self.r_max**2) & (np.abs(bearing) <= self.fov / 2)


@dataclass(frozen=True)
class Outliers:
    r"""False measurements: with probability epsilon a column is replaced by a uniform draw.

    .. math:: p(z \mid x) = (1 - \epsilon)\, p_{\text{honest}}(z \mid x)
                            + \epsilon \prod_i [\,l_i < z_i \le h_i\,] / (h_i - l_i)

    Parameters
    ----------
    epsilon : float in [0, 1]
    low, high : array_like (n,)
        Limits of the false values of the first n rows of z, in their units; later rows (a
        landmark's id) stay. Ranges up to 10 m and any bearing: ``(0, -pi)`` and ``(10, pi)``.
    """

    epsilon: float
    low: tuple[float, ...]
    high: tuple[float, ...]

    def __post_init__(self) -> None:
        require_fields(self, epsilon="in [0, 1]")
        low = require_array("low", self.low, ("n",))
        high = require_array("high", self.high, low.shape)
        if not (low < high).all():
            raise ParameterError(f"low must be below high in each row, got {low} and {high}")

    @property
    def density(self) -> float:
        """Density of a false measurement, as `OutlierMixture` wants it."""
        return float(1.0 / np.prod(np.subtract(self.high, self.low)))

    def spoil(self, z: Array, rng: np.random.Generator) -> tuple[Array, NDArray[np.bool_]]:
        """Replace some columns of z (n, K, ...); also return their labels (K, ...)."""
        require_rng(rng)
        z, n = require_array("z", z), len(self.low)
        if z.ndim < 2 or n > z.shape[0]:
            raise ShapeError(
                f"z must have {n} rows or more, (n, K), got {z.shape}; shorten low, high"
            )
        false = rng.random(z.shape[1:]) < self.epsilon
        low = np.reshape(self.low, (n, *(1,) * (z.ndim - 1)))
        high = np.reshape(self.high, low.shape)
        draws = high - (high - low) * rng.random((n, *z.shape[1:]))
        return np.concatenate((np.where(false, draws, z[:n]), z[n:])), false
