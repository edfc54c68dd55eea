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
from typing import Any, ClassVar, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import (
    DataError,
    ParameterError,
    require_components,
    require_finite,
    require_fraction,
    require_positive,
)
from pfkit.geometry import wrap
from pfkit.maps import LandmarkMap

Array = NDArray[np.float64]


class SensorModel(Protocol):
    """What a filter needs of a sensor model; a class of your own drops in."""

    def log_likelihood(self, z: Array, pose: Array) -> Array: ...


def log_gaussian(error: ArrayLike, sigma: float) -> Array:
    r"""Log density of a zero-mean Gaussian: :math:`-e^2/2\sigma^2 - \log(\sigma\sqrt{2\pi})`."""
    scaled = np.asarray(error) / sigma
    return -0.5 * scaled * scaled - math.log(sigma * math.sqrt(2 * math.pi))


def log_student(error: ArrayLike, sigma: float, nu: float) -> Array:
    r"""Log density of Student's t with scale sigma and nu degrees of freedom.

    .. math:: -\tfrac{\nu+1}{2}\log\Big(1+\frac{e^2}{\nu\sigma^2}\Big)
              + \log\frac{\Gamma((\nu+1)/2)}{\Gamma(\nu/2)\,\sigma\sqrt{\pi\nu}}

    Its tails are heavy: one wild measurement cannot veto a particle. nu = inf is Gaussian.
    """
    if math.isinf(nu):
        return log_gaussian(error, sigma)
    scaled = np.asarray(error) / sigma
    constant = math.lgamma((nu + 1) / 2) - math.lgamma(nu / 2) - 0.5 * math.log(math.pi * nu)
    return constant - math.log(sigma) - 0.5 * (nu + 1) * np.log1p(scaled * scaled / nu)


class Sensor:
    """Base of all sensors: the density of one measurement, summed over K of them.

    A subclass sets `components` and defines ``log_density(zk, pose)`` for one column zk of z.
    """

    components: ClassVar[int]

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
        """
        z = require_finite("z", require_components("z", z, self.components), DataError)
        if z.ndim == 1:
            z = z[:, None]
        total = np.zeros(pose.shape[1:])
        for k in range(z.shape[1]):
            total += self.log_density(z[:, k], pose)
        return total


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

    def __post_init__(self) -> None:
        require_positive("sigma_r", self.sigma_r)
        require_positive("sigma_phi", self.sigma_phi)
        require_finite("bias_phi", self.bias_phi)
        _require_nu(self.nu)

    def expected(self, pose: Array, ids: ArrayLike | None = None) -> Array:
        """Noise-free measurement of landmarks (all if `ids` is left out): (3, K, ...)."""
        pose = require_components("pose", pose, 3)
        (dx, dy), s = _seen(self.world, ids, pose)
        bearing = wrap(np.arctan2(dy, dx) - pose[2] + self.bias_phi)
        return np.stack((np.hypot(dx, dy), bearing, s))

    def sample(self, pose: Array, rng: np.random.Generator, ids: ArrayLike | None = None) -> Array:
        """Noisy measurement of landmarks (all if `ids` is left out): (3, K, ...)."""
        z = self.expected(pose, ids)
        z[0] += _draw(self.sigma_r, self.nu, z[0].shape, rng)
        z[1] = wrap(z[1] + _draw(self.sigma_phi, self.nu, z[1].shape, rng))
        return z

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement (r, phi, s) at poses (3, ...): shape (...)."""
        r, phi, s = zk
        x, y, theta = pose
        mx, my = self.world.locate(s)
        dx, dy = mx - x, my - y
        range_error = r - np.sqrt(dx * dx + dy * dy)
        bearing_error = wrap(phi - self.bias_phi - np.arctan2(dy, dx) + theta)
        return log_student(range_error, self.sigma_r, self.nu) + log_student(
            bearing_error, self.sigma_phi, self.nu
        )


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

    def __post_init__(self) -> None:
        require_positive("sigma_r", self.sigma_r)
        _require_nu(self.nu)
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
        z[0] += _draw(self.sigma_r, self.nu, z[0].shape, rng)
        return z

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement (r, s) at poses (3, ...): shape (...)."""
        r, s = zk
        mx, my = self.world.locate(s)
        dx, dy = mx - pose[0], my - pose[1]
        error = r - self._bias_of(s) - np.sqrt(dx * dx + dy * dy)
        return log_student(error, self.sigma_r, self.nu)

    def _bias_of(self, s: ArrayLike) -> Array:
        return self._offsets.locate(s)[0]  # type: ignore[attr-defined]


@dataclass(frozen=True)
class OutlierMixture(Sensor):
    r"""Allow each measurement to be false, with a density that knows nothing.

    .. math:: p(z \mid x) = (1 - \epsilon)\, p_{\text{sensor}}(z \mid x) + \epsilon\, c

    Far from every landmark the likelihood is then the floor :math:`\epsilon c`, not zero, and
    one false measurement cannot kill the true particles.

    Parameters
    ----------
    sensor : Sensor
        The model of an honest measurement.
    epsilon : float in [0, 1]
        The share of false measurements.
    density : float, > 0
        The density c of a false one, in the units of z: for ranges up to r_max and any bearing
        1 / (2 pi r_max).

    Raises
    ------
    ParameterError
        If epsilon is not in [0, 1] or the density is not positive.
    """

    sensor: Sensor
    epsilon: float
    density: float

    def __post_init__(self) -> None:
        require_fraction("epsilon", self.epsilon)
        require_positive("density", self.density)

    @property
    def components(self) -> int:  # type: ignore[override]
        """Rows of a measurement, those of the wrapped sensor."""
        return self.sensor.components

    def expected(self, pose: Array, **which: Any) -> Array:
        """What an honest measurement would be."""
        return self.sensor.expected(pose, **which)  # type: ignore[attr-defined]

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log of the mixture for one measurement: shape (...)."""
        honest = self.sensor.log_density(zk, pose)
        if self.epsilon == 0:
            return honest
        if self.epsilon == 1:
            return np.full_like(honest, math.log(self.density))
        return np.logaddexp(
            math.log1p(-self.epsilon) + honest, math.log(self.epsilon * self.density)
        )


def _require_nu(nu: float) -> None:
    if not nu > 0:
        raise ParameterError(f"nu must be > 0 (inf for a Gaussian), got {nu}")


def _draw(sigma: float, nu: float, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
    """Errors of scale sigma: Gaussian, or Student t."""
    draws = rng.standard_normal(shape) if math.isinf(nu) else rng.standard_t(nu, shape)
    return sigma * draws
