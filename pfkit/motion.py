r"""Motion models: where a control takes the robot, and how badly.

A motion model is the density p(x_t | u_t, x_{t-1}). A particle filter never evaluates it;
it only *samples*: each particle carries out the control with errors of its own. Draw the
errors anew for each particle and each step. One common error for the whole cloud would move
it rigidly and its spread would never grow.

Where the errors enter matters as much as how large they are. Noise added to the pose makes
a round blob. Noise in the control - a slightly wrong speed, a slightly wrong turn - bends
the cloud into the banana that wheeled robots really leave.

Between two instants a robot with constant speed v and turn rate omega drives an exact arc.
Its chord has length :math:`v\,\Delta t\,\mathrm{sinc}(\omega\Delta t/2)` and points in the
direction :math:`\theta + \omega\Delta t/2`. Written so, the straight line is simply the arc
with omega = 0, and nothing is divided by zero.

Every model has ``mean(pose, u)``, which is noise-free, and ``sample(pose, u, rng)``. Both
take one pose ``(3,)``, a cloud ``(3, M)`` or a batch ``(3, B, M)``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ShapeError, require_components, require_non_negative
from pfkit.geometry import between, wrap

Array = NDArray[np.float64]


class MotionModel(Protocol):
    """What a filter needs of a motion model; a class of your own drops in."""

    def mean(self, pose: Array, u: Array) -> Array: ...

    def sample(self, pose: Array, u: Array, rng: np.random.Generator) -> Array: ...


def _noise(variance: ArrayLike, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
    """Zero-mean Gaussian noise of a given variance, one number per particle."""
    return np.sqrt(variance) * rng.standard_normal(shape)


def drive_arc(pose: Array, distance: ArrayLike, turn: ArrayLike) -> Array:
    r"""Follow an arc of a given length while the heading turns by a given angle.

    .. math:: x' = x + d\,\mathrm{sinc}(\tfrac{\phi}{2}) \cos(\theta + \tfrac{\phi}{2}), \quad
              y' = y + d\,\mathrm{sinc}(\tfrac{\phi}{2}) \sin(\theta + \tfrac{\phi}{2}), \quad
              \theta' = \mathrm{wrap}(\theta + \phi)

    Parameters
    ----------
    pose : array (3, ...), metres and radians
    distance : array_like, metres along the arc; negative drives backwards
    turn : array_like, radians

    Returns
    -------
    array (3, ...), the pose at the end of the arc

    Notes
    -----
    Source: Probabilistic Robotics, eq. 5.9, with its division by omega removed.
    """
    x, y, theta = pose
    half = 0.5 * np.asarray(turn, dtype=float)
    chord = distance * np.sinc(half / np.pi)
    direction = theta + half
    return np.stack(
        (x + chord * np.cos(direction), y + chord * np.sin(direction), wrap(direction + half))
    )


@dataclass(frozen=True)
class VelocityMotion:
    r"""Drive with a commanded speed and turn rate for a time: u = (v, omega, dt).

    .. math:: \hat v = v + \mathcal N(0, \alpha_1 v^2 + \alpha_2 \omega^2), \quad
              \hat\omega = \omega + \mathcal N(0, \alpha_3 v^2 + \alpha_4 \omega^2), \quad
              \hat\gamma = \mathcal N(0, \alpha_5 v^2 + \alpha_6 \omega^2)

    The robot then follows the exact arc of :math:`(\hat v, \hat\omega)` and turns by
    :math:`\hat\gamma\,\Delta t` more, without which all headings would lie on a line.

    Parameters
    ----------
    alpha : 4 or 6 numbers >= 0
        Noise per motion, as variances: alpha_1 is dimensionless, alpha_2 in (m/rad)^2,
        alpha_3 in (rad/m)^2, alpha_4 dimensionless. With four, gamma is left out.

    Raises
    ------
    ParameterError, ShapeError
        If an alpha is negative or not finite, or there are not four or six.

    Notes
    -----
    Source: Probabilistic Robotics, Table 5.3 (sampling), Table 5.1 (density).
    """

    alpha: tuple[float, ...] = (0.05, 0.01, 0.01, 0.05, 0.0, 0.0)

    def __post_init__(self) -> None:
        alpha = require_non_negative("alpha", self.alpha)
        if alpha.shape not in ((4,), (6,)):
            raise ShapeError(f"alpha must hold 4 or 6 numbers, got shape {alpha.shape}")
        object.__setattr__(self, "alpha", (*alpha.tolist(), 0.0, 0.0)[:6])

    def variances(self, u: ArrayLike) -> Array:
        """Variances (3, ...) of v, omega and gamma for a control u (3, ...)."""
        v, omega, _ = require_components("u", u, 3)
        a1, a2, a3, a4, a5, a6 = self.alpha
        v2, omega2 = v * v, omega * omega
        return np.stack((a1 * v2 + a2 * omega2, a3 * v2 + a4 * omega2, a5 * v2 + a6 * omega2))

    def mean(self, pose: Array, u: ArrayLike) -> Array:
        """Noise-free arc: pose (3, ...), u (3,) -> pose (3, ...)."""
        v, omega, dt = require_components("u", u, 3)
        return drive_arc(require_components("pose", pose, 3), v * dt, omega * dt)

    def sample(self, pose: Array, u: ArrayLike, rng: np.random.Generator) -> Array:
        """Each particle drives with errors of its own: (3, ...), (3,) -> (3, ...)."""
        pose = require_components("pose", pose, 3)
        v, omega, dt = require_components("u", u, 3)
        var_v, var_omega, var_gamma = self.variances(u)
        shape = pose.shape[1:]
        v_hat = v + _noise(var_v, shape, rng)
        omega_hat = omega + _noise(var_omega, shape, rng)
        moved = drive_arc(pose, v_hat * dt, omega_hat * dt)
        if self.alpha[4] or self.alpha[5]:
            moved[2] = wrap(moved[2] + dt * _noise(var_gamma, shape, rng))
        return moved


def odometry_control(pose0: ArrayLike, pose1: ArrayLike) -> Array:
    r"""What the odometer saw between two of its poses: turn, drive, turn.

    .. math:: \delta_{rot1} = \mathrm{atan2}(\Delta y, \Delta x) - \theta_0, \quad
              \delta_{trans} = \sqrt{\Delta x^2 + \Delta y^2}, \quad
              \delta_{rot2} = \theta_1 - \theta_0 - \delta_{rot1}

    Parameters
    ----------
    pose0, pose1 : array_like (3, ...), odometry poses, metres and radians

    Returns
    -------
    u : array (3, ...): rot1 (rad), trans (m), rot2 (rad). A robot that turned on the spot has
        no direction of travel; then rot1 is 0 and rot2 takes the whole turn.

    Notes
    -----
    Source: Probabilistic Robotics, Table 5.6, lines 2 to 4.
    """
    dx, dy, turn = between(pose0, pose1)
    trans = np.hypot(dx, dy)
    rot1 = np.where(trans > 0, np.arctan2(dy, dx), 0.0)
    return np.stack((rot1, trans, wrap(turn - rot1)))


@dataclass(frozen=True)
class OdometryMotion:
    r"""Repeat what the odometer saw, turn - drive - turn: u = (rot1, trans, rot2).

    .. math:: \hat\delta_{rot1} = \delta_{rot1} + \mathcal N(0, \alpha_1\delta_{rot1}^2
                                  + \alpha_2\delta_{trans}^2), \quad
              \hat\delta_{trans} = \delta_{trans} + \mathcal N(0, \alpha_3\delta_{trans}^2
                                  + \alpha_4(\delta_{rot1}^2 + \delta_{rot2}^2))

    and rot2 like rot1. `odometry_control` makes u from two odometer poses.

    Parameters
    ----------
    alpha : 4 numbers >= 0
        alpha_1 dimensionless, alpha_2 in (rad/m)^2, alpha_3 dimensionless, alpha_4 (m/rad)^2.

    Raises
    ------
    ParameterError, ShapeError
        If an alpha is negative or not finite, or there are not four.

    Notes
    -----
    Source: Probabilistic Robotics, Table 5.6 (sampling), Table 5.5 (density). As in the
    book's text, alphas multiply squares and give variances.
    """

    alpha: tuple[float, float, float, float] = (0.01, 0.01, 0.01, 0.01)

    def __post_init__(self) -> None:
        alpha = require_non_negative("alpha", self.alpha)
        if alpha.shape != (4,):
            raise ShapeError(f"alpha must hold 4 numbers, got shape {alpha.shape}")
        object.__setattr__(self, "alpha", tuple(alpha.tolist()))

    def variances(self, u: ArrayLike) -> Array:
        """Variances (3, ...) of rot1, trans and rot2 for a control u (3, ...)."""
        rot1, trans, rot2 = require_components("u", u, 3)
        a1, a2, a3, a4 = self.alpha
        rot1, trans, rot2 = rot1 * rot1, trans * trans, rot2 * rot2
        return np.stack(
            (a1 * rot1 + a2 * trans, a3 * trans + a4 * (rot1 + rot2), a1 * rot2 + a2 * trans)
        )

    def mean(self, pose: Array, u: ArrayLike) -> Array:
        """Noise-free turn, drive, turn: pose (3, ...), u (3,) -> pose (3, ...)."""
        pose = require_components("pose", pose, 3)
        return self._move(pose, *require_components("u", u, 3))

    def sample(self, pose: Array, u: ArrayLike, rng: np.random.Generator) -> Array:
        """Each particle repeats the motion with errors of its own: (3, ...), (3,) -> (3, ...)."""
        pose, u = require_components("pose", pose, 3), require_components("u", u, 3)
        noisy = [
            component + _noise(variance, pose.shape[1:], rng)
            for component, variance in zip(u, self.variances(u), strict=True)
        ]
        return self._move(pose, *noisy)

    @staticmethod
    def _move(pose: Array, rot1: ArrayLike, trans: ArrayLike, rot2: ArrayLike) -> Array:
        x, y, theta = pose
        direction = theta + rot1
        return np.stack(
            (x + trans * np.cos(direction), y + trans * np.sin(direction), wrap(direction + rot2))
        )
