"""A first draft of ``log.yaml``, by looking at the tables of a folder.

Names of columns say most: ``t``, ``vel``, ``range_mm``, ``heading [deg]``. Where they say no unit,
the size of the numbers does: a bearing of 170 is no radian, a stamp of 1.7e18 counts nanoseconds.
What each file is follows from what it holds and from its own name. All of it is a guess, and the
draft says so; what is missing is asked for.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.logs.datasets.described import METRE, NAME, RADIAN, RATE, SECOND, SPEED
from pfkit.logs.datasets.scans import is_map
from pfkit.logs.datasets.tables import read_columns, split_lines

Array = NDArray[np.float64]
ENDINGS = (".csv", ".txt", ".tsv", ".dat")
MEANINGS = {  # what a column may be called, in the order in which we look
    "time": r"t|.*time.*|.*stamp.*|secs?|seconds|nsec|msec",
    "landmark": r".*landmark.*|.*beacon.*|.*tag.*|.*anchor.*|.*marker.*|.*feature.*|id|.*_id",
    "omega": r"w|omega|.*ang.*vel.*|.*angular.*|.*gyro.*|.*yaw.?rate.*|.*turn.?rate.*|rv",
    "v": r"v|vx|vel.*|.*speed.*|.*linear.*|.*forward.*|tv",
    "bearing": r"bearing.*|phi.*|azimuth.*|angle.*|beta.*|direction.*",
    "range": r"r|range.*|dist|dist_.*|.*measured.*dist.*|rho.*",
    "distance": r"distance.*|delta_?s.*|ds|travel.*|ticks",
    "turn": r"turn.*|dtheta.*|delta_?theta.*|dyaw.*",
    "theta": r"theta.*|yaw.*|heading.*|psi.*|orientation.*|th",
    "x": r"x|.*_x|x_.*|pos.*x|east.*",
    "y": r"y|.*_y|y_.*|pos.*y|north.*",
}
FILES = {
    "truth": r"truth|gt|ground|reference|mocap|vicon|gps|optitrack",
    "landmarks": r"map|landmark|beacon|anchor|marker|feature",
    "odometry": r"odom|wheel|control|command|encoder|drive",
    "measurements": r"meas|seen|obs|range|scan|laser|lidar|sight|detect|uwb",
}
ORDER = {  # columns of a file without names
    "odometry": {3: ("time", "v", "omega"), 4: ("time", "x", "y", "theta")},
    "measurements": {
        3: ("time", "range", "landmark"),
        4: ("time", "landmark", "range", "bearing"),
    },
    "landmarks": {3: ("landmark", "x", "y"), 5: ("landmark", "x", "y", "", "")},
    "truth": {3: ("time", "x", "y"), 4: ("time", "x", "y", "theta")},
}
BEAM = re.compile(r"(?:r|range|beam|scan|d)[_\[]?(\d+)\]?$", re.I)
UNIT = re.compile(r"[\[(].*?[\])]|_(mm|cm|km|m|deg|rad|ms|us|ns|s|mps|dps)$")
LARGE = 6.5  # radians: an angle beyond a full turn is in degrees


def describe(folder: Path) -> str:
    """Write ``log.yaml`` into a folder and return what it says.

    Parameters
    ----------
    folder : path

    Returns
    -------
    str, the text of the draft

    Raises
    ------
    DataError
        If there is a description already, or no table in the folder.
    """
    path = folder / NAME
    if not folder.is_dir():
        raise DataError(f"{folder}: not a folder; name the folder that holds the tables")
    if path.exists():
        raise DataError(f"{path}: is there already; remove it if you want a new draft")
    tables = {}
    for file in sorted(folder.iterdir()):
        if file.suffix.lower() in ENDINGS and file.is_file():
            try:
                tables[file] = _meanings(file)
            except DataError:  # notes and licences are no tables
                continue
    if not tables:
        raise DataError(f"{folder}: no table of numbers in it ({', '.join(ENDINGS)})")
    text = _draft(folder, tables)
    path.write_text(text, encoding="utf-8")
    return text


def _meanings(path: Path) -> dict[str, str | int]:
    """What the columns of a file seem to be: meaning -> name or number."""
    names, body = split_lines(path)
    if any(len(words) != len(body[0][1]) for _, words in body[:50]):
        raise DataError(f"{path}: its rows are of different length")
    for word in body[0][1]:
        float(word) if word else None
    if not names:
        kind = _by_name(path)
        order = ORDER.get(kind, {}).get(len(body[0][1]), ())
        return {meaning: i + 1 for i, meaning in enumerate(order) if meaning}
    found: dict[str, str | int] = {}
    beams = [name for name in names if BEAM.fullmatch(name)]
    if len(beams) > 4:
        found["beams"] = beams[0]
        found["count"] = len(beams)
    for meaning, pattern in MEANINGS.items():
        for name in names:
            bare = UNIT.sub("", name).strip()
            taken = name in found.values() or name in beams
            if not taken and re.fullmatch(pattern, bare, re.I):
                found[meaning] = name
                break
    return found


def _by_name(path: Path) -> str:
    """What a file's own name says that it is; nothing if it says nothing."""
    return next((kind for kind, p in FILES.items() if re.search(p, path.stem, re.I)), "")


def _role(path: Path, has: dict[str, str | int]) -> str:
    """What a file is: by what it holds, and where that fits two, by its name."""
    named = _by_name(path)
    if "beams" in has or (("range" in has or "bearing" in has) and "time" in has):
        return "measurements"
    if "time" not in has and {"x", "y"} <= set(has):
        return "landmarks"
    if {"v", "omega"} <= set(has) or {"distance", "turn"} <= set(has):
        return "odometry"
    if {"time", "x", "y"} <= set(has):
        return "odometry" if named == "odometry" and "theta" in has else "truth"
    return ""


def _draft(folder: Path, tables: dict[Path, dict[str, str | int]]) -> str:
    """The text of the description."""
    roles: dict[str, Path] = {}
    for path, has in tables.items():
        role = _role(path, has)
        if role and role not in roles:
            roles[role] = path
    lines = [
        "# A first draft, by 'pfkit describe': every line is a guess. Check columns and units.",
        "frame: enu  # or ned, or compass (headings clockwise from north)",
    ]
    for section in ("odometry", "measurements", "landmarks", "truth"):
        if section in roles:
            lines += [f"{section}:", *_section(section, roles[section], tables[roles[section]])]
    maps = [p.name for p in sorted(folder.glob("*.yaml")) if is_map(p)]
    lines += [f"map: {name}" for name in maps[:1]]
    for section in ("odometry", "measurements"):
        if section not in roles:
            lines.append(f"# {section}: no file seems to hold it; add it")
    return "\n".join([*lines, ""])


def _section(section: str, path: Path, has: dict[str, str | int]) -> list[str]:
    """The lines of one section."""
    wanted, lines = ["time"], [f"  file: {path.name}"]
    if section == "odometry":
        kinds = {"speeds": ["v", "omega"], "increments": ["distance", "turn"]}
        kind = next((k for k, names in kinds.items() if set(names) <= set(has)), "poses")
        wanted += kinds.get(kind, ["x", "y", "theta"])
        lines.append(f"  kind: {kind}")
    elif section == "measurements" and "beams" in has:
        lines += ["  sensor: laser", *_beams(path, has)]
    elif section == "measurements":
        rows = [name for name in ("range", "bearing") if name in has]
        wanted += rows + (["landmark"] if "landmark" in has else [])
        lines.append(f"  sensor: {'-'.join(rows)}")
    elif section == "landmarks":
        wanted = ["landmark", "x", "y"]
    else:
        wanted += ["x", "y"] + (["theta"] if "theta" in has else [])
    for name in wanted:
        if name not in has:
            lines.append(f"  {name}: {{column: ?}}  # which?")
            continue
        unit = _unit(name, path, has[name])
        said = f", unit: {unit}" if unit else ""
        lines.append(f"  {name}: {{column: {_quoted(has[name])}{said}}}")
    return lines


def _quoted(column: str | int) -> str:
    return str(column) if isinstance(column, int) else "'" + column.replace("'", "''") + "'"


def _beams(path: Path, has: dict[str, str | int]) -> list[str]:
    """A laser's beams: half a circle is the usual guess."""
    count = int(has["count"])
    step = 180.0 / (count - 1)
    names, body = split_lines(path)
    at = names.index(str(has["beams"]))
    top = max(float(word) for _, words in body[:200] for word in words[at : at + count])
    return [
        f"  beams: {{first: {_quoted(has['beams'])}, count: {count}, unit: m, start: -90, "
        f"step: {step:.6g}, angle_unit: deg, max: {top:g}}}  # check directions and max"
    ]


def _unit(meaning: str, path: Path, column: str | int) -> str:
    """The unit in a column's name, or the one that its numbers suggest."""
    units = {
        "time": SECOND,
        "v": SPEED,
        "omega": RATE,
        **dict.fromkeys(("bearing", "theta", "turn"), RADIAN),
        **dict.fromkeys(("range", "x", "y", "distance"), METRE),
    }.get(meaning)
    if units is None:
        return ""
    words = re.split(r"[_\s\[\]()]+", str(column)) if isinstance(column, str) else []
    spoken = {"mps": "m/s", "dps": "deg/s", "degrees": "deg", "sec": "s"}
    for word in reversed(words[1:]):
        if spoken.get(word, word) in units:
            return spoken.get(word, word)
    values = read_columns(path, [column]).rows[0]
    size = float(np.percentile(np.abs(values), 95))
    if meaning == "time":
        instants = np.unique(values)
        pause = float(np.median(np.diff(instants))) if instants.size > 1 else 0.0
        for limit, unit in ((1e17, "ns"), (1e14, "us"), (1e11, "ms")):
            if size > limit:
                return unit
        return "ms" if pause >= 5 and (values % 1 == 0).all() else "s"
    if meaning in ("bearing", "theta", "turn"):
        return "deg" if size > LARGE else "rad"
    if meaning == "omega":
        return "deg/s" if size > LARGE else "rad/s"
    if meaning == "v":
        return "mm/s" if size > 50 else "m/s"
    return "mm" if size > 500 else "m"
