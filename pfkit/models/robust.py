r"""Sensors that forgive: wrappers that make any sensor model robust.

A Gaussian sensor model believes every measurement. One false reading then vetoes the right
particles, for good. Three remedies, each a wrapper about another sensor, in the order of how
much they know:

* `OutlierMixture` says that a share epsilon of the readings is false. It needs no threshold
  and it is a density: prefer it.
* `Gate` throws a reading away when hardly any particle can explain it. That protects a filter
  that tracks, and locks out one that is lost: to a lost filter the true reading is the odd one.
* `Tempered` raises the likelihood to a power below one. It is for readings that are not
  independent, as neighbouring laser beams, whose product would be far too sure of itself.

Wrappers nest: ``Gate(OutlierMixture(sensor, 0.05, density), 1e-4)`` is a sensor too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ShapeError, require_fields
from pfkit.models.sensors import Sensor

Array = NDArray[np.float64]


class _Wrapper(Sensor):
    """A sensor about a sensor: what it does not change it passes on."""

    sensor: Sensor

    @property
    def components(self) -> int:  # type: ignore[override]
        """Rows of a measurement, those of the wrapped sensor."""
        return self.sensor.components

    @property
    def angles(self) -> tuple[int, ...]:  # type: ignore[override]
        """Rows of a measurement that are angles, those of the wrapped sensor."""
        return self.sensor.angles

    @property
    def broadcasts(self) -> bool:  # type: ignore[override]
        """Whether several columns can be weighed at once, as in the wrapped sensor."""
        return self.sensor.broadcasts

    def check_state(self, pose: ArrayLike) -> Array:
        """Return a state that the wrapped sensor can read."""
        return self.sensor.check_state(pose)


@dataclass(frozen=True)
class OutlierMixture(_Wrapper):
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
        require_fields(self, epsilon="in [0, 1]", density="finite and > 0")

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


@dataclass(frozen=True)
class Gate(_Wrapper):
    r"""Reject a measurement that the particle set as a whole finds too unlikely.

    .. math:: \text{use } z_k \iff
              \frac{1}{M} \sum_m p(z_k \mid x^{[m]}) \ge \lambda

    A rejected measurement counts as none: it adds nothing to the log-likelihood.

    Parameters
    ----------
    sensor : Sensor
    threshold : float >= 0
        The lambda above. It is a density, in the units of p(z | x): 1 / m^2 for a position in
        metres. So it depends on the noise: a Gaussian of covariance Sigma in the plane has the
        peak 1 / (2 pi sqrt|Sigma|), and with a threshold above that *nothing* passes.

    Raises
    ------
    ParameterError
        If the threshold is negative or not finite.

    Notes
    -----
    The mean is over the particles as they stand, without weights: the gate of the laboratory,
    whose filter resamples in every step. A set spread over an area A has a mean density of
    about 1 / A for every measurement, true or false: that is why a gate that serves a tracking
    filter locks out one that starts anywhere.
    """

    sensor: Sensor
    threshold: float

    def __post_init__(self) -> None:
        require_fields(self, threshold="finite and >= 0")

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one measurement, or 0 where the set rejects it: shape (...)."""
        if np.ndim(pose) < 2:
            raise ShapeError(f"a gate asks a set of particles (3, M), got shape {np.shape(pose)}")
        log_p = self.sensor.log_density(zk, pose)
        return np.where(_mean_density(log_p) >= self.threshold, log_p, 0.0)

    def accepts(self, z: ArrayLike, pose: Array) -> NDArray[np.bool_]:
        """Which measurements (n, K) a set of poses (3, M) lets pass: (K,), or (K, B)."""
        z, pose = self.read(z), self.check_state(pose)
        means = [
            _mean_density(self.sensor.log_density(z[:, k], pose))[..., 0] for k in range(z.shape[1])
        ]
        return np.array(means) >= self.threshold


def _mean_density(log_p: Array) -> Array:
    """Mean of exp(log_p) over the particles, the last axis, which is kept with length one."""
    return np.exp(log_p).mean(axis=-1, keepdims=True)


@dataclass(frozen=True)
class Tempered(_Wrapper):
    r"""Count measurements less than fully, because they are not independent.

    .. math:: \log p(z \mid x) \leftarrow \beta \sum_k \log p(z_k \mid x)

    Thirty laser beams that meet the same wrongly mapped cupboard are wrong together. Their
    product treats the one error as thirty, and the belief shrinks to a wrong point. With
    beta = 1/3 thirty beams count as ten.

    Parameters
    ----------
    sensor : Sensor
    exponent : float in [0, 1]
        The power beta; 1 changes nothing, 0 ignores the sensor.

    Raises
    ------
    ParameterError
        If the exponent is not in [0, 1].

    Notes
    -----
    A power of a density is no density. Weights are right up to their constant, but the log
    evidence of a filter with a tempered sensor is no probability: do not compare it across
    sensors. Source: Probabilistic Robotics, section 6.3.4 (on correlated beams).
    """

    sensor: Sensor
    exponent: float

    def __post_init__(self) -> None:
        require_fields(self, exponent="in [0, 1]")

    def log_density(self, zk: Array, pose: Array) -> Array:
        """The exponent times the log density of one measurement: shape (...)."""
        return self.exponent * self.sensor.log_density(zk, pose)

    def log_likelihood(self, z: ArrayLike, pose: Array) -> Array:
        """The exponent times the log-likelihood of the wrapped sensor: shape (...)."""
        return self.exponent * self.sensor.log_likelihood(z, pose)
