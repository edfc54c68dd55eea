r"""History: what a filter said along a whole log.

A filter turns one belief into the next. To judge it we need all its answers: the estimate and
its covariance after each step, the effective sample size before any resampling, the evidence,
and the truth to hold them against. `run` drives a filter along a log and keeps exactly that.

It does not keep the clouds: a thousand steps of a thousand particles are 24 MB. Who wants to
see them passes a function as `watch`, which is called after each step and may keep what it
likes: every tenth cloud for a film, the ancestors for a family tree (`genealogy`), a line
on the screen for progress.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from pfkit.filters.particle_filter import Info, step
from pfkit.filters.recovery import Memory, replaced
from pfkit.filters.tempering import tempered_step
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import SensorModel, how_many
from pfkit.particles.estimators import covariance, mean_pose
from pfkit.particles.particle_set import Particles
from pfkit.particles.priors import SamplesPoses
from pfkit.particles.resampling import Resampler, systematic
from pfkit.particles.triggers import Trigger
from pfkit.worlds.log import Log

Array = NDArray[np.float64]


@dataclass(frozen=True)
class History:
    """What a filter said along a log.

    Parameters
    ----------
    t : array (T,), seconds
    estimate : array (D, T) or (D, T, B), the mean pose after each step
    covariance : array (D, D, T) or (D, D, T, B)
    ess : array (T,) or (T, B), before any resampling
    log_evidence : array (T,) or (T, B)
    resampled : bool array (T,) or (T, B)
    truth : array (3, T) or (3, T, B), or None
    bel : Particles, the last belief
    """

    t: Array
    estimate: Array
    covariance: Array
    ess: Array
    log_evidence: Array
    resampled: NDArray[np.bool_]
    truth: Array | None
    bel: Particles

    @property
    def position_sd(self) -> Array:
        """Root of the summed position variances, metres: (T,) or (T, B)."""
        return np.sqrt(self.covariance[0, 0] + self.covariance[1, 1])

    def __repr__(self) -> str:
        return f"History({len(self.t)} steps, resampled {int(np.sum(self.resampled))} times)"


def run(
    log: Log,
    bel: Particles,
    motion: MotionModel,
    sensor: SensorModel,
    rng: np.random.Generator,
    scheme: Resampler = systematic,
    threshold: float | Trigger = 0.5,
    watch: Callable[[int, Particles, Info], object] | None = None,
    temper: float = 0.0,
    recover: SamplesPoses | None = None,
) -> History:
    """Run the filter along a log.

    Parameters
    ----------
    log : Log
    bel : Particles, the belief before the first control
    motion, sensor, rng, scheme, threshold
        As in `step`.
    watch : function (k, bel, info), optional
        Called after each step: for progress, film, or genealogy.
    temper : float in [0, 1]
        Weigh in stages that each keep this share of M as effective sample size
        (`tempered_update`); 0 weighs plainly.
    recover : LandmarkMap or OccupancyGrid, optional
        Replace a share of the particles by new ones from this map when measurements become less
        likely than they used to be (augmented MCL, see `recovery`).

    Returns
    -------
    History

    Raises
    ------
    ParameterError, ShapeError, DataError, DegenerateWeightsError
        As `step`.
    """
    T, D, batch = len(log), bel.state.shape[0], bel.log_w.shape[:-1]
    estimate, spread = np.empty((D, T, *batch)), np.empty((D, D, T, *batch))
    ess, log_evidence = np.empty((T, *batch)), np.empty((T, *batch))
    resampled = np.zeros((T, *batch), dtype=bool)
    memory = Memory()
    for k, (_, u, z, _) in enumerate(log):
        if temper == 0:
            bel, info = step(bel, u, z, motion, sensor, rng, scheme, threshold, k)
        else:
            bel, info = tempered_step(bel, u, z, motion, sensor, rng, temper, scheme, threshold, k)
        if recover is not None and how_many(z) > 0:
            memory = memory.remember(info.log_evidence, how_many(z))
            bel, info = replaced(bel, info, memory.share, recover, rng, scheme)
        log_evidence[k], ess[k], resampled[k] = info.log_evidence, info.ess, info.resampled
        estimate[:, k], spread[:, :, k] = mean_pose(bel), covariance(bel)
        if watch is not None:
            watch(k, bel, info)
    truth = log.truth
    if truth is not None and batch and truth.ndim == 4:
        truth = truth[..., 0]
    return History(log.t, estimate, spread, ess, log_evidence, resampled, truth, bel)
