r"""Augmented Monte Carlo localisation: notice that the robot is lost, and start afresh.

Somebody carries the robot to another room. No particle is there, and none will ever come:
resampling copies only what exists. But the filter can notice, because its measurements become
improbable. The evidence of each step is the mean likelihood of the particles. Keep two running
means of it, one slow and one fast,

.. math:: w_{slow} \mathrel{+}= \alpha_{slow} (w - w_{slow}), \qquad
          w_{fast} \mathrel{+}= \alpha_{fast} (w - w_{fast}),

and when the recent past is worse than the long run, replace that share of the particles,

.. math:: p = \max(0,\; 1 - w_{fast} / w_{slow}),

by new ones: drawn over the map's free space, or where the present measurement could have been
taken. A filter that is at home replaces hardly any. One caution: a wall of outliers looks
exactly like being lost.

The evidence spans many powers of ten, so the means are kept as logarithms; and it depends on
how many measurements came at once, so we take the geometric mean of the K of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import DataError, ParameterError, Shape, require_array, require_count
from pfkit.filters.particle_filter import Info, _resampled, step
from pfkit.geometry import wrap
from pfkit.models.landmark_sensors import RangeBearing
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import SensorModel, how_many
from pfkit.particles.particle_set import Particles
from pfkit.particles.priors import SamplesPoses
from pfkit.particles.resampling import Resampler, systematic

Array = NDArray[np.float64]


class Memory(NamedTuple):
    """What the filter remembers of its evidence; numbers, or arrays (B,) for a batch.

    Attributes
    ----------
    log_slow, log_fast : logarithms of the two running means; -inf before any measurement
    """

    log_slow: ArrayLike = -math.inf
    log_fast: ArrayLike = -math.inf

    def remember(
        self, log_evidence: ArrayLike, K: int = 1, alpha_slow: float = 0.02, alpha_fast: float = 0.3
    ) -> Memory:
        r"""Fold in the evidence of one step.

        .. math:: w_{slow} \leftarrow (1 - \alpha_{slow}) w_{slow} + \alpha_{slow}\, e^{\ell / K}

        Parameters
        ----------
        log_evidence : float or (B,), the sum over K measurements
        K : int
        alpha_slow, alpha_fast : float, 0 < alpha_slow < alpha_fast < 1
            Memory of about 1 / alpha measurements.

        Returns
        -------
        Memory

        Raises
        ------
        ParameterError
            If the rates are not in that order, or K is not a whole number >= 1.
        """
        if not 0 < alpha_slow < alpha_fast < 1:
            raise ParameterError(
                f"rates must obey 0 < alpha_slow < alpha_fast < 1, got {alpha_slow}, {alpha_fast}"
            )
        log_mean = require_array("log_evidence", log_evidence) / require_count("K", K)
        log_slow, log_fast = (
            np.logaddexp(math.log1p(-alpha) + np.asarray(past), math.log(alpha) + log_mean)
            for alpha, past in ((alpha_slow, self.log_slow), (alpha_fast, self.log_fast))
        )
        return Memory(log_slow, log_fast)

    @property
    def share(self) -> Array:
        r"""Share of particles to replace: :math:`\max(0, 1 - w_{fast}/w_{slow})`."""
        log_slow, log_fast = np.asarray(self.log_slow), np.asarray(self.log_fast)
        worse = log_fast < log_slow  # false before any measurement, when both are -inf
        fall = np.subtract(log_fast, log_slow, out=np.zeros(worse.shape), where=worse)
        return -np.expm1(fall)


def inject(
    bel: Particles,
    share: ArrayLike,
    draw: Callable[[Shape, np.random.Generator], Array],
    rng: np.random.Generator,
) -> tuple[Particles, NDArray[np.bool_]]:
    """Replace each particle by a new one with a given probability; weights stay.

    Parameters
    ----------
    bel : Particles, best just resampled: a new particle gets the weight of the one it replaces
    share : float or (B,), in [0, 1]
    draw : function (shape, rng) -> states (D, ...), for example ``world.sample_poses``
    rng : numpy.random.Generator

    Returns
    -------
    Particles
    new : bool array (M,) or (B, M), which ones were replaced

    Raises
    ------
    ParameterError, ShapeError
        If the share is not in [0, 1], or not one number or one per filter, or draw does not
        return as many states as there are particles.
    """
    filters = bel.log_w.shape[:-1] if np.ndim(share) else ()
    share = require_array("share", share, filters, "in [0, 1]")
    new = rng.random(bel.log_w.shape) < share[..., None]
    if not new.any():
        return bel, new
    fresh = require_array("drawn states", draw(bel.log_w.shape, rng), bel.state.shape)
    return Particles(np.where(new, fresh, bel.state), bel.log_w), new


def poses_seeing(z: ArrayLike, sensor: RangeBearing, M: Shape, rng: np.random.Generator) -> Array:
    r"""Draw poses from which a range and bearing could have been measured: a ring.

    .. math:: \hat r &= r + \mathcal N(0, \sigma_r^2), \quad
              \hat\phi = \phi + \mathcal N(0, \sigma_\phi^2), \quad
              \gamma \sim \mathcal U(0, 2\pi), \\
              x &= m_x + \hat r\cos\gamma, \quad y = m_y + \hat r\sin\gamma, \quad
              \theta = \gamma - \pi - \hat\phi

    Parameters
    ----------
    z : array_like (3, K) or (3, K, B, 1); one of the K columns is chosen by lot
    sensor : RangeBearing, or a wrapper of one
    M : int or (B, M), how many poses
    rng : numpy.random.Generator

    Returns
    -------
    array (3, M) or (3, B, M), metres and radians

    Raises
    ------
    ShapeError, DataError, ParameterError
        If z does not fit the sensor, or nothing was measured.

    Notes
    -----
    Source: Probabilistic Robotics, Table 6.5. It knows no walls: a pose may lie in one.
    """
    z = require_array("z", z, (3, "K", ...), error=DataError)
    while hasattr(sensor, "sensor"):  # an honest measurement is what the wrapped sensor makes
        sensor = sensor.sensor
    r, phi, s = z[:, rng.integers(z.shape[1])]
    r = np.abs(r + sensor.sigma_r * draw_normal(M, rng))
    phi = phi - sensor.bias_phi + sensor.sigma_phi * draw_normal(M, rng)
    gamma = 2 * np.pi * rng.random(M)
    mx, my = sensor.world.locate(s)
    return np.stack((mx + r * np.cos(gamma), my + r * np.sin(gamma), wrap(gamma - np.pi - phi)))


def replaced(
    bel: Particles,
    info: Info,
    share: ArrayLike,
    world: SamplesPoses,
    rng: np.random.Generator,
    scheme: Resampler = systematic,
) -> tuple[Particles, Info]:
    """Replace a share of the particles by poses from a map; filters with a share resample first.

    Parameters
    ----------
    bel : Particles, as a step left them
    info : Info of that step
    share : float or (B,), in [0, 1]
    world : LandmarkMap or OccupancyGrid
    rng : numpy.random.Generator
    scheme : Resampler

    Returns
    -------
    Particles
    Info, in which a replaced particle has ancestor -1
    """
    where = (np.asarray(share) > 0) & ~np.asarray(info.resampled)
    if not np.any(np.asarray(share) > 0):
        return bel, info
    bel, ancestors = _resampled(bel, scheme, rng, bel.M, np.broadcast_to(where, bel.ess.shape))
    bel, new = inject(bel, share, world.sample_poses, rng)
    ancestors = np.take_along_axis(info.ancestors, ancestors, axis=-1)
    resampled = np.asarray(info.resampled) | where
    ancestors = np.where(new, -1, ancestors)
    return bel, info._replace(resampled=resampled[()], ancestors=ancestors)


def augmented_step(
    bel: Particles,
    memory: Memory,
    u: ArrayLike,
    z: ArrayLike | None,
    motion: MotionModel,
    sensor: SensorModel,
    rng: np.random.Generator,
    world: SamplesPoses | None = None,
    scheme: Resampler = systematic,
    alpha_slow: float = 0.02,
    alpha_fast: float = 0.3,
) -> tuple[Particles, Memory, Info]:
    """One turn of augmented MCL: predict, update, resample, replace a share.

    Parameters
    ----------
    bel, u, z, motion, sensor, rng, scheme
        As in `step`.
    memory : Memory, ``Memory()`` at the start
    world : LandmarkMap or OccupancyGrid, optional
        New particles are drawn over its free space. Without it they are drawn where the
        measurement could have been taken (`poses_seeing`; needs a `RangeBearing` sensor).
    alpha_slow, alpha_fast : float, 0 < alpha_slow < alpha_fast < 1

    Returns
    -------
    Particles
    Memory
    Info
        A replaced particle has ancestor -1.

    Raises
    ------
    ParameterError, ShapeError, DataError, DegenerateWeightsError
        As `step`, `Memory.remember` and `poses_seeing`.

    Notes
    -----
    Source: Probabilistic Robotics, Table 8.3. Like the table it resamples at each measurement.
    """
    K = how_many(z)

    def ring(shape: Shape, rng: np.random.Generator) -> Array:
        return poses_seeing(z, sensor, shape, rng)  # type: ignore[arg-type]

    draw = ring if world is None else world.sample_poses
    bel, info = step(bel, u, z, motion, sensor, rng, scheme, threshold=1.0)
    if K == 0:
        return bel, memory, info
    memory = memory.remember(info.log_evidence, K, alpha_slow, alpha_fast)

    bel, new = inject(bel, memory.share, draw, rng)
    return bel, memory, info._replace(ancestors=np.where(new, -1, info.ancestors))
