r"""Learn from the first minutes what the data sheet got wrong.

Noise is what is left when every error that repeats itself has been removed. Wheels that are
smaller than believed make every metre too long; a command that takes a quarter of a second
to arrive makes every turn late; a camera mounted askew shifts every bearing; a radio reads
long by metres. A filter can absorb such errors only as noise that it does not have, and pays
with precision. Where somebody filmed the first minutes, least squares finds them:

.. math:: \min_{k_v, k_\omega, \tau} \sum_i \Big\|
          (x_{t_i} \ominus x_{t_i - W}) - o_i(k_v, k_\omega, \tau) \Big\|^2

where :math:`o_i` is the motion that the odometry reports for the window of length W, with
speeds multiplied by :math:`k_v`, turn rates by :math:`k_\omega` and everything delayed by
:math:`\tau`. A window in which the two disagree by more than the way itself tells of a truth that
jumped or points the wrong way; it is left out. Windows in which the wheels slipped stay in: the
filter will meet such moments again, and the best single scale includes them.

What is fitted on one log holds for that robot on that day. It does not transfer: a calibration
taken from another log is worse than none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError, require_array
from pfkit.geometry import between, wrap
from pfkit.logs.least_squares import least_squares, slopes
from pfkit.logs.odometry import Drift, Preintegrated
from pfkit.logs.seat import Seat, fit_seat
from pfkit.worlds.log import Log
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
WINDOW = 4.0  # seconds: long enough to see a scale error above the truth's own noise
STRIDE = 0.5  # seconds between the starts of two windows
ARM = 0.5  # metres per radian: what a heading error counts beside a position error
NU = 4.0
USUAL_DRIFT = Drift((0.02, 0, 0), (0.05, 0.05, 0.001))  # of commands that nobody calibrated
LEAST_DRIFT = 0.002  # m^2 per metre: wheels that seem perfect on one part are not on the next
MATTERS = np.array([0.02, 0.02, 0.01, np.inf])  # metres, radians: a smaller seat is left as stated
FEWEST = 20  # errors of which a spread is taken
SOON = 2.0  # seconds within which two errors count as consecutive
MOST_ALIKE = 0.9  # the largest correlation that is believed: a factor of 4.4


@dataclass(frozen=True)
class Calibration:
    """Errors that repeat themselves.

    Parameters
    ----------
    speed, turn : float
        True over reported speed and turn rate.
    delay : float, seconds
        The robot moves that much later than the odometry says.
    bearing_bias : float, radians, measured minus true
    range_bias : array (L,) or float, metres, measured minus true, by landmark
    mount : (x, y, yaw) of the sensor on the robot, metres and radians, if fitted
    sigma : (float, float), metres and radians
        Spread that is left of ranges and bearings, widened for errors that repeat; None: unknown.
    drift : Drift, optional
        What is left of the odometry's errors.
    seat : Seat, optional
        The sensor's mounting and clock as fitted, with standard errors. Only a mounting that is
        certain, far enough to matter and told apart from the clock becomes `mount`.
    sd : (float, float, float), standard errors of speed, turn and delay (s), optional
    slip : (float, float), metres to the left per metre driven, and its standard error, optional
    """

    speed: float = 1.0
    turn: float = 1.0
    delay: float = 0.0
    bearing_bias: float = 0.0
    range_bias: float | Array = 0.0
    mount: tuple[float, float, float] | None = None
    sigma: tuple[float | None, float | None] = (None, None)
    drift: Drift | None = None
    seat: Seat | None = None
    sd: tuple[float, float, float] | None = None
    slip: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        for name in ("speed", "turn", "delay", "bearing_bias", "range_bias"):
            require_array(name, getattr(self, name))

    def apply(self, log: Log) -> Log:
        """The log as a well-calibrated odometer would have written it."""
        return replace(log, u=_corrected(log, self.speed, self.turn, self.delay))

    def __str__(self) -> str:
        parts = []
        if (self.speed, self.turn, self.delay) != (1.0, 1.0, 0.0):
            speed, turn, delay = (
                "" if sd is None else f" +- {sd:.3f}" for sd in self.sd or [None] * 3
            )
            parts.append(f"speed x {self.speed:.3f}{speed}, turn x {self.turn:.3f}{turn}")
            parts.append(f"delay {self.delay:.2f}{delay} s")
        if self.slip is not None:
            parts.append(
                f"sideways slip {self.slip[0]:+.3f} +- {self.slip[1]:.3f} m/m (or a truth "
                "whose heading is off by as many radians: no drive tells these apart)"
            )
        if self.bearing_bias:
            parts.append(f"bearing bias {self.bearing_bias:+.4f} rad")
        if np.ndim(self.range_bias):
            metres = ", ".join(f"{b:+.2f}" for b in np.asarray(self.range_bias))
            parts.append(f"range bias {metres} m")
        if self.seat is not None:
            parts.append(str(self.seat))
        return ", ".join(parts) or "nothing"


def fit_odometry(log: Log) -> Calibration:
    """Fit speed scale, turn scale and delay to the truth of a log (its first part, say).

    Parameters
    ----------
    log : Log with u = (v, omega, dt) and truth

    Returns
    -------
    Calibration

    Raises
    ------
    DataError
        If there is no truth, or the robot hardly moved in it.
    """
    i, j = _windows(log)
    looks = np.isfinite(log.truth[2, i] + log.truth[2, j])  # type: ignore[index]
    if not looks.any():
        raise DataError("the truth has no headings; speed and turn cannot be fitted to it")
    i, j = i[looks], j[looks]
    truth = between(log.truth[:, i], log.truth[:, j])  # type: ignore[index]

    def error(parameters: Array) -> Array:
        motion, _ = Preintegrated(_corrected(log, *parameters), Drift()).between(i + 1, j + 1)
        x, y, theta = truth - motion
        return np.stack((x, y, ARM * wrap(theta)))

    neutral = np.array([1.0, 1.0, 0.0])
    x, y, theta = error(neutral)
    agree = (np.hypot(x, y) < np.hypot(*truth[:2]) + 0.1) & (np.abs(theta) < ARM)
    speed, turn, delay = least_squares(lambda p: error(p)[:, agree].ravel(), neutral)
    if not (0.3 < speed < 3 and 0.3 < turn < 3 and abs(delay) < WINDOW / 2):
        raise DataError(
            f"calibration found speed x {speed:.2f}, turn x {turn:.2f}, delay {delay:.2f} s: "
            "truth and odometry do not describe the same drive; calibrate on another part"
        )
    p = np.array([speed, turn, delay])
    left = error(p)[:, agree]
    J = slopes(lambda p: error(p)[:, agree].ravel(), p)
    overlap = WINDOW / STRIDE  # windows share most of what they saw
    sd = np.sqrt(overlap * np.mean(left**2) * np.diag(np.linalg.inv(J.T @ J)))
    way = np.hypot(*truth[:2, agree])
    slip = float((left[1] * way).sum() / (way**2).sum())
    slip_sd = float(np.sqrt(overlap * np.mean((left[1] - slip * way) ** 2) / (way**2).sum()))
    return Calibration(
        float(speed),
        float(turn),
        float(delay),
        sd=(float(sd[0]), float(sd[1]), float(sd[2])),
        slip=(slip, slip_sd),
    )


def fit_bearing_bias(log: Log) -> float:
    """Robust mean of measured minus true bearing, radians, for z = (r, phi, s)."""
    k, z = _measured(log)
    mx, my = log.world.locate(z[2])
    x, y, theta = log.truth[:, k]  # type: ignore[index]
    return _robust_mean(wrap(z[1] - np.arctan2(my - y, mx - x) + theta))


def fit_range_bias(log: Log) -> Array:
    """Robust mean of measured minus true range per landmark, metres, for z = (r, ..., s).

    Returns
    -------
    array (L,) in the order of ``log.world.ids``; a landmark that was never measured gets the
    median of the others.
    """
    k, z = _measured(log)
    mx, my = log.world.locate(z[-1])
    x, y, _ = log.truth[:, k]  # type: ignore[index]
    error = z[0] - np.hypot(mx - x, my - y)
    bias = np.full(len(log.world), np.nan)
    for n, landmark in enumerate(log.world.ids):
        own = error[z[-1] == landmark]
        if own.size:
            bias[n] = _robust_mean(own)
    return np.where(np.isnan(bias), np.nanmedian(bias), bias)


def calibrate(log: Log) -> Calibration:
    """Fit what is wrong with the log: odometry and camera, or the beacons' ranges.

    The odometry of a log with ranges only is left alone: ours measures its wheels, and on the
    first third of Plaza 2 two fitted scales made the filter slightly worse.

    Parameters
    ----------
    log : Log
        A stretch with truth: ranges and bearings, or ranges only.

    Returns
    -------
    Calibration

    Raises
    ------
    ParameterError, DataError
        If `log` is not a log, or has no truth to compare with.
    """
    log.first_measured()
    if log.truth is None:
        raise DataError("calibration compares with the truth, and this log has none")
    rig = log.rig or Rig("range-bearing")
    if rig.sensor == "range":
        found = Calibration(range_bias=fit_range_bias(log))
        return replace(found, sigma=_sigmas(log, found), drift=fit_drift(log))
    found = fit_odometry(log) if rig.odometry == "speeds" else Calibration()
    if rig.named:
        found = _with_sensor(log, rig, found)
    return replace(found, drift=fit_drift(found.apply(log)))


def _with_sensor(log: Log, rig: Rig, found: Calibration) -> Calibration:
    """Add what is fitted of a sensor: its seat; of landmarks also the bearing's bias and noise."""
    seat = None if log.rig is None else fit_seat(log)
    mount = None if seat is None else _believed(seat, rig)
    if rig.sensor == "laser":
        return replace(found, seat=seat, mount=mount)
    if mount is not None and (any(mount) or rig.flipped):
        x, y, _ = mount
        log = _from_the_seat(log, (x, y, 0.0), rig.flipped)
        mount = (x, y, 0.0)
    found = replace(found, bearing_bias=fit_bearing_bias(log), seat=seat, mount=mount)
    return replace(found, sigma=_sigmas(log, found))


def _believed(seat: Seat, rig: Rig) -> tuple[float, float, float]:
    """The mounting: as fitted where that is certain and far enough to matter, else as stated."""
    stated = np.append(rig.mount, 0.0)
    off = seat.value - stated
    sure = (np.abs(off) > 3 * seat.sd) & (np.abs(off) > MATTERS) & ~seat.confused
    x, y, yaw = np.where(sure, seat.value, stated)[:3]
    return float(x), float(y), float(yaw)


def _from_the_seat(log: Log, mount: tuple[float, float, float], flipped: bool) -> Log:
    """The log of the sensor itself: its own poses as truth, and its bearings the right way up."""
    x, y, theta = log.truth  # type: ignore[misc]
    c, s = np.cos(theta), np.sin(theta)
    seat = np.stack((x + c * mount[0] - s * mount[1], y + s * mount[0] + c * mount[1], theta))
    row = log.rig.rows.index("bearing")  # type: ignore[union-attr]
    sign = np.ones((len(log.rig.rows), 1))  # type: ignore[union-attr]
    sign[row] = -1.0 if flipped else 1.0
    return replace(log, truth=seat, z=[sign * zk for zk in log.z])


def fit_drift(log: Log) -> Drift:
    r"""Twice the variance of the odometry's errors over a window.

    .. math:: e_d^2 \approx D_1 |d|, \qquad
              e_\theta^2 \approx D_4 |d| + D_5 |\phi| + D_6\, \Delta t

    A truth of positions only shows the first; the turn's errors are then as much smaller than
    usual as the drive's.
    """
    i, j = _windows(log)
    truth = between(log.truth[:, i], log.truth[:, j])  # type: ignore[index]
    way = np.hypot(*(log.truth[:2, j] - log.truth[:2, i]))  # type: ignore[index]
    steps = Preintegrated.of(log, Drift())
    motion, _ = steps.between(i + 1, j + 1)
    amounts = steps.amounts[:, j + 1] - steps.amounts[:, i + 1]
    looks = np.isfinite(truth[2]).all()
    agree = np.hypot(*(truth - motion)[:2]) < way + 0.1 if looks else way > 0
    along, amounts = (way - np.hypot(*motion[:2]))[agree], amounts[:, agree]
    D1 = max(2 * float(np.sum(_clipped(along) ** 2) / amounts[0].sum()), LEAST_DRIFT)
    if not looks:
        share = D1 / USUAL_DRIFT.drive[0]
        D4, D5, D6 = (share * rate for rate in USUAL_DRIFT.turn)
        return Drift((D1, 0.0, 0.0), (D4, D5, D6))
    D4, D5, D6 = 2 * _non_negative_fit(amounts.T, _clipped(wrap((truth - motion)[2, agree])) ** 2)
    return Drift((D1, 0.0, 0.0), (float(D4), float(D5), float(D6)))


def _clipped(values: Array) -> Array:
    """Errors, those beyond three times the usual size cut to that."""
    scale = 3 * 1.4826 * float(np.median(np.abs(values)))
    return np.clip(values, -scale, scale)


def _non_negative_fit(A: Array, b: Array) -> Array:
    """Least squares with coefficients >= 0: of all choices of columns the best that has them."""
    best, least = np.zeros(A.shape[1]), np.inf
    for n in range(1, A.shape[1] + 1):
        for columns in combinations(range(A.shape[1]), n):
            part = np.linalg.lstsq(A[:, columns], b, rcond=None)[0]
            misfit = float(np.sum((A[:, columns] @ part - b) ** 2))
            if (part >= 0).all() and misfit < least:
                best, least = np.zeros(A.shape[1]), misfit
                best[list(columns)] = part
    return best


def _sigmas(log: Log, found: Calibration) -> tuple[float | None, float | None]:
    """Spread of ranges and of bearings that the calibration leaves, for landmarks with names."""
    rig = log.rig or Rig("range-bearing")
    if "landmark" not in rig.rows:
        return None, None
    k, z = _measured(log)
    mx, my = log.world.locate(z[-1])
    x, y, theta = log.truth[:, k]  # type: ignore[index]
    left: dict[str, Array] = {}
    if "range" in rig.rows:
        bias = np.broadcast_to(found.range_bias, len(log.world))[log.world.index(z[-1])]
        left["range"] = z[0] - bias - np.hypot(mx - x, my - y)
    if "bearing" in rig.rows:
        phi = z[rig.rows.index("bearing")]
        left["bearing"] = wrap(phi - found.bearing_bias - np.arctan2(my - y, mx - x) + theta)
    widths = {name: _width(error, z[-1], log.t[k]) for name, error in left.items()}
    return widths.get("range"), widths.get("bearing")


def _width(error: Array, names: Array, t: Array) -> float | None:
    r"""Robust spread times :math:`\\sqrt{(1 + \\rho)/(1 - \\rho)}`, rho of errors in a row."""
    known = np.isfinite(error)
    error, names, t = error[known], names[known], t[known]
    if error.size < FEWEST:
        return None
    order = np.lexsort((t, names))
    clipped, names, t = _clipped(error - np.median(error))[order], names[order], t[order]
    row = (np.diff(names) == 0) & (np.diff(t) < SOON)
    rho = 0.0
    if row.any():
        rho = float(np.mean((clipped[1:] * clipped[:-1])[row]) / np.mean(clipped**2))
    rho = float(np.clip(rho, 0.0, MOST_ALIKE))
    spread = 1.4826 * float(np.median(np.abs(error - np.median(error))))
    return spread * math.sqrt((1 + rho) / (1 - rho)) or None


def _corrected(log: Log, speed: float, turn: float, delay: float) -> Array:
    """Controls of the same instants, scaled, each taken from `delay` seconds earlier."""
    _, _, dt = log.u
    ends = log.t - log.t[0]
    starts = ends - dt
    marks = np.append(starts[0], ends)
    u = np.array(log.u)
    for row, scale in ((0, speed), (1, turn)):
        way = np.concatenate(([0.0], np.cumsum(log.u[row] * dt)))
        moved = np.interp(ends - delay, marks, way) - np.interp(starts - delay, marks, way)
        u[row] = scale * np.divide(moved, dt, out=np.zeros_like(dt), where=dt > 0)
    return u


def _windows(log: Log) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of steps one window apart, at both of which the truth is known."""
    t0 = np.arange(log.t[0], log.t[-1] - WINDOW, STRIDE)
    i, j = np.searchsorted(log.t, t0), np.searchsorted(log.t, t0 + WINDOW)
    good = np.isfinite(log.truth[:2, i] + log.truth[:2, j]).all(axis=0)  # type: ignore[index]
    i, j = i[good], j[good]
    way = np.hypot(*(log.truth[:2, j] - log.truth[:2, i])) if i.size else np.zeros(0)  # type: ignore[index]
    if way.sum() * STRIDE / WINDOW < 1.0:
        raise DataError(
            f"the robot drives less than a metre in the {log.t[-1] - log.t[0]:.0f} s to calibrate "
            "on (or their truth is missing); take more seconds"
        )
    return i, j


def _measured(log: Log) -> tuple[NDArray[np.int64], Array]:
    """All measurements of a log in one array (n, N), and the step of each (N,)."""
    counts = [zk.shape[1] for zk in log.z]
    k, z = np.repeat(np.arange(len(log)), counts), np.hstack(list(log.z))
    known = np.isfinite(log.truth[0, k])  # type: ignore[index]
    if not known.any():
        raise DataError("no measurement has a known true pose here; calibrate on a longer part")
    return k[known], z[:, known]


def _robust_mean(values: Array) -> float:
    """Location of a Student t: the mean, with far values counted less."""
    mean = float(np.median(values))
    scale = 1.4826 * float(np.median(np.abs(values - mean))) + np.finfo(float).tiny
    for _ in range(20):
        w = 1.0 / (1.0 + ((values - mean) / scale) ** 2 / NU)
        mean = float((w * values).sum() / w.sum())
    return mean
