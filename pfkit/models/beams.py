r"""The beam model: what a laser reads in a room that the map knows only partly.

A map and a ray caster say how far a beam should fly. What the sensor reads differs, for four
reasons, each with a density of its own:

* *hit*: the wall it should meet, with a little noise: a Gaussian about the expected length;
* *short*: somebody stood in the way. The nearer, the likelier to be met: an exponential that
  ends at the wall;
* *max*: the beam was lost (black or mirroring surface) and the sensor reports its maximum;
* *rand*: something unexplained: uniform over the range.

.. math:: p(r \mid x) = z_{hit}\, p_{hit} + z_{short}\, p_{short} + z_{max}\, p_{max}
                        + z_{rand}\, p_{rand}, \qquad \sum z = 1

Reading the maximum is an *event*, with a probability; all else has a density in metres. We keep
the two apart: a reading of r_max has the probability that the sensor reports it, be the beam
lost or the wall too far; a shorter one has the density of the other three. So the model
integrates to one, and log evidence means something.

The four shares and two widths can be learned from readings at known poses: see `beam_fit`.

Thirty beams are not thirty independent witnesses: a person or a wrong wall spoils several at
once. Use few, or wrap the model in `robust.Tempered`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import DataError, ParameterError, require_array, require_fields
from pfkit.models.sensors import Sensor
from pfkit.worlds.occupancy import OccupancyGrid
from pfkit.worlds.raycast import RayCaster

Array = NDArray[np.float64]

SHARES = ("z_hit", "z_short", "z_max", "z_rand")


def normal_cdf(x: ArrayLike) -> Array:
    """The standard normal distribution function; exact, and slow only near its steep part."""
    x = np.asarray(x, dtype=float)
    value = np.array(x > 0, dtype=float)
    near = np.abs(x) < 8.5
    value[near] = [0.5 * math.erfc(-v / math.sqrt(2)) for v in x[near]]
    return value


@dataclass(frozen=True, eq=False)
class BeamModel(Sensor):
    r"""A laser with four kinds of readings: columns z_k = (r, phi).

    .. math:: p_{hit} &= \frac{\mathcal N(r;\, r^*, \sigma_{hit}^2)}{\Phi(r^* / \sigma_{hit})} \\
              p_{short} &= \frac{\lambda\, e^{-\lambda r}}{1 - e^{-\lambda r^*}}\; [r \le r^*] \\
              p_{rand} &= \frac{1}{r_{max}} \qquad (r < r_{max})

    with :math:`r^*` the length that ray casting gives. A hit or a short that would lie beyond
    r_max is read as r_max:

    .. math:: P(r = r_{max}) = z_{max}
              &+ z_{hit}\, \frac{\Phi((r^* - r_{max}) / \sigma_{hit})}{\Phi(r^* / \sigma_{hit})} \\
              &+ z_{short}\, \frac{\max(e^{-\lambda r_{max}} - e^{-\lambda r^*},\, 0)}
                                {1 - e^{-\lambda r^*}}

    Parameters
    ----------
    world : OccupancyGrid
    directions : array_like (K,), radians
        Directions of the sensor's beams from the robot's nose, for `expected` and `sample`.
        Measurements carry their own.
    r_max : float, metres, > 0
    sigma_hit : float, metres, > 0
    lambda_short : float, 1 / metres, > 0
    z_hit, z_short, z_max, z_rand : float in [0, 1]
        Shares of the four kinds; they sum to one.

    Raises
    ------
    ParameterError, ShapeError
        If a parameter is out of range, or the shares do not sum to one.

    Notes
    -----
    Source: Probabilistic Robotics, section 6.3 and Table 6.1. There the Gaussian is cut off at
    r_max and a probability is added to densities; here what it would exceed is read as r_max.
    Cost: one ray cast per beam and particle.
    """

    world: OccupancyGrid
    directions: ArrayLike
    r_max: float
    sigma_hit: float = 0.1
    lambda_short: float = 1.0
    z_hit: float = 0.85
    z_short: float = 0.05
    z_max: float = 0.05
    z_rand: float = 0.05
    components: ClassVar[int] = 2
    angles: ClassVar[tuple[int, ...]] = (1,)

    def __post_init__(self) -> None:
        directions = require_array("directions", self.directions, ("K",))
        require_fields(
            self,
            r_max="finite and > 0",
            sigma_hit="finite and > 0",
            lambda_short="finite and > 0",
            **dict.fromkeys(SHARES, "in [0, 1]"),
        )
        total = float(self.shares.sum())
        if abs(total - 1) > 1e-9:
            raise ParameterError(f"z_hit + z_short + z_max + z_rand must be 1, got {total}")
        object.__setattr__(self, "directions", directions)
        object.__setattr__(self, "_caster", RayCaster(self.world))

    @property
    def shares(self) -> Array:
        """The shares (4,) of hit, short, max and rand."""
        return np.array([getattr(self, name) for name in SHARES])

    def lengths(self, pose: Array, phi: ArrayLike | None = None) -> Array:
        """How far beams would fly, inf if they meet nothing: (K, ...), metres."""
        phi = self.directions if phi is None else phi
        return self._caster.cast(pose, phi, math.inf)  # type: ignore[attr-defined]

    def expected(self, pose: Array) -> Array:
        """What a sensor without faults would read: (2, K, ...)."""
        return self._readings(np.minimum(self.lengths(pose), self.r_max))

    def _readings(self, r: Array) -> Array:
        """Ranges (K, ...) with the sensor's directions beside them: (2, K, ...)."""
        phi = np.reshape(self.directions, (-1, *(1,) * (r.ndim - 1)))
        return np.stack((r, np.broadcast_to(phi, r.shape)))

    def sample(self, pose: Array, rng: np.random.Generator) -> Array:
        """Readings with all four kinds of faults: (2, K, ...)."""
        length = self.lengths(pose)
        shape = length.shape
        hit = length + self.sigma_hit * draw_normal(shape, rng)
        while (behind := hit < 0).any():  # the Gaussian ends at the sensor
            hit[behind] = length[behind] + self.sigma_hit * rng.standard_normal(behind.sum())
        unit = rng.random(shape)  # the exponential that ends at the wall, by inversion
        short = -np.log1p(unit * np.expm1(-self.lambda_short * length)) / self.lambda_short
        lost, unexplained = np.full(shape, self.r_max), self.r_max * rng.random(shape)
        kind = rng.choice(4, size=shape, p=self.shares)
        r = np.choose(kind, (hit, short, lost, unexplained))
        return self._readings(np.minimum(r, self.r_max))

    def parts(self, r: ArrayLike, length: ArrayLike) -> Array:
        """The four densities (4, ...) of readings r whose beams should fly `length` metres.

        Where r is r_max they are probabilities of reading r_max; elsewhere in 1 / metres.
        """
        r = require_array("r", r, rule="finite and >= 0", error=DataError)
        length = require_array("length", length, rule=">= 0", error=DataError)
        r, length = np.broadcast_arrays(r, length)
        top, lam = r >= self.r_max, self.lambda_short
        scaled = (r - length) / self.sigma_hit
        peak = 1 / (self.sigma_hit * math.sqrt(2 * math.pi))
        hit = np.array(peak * np.exp(-0.5 * scaled * scaled))
        hit[top] = normal_cdf((length[top] - self.r_max) / self.sigma_hit)
        hit /= normal_cdf(length / self.sigma_hit)
        before = np.where(length > 0, -np.expm1(-lam * length), 1.0)  # somebody before the wall
        short = np.where((r <= length) & (length > 0), lam * np.exp(-lam * r) / before, 0.0)
        beyond = math.exp(-lam * self.r_max) - np.exp(-lam * length[top])  # ... but out of reach
        short[top] = np.maximum(beyond, 0.0) / before[top]
        return np.stack((hit, short, top.astype(float), np.where(top, 0.0, 1 / self.r_max)))

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log p of one reading (r, phi) at poses (3, ...): shape (...)."""
        return self.log_likelihood(zk[:, None], pose)

    def log_likelihood(self, z: ArrayLike, pose: Array) -> Array:
        """Sum of log densities over the beams: z (2, K) or (2, K, B, 1), one number per pose."""
        r, phi = self.read(z)
        pose = self.check_state(pose)
        total = np.zeros(pose.shape[1:])
        for rk, length in zip(r, self.lengths(pose, phi), strict=True):
            density = np.tensordot(self.shares, self.parts(rk, length), axes=1)
            with np.errstate(divide="ignore"):  # without z_rand a reading can be impossible
                total += np.log(density)
        return total
