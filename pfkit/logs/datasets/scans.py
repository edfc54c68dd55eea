"""Scans of a laser as rows of measurements, and the map they were taken on.

A scan is many ranges at one instant. Formats say differently that a beam met nothing: infinity, the
maximum, a number beyond it, zero, minus one. Here each such reading becomes r_max, and what is no
number at all is left out.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.worlds.occupancy import OccupancyGrid

Array = NDArray[np.float64]
SHARED = 0.005  # share of readings at the very maximum that makes it "no return"


def rows_of_scans(t: Array, r: list[Array], phi: list[Array], r_max: float) -> Array:
    """Measurements (3, N): time, range, bearing; no return reads r_max.

    Parameters
    ----------
    t : array (n,), seconds, one per scan
    r, phi : n arrays (K,), metres and radians
    r_max : float, metres
    """
    times = np.repeat(t, [ranges.size for ranges in r])
    ranges, angles = np.concatenate(r), np.concatenate(phi)
    heard = ~np.isnan(ranges)
    times, ranges, angles = times[heard], ranges[heard], angles[heard]
    return np.stack((times, np.where((ranges > 0) & (ranges < r_max), ranges, r_max), angles))


def reach(r: list[Array]) -> float:
    """The range that means "no return" where a format does not say: the shared maximum, if any."""
    ranges = np.concatenate(r)
    ranges = ranges[np.isfinite(ranges)]
    if not ranges.size:
        raise DataError(
            "no beam of any scan met anything; is the laser's topic or file the right one?"
        )
    top = float(ranges.max())
    return top if np.mean(ranges >= top * (1 - 1e-6)) >= SHARED else top * (1 + 1e-6)


def find_map(folder: Path, named: Path | None) -> OccupancyGrid:
    """The map that was named, or the only one in a folder.

    Raises
    ------
    DataError
        If there is none, or more than one.
    """
    if named is not None:
        return OccupancyGrid.load(named)
    found = [p for p in sorted([*folder.glob("*.yaml"), *folder.glob("*.yml")]) if is_map(p)]
    if len(found) != 1:
        there = ", ".join(p.name for p in found) or "none"
        raise DataError(
            f"{folder}: a laser needs one map (a .yaml of map_server beside its picture), found "
            f"{there}; name it with --map (map=...)"
        )
    return OccupancyGrid.load(found[0])


def is_map(path: Path) -> bool:
    """Whether a YAML file is a map's: it names an image."""
    return any(line.startswith(b"image:") for line in path.read_bytes().splitlines())
