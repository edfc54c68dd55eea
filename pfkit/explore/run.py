"""A run: one world, or two of one seed side by side, and the way back through the last minute.

Operations are plain data, and a run is what they made of it. To go back means to take the nearest
copy of the worlds and to do again what was done since.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from pfkit.errors import ParameterError
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Scene, finite

KEPT = 60.0  # seconds of a run that stay
COPIES = 2.0  # copies of the worlds in each of them
MOST_TICKS = 20_000  # that one request may ask for


@dataclass
class Moment:
    """Copies of the worlds between two ticks, and what was done to them from there on."""

    ticks: int
    worlds: list[Scene]
    done: list[tuple[int, list[Any]]] = field(default_factory=list)  # tick, operation


class Run:
    """Worlds, and the operations on them: the lists of a `Host`."""

    def __init__(self, world: Scene):
        self.worlds = [world]
        self.differs = ""  # the control in which the second world differs
        self._begin()

    @property
    def ticks(self) -> int:
        return self.worlds[0].ticks

    @property
    def kept(self) -> tuple[int, int]:
        """The first and the last tick that one can go to."""
        return self.moments[0].ticks, max(self.newest, self.ticks)

    def do(self, operation: list[Any]) -> None:
        """Apply one operation; `Host.do` lists them."""
        match operation:
            case ["step", int(n)] if 0 <= n <= MOST_TICKS:
                self._forget_what_came()
                for _ in range(n):
                    for world in self.worlds:
                        world.step()
                    self._keep()
            case ["phase", int(n)] if 0 <= n <= MOST_TICKS:
                self._forget_what_came()
                self._to_phase(n)
            case ["back", int(tick)]:
                self._back(tick)
            case ["watch"]:
                for world in self.worlds:
                    world.watch()
            case ["compare", name, value]:
                self._compare(name, value)
            case ["reset", _] | ["set", _, _] | ["other", _] | ["hold", _, _, _, _]:
                self._forget_what_came()
                for world in self.worlds:
                    world.finish()
                before = self.ticks
                _apply(self.worlds, operation, self.differs)
                if self.ticks < before or operation[0] == "reset":
                    self._begin()
                else:
                    self.moments[-1].done.append((self.ticks, operation))
            case _:
                raise ParameterError(
                    f"operation {operation!r:.60}: give one of reset, set, other, hold, step, "
                    "phase, back, compare, watch"
                )

    def _to_phase(self, most: int) -> None:
        """All worlds end their phases in the same ticks, so they can go on one tick at a time."""
        for _ in range(most):
            ended = [world.to_phase(1) for world in self.worlds]
            if ended[0]:
                return
            self._keep()

    def _compare(self, name: str | None, value: Any) -> None:
        """Start again, two worlds of one seed that differ in one control; None: one world."""
        first = self.worlds[0]
        second = [first.copy()] if name is not None else []
        for world in second:
            world.set(str(name), value)
        self.worlds, self.differs = [first, *second], name or ""
        for world in self.worlds:
            world.reset(first.seed)
        self._begin()

    # ---- the way back -----------------------------------------------------------------------
    def _begin(self) -> None:
        self.moments = [Moment(self.ticks, self._copies())]
        self.newest = self.ticks

    def _copies(self) -> list[Scene]:
        return [world.copy() for world in self.worlds]

    def _keep(self) -> None:
        rate = self.worlds[0].rate
        if self.ticks - self.moments[-1].ticks < max(1, round(rate / COPIES)):
            return
        self.moments.append(Moment(self.ticks, self._copies()))
        while self.moments[1].ticks <= self.ticks - KEPT * rate:
            del self.moments[0]

    def _forget_what_came(self) -> None:
        """After a way back something new happens: what came then is no longer true."""
        if self.newest > self.ticks:
            self.moments = [m for m in self.moments if m.ticks <= self.ticks]
            last = self.moments[-1]
            last.done = [(tick, op) for tick, op in last.done if tick <= self.ticks]
        self.newest = 0

    def _back(self, tick: int) -> None:
        first, last = self.kept
        tick, self.newest = min(max(tick, first), last), last
        moment = [m for m in self.moments if m.ticks <= tick][-1]
        self.worlds = [world.copy() for world in moment.worlds]
        for when, operation in [*moment.done, (tick, ["step", 0])]:
            for world in self.worlds:
                while world.ticks < min(when, tick):
                    world.step()
            if when <= tick and operation[0] != "step":
                _apply(self.worlds, operation, self.differs)
        for world in self.worlds:
            world.news()  # it was told when it happened

    # ---- the picture ------------------------------------------------------------------------
    def frame(self) -> np.ndarray:
        """One drawing of all worlds, each in a part of its own."""
        if len(self.worlds) == 1:
            return self.worlds[0].frame()[0]
        drawings: list[np.ndarray] = []
        for k, world in enumerate(self.worlds):
            pen = Pen()
            pen.part(k, len(self.worlds))
            drawings.extend((pen.array(), world.frame()[0]))
        return np.concatenate(drawings)


def _apply(worlds: list[Scene], operation: list[Any], differs: str) -> None:
    """What the reader does: to both worlds, but for the control in which they differ."""
    match operation:
        case ["reset", seed]:
            for world in worlds:
                world.reset(seed)
        case ["set", name, value]:
            for world in worlds[: 1 if name == differs else None]:
                world.set(name, value)
            if len(worlds) == 2 and not worlds[0].by_name[name].live:
                for world in worlds:  # one that starts again takes the other with it
                    world.reset(world.seed)
        case ["other", value]:
            if len(worlds) == 1:
                raise ParameterError("other: there is one world only; compare first")
            worlds[1].set(differs, value)
            if not worlds[1].by_name[differs].live:
                worlds[0].reset(worlds[0].seed)
        case ["hold", name, x, y, touch]:
            for k, world in enumerate(worlds):
                before = world.values.get(differs)
                world.hold(name, finite("x", x), finite("y", y), touch)
                if k and world.values.get(differs) != before:  # a handle of what they differ in
                    world.set(differs, before)
