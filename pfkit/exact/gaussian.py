r"""Extended and unscented Kalman filters: a Gaussian through a bent world.

A robot's motion turns and its sensors measure angles: nothing is linear. Both famous remedies
keep the Gaussian belief and answer the same question approximately, "a Gaussian goes through a
function; what mean and covariance come out?":

* `linearise` replaces the function by its tangent at the mean (the extended filter),
* `unscented` sends a few chosen points through it and measures what comes out.

All else is shared, and is Kalman's. Noise is just more coordinates: a model's ``sample`` is a
fixed function of the state and of standard normals, so we hand it the normals that we want.
That is how these filters work with every motion and sensor model of the package, and with
yours, as long as its noise is Gaussian.

One Gaussian costs microseconds and is superb while it is right: one mode, nearly linear. It
cannot hold two hypotheses, and after a bad start it is confidently wrong.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, ParameterError, require_array, require_number
from pfkit.exact.kalman import Gaussian, angles_of, condition, wrap_rows
from pfkit.geometry import circular_mean
from pfkit.models.landmark_sensors import LandmarkSensor
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import Sensor, how_many

Array = NDArray[np.float64]
Function = Callable[[Array], Array]
Transform = Callable[[Function, Array, Array, tuple[int, ...]], tuple[Array, Array, Array]]


def linearise(
    f: Function, mean: Array, Sigma: Array, angles: tuple[int, ...] = ()
) -> tuple[Array, Array, Array]:
    r"""A Gaussian through a function, by its tangent at the mean.

    .. math:: y = f(\mu), \qquad Y = J \Sigma J^T, \qquad C = \Sigma J^T, \qquad
              J = \partial f / \partial x \,|_\mu

    Parameters
    ----------
    f : function of (N, P) points that returns (n, P) values
    mean : array (N,)
    Sigma : array (N, N)
    angles : tuple of int, the rows of the result that are angles

    Returns
    -------
    mean (n,), covariance (n, n), and cross-covariance (N, n) of argument and result

    Raises
    ------
    ShapeError, ParameterError
        If mean and Sigma do not match, or f is not a function.

    Notes
    -----
    J by central differences, in one call of f with 2 N + 1 points.
    """
    mean, Sigma = _moments(f, mean, Sigma)
    step = 1e-5 * np.eye(mean.size)
    value = _values(f, np.column_stack((mean, mean[:, None] + step, mean[:, None] - step)))
    y, difference = value[:, 0], value[:, 1 : mean.size + 1] - value[:, mean.size + 1 :]
    J = wrap_rows(difference, angles) / 2e-5
    cross = Sigma @ J.T
    return y, J @ cross, cross


def unscented(
    f: Function, mean: Array, Sigma: Array, angles: tuple[int, ...] = ()
) -> tuple[Array, Array, Array]:
    r"""A Gaussian through a function, by 2 N points at :math:`\mu \pm \sqrt N\, s_i`.

    .. math:: y = \frac{1}{2N} \sum_i f(x_i), \qquad
              Y = \frac{1}{2N} \sum_i (f(x_i) - y)(f(x_i) - y)^T, \qquad \Sigma = s s^T

    Parameters, returns and errors are those of `linearise`. The mean of an angle is circular.

    Notes
    -----
    Source: Probabilistic Robotics, Table 3.4, with alpha = 1 and beta = kappa = 0: the point in
    the middle has no weight, all others have the same, and Y is a covariance whatever f does
    (the "cubature" points).
    """
    mean, Sigma = _moments(f, mean, Sigma)
    values, vectors = np.linalg.eigh(Sigma)
    root = vectors * np.sqrt(np.maximum(values, 0.0) * mean.size)
    deviation = np.hstack((root, -root))
    value = _values(f, mean[:, None] + deviation)
    y = value.mean(axis=1)
    for row in angles:
        y[row] = circular_mean(value[row])
    spread = wrap_rows(value - y[:, None], angles)
    return y, spread @ spread.T / value.shape[1], deviation @ spread.T / value.shape[1]


def gaussian_predict(
    bel: Gaussian, u: ArrayLike, motion: MotionModel, transform: Transform = linearise
) -> tuple[Gaussian, Array]:
    r"""Move a Gaussian by any motion model with Gaussian noise: EKF or UKF.

    .. math:: (x_{t-1}, \epsilon) \mapsto x_t, \qquad \epsilon \sim \mathcal N(0, I)

    Parameters
    ----------
    bel : Gaussian
    u : array_like (n,), the control
    motion : MotionModel
    transform : `linearise` (EKF) or `unscented` (UKF)

    Returns
    -------
    Gaussian
    cross : array (D, D), covariance of the states before and after, for the smoother

    Raises
    ------
    ParameterError, ShapeError
        If the motion's noise is not Gaussian, or an argument is not what it should be.

    Notes
    -----
    Source: Probabilistic Robotics, Tables 3.3, 3.4, 7.2 and 7.4, with noise in the control.
    """
    u, angles = np.asarray(u, dtype=float), angles_of(bel.mean)
    mean, Sigma, f = _augment(bel, lambda state, rng: motion.sample(state, u, rng))
    y, Y, cross = transform(f, mean, Sigma, angles)
    return Gaussian(wrap_rows(y, angles), Y), cross[: bel.mean.size]


def gaussian_update(
    bel: Gaussian,
    z: ArrayLike | None,
    sensor: Sensor,
    transform: Transform = linearise,
    gate: float = math.inf,
) -> tuple[Gaussian, float, int]:
    """Weigh a Gaussian by measurements, one column of z after the other: EKF or UKF.

    Parameters
    ----------
    bel : Gaussian
    z : array_like (n, K), or None
    sensor : Sensor with Gaussian noise: `RangeBearing`, `Range`, `Bearing`, `Compass`, `Position`
    transform : `linearise` (EKF) or `unscented` (UKF)
    gate : float, as in `kalman_update`, for each column on its own

    Returns
    -------
    Gaussian
    log_evidence : float, summed over the columns that passed
    rejected : int, how many did not

    Raises
    ------
    ParameterError
        If the sensor's noise is not Gaussian, or the gate is not positive.
    ShapeError, DataError
        If z does not have the sensor's rows, or is not finite.

    Notes
    -----
    Source: Probabilistic Robotics, Table 7.2, lines 9 to 20.
    """
    gate = require_number("gate", gate, "> 0")
    if how_many(z) == 0:
        return bel, 0.0, 0
    z = require_array("z", z, (sensor.components, ...), error=DataError)
    total, rejected = 0.0, 0
    for column in z.reshape(z.shape[0], -1).T:
        named = isinstance(sensor, LandmarkSensor)
        which: dict[str, Any] = {"ids": column[-1:]} if named else {}
        n = column.size - len(which)
        mean, Sigma, f = _augment(bel, lambda x, rng: _measure(sensor, x, rng, which)[:n])  # noqa: B023
        y, S, cross = transform(f, mean, Sigma, sensor.angles)
        innovation = wrap_rows(column[:n] - y, sensor.angles)
        bel, log_evidence, out = condition(bel, innovation, S, cross[: bel.mean.size], gate)
        total, rejected = total + log_evidence, rejected + out
    return bel, total, rejected


def _moments(f: Function, mean: ArrayLike, Sigma: ArrayLike) -> tuple[Array, Array]:
    """Check what both transforms need."""
    mean = require_array("mean", mean, ("N",))
    return mean, require_array("Sigma", Sigma, (mean.size, mean.size))


def _values(f: Function, points: Array) -> Array:
    """The values (n, P) of a function at points (N, P), which may be a student's own."""
    return require_array("the value of f", f(points), ("n", points.shape[1]))


def _measure(sensor: Any, state: Array, rng: Any, which: dict[str, Any]) -> Array:
    """One noisy measurement (n, P) of states (D, P)."""
    if not hasattr(sensor, "sample") or hasattr(sensor, "sensor"):
        raise ParameterError(
            f"{type(sensor).__name__} has no Gaussian noise to linearise; give the Gaussian "
            "filter the sensor it wraps, and a gate against outliers"
        )
    return sensor.sample(state, rng, **which)[:, 0]


class _Normals:
    """In place of a generator: hands out given standard normals, and counts them."""

    def __init__(self, given: Array | None = None) -> None:
        self.given, self.used = given, 0

    def standard_normal(self, size: int | tuple[int, ...]) -> Array:
        shape = (size,) if isinstance(size, int) else tuple(size)
        first, self.used = self.used, self.used + math.prod(shape[:-1])
        return (
            np.zeros(shape) if self.given is None else self.given[first : self.used].reshape(shape)
        )

    def __getattr__(self, name: str) -> Any:
        raise ParameterError(
            f"the model draws rng.{name}, and a Gaussian filter needs rng.standard_normal: "
            "use a model with Gaussian noise (nu = inf)"
        )


def _augment(bel: Gaussian, sample: Callable[[Array, Any], Array]) -> tuple[Array, Array, Function]:
    """Add the noise to the state: mean and covariance of (x, eps), and sample as function of it."""
    D, counter = bel.mean.size, _Normals()
    sample(bel.mean[:, None], counter)
    mean = np.concatenate((bel.mean, np.zeros(counter.used)))
    Sigma = np.eye(mean.size)
    Sigma[:D, :D] = bel.Sigma
    return mean, Sigma, lambda points: sample(points[:D], _Normals(points[D:]))
