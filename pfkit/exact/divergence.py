r"""How far is the cloud from the truth about the truth?

A grid filter with fine enough cells knows the exact posterior p. A cloud of particles stands
for a density q. The Kullback-Leibler divergence

.. math:: \mathrm{KL}(q \,\|\, p) = \int q(x) \log \frac{q(x)}{p(x)}\, dx \ge 0

says in nats how far off the cloud is, and turns "looks converged" into a number. Its direction
matters. This one asks about the places where the *particles* are: a cloud that holds one of
four equal modes is off by log 4 = 1.39 nats. (The other direction would be infinite.)

Neither density can be read off M points, so we count. Cut the space into boxes that each hold
about the same mass of p, and compare shares:

.. math:: \widehat{\mathrm{KL}} = \sum_c \hat q_c \log \frac{\hat q_c}{p_c}
          - \frac{C_+ - 1}{2 n},

where the last term removes most of the bias that counting n points into C_+ boxes brings. What
the boxes do not resolve is not seen: the number is a lower bound and cannot exceed about log C.
The interval treats the particles as n = ESS independent draws. After many resamplings they are
fewer than that, and a cloud of copies shows up as the divergence it is.

And the grid itself? It earns the name oracle only when halving its cells no longer moves its
answer. `refinement` says, in nats too, how far halving them moved it.
"""

from __future__ import annotations

import heapq
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import ShapeError, require_array, require_count
from pfkit.exact.posegrid import PoseGrid
from pfkit.particles.particle_set import Particles

Array = NDArray[np.float64]


class Divergence(NamedTuple):
    """KL(particles || grid) in nats; numbers, or arrays (B,) for a batch.

    Attributes
    ----------
    kl : the estimate, bias removed; slightly negative by chance when there is no divergence
    low, high : an interval that holds it in about 95 of 100 cases
    bias : what was removed
    bins : int, number of boxes; the estimate cannot exceed about log(bins)
    outside : share of the particles' mass outside the grid, counted to its nearest cell
    """

    kl: Array | np.float64
    low: Array | np.float64
    high: Array | np.float64
    bias: Array | np.float64
    bins: int
    outside: Array | np.float64


def equal_mass_boxes(p: Array, bins: int) -> NDArray[np.int64]:
    """Cut a block of cells into boxes that hold about the same mass.

    The heaviest box is halved, along the axis on which its mass spreads most, until there are
    enough. Every box holds some mass, so no ratio is infinite.

    Parameters
    ----------
    p : array (n_x, n_y, n_theta), probabilities
    bins : int, how many boxes; fewer if the mass sits in fewer cells

    Returns
    -------
    int64 array (n_x, n_y, n_theta), the number of each cell's box

    Raises
    ------
    ShapeError, ParameterError
        If p is not a block of masses, or bins is not a whole number >= 1.

    Notes
    -----
    O(N log bins) for N cells: each level of cuts looks at each cell once.
    """
    p = require_array("p", p, ("n_x", "n_y", "n_theta"), "finite and >= 0")
    label = np.zeros(p.shape, dtype=np.int64)
    whole = tuple(slice(0, n) for n in p.shape)
    heap = [(-float(p.sum()), 0, whole)]
    done = 0
    while heap and len(heap) + done < require_count("bins", bins):
        _, number, box = heapq.heappop(heap)
        halves = _halve(p, box)
        if halves is None:
            done += 1
            continue
        other = len(heap) + done + 1
        label[halves[1]] = other
        for name, half in zip((number, other), halves, strict=True):
            heapq.heappush(heap, (-float(p[half].sum()), name, half))
    return label


def _halve(p: Array, box: tuple[slice, ...]) -> tuple[tuple[slice, ...], ...] | None:
    """Cut a box where its mass is halved; None if all of it is in one cell."""
    part = p[box]
    marginals = [part.sum(axis=tuple(a for a in range(p.ndim) if a != axis)) for axis in range(3)]
    axis = int(np.argmax([_spread(m) / n for m, n in zip(marginals, p.shape, strict=True)]))
    below = np.cumsum(marginals[axis])
    held = np.flatnonzero(marginals[axis])
    if held.size < 2:
        return None
    inner = below[held[0] : held[-1]]  # cuts that leave some mass on both sides, however little
    cut = box[axis].start + 1 + int(held[0] + np.argmin(np.abs(inner / below[-1] - 0.5)))
    first, second = list(box), list(box)
    first[axis], second[axis] = slice(box[axis].start, cut), slice(cut, box[axis].stop)
    return tuple(first), tuple(second)


def _spread(mass: Array) -> float:
    """Standard deviation of a marginal, in cells."""
    at, total = np.arange(mass.size), mass.sum()
    mean = (at * mass).sum() / total
    return math.sqrt(max(((at - mean) ** 2 * mass).sum() / total, 0.0))


def _shares(box: NDArray[np.int64], mass: Array, bins: int = 0) -> Array:
    """Mass in each box."""
    return np.bincount(box.ravel(), mass.ravel(), bins).astype(float)


def _log_ratio_sum(q: Array, p: Array, power: int = 1) -> Array:
    """Sum over boxes of q log(q / p) ** power, with 0 log 0 = 0: (..., C) -> (...)."""
    ratio = np.log(np.where(q > 0, q, 1.0) / np.where(q > 0, p, 1.0))
    return (q * ratio**power).sum(axis=-1)


def kl_divergence(bel: Particles, grid: PoseGrid, bins: int = 64) -> Divergence:
    r"""How far a particle set is from the exact posterior, in nats.

    .. math:: \widehat{\mathrm{KL}} &= \sum_c \hat q_c \log(\hat q_c / p_c) - (C_+ - 1)/2n \\
              \mathrm{sd}^2 &= \frac{1}{n} \Big(\mathrm{Var}_{\hat q}[\log(\hat q/p)]
              - \frac{C_+ - 1}{n}\Big)_+ + \frac{C_+ - 1}{2 n^2}

    Parameters
    ----------
    bel : Particles with state (3, M) or (3, B, M)
    grid : PoseGrid, the posterior on the same data
    bins : int
        Number of boxes. More of them see finer differences and need more particles: take
        M / 10 or less.

    Returns
    -------
    Divergence

    Raises
    ------
    ShapeError, ParameterError
        If the particles are not poses, or an argument is not what it should be.

    Notes
    -----
    Source for the bias: G. Miller, "Note on the bias of information estimates" (1955). When
    q = p, counting alone makes the log ratios vary by (C_+ - 1) / n; what is left then is the
    variance of a chi-square, the last term.
    """
    box = equal_mass_boxes(grid.p, bins).ravel()
    p = _shares(box, grid.p)
    cell, inside = grid.index(bel.state)
    w, labels = bel.w, box[cell]
    rows = zip(labels.reshape(-1, bel.M), w.reshape(-1, bel.M), strict=True)
    q = np.stack([_shares(label, row, p.size) for label, row in rows])
    q = q.reshape(*w.shape[:-1], p.size)
    n, plug_in = bel.ess, _log_ratio_sum(q, p)
    extra = np.count_nonzero(q, axis=-1) - 1
    bias = extra / (2 * n)
    between = np.maximum(_log_ratio_sum(q, p, 2) - plug_in**2 - extra / n, 0.0)
    kl, half = plug_in - bias, 1.96 * np.sqrt(between / n + extra / (2 * n * n))
    return Divergence(kl, kl - half, kl + half, bias, p.size, (w * ~inside).sum(axis=-1))


def refinement(coarse: PoseGrid, fine: PoseGrid, bins: int = 64) -> float:
    r"""How far halving the cells moved the answer: KL(coarse || fine) in nats.

    .. math:: \sum_c p^h_c \log (p^h_c / p^{h/2}_c)

    Parameters
    ----------
    coarse : PoseGrid (n_x, n_y, n_theta)
    fine : PoseGrid (2 n_x, 2 n_y, 2 n_theta) with the same bounds
    bins : int, boxes as in `kl_divergence`: the same yardstick as for the particles

    Returns
    -------
    float

    Raises
    ------
    ShapeError, ParameterError
        If the fine grid is not the coarse one with halved cells.
    """
    shape = coarse.p.shape
    if fine.p.shape != tuple(2 * n for n in shape) or fine.bounds != coarse.bounds:
        raise ShapeError(
            f"fine must have twice the cells of coarse and the same bounds, got {fine} for {coarse}"
        )
    n_x, n_y, n_theta = shape
    merged = fine.p.reshape(n_x, 2, n_y, 2, n_theta, 2).sum(axis=(1, 3, 5))
    box = equal_mass_boxes(merged, bins).ravel()
    q, p = _shares(box, coarse.p), _shares(box, merged)
    return float(_log_ratio_sum(q, p))
