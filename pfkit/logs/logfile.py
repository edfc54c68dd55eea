r"""Log files: a drive in a folder of small text tables.

A log that is saved can be looked at, mailed, and filtered tomorrow with another program. One
folder holds one drive:

===================  ==============================================================
file                 rows
===================  ==============================================================
`steps.txt`          one per step: time, the control u1 u2 ..., the true state x1 x2 ...
`measurements.txt`   one per measurement: its step (from 0), z1 z2 ..., 1 if false
`start.txt`          the true state before the first step
`landmarks.txt`      the map: id, x, y; or `map.yaml` and `map.pgm` for a grid
`bounds.txt`         with landmarks: x_min, x_max, y_min, y_max
`rig.txt`            what u and z mean: sensor, odometry, named, mount, flipped, r_max
===================  ==============================================================

Numbers are separated by blanks. The first line, which starts with ``#``, names the columns; a
second one may say where the log came from. Without a truth, labels or a map the columns or
files are left out.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, ShapeError, require_count
from pfkit.logs.datasets.text import read_table
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.occupancy import OccupancyGrid
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
RIG = "rig.txt"


def save_log(log: Log, folder: str | Path, digits: int = 17) -> None:
    """Write a log to a folder, which is made if need be.

    Parameters
    ----------
    log : Log of one drive
    folder : path
    digits : int, significant digits; 17 keep every bit

    Raises
    ------
    ShapeError
        If the log holds a batch.
    """
    if log.u.ndim != 2:
        raise ShapeError(f"only single drives can be saved, got u {log.u.shape}; pick one run")
    require_count("digits", digits)
    folder = Path(folder)
    rows = [log.t[None], log.u] + ([] if log.truth is None else [log.truth])
    names = ["time", *_numbered("u", log.u), *_numbered("x", log.truth)]
    folder.mkdir(parents=True, exist_ok=True)
    _write(folder / "steps.txt", names, np.concatenate(rows), digits, log.source)
    _write(folder / "measurements.txt", *_flatten(log), digits)
    if log.start is not None:
        _write(folder / "start.txt", _numbered("x", log.start), log.start[:, None], digits)
    if isinstance(log.world, LandmarkMap):
        world = np.concatenate((log.world.ids[None].astype(float), log.world.positions))
        _write(folder / "landmarks.txt", ["id", "x", "y"], world, digits)
        bounds = np.array(log.world.bounds)[:, None]
        _write(folder / "bounds.txt", ["x_min", "x_max", "y_min", "y_max"], bounds, digits)
    elif isinstance(log.world, OccupancyGrid):
        log.world.save(folder / "map.yaml")
    if log.rig is not None:
        (folder / RIG).write_text(_rig_text(log.rig), encoding="utf-8")


def read_log(folder: str | Path) -> Log:
    """Read a log that `save_log` wrote.

    Parameters
    ----------
    folder : path

    Returns
    -------
    Log

    Raises
    ------
    DataError
        With file, line and reason, if a table is missing or damaged.
    """
    folder = Path(folder)
    steps, source = _read(folder / "steps.txt")
    u, truth = (np.array([steps[n] for n in steps if n.startswith(c)]) for c in "ux")
    T = len(steps["time"])
    z, false = _unflatten(folder / "measurements.txt", T)
    start, _ = _read(folder / "start.txt") if (folder / "start.txt").exists() else ({}, "")
    return Log(
        t=steps["time"],
        u=u,
        z=z,
        truth=truth if truth.size else None,
        start=np.concatenate(list(start.values())) if start else None,
        world=_read_world(folder),
        source=source,
        outlier=false,
        rig=_read_rig(folder / RIG),
    )


def _rig_text(rig: Rig) -> str:
    """A line for each part of a rig: its name, then what it is."""
    lines = [f"sensor {rig.sensor}", f"odometry {rig.odometry}", f"named {int(rig.named)}"]
    lines.append("mount " + " ".join(repr(part) for part in rig.mount))
    return "\n".join([*lines, f"flipped {int(rig.flipped)}", f"r_max {rig.r_max!r}", ""])


def _read_rig(path: Path) -> Rig | None:
    """The rig that a folder states, if it does."""
    if not path.is_file():
        return None
    said = dict(line.split(None, 1) for line in path.read_text("utf-8").splitlines() if line)
    try:
        x, y, yaw = (float(word) for word in said["mount"].split())
        return Rig(
            said["sensor"].strip(),
            said["odometry"].strip(),
            bool(int(said["named"])),
            (x, y, yaw),
            bool(int(said["flipped"])),
            float(said["r_max"]),
        )
    except KeyError as missing:
        raise DataError(f"{path}: no line {missing}; save_log writes it") from None
    except ValueError as problem:
        raise DataError(f"{path}: {problem}; save_log writes it") from None


def _numbered(letter: str, rows: ArrayLike | None) -> list[str]:
    """Names x1, x2, ... for the rows of an array."""
    return [] if rows is None else [f"{letter}{i + 1}" for i in range(len(np.asarray(rows)))]


def _flatten(log: Log) -> tuple[list[str], Array]:
    """All measurements side by side, each with its step and its label: (1 + n + 1, sum K)."""
    counts = [zk.shape[1] for zk in log.z]
    rows = [np.repeat(np.arange(float(len(log))), counts)[None], np.concatenate(log.z, axis=1)]
    names = ["step", *_numbered("z", rows[1])]
    if log.outlier is not None:
        rows.append(np.concatenate(log.outlier)[None].astype(float))
        names.append("false")
    return names, np.concatenate(rows)


def _unflatten(path: Path, T: int) -> tuple[list[Array], list[NDArray[np.bool_]] | None]:
    """Measurements and labels of each of T steps."""
    table, _ = _read(path)
    step = table["step"]
    if ((step < 0) | (step >= T) | (step != np.floor(step)) | (np.diff(step, prepend=0) < 0)).any():
        raise DataError(
            f"{path}: steps must be whole numbers in order, 0 to {T - 1}; sort the rows"
        )
    edges = np.searchsorted(step, np.arange(1, T))
    z = np.split(np.stack([table[n] for n in table if n.startswith("z")]), edges, axis=1)
    false = np.split(table["false"] > 0, edges) if "false" in table else None
    return z, false


def _read_world(folder: Path) -> LandmarkMap | OccupancyGrid | None:
    if (folder / "map.yaml").exists():
        return OccupancyGrid.load(folder / "map.yaml")
    if not (folder / "landmarks.txt").exists():
        return None
    landmarks, _ = _read(folder / "landmarks.txt")
    bounds, _ = _read(folder / "bounds.txt")
    x0, x1, y0, y1 = (float(limit[0]) for limit in bounds.values())
    positions = np.stack((landmarks["x"], landmarks["y"]))
    return LandmarkMap(positions, landmarks["id"].astype(np.int64), (x0, x1, y0, y1))


def _write(path: Path, names: list[str], rows: Array, digits: int, source: str = "") -> None:
    lines = ["# " + " ".join(names)] + ([f"# {source}"] if source else [])
    lines += [" ".join(f"{value:.{digits}g}" for value in column) for column in rows.T]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _read(path: Path) -> tuple[dict[str, Array], str]:
    """Columns by the names in the first line, and what the second line says."""
    lines = path.read_text(encoding="utf-8").splitlines()
    comments = [line[2:] for line in lines if line.startswith("# ")]
    if not comments or not lines[0].startswith("# "):
        raise DataError(f"{path}, line 1: must name the columns after '# '; save_log writes it")
    names, source = comments[0].split(), "".join(comments[1:])
    if len(comments) == len(lines):  # names but no rows: nothing was measured
        return {name: np.empty(0) for name in names}, source
    return dict(zip(names, read_table(path, names), strict=True)), source
