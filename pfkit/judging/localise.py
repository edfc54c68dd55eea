"""Localise a recorded robot: settings that work, one call, an honest score.

Everything is put together here: calibrate on the first seconds (if their truth may be used),
compose the odometry between measurements, start from a known pose or from anywhere on the map,
run the filter, carry its answers on to every odometry stamp, compare with the truth.

The settings were chosen on the first third of MRCLAM data set 4, robot 3, and of Plaza 2.
Three things about them are worth knowing.

* sigma_r is three times the spread of the range errors. Consecutive errors to one landmark
  are nearly equal; a model that takes them as independent counts the same news many times, and
  a wide sigma is the cheap way to say so.
* The errors have Student's t with four degrees of freedom: one bar code that was misread must
  not overrule everything else.
* Commands are not measurements. What is not calibrated must be paid for as noise (`Drift`).

A global start needs two things more; they were chosen on variants of the log with other starts,
fewer landmarks and false measurements. The first measurement may be false, and a cloud that
gathers around it is lost; so one measurement in a thousand may come from anywhere
(`OutlierMixture`), which keeps a few particles elsewhere. A larger share would doubt true
measurements, too, and be slow where landmarks are few. And a wide cloud is weighed in stages
(`tempered_update`), a narrow one plainly: a cloud that has found the robot must not walk after
a false measurement.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError, ParameterError, require_count
from pfkit.filters.particle_filter import predict, resample, update
from pfkit.filters.tempering import tempered_update
from pfkit.judging.diagnostics import pose_error, settling_time
from pfkit.logs.calibration import Calibration, calibrate
from pfkit.logs.odometry import (
    ComposedMotion,
    Drift,
    fill_in,
    informative_steps,
    preintegrate,
)
from pfkit.models.landmark_sensors import Range, RangeBearing
from pfkit.models.robust import OutlierMixture
from pfkit.models.sensors import Sensor
from pfkit.particles.estimators import covariance, mean_pose
from pfkit.particles.particle_set import Particles
from pfkit.particles.priors import gaussian_prior, uniform_prior
from pfkit.particles.resampling import systematic
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap

Array = NDArray[np.float64]
Watch = Callable[[int, int], object]
OUTLIER_SHARE = 0.001  # of the measurements of a global start: may come from anywhere


@dataclass(frozen=True)
class Settings:
    """What the filter assumes about one kind of log.

    Parameters
    ----------
    drift : Drift
    sensor : Sensor
    M : (int, int), particles for a known and for a global start
    start_sd : (3,), metres and radians, of a "known" start
    limit : float, metres; an error below it counts as converged
    """

    drift: Drift
    sensor: Sensor
    M: tuple[int, int]
    start_sd: tuple[float, float, float]
    limit: float


def settings_for(log: Log, calibration: Calibration | None = None) -> Settings:
    """The course's settings for a log with range and bearing, or with ranges only."""
    fitted = calibration or Calibration()
    if log.z[log.first_measured()].shape[0] == 3:
        if calibration is None:
            drift, (sigma_r, sigma_phi) = Drift((0.02, 0, 0), (0.05, 0.05, 0.001)), (0.45, 0.02)
        else:
            drift, (sigma_r, sigma_phi) = Drift((0.01, 0, 0), (0.01, 0.01, 3e-4)), (0.40, 0.0125)
        sensor: Sensor = RangeBearing(
            log.world, sigma_r, sigma_phi, nu=4, bias_phi=fitted.bearing_bias
        )
        return Settings(drift, sensor, (1000, 5000), (0.02, 0.02, 0.02), 0.5)
    drift = Drift((0.005, 0, 0), (5e-5, 0.002, 0))
    sensor = Range(log.world, 3.0, bias=fitted.range_bias, nu=4)
    return Settings(drift, sensor, (2000, 20000), (0.2, 0.2, 0.02), 5.0)


def calibrate_first(log: Log, seconds: float) -> Calibration:
    """Calibrate on the first seconds of a log.

    Raises
    ------
    ParameterError
        If `seconds` is not positive.
    DataError
        If these seconds hold too little driving, measuring or truth.
    """
    if not seconds > 0:
        raise ParameterError(f"seconds to calibrate on must be > 0, got {seconds}")
    part = log[: int(np.searchsorted(log.t, log.t[0] + seconds))]
    if len(part) == 0 or not any(zk.shape[1] for zk in part.z):
        raise DataError(f"nothing is measured in the first {seconds:g} s; calibrate on more")
    return calibrate(part)


class Track(NamedTuple):
    """What the filter said at every step of the log.

    Attributes
    ----------
    estimate : array (3, T, B), metres and radians, for B seeds
    sd : array (T, B), metres: root of the summed position variances
    first : float, seconds, the time of the first measurement
    seconds : float, how long the filter took (all B together)
    """

    estimate: Array
    sd: Array
    first: float
    seconds: float


def localise(
    log: Log,
    rng: np.random.Generator,
    start: str = "known",
    M: int | None = None,
    batch: int = 1,
    settings: Settings | None = None,
    plain: bool = False,
    every_row: bool = False,
    watch: Watch | None = None,
) -> Track:
    """Run the filter along a recorded log.

    Parameters
    ----------
    log : Log with u = (v, omega, dt), already calibrated if it is to be
    rng : numpy.random.Generator
    start : "known" (the truth before the first command) or "global" (anywhere on the map)
    M : int, optional; particles, from the settings if left out
    batch : int, how many filters run side by side
    settings : Settings, optional; `settings_for` the log if left out
    plain : bool
        Weigh plainly from a global start, too, and believe every measurement: to see what happens.
    every_row : bool
        One prediction per step instead of one per measurement: to see that it is the same.
    watch : function (k, n), called after step k of n

    Returns
    -------
    Track

    Raises
    ------
    ParameterError
        If `start` is neither of the two, or M or `batch` is not a whole number >= 1.
    DataError
        If nothing was measured, or a known start is asked of a log that does not know its own.
    """
    settings = settings or settings_for(log)
    if start not in ("known", "global"):
        raise ParameterError(f"start must be 'known' or 'global', got {start!r}")
    M = settings.M[start == "global"] if M is None else require_count("particles M", M)
    shape = (require_count("batch", batch), M)
    if start == "known":
        if log.start is None:
            raise DataError("the log does not know where it starts; use a global start")
        bel = gaussian_prior(shape, log.start, settings.start_sd, rng)
    else:
        bel = uniform_prior(shape, log.world, rng)
    steps = np.arange(len(log)) if every_row else informative_steps(log)
    short = preintegrate(log, settings.drift, steps)
    first = float(log.t[log.first_measured()])
    began = time.perf_counter()
    sensor, staged = settings.sensor, np.inf
    if start == "global" and not plain:
        sensor, staged = _with_outliers(sensor, log.world), settings.limit
    estimate, Sigma = _filter(short, bel, sensor, rng, staged, watch)
    seconds = time.perf_counter() - began
    estimate, sd = fill_in(log, settings.drift, np.append(0, steps + 1), estimate, Sigma)
    return Track(estimate, sd, first, seconds)


def _with_outliers(sensor: Sensor, world: LandmarkMap) -> Sensor:
    """The sensor, but a share of its measurements comes from anywhere on the map."""
    x0, x1, y0, y1 = world.bounds
    farthest = np.hypot(x1 - x0, y1 - y0)
    circle = 2 * np.pi if sensor.components == 3 else 1.0  # range alone has no bearing
    return OutlierMixture(sensor, OUTLIER_SHARE, 1 / (circle * farthest))


def _filter(
    log: Log,
    bel: Particles,
    sensor: Sensor,
    rng: np.random.Generator,
    staged: float,
    watch: Watch | None,
) -> tuple[Array, Array]:
    """Answers (3, T + 1, B) and covariances (3, 3, T + 1, B), from before the first step on."""
    motion = ComposedMotion()
    answers, spreads = [mean_pose(bel)], [covariance(bel)]
    for k, (_, u, z, _) in enumerate(log):
        bel = predict(bel, u, motion, rng)
        if z.shape[1]:
            bel = _weigh(bel, z, sensor, rng, staged)
        answers.append(mean_pose(bel))
        spreads.append(covariance(bel))
        if z.shape[1]:
            bel = resample(bel, systematic, rng, where=bel.ess < 0.5 * bel.M)
        if watch is not None:
            watch(k + 1, len(log))
    return np.stack(answers, axis=1), np.stack(spreads, axis=2)


def _weigh(
    bel: Particles, z: Array, sensor: Sensor, rng: np.random.Generator, staged: float
) -> Particles:
    """Weigh plainly; in stages those filters whose cloud is still wider than `staged` metres."""
    Sigma = covariance(bel)
    lost = Sigma[0, 0] + Sigma[1, 1] > staged**2
    if not lost.any():
        return update(bel, z, sensor)[0]
    return tempered_update(bel, z, sensor, rng, np.where(lost, 0.5, 0.0))[0]


class Score(NamedTuple):
    """Errors at the scored steps: metres and radians, one number per seed (B,)."""

    rmse: Array
    median: Array
    p95: Array
    heading_rmse: Array
    converged: Array


def scored_steps(log: Log, since: float = -np.inf) -> NDArray[np.bool_]:
    """Steps (T,) at which errors count: odometry stamps with a known truth, from `since` on."""
    if log.truth is None:
        return np.zeros(len(log), dtype=bool)
    known = np.isfinite(log.truth).all(axis=0) & (log.t >= since)
    return known if log.scored is None else known & log.scored


def score(log: Log, estimate: Array, limit: float, since: float = -np.inf) -> Score:
    """Compare estimates with the truth, at the odometry stamps where there is one.

    Parameters
    ----------
    log : Log
    estimate : array (3, T) or (3, T, B)
    limit : float, metres; `converged` is when the error falls below it for good (s, or inf)
    since : float, seconds; earlier steps do not count for the errors

    Returns
    -------
    Score

    Raises
    ------
    DataError
        If the log has no truth at any step that counts.
    """
    if log.truth is None or not scored_steps(log, since).any():
        raise DataError("the log has no truth at any step that is to be scored")
    known = scored_steps(log)
    error = pose_error(estimate[:, known], log.truth[:, known])
    distance = np.hypot(error[0], error[1])
    late = log.t[known] >= since
    return Score(
        np.sqrt(np.mean(distance[late] ** 2, axis=0)),
        np.median(distance[late], axis=0),
        np.percentile(distance[late], 95, axis=0),
        np.sqrt(np.mean(error[2][late] ** 2, axis=0)),
        np.asarray(settling_time(log.t[known], distance, limit)),
    )
