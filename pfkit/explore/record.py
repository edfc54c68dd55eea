"""Recorded runs: what a page plays before Python has started.

A recording is made by the scene itself, so it shows what the live run will do; because both start
from the same seed, a reader who touches a control goes on from the very frame on the screen.

A few frames a second are stored, and the page moves between them (`tween` in `web/render.js`). Each
record's numbers are rounded to a five-hundredth of their range in the whole run and stored as
differences: of neighbours in one frame, or from the frame before, whichever is smaller. Where the
scene keeps a `lineage`, each particle starts from the one it descends from, so that copies part
from their ancestor before the reader's eyes. `decode` in `web/render.js` is the inverse.
"""

from __future__ import annotations

import base64
import json
import zlib
from collections import Counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.explore.host import report
from pfkit.explore.operations import FEWEST, NUMBER, Operation, operation
from pfkit.explore.pen import STYLES
from pfkit.explore.scene import Scene

LEVELS = 500  # steps in the range of a number: about a pixel
EXACT, BESIDE, BEFORE, DESCENT = range(4)  # how the numbers of a record are stored
CLOUD = STYLES.index("particles")
SETS = (NUMBER["points"], NUMBER["quills"])  # of which the order means nothing
Key = tuple[int, int, int]  # operation, style, how many of the kind came before in the frame


def split(drawing: np.ndarray) -> list[tuple[Key, np.ndarray]]:
    """The records of a drawing, each with a key that it keeps from frame to frame."""
    seen: Counter[tuple[int, int]] = Counter()
    out, i = [], 0
    while i < drawing.size:
        op, style, n = (int(v) for v in drawing[i : i + 3])
        out.append(((op, style, seen[op, style]), drawing[i + 3 : i + 3 + n]))
        seen[op, style] += 1
        i += 3 + n
    return out


def _rows(op: Operation, numbers: np.ndarray) -> np.ndarray | None:
    """The numbers to be rounded, in their rows; None if the record is stored exactly."""
    if not op.rows or numbers.size - op.lead < FEWEST or not np.isfinite(numbers).all():
        return None
    return numbers[op.lead :].reshape(op.rows, -1)


class Packer:
    """Turns the frames of one run into three streams of numbers."""

    def __init__(self, frames: list[list[tuple[Key, np.ndarray]]]):
        self.ranges: dict[tuple[Key, int], tuple[float, float]] = {}
        for frame in frames:
            for key, numbers in frame:
                rows = _rows(operation(key[0]), numbers)
                for k, row in enumerate(rows if rows is not None else ()):
                    low, high = self.ranges.get((key, k), (np.inf, -np.inf))
                    self.ranges[key, k] = min(low, float(row.min())), max(high, float(row.max()))
        self.before: dict[Key, NDArray[np.int64]] = {}
        self.heads: list[int] = []
        self.floats: list[float] = []
        self.ints: list[NDArray[np.int64]] = []

    def add(self, frame: list[tuple[Key, np.ndarray]], lineage: NDArray[np.int64] | None) -> int:
        """Append one frame; returns the number of particles whose descent is stored with it."""
        descent = lineage if self.heads else None  # the first frame descends from none
        if descent is not None:
            self.ints.append(np.diff(descent, prepend=0))
        for key, numbers in frame:
            op = operation(key[0])
            rows = _rows(op, numbers)
            if rows is None:
                self.heads.extend((key[0], key[1], numbers.size, EXACT))
                self.floats.extend(numbers)
                continue
            self.floats.extend(numbers[: op.lead])
            size = lineage.size if lineage is not None and key[1] == CLOUD else -1
            cloud = rows.shape[1] == size and key[0] in SETS
            mode = self._add_rows(key, rows, cloud, descent)
            self.heads.extend((key[0], key[1], numbers.size, mode))
        return 0 if descent is None else descent.size

    def _add_rows(
        self, key: Key, rows: np.ndarray, cloud: bool, descent: NDArray[np.int64] | None
    ) -> int:
        """Round, choose the smaller differences, keep the levels for the next frame."""
        levels = np.stack([self._levels(key, k, row) for k, row in enumerate(rows)])
        before = self.before.get(key)
        if before is not None and before.shape != levels.shape:
            before = None
        if cloud and descent is not None and before is not None:
            own = np.arange(descent.size)
            mode, change = DESCENT, levels - before[:, np.where(descent < 0, own, descent)]
        else:
            if key[0] in SETS and not cloud:
                levels = levels[:, np.lexsort((levels[1], levels[0] // 8))]
            mode, change = BESIDE, np.diff(levels, axis=1, prepend=0)
            if before is not None and np.abs(levels - before).sum() <= np.abs(change).sum():
                mode, change = BEFORE, levels - before
        self.before[key] = levels
        self.ints.append(change.ravel())
        return mode

    def _levels(self, key: Key, k: int, row: np.ndarray) -> NDArray[np.int64]:
        low, scale = self.scale(key, k)
        return np.round((row - low) / scale).astype(np.int64)

    def scale(self, key: Key, k: int) -> tuple[float, float]:
        low, high = self.ranges[key, k]
        return low, (high - low) / LEVELS or 1.0


def record(scene: Scene, steps: int | None = None, every: int | None = None) -> dict[str, Any]:
    """Run `scene` from its seed and return the recording as plain data (JSON-able)."""
    steps, every = steps or scene.record_steps, every or scene.record_every
    scene.reset(scene.seed)
    drawings, lineages, told = [], [], []
    for tick in range(steps + 1):
        if tick % every == 0:
            drawings.append(split(scene.frame()[0]))
            lineages.append(scene.lineage)
            if scene.lineage is not None:
                scene.lineage = np.arange(scene.lineage.size)
            told.append(report([scene]))
        if tick < steps:
            scene.step()
    packer, frames = Packer(drawings), []
    for drawing, lineage, said in zip(drawings, lineages, told, strict=True):
        descent = packer.add(drawing, lineage)
        readouts = {k: _short(v) for k, v in said["readouts"][0].items()}
        phase = said["phase"]
        told_now = [phase["name"], phase["sentences"][0]]
        frames.append([len(drawing), descent, said["ticks"], readouts, *told_now])
    return {
        "about": scene.describe(),
        "values": scene.values,
        "every": every,
        "ranges": [[*key, k, *packer.scale(key, k)] for key, k in packer.ranges],
        "frames": frames,
        "heads": _text(np.array(packer.heads, "<i4")),
        "floats": _text(np.array(packer.floats, "<f4")),
        "deltas": _text(np.concatenate([*packer.ints, np.empty(0)]).astype("<i2")),
    }


def _short(value: float | str) -> float | str:
    return value if isinstance(value, str) else float(f"{value:.4g}")


def _text(array: np.ndarray) -> str:
    """Bytes of one plane after the other, deflated, base64: planes compress better than words."""
    planes = array.view(np.uint8).reshape(-1, array.itemsize).T
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    packed = packer.compress(planes.tobytes()) + packer.flush()
    return base64.b64encode(packed).decode("ascii")


def to_script(recording: dict[str, Any], key: str) -> str:
    """The recording as a classic script, which a page can load from a folder as well."""
    body = json.dumps(recording, separators=(",", ":"), ensure_ascii=True)
    return f"(window.pfRecordings=window.pfRecordings||{{}})[{json.dumps(key)}]={body};\n"
