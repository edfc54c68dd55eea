"""The bridge between a scene and a front end, the same one in the page and in Jupyter.

A front end speaks to it in plain data: it sends a list of operations and gets back a drawing and a
report. Nothing that it sends is ever evaluated; an unknown name is an error with a message.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from pfkit.errors import ParameterError
from pfkit.explore import scene
from pfkit.explore.scene import Scene

MAX_REPLAY = 20_000  # ticks that one request may ask for


class Host:
    """Keeps open scenes by key."""

    def __init__(self) -> None:
        self.scenes: dict[str, Scene] = {}

    def open(self, key: str, name: str, panel: str | None, seed: int) -> str:
        """Open a scene; returns its description as JSON."""
        self.scenes[key] = scene(name, panel, seed)
        return json.dumps(self.scenes[key].describe())

    def close(self, key: str) -> None:
        self.scenes.pop(key, None)

    def do(self, key: str, operations: str) -> tuple[np.ndarray, str]:
        """Apply operations in order; return the drawing and a JSON report.

        Parameters
        ----------
        key : str
            As given to `open`.
        operations : str
            JSON list of ["reset", seed], ["set", name, value], ["step", n], or ["watch"]: what
            comes before it was no deed of the reader.

        Returns
        -------
        drawing : float32 array (n,)
        report : str
            JSON with ticks, readouts, values of all controls, handles, missions done, and what
            was told since the last report.
        """
        s = self.scenes[key]
        for operation in json.loads(operations):
            _apply(s, operation)
        drawing, readouts = s.frame()
        told = report(s, readouts)
        return drawing, json.dumps({**told, "done": s.achieved, "told": s.news()})


def _apply(s: Scene, operation: list[Any]) -> None:
    match operation:
        case ["reset", seed]:
            s.reset(seed)
        case ["set", name, value]:
            s.set(name, value)
        case ["step", int(n)] if 0 <= n <= MAX_REPLAY:
            for _ in range(n):
                s.step()
        case ["watch"]:
            s.watch()
        case _:
            raise ParameterError(
                f"operation {operation!r:.60}: give one of reset, set, step, watch"
            )


def report(s: Scene, readouts: dict[str, float | str]) -> dict[str, Any]:
    """What a front end shows beside the drawing; non-finite numbers become text."""
    clean = {
        k: (v if isinstance(v, str) or np.isfinite(v) else str(v)) for k, v in readouts.items()
    }
    return {
        "ticks": s.ticks,
        "seed": s.seed,
        "readouts": clean,
        "values": s.values,
        "handles": [[float(x), float(y)] for x, y in s.handles()],
    }
