"""Plaza 2: a robot mower that hears the distance to four radio beacons.

It drove 1.35 km in seven minutes on grass; GPS was the referee (J. Djugash, B. Hamner,
S. Roth, *Navigating with ranging radios: five data sets with ground truth*, Journal of Field
Robotics 26(9), 2009). The files in ``data/plaza2`` are text made from the copy that the
gtsam library ships under the BSD licence.

Two traps of this log. Its ranges read metres too long, differently for each beacon. And the
heading column of the truth points backwards: it holds the course minus pi. The loader turns
it round, so that ``truth`` has the convention of the whole package.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from pfkit.datasets.text import line_of_row, read_table
from pfkit.datasets.timeline import merge
from pfkit.errors import DataError
from pfkit.geometry import wrap
from pfkit.log import Log
from pfkit.maps import LandmarkMap

MARGIN = 20.0  # metres by which the lawn reaches beyond the beacons


def is_plaza(folder: Path) -> bool:
    """Whether a folder looks like Plaza: it has ranges and beacons."""
    names = {f.name.removesuffix(".gz") for f in folder.iterdir()} if folder.is_dir() else set()
    return bool(names & {"ranges.txt", "beacons.txt"})


def read_plaza(folder: Path, source: str) -> Log:
    """Read and join the four files; see `pfkit.datasets.load_plaza`."""
    rows = read_table(folder / "odometry.txt", ("time", "distance", "turn"))
    seen = read_table(folder / "ranges.txt", ("time", "sender", "beacon", "range"))
    beacons = read_table(folder / "beacons.txt", ("beacon", "x", "y"))
    truth = read_table(folder / "truth.txt", ("time", "x", "y", "heading"))
    truth[3] = wrap(truth[3] + np.pi)
    (x0, y0), (x1, y1) = beacons[1:].min(axis=1) - MARGIN, beacons[1:].max(axis=1) + MARGIN
    world = LandmarkMap(beacons[1:], beacons[0].astype(np.int64), (x0, x1, y0, y1))
    unknown = np.flatnonzero(~np.isin(seen[2], world.ids))
    if unknown.size:
        line = line_of_row(folder / "ranges.txt", unknown[0])
        raise DataError(
            f"{folder / 'ranges.txt'}, line {line}: beacon {seen[2, unknown[0]]:g} is not in "
            "beacons.txt; delete the line or add the beacon"
        )
    command = _as_commands(folder, rows, truth[0, 0])
    return merge(command, seen[[0, 3, 2]], truth, world, source, start=command[0, 0])


def _as_commands(folder: Path, rows: np.ndarray, t_truth: float) -> np.ndarray:
    """Turn "driven since the last row" into speeds that hold until the next row: (3, N + 1)."""
    t, distance, turn = rows
    t0 = t_truth if t_truth < t[0] else t[0] - np.median(np.diff(t))
    dt = np.diff(t, prepend=t0)
    if not (dt > 0).all():
        line = line_of_row(folder / "odometry.txt", int(np.argmin(dt)))
        raise DataError(
            f"{folder / 'odometry.txt'}, line {line}: no time passed since the last row"
        )
    v, omega = np.append(distance / dt, 0.0), np.append(turn / dt, 0.0)
    return np.stack((np.append(t0, t), v, omega))
