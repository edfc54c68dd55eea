r"""Wheel encoders: from counted turns to a pose, and from a square back to the wheels.

An encoder counts how far a wheel has turned, not how far the robot has come. The way from the one
to the other leads through three lengths: the two radii and the axle between them. For a row of
counts that turn the wheels by :math:`a_l` and :math:`a_r` radians,

.. math:: d = \tfrac12 (r_r a_r + r_l a_l), \qquad \phi = \frac{r_r a_r - r_l a_l}{L},

and the robot drives the arc of d and :math:`\phi`. A length that is wrong by a little errs the same
way in every row, so it cannot be averaged away. It can be measured. Let the robot drive a square
that it believes to be closed, and see where it really stands. An axle that is too short in the
books spoils the four turns, wheels of unequal size bend the four sides. Driven in one direction the
two look alike; driven in both, one keeps its sign and the other changes it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, require_array, require_fields, require_number
from pfkit.geometry import compose, wrap
from pfkit.logs.least_squares import least_squares, slopes

Array = NDArray[np.float64]
ORIGIN = (0.0, 0.0, 0.0)
ALIKE = 20.0  # condition number beyond which drives do not tell two errors apart


@dataclass(frozen=True)
class WheelGeometry:
    """What turns of two wheels mean in metres and radians.

    Parameters
    ----------
    r_l, r_r : float, metres, > 0
        Radii of the left and the right wheel.
    L : float, metres, > 0
        Length of the axle, from wheel to wheel.

    Raises
    ------
    ParameterError
        If a length is not positive.
    """

    r_l: float
    r_r: float
    L: float

    def __post_init__(self) -> None:
        require_fields(self, r_l="finite and > 0", r_r="finite and > 0", L="finite and > 0")

    def arcs(self, turns: ArrayLike) -> tuple[Array, Array]:
        """Distance (m) and turn (rad) of the body for turns (2, ...) of left and right wheel."""
        left, right = require_array("turns", turns, (2, "T", ...))
        left, right = self.r_l * left, self.r_r * right
        return (left + right) / 2, (right - left) / self.L


def encoder_odometry(turns: ArrayLike, wheels: WheelGeometry, start: ArrayLike = ORIGIN) -> Array:
    """Dead reckoning by encoders: where the wheels say that the robot is.

    Parameters
    ----------
    turns : array_like (2, T, ...), radians
        What the left and the right wheel turned in each row.
    wheels : WheelGeometry
    start : array_like (3,) or (3, 1, ...)

    Returns
    -------
    array (3, T, ...), the pose after each row, each row an exact arc

    Raises
    ------
    ShapeError, ParameterError
        If there are not two wheels, or a number is not finite.
    """
    distance, turn = wheels.arcs(turns)
    heading = np.cumsum(turn, axis=0)
    direction = heading - turn / 2
    chord = distance * np.sinc(turn / (2 * np.pi))
    x, y = (np.cumsum(chord * f(direction), axis=0) for f in (np.cos, np.sin))
    path = np.stack((x, y, wrap(heading)))
    start = require_array("start", start, (3, ...))
    return compose(start.reshape(3, *(start.shape[1:] or (1,) * turn.ndim)), path)


def square_turns(
    side: float, wheels: WheelGeometry, clockwise: bool = False, rows: int = 20
) -> Array:
    """Turns of the wheels for a square that brings a robot with these wheels home.

    Parameters
    ----------
    side : float, metres, > 0
    wheels : WheelGeometry
    clockwise : bool
        The way round; the first side leads straight ahead in both.
    rows : int, of each side and of each quarter turn on the spot

    Returns
    -------
    array (2, 8 * rows), radians: side, quarter turn, side, ... and a last quarter turn

    Raises
    ------
    ParameterError
        If the side is not positive.
    """
    require_number("side", side, "finite and > 0")
    rim = (-1 if clockwise else 1) * np.pi / 4 * wheels.L
    once = np.array(((side, -rim), (side, rim))) / rows
    return np.tile(np.repeat(once, rows, axis=1), 4) / np.array(((wheels.r_l,), (wheels.r_r,)))


def calibrate_wheels(
    drives: Sequence[ArrayLike], ends: ArrayLike, wheels: WheelGeometry
) -> WheelGeometry:
    r"""Find the axle, and which wheel is larger, from where some drives really ended.

    .. math:: \min_{e, k} \sum_i \big\| p_i - \hat p_i\big(r (1 - \tfrac e2),
              r (1 + \tfrac e2), k L\big) \big\|^2

    with the measured end :math:`p_i` of drive i, the end :math:`\hat p_i` that its encoders give,
    and r the mean of the radii that `wheels` has.

    Parameters
    ----------
    drives : sequence of array_like (2, T), radians
        Turns of the wheels of each drive, such as squares in both directions.
    ends : array_like (2, n), metres
        Where each drive ended, as seen from its start: ahead and to the left.
    wheels : WheelGeometry
        What the books say. Their mean radius is kept: no closed path can see it, since larger
        wheels on a longer axle drive a larger square that closes as well. Measure it on a straight
        line, as distance over turns.

    Returns
    -------
    WheelGeometry

    Raises
    ------
    ShapeError
        If there is not one end for each drive.
    DataError
        If the drives cannot tell the two errors apart, such as squares in one direction only.

    Notes
    -----
    Source: the two errors, and the square in both directions, are the UMBmark test of J. Borenstein
    and L. Feng (IEEE Transactions on Robotics and Automation 12(6), 1996), which solves for
    them to first order.
    """
    ends = require_array("ends", ends, (2, len(drives)))
    r = (wheels.r_l + wheels.r_r) / 2

    def believed(p: Array) -> WheelGeometry:
        e, k = p.tolist()
        return WheelGeometry(r * (1 - e / 2), r * (1 + e / 2), k * wheels.L)

    def error(p: Array) -> Array:
        reached = [encoder_odometry(turns, believed(p))[:2, -1] for turns in drives]
        return (np.stack(reached, axis=1) - ends).ravel()

    as_written = np.array((0.0, 1.0))
    condition = np.linalg.cond(slopes(error, as_written))
    if not condition < ALIKE:
        raise DataError(
            "an uneven pair of wheels and a wrong axle look alike in these drives (condition "
            f"number {condition:.3g}); drive a square in both directions"
        )
    return believed(least_squares(error, as_written))
