r"""Motion models: where a control takes the robot, and how badly.

A motion model is the density :math:`p(x_t \mid u_t, x_{t-1})`. A particle filter never
evaluates it; it only *samples*: each particle carries out the control with errors of its own.
Draw the errors anew for each particle and each step. One common error for the whole cloud would
move it rigidly and its spread would never grow.

Where the errors enter matters as much as how large they are. Noise added to the pose makes
a round blob. Noise in the control, a slightly wrong speed and a slightly wrong turn, bends
the cloud into the banana that wheeled robots really leave.

Between two instants a robot with constant speed v and turn rate omega drives an exact arc.
Its chord has length :math:`v\,\Delta t\,\mathrm{sinc}(\omega\Delta t/2)` and points in the
direction :math:`\theta + \omega\Delta t/2`. Written so, the straight line is simply the arc
with omega = 0, and nothing is divided by zero.

Every model has ``mean(pose, u)``, which is noise-free, and ``sample(pose, u, rng)``. Both
take one pose ``(3,)``, a cloud ``(3, M)`` or a batch ``(3, B, M)``. Where three errors enter,
the model has a density too, ``log_density(pose1, u, pose0)``: the errors that would explain the
move, and the Jacobian from errors to poses, without which it would not integrate to one.

Here are the parts that all models share, and the textbook's velocity model. `odometry_motion`
holds its rival, and `wheels` the models of two common vehicles.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import ParameterError, require_array
from pfkit.geometry import _wrap, between, wrap

Array = NDArray[np.float64]


class MotionModel(Protocol):
    """What a filter needs of a motion model; a class of your own drops in."""

    def mean(self, pose: Array, u: Array) -> Array:
        """Where the control would take the robot without noise: (3, ...), (n,) -> (3, ...)."""

    def sample(self, pose: Array, u: Array, rng: np.random.Generator) -> Array:
        """Where each particle goes, with errors of its own: (3, ...), (n,) -> (3, ...)."""


def draw_noise(variance: ArrayLike, shape: tuple[int, ...], rng: np.random.Generator) -> Array:
    """Zero-mean Gaussian noise of a given variance: one number for each entry of the shape."""
    return np.sqrt(variance) * draw_normal(shape, rng)


def log_noise(error: Array, variance: Array) -> Array:
    """Log density of that noise; a variance of 0 has none."""
    if not np.all(np.asarray(variance) > 0):
        raise ParameterError(
            "the motion has no density where a variance is 0: the particles lie on a line or a "
            "surface; give every alpha a value > 0 and let the robot move"
        )
    return -0.5 * (error * error / variance + np.log(2 * np.pi * variance))


def drive_arc(pose: Array, distance: ArrayLike, turn: ArrayLike) -> Array:
    r"""Follow an arc of a given length while the heading turns by a given angle.

    .. math:: x' &= x + d\,\mathrm{sinc}(\tfrac{\phi}{2}) \cos(\theta + \tfrac{\phi}{2}) \\
              y' &= y + d\,\mathrm{sinc}(\tfrac{\phi}{2}) \sin(\theta + \tfrac{\phi}{2}) \\
              \theta' &= \mathrm{wrap}(\theta + \phi)

    Parameters
    ----------
    pose : array (3, ...), metres and radians
    distance : array_like, metres along the arc; negative drives backwards
    turn : array_like, radians

    Returns
    -------
    array (3, ...), the pose at the end of the arc

    Raises
    ------
    ShapeError, ParameterError
        If the pose does not have three components, or a value is not finite.

    Notes
    -----
    Source: Probabilistic Robotics, eq. 5.9, with its division by omega removed.
    """
    pose, distance = require_array("pose", pose, (3, ...)), require_array("distance", distance)
    return _arc(pose, distance, require_array("turn", turn))


def _arc(pose: Array, distance: Array, turn: Array) -> Array:
    """`drive_arc` without the checks, for numbers that have been checked already."""
    x, y, theta = pose
    half = 0.5 * turn
    safe = (
        half if np.count_nonzero(half) == half.size else np.where(half == 0, 1e-20, half)
    )  # sin(h) / h -> 1
    chord = distance * (np.sin(safe) / safe)
    direction = theta + half
    end = np.empty((3, *np.broadcast(x, chord).shape))
    end[0] = x + chord * np.cos(direction)
    end[1] = y + chord * np.sin(direction)
    end[2] = _wrap(direction + half)
    return end


def inverse_arc(pose0: ArrayLike, pose1: ArrayLike, backwards: bool = False) -> Array:
    r"""The arc that leads from one pose to the place of another, and the turn still missing there.

    The chord has the length c and the direction :math:`\beta` as seen from the nose. An arc bends
    away from its tangent by half of its turn, so

    .. math:: \phi = 2 \beta, \qquad d = c \,/\, \mathrm{sinc}(\tfrac{\phi}{2}), \qquad
              \phi' = \mathrm{wrap}(\theta_1 - \theta_0 - \phi).

    Parameters
    ----------
    pose0, pose1 : array_like (3, ...), metres and radians, before and after; they broadcast
    backwards : bool
        Take the arc that drives in reverse: the chord is then seen from the robot's tail, and
        the distance is negative.

    Returns
    -------
    array (3, ...): distance d (m), turn phi (rad, at most a full one), extra turn phi' (rad).
    ``drive_arc(pose0, d, phi)``, turned by phi' more, is pose1. A robot that stays where it is
    drives no arc: its d is 0, and all of its turn is extra (forwards). NaN where a pose is NaN.

    Raises
    ------
    ShapeError, ParameterError
        If a pose does not have three components, or a value is infinite.

    Notes
    -----
    Source: Probabilistic Robotics, Table 5.1, lines 2 to 9, by the chord in place of the circle's
    centre, which lies at infinity when the robot drives straight.
    """
    dx, dy, turn = between(pose0, pose1)
    sign = -1.0 if backwards else 1.0
    chord, beta = np.hypot(dx, dy), np.arctan2(sign * dy, sign * dx)
    return np.stack((sign * chord / np.sinc(beta / np.pi), 2.0 * beta, wrap(turn - 2.0 * beta)))


@dataclass(frozen=True)
class VelocityMotion:
    r"""Drive with a commanded speed and turn rate for a time: u = (v, omega, dt).

    .. math:: \hat v &= v + \mathcal N(0, \alpha_1 v^2 + \alpha_2 \omega^2) \\
              \hat\omega &= \omega + \mathcal N(0, \alpha_3 v^2 + \alpha_4 \omega^2) \\
              \hat\gamma &= \mathcal N(0, \alpha_5 v^2 + \alpha_6 \omega^2)

    The robot then follows the exact arc of :math:`(\hat v, \hat\omega)` and turns by
    :math:`\hat\gamma\,\Delta t` more, without which all headings would lie on a line.

    Parameters
    ----------
    alpha : 4 or 6 numbers >= 0
        Noise per motion, as variances: alpha_1 is dimensionless, alpha_2 in (m/rad)^2,
        alpha_3 in (rad/m)^2, alpha_4 dimensionless, alpha_5 and alpha_6 as these two. With
        four, gamma is left out.

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
        n = 6 if np.size(self.alpha) == 6 else 4
        alpha = require_array("alpha", self.alpha, (n,), "finite and >= 0")
        object.__setattr__(self, "alpha", (*alpha.tolist(), 0.0, 0.0)[:6])

    def variances(self, u: ArrayLike) -> Array:
        """Variances (3, ...) of v, omega and gamma for a control u (3, ...)."""
        v, omega, _ = np.asarray(u, dtype=float)
        a1, a2, a3, a4, a5, a6 = self.alpha
        v2, omega2 = v * v, omega * omega
        return np.array((a1 * v2 + a2 * omega2, a3 * v2 + a4 * omega2, a5 * v2 + a6 * omega2))

    def mean(self, pose: Array, u: ArrayLike) -> Array:
        """Noise-free arc: pose (3, ...), u (3,) -> pose (3, ...)."""
        v, omega, dt = np.asarray(u, dtype=float)
        return drive_arc(pose, v * dt, omega * dt)

    def sample(self, pose: Array, u: ArrayLike, rng: np.random.Generator) -> Array:
        """Each particle drives with errors of its own: (3, ...), (3,) -> (3, ...)."""
        pose, u = require_array("pose", pose, (3, ...)), require_array("u", u, (3, ...))
        v, omega, dt = u
        var_v, var_omega, var_gamma = self.variances(u)
        shape = np.broadcast(pose[0], v).shape
        v_hat = v + draw_noise(var_v, shape, rng)
        omega_hat = omega + draw_noise(var_omega, shape, rng)
        moved = _arc(pose, v_hat * dt, omega_hat * dt)
        if self.alpha[4] or self.alpha[5]:
            moved[2] = wrap(moved[2] + dt * draw_noise(var_gamma, shape, rng))
        return moved

    def log_density(self, pose1: Array, u: ArrayLike, pose0: Array) -> Array:
        r"""Log of the density of a move, in 1 / (square metre and radian).

        One arc forwards and one backwards explain a move (`inverse_arc`). Each gives the
        errors of v, omega and gamma, and

        .. math:: dx\,dy\,d\theta = \tfrac12\, c\, |\mathrm{sinc}(\tfrac{\phi}{2})|\,
                  \Delta t^3\; d\hat v\, d\hat\omega\, d\hat\gamma

        with the chord c and the turn :math:`\phi` of that arc.

        Parameters
        ----------
        pose1, pose0 : array (3, ...), metres and radians, after and before; they broadcast
        u : array_like (3, ...)

        Returns
        -------
        array (...)

        Raises
        ------
        ParameterError
            If alpha_5 and alpha_6 are 0 (all headings lie on a surface), or the robot stands.

        Notes
        -----
        Source: Probabilistic Robotics, Table 5.1, which leaves the Jacobian out. Arcs of more
        than a full turn in one step are not counted. The density has a pole at c = 0.
        """
        v, omega, dt = np.asarray(u, dtype=float)
        require_array("dt", dt, rule="finite and > 0")
        var_v, var_omega, var_gamma = self.variances(u)
        branches = []
        for backwards in (False, True):
            distance, turn, extra = inverse_arc(pose0, pose1, backwards)
            bend = np.sinc(turn / (2 * np.pi))
            with np.errstate(divide="ignore"):  # the pole
                log_jacobian = np.log(0.5 * np.abs(distance) * bend**2 * dt**3)
            branches.append(
                log_noise(distance / dt - v, var_v)
                + log_noise(turn / dt - omega, var_omega)
                + log_noise(extra / dt, var_gamma)
                - log_jacobian
            )
        return np.logaddexp(*branches)
