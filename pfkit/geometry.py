"""Angles and rigid motions of the plane.

A robot on a floor has a pose: a position (x, y) and a heading theta. Headings live on a
circle, not on a line: 359 degrees and 1 degree are two degrees apart, and their mean is 0,
not 180. Whatever subtracts or averages headings must therefore know about the circle;
`wrap` and `circular_mean` are the two functions that do,
and `resultant_length` says what a mean is worth: of two opposite headings there is none.

A pose is also a rigid motion: "go to (x, y), then turn by theta". Motions compose, and each
has an inverse. That group is called SE(2). Odometry between two instants is the motion
``between(pose0, pose1)``, and a map that is shifted and turned by a motion g moves every
right answer along: ``compose(g, pose)``. The tests lean on that equivariance.

All functions take components first: a pose is ``(3, ...)`` and the rest broadcasts.

A log's truth is NaN where nobody filmed. `wrap` and `between`, with which a truth is compared,
hand that on; `compose` and `inverse`, which move robots, refuse it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array

TWO_PI = 2.0 * np.pi
CANCELLED = 1e-12  # resultant length below which only rounding is left


def wrap(angle: ArrayLike) -> NDArray[np.float64]:
    r"""Map angles to the interval (-pi, pi].

    .. math:: \mathrm{wrap}(a) = a - 2\pi \lceil a / 2\pi - 1/2 \rceil

    Parameters
    ----------
    angle : array_like, any shape, radians

    Returns
    -------
    array of the same shape, radians in (-pi, pi] but for rounding; NaN stays NaN

    Raises
    ------
    ParameterError
        If an angle is not a number, or infinite.

    Examples
    --------
    >>> wrap([0.0, np.pi, -np.pi, 2 * np.pi]).round(6)
    array([0.      , 3.141593, 3.141593, 0.      ])
    """
    return _wrap(require_array("angle", angle, rule="not infinite"))


def _wrap(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """`wrap` without the check, for angles that have been checked already."""
    return angle - TWO_PI * np.ceil(angle / TWO_PI - 0.5)


def compose(pose: ArrayLike, motion: ArrayLike) -> NDArray[np.float64]:
    r"""Carry out a motion that is given in the frame of a pose.

    .. math:: a \oplus b = (a_x + b_x \cos a_\theta - b_y \sin a_\theta,\;
                            a_y + b_x \sin a_\theta + b_y \cos a_\theta,\;
                            \mathrm{wrap}(a_\theta + b_\theta))

    Parameters
    ----------
    pose, motion : array_like (3, ...), metres and radians; trailing axes broadcast

    Returns
    -------
    array (3, ...), the pose after the motion

    Raises
    ------
    ShapeError, ParameterError
        If the first axis of either argument does not have length 3, or a value is not finite.

    Examples
    --------
    >>> compose([1.0, 2.0, np.pi / 2], [3.0, 0.0, 0.0]).round(6)  # three metres ahead
    array([1.      , 5.      , 1.570796])
    """
    return _compose(
        require_array("pose", pose, (3, ...)), require_array("motion", motion, (3, ...))
    )


def _compose(pose: NDArray[np.float64], motion: NDArray[np.float64]) -> NDArray[np.float64]:
    """`compose` without the checks."""
    (x, y, theta), (dx, dy, dtheta) = pose, motion
    c, s = np.cos(theta), np.sin(theta)
    return np.stack((x + c * dx - s * dy, y + s * dx + c * dy, _wrap(theta + dtheta)))


def inverse(pose: ArrayLike) -> NDArray[np.float64]:
    r"""The motion that undoes a pose: ``compose(pose, inverse(pose))`` is the origin.

    Parameters
    ----------
    pose : array_like (3, ...), metres and radians

    Returns
    -------
    array (3, ...)

    Raises
    ------
    ShapeError, ParameterError
        If the first axis does not have length 3, or a value is not finite.
    """
    return _inverse(require_array("pose", pose, (3, ...)))


def _inverse(pose: NDArray[np.float64]) -> NDArray[np.float64]:
    """`inverse` without the checks."""
    x, y, theta = pose
    c, s = np.cos(theta), np.sin(theta)
    return np.stack((-c * x - s * y, s * x - c * y, _wrap(-theta)))


def between(pose0: ArrayLike, pose1: ArrayLike) -> NDArray[np.float64]:
    """The motion from one pose to another, in the frame of the first.

    ``compose(pose0, between(pose0, pose1)) == pose1``.

    Parameters
    ----------
    pose0, pose1 : array_like (3, ...), metres and radians; trailing axes broadcast

    Returns
    -------
    array (3, ...); NaN where a pose is NaN

    Raises
    ------
    ShapeError, ParameterError
        If the first axis of either argument does not have length 3, or a value is infinite.
    """
    first = require_array("pose0", pose0, (3, ...), "not infinite")
    second = require_array("pose1", pose1, (3, ...), "not infinite")
    return _compose(_inverse(first), second)


def circular_mean(theta: ArrayLike, w: ArrayLike | None = None) -> NDArray[np.float64]:
    r"""Weighted mean direction.

    .. math:: \bar\theta = \mathrm{atan2}\Big(\sum_m w_m \sin\theta_m,\;
                                              \sum_m w_m \cos\theta_m\Big)

    Parameters
    ----------
    theta : array_like (..., M), radians
    w : array_like (..., M) or (M,), optional
        Weights; equal if left out. They need not sum to one.

    Returns
    -------
    array (...), radians in (-pi, pi]
        NaN where the directions cancel: no direction is their mean. Where they nearly cancel
        there is one, and it is worth little: `resultant_length` says how much.

    Raises
    ------
    ParameterError, ShapeError
        If an angle or a weight is not finite, there is nothing to average, or the two shapes
        do not belong together.

    Examples
    --------
    >>> round(float(circular_mean(np.radians([350.0, 30.0]))), 6)  # 10 degrees, not 190
    0.174533
    """
    return direction(*_resultant(theta, w))


def resultant_length(theta: ArrayLike, w: ArrayLike | None = None) -> NDArray[np.float64]:
    r"""How far directions agree: the length of their mean vector.

    .. math:: R = \frac{1}{\sum_m w_m} \sqrt{\Big(\sum_m w_m \cos\theta_m\Big)^2
                                            + \Big(\sum_m w_m \sin\theta_m\Big)^2}

    It is 1 if all agree and 0 if they cancel; a normal spread of sigma radians gives
    :math:`e^{-\sigma^2/2}`. Of n independent directions without a common one, R exceeds r with
    probability about :math:`e^{-n r^2}` (Rayleigh's test).

    Parameters
    ----------
    theta : array_like (..., M), radians
    w : array_like (..., M) or (M,), optional
        Weights >= 0; equal if left out. They need not sum to one.

    Returns
    -------
    array (...), between 0 and 1

    Raises
    ------
    ParameterError, ShapeError
        As `circular_mean`.

    Notes
    -----
    Source: K. V. Mardia and P. E. Jupp, Directional Statistics (2000), sections 2.3 and 6.3.

    Examples
    --------
    >>> round(float(resultant_length(np.radians([0.0, 90.0]))), 6)  # half the diagonal
    0.707107
    """
    return np.hypot(*_resultant(theta, w))


def _resultant(
    theta: ArrayLike, w: ArrayLike | None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Weighted mean of sine and cosine over the last axis."""
    theta = require_array("theta", theta, (..., "M"))
    w = 1.0 if w is None else w
    weights = require_array("w", w, theta.shape[theta.ndim - np.ndim(w) :])  # of its last axes
    total = np.sum(np.broadcast_to(weights, theta.shape), axis=-1)
    return (
        np.sum(weights * np.sin(theta), axis=-1) / total,
        np.sum(weights * np.cos(theta), axis=-1) / total,
    )


def direction(sine: NDArray[np.float64], cosine: NDArray[np.float64]) -> NDArray[np.float64]:
    """Direction of a mean vector; NaN where nothing but rounding is left of it."""
    return np.where(np.hypot(sine, cosine) > CANCELLED, np.arctan2(sine, cosine), np.nan)[()]
