"""Plaza 2: a robot mower that hears the distance to four radio beacons.

It drove 1.35 km in seven minutes on grass; GPS was the referee (J. Djugash, B. Hamner,
S. Roth, *Navigating with ranging radios: five data sets with ground truth*, Journal of Field
Robotics 26(9), 2009). The files in ``data/plaza2`` are text made from the copy that the
gtsam library ships under the BSD licence.

Two traps of this log. Its ranges read metres too long, differently for each beacon. And the
heading column of the truth points backwards: it holds the course minus pi. Nobody need know that
here: `headings` sees it in the data and turns the truth round.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.logs.datasets.text import identities, in_order, read_table, read_truth, refuse
from pfkit.logs.datasets.timeline import merge
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
MARGIN = 20.0  # metres by which the lawn reaches beyond the beacons


def is_plaza(folder: Path) -> bool:
    """Whether a folder looks like Plaza: it has ranges and beacons."""
    names = {f.name.removesuffix(".gz") for f in folder.iterdir()} if folder.is_dir() else set()
    return bool(names & {"ranges.txt", "beacons.txt"})


def read_plaza(folder: Path, source: str, need_truth: bool = True) -> Log:
    """Read and join the four files; see `pfkit.logs.datasets.load_plaza`."""
    rows = read_table(folder / "odometry.txt", ("time", "distance", "turn"))
    seen = read_table(folder / "ranges.txt", ("time", "sender", "beacon", "range"), ordered=False)
    beacons = read_table(folder / "beacons.txt", ("beacon", "x", "y"))
    truth = read_truth(folder / "truth.txt", need_truth)
    (x0, y0), (x1, y1) = beacons[1:].min(axis=1) - MARGIN, beacons[1:].max(axis=1) + MARGIN
    ids = identities(folder / "beacons.txt", "beacon", beacons[0])
    world = LandmarkMap(beacons[1:], ids, (x0, x1, y0, y1))
    refuse(
        folder / "ranges.txt",
        ~np.isin(seen[2], ids),
        seen[2],
        "beacon {:g} is not in beacons.txt; delete the line or add the beacon",
    )
    refuse(
        folder / "ranges.txt", seen[3] < 0, seen[3], "range must be >= 0, got {:g}; delete the line"
    )
    command = _as_commands(folder / "odometry.txt", rows, None if truth is None else truth[0, 0])
    measured, notes = in_order(folder / "ranges.txt", seen[[0, 3, 2]], seen[2])
    rig = Rig("range")
    return merge(command, measured, truth, world, source, command[0, 0], rig, notes=notes)


def _as_commands(path: Path, rows: Array, t_truth: float | None) -> Array:
    """Turn "driven since the last row" into speeds that hold until the next row: (3, N + 1)."""
    t, distance, turn = rows
    pause = np.median(np.diff(t)) if t.size > 1 else 1.0
    t0 = t[0] - pause if t_truth is None or t_truth >= t[0] else t_truth
    dt = np.diff(t, prepend=t0)
    refuse(path, dt <= 0, t, "no time passed between the last row and {:g} s; delete the line")
    v, omega = np.append(distance / dt, 0.0), np.append(turn / dt, 0.0)
    return np.stack((np.append(t0, t), v, omega))
