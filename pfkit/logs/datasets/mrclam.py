"""UTIAS MRCLAM: small robots that see the bar codes of fifteen landmarks.

Five robots drove for up to an hour and a half in a room of 15 by 8 metres, past landmarks
that carry bar codes, under a motion-capture system that filmed the truth
(K. Y. K. Leung, Y. Halpern, T. D. Barfoot, H. H. T. Liu, *The UTIAS multi-robot cooperative
localization and mapping dataset*, International Journal of Robotics Research 30(8), 2011).
A measurement names the *bar code* it saw; the map lists *subjects*; a third file joins them.
Subjects 1 to 5 are the other robots: they move, so they are no landmarks, and their
measurements are left out.

Two layouts are read: the official one (``Robot3_Odometry.dat``, ``Barcodes.dat``, ...) and the
one in which one robot's files share a prefix (``ds0_Odometry.dat``, ``ds0_Barcodes.dat``, ...).
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.logs.datasets.text import identities, in_order, read_table, read_truth, refuse
from pfkit.logs.datasets.timeline import merge
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.rig import Rig

ODOMETRY = re.compile(r"(?P<prefix>.*_)Odometry\.dat(\.gz)?")
MARGIN = 1.0  # metres by which the robots' area reaches beyond the landmarks


class Files(NamedTuple):
    """Paths of the five files of one robot's log, and of a sixth that simulations have."""

    odometry: Path
    measurement: Path
    groundtruth: Path
    landmarks: Path
    barcodes: Path
    outlier: Path


def is_mrclam(folder: Path) -> bool:
    """Whether a folder looks like MRCLAM: any ``..._Odometry.dat`` or a bar code file."""
    return folder.is_dir() and any(
        ODOMETRY.fullmatch(f.name) or f.name.split("_")[-1].startswith("Barcodes.dat")
        for f in folder.iterdir()
    )


def mrclam_files(folder: Path, robot: int | None = None) -> Files:
    """Find the five files in either layout.

    Raises
    ------
    DataError
        If there is no odometry file, or several robots and no choice among them.
    """
    prefixes = sorted({m["prefix"] for f in folder.iterdir() if (m := ODOMETRY.fullmatch(f.name))})
    if robot is not None:
        prefixes = [p for p in prefixes if p == f"Robot{robot}_"]
    wanted = "*_Odometry.dat" if robot is None else f"Robot{robot}_Odometry.dat"
    if not prefixes:
        raise DataError(f"{folder / wanted}: no such file; see data/README.md for the layout")
    if len(prefixes) > 1:
        raise DataError(
            f"{folder}: {len(prefixes)} robots ({', '.join(prefixes)}); choose one with robot=N "
            "(--robot N)"
        )
    own = prefixes[0]
    shared = "" if re.fullmatch(r"Robot\d+_", own) else own
    return Files(
        folder / f"{own}Odometry.dat",
        folder / f"{own}Measurement.dat",
        folder / f"{own}Groundtruth.dat",
        folder / f"{shared}Landmark_Groundtruth.dat",
        folder / f"{shared}Barcodes.dat",
        folder / f"{own}Outlier.dat",
    )


def read_mrclam(
    files: Files, source: str, drop_unknown: bool = False, need_truth: bool = True
) -> Log:
    """Read and join the five files; see `pfkit.logs.datasets.load_mrclam`."""
    command = read_table(files.odometry, ("time", "v", "omega"))
    seen = read_table(files.measurement, ("time", "barcode", "range", "bearing"), ordered=False)
    refuse(files.measurement, seen[2] < 0, seen[2], "range must be >= 0, got {:g}; delete the line")
    truth = read_truth(files.groundtruth, need_truth)
    landmarks = read_table(files.landmarks, ("subject", "x", "y", "sd of x", "sd of y"))
    barcodes = read_table(files.barcodes, ("subject", "barcode"))
    ids = identities(files.landmarks, "subject", landmarks[0])
    world = LandmarkMap(landmarks[1:3], ids, _arena(landmarks[1:3]))
    subject = _subjects(files, seen, barcodes, drop_unknown)
    labels = _outliers(files, seen[0]) if files.outlier.is_file() else np.zeros(seen.shape[1])
    rows = np.stack((seen[0], seen[2], seen[3], subject, labels))
    rows, notes = in_order(files.measurement, rows, seen[1])
    rows = rows[:, np.isin(rows[3], ids)]
    false = rows[4] > 0 if files.outlier.is_file() else None
    rig = Rig("range-bearing")
    return merge(command, rows[:4], truth, world, source, command[0, 0], rig, false, notes)


def _outliers(files: Files, t: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Labels of false measurements, which only a simulated log can have."""
    labels = read_table(files.outlier, ("time", "label"))
    if labels.shape[1] != t.size or (labels[0] != t).any():
        raise DataError(f"{files.outlier}: its rows must be those of {files.measurement.name}")
    return labels[1] != 0


def _subjects(
    files: Files, seen: NDArray[np.float64], barcodes: NDArray[np.float64], drop_unknown: bool
) -> NDArray[np.int64]:
    """The subject behind the bar code of every measurement; -1 for one that is to be dropped."""
    subjects, codes = barcodes
    refuse(files.barcodes, subjects % 1 != 0, subjects, "subject must be whole, got {:g}")
    identities(files.barcodes, "bar code", codes)
    order = np.argsort(codes)
    at = order[np.minimum(np.searchsorted(codes[order], seen[1]), codes.size - 1)]
    unknown = codes[at] != seen[1]
    if not drop_unknown:
        refuse(
            files.measurement,
            unknown,
            seen[1],
            f"bar code {{:g}} is not in {files.barcodes.name}; add the code, or drop such rows "
            "(drop_unknown=True, --drop-unknown)",
        )
    return np.where(unknown, -1, subjects[at]).astype(np.int64)


def _arena(positions: NDArray[np.float64]) -> tuple[float, float, float, float]:
    (x0, y0), (x1, y1) = positions.min(axis=1) - MARGIN, positions.max(axis=1) + MARGIN
    return float(x0), float(x1), float(y0), float(y1)
