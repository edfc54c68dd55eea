"""Real logs, read into `Log`: one table of layouts, one reader for each.

A folder is looked for in three places: the argument itself, then the environment variable
``PFKIT_DATA`` (a log folder, or a folder of log folders), then the course's ``data/``. Its layout
is recognised by the names, or the first words, of its files; a folder of no known layout is
answered with what was found in it and with what each layout would need.

A log states its `Rig`. Time starts at 0; the steps are the instants of the odometry *and* of the
measurements, and ``log.scored`` marks the former. Where the truth is unknown it is NaN. What a
reader mended or decided stands in ``log.notes``.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from pfkit.errors import DataError
from pfkit.logs.datasets.carmen import carmen_file, read_carmen
from pfkit.logs.datasets.described import is_described, read_described
from pfkit.logs.datasets.labyrinth import is_labyrinth, read_labyrinth
from pfkit.logs.datasets.mrclam import is_mrclam, mrclam_files, read_mrclam
from pfkit.logs.datasets.plaza import is_plaza, read_plaza
from pfkit.logs.datasets.rosbag import bags, read_rosbag
from pfkit.worlds.log import Log

__all__ = ["LAYOUTS", "Wanted", "find_folder", "load_log", "load_mrclam", "load_plaza"]

WHERE = (
    "get MRCLAM from asrl.utias.utoronto.ca/datasets/mrclam, unpack one MRCLAM_DatasetN, and "
    "name that folder in the call or in the environment variable PFKIT_DATA"
)


@dataclass(frozen=True)
class Wanted:
    """What the caller says about a folder; see `load_log`."""

    robot: int | None = None
    drop_unknown: bool = False
    need_truth: bool = True
    map: Path | None = None
    odometry: str | None = None
    scan: str | None = None
    truth: str | None = None


class Layout(NamedTuple):
    """A way in which people lay out a log.

    Attributes
    ----------
    fits : function (folder) -> bool
    read : function (folder, Wanted) -> Log
    needs : str, the files of it
    """

    fits: Callable[[Path], bool]
    read: Callable[[Path, Wanted], Log]
    needs: str


def _is_saved(folder: Path) -> bool:
    return (folder / "steps.txt").is_file() or (folder / "measurements.txt").is_file()


def _saved(folder: Path, wanted: Wanted) -> Log:
    from pfkit.logs.logfile import read_log  # which reads its tables with this package's `text`

    log = read_log(folder)
    if wanted.need_truth and log.start is None:
        raise DataError(
            f"{folder / 'start.txt'}: no such file; a known start needs it. Without one, use "
            "--start global or --pose"
        )
    return replace(log, source=log.source or f"saved, {folder.name}")


def _mrclam(folder: Path, wanted: Wanted) -> Log:
    files = mrclam_files(folder, wanted.robot)
    source = f"MRCLAM, {folder.name}"
    return read_mrclam(files, source, wanted.drop_unknown, wanted.need_truth)


def _plaza(folder: Path, wanted: Wanted) -> Log:
    return read_plaza(folder, f"Plaza, {folder.name}", wanted.need_truth)


def _labyrinth(folder: Path, wanted: Wanted) -> Log:
    return read_labyrinth(folder, f"Labyrinth, {folder.name}", wanted.need_truth)


def _carmen(folder: Path, wanted: Wanted) -> Log:
    return read_carmen(folder, f"CARMEN, {folder.name}", wanted.need_truth, wanted.map)


def _described(folder: Path, wanted: Wanted) -> Log:
    source = f"described, {folder.name}"
    return read_described(folder, source, wanted.drop_unknown, wanted.need_truth, wanted.map)


def _rosbag(folder: Path, wanted: Wanted) -> Log:
    topics = {"odometry": wanted.odometry, "scan": wanted.scan, "truth": wanted.truth}
    source = f"bag, {folder.name}"
    return read_rosbag(folder, source, wanted.need_truth, wanted.map, topics)


LAYOUTS = {
    "described": Layout(is_described, _described, "log.yaml, and the tables that it names"),
    "saved": Layout(_is_saved, _saved, "steps.txt and measurements.txt, as save_log writes them"),
    "MRCLAM": Layout(is_mrclam, _mrclam, "*_Odometry.dat, *_Measurement.dat, *Barcodes.dat"),
    "Plaza": Layout(is_plaza, _plaza, "odometry.txt, ranges.txt and beacons.txt"),
    "Labyrinth": Layout(is_labyrinth, _labyrinth, "*.txt with lines range2 and odom2diff"),
    "rosbag": Layout(
        lambda folder: bool(bags(folder)),
        _rosbag,
        "*.bag, *.mcap, *.db3 or a folder with metadata.yaml, and a map (.yaml)",
    ),
    "CARMEN": Layout(
        lambda folder: carmen_file(folder) is not None,
        _carmen,
        "*.log with lines FLASER or ROBOTLASER1, and a map (.yaml)",
    ),
}


def find_folder(name: str | Path | None, is_layout: Callable[[Path], bool] | None = None) -> Path:
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
    fits = is_layout or (lambda folder: any(layout.fits(folder) for layout in LAYOUTS.values()))
    if name is not None and Path(name).exists():
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
    found = _folder(find_folder(folder, is_mrclam))
    return _mrclam(found, Wanted(robot, drop_unknown, need_truth))


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
    return _plaza(_folder(find_folder(folder, is_plaza)), Wanted(need_truth=need_truth))


def load_log(
    folder: str | Path | None = None,
    robot: int | None = None,
    drop_unknown: bool = False,
    need_truth: bool = True,
    *,
    map: str | Path | None = None,
    odometry: str | None = None,
    scan: str | None = None,
    truth: str | None = None,
) -> Log:
    """Load a log of any layout that is known, recognised by its files.

    Parameters
    ----------
    folder : path, optional
        Where the files are; else the environment variable PFKIT_DATA, else ``data/``.
    robot : int, optional
        Which robot of a folder with several; the only one if left out.
    drop_unknown : bool
        Leave out measurements of landmarks that the map does not know, instead of an error.
    need_truth : bool
        As in `load_mrclam`.
    map : path, optional
        The YAML file of a laser's map, if it is not the only one in the folder.
    odometry, scan, truth : str, optional
        Topics of a bag that holds several, or a truth.

    Returns
    -------
    Log

    Raises
    ------
    DataError
        If the folder holds no log that can be read; the message names file, line and reason.
    """
    found = find_folder(folder)
    wanted = Wanted(
        robot,
        drop_unknown,
        need_truth,
        None if map is None else Path(map),
        odometry,
        scan,
        truth,
    )
    for layout in LAYOUTS.values():
        if layout.fits(found):
            return layout.read(found, wanted)
    raise DataError(_unknown(_folder(found)))


def _folder(found: Path) -> Path:
    if not found.is_dir():
        raise DataError(f"{found}: not a folder; name the folder that holds the log")
    return found


def _unknown(folder: Path) -> str:
    """What to say of a folder of no known layout: what is there, and what each would need."""
    names = sorted(p.name for p in folder.iterdir())
    there = ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")
    needs = "; ".join(f"{name}: {layout.needs}" for name, layout in LAYOUTS.items())
    return (
        f"{folder}: no log of a known layout in it. There is {there or 'nothing'}. "
        f"Known are {needs}. If these are tables of numbers, 'pfkit describe {folder}' drafts "
        "a log.yaml"
    )
