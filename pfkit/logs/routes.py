r"""Routes: what to tell the robot so that it goes where we want.

Two ways to drive. *Open loop*: a list of commands, carried out without looking. Errors
accumulate, so a long list of commands ends anywhere. *Closed loop*: a driver looks where the
robot is and steers back to the route. `PurePursuit` chases a carrot that runs ahead of the
robot on a line through way-points. With the carrot at distance l and an angle alpha off the
nose, the circle that starts along the nose and passes through the carrot has curvature

.. math:: \kappa = \frac{2 \sin\alpha}{l} .

The driver of a simulation may look at the truth. A filter may not: it gets only the commands
that the driver gave, and the robot carried those out imperfectly.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import ParameterError, require_array, require_fields, require_number
from pfkit.geometry import wrap

Array = NDArray[np.float64]


def commands(segments: Iterable[tuple[float, float, float]], dt: float) -> Array:
    """Cut a list of commands into steps of dt; the last step of a command may be shorter.

    Parameters
    ----------
    segments : iterable of (v, omega, seconds), m/s, rad/s, s
    dt : float, > 0, seconds

    Returns
    -------
    u : array (3, T), columns (v, omega, dt), for `VelocityMotion`

    Raises
    ------
    ParameterError, ShapeError
        If a number is not finite, a duration is negative, or a command has not three numbers.
    """
    dt = require_number("dt", dt, "finite and > 0")
    columns: list[Array] = []
    for segment in segments:
        v, omega, seconds = require_array("a command (v, omega, seconds)", segment, (3,))
        if seconds < 0:
            raise ParameterError(f"a command must last >= 0 s, got {seconds}; swap its end points")
        whole = int(seconds / dt + 1e-9)
        rest = seconds - whole * dt
        steps = np.full(whole + (rest > 1e-9 * dt), float(dt))
        if steps.size > whole:
            steps[-1] = rest
        columns.append(np.stack((np.full_like(steps, v), np.full_like(steps, omega), steps)))
    return np.concatenate(columns, axis=1) if columns else np.empty((3, 0))


@dataclass(frozen=True)
class PurePursuit:
    r"""A driver that follows way-points: ``u = driver(k, pose)``.

    .. math:: \omega = v\,\frac{2 \sin\alpha}{l}

    Parameters
    ----------
    points : array_like (2, P), metres, P >= 2
    v : float, > 0, m/s
    dt : float, > 0, seconds
    lookahead : float, > 0, metres
        How far ahead the carrot runs; corners are cut by about as much.
    closed : bool
        Return to the first point and go round again; else stop at the last point.
    omega_max : float, > 0, rad/s

    Raises
    ------
    ParameterError, ShapeError
        If there are fewer than two different points or a number is not positive.

    Notes
    -----
    Source: R. C. Coulter, Carnegie Mellon report CMU-RI-TR-92-01 (1992).
    """

    points: Array
    v: float
    dt: float
    lookahead: float = 0.5
    closed: bool = True
    omega_max: float = 2.0
    _knots: Array = field(init=False, repr=False)
    _s: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        points = require_array("points", self.points, (2, "P"))
        require_fields(
            self,
            v="finite and > 0",
            dt="finite and > 0",
            lookahead="finite and > 0",
            omega_max="finite and > 0",
        )
        knots = np.append(points, points[:, :1], axis=1) if self.closed else points
        lengths = np.hypot(*np.diff(knots, axis=1))
        if lengths.size == 0 or not (lengths > 0).all():
            raise ParameterError(f"way-points must differ from their neighbours: {points.T}")
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "_knots", knots)
        object.__setattr__(self, "_s", np.append(0.0, np.cumsum(lengths)))

    def __call__(self, k: int, pose: Array) -> Array:
        """Control (3, ...) for a robot at pose (3, ...): v, omega, dt."""
        pose = require_array("pose", pose, (3, ...))
        s, length = self._progress(pose[:2]), self._s[-1]
        goal = (
            (s + self.lookahead) % length if self.closed else np.minimum(s + self.lookahead, length)
        )
        dx, dy = self._at(goal) - pose[:2]
        alpha = wrap(np.arctan2(dy, dx) - pose[2])
        # a carrot behind the robot asks for the sharpest turn, not for none
        bend = np.where(np.abs(alpha) > np.pi / 2, np.sign(alpha), np.sin(alpha))
        distance = np.maximum(np.sqrt(dx * dx + dy * dy), 1e-3 * self.lookahead)
        omega = np.clip(2 * self.v * bend / distance, -self.omega_max, self.omega_max)
        driving = np.ones_like(s, dtype=bool) if self.closed else s < length
        return np.stack((self.v * driving, omega * driving, np.full_like(omega, self.dt)))

    def _at(self, s: Array) -> Array:
        """Points (2, ...) at distances s (...) along the route."""
        return np.stack([np.interp(s, self._s, xs) for xs in self._knots])

    def _progress(self, position: Array) -> Array:
        """Distance along the route (...) of its point nearest to a position (2, ...)."""
        knots, s = self._knots, self._s
        column = (slice(None), slice(None), *(None,) * (position.ndim - 1))
        start, step = knots[:, :-1][column], np.diff(knots, axis=1)[column]
        share = np.sum((position[:, None] - start) * step, axis=0) / np.sum(step * step, axis=0)
        share = np.clip(share, 0.0, 1.0)
        miss = np.sum((start + share * step - position[:, None]) ** 2, axis=0)
        nearest = np.argmin(miss, axis=0)
        share = np.take_along_axis(share, nearest[None], axis=0)[0]
        return s[nearest] + share * np.diff(s)[nearest]
