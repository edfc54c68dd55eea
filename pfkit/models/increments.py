r"""Odometry poses as they come: repeat the increment, with noise of a constant size.

Many robots report a pose that their wheels have added up. It drifts, but between two reports it is
nearly right. `increments` turns such poses into motions, each in the frame of the pose before; the
model repeats them with errors that do not depend on the motion,

.. math:: x_t = x_{t-1} \oplus (u + \varepsilon), \qquad
          \varepsilon \sim \mathcal N\big(0, \mathrm{diag}(\sigma_x^2, \sigma_y^2,
          \sigma_\theta^2)\big).

It is the plainest of the motion models. A robot at rest diffuses, too; `OdometryMotion` is the one
that scales its noise with the motion.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import require_array
from pfkit.geometry import between, compose

Array = NDArray[np.float64]


def increments(poses: ArrayLike) -> Array:
    r"""Motions between consecutive poses, the first one zero.

    .. math:: u_k = \ominus x_{k-1} \oplus x_k

    Parameters
    ----------
    poses : array_like (3, T), metres and radians, in any frame

    Returns
    -------
    array (3, T): dx, dy, dtheta in the frame of the pose before

    Raises
    ------
    ShapeError, ParameterError
        If the poses are not (3, T) or not finite.
    """
    poses = require_array("poses", poses, (3, ...))
    return between(np.concatenate((poses[:, :1], poses[:, :-1]), axis=1), poses)


@dataclass(frozen=True)
class IncrementMotion:
    """Repeat u = (dx, dy, dtheta) with constant Gaussian noise.

    Parameters
    ----------
    sigma : (sigma_x, sigma_y, sigma_theta), metres and radians, >= 0
        Standard deviation for each step, along the robot, across it, and of its turn.

    Raises
    ------
    ParameterError, ShapeError
        If a sigma is negative or not finite, or there are not three.
    """

    sigma: tuple[float, float, float] = (0.01, 0.01, 0.01)

    def __post_init__(self) -> None:
        sigma = require_array("sigma", self.sigma, (3,), "finite and >= 0")
        object.__setattr__(self, "sigma", tuple(sigma.tolist()))

    def mean(self, pose: Array, u: ArrayLike) -> Array:
        """Noise-free motion: pose (3, ...), u (3,) -> pose (3, ...)."""
        u, pose = require_array("u", u, (3, ...)), require_array("pose", pose, (3, ...))
        return compose(pose, u[(..., *(None,) * (pose.ndim - u.ndim))])

    def sample(self, pose: Array, u: ArrayLike, rng: np.random.Generator) -> Array:
        """Each particle repeats the motion with errors of its own: (3, ...), (3,) -> (3, ...)."""
        u, pose = require_array("u", u, (3, ...)), require_array("pose", pose, (3, ...))
        u = u[(..., *(None,) * (pose.ndim - u.ndim))]
        sigma = np.reshape(self.sigma, (3, *(1,) * (pose.ndim - 1)))
        return compose(pose, u + sigma * draw_normal(pose.shape, rng))
