r"""Motion models of a point target: how wrong may a model be and still be useful?

A ball crosses an image. Four models explain its motion, each with one idea more:

====================  =============  =====================================================
model                 state          mean motion in one step, u = (v, omega, dt)
====================  =============  =====================================================
`FixedTarget`         (x, y, ...)    none
`HeadingTarget`       (x, y)         v dt (cos theta0, sin theta0), theta0 given beforehand
`LineTarget`          (x, y, theta)  v dt (cos theta, sin theta), theta estimated
`CircleTarget`        (x, y, theta)  as the line, and theta grows by omega dt
====================  =============  =====================================================

All read the same control u = (v, omega, dt) and ignore what they have no idea of, so that one
model can replace another in the same filter. All add independent Gaussian noise to the state:
sd ``sigma`` per component of the position and step, sd ``sigma_theta`` on the heading. That
noise is what lets a wrong model follow: it buys forgiveness with precision.

Units are those of the data: pixels and frames in the labs, metres and seconds elsewhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import require_array, require_fields
from pfkit.geometry import wrap

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FixedTarget:
    r"""The target does not move: a random walk, :math:`x_t = x_{t-1} + \epsilon`.

    Parameters
    ----------
    sigma : float, pixels (or metres), >= 0
        Standard deviation of the noise of each position component in one step.
    sigma_theta : float, radians, >= 0
        The same for the heading, where the state has one.

    Raises
    ------
    ParameterError
        If a standard deviation is negative.
    """

    sigma: float
    sigma_theta: float = 0.0

    def __post_init__(self) -> None:
        require_fields(self, sigma="finite and >= 0", sigma_theta="finite and >= 0")

    def mean(self, state: ArrayLike, u: ArrayLike) -> Array:
        """Where the state (D, ...) goes without noise under u = (v, omega, dt)."""
        return np.array(state, dtype=float)

    def sample(self, state: ArrayLike, u: ArrayLike, rng: np.random.Generator) -> Array:
        """One noisy step of every state (D, ...): fresh noise for each particle."""
        moved = self.mean(state, u)
        moved[:2] += self.sigma * draw_normal((2, *moved.shape[1:]), rng)
        if len(moved) > 2:
            noise = self.sigma_theta * draw_normal(moved.shape[1:], rng)
            moved[2] = wrap(moved[2] + noise)
        return moved


def _ahead(state: ArrayLike, theta: float | Array, u: ArrayLike) -> Array:
    """Positions moved by v dt along theta; the rest of the state unchanged."""
    v, _, dt = np.asarray(u, dtype=float)
    moved = np.array(state, dtype=float)
    moved[0] += v * dt * np.cos(theta)
    moved[1] += v * dt * np.sin(theta)
    return moved


@dataclass(frozen=True, kw_only=True)
class HeadingTarget(FixedTarget):
    r"""A line whose heading theta0 is known beforehand and never questioned.

    .. math:: x_t = x_{t-1} + v\,dt\,(\cos\theta_0, \sin\theta_0) + \epsilon

    Parameters
    ----------
    sigma : float, pixels, >= 0
    heading : float, radians
    """

    heading: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        require_fields(self, heading="finite")

    def mean(self, state: ArrayLike, u: ArrayLike) -> Array:
        return _ahead(state, self.heading, u)


@dataclass(frozen=True)
class LineTarget(FixedTarget):
    r"""A line whose heading is part of the state, so that the filter can learn it.

    .. math:: (x, y)_t = (x, y)_{t-1} + v\,dt\,(\cos\theta, \sin\theta) + \epsilon,
              \qquad \theta_t = \theta_{t-1} + \epsilon_\theta
    """

    def mean(self, state: ArrayLike, u: ArrayLike) -> Array:
        state = require_array("state", state, (3, ...))
        return _ahead(state, state[2], u)


@dataclass(frozen=True)
class CircleTarget(FixedTarget):
    r"""A circle of radius v/omega: the line model, and the heading turns.

    .. math:: \theta_t = \mathrm{wrap}(\theta_{t-1} + \omega\,dt + \epsilon_\theta)

    Speed v and rate omega are given in u. Centre and phase of the circle are free: they
    follow from the state.
    """

    def mean(self, state: ArrayLike, u: ArrayLike) -> Array:
        state = require_array("state", state, (3, ...))
        moved = _ahead(state, state[2], u)
        _, omega, dt = np.asarray(u, dtype=float)
        moved[2] = wrap(moved[2] + omega * dt)
        return moved
