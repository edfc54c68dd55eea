r"""The histogram filter for a robot with a heading: predict and update on a block of cells.

Weighing is as easy as in the corridor, one likelihood per cell. Moving is the costly half, and
there are two ways to do it.

*Convolution.* The motion is the same wherever the robot stands; only its direction turns with
the heading. So we draw the motion once, in the robot's own frame, turn it by each heading, and
make from it a kernel that shifts and smears the whole slice of that heading at once. With FFTs
this costs :math:`O(s\, N \log N)`, with N cells and s heading cells reached by the kernel.
It does not know about walls.

*Transport.* Throw random points out of every occupied cell, let each drive, and drop its mass
into the cell where it ends. This costs :math:`O(K N)` for K points per cell, takes any motion
model, skips empty cells, and leaves some noise.

Either way the answer carries an error of the size of the cells: a step smears by about half a
cell more than the robot does. Believe a grid only when halving its cells no longer moves the
answer; `divergence.refinement` says how far it moved.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DegenerateWeightsError, require_count
from pfkit.exact.posegrid import PoseGrid
from pfkit.filters.particle_filter import update
from pfkit.geometry import compose
from pfkit.models.motion import MotionModel
from pfkit.models.sensors import SensorModel, how_many

Array = NDArray[np.float64]


def predict_by_convolution(
    bel: PoseGrid, u: ArrayLike, motion: MotionModel, rng: np.random.Generator, draws: int = 4096
) -> PoseGrid:
    r"""Move every slice of equal heading by one kernel.

    .. math:: \overline{bel}(\cdot, \cdot, \theta') = \sum_\theta k_{\theta \to \theta'} *
              bel(\cdot, \cdot, \theta)

    Parameters
    ----------
    bel : PoseGrid
    u : array_like (n,), the control
    motion : MotionModel, the same everywhere on the map
    rng : numpy.random.Generator
    draws : int
        Motions drawn to make the kernel; equal generators give equal kernels on any grid.

    Returns
    -------
    PoseGrid

    Raises
    ------
    DegenerateWeightsError
        If all mass leaves the bounds.
    ParameterError, ShapeError
        If an argument is not what it should be.

    Notes
    -----
    Each draw is shared between the eight cells around its end. That keeps the kernel's mean and
    adds at most a quarter of a cell squared to its variance. O(s N log N). The FFT rounds:
    what falls below 1e-15 of the largest cell is set to zero.
    """
    u = np.asarray(u, dtype=float)
    moves = motion.sample(np.zeros((3, require_count("draws", draws))), u, rng)
    if not moves.any():
        return bel
    reach = np.ceil(np.hypot(moves[0], moves[1]).max() / bel.cell[:2]).astype(np.int64) + 1
    n_x, n_y, n_theta = bel.p.shape
    size = (n_x + int(reach[0]), n_y + int(reach[1]))  # room, so that nothing comes round
    spectrum = np.fft.rfft2(bel.p, s=size, axes=(0, 1))
    moved = np.zeros_like(spectrum)
    for k in np.flatnonzero(bel.p.any(axis=(0, 1))):
        heading = np.array((0.0, 0.0, bel.poses[2, 0, 0, k]))[:, None]
        shift = compose(heading, moves) - heading
        shift[2] = moves[2]
        kernel, turns = _kernel(shift / bel.cell[:, None], size, n_theta)
        target = (k + turns) % n_theta
        moved[:, :, target] += spectrum[:, :, k, None] * np.fft.rfft2(kernel, axes=(0, 1))
    p = np.fft.irfft2(moved, s=size, axes=(0, 1))
    p[p < 1e-15 * p.max()] = 0.0
    return _keep(bel, p[:n_x, :n_y])


def _kernel(shift: Array, size: tuple[int, int], n_theta: int) -> tuple[Array, NDArray[np.int64]]:
    """Share out draws (3, K), in cells, over whole shifts: a block, and its turns (n_turns,)."""
    low = np.floor(shift).astype(np.int64)
    fraction = shift - low
    first = int(low[2].min())
    n_turns = min(int(low[2].max()) + 2 - first, n_theta)
    kernel = np.zeros(size[0] * size[1] * n_turns)
    for corner in product((0, 1), repeat=3):
        i, j, k = low + np.array(corner)[:, None]
        share = np.prod([f if c else 1 - f for c, f in zip(corner, fraction, strict=True)], axis=0)
        cell = ((i % size[0]) * size[1] + j % size[1]) * n_turns + (k - first) % n_turns
        kernel += np.bincount(cell, share, kernel.size)
    return (kernel / shift.shape[1]).reshape(*size, n_turns), first + np.arange(n_turns)


def predict_by_transport(
    bel: PoseGrid, u: ArrayLike, motion: MotionModel, rng: np.random.Generator, draws: int = 16
) -> PoseGrid:
    r"""Let random points of every occupied cell drive, and collect their mass where they end.

    .. math:: \overline{bel}_i &= \sum_j bel_j\; \frac{1}{K} \sum_k
              [\, x_{jk}' \in \text{cell } i \,], \\
              x_{jk}' &\sim p(x' \mid u, x_{jk}), \quad x_{jk} \text{ uniform in cell } j

    Parameters
    ----------
    bel : PoseGrid
    u : array_like (n,), the control
    motion : MotionModel, any
    rng : numpy.random.Generator
    draws : int
        Points K per cell.

    Returns
    -------
    PoseGrid

    Raises
    ------
    DegenerateWeightsError
        If all mass leaves the bounds.
    ParameterError, ShapeError
        If an argument is not what it should be.

    Notes
    -----
    Source: Probabilistic Robotics, Table 8.1, its integral done by sampling. O(K N).
    """
    u, draws = np.asarray(u, dtype=float), require_count("draws", draws)
    occupied = np.flatnonzero(bel.p)
    mass, centre = bel.p.ravel()[occupied] / draws, bel.poses.reshape(3, -1)[:, occupied]
    p = np.zeros(bel.p.size)
    for _ in range(draws):
        start = centre + bel.cell[:, None] * (rng.random(centre.shape) - 0.5)
        cell, inside = bel.index(motion.sample(start, u, rng))
        p += np.bincount(cell, mass * inside, p.size)
    return _keep(bel, p.reshape(bel.p.shape))


def _keep(bel: PoseGrid, p: Array) -> PoseGrid:
    """Scale what is left inside the bounds up to one, and note what was lost."""
    inside = p.sum()
    if not inside > 0:
        raise DegenerateWeightsError(
            f"all mass left the bounds {bel.bounds}; check the control's units or widen the bounds"
        )
    lost = max(1 - inside, 0.0)
    return replace(bel, p=p / inside, lost=bel.lost + (1 - bel.lost) * lost)


def update_grid(bel: PoseGrid, z: ArrayLike | None, sensor: SensorModel) -> tuple[PoseGrid, float]:
    r"""Weigh every cell by the likelihood at its centre.

    .. math:: bel_i = \eta\, p(z \mid x_i)\, \overline{bel}_i, \qquad
              \log p(z_t \mid z_{1:t-1}) = \log \sum_i p(z \mid x_i)\, \overline{bel}_i

    Parameters
    ----------
    bel : PoseGrid
    z : array_like (n, K), or None; no measurement leaves the belief as it is
    sensor : SensorModel
        Its noise should not be narrower than a cell, or the centre misses the peak.

    Returns
    -------
    PoseGrid
    log_evidence : float

    Raises
    ------
    DegenerateWeightsError
        If the measurement is impossible in every cell.
    ParameterError, ShapeError, DataError
        If an argument is not what it should be.
    """
    if how_many(z) == 0:
        return bel, 0.0
    posterior, log_evidence = update(bel.particles(), z, sensor)
    return replace(bel, p=posterior.w.reshape(bel.p.shape)), float(log_evidence)
