r"""The odometry motion model: believe the wheels' own bookkeeping.

A robot that counts its wheels' turns keeps a running guess of its pose. That guess drifts
without bound, but over one step it is far better than the commands were: it knows of the slow
start and of the bump. So we take from it only the *change*, and describe the change by three
numbers: turn towards the goal, drive straight, turn to the final heading. Each of the three
gets an error of its own, which grows with the motion. A robot at rest gets none.

Strictly, odometry is a measurement. The model uses it as a control, which costs nothing and
saves the velocities from being part of the state.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array
from pfkit.geometry import between, wrap
from pfkit.models.motion import draw_noise, log_noise

Array = NDArray[np.float64]


def odometry_control(pose0: ArrayLike, pose1: ArrayLike) -> Array:
    r"""What the odometer saw between two of its poses: turn, drive, turn.

    .. math:: \delta_{rot1} &= \mathrm{atan2}(\Delta y, \Delta x) - \theta_0 \\
              \delta_{trans} &= \sqrt{\Delta x^2 + \Delta y^2} \\
              \delta_{rot2} &= \theta_1 - \theta_0 - \delta_{rot1}

    Parameters
    ----------
    pose0, pose1 : array_like (3, ...), odometry poses, metres and radians

    Returns
    -------
    u : array (3, ...): rot1 (rad), trans (m), rot2 (rad). A robot that turned on the spot has
        no direction of travel; then rot1 is 0 and rot2 takes the whole turn. NaN
        where a pose is NaN.

    Notes
    -----
    Source: Probabilistic Robotics, Table 5.6, lines 2 to 4. The book's trans is never negative:
    a robot in reverse seems to make two half turns, and gets the noise of two half turns.
    """
    dx, dy, turn = between(pose0, pose1)
    trans = np.hypot(dx, dy)
    rot1 = np.where(trans == 0, 0.0, np.arctan2(dy, dx))
    return np.stack((rot1, trans, wrap(turn - rot1)))


@dataclass(frozen=True)
class OdometryMotion:
    r"""Repeat what the odometer saw, turn - drive - turn: u = (rot1, trans, rot2).

    .. math:: \hat\delta_{rot1} &= \delta_{rot1} + \mathcal N(0, \alpha_1\delta_{rot1}^2
                                  + \alpha_2\delta_{trans}^2) \\
              \hat\delta_{trans} &= \delta_{trans} + \mathcal N(0, \alpha_3\delta_{trans}^2
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
        alpha = require_array("alpha", self.alpha, (4,), "finite and >= 0")
        object.__setattr__(self, "alpha", tuple(alpha.tolist()))

    def variances(self, u: ArrayLike) -> Array:
        """Variances (3, ...) of rot1, trans and rot2 for a control u (3, ...)."""
        rot1, trans, rot2 = np.asarray(u, dtype=float)
        a1, a2, a3, a4 = self.alpha
        rot1, trans, rot2 = rot1 * rot1, trans * trans, rot2 * rot2
        return np.stack(
            (a1 * rot1 + a2 * trans, a3 * trans + a4 * (rot1 + rot2), a1 * rot2 + a2 * trans)
        )

    def mean(self, pose: Array, u: ArrayLike) -> Array:
        """Noise-free turn, drive, turn: pose (3, ...), u (3,) -> pose (3, ...)."""
        return self._move(require_array("pose", pose, (3, ...)), *require_array("u", u, (3, ...)))

    def sample(self, pose: Array, u: ArrayLike, rng: np.random.Generator) -> Array:
        """Each particle repeats the motion with errors of its own: (3, ...), (3,) -> (3, ...)."""
        pose, u = require_array("pose", pose, (3, ...)), require_array("u", u, (3, ...))
        shape = np.broadcast_shapes(pose.shape[1:], u.shape[1:])
        noisy = [
            component + draw_noise(variance, shape, rng)
            for component, variance in zip(u, self.variances(u), strict=True)
        ]
        return self._move(pose, *noisy)

    def log_density(self, pose1: Array, u: ArrayLike, pose0: Array) -> Array:
        r"""Log of the density of a move, in 1 / (square metre and radian).

        Two moves explain a displacement: turn to it and drive, or turn away and back up. Each
        gives three errors, and :math:`dx\,dy\,d\theta = |\delta_{trans}|\,
        d\delta_{rot1}\, d\delta_{trans}\, d\delta_{rot2}`.

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
            If a variance is 0: the robot stands, or an alpha is 0.

        Notes
        -----
        Source: Probabilistic Robotics, Table 5.5, which leaves the Jacobian and the second
        move out. The density has a pole where the robot ends up where it was.
        """
        u = np.asarray(u, dtype=float)
        var1, var_t, var2 = self.variances(u)
        _, _, turn = between(pose0, pose1)
        first, distance, _ = odometry_control(pose0, pose1)
        branches = []
        for rot1, trans in ((first, distance), (first + np.pi, -distance)):
            branches.append(
                log_noise(wrap(rot1 - u[0]), var1)
                + log_noise(trans - u[1], var_t)
                + log_noise(wrap(turn - rot1 - u[2]), var2)
            )
        with np.errstate(divide="ignore"):  # the pole
            return np.logaddexp(*branches) - np.log(distance)

    @staticmethod
    def _move(pose: Array, rot1: Array, trans: Array, rot2: Array) -> Array:
        x, y, theta = pose
        direction = theta + rot1
        end = np.empty((3, *np.broadcast_shapes(np.shape(direction), np.shape(trans))))
        end[0] = x + trans * np.cos(direction)
        end[1] = y + trans * np.sin(direction)
        end[2] = wrap(direction + rot2)
        return end
