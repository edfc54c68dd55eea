"""A hundred seeds: the same experiment again and again, behind the picture, and what became of it.

One run shows what can happen. How often it happens is counted: every seed gives one number, the
panel's score, and the numbers of all runs fill a histogram. A front end asks for a little work at a
time, so that the picture goes on.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from pfkit.errors import ParameterError
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Scene

RUNS = 100
BINS = 20
SIZE = (560, 150)
STYLES = ("estimate", "dead reckoning")  # of the first and the second world


class Seeds:
    """Runs of the seeds 1 to 100, of one world or two, with their controls as they stand now."""

    def __init__(self, worlds: list[Scene]):
        score = worlds[0].panel.score
        if score is None:
            raise ParameterError(f"panel {worlds[0].panel_name!r} has no score to compare seeds by")
        self.score = score
        self.gauge = worlds[0].gauges[score.readout]
        self.names = [""] if len(worlds) == 1 else ["left: ", "right: "]
        self.worlds = [type(w)(w.panel_name, 1) for w in worlds]
        for mine, theirs in zip(self.worlds, worlds, strict=True):
            mine.values.update(theirs.values)
            mine.reset(1)
        self.results: list[list[float]] = [[] for _ in worlds]

    @property
    def done(self) -> int:
        """Seeds that all worlds have ended."""
        return len(self.results[-1])

    def work(self, ticks: int) -> None:
        """Go on for so many ticks in all."""
        for _ in range(ticks):
            if self.done == RUNS:
                return
            for world in self.worlds:
                for when, name, value in self.score.moves:
                    if when == world.ticks:
                        world.set(name, value)
                world.step()
            if self.worlds[0].ticks >= self.score.ticks:
                self._note()

    def _note(self) -> None:
        for world, results in zip(self.worlds, self.results, strict=True):
            results.append(float(world.readouts()[self.score.readout]))
        for world in self.worlds:
            world.reset(self.done + 1)

    def failed(self) -> list[int]:
        return [sum(not value <= self.score.limit for value in r) for r in self.results]

    def sentence(self) -> str:
        """What the runs so far say, in one sentence."""
        if not self.done:
            return "The first seeds are running."
        unit, limit = self.gauge.unit, self.score.limit
        after = self.score.ticks / self.worlds[0].rate
        counts = [
            f"{name}{failed} of {self.done}"
            for name, failed in zip(self.names, self.failed(), strict=True)
        ]
        runs = ", ".join(counts)
        return f"{self.score.readout} above {limit:g} {unit} after {after:.0f} s: {runs} runs."

    def report(self) -> dict[str, Any]:
        return {"done": self.done, "runs": RUNS, "sentence": self.sentence()}

    def draw(self) -> np.ndarray:
        """The histogram; what lies beyond its last bin is counted there."""
        pen, limit = Pen(), self.score.limit
        top = 2 * limit
        edges = np.linspace(0, top, BINS + 1)
        counts = [np.histogram(np.clip(r, 0, top), edges)[0] for r in self.results]
        high = max(4, 1.15 * max(int(c.max()) for c in counts))
        pen.view((0.02, 0.2, 0.96, 0.66), (0, top), (0, high), frame=False)
        for k, (style, n) in enumerate(zip(STYLES, counts, strict=False)):
            left, width = edges[:-1], np.diff(edges) / len(counts)
            shown = n > 0
            left = (left + k * width)[shown]
            pen.bars(style, left, left + 0.9 * width[shown], 0, n[shown])
        pen.line("muted", [0, top], [0, 0], width=1)
        pen.line("ink", [limit, limit], [0, high], width=1.5, dash=4)
        pen.text("ink", limit, 1.1 * high, f"limit {limit:g} {self.gauge.unit}", 11, anchor=0)
        pen.ticks(0, [0, limit / 2, limit, 1.5 * limit])
        pen.text("muted", top, -0.12 * high, f"{top:g} and more", size=11, anchor=1)
        return pen.array()
