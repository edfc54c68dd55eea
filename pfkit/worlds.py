"""Worlds: the maps and routes that the chapters and labs share.

The *arena* is the book's running world: ten metres by eight, four landmarks at unequal
corners so that no symmetry is left, and a route that closes a loop.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pfkit.maps import LandmarkMap


def arena() -> LandmarkMap:
    """The book's running world: 10 m x 8 m, four landmarks, no symmetry."""
    return LandmarkMap(
        np.array([[1.5, 8.6, 6.8, 2.2], [1.2, 1.8, 6.9, 6.4]]), bounds=(0.0, 10.0, 0.0, 8.0)
    )


ARENA_START = np.array([3.0, 2.0, 0.0])


def arena_route(laps: int = 1, dt: float = 0.25) -> NDArray[np.float64]:
    """Controls (3, 72 * laps) of a round of the arena from `ARENA_START`: v, omega, dt.

    A rounded rectangle at 1 m/s: sides of 4 m and 2 m, corners of 1.5 s.
    """
    corner = [np.pi / 3] * 6
    omega = np.array(([0.0] * 16 + corner + [0.0] * 8 + corner) * 2 * laps)
    return np.stack((np.ones_like(omega), omega, np.full_like(omega, dt)))
