"""CARMEN: one text file, a message a line.

The navigation toolkit of Carnegie Mellon wrote its logs like that, and many classic ones are still
passed round so. A line starts with its kind and ends with a time stamp, a computer's name and the
logger's time:

* ``ODOM`` x y theta, speeds, acceleration: the pose that the wheels have added up;
* ``FLASER`` n, n ranges, the laser's pose, the odometer's pose: a scan over the front half circle;
* ``ROBOTLASER1`` a laser's geometry, n, n ranges, the poses of laser and robot;
* ``TRUEPOS`` the true pose, the odometer's pose: simulators write it.

Other kinds are passed over. Some logs were *corrected*: the first pose of each scan is then not the
laser's on the drifting odometer but where the robot really was. We look which it is. If the two
poses differ by the same motion all the time, that motion is the laser's mounting; if they drift
apart, the first one is taken as the truth. Either is said.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.geometry import between
from pfkit.logs.datasets.scans import find_map, reach, rows_of_scans
from pfkit.logs.datasets.text import LARGEST, in_order, jump_back, read_text
from pfkit.logs.datasets.timeline import merge
from pfkit.worlds.log import Log
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
KINDS = ("ODOM", "FLASER", "ROBOTLASER1", "TRUEPOS", "PARAM")
ENDINGS = (".log", ".clf", ".carmen", ".txt", ".gz")
SICK = 80.0  # metres: above it the scanner of those years has codes, not ranges
FIXED = 0.05  # metres and radians within which two poses differ "by the same motion"


@dataclass
class Messages:
    """What the lines of a file said; poses with their time first."""

    odometry: list[list[float]] = field(default_factory=list)
    truth: list[list[float]] = field(default_factory=list)
    laser: list[list[float]] = field(default_factory=list)
    robot: list[list[float]] = field(default_factory=list)
    r: list[Array] = field(default_factory=list)
    phi: list[Array] = field(default_factory=list)
    r_max: float = 0.0
    offset: float = 0.0


def carmen_file(folder: Path) -> Path | None:
    """The first file of a folder that holds CARMEN's messages."""
    if not folder.is_dir():
        return None
    files = [p for p in sorted(folder.iterdir()) if p.suffix in ENDINGS and p.is_file()]
    return next((p for p in files if _speaks(p)), None)


def _speaks(path: Path) -> bool:
    try:
        head = read_text(path)[:20000].splitlines()
    except DataError:
        return False
    return any(line.split(" ", 1)[0] in KINDS for line in head[:200])


def read_carmen(
    folder: Path, source: str, need_truth: bool = True, map_file: Path | None = None
) -> Log:
    """Read a CARMEN log and the map beside it; see `pfkit.logs.datasets.load_log`."""
    path = carmen_file(folder)
    if path is None:
        raise DataError(f"{folder}: no file with CARMEN's messages ({', '.join(KINDS)})")
    said = _parse(path)
    if not said.r:
        raise DataError(f"{path}: no scan in it (FLASER or ROBOTLASER1); nothing to localise by")
    laser, robot = np.array(said.laser).T, np.array(said.robot).T
    poses = np.array(said.odometry).T if len(said.odometry) > 1 else robot
    mount, truth, notes = _poses(said, laser, robot, poses)
    if need_truth and truth is None:
        raise DataError(
            f"{path}: no truth in it (TRUEPOS, or scans with corrected poses); without one use "
            "--start global or --pose"
        )
    for name, stream in (("ODOM", poses), ("truth", truth)):
        if stream is not None and (back := jump_back(stream[0])) is not None:
            by = stream[0, back - 1] - stream[0, back]
            raise DataError(
                f"{path}: the clock of {name} jumps back by {by:g} s; cut the file there"
            )
    r_max = said.r_max or min(reach(said.r), SICK)
    rows, late = in_order(path, rows_of_scans(laser[0], said.r, said.phi, r_max))
    poses = poses[:, np.argsort(poses[0], kind="stable")]
    rig = Rig("laser", "increments", mount=mount, r_max=r_max)
    world = find_map(folder, map_file)
    return merge(poses, rows, truth, world, source, poses[0, 0], rig, notes=[*late, *notes])


def _parse(path: Path) -> Messages:
    """All messages of a file."""
    said = Messages()
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        kind, *words = line.split() or [""]
        if kind not in KINDS:
            continue
        try:
            _take(said, kind, words)
        except (ValueError, IndexError):
            raise DataError(
                f"{path}, line {number}: {kind} is cut short or holds a word where a number "
                "belongs; repair or delete the line"
            ) from None
    return said


def _take(said: Messages, kind: str, words: list[str]) -> None:
    """File one message; ValueError or IndexError if it is damaged."""
    if kind == "PARAM":
        if words[0] == "robot_frontlaser_offset":
            said.offset = float(words[1])
        return
    if kind == "ODOM":
        said.odometry.append([_stamp(words, 6), *_finite(words[:3])])
    elif kind == "TRUEPOS":
        said.truth.append([_stamp(words, 6), *_finite(words[:3])])
    elif kind == "FLASER":
        n = int(words[0])
        _scan(said, words, 1, n, _half_circle(n), n + 1)
    else:
        start, step, r_max, n = float(words[1]), float(words[3]), float(words[4]), int(words[7])
        said.r_max = r_max
        remissions = int(words[8 + n])
        _scan(
            said, words, 8, n, np.array(start + step * np.arange(n), float), 9 + n + remissions, 5
        )


def _scan(
    said: Messages, words: list[str], first: int, n: int, phi: Array, at: int, between: int = 0
) -> None:
    """File one scan: its ranges, and the two poses that follow."""
    r = np.array(words[first : first + n], dtype=float)
    if n < 1 or r.size != n:
        raise ValueError
    t = _stamp(words, at + 6 + between)
    laser, robot = _finite(words[at : at + 3]), _finite(words[at + 3 : at + 6])
    said.r.append(r)
    said.phi.append(phi)
    said.laser.append([t, *laser])
    said.robot.append([t, *robot])


def _half_circle(n: int) -> Array:
    """Directions of n beams over the front half circle: an even number leaves the last one out."""
    step = np.pi / (n - 1 if n % 2 else n) if n > 1 else 0.0
    return np.asarray(-np.pi / 2 + step * np.arange(n), dtype=np.float64)


def _finite(words: list[str]) -> list[float]:
    values = [float(word) for word in words]
    if len(values) != 3 or not (np.abs(values) <= LARGEST).all():
        raise ValueError
    return values


def _stamp(words: list[str], at: int) -> float:
    """The time stamp behind a message's numbers; the logger's where there is none."""
    t = float(words[at])
    t = t if t > 0 or len(words) < at + 3 else float(words[at + 2])
    if not abs(t) <= LARGEST:
        raise ValueError
    return t


def _poses(
    said: Messages, laser: Array, robot: Array, poses: Array
) -> tuple[tuple[float, float, float], Array | None, list[str]]:
    """The laser's mounting, the truth if there is one, and what was found."""
    seat = between(robot[1:], laser[1:])
    usual = np.median(seat, axis=1)
    mount = (said.offset, 0.0, 0.0)
    truth = np.array(said.truth).T if said.truth else None
    if (np.abs(between(usual[:, None], seat)) < FIXED).all():
        if np.hypot(*usual[:2]) > 1e-3 or abs(usual[2]) > 1e-3:
            mount = (float(usual[0]), float(usual[1]), float(usual[2]))
        x, y, yaw = mount
        note = f"the laser sits at ({x:.3f}, {y:.3f}) m, turned by {np.degrees(yaw):.1f} degrees"
        return mount, truth, [note] if any(mount) else []
    if truth is not None:
        return mount, truth, []
    return mount, laser, ["the scans carry corrected poses, which are taken as the truth"]
