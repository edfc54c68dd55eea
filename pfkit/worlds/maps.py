"""Maps: what the robot knows of its surroundings before it starts.

A landmark map is a list of points with names. A robot that recognises a landmark (by a bar
code, a radio beacon's number) knows which point it measured; that is *known association*.
The map also carries the bounding box of the area in which the robot can be, because "the
robot may be anywhere" needs an *anywhere*: a prior that is tighter than the world silently
adds information, and can even break a symmetry.

Names are whole numbers that need not run from 0; those of a real arena are printed on its
posts. `locate` looks them up in a sorted list, for any number of measurements at once, and an
unknown name is an error: bar codes on a recorded log may belong to other robots.
Where names are missing altogether, `association` has to guess them.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import (
    ParameterError,
    Shape,
    UnknownLandmarkError,
    as_numbers,
    require_array,
    require_bounds,
    require_rng,
    require_shape,
)


@dataclass(frozen=True)
class LandmarkMap:
    """Point landmarks with integer ids, and the box in which the robot can be.

    Parameters
    ----------
    positions : array_like (2, L), metres
    ids : array_like (L,) of int, optional
        Names of the landmarks; 0, 1, ... L-1 if left out.
    bounds : (x_min, x_max, y_min, y_max), metres, optional
        Where the robot can be; the landmarks' own bounding box if left out.

    Raises
    ------
    ShapeError, ParameterError
        If shapes do not match, a coordinate is not finite, an id repeats, or the box is empty.
    """

    positions: NDArray[np.float64]
    ids: NDArray[np.int64] = None  # type: ignore[assignment]
    bounds: tuple[float, float, float, float] = None  # type: ignore[assignment]
    _order: NDArray[np.int64] = field(init=False, repr=False)
    _sorted: NDArray[np.float64] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        positions = require_array("positions", self.positions, (2, "L"))
        L = positions.shape[1]
        ids = np.arange(L) if self.ids is None else require_array("ids", self.ids, (L,), "whole")
        ids = ids.astype(np.int64)
        if np.unique(ids).size != L:
            raise ParameterError(f"ids must be {L} different integers, got {ids.tolist()}")
        if self.bounds is None:
            (x0, y0), (x1, y1) = positions.min(axis=1), positions.max(axis=1)
        else:
            x0, x1, y0, y1 = require_bounds(self.bounds)
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "ids", ids)
        object.__setattr__(self, "bounds", (float(x0), float(x1), float(y0), float(y1)))
        order = np.argsort(ids)
        object.__setattr__(self, "_order", np.append(order, -1))
        object.__setattr__(self, "_sorted", np.append(ids[order], np.nan))

    def __len__(self) -> int:
        return self.ids.size

    def __repr__(self) -> str:
        return f"LandmarkMap({len(self)} landmarks, bounds {self.bounds})"

    def locate(self, ids: ArrayLike) -> NDArray[np.float64]:
        """Positions of landmarks by their ids.

        Parameters
        ----------
        ids : array_like of int (or whole floats), any shape

        Returns
        -------
        array (2, *shape of ids), metres

        Raises
        ------
        UnknownLandmarkError
            If the map has no landmark of that id.
        """
        return self.positions[:, self.index(ids)]

    def index(self, ids: ArrayLike) -> NDArray[np.int64]:
        """Where landmarks stand in the map's own order, by their ids; else as `locate`."""
        wanted = as_numbers("landmark ids", ids, UnknownLandmarkError)
        at = self._sorted.searchsorted(wanted)  # NaN at the end is found last, and equals nothing
        wrong = self._sorted[at] != wanted
        if wrong.any():
            raise UnknownLandmarkError(
                f"landmark {wanted[wrong].flat[0]:g} is not in the map, which has "
                f"{self.ids.tolist()}; drop the measurement or add the landmark"
            )
        return self._order[at]

    def sample_poses(self, shape: Shape, rng: np.random.Generator) -> NDArray[np.float64]:
        """Draw poses uniformly over the bounds, heading uniform on the circle.

        Parameters
        ----------
        shape : int M, or (B, M)
        rng : numpy.random.Generator

        Returns
        -------
        array (3, *shape), metres and radians

        Raises
        ------
        ParameterError
            If the bounds were left out and the landmarks' own box has no area.
        """
        shape = require_shape("shape", shape)
        require_rng(rng)
        x0, x1, y0, y1 = self.bounds
        if not (x0 < x1 and y0 < y1):
            raise ParameterError(f"the landmarks' own box {self.bounds} has no area; give bounds")
        low = np.array((x0, y0, -np.pi)).reshape(3, *(1,) * len(shape))
        high = np.array((x1, y1, np.pi)).reshape(3, *(1,) * len(shape))
        return high - (high - low) * rng.random((3, *shape))  # heading in (-pi, pi]

    def contains(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.bool_]:
        """Whether points lie inside the bounds.

        Parameters
        ----------
        x, y : array_like, metres; any shapes that broadcast

        Returns
        -------
        bool array, of the common shape
        """
        x0, x1, y0, y1 = self.bounds
        x, y = require_array("x", x), require_array("y", y)
        return (x0 <= x) & (x <= x1) & (y0 <= y) & (y <= y1)
