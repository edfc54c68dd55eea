r"""Kalman's filter: the Bayes filter of a linear world, exactly.

Say that the belief is one Gaussian, and it is two small arrays, a mean and a covariance. If
motion and sensor are linear with Gaussian noise, it *stays* Gaussian, and the integrals of the
Bayes filter become a few products of matrices:

.. math:: \bar\mu = F\mu + s, \quad \bar\Sigma = F \Sigma F^T + \Sigma_u; \qquad
          \mu = \bar\mu + K\nu, \quad \Sigma = \bar\Sigma - K S K^T .

The innovation :math:`\nu` is what the measurement adds to what we expected, S its covariance,
and the gain K shares out how much of it to believe. Nothing is approximated. So this filter is
the rival to beat where the world is nearly linear, and an oracle where it is exactly so: its
evidence :math:`\mathcal N(\nu; 0, S)` is the true one.

A *gate* rejects measurements too far from what was expected. It guards a good belief against
outliers, and guards a bad one against the truth.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array, require_covariance, require_number
from pfkit.geometry import wrap

Array = NDArray[np.float64]


def wrap_rows(value: Array, angles: tuple[int, ...]) -> Array:
    """Wrap the rows of a fresh array that are angles, in place."""
    for row in angles:
        value[row] = wrap(value[row])
    return value


def angles_of(state: Array) -> tuple[int, ...]:
    """Which rows of a state are angles: the heading, if there are three rows or more."""
    return (2,) if state.shape[0] >= 3 else ()


@dataclass(frozen=True)
class Gaussian:
    """A belief as a mean and a covariance.

    Parameters
    ----------
    mean : array_like (D,); of a pose: metres and radians
    Sigma : array_like (D, D) covariance, or (D,) standard deviations, which may be 0

    Raises
    ------
    ShapeError, ParameterError
        If the two do not match, or Sigma is not symmetric with eigenvalues >= 0.
    """

    mean: Array
    Sigma: Array

    def __post_init__(self) -> None:
        mean = require_array("mean", self.mean, ("D",))
        object.__setattr__(self, "mean", mean)
        object.__setattr__(self, "Sigma", require_covariance("Sigma", self.Sigma, mean.size))


def kalman_predict(
    bel: Gaussian, F: ArrayLike, Sigma_u: ArrayLike, shift: ArrayLike = 0.0
) -> Gaussian:
    r"""Linear motion, exactly: :math:`x_t = F x_{t-1} + s + \mathcal N(0, \Sigma_u)`.

    .. math:: \bar\mu = F \mu + s, \qquad \bar\Sigma = F \Sigma F^T + \Sigma_u

    Parameters
    ----------
    bel : Gaussian
    F : array_like (D, D)
    Sigma_u : array_like (D, D), covariance of the motion noise
    shift : array_like (D,), what the control adds

    Returns
    -------
    Gaussian

    Raises
    ------
    ShapeError, ParameterError
        If shapes do not match, a number is not finite, or Sigma_u is not a covariance.

    Notes
    -----
    Source: Probabilistic Robotics, Table 3.1, lines 2 and 3.
    """
    D = bel.mean.size
    F, Sigma_u = np.asarray(F), require_covariance("Sigma_u", Sigma_u, D)
    return Gaussian(F @ bel.mean + np.asarray(shift), F @ bel.Sigma @ F.T + Sigma_u)


def kalman_update(
    bel: Gaussian, z: ArrayLike, H: ArrayLike, Sigma_z: ArrayLike, gate: float = math.inf
) -> tuple[Gaussian, float, bool]:
    r"""Linear measurement, exactly: :math:`z = H x + \mathcal N(0, \Sigma_z)`.

    .. math:: S &= H \Sigma H^T + \Sigma_z, & K &= \Sigma H^T S^{-1}, \\
              \mu' &= \mu + K (z - H\mu), \qquad & \Sigma' &= \Sigma - K S K^T

    Parameters
    ----------
    bel : Gaussian
    z : array_like (n,)
    H : array_like (n, D)
    Sigma_z : array_like (n, n), covariance of the measurement noise
    gate : float
        Reject z if :math:`\nu^T S^{-1} \nu` exceeds it. For n = 2 an honest measurement passes
        9.21 with probability .99; for n = 1 it is 6.63.

    Returns
    -------
    Gaussian
    log_evidence : float, log N(z; H mu, S); 0 if z was rejected
    rejected : bool

    Raises
    ------
    ShapeError, ParameterError
        If shapes do not match, a number is not finite, Sigma_z is not a covariance or leaves
        S singular, or the gate is not positive.

    Notes
    -----
    Source: Probabilistic Robotics, Table 3.1, lines 4 to 6.
    """
    gate = require_number("gate", gate, "> 0")
    z = require_array("z", z, ("n",))
    H = require_array("H", H, (z.size, bel.mean.size))
    Sigma_z = require_covariance("Sigma_z", Sigma_z, z.size)
    cross = bel.Sigma @ H.T
    return condition(bel, z - H @ bel.mean, H @ cross + Sigma_z, cross, gate)


def condition(
    bel: Gaussian, innovation: Array, S: Array, cross: Array, gate: float
) -> tuple[Gaussian, float, bool]:
    r"""Condition a Gaussian on a measurement, whatever gave its moments.

    .. math:: K = C S^{-1}, \qquad \mu' = \mu + K\nu, \qquad \Sigma' = \Sigma - K S K^T

    Parameters
    ----------
    bel : Gaussian
    innovation : array (n,), measured minus expected
    S : array (n, n), covariance of the innovation
    cross : array (D, n), covariance C of state and measurement
    gate : float, as in `kalman_update`

    Returns
    -------
    Gaussian, log_evidence, rejected
        As in `kalman_update`.

    Raises
    ------
    ParameterError
        If S is singular.
    """
    K = np.linalg.solve(S, cross.T).T
    distance = float(innovation @ np.linalg.solve(S, innovation))
    if distance > gate:
        return bel, 0.0, True
    mean = wrap_rows(bel.mean + K @ innovation, angles_of(bel.mean))
    log_evidence = -0.5 * (distance + np.linalg.slogdet(2 * math.pi * S)[1])
    return Gaussian(mean, bel.Sigma - K @ S @ K.T), float(log_evidence), False
