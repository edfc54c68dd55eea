r"""Distance field: how far is it from each cell to the nearest wall?

.. math:: D(c) = \min_{c'\ \text{occupied}} \lVert c - c' \rVert_2

The obvious way looks at all pairs of cells. The squared distance, however, splits into a part
along the columns and a part along the rows,

.. math:: D^2(i, j) = \min_{i'} \Big[ (i - i')^2 + \min_{j'} (j - j')^2 \Big] ,

so two one-dimensional searches do: first up and down each column, then along each row over the
result. The second search widens step by step and stops once a wider step cannot win for any
cell, so its cost is the number of cells times the largest distance on the map, in cells.

The result is exact: a sum of two squares of whole numbers, and its root.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ShapeError, require_number

Array = NDArray[np.float64]


def distance_field(occupied: ArrayLike, resolution: float = 1.0) -> Array:
    """Distance from the centre of each cell to the centre of the nearest occupied one.

    Parameters
    ----------
    occupied : array_like of bool (rows, columns)
    resolution : float, metres per cell, > 0

    Returns
    -------
    array (rows, columns), metres; 0 in occupied cells, inf everywhere if there are none

    Raises
    ------
    ShapeError, ParameterError
        If `occupied` is not a table of booleans, or the resolution is not positive.

    Notes
    -----
    Source: P. F. Felzenszwalb and D. P. Huttenlocher, "Distance transforms of sampled
    functions", Theory of Computing 8 (2012), for the split; the search here is simpler.
    """
    occupied = np.asarray(occupied)
    require_number("resolution", resolution, "finite and > 0")
    if occupied.dtype != bool or occupied.ndim != 2 or occupied.size == 0:
        raise ShapeError(
            f"occupied must be booleans (rows, columns), got {occupied.dtype} of shape "
            f"{occupied.shape}; pass grid.occupied, not grid.p"
        )
    along = _along_columns(occupied) ** 2
    squared = along.copy()
    buffer = np.empty_like(along)
    for k in range(1, occupied.shape[1]):
        if k * k >= squared.max():
            break
        shifted = np.add(along, k * k, out=buffer)
        np.minimum(squared[:, k:], shifted[:, :-k], out=squared[:, k:])
        np.minimum(squared[:, :-k], shifted[:, k:], out=squared[:, :-k])
    return np.asarray(resolution * np.sqrt(squared))


def _along_columns(occupied: NDArray[np.bool_]) -> Array:
    """Distance, in cells, to the nearest occupied cell of the same column; inf if it has none."""
    row = np.arange(occupied.shape[0], dtype=float)[:, None]
    below = np.maximum.accumulate(np.where(occupied, row, -np.inf), axis=0)
    above = np.minimum.accumulate(np.where(occupied, row, np.inf)[::-1], axis=0)[::-1]
    return np.minimum(row - below, above - row)
