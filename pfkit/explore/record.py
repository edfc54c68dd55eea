"""Recorded runs: what a page plays before Python has started.

A recording is made by the scene itself, so it shows what the live run will do; because both start
from the same seed, a reader who touches a control goes on from the very frame on the screen.

To stay small, each record's numbers are rounded to 11 bits of their own range and stored as the
differences of neighbours; particles are sorted first, because their order means nothing to a
picture. `decode` in `web/render.js` is the inverse.
"""

from __future__ import annotations

import base64
import json
import zlib
from typing import Any

import numpy as np

from pfkit.explore.host import report
from pfkit.explore.operations import FEWEST, Operation, operation
from pfkit.explore.scene import Scene

LEVELS = 1000


def _pack(op: Operation, numbers: np.ndarray, floats: list[float], ints: list[np.ndarray]) -> None:
    """Append one record's numbers: as float32, or as quantised differences if there are many."""
    if not op.rows or numbers.size - op.lead < FEWEST:
        floats.extend(numbers)
        return
    floats.extend(numbers[: op.lead])
    rows = numbers[op.lead :].reshape(op.rows, -1)
    if op.name in ("points", "quills"):
        rows = rows[:, np.argsort(np.round(rows[0], 2) * 1e4 + rows[1], kind="stable")]
    for row in rows:
        low, high = float(row.min()), float(row.max())
        scale = (high - low) / LEVELS or 1.0
        floats.extend((low, scale))
        level = np.round((row - low) / scale).astype(np.int16)
        ints.append(np.diff(level, prepend=np.int16(0)))


def pack(drawing: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Split a drawing into (heads int32, floats float32, differences int16)."""
    heads: list[int] = []
    floats: list[float] = []
    ints: list[np.ndarray] = []
    i = 0
    while i < drawing.size:
        op, style, n = (int(v) for v in drawing[i : i + 3])
        heads.extend((op, style, n))
        _pack(operation(op), drawing[i + 3 : i + 3 + n], floats, ints)
        i += 3 + n
    joined = np.concatenate(ints) if ints else np.empty(0, np.int16)
    return np.array(heads, np.int32), np.array(floats, np.float32), joined


def record(scene: Scene, steps: int | None = None, every: int | None = None) -> dict[str, Any]:
    """Run `scene` from its seed and return the recording as plain data (JSON-able)."""
    steps, every = steps or scene.record_steps, every or scene.record_every
    scene.reset(scene.seed)
    heads, floats, ints, frames = [], [], [], []
    for tick in range(steps + 1):
        if tick % every == 0:
            drawing, readouts = scene.frame()
            h, f, d = pack(drawing)
            heads.append(h)
            floats.append(f)
            ints.append(d)
            told = report(scene, {k: _short(v) for k, v in readouts.items()})
            handles = [[round(x, 2), round(y, 2)] for x, y in told["handles"]]
            frames.append([h.size, f.size, d.size, scene.ticks, told["readouts"], handles])
        if tick < steps:
            scene.step()
    return {
        "about": scene.describe(),
        "values": scene.values,
        "every": every,
        "levels": LEVELS,
        "frames": frames,
        "heads": _text(np.concatenate(heads).astype("<i4")),
        "floats": _text(np.concatenate(floats).astype("<f4")),
        "deltas": _text(np.concatenate(ints).astype("<i2")),
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
