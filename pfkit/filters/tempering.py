r"""Staged tempering: believe a sharp measurement step by step.

A cloud that is spread over a whole arena meets a measurement good to a few centimetres and a
degree. Perhaps five of its five thousand particles are near enough to count. Plain weighting
keeps these five, whatever else is wrong with them, and resampling makes a thousand copies of
each: from here on the filter is sure, and often sure of the wrong place.

Tempering lets the measurement in by degrees. The likelihood is raised to a small power first,

.. math:: p_\beta(x) \propto bel(x)\, p(z \mid x)^\beta, \qquad 0 = \beta_0 < \beta_1 < \dots < 1,

and each stage takes the largest step that leaves an effective sample size of at least half of M.
Between two stages the survivors are resampled, and every copy is moved by a kernel of 0.3
times the cloud's own spread, so that copies become neighbours which the next stage can tell
apart. The cloud walks towards the measurement instead of being cut down by it. When a
measurement would leave enough particles anyway, there is one stage and nothing is moved:
tempering costs nothing once the robot is found.

The kernel makes the belief a little wider than Bayes' rule allows - between a posterior and a
guess we err towards doubt. It shrinks with the cloud. The scheme is that of annealed particle
filters (J. Deutscher, A. Blake and I. Reid, CVPR 2000) with the adaptive stages of SMC samplers
(P. Del Moral, A. Doucet and A. Jasra, Statistics and Computing 22, 2012).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import require_array
from pfkit.filters.particle_filter import Info, _resampled, predict, take, update
from pfkit.geometry import wrap
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import SensorModel, how_many
from pfkit.particles.estimators import covariance
from pfkit.particles.particle_set import Particles, ess, normalise
from pfkit.particles.resampling import Resampler, systematic
from pfkit.particles.triggers import Trigger, ess_below

Array = NDArray[np.float64]
CLOSE = 0.1  # the next exponent is sought to a tenth of itself
SMALLEST = 1e-4  # the least step of the exponent: at most ten thousand stages, in fact ten


def tempered_update(
    bel: Particles,
    z: ArrayLike | None,
    sensor: SensorModel,
    rng: np.random.Generator,
    keep: ArrayLike = 0.5,
    kernel: float = 0.3,
    scheme: Resampler = systematic,
) -> tuple[Particles, NDArray[np.int64]]:
    r"""Weigh by a measurement in stages that each keep ESS >= keep * M.

    .. math:: w \leftarrow w\, p(z \mid x)^{\beta_{s} - \beta_{s-1}}, \qquad
              x \leftarrow x + \mathcal N(0,\, \rho^2\, \mathrm{Cov}(bel))

    Parameters
    ----------
    bel : Particles, poses (3, M) or (3, B, M)
    z : array_like (n, K), or None for no measurement
    sensor : SensorModel
    rng : numpy.random.Generator
    keep : float in [0, 1], or array_like (B,), one for each filter of a batch
        The share of M that the effective sample size must keep in a stage; 0 is plain weighting.
    kernel : float >= 0
        The kernel's width rho, in units of the cloud's own spread.
    scheme : Resampler

    Returns
    -------
    Particles, weighted: resample them as after any update
    stages : int64 array, () or (B,); 1 where plain weighting was good enough

    Raises
    ------
    ParameterError, DegenerateWeightsError
        If an argument is not what it should be, or the measurement is impossible for all
        particles.
    """
    filters = bel.log_w.shape[:-1]
    keep = require_array("keep", keep, filters if np.ndim(keep) else (), "in [0, 1]")
    stages = np.zeros(filters, dtype=np.int64)
    if how_many(z) == 0:
        return bel, stages
    z, left = np.asarray(z, dtype=float), np.ones(filters)
    while True:
        log_p = sensor.log_likelihood(z, bel.state)
        step = _largest_step(bel.log_w, log_p, keep * bel.M, left)
        stages = stages + (left > 0)
        left = left - step
        bel = Particles(bel.state, normalise(bel.log_w + step[..., None] * log_p)[0])
        if not (left > 0).any():
            return bel, stages
        bel = _spread_out(bel, left > 0, kernel, scheme, rng)


def tempered_step(
    bel: Particles,
    u: ArrayLike,
    z: ArrayLike | None,
    motion: MotionModel,
    sensor: SensorModel,
    rng: np.random.Generator,
    keep: ArrayLike = 0.5,
    scheme: Resampler = systematic,
    threshold: float | Trigger = 0.5,
    k: int = 0,
) -> tuple[Particles, Info]:
    """One turn of the filter that weighs in stages: as `step`, with `tempered_update` inside.

    Parameters
    ----------
    bel, u, z, motion, sensor, rng, scheme, threshold, k
        As in `step`.
    keep : float in [0, 1] or (B,), as in `tempered_update`

    Returns
    -------
    Particles
    Info
        Its log evidence is that of plain weighting; what the stages moved has no ancestor that a
        family tree could use.
    """
    trigger = threshold if callable(threshold) else ess_below(threshold)
    bel = predict(bel, u, motion, rng)
    _, log_evidence = update(bel, z, sensor)
    bel, _ = tempered_update(bel, z, sensor, rng, keep, scheme=scheme)
    ess = bel.ess
    poor = np.zeros(np.shape(ess), dtype=bool)
    if how_many(z) > 0:
        poor |= np.asarray(trigger(bel, k), dtype=bool)
    bel, ancestors = _resampled(bel, scheme, rng, bel.M, poor)
    return bel, Info(log_evidence, ess, poor[()], ancestors)


def _largest_step(log_w: Array, log_p: Array, wanted: Array, left: Array) -> Array:
    """The largest exponent <= left that keeps ESS >= wanted, per filter, to a tenth of itself."""
    log_p = log_p - log_p.max(axis=-1, keepdims=True)
    low, high, middle = np.zeros_like(left), left, left
    while (high - low > np.maximum(CLOSE * high, SMALLEST)).any():
        enough = ess(normalise(log_w + middle[..., None] * log_p)[0]) >= wanted
        low, high = np.where(enough, middle, low), np.where(enough, high, middle)
        middle = (low + high) / 2
    return np.minimum(np.maximum(low, SMALLEST), left)


def _spread_out(
    bel: Particles, where: NDArray, kernel: float, scheme: Resampler, rng: np.random.Generator
) -> Particles:
    """Resample the filters named by `where` and move each copy by the kernel."""
    values, vectors = np.linalg.eigh(np.moveaxis(covariance(bel), (0, 1), (-2, -1)))
    root = vectors * np.sqrt(np.maximum(values, 0.0))[..., None, :]
    moved = take(bel, scheme(bel.w, rng))
    noise = kernel * np.einsum("...ij,j...m->i...m", root, draw_normal(bel.state.shape, rng))
    state = moved.state + noise
    state[2] = wrap(state[2])
    keep = where[..., None]
    return Particles(np.where(keep, state, bel.state), np.where(keep, moved.log_w, bel.log_w))
