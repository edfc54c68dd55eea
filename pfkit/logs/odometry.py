r"""Odometry in one piece: many small steps, one prediction.

A robot reports its wheels fifty to a hundred times a second and sees a landmark once or twice.
To move every particle at every report is to draw a hundred small errors where one would do:
their sum is what matters when the next measurement arrives. If the small errors are
independent, that sum can be worked out once, for the odometry alone, before the filter
starts.

Let step k drive a distance with an error of variance :math:`a_k` along the chord
:math:`c_k`, and turn with an error of variance :math:`q_k` about its midpoint :math:`m_k`.
To first order the pose :math:`p_j` after the steps i+1 ... j is off by

.. math:: \delta\theta = \sum_k \eta_k, \qquad
          \delta p = \sum_k \varepsilon_k c_k + \eta_k J (p_j - m_k), \qquad
          J = \begin{pmatrix} 0 & -1 \\ 1 & 0 \end{pmatrix},

so a small early turn swings everything that comes after it: the banana, flattened. The
covariance of that sum is a handful of running sums over k, whatever i and j.

For this to work, errors must add up with the way, not with the number of rows: their
*variances* grow per metre, per radian and per second (`Drift`). The alphas of
`VelocityMotion` multiply squares, which depends on how finely a drive is cut into rows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import ShapeError, require_array
from pfkit.geometry import between, compose, wrap
from pfkit.worlds.log import Log

Array = NDArray[np.float64]
TRANSPOSE = (1, 0, 2)


@dataclass(frozen=True)
class Drift:
    r"""How fast odometry gets worse: variances per metre, radian and second.

    .. math:: a = D_1 |d| + D_2 |\phi| + D_3\,\Delta t, \qquad
              q = D_4 |d| + D_5 |\phi| + D_6\,\Delta t

    for a step that drives d metres and turns by phi in dt seconds.

    Parameters
    ----------
    drive : (D_1, D_2, D_3), m^2 per metre, per radian and per second
    turn : (D_4, D_5, D_6), rad^2 per metre, per radian and per second

    Raises
    ------
    ParameterError
        If a rate is negative or not finite.
    """

    drive: tuple[float, float, float] = (0.01, 0.0, 0.0)
    turn: tuple[float, float, float] = (0.01, 0.01, 0.0)

    def __post_init__(self) -> None:
        require_array("drive", self.drive, (3,), "finite and >= 0")
        require_array("turn", self.turn, (3,), "finite and >= 0")

    def variances(self, u: Array) -> tuple[Array, Array]:
        """Variances a (m^2) and q (rad^2) of steps u = (v, omega, dt), shape (3, T)."""
        v, omega, dt = u
        return self.grown(v * dt, omega * dt, dt)

    def grown(self, way: Array, turn: Array, dt: Array) -> tuple[Array, Array]:
        """Variances a and q of a way in metres, a turn in radians and a time, (T,) each."""
        amounts = np.stack((np.abs(way), np.abs(turn), dt))
        return np.asarray(self.drive) @ amounts, np.asarray(self.turn) @ amounts


@dataclass(frozen=True)
class ComposedMotion:
    r"""A relative motion with its own Gaussian error: u = (dx, dy, dtheta, L).

    .. math:: x_t = x_{t-1} \oplus (u_{1:3} + L\,\xi), \qquad \xi \sim \mathcal N(0, I)

    L is a square root of the error's covariance, three by three, its rows one after another
    in u[3:12]. `preintegrate` makes such controls.
    """

    def mean(self, pose: Array, u: Array) -> Array:
        """Noise-free motion: pose (3, ...), u (12,) -> pose (3, ...)."""
        return compose(pose, require_array("u", u, (12, ...))[:3])

    def sample(self, pose: Array, u: Array, rng: np.random.Generator) -> Array:
        """Each particle moves with an error of its own: (3, ...), (12,) -> (3, ...)."""
        u = require_array("u", u, (12, ...))
        L = u[3:].reshape(3, 3, *u.shape[1:])
        error = np.einsum("ij...,j...->i...", L, rng.standard_normal(pose.shape))
        column = (..., *(None,) * (pose.ndim - u.ndim))
        return compose(pose, u[:3][column] + error)


class Paces(NamedTuple):
    """Steps of any odometry in one form, arrays (T,).

    Attributes
    ----------
    way : metres along the path
    chord : metres from start to end, negative in reverse
    bend : radians, the chord's direction from the heading before the step
    turn : radians
    dt : seconds
    """

    way: Array
    chord: Array
    bend: Array
    turn: Array
    dt: Array


def paces(u: Array, odometry: str = "speeds", t: Array | None = None) -> Paces:
    """Read controls as steps.

    Parameters
    ----------
    u : array (3, T), rows as `Rig` names them
    odometry : "speeds", "turns" or "increments"
    t : array (T,), seconds, at the ends of the steps; speeds know their own times
    """
    first, second, third = require_array("u", u, (3, ...))
    if odometry == "speeds":
        way, turn = first * third, second * third
        return Paces(way, way * np.sinc(turn / (2 * np.pi)), turn / 2, turn, third)
    dt = np.zeros(first.size) if t is None else np.diff(t, prepend=t[0])
    if odometry == "turns":
        return Paces(second, second, first, wrap(first + third), dt)
    chord = np.hypot(first, second)
    return Paces(chord, chord, np.arctan2(second, first), third, dt)


class Preintegrated:
    """The odometry of a log, integrated once; gives the motion between any two instants.

    Parameters
    ----------
    u : array (3, T), controls v (m/s), omega (rad/s), dt (s), or as `odometry` says
    drift : Drift
    odometry : str, as in `Rig`
    t : array (T,), seconds, needed by a drift that grows with time if u does not hold it

    Attributes
    ----------
    path : array (3, T + 1), dead reckoning from the origin; column k + 1 is the end of step k
    amounts : array (3, T + 1), metres, radians and seconds by then
    """

    def __init__(
        self, u: Array, drift: Drift, odometry: str = "speeds", t: Array | None = None
    ) -> None:
        way, length, bend, turn, dt = paces(u, odometry, t)
        heading = np.concatenate(([0.0], np.cumsum(turn)))
        direction = heading[:-1] + bend
        c = np.stack((np.cos(direction), np.sin(direction)))
        chord = length * c
        position = np.hstack((np.zeros((2, 1)), np.cumsum(chord, axis=1)))
        middle = (position[:, :-1] + position[:, 1:]) / 2
        a, q = drift.grown(way, turn, dt)
        self.path = np.vstack((position, wrap(heading)))
        self.amounts = _running_sum(np.stack((np.abs(way), np.abs(turn), dt)))
        self._a = _running_sum(a * c[:, None] * c)
        self._q = _running_sum(q)
        self._qm = _running_sum(q * middle)
        self._qmm = _running_sum(q * middle[:, None] * middle)

    @classmethod
    def of(cls, log: Log, drift: Drift) -> Preintegrated:
        """The odometry of a log, which is speeds unless its rig says otherwise."""
        return cls(log.u, drift, "speeds" if log.rig is None else log.rig.odometry, log.t)

    def between(self, i: NDArray[np.int64], j: NDArray[np.int64]) -> tuple[Array, Array]:
        """Motion (3, n) from instants i to later instants j of `path`, and its covariance.

        Returns
        -------
        motion : array (3, n), in the frame of the earlier pose
        Sigma : array (3, 3, n), its error's covariance in the same frame
        """
        q, qm, qmm, a = (s[..., j] - s[..., i] for s in (self._q, self._qm, self._qmm, self._a))
        p = self.path[:2, j]
        outer = p[:, None] * qm
        spread = q * p[:, None] * p - outer - outer.transpose(TRANSPOSE) + qmm
        lever = q * p - qm
        Sigma = np.empty((3, 3, q.size))
        Sigma[:2, :2] = a + _quarter_turn(_quarter_turn(spread).transpose(TRANSPOSE))
        Sigma[2, :2] = Sigma[:2, 2] = _quarter_turn(lever)
        Sigma[2, 2] = q
        start = self.path[:, i]
        return between(start, self.path[:, j]), _rotate(Sigma, -start[2])


def _running_sum(values: Array) -> Array:
    total = np.cumsum(values, axis=-1)
    return np.concatenate((np.zeros((*values.shape[:-1], 1)), total), axis=-1)


def _quarter_turn(rows: Array) -> Array:
    """Multiply by J from the left."""
    return np.stack((-rows[1], rows[0]))


def _rotate(Sigma: Array, angle: Array) -> Array:
    """Covariances (3, 3, n) of (x, y, theta) seen in frames turned by `angle` (n,)."""
    R = np.zeros_like(Sigma)
    R[0, 0] = R[1, 1] = np.cos(angle)
    R[1, 0], R[0, 1] = np.sin(angle), -np.sin(angle)
    R[2, 2] = 1.0
    return np.einsum("ijn,jkn,lkn->iln", R, Sigma, R)


def _root(Sigma: Array) -> Array:
    """Square roots L with L L^T = Sigma (3, 3, n), also of singular ones."""
    values, vectors = np.linalg.eigh(Sigma.transpose(2, 0, 1))
    root = vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :]
    return root.transpose(1, 2, 0)


def informative_steps(log: Log) -> NDArray[np.int64]:
    """Indices (n,) of the steps that measured something, and of the last one."""
    measured = np.array([zk.shape[1] > 0 for zk in log.z], dtype=bool)
    measured[-1] = True
    return np.flatnonzero(measured)


def preintegrate(log: Log, drift: Drift, steps: NDArray[np.int64] | None = None) -> Log:
    """Keep some of a log's steps; one motion leads from each to the next.

    Parameters
    ----------
    log : Log
    drift : Drift
    steps : int64 array (n,), increasing, optional
        The steps to keep; `informative_steps` if left out. A step with a measurement that is
        not kept is lost. ``np.arange(len(log))`` gives the same model row by row.

    Returns
    -------
    Log with u of shape (12, n) for `ComposedMotion`
    """
    steps = informative_steps(log) if steps is None else steps
    ends = steps + 1
    motion, Sigma = Preintegrated.of(log, drift).between(np.append(0, ends[:-1]), ends)
    return replace(
        log,
        t=log.t[steps],
        u=np.concatenate((motion, _root(Sigma).reshape(9, -1))),
        z=[log.z[k] for k in steps],
        truth=None if log.truth is None else log.truth[:, steps],
        outlier=None if log.outlier is None else [log.outlier[k] for k in steps],
        scored=None if log.scored is None else log.scored[steps],
        rig=None,
    )


def fill_in(
    log: Log, drift: Drift, ends: NDArray[np.int64], estimate: Array, Sigma: Array
) -> tuple[Array, Array]:
    """Carry estimates at a few instants on to every step of a log, by its odometry.

    Parameters
    ----------
    log : Log
    drift : Drift
    ends : int64 array (n,), increasing from 0
        When the estimates hold: 0 is before the first step, k + 1 at the end of step k.
    estimate : array (3, n) or (3, n, B)
    Sigma : array (3, 3, n) or (3, 3, n, B), covariances of the estimates

    Returns
    -------
    estimate : array (3, T) or (3, T, B)
    sd : array (T,) or (T, B), root of the summed position variances, metres

    Raises
    ------
    ParameterError, ShapeError
        If the estimates, their covariances and their instants do not belong together.
    """
    ends = np.asarray(ends)
    if ends.dtype.kind not in "iu" or ends.ndim != 1 or np.any(ends < 0):
        raise ShapeError(f"ends must be whole numbers (T,), got {ends.dtype} of shape {ends.shape}")
    estimate = require_array("estimate", estimate, (3, ends.size, ...))
    Sigma = require_array("Sigma", Sigma, (3, *estimate.shape))
    now = np.arange(1, len(log) + 1)
    latest = np.searchsorted(ends, now, side="right") - 1
    motion, grown = Preintegrated.of(log, drift).between(ends[latest], now)
    batch = (..., *(None,) * (estimate.ndim - 2))
    pose, before = estimate[:, latest], Sigma[:, :, latest]
    moved = compose(pose, motion[batch])
    lever = np.stack((pose[1] - moved[1], moved[0] - pose[0]))
    variance = before[0, 0] + before[1, 1] + (grown[0, 0] + grown[1, 1])[batch]
    variance += 2 * (lever * before[:2, 2]).sum(axis=0) + before[2, 2] * (lever**2).sum(axis=0)
    return moved, np.sqrt(np.maximum(variance, 0.0))
