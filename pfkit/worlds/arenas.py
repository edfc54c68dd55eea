"""Worlds: the maps and routes that the chapters and labs share.

The *arena* is the book's running world: ten metres by eight, four landmarks at unequal
corners so that no symmetry is left, and a route that closes a loop.

The symmetric worlds of lab 5 are the opposite: turned by a quarter (or a fifth) of a circle
they look the same. If landmarks have no names, no measurement can tell a pose from its copies.
Their bounding boxes are larger than the landmarks' own, so that every copy of the start lies
inside: a prior that leaves a copy out has decided the question before the robot moved.
`symmetry` finds the copies.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import ParameterError
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.occupancy import OccupancyGrid


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


SQUARE_START = np.array([0.0, 0.0, 0.0])
SQUARE_ROUTE = np.array([[0.0, 15.0, 15.0, 0.0], [0.0, 0.0, 15.0, 15.0]])


def square() -> LandmarkMap:
    """Four landmarks that look the same from four sides: exact symmetry about (7.5, 7.5)."""
    corners = np.array([[10.0, 5.0, 5.0, 10.0], [10.0, 10.0, 5.0, 5.0]])
    return LandmarkMap(corners, bounds=(-2.5, 17.5, -2.5, 17.5))


BROKEN_SQUARE_START = np.array([13.0, 13.0, np.pi])
BROKEN_SQUARE_ROUTE = np.array([[13.0, -2.0, -2.0, 15.0, 15.0], [13.0, 13.0, -2.0, -2.0, 10.0]])


def broken_square() -> LandmarkMap:
    """A square about (5.5, 5.5) and a fifth landmark, (20, 10), that gives the corner away.

    Seen from less than 6 m only, the fifth stays hidden while the robot goes round the square
    along `BROKEN_SQUARE_ROUTE`; the last leg brings it near.
    """
    return LandmarkMap(
        np.array([[10.0, 1.0, 1.0, 10.0, 20.0], [10.0, 10.0, 1.0, 1.0, 10.0]]),
        bounds=(-4.5, 15.5, -4.5, 15.5),
    )


def pentagon(L: int = 10) -> LandmarkMap:
    """Rings of five landmarks about the origin: five copies of every pose, and no mirror.

    Parameters
    ----------
    L : int, 10 or 40
        Two rings or eight. Each ring is turned a little further than the one inside it.

    Raises
    ------
    ParameterError
        If L is neither.
    """
    if L not in (10, 40):
        raise ParameterError(f"the pentagon world has 10 or 40 landmarks, got {L}")
    rings = L // 5
    radius = np.linspace(4.0, 10.0, rings).repeat(5)
    angle = 2 * np.pi / 5 * np.tile(np.arange(5), rings) + 0.35 * np.arange(rings).repeat(5)
    points = radius * np.stack((np.cos(angle), np.sin(angle)))
    return LandmarkMap(points, bounds=(-12.0, 12.0, -12.0, 12.0))


SIX_BEACONS_START = np.array([7.0, 7.0, np.pi / 4])


def six_beacons() -> LandmarkMap:
    """Six beacons that give ranges only, in a 50 m square: the walk-through of a 2014 blog.

    The robot starts at `SIX_BEACONS_START` and advances sqrt 2 m, to (8, 8), and so on.
    """
    return LandmarkMap(
        np.array([[10.0, 15, 30, 25, 35, 40], [20.0, 35, 40, 16, 37, 10]]),
        bounds=(0.0, 50.0, 0.0, 50.0),
    )


CIRCLE_START = np.array([15.0, 10.0, np.pi / 2])


def one_landmark() -> LandmarkMap:
    """A single landmark at (10, 10) that the robot circles at 5 m: it never learns its phase."""
    return LandmarkMap(np.array([[10.0], [10.0]]), bounds=(0.0, 20.0, 0.0, 20.0))


def circle_route(v: float = 0.5, dt: float = 0.5) -> NDArray[np.float64]:
    """Controls (3, T) of one counter-clockwise round from `CIRCLE_START`: v, omega, dt.

    Parameters
    ----------
    v : float, > 0, m/s
    dt : float, > 0, seconds
    """
    T = round(2 * np.pi * 5.0 / (v * dt))
    omega = 2 * np.pi / (T * dt)  # so that T whole steps close the circle
    return np.tile(np.array([[5.0 * omega], [omega], [dt]]), T)


OFFICE_START = np.array([2.0, 4.0, 0.0])
OFFICE_ROUTE = np.array([[1.5, 10.5, 10.5, 1.5], [4.0, 4.0, 1.5, 1.5]])
OFFICE_WALLS = (  # x_min, x_max, y_min, y_max in metres
    *((0.0, 12.0, 0.0, 0.2), (0.0, 12.0, 7.8, 8.0), (0.0, 0.2, 0.0, 8.0), (11.8, 12.0, 0.0, 8.0)),
    *((0.0, 12.0, 3.0, 3.2), (0.0, 12.0, 4.8, 5.0)),  # the corridor
    *((4.4, 4.6, 0.0, 3.0), (8.4, 8.6, 0.0, 3.0), (6.6, 6.8, 5.0, 8.0)),  # between rooms
)
OFFICE_DOORS = (
    *((1.0, 2.0, 3.0, 3.2), (10.0, 11.0, 3.0, 3.2), (3.4, 4.4, 4.8, 5.0), (9.0, 10.0, 4.8, 5.0)),
    *((4.4, 4.6, 1.0, 2.0), (8.4, 8.6, 1.0, 2.0)),
)
OFFICE_FURNITURE = ((5.6, 6.8, 0.2, 0.7), (0.2, 0.8, 6.0, 7.4), (9.8, 10.2, 6.4, 6.8))


def office() -> OccupancyGrid:
    """Five rooms along a corridor, 12 m x 8 m in cells of 0.1 m, for a robot with a laser.

    `OFFICE_ROUTE` goes along the corridor and back through the three lower rooms.
    """
    x = 0.1 * (np.arange(120) + 0.5)
    y = 0.1 * (np.arange(80) + 0.5)[:, None]
    wall = np.zeros((y.size, x.size), dtype=bool)
    for boxes, solid in ((OFFICE_WALLS, True), (OFFICE_DOORS, False), (OFFICE_FURNITURE, True)):
        for x0, x1, y0, y1 in boxes:
            wall[(x0 < x) & (x < x1) & (y0 < y) & (y < y1)] = solid
    return OccupancyGrid(wall, 0.1)
