r"""Where does the sensor sit, and is its clock right?

A truth tells where the robot was; a map, what the sensor should have seen from there. What is left
depends on four numbers that nobody measured: the sensor's place on the robot (x, y), its yaw, and
how late its stamps are. Least squares finds them, and says with its covariance how well,

.. math:: \Sigma = \Big(\sum_i J_i^\top J_i / \sigma_i^2\Big)^{-1} ,

where sigma is widened for errors that repeat, so that the standard errors are honest.

Some drives cannot tell two of them apart. A robot that never turns and keeps its speed sees the
same thing with a sensor ten centimetres ahead and with a clock that is late. Then the two estimates
are correlated nearly fully, and the pair is named. Drive curves, at several speeds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.geometry import compose, wrap
from pfkit.logs.least_squares import least_squares, slopes
from pfkit.worlds.distance import distance_field
from pfkit.worlds.log import Log

Array = NDArray[np.float64]
NAMES = ("mount x", "mount y", "mount yaw", "clock")
UNITS = ("m", "m", "rad", "s")
ALIKE = 0.95  # correlation of two estimates above which the drive did not tell them apart
ROUNDS = 12
FARTHEST = 0.5  # metres from a wall beyond which a beam met something else
MOST = 6000  # beams that are compared
YAWS = 24  # first guesses of a laser's yaw
REPEATED = 3.0  # how much wider than its spread the error of a beam counts


@dataclass(frozen=True)
class Seat:
    """A sensor's pose on the robot and the lateness of its clock.

    Parameters
    ----------
    value : array (4,): x, y (m), yaw (rad), clock (s)
    sd : array (4,), standard errors; inf for what the drive does not show
    alike : tuple of str, pairs that the drive does not tell apart
    """

    value: Array
    sd: Array
    alike: tuple[str, ...] = ()

    @property
    def confused(self) -> NDArray[np.bool_]:
        """Which of the four are in a pair that the drive does not tell apart."""
        return np.array([any(name in pair for pair in self.alike) for name in NAMES])

    def __str__(self) -> str:
        said = [
            f"{name} {value:+.3f} +- {sd:.3f} {unit}"
            for name, value, sd, unit in zip(NAMES, self.value, self.sd, UNITS, strict=True)
        ]
        return ", ".join([*said, *(f"this drive cannot tell {pair} apart" for pair in self.alike)])


class Looks(NamedTuple):
    """Measurements with a known true pose: steps (N,) and z (n, N)."""

    k: NDArray[np.int64]
    z: Array


def fit_seat(log: Log) -> Seat:
    """Fit the mounting and the clock of a sensor to a stretch of a log with truth and headings.

    Parameters
    ----------
    log : Log of a laser on a grid, or of named landmarks seen by range and bearing or by bearing

    Returns
    -------
    Seat

    Raises
    ------
    DataError
        If there is no truth with headings, or nothing is measured where it is known.
    """
    if log.truth is None or log.rig is None or not np.isfinite(log.truth).all(axis=0).any():
        raise DataError("a mounting is fitted to a truth with headings, and this log has none")
    counts = [zk.shape[1] for zk in log.z]
    k, z = np.repeat(np.arange(len(log)), counts), np.hstack(list(log.z))
    known = np.isfinite(log.truth[:, k]).all(axis=0)
    if log.rig.sensor == "laser":
        known &= (z[0] > 0) & (z[0] < log.rig.r_max)
    if log.rig.flipped:
        z = z * np.array([[1.0], [-1.0]])
    if known.sum() < 50:
        raise DataError(f"{known.sum()} measurements have a known true pose; take more seconds")
    looks = Looks(k[known], z[:, known])
    start = np.append(log.rig.mount, 0.0)
    if log.rig.sensor == "laser":
        return _fit_laser(log, looks, start)
    bearing, *_ = _landmark_errors(log, looks, start)
    start[2] -= float(np.median(bearing))
    return _fitted(_landmark_error(log, looks, start), start)


def _poses(log: Log, looks: Looks, p: Array) -> Array:
    """Poses (3, N) of the sensor when it looked."""
    x, y, theta = log.truth  # type: ignore[misc]
    sound = np.isfinite(log.truth).all(axis=0)  # type: ignore[arg-type]
    t = log.t[looks.k] - p[3]
    rows = (x[sound], y[sound], np.unwrap(theta[sound]))
    robot = np.stack([np.interp(t, log.t[sound], row) for row in rows])
    return compose(robot, p[:3, None])


def _landmark_errors(log: Log, looks: Looks, p: Array) -> list[Array]:
    """Errors of bearings, radians, and of ranges, metres, if there are any: (N,) each."""
    rows = log.rig.rows  # type: ignore[union-attr]
    mx, my = log.world.locate(looks.z[-1])
    x, y, theta = _poses(log, looks, p)
    bearing = looks.z[rows.index("bearing")]
    found = [wrap(bearing - np.arctan2(my - y, mx - x) + theta)]
    return [*found, looks.z[0] - np.hypot(mx - x, my - y)] if "range" in rows else found


def _landmark_error(log: Log, looks: Looks, guess: Array) -> Callable[[Array], Array]:
    """The errors in units of their spread at a first guess, far ones cut off: (m,)."""
    first = _landmark_errors(log, looks, guess)
    spreads = [1.4826 * float(np.median(np.abs(e - np.median(e)))) for e in first]

    def error(p: Array) -> Array:
        pairs = zip(_landmark_errors(log, looks, p), spreads, strict=True)
        return np.concatenate([np.clip(e / max(s, 1e-6), -4, 4) for e, s in pairs])

    return error


def _fit_laser(log: Log, looks: Looks, start: Array) -> Seat:
    """Beams must end at walls: the best of several yaws first, then least squares."""
    every = max(1, looks.k.size // MOST)
    looks = Looks(looks.k[::every], looks.z[:, ::every])
    error = _wall_error(log, looks)
    guesses = [start]
    for yaw in np.linspace(-np.pi, np.pi, YAWS, endpoint=False):
        guesses.append(np.array([start[0], start[1], wrap(start[2] + yaw), 0.0]))
    best = min(guesses, key=lambda p: float(np.mean(np.abs(error(p)))))
    return _fitted(error, best)


def _wall_error(log: Log, looks: Looks) -> Callable[[Array], Array]:
    """Distances of beam ends from the nearest wall's face, interpolated between cells: (m,)."""
    world = log.world
    field = distance_field(world.occupied, world.resolution)
    rows, columns = field.shape

    def error(p: Array) -> Array:
        x, y, theta = _poses(log, looks, p)
        r, phi = looks.z[0] + world.resolution / 2, theta + looks.z[1]
        i, j = world.to_cells(x + r * np.cos(phi), y + r * np.sin(phi)) - 0.5
        i, j = np.clip(i, 0, columns - 1.001), np.clip(j, 0, rows - 1.001)
        i0, j0 = np.floor(i).astype(np.int64), np.floor(j).astype(np.int64)
        a, b = i - i0, j - j0
        low = field[j0, i0] * (1 - a) + field[j0, i0 + 1] * a
        high = field[j0 + 1, i0] * (1 - a) + field[j0 + 1, i0 + 1] * a
        return np.minimum(low * (1 - b) + high * b, FARTHEST) / world.resolution

    return error


def _fitted(error: Callable[[Array], Array], start: Array) -> Seat:
    """Gauss-Newton from a first guess, and how sure the result is."""
    p = least_squares(error, start, ROUNDS)
    J, e = slopes(error, p), error(p)
    values, vectors = np.linalg.eigh(J.T @ J)
    seen = values > 1e-9 * values.max()
    spread = REPEATED**2 * float(np.mean((e - np.median(e)) ** 2))
    Sigma = spread * (vectors[:, seen] / values[seen]) @ vectors[:, seen].T
    sd = np.sqrt(np.maximum(np.diag(Sigma), 0.0))
    blind = (np.abs(vectors[:, ~seen]) > 0.1).any(axis=1)
    alike = []
    for a in range(4):
        for b in range(a + 1, 4):
            together = blind[a] and blind[b]
            if together or abs(Sigma[a, b]) > ALIKE * sd[a] * sd[b] > 0:
                alike.append(f"{NAMES[a]} and {NAMES[b]}")
    return Seat(p, np.where(blind, np.inf, sd), tuple(alike))
