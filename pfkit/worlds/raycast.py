r"""Ray casting: how far does a beam fly before it meets a wall?

The plain way walks along the ray from cell to cell and looks into each. In an open hall that
is hundreds of looks per beam. *Sphere tracing* looks up how much empty space there is and
leaps across it. We leap across empty *squares*: for each cell and each of the four diagonal
directions a table holds the side of the largest empty square that starts there and lies
ahead. The ray leaves that square through a side at a known place,

.. math:: t = \min\Big(\frac{i + k - x}{d_x},\; \frac{j + k - y}{d_y}\Big)

(for a ray from (x, y) that moves right and up; k is the side of the square at cell (i, j)),
and looks again. Next to a wall k is 1 and the leap is the plain walk's step. So nothing is
skipped, and once the ray enters an occupied cell its length is that to the near edge: exact.

All rays leap together, in blocks that fit the processor's cache; those that have arrived drop
out. Rays that move left or down are cast on a mirrored map, so that one formula serves all.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array, require_number
from pfkit.worlds.occupancy import OccupancyGrid

Array = NDArray[np.float64]

BLOCK = 32_768  # rays at a time: their handful of arrays fit into the cache
NUDGE = 1e-9  # cells; a ray that stands on an edge belongs to the cell ahead
TINY = 1e-100  # stands in for a zero component of the direction: no division by zero


@dataclass(frozen=True, eq=False)
class RayCaster:
    """Casts beams in an occupancy grid; builds its table of empty squares once.

    Parameters
    ----------
    world : OccupancyGrid
        Beams stop at occupied cells. Unknown cells do not stop them.

    Notes
    -----
    The table costs 16 bytes a cell and, to build, the number of cells times the side of the
    largest empty square.
    """

    world: OccupancyGrid

    def __post_init__(self) -> None:
        rows, columns = self.world.p.shape
        stop = np.ones((rows + 2, columns + 2), dtype=bool)  # a rim, so that rays end there
        stop[1:-1, 1:-1] = self.world.occupied
        mirrored = (stop, stop[:, ::-1], stop[::-1], stop[::-1, ::-1])
        squares = np.stack([empty_squares(view) for view in mirrored]).astype(np.float32)
        object.__setattr__(self, "_squares", squares)

    def cast(self, pose: ArrayLike, angles: ArrayLike, r_max: float) -> Array:
        """Lengths of beams at many poses.

        Parameters
        ----------
        pose : array_like (3, ...), metres and radians
        angles : array_like (K,), radians from the robot's nose; or (K, B, 1) in a batch
        r_max : float, metres, > 0
            Beams that meet nothing within r_max, or leave the map, or start outside it, get
            r_max. It may be infinite.

        Returns
        -------
        array (K, ...), metres, in [0, r_max]; 0 for a pose inside a wall

        Raises
        ------
        ShapeError, ParameterError
            If pose or angles have the wrong shape or are not finite, or r_max is not positive.
        """
        pose = require_array("pose", pose, (3, ...))
        phi = require_array("angles", angles, ("K", ...))
        r_max = require_number("r_max", r_max, "> 0")
        if phi.ndim == 1:
            phi = phi.reshape(-1, *(1,) * (pose.ndim - 1))
        shape = (len(phi), *np.broadcast_shapes(pose.shape[1:], phi.shape[1:]))
        poses = np.broadcast_to(pose, (3, *shape[1:])).reshape(3, -1)
        if phi[0].size > 1:  # else all poses share their angles, and one column serves
            phi = np.broadcast_to(phi, shape)
        phi = phi.reshape(shape[0], -1)
        lengths = np.empty((shape[0], poses.shape[1]))
        step = max(BLOCK // shape[0], 1)
        for first in range(0, poses.shape[1], step):
            some = slice(first, first + step)
            own = phi[:, some] if phi.shape[1] > 1 else phi
            lengths[:, some] = self._lengths(poses[:, some], own)
        return np.minimum(lengths * self.world.resolution, r_max).reshape(shape)

    def _lengths(self, pose: Array, phi: Array) -> Array:
        """Lengths (K, m), in cells, of the beams phi (K, m) of some poses (3, m)."""
        _, height, width = self._squares.shape  # type: ignore[attr-defined]
        theta = pose[2] - self.world.origin[2]
        c, s, ahead, aside = np.cos(theta), np.sin(theta), np.cos(phi), np.sin(phi)
        dx, dy = c * ahead - s * aside, s * ahead + c * aside
        x, y = 1.0 + self.world.to_cells(pose[0], pose[1])  # of the map with its rim
        inside = (x >= 1) & (x < width - 1) & (y >= 1) & (y < height - 1)
        left, down = dx < 0, dy < 0
        rays = np.empty((5, *dx.shape))
        rays[0], rays[1] = np.where(left, width - x, x), np.where(down, height - y, y)
        dx, dy = np.maximum(np.abs(dx), TINY), np.maximum(np.abs(dy), TINY)
        rays[:2, :, ~inside] = 0.0  # the corner of the rim: such a ray ends where it starts
        rays[2], rays[3], rays[4] = dy / dx, dx / dy, (left + 2.0 * down) * (height * width)
        rays = rays.reshape(5, -1)
        i, j = self._leap(rays)
        x, y, slope, per_slope, _ = rays
        across = np.maximum(np.maximum(i - x, (j - y) * per_slope), 0.0)  # to the cell's near edge
        met = (i > 0) & (i < width - 1) & (j > 0) & (j < height - 1)
        return np.where(met, across * np.sqrt(1.0 + slope * slope), np.inf).reshape(dx.shape)

    def _leap(self, rays: Array) -> Array:
        """Where each ray ends, column and row: (2, n). A ray is (x, y, slope, 1 / slope, table).

        The progress of a ray is measured along x: the way to the square's right side is
        i + k - x, and its top is reached after (j + k - y) / slope.
        """
        squares = self._squares.ravel()  # type: ignore[attr-defined]
        width = self._squares.shape[2]  # type: ignore[attr-defined]
        end = np.empty((2, rays.shape[1]))
        who = np.arange(rays.shape[1])
        cell = np.floor(rays[:2] + NUDGE)
        while who.size:
            look = cell[1] * width
            look += cell[0]
            look += rays[4]
            k = np.take(squares, look.astype(np.int64))
            clear = k > 0
            arrived, flying = np.flatnonzero(~clear), np.flatnonzero(clear)
            if arrived.size:
                ended = who.take(arrived)
                end[0, ended], end[1, ended] = cell[0].take(arrived), cell[1].take(arrived)
                rays, cell = rays.take(flying, axis=1), cell.take(flying, axis=1)
                k, who = k.take(flying), who.take(flying)
            start, slope, per_slope = rays[:2], rays[2], rays[3]
            cell += k
            cell -= start
            cell[1] *= per_slope
            np.minimum(cell[0], cell[1], out=cell[0])
            np.multiply(cell[0], slope, out=cell[1])
            cell += start
            cell += NUDGE
            np.floor(cell, out=cell)
        return end


def empty_squares(stop: ArrayLike) -> NDArray[np.int64]:
    """Side of the largest square without a stop whose lower left cell each cell is.

    Parameters
    ----------
    stop : array_like of bool (rows, columns)

    Returns
    -------
    int64 array (rows, columns), in cells; 0 in a stop. Squares do not reach over the edge.
    """
    empty = ~np.asarray(stop, dtype=bool)
    side = empty.astype(np.int64)
    while empty.any():  # a square of side k + 1 is four overlapping squares of side k
        empty = empty[:-1, :-1] & empty[1:, :-1] & empty[:-1, 1:] & empty[1:, 1:]
        side[: empty.shape[0], : empty.shape[1]] += empty
    return side
