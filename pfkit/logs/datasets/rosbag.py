"""Bags of ROS 1 and ROS 2, read with the `rosbags` library (``pip install 'pfkit[logs]'``).

A bag holds messages of many topics. We need three kinds: the odometer's pose (``Odometry``), the
scans (``LaserScan``) and, from ``/tf_static``, where the scanner sits. A topic with the true pose
is named by an option. Where a bag holds two topics of a kind, one must be chosen. The map comes
from the folder, or else from an ``OccupancyGrid`` in the bag.

A message counts for the time in its header, since the bag's own time is when it was written down.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError, PfkitError
from pfkit.logs.datasets.scans import find_map, is_map, reach, rows_of_scans
from pfkit.logs.datasets.text import in_order, jump_back
from pfkit.logs.datasets.timeline import merge
from pfkit.worlds.log import Log
from pfkit.worlds.occupancy import OccupancyGrid
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
KINDS = {
    "odometry": ("nav_msgs/msg/Odometry",),
    "scan": ("sensor_msgs/msg/LaserScan",),
    "truth": (
        "nav_msgs/msg/Odometry",
        "geometry_msgs/msg/PoseStamped",
        "geometry_msgs/msg/PoseWithCovarianceStamped",
    ),
    "tf": ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage"),
    "map": ("nav_msgs/msg/OccupancyGrid",),
}
STORAGE = (".mcap", ".db3")
UNKNOWN = 0.4  # probability of a cell of which nothing is known: between the usual thresholds


def bags(folder: Path) -> list[Path]:
    """What of a folder the library is to open; nothing if there is no bag in it."""
    if not folder.is_dir():
        return []
    if (folder / "metadata.yaml").is_file():
        return [folder]
    files = sorted(folder.iterdir())
    first = [p for p in files if p.suffix == ".bag"]
    second = [p for p in files if (p / "metadata.yaml").is_file()]
    second = second or [p for p in files if p.suffix in STORAGE]
    return first or second


def read_rosbag(
    folder: Path,
    source: str,
    need_truth: bool = True,
    map_file: Path | None = None,
    topics: dict[str, str | None] | None = None,
) -> Log:
    """Read the bag of a folder; see `pfkit.logs.datasets.load_log`."""
    paths, topics = bags(folder), topics or {}
    try:
        highlevel = importlib.import_module("rosbags.highlevel")
        typesys = importlib.import_module("rosbags.typesys")
    except ImportError:
        raise DataError(f"{paths[0]}: rosbags is not there; pip install 'pfkit[logs]'") from None
    if len(paths) > 1 and paths[0].suffix != ".bag":
        raise DataError(f"{folder}: {len(paths)} bags; name the folder of one of them")
    if need_truth and not topics.get("truth"):
        raise DataError(
            f"{paths[0]}: which topic holds the truth? --truth TOPIC (truth=...); without one use "
            "--start global or --pose"
        )
    try:
        types = typesys.get_typestore(typesys.Stores.ROS2_HUMBLE)
        with highlevel.AnyReader(paths, default_typestore=types) as reader:
            return _read(Bag(paths[0], reader), folder, source, map_file, topics)
    except PfkitError:
        raise
    except Exception as problem:  # whatever the library stumbles over in a damaged file
        what = " ".join(str(problem).split()) or type(problem).__name__
        raise DataError(f"{paths[0]}: cannot be read as a bag ({what}); is it cut off?") from None


class Bag:
    """An open bag: messages by kind."""

    def __init__(self, path: Path, reader: Any) -> None:
        self.path, self.reader = path, reader

    def topic(self, kind: str, named: str | None) -> str:
        """The topic that was named, or the only one of its kind."""
        there = {c.topic: c.msgtype for c in self.reader.connections}
        fit = sorted(t for t, msgtype in there.items() if msgtype in KINDS[kind])
        if named is not None and named not in fit:
            what = f"is a {there[named]}" if named in there else "is not in the bag"
            raise DataError(
                f"{self.path}: topic {named} {what}; for --{kind} there is "
                f"{', '.join(fit) or 'none'}"
            )
        if named is None and len(fit) != 1:
            raise DataError(
                f"{self.path}: {len(fit)} topics of {' or '.join(KINDS[kind])}: "
                f"{', '.join(fit) or 'it holds ' + (', '.join(sorted(there)) or 'nothing')}; "
                f"choose one with --{kind}"
            )
        return named or fit[0]

    def messages(self, *topics: str) -> Iterator[tuple[float, Any]]:
        """Time in seconds and message, of some topics."""
        wanted = [c for c in self.reader.connections if c.topic in topics]
        for connection, stamp, raw in self.reader.messages(wanted) if wanted else ():
            message = self.reader.deserialize(raw, connection.msgtype)
            header = getattr(message, "header", None)
            t = header.stamp.sec + 1e-9 * header.stamp.nanosec if header is not None else 0.0
            yield (t if t > 0 else 1e-9 * stamp), message

    def of_kind(self, kind: str) -> list[str]:
        """All topics of a kind."""
        return sorted({c.topic for c in self.reader.connections if c.msgtype in KINDS[kind]})


def _read(
    bag: Bag, folder: Path, source: str, map_file: Path | None, topics: dict[str, str | None]
) -> Log:
    """Odometry, scans, mounting, truth and map of an open bag, joined."""
    truth_topic = None if not topics.get("truth") else bag.topic("truth", topics["truth"])
    odometry = topics.get("odometry")
    if odometry is None:  # the truth may be of the same type
        left = [topic for topic in bag.of_kind("odometry") if topic != truth_topic]
        odometry = left[0] if len(left) == 1 else None
    odometry = bag.topic("odometry", odometry)
    poses, base = _poses(bag, odometry)
    times, r, phi, r_max, frame = _scans(bag, bag.topic("scan", topics.get("scan")))
    rows, notes = in_order(bag.path, rows_of_scans(times, r, phi, r_max))
    mount, flipped, said = _mounting(bag, base, frame)
    truth = None if truth_topic is None else _poses(bag, truth_topic)[0]
    rig = Rig("laser", "increments", mount=mount, flipped=flipped, r_max=r_max)
    world = _map(bag, folder, map_file)
    return merge(poses, rows, truth, world, source, poses[0, 0], rig, notes=[*notes, *said])


def _poses(bag: Bag, topic: str) -> tuple[Array, str]:
    """Time, x, y and yaw (4, N) of a topic, and the frame that moves."""
    rows, child = [], ""
    for t, message in bag.messages(topic):
        pose = getattr(message.pose, "pose", message.pose)
        rows.append((t, pose.position.x, pose.position.y, *_yaw(bag, topic, pose.orientation)[:1]))
        child = getattr(message, "child_frame_id", child)
    if len(rows) < 2:
        raise DataError(f"{bag.path}: topic {topic} holds {len(rows)} messages; choose another")
    table = np.array(rows, dtype=float).T
    if not np.isfinite(table).all():
        raise DataError(f"{bag.path}: topic {topic} holds a pose that is not finite; repair it")
    back = jump_back(table[0])
    if back is not None:
        by = table[0, back - 1] - table[0, back]
        raise DataError(
            f"{bag.path}: the clock of {topic} jumps back by {by:g} s; cut the bag there"
        )
    return table[:, np.argsort(table[0], kind="stable")], child


def _yaw(bag: Bag, topic: str, q: Any) -> tuple[float, bool]:
    """Heading of a unit quaternion, and whether its z axis points down."""
    R = _rotation(q)
    if R is None:
        raise DataError(f"{bag.path}: topic {topic} holds an orientation (0, 0, 0, 0); repair it")
    return float(np.arctan2(R[1, 0], R[0, 0])), bool(R[2, 2] < 0)


def _rotation(q: Any) -> Array | None:
    """The matrix of a quaternion; None if it is zero."""
    x, y, z, w = (float(part) for part in (q.x, q.y, q.z, q.w))
    norm = x * x + y * y + z * z + w * w
    if not norm > 1e-12:
        return None
    s = 2.0 / norm
    return np.array(
        [
            [1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)],
        ]
    )


def _scans(bag: Bag, topic: str) -> tuple[Array, list[Array], list[Array], float, str]:
    """Times, ranges, directions, the reading that means no return, and the scanner's frame."""
    times, r, phi, r_max, frame = [], [], [], 0.0, ""
    for t, scan in bag.messages(topic):
        ranges = np.array(scan.ranges, dtype=float)
        ranges[ranges < scan.range_min] = np.nan
        times.append(t)
        r.append(ranges)
        phi.append(scan.angle_min + scan.angle_increment * np.arange(ranges.size))
        r_max, frame = float(scan.range_max), scan.header.frame_id
    if not times:
        raise DataError(f"{bag.path}: topic {topic} holds no message; choose another")
    if not 0 < r_max < np.inf:
        r_max = reach(r)
    return np.array(times), r, phi, r_max, frame.lstrip("/")


def _mounting(
    bag: Bag, base: str, frame: str
) -> tuple[tuple[float, float, float], bool, list[str]]:
    """Where the scanner sits, by the chain of static transforms from the robot to it."""
    edges: dict[str, list[tuple[str, Array]]] = {}
    for _, message in bag.messages(*[t for t in bag.of_kind("tf") if t.endswith("tf_static")]):
        for link in message.transforms:
            parent, child = (n.lstrip("/") for n in (link.header.frame_id, link.child_frame_id))
            T = np.eye(4)
            R = _rotation(link.transform.rotation)
            T[:3, :3] = np.eye(3) if R is None else R
            move = link.transform.translation
            T[:3, 3] = move.x, move.y, move.z
            edges.setdefault(parent, []).append((child, T))
            back = np.array(np.linalg.inv(T), dtype=np.float64)
            edges.setdefault(child, []).append((parent, back))
    base = base.lstrip("/") or "base_link"
    todo, seen = [(base, np.eye(4))], {base}
    while todo:
        name, T = todo.pop()
        if name == frame:
            yaw, flipped = float(np.arctan2(T[1, 0], T[0, 0])), bool(T[2, 2] < 0)
            mount = (float(T[0, 3]), float(T[1, 3]), yaw)
            note = (
                f"the scanner sits at ({mount[0]:.3f}, {mount[1]:.3f}) m, turned by "
                f"{np.degrees(yaw):.1f} degrees{', upside down' if flipped else ''}"
            )
            return mount, flipped, [note] if any(mount) or flipped else []
        for child, step in edges.get(name, []):
            if child not in seen:
                seen.add(child)
                todo.append((child, T @ step))
    return (
        (0.0, 0.0, 0.0),
        False,
        [
            f"no static transform leads from {base} to {frame or 'a frame without a name'}; the "
            "scanner is taken to sit at the robot's origin. If it does not: --mount"
        ],
    )


def _map(bag: Bag, folder: Path, named: Path | None) -> OccupancyGrid:
    """The map beside the bag, or else the one inside."""
    beside = any(is_map(p) for p in folder.glob("*.yaml"))
    inside = bag.of_kind("map")
    if named is not None or beside or not inside:
        return find_map(folder, named)
    maps = [message for _, message in bag.messages(inside[0])]
    if not maps:
        raise DataError(f"{bag.path}: topic {inside[0]} holds no map; name one with --map")
    message = maps[-1]
    cells = np.array(message.data, dtype=float).reshape(message.info.height, message.info.width)
    p = np.where(cells < 0, UNKNOWN, cells / 100)
    origin = message.info.origin
    yaw, _ = _yaw(bag, inside[0], origin.orientation)
    place = (float(origin.position.x), float(origin.position.y), yaw)
    return OccupancyGrid(p, round(float(message.info.resolution), 6), place)
