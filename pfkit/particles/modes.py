r"""Clusters: the hypotheses of a cloud, each with its mass and its spread.

A mean summarises one heap of particles. A cloud in a symmetric building is several heaps, and
the honest answer is a list: here with 60 %, there with 40 %. To find the heaps we lay a coarse
grid over the state, keep the cells that hold particles, and join cells that touch, at a side or
at a corner. What hangs together is one hypothesis. Their means and covariances and those of
the whole cloud obey the law of total covariance,

.. math:: \Sigma = \sum_c W_c\, \Sigma_c + \sum_c W_c\, (\mu_c - \mu)(\mu_c - \mu)^T ,

what is uncertain within the hypotheses and what is uncertain between them.

The size of the cells is the resolution: two heaps closer than a cell or two are one. A thin
bridge of stray particles joins what it connects.
"""

from __future__ import annotations

import math
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array, whole_cells
from pfkit.particles.estimators import covariance, mean_pose
from pfkit.particles.particle_set import Particles, normalise

Array = NDArray[np.float64]
Cell = tuple[int, ...]


class Clusters(NamedTuple):
    """Hypotheses, the heaviest first.

    Attributes
    ----------
    mean : array (D, C), the mean pose of each
    mass : array (C,), the share of the weight of each
    label : int64 array (M,), which cluster a particle belongs to; -1 where no weight is near
    covariance : array (D, D, C), the covariance of each about its own mean
    """

    mean: Array
    mass: Array
    label: NDArray[np.int64]
    covariance: Array


def clusters(bel: Particles, cell: ArrayLike = (1.0, 1.0, math.pi / 4)) -> Clusters:
    """Find the heaps of a cloud.

    Parameters
    ----------
    bel : Particles with state (D, M)
    cell : array_like (D,), > 0
        Size of a cell: metres, metres, radians. The heading's is shrunk to a whole part of the
        circle, so that cells meet at pi.

    Returns
    -------
    Clusters

    Raises
    ------
    ShapeError, ParameterError
        If there is not one cell size > 0 per component, or the set is a batch.

    Notes
    -----
    O(M log M) for sorting particles into cells; then 3^D - 1 neighbours for each occupied cell.
    """
    D = len(require_array("the state of one set", bel.state, ("D", "M")))
    cell = require_array("cell", cell, (D,), "finite and > 0")
    size, turn = cell.copy(), 0
    if D >= 3:
        turn = math.ceil(2 * math.pi / cell[2])
        size[2] = 2 * math.pi / turn
    at = whole_cells(bel.state / size[:, None])
    if turn:
        at[2] %= turn
    cells, home = np.unique(at, axis=1, return_inverse=True)
    home = home.reshape(-1)  # NumPy 2.0 returned (1, M) here
    share = np.bincount(home, bel.w)
    names = _join([tuple(c) for c in cells.T.tolist()], share > 0, turn)
    return _summary(bel, names[home])


def _join(cells: list[Cell], held: NDArray[np.bool_], turn: int) -> NDArray[np.int64]:
    """Name of the connected component of each cell; -1 for cells that hold no weight."""
    free = {c: i for i, c in enumerate(cells) if held[i]}
    names = np.full(len(cells), -1, dtype=np.int64)
    steps = list(product((-1, 0, 1), repeat=len(cells[0])))
    name = 0
    while free:
        queue = [free.popitem()]
        while queue:
            here, i = queue.pop()
            names[i] = name
            for s in steps:
                near = tuple(a + b for a, b in zip(here, s, strict=True))
                if turn:
                    near = (*near[:2], near[2] % turn, *near[3:])
                if near in free:
                    queue.append((near, free.pop(near)))
        name += 1
    return names


def _summary(bel: Particles, label: NDArray[np.int64]) -> Clusters:
    """Masses, means and covariances, the heaviest cluster first."""
    mass = np.bincount(label + 1, bel.w, label.max() + 2)[1:].astype(float)
    order = np.argsort(-mass, kind="stable")
    rank = np.empty(order.size + 1, dtype=np.int64)
    rank[order], rank[-1] = np.arange(order.size), -1
    label = rank[label]
    parts = [
        Particles(bel.state[:, label == c], normalise(bel.log_w[label == c])[0])
        for c in range(order.size)
    ]
    means = np.stack([mean_pose(part) for part in parts], axis=-1)
    spreads = np.stack([covariance(part) for part in parts], axis=-1)
    return Clusters(means, mass[order], label, spreads)
