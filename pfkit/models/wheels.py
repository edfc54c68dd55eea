r"""Motion models of two vehicles: two driven wheels, and a bicycle.

The velocity model does not ask how a robot comes by its v and omega. Vehicles differ there,
and so do their errors.

A *differential drive* has two driven wheels on one axle. Equal speeds drive straight, opposite
speeds turn on the spot, and one slipping wheel spoils speed *and* turn at once: the errors of
v and omega are correlated, which no choice of alphas in the velocity model can say.

A *bicycle* (or a car) steers. It turns only while it rolls, so it cannot turn on the spot, and
a parked one stays parked whatever the handlebar does.

Both end in the same exact arc. Neither has a density: two errors move three coordinates, so
after one step all particles lie on a surface.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ParameterError, require_array, require_fields
from pfkit.models.motion import draw_noise, drive_arc

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DifferentialDrive:
    r"""Two wheels on one axle, turning at their own speeds: u = (u_l, u_r, dt).

    .. math:: v = \frac r2 (u_r + u_l), \qquad \omega = \frac rL (u_r - u_l)

    .. math:: \hat u_i = u_i + \mathcal N(0, \alpha u_i^2), \quad
              \hat v = v + \mathcal N(0, \sigma_v^2), \quad
              \hat\omega = \omega + \mathcal N(0, \sigma_\omega^2)

    Parameters
    ----------
    r : float, metres, > 0
        Radius of the wheels.
    L : float, metres, > 0
        Length of the axle, from wheel to wheel.
    alpha : float >= 0
        Slip: variance of a wheel's speed per squared speed, dimensionless.
    sigma_v, sigma_omega : float >= 0, m/s and rad/s
        Standard deviations of disturbances that act on the body, also at rest.

    Raises
    ------
    ParameterError
        If a length is not positive or a noise is negative.
    """

    r: float
    L: float
    alpha: float = 0.01
    sigma_v: float = 0.0
    sigma_omega: float = 0.0

    def __post_init__(self) -> None:
        require_fields(
            self,
            r="finite and > 0",
            L="finite and > 0",
            alpha="finite and >= 0",
            sigma_v="finite and >= 0",
            sigma_omega="finite and >= 0",
        )

    def body_speed(self, left: ArrayLike, right: ArrayLike) -> tuple[Array, Array]:
        """Speed v (m/s) and turn rate omega (rad/s) from wheel speeds in rad/s."""
        left, right = np.asarray(left), np.asarray(right)
        return 0.5 * self.r * (right + left), self.r / self.L * (right - left)

    def mean(self, pose: Array, u: ArrayLike) -> Array:
        """Noise-free arc: pose (3, ...), u (3,) -> pose (3, ...)."""
        left, right, dt = np.asarray(u, dtype=float)
        v, omega = self.body_speed(left, right)
        return drive_arc(pose, v * dt, omega * dt)

    def sample(self, pose: Array, u: ArrayLike, rng: np.random.Generator) -> Array:
        """Each particle's wheels slip on their own: (3, ...), (3,) -> (3, ...)."""
        pose, u = require_array("pose", pose, (3, ...)), require_array("u", u, (3, ...))
        left, right, dt = u
        shape = np.broadcast_shapes(pose.shape[1:], u.shape[1:])
        v, omega = self.body_speed(
            left + draw_noise(self.alpha * left**2, shape, rng),
            right + draw_noise(self.alpha * right**2, shape, rng),
        )
        v = v + draw_noise(self.sigma_v**2, shape, rng)
        omega = omega + draw_noise(self.sigma_omega**2, shape, rng)
        return drive_arc(pose, v * dt, omega * dt)


@dataclass(frozen=True)
class Bicycle:
    r"""Roll at a speed with the front wheel turned: u = (v, delta, dt).

    .. math:: \omega = \frac vL \tan\delta, \qquad
              \hat v = v + \mathcal N(0, \alpha v^2), \quad
              \hat\delta = \delta + \mathcal N(0, \sigma_\delta^2)

    The pose is that of the rear wheel's contact point; v is the rear wheel's speed.

    Parameters
    ----------
    L : float, metres, > 0
        Wheelbase, from rear to front axle.
    alpha : float >= 0
        Variance of the speed per squared speed, dimensionless.
    sigma_delta : float >= 0, radians
        Standard deviation of the steering angle.

    Raises
    ------
    ParameterError
        If the wheelbase is not positive, a noise is negative, or a steering angle is a quarter
        turn or more.
    """

    L: float
    alpha: float = 0.01
    sigma_delta: float = 0.02

    def __post_init__(self) -> None:
        require_fields(
            self, L="finite and > 0", alpha="finite and >= 0", sigma_delta="finite and >= 0"
        )

    def mean(self, pose: Array, u: ArrayLike) -> Array:
        """Noise-free arc: pose (3, ...), u (3,) -> pose (3, ...)."""
        v, delta, dt = self._control(u)
        return drive_arc(pose, v * dt, v * dt * np.tan(delta) / self.L)

    def sample(self, pose: Array, u: ArrayLike, rng: np.random.Generator) -> Array:
        """Each particle rolls and steers with errors of its own: (3, ...), (3,) -> (3, ...)."""
        pose, u = require_array("pose", pose, (3, ...)), self._control(u)
        v, delta, dt = u
        shape = np.broadcast_shapes(pose.shape[1:], u.shape[1:])
        distance = (v + draw_noise(self.alpha * v**2, shape, rng)) * dt
        delta = delta + draw_noise(self.sigma_delta**2, shape, rng)
        return drive_arc(pose, distance, distance * np.tan(delta) / self.L)

    @staticmethod
    def _control(u: ArrayLike) -> Array:
        u = np.asarray(u, dtype=float)
        if not (np.abs(u[1]) < np.pi / 2).all():
            raise ParameterError(
                f"the steering angle must be within a quarter turn, got {np.max(np.abs(u[1]))} "
                "rad; u is (v, delta, dt) with delta in radians"
            )
        return u
