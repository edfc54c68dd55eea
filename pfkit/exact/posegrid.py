r"""A belief about a pose as one number per cell: the exact answer we can afford, once.

A pose has three components, so the corridor's list of cells becomes a block: n_x by n_y by
n_theta numbers, each the probability that the robot stands in that cell with that heading.
Four modes, a ring, a wedge: a block shows them all, and no luck is involved.

The price is memory and time. A hundred cells each way are a million, and cells twice as fine
are eight times as many. Most of them are empty most of the time, which is the observation that
particles start from.

`gridfilter` moves and weighs such a belief; `divergence` compares particles with it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import log_gaussian
from pfkit.errors import ParameterError, require_array, require_bounds, require_fields, whole_cells
from pfkit.geometry import wrap
from pfkit.particles.particle_set import Particles, normalise

Array = NDArray[np.float64]
Bounds = tuple[float, float, float, float]


@dataclass(frozen=True)
class PoseGrid:
    """A belief about a pose as one probability per cell.

    Parameters
    ----------
    p : array (n_x, n_y, n_theta), probabilities that sum to one
    bounds : (x_min, x_max, y_min, y_max), metres
        What the cells cover; headings always cover the circle, from -pi on.
    lost : float in [0, 1]
        Share of mass that has left the bounds so far. It is dropped and the rest scaled up: the
        robot is taken to stay inside, so choose bounds with a margin and keep an eye on it.

    Raises
    ------
    ShapeError, ParameterError
        If p is not a block of probabilities that sum to one, or the box is empty.
    """

    p: Array
    bounds: Bounds
    lost: float = 0.0

    def __post_init__(self) -> None:
        p = require_array("p", self.p, ("n_x", "n_y", "n_theta"), "finite and >= 0")
        if not np.isclose(p.sum(), 1.0):
            raise ParameterError(f"p must sum to 1, got {p.sum():.6g}; divide it by its sum")
        require_fields(self, lost="in [0, 1]")
        object.__setattr__(self, "p", p)
        object.__setattr__(self, "bounds", require_bounds(self.bounds))

    @property
    def low(self) -> Array:
        """Lower corner of the block (3,): metres, metres, radians."""
        return np.array((self.bounds[0], self.bounds[2], -np.pi))

    @property
    def cell(self) -> Array:
        """Size of a cell (3,): metres, metres, radians."""
        x0, x1, y0, y1 = self.bounds
        return np.array((x1 - x0, y1 - y0, 2 * np.pi)) / self.p.shape

    @cached_property
    def poses(self) -> Array:
        """Cell centres (3, n_x, n_y, n_theta)."""
        axes = [
            a + h * (np.arange(n) + 0.5)
            for a, h, n in zip(self.low, self.cell, self.p.shape, strict=True)
        ]
        return np.stack(np.meshgrid(*axes, indexing="ij"))

    def index(self, pose: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Flat cell numbers (...) of poses (3, ...), and whether each lies inside the bounds.

        A pose outside gets the cell of the block that is nearest to it.
        """
        pose = require_array("pose", pose, (3, ...))
        column = (slice(None), *(None,) * (pose.ndim - 1))
        at = whole_cells((pose - self.low[column]) / self.cell[column])
        n_x, n_y, n_theta = self.p.shape
        i, j = np.clip(at[0], 0, n_x - 1), np.clip(at[1], 0, n_y - 1)
        return (i * n_y + j) * n_theta + at[2] % n_theta, (i == at[0]) & (j == at[1])

    def particles(self) -> Particles:
        """The cells as weighted particles at their centres, so that every estimator applies."""
        with np.errstate(divide="ignore"):  # log 0 = -inf is what an empty cell means
            return Particles(self.poses.reshape(3, -1), np.log(self.p).ravel())

    def __repr__(self) -> str:
        shape = " x ".join(str(n) for n in self.p.shape)
        return f"PoseGrid({shape} cells, bounds {self.bounds}, lost {self.lost:.1e})"


def uniform_grid(shape: tuple[int, int, int], bounds: Bounds) -> PoseGrid:
    """Know nothing: the same probability in each of n_x * n_y * n_theta cells.

    Parameters
    ----------
    shape : (n_x, n_y, n_theta)
    bounds : (x_min, x_max, y_min, y_max), metres, for example ``world.bounds``

    Returns
    -------
    PoseGrid

    Raises
    ------
    ShapeError, ParameterError
        If the shape is not three whole numbers >= 1, or the box is empty.
    """
    return PoseGrid(np.full(shape, 1 / math.prod(shape)), bounds)


def gaussian_grid(
    shape: tuple[int, int, int], bounds: Bounds, mean: ArrayLike, sigma: ArrayLike
) -> PoseGrid:
    r"""Know the pose up to independent Gaussian errors, the heading's wrapped.

    .. math:: p_{ijk} \propto \mathcal N(x_i; \bar x, \sigma_x^2)\,
              \mathcal N(y_j; \bar y, \sigma_y^2)\, \mathcal N(\mathrm{wrap}(\theta_k -
              \bar\theta); 0, \sigma_\theta^2)

    Parameters
    ----------
    shape : (n_x, n_y, n_theta)
    bounds : (x_min, x_max, y_min, y_max), metres
    mean : array_like (3,), metres and radians
    sigma : array_like (3,), standard deviations > 0, metres and radians
        Much less than a cell, and the grid cannot show it.

    Returns
    -------
    PoseGrid

    Raises
    ------
    ShapeError, ParameterError
        If a shape is wrong, the box is empty, or a sigma is not positive.
    """
    grid = uniform_grid(shape, bounds)
    mean, sigma = np.asarray(mean), np.asarray(sigma)
    x, y, theta = grid.poses
    errors = (x - mean[0], y - mean[1], wrap(theta - mean[2]))
    log_p = np.zeros(grid.p.shape)
    for error, sd in zip(errors, sigma, strict=True):
        log_p += log_gaussian(error, sd)
    return replace(grid, p=np.exp(normalise(log_p.ravel())[0]).reshape(grid.p.shape))
