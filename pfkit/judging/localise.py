"""Localise a recorded robot: one call, an honest score.

Everything is put together here: compose the odometry between measurements, start from a known pose
or from anywhere on the map, run the filter, carry its answers on to every odometry stamp, compare
with the truth. What the filter assumes of a log is chosen in `settings`.

A global start needs two things more; they were chosen on variants of an MRCLAM log with other
starts, fewer landmarks and false measurements. The first measurement may be false, and a cloud that
gathers around it is lost; so one measurement in a thousand may come from anywhere
(`OutlierMixture`), which keeps a few particles elsewhere. A larger share would doubt true
measurements, too, and be slow where landmarks are few. And a wide cloud is weighed in stages
(`tempered_update`), a narrow one plainly: a cloud that has found the robot must not walk after
a false measurement.

Scans of a laser need thinning first. Thirty beams tell nearly as much as three hundred, and are
thirty witnesses, not three hundred; a scan from the same spot as the last one tells nothing new at
all, and a filter that believes it again and again becomes certain of whatever it believed. Beams
are cast for every particle, which is slow; so a laser's global start goes on with fewer particles,
those of a known start, as soon as the cloud is narrow.

In a symmetric world no single answer is honest. The track then comes with `Hypotheses`: heaps of
particles with the share of the weight of each, wherever there is more than one.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, ParameterError, require_array
from pfkit.filters.particle_filter import predict, resample, update
from pfkit.filters.recovery import Memory, inject
from pfkit.filters.tempering import tempered_update
from pfkit.judging.diagnostics import pose_error, settling_time
from pfkit.judging.settings import Settings, calibrate_first, rig_of, settings_for
from pfkit.judging.study import Progress, silent
from pfkit.logs.odometry import (
    ComposedMotion,
    Drift,
    Preintegrated,
    fill_in,
    informative_steps,
    preintegrate,
)
from pfkit.models.robust import OutlierMixture
from pfkit.models.sensors import Sensor
from pfkit.particles.estimators import covariance, mean_pose
from pfkit.particles.modes import clusters
from pfkit.particles.particle_set import Particles
from pfkit.particles.priors import gaussian_prior, uniform_prior
from pfkit.particles.resampling import systematic
from pfkit.worlds.log import Log

__all__ = [
    "Hypotheses",
    "Score",
    "Settings",
    "Track",
    "calibrate_first",
    "localise",
    "score",
    "scored_steps",
    "settings_for",
    "thinned",
]

Array = NDArray[np.float64]
OUTLIER_SHARE = 0.001  # of the measurements of a global start: may come from anywhere
BEAMS = 30  # of a scan
SPACING = 0.1  # metres or radians that the robot moves before it looks again
LOOKS = 50  # how often along a log hypotheses are counted
LEAST_MASS = 0.05  # of a hypothesis


class Hypotheses(NamedTuple):
    """Where the robot may be, at the instants at which there was more than one answer.

    Attributes
    ----------
    t : array (n,), seconds, one entry per hypothesis
    mass : array (n,), its share of the weight
    mean : array (3, n), its mean pose
    """

    t: Array
    mass: Array
    mean: Array


class Track(NamedTuple):
    """What the filter said at every step of the log.

    Attributes
    ----------
    estimate : array (3, T, B), metres and radians, for B seeds
    sd : array (T, B), metres: root of the summed position variances
    first : float, seconds, the time of the first measurement
    seconds : float, how long the filter took (all B together)
    hypotheses : Hypotheses of the first seed
    """

    estimate: Array
    sd: Array
    first: float
    seconds: float
    hypotheses: Hypotheses


def localise(
    log: Log,
    rng: np.random.Generator,
    start: str | ArrayLike = "known",
    M: int | None = None,
    batch: int = 1,
    settings: Settings | None = None,
    plain: bool = False,
    every_row: bool = False,
    progress: Progress = silent,
    recover: bool = False,
) -> Track:
    """Run the filter along a recorded log.

    Parameters
    ----------
    log : Log with a rig, already calibrated if it is to be
    rng : numpy.random.Generator
    start : "known" (the truth before the first command), "global" (anywhere on the map), or (3,)
        A pose is where the robot starts, to within the settings' `start_sd`.
    M : int, optional; particles, from the settings if left out
    batch : int, how many filters run side by side
    settings : Settings, optional; `settings_for` the log if left out
    plain : bool
        Weigh plainly from a global start, too, and believe every measurement: to see what happens.
    every_row : bool
        One prediction per step instead of one per measurement: to see that it is the same.
    progress : function (iterable, total=n) -> iterable
        What the steps pass through, such as `tqdm`, which draws a bar.
    recover : bool
        Replace a share of the particles by new ones, anywhere on the map, whenever measurements
        become less likely than they used to be (augmented MCL): for robots that are carried off.

    Returns
    -------
    Track

    Raises
    ------
    ParameterError
        If `start` is none of the three, or M or `batch` is not a whole number >= 1.
    DataError
        If nothing was measured, or a known start is asked of a log that does not know its own.
    """
    settings = settings or settings_for(log)
    everywhere = isinstance(start, str) and start == "global"
    M = settings.M[everywhere] if M is None else M
    shape = (batch, M)
    bel = (
        uniform_prior(shape, log.world, rng)
        if everywhere
        else gaussian_prior(shape, _start(log, start), settings.start_sd, rng)
    )
    looked = thinned(log, settings.drift) if rig_of(log).sensor == "laser" else log
    steps = np.arange(len(log)) if every_row else informative_steps(looked)
    short = preintegrate(looked, settings.drift, steps)
    first = float(log.t[looked.first_measured()])
    began = time.perf_counter()
    sensor, staged = settings.sensor, math.inf
    if (everywhere or recover) and not plain:
        sensor, staged = _with_outliers(log, sensor), settings.limit
    few = settings.M[0] if looked is not log and M > settings.M[0] else M
    world = log.world if recover else None
    estimate, Sigma, found = _filter(
        short, bel, sensor, rng, staged, settings.limit, few, world, progress
    )
    seconds = time.perf_counter() - began
    estimate, sd = fill_in(log, settings.drift, np.append(0, steps + 1), estimate, Sigma)
    return Track(estimate, sd, first, seconds, found)


def _start(log: Log, start: str | ArrayLike) -> Array:
    """The pose that a start which is not global means."""
    if not isinstance(start, str):
        return require_array("start", start, (3,))
    if start != "known":
        raise ParameterError(f"start must be 'known', 'global' or a pose (3,), got {start!r}")
    if log.start is None:
        raise DataError(
            "the log does not know where it starts; use a global start, or name a pose "
            "(--start global, --pose x,y,theta)"
        )
    return log.start


def thinned(log: Log, drift: Drift) -> Log:
    """A laser's log with scans only where the robot has moved, and few beams in each.

    Beams that met nothing are dropped before the others are thinned, so that a scan with few good
    ones keeps them all.

    Parameters
    ----------
    log : Log of a laser
    drift : Drift
    """
    path, r_max = Preintegrated.of(log, drift).path[:, 1:], rig_of(log).r_max
    z, last = [], None
    for k, zk in enumerate(log.z):
        good = (zk[0] > 0) & (zk[0] < r_max)
        if good.any() and (last is None or _moved(path[:, last], path[:, k])):
            kept = np.flatnonzero(good)
            if kept.size > BEAMS:
                kept = kept[np.linspace(0, kept.size - 1, BEAMS).round().astype(np.int64)]
            z.append(zk[:, kept])
            last = k
        else:
            z.append(zk[:, :0])
    return replace(log, z=z, outlier=None)


def _moved(before: Array, now: Array) -> bool:
    x, y, theta = now - before
    return bool(math.hypot(x, y) > SPACING or abs(math.remainder(theta, 2 * math.pi)) > SPACING)


def _with_outliers(log: Log, sensor: Sensor) -> Sensor:
    """The sensor, but a share of its measurements comes from anywhere on the map."""
    rig = rig_of(log)
    if rig.sensor == "laser":
        return sensor  # its model has a share of unexplained readings
    x0, x1, y0, y1 = log.world.bounds
    farthest = np.hypot(x1 - x0, y1 - y0) if "range" in rig.rows else 1.0
    circle = 2 * np.pi if "bearing" in rig.rows else 1.0
    return OutlierMixture(sensor, OUTLIER_SHARE, 1 / (circle * farthest))


def _filter(
    log: Log,
    bel: Particles,
    sensor: Sensor,
    rng: np.random.Generator,
    staged: float,
    limit: float,
    few: int,
    world: object | None,
    progress: Progress,
) -> tuple[Array, Array, Hypotheses]:
    """Answers (3, T + 1, B), covariances (3, 3, T + 1, B), from before the first step on."""
    motion, memory = ComposedMotion(), Memory()
    answers, spreads = [mean_pose(bel)], [covariance(bel)]
    found: list[tuple[float, float, Array]] = []
    pause = max(1, len(log) // LOOKS)
    for k, (t, u, z, _) in enumerate(progress(log, total=len(log))):
        bel = predict(bel, u, motion, rng)
        if z.shape[1]:
            if world is not None:
                memory = memory.remember(update(bel, z, sensor)[1], z.shape[1])
            bel = _weigh(bel, z, sensor, rng, staged)
        answers.append(mean_pose(bel))
        spreads.append(covariance(bel))
        if (k + 1) % pause == 0 or k + 1 == len(log):
            found += _heaps(t, bel, spreads[-1], limit)
        if z.shape[1]:
            share = memory.share * np.ones(bel.log_w.shape[:-1])
            bel = resample(bel, systematic, rng, where=(bel.ess < 0.5 * bel.M) | (share > 0))
            if few < bel.M and (spreads[-1][0, 0] + spreads[-1][1, 1] < limit**2 / 4).all():
                bel = resample(bel, systematic, rng, n=few)
            if world is not None:
                bel, _ = inject(bel, share, world.sample_poses, rng)  # type: ignore[attr-defined]
    heaps = Hypotheses(
        np.array([t for t, _, _ in found]),
        np.array([mass for _, mass, _ in found]),
        np.array([mean for _, _, mean in found]).reshape(-1, 3).T,
    )
    return np.stack(answers, axis=1), np.stack(spreads, axis=2), heaps


def _weigh(
    bel: Particles, z: Array, sensor: Sensor, rng: np.random.Generator, staged: float
) -> Particles:
    """Weigh plainly; in stages those filters whose cloud is still wider than `staged` metres."""
    Sigma = covariance(bel)
    lost = Sigma[0, 0] + Sigma[1, 1] > staged**2
    if not lost.any():
        return update(bel, z, sensor)[0]
    return tempered_update(bel, z, sensor, rng, np.where(lost, 0.5, 0.0))[0]


def _heaps(
    t: float, bel: Particles, Sigma: Array, limit: float
) -> list[tuple[float, float, Array]]:
    """The hypotheses of the first filter, if there is more than one."""
    if Sigma[0, 0, 0] + Sigma[1, 1, 0] < limit**2 / 4:
        return []
    first = Particles.trusted(bel.state[:, 0], bel.log_w[0])
    heaps = clusters(first, (2 * limit, 2 * limit, math.pi / 4))
    heavy = heaps.mass >= LEAST_MASS
    if heavy.sum() < 2:
        return []
    return [(t, float(m), x) for m, x in zip(heaps.mass[heavy], heaps.mean.T[heavy], strict=True)]


class Score(NamedTuple):
    """Errors at the scored steps: metres and radians, one number per seed (B,).

    The heading's is NaN where the truth has none.
    """

    rmse: Array
    median: Array
    p95: Array
    heading_rmse: Array
    converged: Array


def scored_steps(log: Log, since: float = -np.inf) -> NDArray[np.bool_]:
    """Steps (T,) at which errors count: odometry stamps with a known truth, from `since` on."""
    if log.truth is None:
        return np.zeros(len(log), dtype=bool)
    known = np.isfinite(log.truth[:2]).all(axis=0) & (log.t >= since)
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
    looks = late & np.isfinite(log.truth[2, known])
    heading = np.full(distance.shape[1:], np.nan)
    if looks.any():
        heading = np.sqrt(np.mean(error[2][looks] ** 2, axis=0))
    return Score(
        np.sqrt(np.mean(distance[late] ** 2, axis=0)),
        np.median(distance[late], axis=0),
        np.percentile(distance[late], 95, axis=0),
        heading,
        np.asarray(settling_time(log.t[known], distance, limit)),
    )
