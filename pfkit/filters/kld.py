r"""KLD-sampling: as many particles as the belief needs, and no more.

A robot that may be anywhere needs many thousands of particles. Once it knows where it is, a few
hundred do. How many? Lay a grid over the state and suppose that the belief covers k of its
cells. If n particles are drawn from it, the likelihood-ratio statistic says how far their shares
may stray, and

.. math:: n = \frac{k - 1}{2\epsilon} \Big(1 - \frac{2}{9(k-1)}
              + \sqrt{\frac{2}{9(k-1)}}\; z_{1-\delta}\Big)^3

particles keep the Kullback-Leibler divergence between shares and truth below :math:`\epsilon`
with probability :math:`1 - \delta`. Nobody knows k beforehand. So we draw one particle after
another, count the cells that are met, and stop when n is enough for the k so far.

The bound is about *drawing* from a known belief. It does not promise that the belief is right:
a cloud on the wrong spot occupies few cells too, and gets few particles.
"""

from __future__ import annotations

import math
from statistics import NormalDist

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ParameterError, require_array, require_count, require_number, whole_cells
from pfkit.filters.particle_filter import Info, predict, take, update
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import SensorModel, how_many
from pfkit.particles.particle_set import Particles
from pfkit.particles.resampling import multinomial

CELL = (0.5, 0.5, math.pi / 18)


def kld_bound(
    k: ArrayLike, epsilon: float = 0.05, delta: float = 0.01
) -> NDArray[np.int64] | np.int64:
    r"""How many particles a belief over k cells needs.

    .. math:: n = \Big\lceil \frac{\chi^2_{k-1, 1-\delta}}{2 \epsilon} \Big\rceil
              \quad\text{(Wilson and Hilferty's approximation)}

    Parameters
    ----------
    k : int or array_like of int, >= 1, occupied cells
    epsilon : float > 0, nats
        Divergence that is tolerated.
    delta : float in (0, 1)
        Probability of exceeding it that is tolerated.

    Returns
    -------
    int64 or int64 array of the shape of k; 1 for k = 1

    Raises
    ------
    ParameterError
        If a k is below 1, epsilon is not positive, or delta is not in (0, 1).

    Notes
    -----
    Source: Probabilistic Robotics, Table 8.4; D. Fox, IJRR 22 (2003).
    """
    k = require_array("k", k, rule="whole and >= 1")
    epsilon = require_number("epsilon", epsilon, "> 0")
    delta = require_number("delta", delta, "in (0, 1)")
    quantile = NormalDist().inv_cdf(1 - delta)
    more = np.maximum(k - 1, 1)
    spread = 2 / (9 * more)
    n = more / (2 * epsilon) * (1 - spread + np.sqrt(spread) * quantile) ** 3
    if n.max() > 2**62:
        raise ParameterError(f"{n.max():g} particles are too many; raise epsilon, got {epsilon:g}")
    return np.where(k > 1, np.maximum(np.ceil(n), 1), 1).astype(np.int64)[()]


def kld_count(
    state: ArrayLike,
    cell: ArrayLike = CELL,
    epsilon: float = 0.05,
    delta: float = 0.01,
    least: int = 100,
) -> int:
    """How many of the draws, taken in order, are enough.

    Parameters
    ----------
    state : array_like (D, n), draws from the belief in random order
    cell : array_like (D,), > 0
        Size of the cells that are counted: metres, metres, radians.
    epsilon, delta
        As in `kld_bound`.
    least : int
        Never stop before so many.

    Returns
    -------
    int, at most n

    Raises
    ------
    ShapeError, ParameterError
        If there is not one cell size > 0 for each component.
    """
    state = require_array("the state of one filter", state, ("D", "n"))
    cell = require_array("cell", cell, state.shape[:1], "finite and > 0")
    cells = whole_cells(state / cell[:, None])
    _, first = np.unique(cells, axis=1, return_index=True)
    met = np.zeros(state.shape[1], dtype=np.int64)
    met[first] = 1
    n = np.arange(1, met.size + 1)
    enough = (n >= kld_bound(np.cumsum(met), epsilon, delta)) & (n >= require_count("least", least))
    return int(np.argmax(enough)) + 1 if enough.any() else met.size


def kld_step(
    bel: Particles,
    u: ArrayLike,
    z: ArrayLike | None,
    motion: MotionModel,
    sensor: SensorModel,
    rng: np.random.Generator,
    cell: ArrayLike = CELL,
    epsilon: float = 0.05,
    delta: float = 0.01,
    least: int = 100,
    most: int = 20_000,
) -> tuple[Particles, Info]:
    """One turn of a filter whose number of particles adapts.

    Draw ancestors and move them until there are enough for the cells they meet; then weigh.

    Parameters
    ----------
    bel : Particles with state (D, M)
    u, z, motion, sensor, rng
        As in `step`.
    cell, epsilon, delta, least
        As in `kld_count`.
    most : int
        Never draw more than so many.

    Returns
    -------
    Particles, of a new size
    Info
        ``ancestors`` has the new size.

    Raises
    ------
    ParameterError, ShapeError, DataError, DegenerateWeightsError
        As `predict`, `update` and `kld_count`.

    Notes
    -----
    Source: Probabilistic Robotics, Table 8.4. Drawing and moving are cheap, so all `most` are
    drawn in one go and the surplus is dropped; what is saved is the weighing. Without a
    measurement there is nothing to adapt to: the cloud only moves, at its present size.
    """
    if how_many(z) == 0:
        moved, ancestors = predict(bel, u, motion, rng), np.arange(bel.M, dtype=np.int64)
        return moved, Info(np.float64(0.0), moved.ess, np.False_, ancestors)
    drawn = rng.permutation(multinomial(bel.w, rng, most))
    moved = predict(take(bel, drawn), u, motion, rng)
    n = kld_count(moved.state, cell, epsilon, delta, least)
    ancestors = drawn[:n]
    kept = Particles(moved.state[:, :n], np.full(n, -math.log(n)))
    kept, log_evidence = update(kept, z, sensor)
    return kept, Info(log_evidence, kept.ess, np.True_, ancestors)
