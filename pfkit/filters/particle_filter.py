r"""The particle filter: predict, update, resample.

The Bayes filter alternates two lines,

.. math:: \overline{bel}(x_t) = \int p(x_t \mid u_t, x_{t-1})\, bel(x_{t-1})\, dx_{t-1},
          \qquad bel(x_t) = \eta\, p(z_t \mid x_t)\, \overline{bel}(x_t) .

With particles each line becomes a loop body. *Predict* moves every particle by a draw from
the motion model. *Update* multiplies every weight by the likelihood of the measurement; the
sum of what results, before it is divided out, estimates the evidence
:math:`p(z_t \mid z_{1:t-1})`.
*Resample* turns weights into copies when too few particles carry the weight. It adds noise
and no information, so we do it only when the effective sample size says so, and never
without a measurement.

State and diagnostics are kept apart: `step` returns the new belief and an `Info`.
Everything works for one filter ``(D, M)`` and for B side by side ``(D, B, M)``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ParameterError, ShapeError, require_array
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import SensorModel, how_many
from pfkit.particles.particle_set import Particles, normalise
from pfkit.particles.resampling import Resampler, systematic
from pfkit.particles.triggers import Trigger, ess_below

Array = NDArray[np.float64]


class Info(NamedTuple):
    """What happened in one step.

    Attributes
    ----------
    log_evidence : float or (B,), log of the evidence; 0 without a measurement
    ess : float or (B,), effective sample size before any resampling
    resampled : bool or (B,)
    ancestors : int64 array (M,) or (B, M): which particle each one descends from
    """

    log_evidence: Array | np.float64
    ess: Array | np.float64
    resampled: NDArray[np.bool_] | np.bool_
    ancestors: NDArray[np.int64]


def predict(
    bel: Particles, u: ArrayLike, motion: MotionModel, rng: np.random.Generator
) -> Particles:
    r"""Move every particle by a draw from the motion model.

    .. math:: x_t^{[m]} \sim p(x_t \mid u_t, x_{t-1}^{[m]})

    Parameters
    ----------
    bel : Particles
    u : array_like (n,), the control, or (n, B, 1) with one per filter of a batch
    motion : MotionModel
    rng : numpy.random.Generator

    Returns
    -------
    Particles with the same weights

    Raises
    ------
    ParameterError, ShapeError
        If the belief, the control, the model or the generator is not one, or the model moves
        the particles to places that are not finite or not as many.

    Notes
    -----
    Source: Probabilistic Robotics, Table 4.3, line 4.
    """
    moved = motion.sample(bel.state, np.asarray(u, dtype=float), rng)
    return Particles.trusted(require_array("the moved state", moved, bel.state.shape), bel.log_w)


def update(
    bel: Particles, z: ArrayLike | None, sensor: SensorModel
) -> tuple[Particles, Array | np.float64]:
    r"""Weigh every particle by the likelihood of the measurement.

    .. math:: w_t^{[m]} = \eta\, p(z_t \mid x_t^{[m]})\, w_{t-1}^{[m]}

    Parameters
    ----------
    bel : Particles
    z : array_like (n, K), or None; no measurement leaves the belief as it is
    sensor : SensorModel

    Returns
    -------
    Particles
    log_evidence : float or (B,)
        :math:`\log \sum_m w_{t-1}^{[m]} p(z_t \mid x_t^{[m]})`.

    Raises
    ------
    DegenerateWeightsError
        If the measurement is impossible for every particle, or a likelihood is NaN.
    ShapeError
        If the sensor does not return one number per particle.
    ParameterError, DataError
        If the belief or the model is not one, or z is not made of numbers.

    Notes
    -----
    Source: Probabilistic Robotics, Table 4.3, line 5.
    """
    if how_many(z) == 0:
        return bel, np.zeros(bel.log_w.shape[:-1])[()]
    log_p = sensor.log_likelihood(np.asarray(z, dtype=float), bel.state)
    log_likelihood = require_array(
        "the log-likelihood of each particle", log_p, bel.log_w.shape, rule=None
    )
    log_w, log_evidence = normalise(bel.log_w + log_likelihood)
    return Particles.trusted(bel.state, log_w), log_evidence


def take(bel: Particles, ancestors: NDArray[np.int64]) -> Particles:
    """Copy the named ancestors into a set of equal weights.

    Parameters
    ----------
    bel : Particles
    ancestors : int array (n,) or (B, n)
        Index of the particle that each new one copies.

    Returns
    -------
    Particles with equal weights

    Raises
    ------
    ShapeError, ParameterError
        If the indices are not whole numbers from 0 to M - 1, or not in the belief's batch shape.
    """
    ancestors = np.asarray(ancestors)
    if ancestors.ndim != bel.log_w.ndim or ancestors.shape[:-1] != bel.log_w.shape[:-1]:
        raise ShapeError(
            f"ancestors must have shape (n,), or (B, n) for a batch, got {ancestors.shape} "
            f"for weights of shape {bel.log_w.shape}"
        )
    whole = ancestors.dtype.kind in "iu" and ancestors.size > 0
    if not whole or ancestors.min() < 0 or ancestors.max() >= bel.M:
        raise ParameterError(
            f"ancestors must be whole numbers from 0 to {bel.M - 1}, got {ancestors!r:.80}; "
            "a resampling scheme returns indices, not weights"
        )
    if bel.log_w.ndim == 1:
        state = np.take(bel.state, ancestors, axis=1)
    else:
        state = np.take_along_axis(bel.state, ancestors[None], axis=-1)
    return Particles.trusted(state, np.full(ancestors.shape, -math.log(ancestors.shape[-1])))


def resample(
    bel: Particles,
    scheme: Resampler,
    rng: np.random.Generator,
    n: int | None = None,
    where: ArrayLike = True,
) -> Particles:
    r"""Replace weights by copies: particle m appears N_m times, :math:`E[N_m] = n w_m`.

    Parameters
    ----------
    bel : Particles
    scheme : Resampler
        ``systematic``, ``stratified``, ``residual``, ``multinomial`` or a function of yours.
    rng : numpy.random.Generator
    n : int, optional
        New number of particles; as many as before if left out.
    where : bool or bool array (B,)
        The filters of a batch that are resampled; the others stay as they are.

    Returns
    -------
    Particles with equal weights, where resampled

    Raises
    ------
    ParameterError, ShapeError
        If an argument is not what it should be, or the scheme does not return n indices.

    Notes
    -----
    Source: Probabilistic Robotics, Table 4.3, lines 8 to 11.
    """
    n = bel.M if n is None else n
    if where is True:
        return take(bel, _draw(scheme, bel.w, rng, n))
    rows = np.broadcast_to(np.asarray(where, dtype=bool), bel.log_w.shape[:-1])
    if n != bel.M and not rows.all():
        raise ParameterError(f"filters side by side keep one size: n must be {bel.M}, got {n}")
    return _resampled(bel, scheme, rng, n, rows)[0]


def _resampled(
    bel: Particles, scheme: Resampler, rng: np.random.Generator, n: int, where: NDArray[np.bool_]
) -> tuple[Particles, NDArray[np.int64]]:
    """The belief after resampling some filters, and each particle's ancestor: its own elsewhere."""
    if where.all():
        ancestors = _draw(scheme, bel.w, rng, n)
        return take(bel, ancestors), ancestors
    own = np.broadcast_to(np.arange(n, dtype=np.int64), bel.log_w.shape)
    if not where.any():
        return bel, own
    ancestors = own.copy()
    ancestors[where] = _draw(scheme, bel.w[where], rng, n)
    copies = take(bel, ancestors)
    log_w = np.where(where[..., None], copies.log_w, bel.log_w)
    return Particles.trusted(copies.state, log_w), ancestors


def _draw(scheme: Resampler, w: Array, rng: np.random.Generator, n: int) -> NDArray[np.int64]:
    """Ancestors from a resampling scheme, which may be a student's own."""
    ancestors = scheme(w, rng, n)
    if np.shape(ancestors) != (*w.shape[:-1], n):
        raise ShapeError(
            f"the scheme must return indices of shape {(*w.shape[:-1], n)}, got "
            f"{np.shape(ancestors)}; one ancestor for each new particle"
        )
    return ancestors


def step(
    bel: Particles,
    u: ArrayLike,
    z: ArrayLike | None,
    motion: MotionModel,
    sensor: SensorModel,
    rng: np.random.Generator,
    scheme: Resampler = systematic,
    threshold: float | Trigger = 0.5,
    k: int = 0,
) -> tuple[Particles, Info]:
    """One turn of the filter: predict, update, resample if ESS < threshold * M.

    Parameters
    ----------
    bel, u, z, motion, sensor, rng, scheme
        As in `predict`, `update` and `resample`.
    threshold : float in [0, 1], or a function (bel, k) -> bool
        0 never resamples; 1 resamples after every informative measurement. For other rules see
        `triggers`.
    k : int
        Number of the step, for triggers that count.

    Returns
    -------
    Particles
    Info

    Raises
    ------
    ParameterError, ShapeError, DataError, DegenerateWeightsError
        As `predict`, `update` and `resample`.

    Notes
    -----
    In a batch only those filters resample whose own ESS is low.
    """
    trigger = threshold if callable(threshold) else ess_below(threshold)
    bel = predict(bel, u, motion, rng)
    bel, log_evidence = update(bel, z, sensor)
    ess = bel.ess
    poor = np.zeros(np.shape(ess), dtype=bool)
    if how_many(z) > 0:
        poor |= np.asarray(trigger(bel, k), dtype=bool)
    bel, ancestors = _resampled(bel, scheme, rng, bel.M, poor)
    return bel, Info(log_evidence, ess, poor[()], ancestors)
