r"""The likelihood field: score a laser beam by where it ends.

The beam model asks, for every particle, how far each beam should fly; that takes a ray cast.
The likelihood field asks something cheaper: if the robot were there, the beam would end *here*;
how far is the nearest wall from here?

.. math:: q = z_{hit}\, \mathcal N(D(x_{end});\, 0, \sigma_{hit}^2)
              + \frac{z_{rand}}{r_{max}}

with the distance field D computed once for the map. So each beam costs one look into a table.
It is smooth, too: a small error of the pose changes D a little, whereas a beam that just misses
a door post jumps to the wall behind it. Filters with few particles like that.

What it gives up: it does not notice that a beam flew *through* a wall, and it explains nobody
who stands in the way. And it is no density in r: it cannot be sampled, and its log evidence is
not comparable with that of a beam model.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, ParameterError, require_array, require_fields
from pfkit.models.sensors import Sensor
from pfkit.worlds.distance import distance_field
from pfkit.worlds.occupancy import OccupancyGrid

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LikelihoodField(Sensor):
    """Score beams by the distance from their end to the nearest wall: columns z_k = (r, phi).

    Parameters
    ----------
    world : OccupancyGrid
    r_max : float, metres, > 0
        Readings of r_max or more end nowhere and are left out.
    sigma_hit : float, metres, > 0
        How far an end may be from a wall: sensor noise and the map's own errors together.
    z_hit, z_rand : float in [0, 1]
        Shares of readings that end at a wall, and of unexplained ones; at most 1 together.

    Raises
    ------
    ParameterError
        If a parameter is out of range.

    Notes
    -----
    Source: Probabilistic Robotics, section 6.4 and Table 6.3. Distances are those of cell
    centres, so an end is placed to within half a cell. Ends outside the map count as
    unexplained.
    Cost: one look-up per beam and particle.
    """

    world: OccupancyGrid
    r_max: float
    sigma_hit: float = 0.2
    z_hit: float = 0.95
    z_rand: float = 0.05
    components: ClassVar[int] = 2
    angles: ClassVar[tuple[int, ...]] = (1,)

    def __post_init__(self) -> None:
        require_fields(
            self,
            r_max="finite and > 0",
            sigma_hit="finite and > 0",
            z_hit="in [0, 1]",
            z_rand="in [0, 1]",
        )
        hit, rand = self.z_hit, self.z_rand
        if not 0 < hit + rand <= 1 + 1e-9:
            raise ParameterError(f"z_hit + z_rand must be in (0, 1], got {hit + rand}")
        scaled = distance_field(self.world.occupied, self.world.resolution) / self.sigma_hit
        peak = hit / (self.sigma_hit * math.sqrt(2 * math.pi))
        rim = np.pad(peak * np.exp(-0.5 * scaled * scaled), 1)  # one cell of "outside"
        with np.errstate(divide="ignore"):  # without z_rand an end far from walls is impossible
            log_q = np.log(rim + rand / self.r_max)
        object.__setattr__(self, "_log_q", log_q)

    def log_density(self, zk: Array, pose: Array) -> Array:
        """Log q of one reading (r, phi) at poses (3, ...): shape (...)."""
        return self.log_likelihood(zk[:, None], pose)

    def log_likelihood(self, z: ArrayLike, pose: Array) -> Array:
        """Sum of log q over the beams: z (2, K) or (2, K, B, 1), one number per pose."""
        z = self.read(z)
        require_array("ranges", z[0], rule=">= 0", error=DataError)
        x, y, theta = self.check_state(pose)
        rows, columns = self._log_q.shape  # type: ignore[attr-defined]
        log_q = self._log_q.ravel()  # type: ignore[attr-defined]
        heading = theta - self.world.origin[2]
        ahead, aside = np.cos(heading), np.sin(heading)
        column, row = self.world.to_cells(x, y) + 1.0  # the rim comes first
        along = z[0] * np.cos(z[1]) / self.world.resolution
        across = z[0] * np.sin(z[1]) / self.world.resolution
        total = np.zeros(x.shape)
        for rk, a, b in zip(z[0], along, across, strict=True):
            i = np.clip(column + a * ahead - b * aside, 0, columns - 1).astype(np.int64)
            j = np.clip(row + a * aside + b * ahead, 0, rows - 1).astype(np.int64)
            total += np.where(rk < self.r_max, np.take(log_q, j * columns + i), 0.0)
        return total
