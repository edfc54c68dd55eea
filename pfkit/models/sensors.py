r"""Sensor models: what a measurement says about a pose.

A sensor model is the density p(z | x): how probable was *this* measurement, had the robot
been at x? The filter evaluates it at every particle; that number is the weight. Read as a
function of x it is called the likelihood, and it need not integrate to one.

Several measurements at once are conditionally independent given the pose and the map, so
their densities *multiply*:

.. math:: p(z_{1:K} \mid x) = \prod_k p(z_k \mid x), \qquad
          \log p = \sum_k \log p(z_k \mid x) .

Averaging them instead is a common error: it lets one vague measurement excuse another that
is impossible.

A bearing is an angle, so the difference of two bearings must be wrapped before it is
squared. And a bearing is measured from the robot's nose: subtract the heading.

All densities carry their full normalising constants. They cancel in the weights, but not in
the evidence, in a mixture with outliers, or in an absolute gate.

A measurement set z has components first: ``(n, K)``, one column per measurement.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal, error_density, gaussian
from pfkit.errors import DataError, require_array, require_fields, require_rng
from pfkit.geometry import wrap

Array = NDArray[np.float64]


class SensorModel(Protocol):
    """What a filter needs of a sensor model; a class of your own drops in."""

    def log_likelihood(self, z: Array, pose: Array) -> Array:
        """Log p(z | x) of all measurements z (n, K): one number for each pose (3, ...)."""


def how_many(z: ArrayLike | None) -> int:
    """Number K of measurements in a set (n, K, ...): 0 for None, 1 for a single one (n,)."""
    shape = (0,) if z is None else np.shape(z)
    return 0 if 0 in shape else shape[1] if len(shape) > 1 else 1


def draw_errors(sigma: float, nu: float, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
    """Errors of scale sigma: Gaussian, or Student t."""
    require_rng(rng)
    draws = rng.standard_normal(shape) if math.isinf(nu) else rng.standard_t(nu, shape)
    return sigma * draws


_CACHE = 8192  # numbers in an array that still fits into a processor's first cache


class Sensor:
    """Base of all sensors: the density of one measurement, summed over K of them.

    A subclass sets `components` and defines ``log_density(zk, pose)`` for one column zk of z.
    `angles` names the rows of z that are angles, for whoever subtracts measurements. A sensor
    that sets `broadcasts` promises that its `log_density` takes several columns at once, zk
    (n, k, 1), and returns (k, ...): for small sets one call for all columns is much faster.
    """

    components: ClassVar[int]
    angles: ClassVar[tuple[int, ...]] = ()
    broadcasts: ClassVar[bool] = False

    def check_state(self, pose: ArrayLike) -> Array:
        """Return a pose (3, ...) as a finite array; sensors of other states say which."""
        return require_array("pose", pose, (3, ...))

    def read(self, z: ArrayLike) -> Array:
        """Return measurements (n, K, ...) as a finite array; a single one (n,) is a set of one."""
        z = require_array("z", z, (self.components, ...), error=DataError)
        return z if z.ndim > 1 else z[:, None]

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log density of one measurement zk (n, ...) at poses (3, ...): shape (...)."""
        raise NotImplementedError

    def log_likelihood(self, z: ArrayLike, pose: Array) -> Array:
        r"""Sum over the measurements, :math:`\sum_k \log p(z_k \mid x)`.

        Parameters
        ----------
        z : array_like (n, K), or (n, K, B, 1) with one set per filter of a batch
        pose : array (3, ...)

        Returns
        -------
        array (...), one number per particle

        Raises
        ------
        ShapeError, DataError
            If z does not have n rows or holds NaN or infinity.
        ParameterError, ShapeError
            If a pose is not finite, or does not have the components that the sensor reads.
        """
        z, pose = self.read(z), self.check_state(pose)
        if z.shape[1] == 1:
            return self.log_density(z[:, 0], pose)
        total = np.zeros(pose.shape[1:])
        together = max(1, _CACHE // max(1, total.size)) if self.broadcasts else 1
        if together == 1:
            for k in range(z.shape[1]):
                total += self.log_density(z[:, k], pose)
            return total
        if z.ndim == 2:
            z = z.reshape(*z.shape, *(1,) * (pose.ndim - 1))
        for k in range(0, z.shape[1], together):
            total += self.log_density(z[:, k : k + together], pose).sum(axis=0)
        return total


@dataclass(frozen=True)
class Position(Sensor):
    r"""A position fix, as from satellites or a camera on the ceiling: columns z_k = (x, y).

    .. math:: p(z \mid x) = \mathcal N(z_x - x;\, 0, \sigma_x^2)\;
                            \mathcal N(z_y - y;\, 0, \sigma_y^2)

    It reads the first two components of a state of any dimension.

    Parameters
    ----------
    sigma : float or array_like (2,), metres (or pixels), > 0
        Standard deviation, the same in x and y or one for each.

    Raises
    ------
    ParameterError, ShapeError
        If sigma is not one positive number or two.
    """

    sigma: ArrayLike
    components: ClassVar[int] = 2
    broadcasts: ClassVar[bool] = True

    def __post_init__(self) -> None:
        sizes = (2,) if np.ndim(self.sigma) else ()
        sigma = require_array("sigma", self.sigma, sizes, "finite and > 0")
        object.__setattr__(self, "_sigmas", tuple(np.broadcast_to(sigma, 2).tolist()))

    def expected(self, pose: Array) -> Array:
        """The position itself, as one measurement: (2, 1, ...)."""
        return self.check_state(pose)[:2, None].copy()

    def check_state(self, pose: ArrayLike) -> Array:
        """Return a state (D, ...), D >= 2, as a finite array."""
        return np.asarray(pose, dtype=float)

    def sample(self, pose: Array, rng: np.random.Generator) -> Array:
        """One noisy position: (2, 1, ...)."""
        z = self.expected(pose)
        for row, sigma in zip(z, self._sigmas, strict=True):  # type: ignore[attr-defined]
            row += sigma * draw_normal(row.shape, rng)
        return z

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one position (2, ...) at states (D, ...): shape (...)."""
        sigma_x, sigma_y = self._sigmas  # type: ignore[attr-defined]
        return gaussian(zk[0] - pose[0], sigma_x) + gaussian(zk[1] - pose[1], sigma_y)


@dataclass(frozen=True)
class Compass(Sensor):
    r"""The heading itself: columns z_k = (theta,).

    .. math:: p(z \mid x) = \mathcal N(\mathrm{wrap}(z - b - \theta);\, 0, \sigma_\theta^2)

    Parameters
    ----------
    sigma_theta : float, radians, > 0
    bias : float, radians
        Constant error b, measured minus true: the declination, or a compass mounted askew.
    nu : float
        Degrees of freedom of a Student t with scale sigma_theta; inf is the Gaussian above.

    Raises
    ------
    ParameterError
        If sigma_theta or nu is not positive, or the bias is not finite.
    """

    sigma_theta: float
    bias: float = 0.0
    nu: float = math.inf
    components: ClassVar[int] = 1
    angles: ClassVar[tuple[int, ...]] = (0,)

    def __post_init__(self) -> None:
        require_fields(self, sigma_theta="finite and > 0", bias="finite", nu="> 0")

    def expected(self, pose: Array) -> Array:
        """Noise-free (but biased) heading: (1, 1, ...)."""
        return wrap(self.check_state(pose)[2:, None] + self.bias)

    def sample(self, pose: Array, rng: np.random.Generator) -> Array:
        """One noisy heading: (1, 1, ...)."""
        z = self.expected(pose)
        return wrap(z + draw_errors(self.sigma_theta, self.nu, z.shape, rng))

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one heading (1, ...) at poses (3, ...): shape (...)."""
        return error_density(wrap(zk[0] - self.bias - pose[2]), self.sigma_theta, self.nu)
