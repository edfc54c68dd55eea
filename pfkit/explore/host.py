"""The bridge between runs and a front end, the same one in the page and in Jupyter.

A front end speaks to it in plain data: it sends a list of operations and gets back a drawing and a
report. Nothing that it sends is ever evaluated; an unknown name is an error with a message.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from pfkit.explore import scene
from pfkit.explore.run import MOST_TICKS, Run
from pfkit.explore.scene import Readouts, Scene
from pfkit.explore.seeds import SIZE, Seeds


class Host:
    """Keeps open runs by key."""

    def __init__(self) -> None:
        self.runs: dict[str, Run] = {}
        self.seeds: dict[str, Seeds] = {}

    def open(self, key: str, name: str, panel: str | None, seed: int) -> str:
        """Open a scene; returns its description as JSON."""
        world = scene(name, panel, seed)
        self.runs[key] = Run(world)
        self.seeds.pop(key, None)
        return json.dumps(world.describe())

    def do(self, key: str, operations: str) -> tuple[np.ndarray, str]:
        """Apply operations in order; return the drawing and a JSON report.

        Parameters
        ----------
        key : str
            As given to `open`.
        operations : str
            JSON list of

            * ["reset", seed], ["set", name, value], ["hold", name, x, y, touch]: as in `Scene`,
            * ["step", n]: n ticks; ["phase", n]: to the end of a phase, at most n ticks,
            * ["back", tick]: as it was then, if that was in the last minute,
            * ["compare", name, value]: start again, beside a second world that differs in this
              control; ["compare", null, null] ends it; ["other", value] moves the second's,
            * ["watch"]: what comes before it was no deed of the reader.

        Returns
        -------
        drawing : float32 array (n,)
        report : str
            JSON with ticks (and whether one has begun), readouts (one for each world), values of
            all controls, the last phase and its sentence, missions done, what was told since the
            last report, and the ticks one can go back to.
        """
        run = self.runs[key]
        for operation in json.loads(operations):
            run.do(operation)
        first = run.worlds[0]
        told = report(run.worlds)
        ways = {"kept": list(run.kept), "done": first.achieved, "told": first.news()}
        return run.frame(), json.dumps({**told, **ways})

    def many(self, key: str, ticks: int, again: bool) -> tuple[np.ndarray, str]:
        """Work on the hundred seeds for so many ticks; their histogram, and how far they are."""
        if again or key not in self.seeds:
            self.seeds[key] = Seeds(self.runs[key].worlds)
        seeds = self.seeds[key]
        seeds.work(min(max(int(ticks), 1), MOST_TICKS))
        return seeds.draw(), json.dumps({**seeds.report(), "size": SIZE})


def _clean(readouts: Readouts) -> Readouts:
    """Numbers that JSON has: others become text."""
    return {k: (v if isinstance(v, str) or np.isfinite(v) else str(v)) for k, v in readouts.items()}


def report(worlds: list[Scene]) -> dict[str, Any]:
    """What a front end shows beside the drawing."""
    first = worlds[0]
    return {
        "ticks": first.ticks,
        "begun": first.begun,
        "seed": first.seed,
        "readouts": [_clean(world.readouts()) for world in worlds],
        "values": first.values,
        "other": worlds[-1].values if len(worlds) > 1 else None,
        "phase": {
            "count": first.ended,
            "name": first.phase,
            "sentences": [world.sentence for world in worlds],
        },
    }
