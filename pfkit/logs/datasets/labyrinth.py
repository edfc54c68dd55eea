"""The Labyrinth data set: a small robot, four UWB radios, and a description that does not hold.

A robot with two wheels drives 9 m in a square of 2.4 m; four anchors in the corners measure the
distance to it (T. Pfeifer, *The Labyrinth Dataset*, TU Chemnitz, in the libRSF collection, CC BY-SA
4.0). A file holds lines of several kinds, each with its name first: ``range2`` (time, range,
variance, the anchor's x and y, its number, a quality), ``odom2diff`` (time, speed of the right and
of the left wheel, a sideways speed, the distance between the wheels, three variances) and
``point2`` (time, x, y), the truth, which has no heading.

The file says which wheel is which and how far apart they stand. Neither need be true, and a wrong
answer sends dead reckoning through the wall. So we do not believe it: of the six combinations of
exchanged wheels and of one, two or half the track we take the one whose path fits best, after a
shift and a turn, to the truth; without a truth, to the ranges. What was found is said in the notes.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.logs.datasets.text import LARGEST, in_order, jump_back, read_text
from pfkit.logs.datasets.timeline import held_controls, merge
from pfkit.logs.odometry import Drift, Preintegrated
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
KINDS = {"range2": 7, "odom2diff": 8, "point2": 3}  # numbers that a line of each kind must have
REACH = 0.15  # of the anchors' longest side: how far beyond them the robot may be
SURE = 0.8  # a combination must fit better than what the file says by this factor


def is_labyrinth(folder: Path) -> bool:
    """Whether a text file in the folder starts with one of the kinds of line."""
    return bool(_files(folder))


def _files(folder: Path) -> list[Path]:
    if not folder.is_dir():
        return []
    found = [p for p in sorted(folder.iterdir()) if p.suffix == ".txt" and p.is_file()]
    return [p for p in found if _first_word(p) in KINDS]


def _first_word(path: Path) -> str:
    with path.open("rb") as file:
        return file.read(40).split(b" ")[0].decode("ascii", "replace")


def read_labyrinth(folder: Path, source: str, need_truth: bool = True) -> Log:
    """Read and join the lines of all files; see `pfkit.logs.datasets.load_log`."""
    lines = {kind: [] for kind in KINDS}  # type: dict[str, list[list[float]]]
    for path in _files(folder):
        _collect(path, lines)
    for kind, what in (("range2", "ranges"), ("odom2diff", "odometry")):
        if not lines[kind]:
            raise DataError(f"{folder}: no line {kind} ({what}) in its text files")
    if need_truth and not lines["point2"]:
        raise DataError(
            f"{folder}: no line point2 (the truth); without one use --start global or --pose"
        )
    rows, wheels = np.array(lines["range2"]).T, np.array(lines["odom2diff"]).T
    world = _anchors(folder, rows)
    measured, notes = in_order(folder, rows[[0, 1, 5]], rows[5])
    wheels = wheels[:, np.argsort(wheels[0], kind="stable")]
    truth = None
    if lines["point2"]:
        t, x, y = np.array(sorted(lines["point2"])).T
        truth = np.stack((t, x, y, np.full_like(t, np.nan)))
    command, said = _commands(wheels, truth, measured, world)
    return merge(
        command, measured, truth, world, source, command[0, 0], Rig("range"), None, notes + said
    )


def _collect(path: Path, lines: dict[str, list[list[float]]]) -> None:
    """Add the numbers of a file's lines to the lists of their kinds."""
    for number, line in enumerate(read_text(path).splitlines(), start=1):
        kind, *words = line.split() or [""]
        if not kind or kind.startswith("#"):
            continue
        where = f"{path}, line {number}"
        if kind not in KINDS:
            raise DataError(f"{where}: {kind!r:.30} is none of {', '.join(KINDS)}; delete the line")
        try:
            values = [float(word) for word in words]
        except ValueError:
            raise DataError(f"{where}: {kind} must be followed by numbers; repair it") from None
        if len(values) < KINDS[kind]:
            raise DataError(f"{where}: {kind} needs {KINDS[kind]} numbers, got {len(values)}")
        values = values[: KINDS[kind]]
        if not (np.abs(values) <= LARGEST).all():
            raise DataError(f"{where}: a number is not finite or absurd: {words}; repair the line")
        if kind == "range2" and values[1] < 0:
            raise DataError(f"{where}: range must be >= 0, got {values[1]:g}; delete the line")
        lines[kind].append(values)
    for kind in ("odom2diff", "point2"):
        t = np.array([row[0] for row in lines[kind]])
        if (back := jump_back(t)) is not None:
            raise DataError(
                f"{path}: the clock of {kind} jumps back by {t[back - 1] - t[back]:g} s at "
                f"{t[back]:.10g}; cut the file there"
            )


def _anchors(folder: Path, rows: Array) -> LandmarkMap:
    """The map that the range lines carry: each anchor's number and place."""
    ids, first, own = np.unique(rows[5], return_index=True, return_inverse=True)
    places = rows[3:5, first]
    moved = np.hypot(*(rows[3:5] - places[:, own])) > 1e-6
    if moved.any():
        name = rows[5, moved][0]
        raise DataError(f"{folder}: anchor {name:g} stands in two places; a map is fixed")
    if (ids % 1 != 0).any():
        raise DataError(f"{folder}: anchors must have whole numbers, got {ids.tolist()}")
    low, high = places.min(axis=1), places.max(axis=1)
    reach = REACH * (high - low).max()
    (x0, y0), (x1, y1) = low - reach, high + reach
    return LandmarkMap(places, ids.astype(np.int64), (x0, x1, y0, y1))


def _commands(
    wheels: Array, truth: Array | None, measured: Array, world: LandmarkMap
) -> tuple[Array, list[str]]:
    """Speeds (3, N) of the best of six readings of the wheels, and what was found."""
    t, right, left, _, track = wheels[:5]
    speed = (right + left) / 2
    misfit = {}
    for sign in (1.0, -1.0):
        for scale in (1.0, 2.0, 0.5):
            command = np.stack((t, speed, sign * (right - left) / (scale * track)))
            misfit[sign, scale] = _misfit(command, truth, measured, world)
    best = min(misfit, key=lambda key: misfit[key])
    if misfit[best] > SURE * misfit[1.0, 1.0]:
        best = (1.0, 1.0)
    sign, scale = best
    command = np.stack((t, speed, sign * (right - left) / (scale * track)))
    if best == (1.0, 1.0):
        return command, []
    found = ["the wheel columns are exchanged"] if sign < 0 else []
    found += (
        [f"the wheels stand {scale:g} times as far apart as the file says"] if scale != 1 else []
    )
    by = "the truth" if truth is not None else "the ranges"
    return command, [
        f"{' and '.join(found)}: such a path fits {by} to {misfit[best]:.2f} m, "
        f"the file's own only to {misfit[1.0, 1.0]:.2f} m"
    ]


def _misfit(command: Array, truth: Array | None, measured: Array, world: LandmarkMap) -> float:
    """How far, in metres, a dead-reckoned path is from truth or ranges after the best fit."""
    t = truth[0] if truth is not None else measured[0]
    inside = (t >= command[0, 0]) & (t <= command[0, -1])
    instants = np.union1d(command[0], t[inside])
    u = held_controls(instants, *command)
    path = Preintegrated(u, Drift()).path[:, 1:]
    o = (path[0] + 1j * path[1])[np.searchsorted(instants, t[inside])]
    if truth is not None:
        p = (truth[1] + 1j * truth[2])[inside]
        p, o = p - p.mean(), o - o.mean()
        turn = np.exp(1j * np.angle(np.sum(p * np.conj(o))))
        return float(np.sqrt(np.mean(np.abs(p - turn * o) ** 2)))
    return _misfit_of_ranges(o, measured[:, inside], world)


def _misfit_of_ranges(o: Array, measured: Array, world: LandmarkMap) -> float:
    """The least median error of ranges over a grid of starts, each anchor's own bias removed."""
    x0, x1, y0, y1 = world.bounds
    _, r, s = measured
    anchors = world.locate(s)
    xs, ys = np.linspace(x0, x1, 21), np.linspace(y0, y1, 21)[:, None]
    starts = (xs + 1j * ys).reshape(-1, 1)
    least = np.inf
    for turn in np.exp(1j * np.linspace(0, 2 * np.pi, 36, endpoint=False)):
        error = r - np.abs(starts + turn * (o - o[0]) - (anchors[0] + 1j * anchors[1]))
        for name in world.ids:
            error[:, s == name] -= np.median(error[:, s == name], axis=1, keepdims=True)
        least = min(least, float(np.median(np.abs(error), axis=1).min()))
    return least
