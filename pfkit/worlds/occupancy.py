r"""Occupancy grids: a floor plan in square cells.

A landmark map lists points; an occupancy grid says of every place whether something stands
there. It divides the floor into square cells and keeps for each the probability that it is
occupied. Two thresholds turn that into three answers: *occupied* (a laser beam stops there),
*free* (the robot can be there) and *unknown* (nobody has looked).

Cells are counted as the axes run: column i along x, row j along y, row 0 at the bottom. So
``p[j, i]`` is the cell whose lower left corner is i cells along and j cells up from the map's
origin. The origin is a pose: the whole map may stand askew in the world. `to_cells` and
`from_cells` go to and fro, with fractions: cell (i, j) covers i to i + 1 and j to j + 1.

Files are those of ROS's ``map_server`` (see `map_files`).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import (
    DataError,
    ParameterError,
    Shape,
    ShapeError,
    require_array,
    require_fields,
)
from pfkit.worlds.map_files import read_cells, read_settings, write_pgm

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class OccupancyGrid:
    """A map of square cells, each with its probability of being occupied.

    Parameters
    ----------
    p : array_like (rows, columns), probabilities in [0, 1], or booleans: True is a wall
        Row 0 is the bottom row.
    resolution : float, metres per cell, > 0
    origin : (x, y, yaw), metres and radians
        Pose of the lower left corner of the map.
    occupied_thresh, free_thresh : float in [0, 1]
        Above the first a cell is occupied, below the second it is free.

    Raises
    ------
    ShapeError, ParameterError
        If p is not a table of probabilities, or a setting is out of range.
    """

    p: NDArray[Any]
    resolution: float
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    occupied_thresh: float = 0.65
    free_thresh: float = 0.196

    def __post_init__(self) -> None:
        p = require_array("p", self.p, ("rows", "columns"), "in [0, 1]")
        origin = require_array("origin", self.origin, (3,))
        require_fields(
            self, resolution="finite and > 0", free_thresh="in [0, 1]", occupied_thresh="in [0, 1]"
        )
        if self.free_thresh > self.occupied_thresh:
            raise ParameterError(
                "thresholds must satisfy 0 <= free <= occupied <= 1, got "
                f"{self.free_thresh} and {self.occupied_thresh}"
            )
        object.__setattr__(self, "p", p)
        object.__setattr__(self, "origin", tuple(origin.tolist()))

    def __repr__(self) -> str:
        rows, columns = self.p.shape
        wide, high = columns * self.resolution, rows * self.resolution
        return f"OccupancyGrid({columns} x {rows} cells, {wide:g} m x {high:g} m)"

    @cached_property
    def occupied(self) -> NDArray[np.bool_]:
        """Where a beam stops: bool (rows, columns)."""
        return self.p > self.occupied_thresh

    @cached_property
    def free(self) -> NDArray[np.bool_]:
        """Where the robot can be: bool (rows, columns)."""
        return self.p < self.free_thresh

    @cached_property
    def bounds(self) -> tuple[float, float, float, float]:
        """The upright box about the map: x_min, x_max, y_min, y_max in metres."""
        rows, columns = self.p.shape
        x, y = self.from_cells((0, columns, columns, 0), (0, 0, rows, rows))
        return float(x.min()), float(x.max()), float(y.min()), float(y.max())

    def to_cells(self, x: ArrayLike, y: ArrayLike) -> Array:
        """Column and row, with fractions, of points in the world: (2, ...)."""
        x0, y0, yaw = self.origin
        dx, dy = require_array("x", x) - x0, require_array("y", y) - y0
        c, s = np.cos(yaw) / self.resolution, np.sin(yaw) / self.resolution
        return np.stack((c * dx + s * dy, c * dy - s * dx))

    def from_cells(self, column: ArrayLike, row: ArrayLike) -> Array:
        """Points in the world, metres, from columns and rows with fractions: (2, ...)."""
        x0, y0, yaw = self.origin
        i, j = np.asarray(column, dtype=float), np.asarray(row, dtype=float)
        c, s = np.cos(yaw) * self.resolution, np.sin(yaw) * self.resolution
        return np.stack((x0 + c * i - s * j, y0 + s * i + c * j))

    def contains(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
        """Whether points lie in free cells; any shape, broadcast."""
        i, j = np.floor(self.to_cells(x, y)).astype(np.int64)
        rows, columns = self.p.shape
        inside = (i >= 0) & (i < columns) & (j >= 0) & (j < rows)
        return inside & self.free[np.clip(j, 0, rows - 1), np.clip(i, 0, columns - 1)]

    def sample_poses(self, shape: Shape, rng: np.random.Generator) -> Array:
        """Draw poses uniformly over the free cells, heading uniform on the circle: (3, ...).

        Raises
        ------
        ParameterError
            If the map has no free cell.
        """
        rows, columns = np.nonzero(self.free)
        if rows.size == 0:
            raise ParameterError(
                f"the map has no free cell (p < {self.free_thresh}); check negate and thresholds"
            )
        cell = rng.integers(rows.size, size=shape)
        i, j = columns[cell] + rng.random(shape), rows[cell] + rng.random(shape)
        theta = np.pi - 2 * np.pi * rng.random(shape)  # in (-pi, pi]
        return np.stack((*self.from_cells(i, j), theta))

    @classmethod
    def load(cls, path: str | Path) -> OccupancyGrid:
        """Read a map of ROS's map_server from its YAML file.

        Raises
        ------
        DataError
            If a file is missing, cut off or malformed; names file and reason.
        """
        path = Path(path)
        found = read_settings(path)
        p = read_cells(path, found)
        try:
            return cls(p, found.resolution, found.origin, found.occupied_thresh, found.free_thresh)
        except (ParameterError, ShapeError) as problem:
            raise DataError(f"{path}: {problem}") from None

    def save(self, path: str | Path, text: bool = False) -> None:
        """Write the YAML file, and beside it the picture (P5; P2 if text), 256 shades of grey."""
        path = Path(path)
        picture = path.with_suffix(".pgm")
        x, y, yaw = self.origin
        write_pgm(picture, np.round(255 * (1.0 - self.p[::-1])).astype(np.uint8), text)
        path.write_text(
            f"image: {picture.name}\nresolution: {self.resolution!r}\n"
            f"origin: [{x!r}, {y!r}, {yaw!r}]\nnegate: 0\n"
            f"occupied_thresh: {self.occupied_thresh!r}\nfree_thresh: {self.free_thresh!r}\n",
            encoding="utf-8",
        )
