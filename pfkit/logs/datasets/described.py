"""Tables of one's own, described by a short YAML file.

Most robots write CSV files of their own making. Nobody can guess what is in them, but a page of
YAML can say it: ``log.yaml`` in the folder names each file and each of its columns, with its unit.
``pfkit describe FOLDER`` drafts it (`describe`); read the draft, it is a guess.

.. code-block:: yaml

    frame: enu              # x east, y north, angles counter-clockwise; or ned, or compass
    odometry:
      file: wheels.csv
      kind: speeds          # v and omega; or increments (distance and turn), or poses (x, y, theta)
      time: {column: stamp, unit: ms}
      v: {column: speed, unit: m/s}
      omega: {column: gyro, unit: deg/s}
    measurements:
      file: seen.csv
      sensor: range-bearing # or range, bearing, laser
      time: {column: stamp, unit: ms, offset: 0.12}
      range: {column: dist, unit: mm}
      bearing: {column: angle, unit: deg}
      landmark: {column: id}
    landmarks:
      file: map.csv
      landmark: {column: id}
      x: {column: east, unit: m}
      y: {column: north, unit: m}
    truth:                  # if there is one; theta may be missing
      file: truth.csv
      time: {column: t, unit: s}
      x: {column: x, unit: m}
      y: {column: y, unit: m}

A ``time`` may have an ``offset`` in seconds, which is added: what a clock was behind. Landmarks
without names have no ``landmark`` under measurements. A laser has, instead of range and bearing,
``beams: {first: r0, count: 181, unit: m, start: -90, step: 1, angle_unit: deg, max: 8}`` and a
``map: map.yaml``. ``mount: [x, y, yaw]`` (metres, radians), ``flipped: true`` and
``bounds: [x0, x1, y0, y1]`` may stand at the left margin. Columns are named as in the file's first
line, or counted from 1 where it has none.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError, PfkitError
from pfkit.geometry import wrap
from pfkit.logs.datasets.scans import find_map, rows_of_scans
from pfkit.logs.datasets.tables import Table, read_columns
from pfkit.logs.datasets.text import identities, in_order, jump_back, refuse
from pfkit.logs.datasets.timeline import merge
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.rig import SENSORS, Rig

Array = NDArray[np.float64]
NAME = "log.yaml"
FRAMES = ("enu", "ned", "compass")
SECTIONS = ("odometry", "measurements", "landmarks", "truth")
SINGLES = ("frame", "map", "mount", "flipped", "bounds")
KINDS = {"speeds": ("v", "omega"), "increments": ("distance", "turn"), "poses": ("x", "y", "theta")}
SECOND, METRE, RADIAN = (
    {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "km": 1e3, "ft": 0.3048, "in": 0.0254},
    {"rad": 1.0, "deg": np.pi / 180},
)
SPEED = {f"{name}/s": value for name, value in METRE.items()} | {"km/h": 1 / 3.6, "mph": 0.44704}
RATE = {"rad/s": 1.0, "deg/s": np.pi / 180, "rpm": 2 * np.pi / 60}
NUMBER = {"": 1.0}
UNITS: dict[str, dict[str, float]] = {
    "time": SECOND,
    **dict.fromkeys(("range", "x", "y", "distance"), METRE),
    **dict.fromkeys(("bearing", "theta", "turn"), RADIAN),
    "v": SPEED,
    "omega": RATE,
    "landmark": NUMBER,
}
ANGLES = ("bearing", "theta", "turn", "omega")  # these run the other way where angles are clockwise
MARGIN = 0.1  # of the landmarks' longest side: how far beyond them the robot may be


def is_described(folder: Path) -> bool:
    """Whether a folder holds a description."""
    return (folder / NAME).is_file()


def read_described(
    folder: Path,
    source: str,
    drop_unknown: bool = False,
    need_truth: bool = True,
    map_file: Path | None = None,
) -> Log:
    """Read the tables that ``log.yaml`` describes; see `pfkit.logs.datasets.load_log`."""
    said = _description(folder / NAME)
    if need_truth and "truth" not in said:
        raise DataError(
            f"{folder / NAME}: no truth is described; without one use --start global or --pose"
        )
    frame = said["frame"]
    moved, odometry, notes = _odometry(folder, said["odometry"], frame)
    rig = _rig(folder / NAME, said, odometry)
    if rig.sensor == "laser":
        named = folder / str(said["map"]) if "map" in said else None
        world: Any = find_map(folder, map_file or named)
        rows, late = _scans(folder, said["measurements"], rig)
    else:
        world = _landmarks(folder, said, frame)
        rows, late = _sightings(folder, said["measurements"], rig, world, drop_unknown, frame)
    truth = _truth(folder, said["truth"], frame) if "truth" in said else None
    return merge(moved, rows, truth, world, source, moved[0, 0], rig, notes=[*notes, *late])


def _description(path: Path) -> dict[str, Any]:
    """The YAML file, with what must be in it."""
    try:
        import yaml
    except ImportError:
        raise DataError(
            f"{path}: PyYAML is not there to read it; pip install 'pfkit[logs]'"
        ) from None
    try:
        said = yaml.safe_load(path.read_text(encoding="utf-8-sig"))
    except (yaml.YAMLError, UnicodeDecodeError) as problem:
        what = " ".join(str(problem).split())
        raise DataError(f"{path}: no sound YAML ({what}); indent with blanks") from None
    if not isinstance(said, dict):
        raise DataError(f"{path}: it must say odometry: and measurements:; {DRAFT}")
    strange = [key for key in said if key not in (*SECTIONS, *SINGLES)]
    if strange:
        raise DataError(f"{path}: {strange[0]!r} is none of {', '.join((*SECTIONS, *SINGLES))}")
    if said.get("frame") not in FRAMES:
        raise DataError(
            f"{path}: frame must be one of {', '.join(FRAMES)}, got {said.get('frame')!r}; enu: "
            "angles run counter-clockwise from x; ned: x north, y east; compass: headings "
            "clockwise from y (north)"
        )
    for section in ("odometry", "measurements"):
        if section not in said:
            raise DataError(f"{path}: {section} is missing; {DRAFT}")
    for section in SECTIONS:
        if section in said and not (isinstance(said[section], dict) and "file" in said[section]):
            raise DataError(f"{path}: {section} must name its file and columns; {DRAFT}")
    return said


DRAFT = "'pfkit describe FOLDER' drafts a description"


def _columns(folder: Path, section: dict[str, Any], *names: str) -> tuple[Table, dict[str, Array]]:
    """Columns of one section in SI units, by name."""
    path = folder / str(section["file"])
    wanted = {}
    for name in names:
        entry = section.get(name)
        entry = entry if isinstance(entry, dict) else {"column": entry}
        if entry.get("column") is None:
            raise DataError(f"{folder / NAME}: {path.name} needs {name}: {{column:, unit:}}")
        wanted[name] = entry
    table = read_columns(path, [entry["column"] for entry in wanted.values()])
    found = {}
    for (name, entry), column in zip(wanted.items(), table.rows, strict=True):
        units, unit = UNITS[name], str(entry.get("unit", ""))
        if unit not in units:
            raise DataError(
                f"{folder / NAME}: {name} of {path.name} needs a unit, one of {', '.join(units)}; "
                f"got {unit!r}"
            )
        found[name] = column * units[unit] + float(entry.get("offset", 0.0))
        _require_likely(folder / NAME, path, name, unit, found[name])
    return table, found


def _require_likely(description: Path, path: Path, name: str, unit: str, values: Array) -> None:
    """Refuse angles that turn more than once: they are in other units than the description says."""
    if name == "bearing" and np.percentile(np.abs(values), 90) > 2 * np.pi + 0.1:
        raise DataError(
            f"{description}: bearing of {path.name} reaches {np.abs(values).max():.4g} rad if its "
            f"unit is {unit}; is it deg?"
        )


def _clockwise(found: dict[str, Array], frame: str) -> dict[str, Array]:
    """Columns of a frame as ours: x east, y north, angles counter-clockwise from x."""
    if frame == "enu":
        return found
    turned = {name: -v if name in ANGLES else v for name, v in found.items()}
    if frame == "ned" and "x" in found:
        turned["x"], turned["y"] = found["y"], found["x"]
    if "theta" in found:
        turned["theta"] = wrap(np.pi / 2 - found["theta"])
    return turned


def _in_time(path: Path, t: Array) -> None:
    """Refuse a time that runs backwards: a jump of the clock by that name."""
    if (np.diff(t) >= 0).all():
        return
    back = jump_back(t)
    row = int(np.flatnonzero(np.diff(t) < 0)[0]) + 1 if back is None else back
    what = "the clock jumps back" if back is not None else "time runs backwards"
    raise DataError(
        f"{path}: {what} by {t[row - 1] - t[row]:g} s at row {row + 1}; "
        + ("cut the file there" if back is not None else "sort the file")
    )


def _odometry(folder: Path, section: dict[str, Any], frame: str) -> tuple[Array, str, list[str]]:
    """Time and speeds (3, N), or time and poses (4, N), and which of them."""
    kind = section.get("kind")
    if kind not in KINDS:
        raise DataError(
            f"{folder / NAME}: odometry needs kind, one of {', '.join(KINDS)}; got {kind!r}"
        )
    table, found = _columns(folder, section, "time", *KINDS[kind])
    _in_time(table.path, found["time"])
    found = _clockwise(found, frame)
    rows = np.stack([found[name] for name in ("time", *KINDS[kind])])
    if kind != "increments":
        return rows, "speeds" if kind == "speeds" else "increments", []
    t, distance, turn = rows
    pause = float(np.median(np.diff(t))) if t.size > 1 else 1.0
    dt = np.diff(t, prepend=t[0] - pause)
    if not (dt > 0).all():
        raise DataError(f"{table.path}: two increments at {t[dt <= 0][0]:g} s; delete one row")
    v, omega = np.append(distance / dt, 0.0), np.append(turn / dt, 0.0)
    return np.stack((np.append(t[0] - pause, t), v, omega)), "speeds", []


def _rig(path: Path, said: dict[str, Any], odometry: str) -> Rig:
    """The rig that the description states."""
    section = said["measurements"]
    sensor = section.get("sensor")
    if sensor not in SENSORS:
        raise DataError(
            f"{path}: measurements need sensor, one of {', '.join(SENSORS)}; got {sensor!r}"
        )
    beams = section.get("beams")
    needed = {"first", "count", "start", "step", "max"}
    if sensor == "laser" and not (isinstance(beams, dict) and needed <= set(beams)):
        raise DataError(
            f"{path}: a laser needs beams: {{first: r0, count: 181, start: -90, step: 1, "
            "angle_unit: deg, max: 8}"
        )
    try:
        return Rig(
            sensor,
            odometry,
            "landmark" in section or sensor == "laser",
            said.get("mount", (0.0, 0.0, 0.0)),
            bool(said.get("flipped", False)),
            float(beams["max"]) if sensor == "laser" else np.inf,
        )
    except (PfkitError, TypeError, ValueError) as problem:
        raise DataError(f"{path}: {problem}") from None


def _landmarks(folder: Path, said: dict[str, Any], frame: str) -> LandmarkMap:
    """The map of landmarks, with the bounds that are stated or a margin about them."""
    if "landmarks" not in said:
        raise DataError(f"{folder / NAME}: landmarks is missing; {DRAFT}")
    table, found = _columns(folder, said["landmarks"], "landmark", "x", "y")
    ids = identities(table.path, "landmark", found["landmark"])
    found = _clockwise(found, frame)
    places = np.stack((found["x"], found["y"]))
    low, high = places.min(axis=1), places.max(axis=1)
    margin = max(MARGIN * float((high - low).max()), 1e-3)
    bounds = said.get(
        "bounds", (low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin)
    )
    try:
        return LandmarkMap(places, ids, bounds)
    except PfkitError as problem:
        raise DataError(f"{folder / NAME}: {problem}") from None


def _sightings(
    folder: Path,
    section: dict[str, Any],
    rig: Rig,
    world: LandmarkMap,
    drop_unknown: bool,
    frame: str,
) -> tuple[Array, list[str]]:
    """Time and the rows of z, sorted by time."""
    table, found = _columns(folder, section, "time", *rig.rows)
    found = _clockwise(found, frame)
    if "range" in found:
        refuse(table.path, found["range"] < 0, found["range"], "range is {:g}; delete the line")
    if "bearing" in found:
        found["bearing"] = wrap(found["bearing"])
    rows = np.stack([found[name] for name in ("time", *rig.rows)])
    names = found.get("landmark")
    rows, notes = in_order(table.path, rows, names)
    if names is None:
        return rows, notes
    known = np.isin(rows[-1], world.ids)
    if not known.all() and not drop_unknown:
        raise DataError(
            f"{table.path}: landmark {rows[-1, ~known][0]:g} is not in the map, which has "
            f"{world.ids.tolist()}; add it, or drop such rows (drop_unknown=True, --drop-unknown)"
        )
    return rows[:, known], notes


def _scans(folder: Path, section: dict[str, Any], rig: Rig) -> tuple[Array, list[str]]:
    """Time, range and bearing of every beam, sorted by time."""
    beams = section["beams"]
    unit, angle = str(beams.get("unit", "m")), str(beams.get("angle_unit", "rad"))
    if unit not in METRE or angle not in RADIAN:
        raise DataError(f"{folder / NAME}: beams in {unit!r} and {angle!r}; use m and rad, or deg")
    table, found = _columns(folder, section, "time")
    wide = read_columns(folder / str(section["file"]), [beams["first"]], int(beams["count"]))
    r = list(wide.rows.T * METRE[unit])
    step = float(beams["step"]) * RADIAN[angle]
    phi = float(beams["start"]) * RADIAN[angle] + step * np.arange(int(beams["count"]))
    rows = rows_of_scans(found["time"], r, [np.array(phi)] * len(r), rig.r_max)
    return in_order(table.path, rows)


def _truth(folder: Path, section: dict[str, Any], frame: str) -> Array:
    """Time, x, y and heading (4, N); NaN headings where none is described."""
    names = ("time", "x", "y", "theta") if "theta" in section else ("time", "x", "y")
    table, found = _columns(folder, section, *names)
    _in_time(table.path, found["time"])
    found = _clockwise(found, frame)
    found.setdefault("theta", np.full(found["x"].size, np.nan))
    return np.stack([found[name] for name in ("time", "x", "y", "theta")])
