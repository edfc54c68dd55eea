"""Real logs, read into `Log`: MRCLAM (range and bearing) and Plaza 2 (range only).

A folder is looked for in three places: the argument itself, then the environment variable
``PFKIT_DATA`` (a log folder, or a folder of log folders), then the course's ``data/``.

Controls are u = (v, omega, dt) for `VelocityMotion`. Time starts at 0; the steps are the
instants of the odometry *and* of the measurements, and ``log.scored`` marks the former. Where
the truth is unknown it is NaN.
"""

from __future__ import annotations

import os
from pathlib import Path

from pfkit.errors import DataError, as_path
from pfkit.logs.datasets.mrclam import is_mrclam, mrclam_files, read_mrclam
from pfkit.logs.datasets.plaza import is_plaza, read_plaza
from pfkit.worlds.log import Log

__all__ = ["find_folder", "load_log", "load_mrclam", "load_plaza"]

WHERE = (
    "get MRCLAM from asrl.utias.utoronto.ca/datasets/mrclam, unpack one MRCLAM_DatasetN, and "
    "name that folder in the call or in the environment variable PFKIT_DATA"
)


def find_folder(name: str | Path | None, is_layout=None) -> Path:
    """Find a log folder: the path itself, then ``PFKIT_DATA``, then the course's ``data/``.

    Parameters
    ----------
    name : path, or the name of a folder in one of these places, or None for the first that fits
    is_layout : function Path -> bool, optional
        What counts as a log folder; any known layout if left out.

    Raises
    ------
    DataError
        If there is none; says where to get a log and how to lay it out.
    """
    fits = is_layout or (lambda folder: is_mrclam(folder) or is_plaza(folder))
    if name is not None and as_path("folder", name).exists():
        return Path(name)
    data = Path(__file__).parents[3] / "data"
    roots = [Path(os.environ["PFKIT_DATA"])] if os.environ.get("PFKIT_DATA") else []
    for root in (*roots, data):
        inside = sorted(root.iterdir()) if root.is_dir() else []
        for folder in (root, *inside) if name is None else (root / name,):
            if fits(folder):
                return folder
    what = "no log folder" if name is None else f"{name}: no such log folder"
    raise DataError(f"{what} (tried PFKIT_DATA and data/, too); {WHERE}; see data/README.md")


def load_mrclam(
    folder: str | Path | None = None,
    robot: int | None = None,
    drop_unknown: bool = False,
    need_truth: bool = True,
) -> Log:
    """Load one robot's MRCLAM log.

    Parameters
    ----------
    folder : path, optional
        ``MRCLAM_Dataset4`` or a folder of ``ds0_*.dat``; searched for by `find_folder`.
    robot : int, optional
        Which robot, where the folder holds several.
    drop_unknown : bool
        Drop measurements whose bar code is not listed (misread ones) instead of refusing.
    need_truth : bool
        Refuse a log without ground truth. With False one is read, too; its truth and start are
        None, so that it can be localised from a global start and cannot be scored.

    Returns
    -------
    Log with z of shape (3, K): range (m), bearing (rad), landmark (the subject's number)

    Raises
    ------
    DataError
        One line with file, line and reason.
    """
    found = find_folder(folder, is_mrclam)
    if not found.is_dir():
        raise DataError(f"{found}: not a folder; name the folder that holds the log")
    files = mrclam_files(found, robot)
    return read_mrclam(files, f"MRCLAM, {found.name}", drop_unknown, need_truth)


def load_plaza(folder: str | Path | None = None, need_truth: bool = True) -> Log:
    """Load the range-only log Plaza 2.

    Parameters
    ----------
    folder : path, optional
        A folder with odometry.txt, ranges.txt, beacons.txt, truth.txt.
    need_truth : bool
        As in `load_mrclam`.

    Returns
    -------
    Log with z of shape (2, K): range (m), beacon id

    Raises
    ------
    DataError
        One line with file, line and reason.
    """
    found = find_folder(folder, is_plaza)
    if not found.is_dir():
        raise DataError(f"{found}: not a folder; name the folder that holds the log")
    return read_plaza(found, f"Plaza, {found.name}", need_truth)


def load_log(
    folder: str | Path | None = None,
    robot: int | None = None,
    drop_unknown: bool = False,
    need_truth: bool = True,
) -> Log:
    """Load a log of either layout, recognised by its file names.

    Parameters
    ----------
    folder : path, optional
        Where the files are; else the environment variable PFKIT_DATA, else ``data/``.
    robot : int, optional
        Which robot of a folder with several; the only one if left out.
    drop_unknown : bool
        Leave out measurements of bar codes that the map does not know, instead of an error.
    need_truth : bool
        As in `load_mrclam`.

    Returns
    -------
    Log

    Raises
    ------
    DataError
        If the folder holds no log that can be read; the message names file, line and reason.
    """
    found = find_folder(folder)
    if is_plaza(found):
        return load_plaza(found, need_truth)
    if is_mrclam(found):
        return load_mrclam(found, robot, drop_unknown, need_truth)
    raise DataError(
        f"{found}: neither *_Odometry.dat (MRCLAM) nor ranges.txt (Plaza) in it; {WHERE}"
    )
