"""What every explorable is: a *scene*.

A scene is a small world computed in pure NumPy. It declares its controls, and then answers four
calls; a front end (the page, or a notebook) needs no other knowledge of it:

    scene.reset(seed)          start again: same seed, same history
    scene.set(name, value)     move one control
    scene.step()               let one tick pass
    scene.frame()              (flat float32 drawing, named readouts)

The drawing is a list of primitives in one array (`pfkit.explore.pen` gives its layout), so one
renderer draws every scene. Readouts are numbers or short texts: what a picture shows, a reader
who cannot see it can still read.

A scene can have several *panels*: named ways of showing the same world, each with its own
controls, starting values and three guided missions.

A scene never draws, sleeps or reads a clock, and takes all its chance from one seeded generator.
So a run is a value: scene, panel, seed and the list of control changes name it completely.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np

from pfkit.errors import ParameterError
from pfkit.explore.pen import Pen

Kind = Literal["range", "choice", "toggle", "button", "point"]
Readouts = dict[str, float | str]


@dataclass(frozen=True)
class Control:
    """One thing the reader can move.

    Parameters
    ----------
    name, label, help
        Identifier, visible name, and one sentence that says what it does.
    kind
        "range" (number in [lo, hi]), "choice" (one of `choices`), "toggle" (bool), "button"
        (an event, no value), "point" (x, y, phase in data units of the first view; phase 0 press,
        1 drag, 2 release, 3 a tap: pressed and released in one place, 4 called off).
    keys
        Keyboard: maps a key name of the browser ("ArrowUp", "k") to the value that it sets. A range
        falls back to its default on release, so that keys act like a joystick.
    live
        False if a change restarts the run (M, for instance).
    """

    name: str
    label: str
    kind: Kind
    default: Any = None
    lo: float = 0.0
    hi: float = 1.0
    step: float = 0.01
    unit: str = ""
    choices: tuple[tuple[str, str], ...] = ()
    help: str = ""
    keys: Mapping[str, Any] = field(default_factory=dict)
    log: bool = False
    live: bool = True

    def clean(self, value: Any) -> Any:
        """The value this control can really take; `ParameterError` if it cannot take this one."""
        if self.kind == "range":
            return float(np.clip(self._number(value), self.lo, self.hi))
        if self.kind == "choice":
            allowed = [key for key, _ in self.choices]
            if value not in allowed:
                raise ParameterError(f"{self.name} = {value!r}: choose one of {allowed}")
            return value
        if self.kind == "toggle":
            if not isinstance(value, bool):
                raise ParameterError(f"{self.name} = {value!r}: give true or false")
            return value
        if self.kind == "point":
            if not isinstance(value, list | tuple) or len(value) != 3:
                raise ParameterError(f"{self.name} = {value!r}: give (x, y, phase)")
            return tuple(self._number(v) for v in value)
        return None

    def _number(self, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
            raise ParameterError(f"{self.name} = {value!r}: give a finite number")
        return float(value)

    def describe(self) -> dict[str, Any]:
        """The control as plain data, for a front end."""
        return {
            "name": self.name,
            "label": self.label,
            "kind": self.kind,
            "default": self.default,
            "lo": self.lo,
            "hi": self.hi,
            "step": self.step,
            "unit": self.unit,
            "choices": [list(c) for c in self.choices],
            "help": self.help,
            "keys": dict(self.keys),
            "log": self.log,
            "live": self.live,
        }


@dataclass(frozen=True)
class Mission:
    """Something to try, under a short name, and how the scene knows that the reader did it."""

    deed: str
    text: str
    done: Callable[[Any], bool]


@dataclass(frozen=True)
class Gauge:
    """How a readout is shown: its unit, and decimals that stay whatever the value."""

    unit: str = ""
    decimals: int = 0


@dataclass(frozen=True)
class Panel:
    """One way of showing a scene: which controls, from which values, with which missions."""

    title: str
    controls: tuple[str, ...]
    values: Mapping[str, Any] = field(default_factory=dict)
    missions: tuple[Mission, ...] = ()
    alt: str = ""
    record: tuple[int, int] | None = None  # ticks, and ticks per frame, of its recorded run


class Scene:
    """Base of all scenes: keeps the values, the seed and the generator; subclasses keep the world.

    Subclasses define the class attributes below and `start`, `advance`, `draw`, `readouts`, and
    may define `changed(name, value)` for what must happen at once when a control moves, and
    `handles` for what a finger can take hold of.

    Missions are judged from `watch` on, which a front end calls when the reader takes over. A deed
    counts when it is done, not because it is so already, or because a new seed makes it so. What
    was achieved stays so when the run starts again.
    """

    name: ClassVar[str]
    size: ClassVar[tuple[int, int]] = (720, 400)
    rate: ClassVar[float] = 30.0  # ticks per second that feel right
    all_controls: ClassVar[tuple[Control, ...]]
    panels: ClassVar[dict[str, Panel]]
    gauges: ClassVar[dict[str, Gauge]] = {}  # of each readout that is a number
    record_steps: int = 240  # length of the recorded run, in ticks
    record_every: int = 3  # ticks between two of its frames
    still_at: ClassVar[int] = 0  # tick that the still shows; 0: the end of the recorded run

    def __init__(self, panel: str | None = None, seed: int = 1):
        panel = panel or next(iter(self.panels))
        if panel not in self.panels:
            raise ParameterError(
                f"{self.name} has no panel {panel!r}; choose one of {sorted(self.panels)}"
            )
        self.panel_name, self.panel = panel, self.panels[panel]
        if self.panel.record:
            self.record_steps, self.record_every = self.panel.record
        self.by_name = {c.name: c for c in self.all_controls}
        self.values: dict[str, Any] = {
            c.name: c.default for c in self.all_controls if c.kind not in ("button", "point")
        }
        self.values.update(self.panel.values)
        self.tried: Counter[tuple[str, Any]] = Counter()  # ticks that each value has stood
        self.sentences: list[str] = []
        self.reset(seed)
        self.watch()

    def watch(self) -> None:
        """From here on the reader acts: nothing is achieved yet, nothing was said."""
        self.achieved = [False] * len(self.panel.missions)
        self.tried.clear()
        self.sentences.clear()
        self._already = self._deeds()

    def reset(self, seed: int) -> None:
        """Start again from this seed with the controls where they are."""
        if isinstance(seed, bool) or not isinstance(seed, int) or not 0 <= seed < 2**31:
            raise ParameterError(f"seed = {seed!r}: give a whole number from 0 to 2147483647")
        self.seed, self.ticks = seed, 0
        self.rng = np.random.default_rng(seed)
        self.start()
        self._already = self._deeds()

    def set(self, name: str, value: Any) -> None:
        """Move the control `name` to `value` (clipped into its range)."""
        if name not in self.by_name:
            raise ParameterError(f"{self.name} has no control {name!r}")
        control = self.by_name[name]
        value = control.clean(value)
        if control.kind not in ("button", "point"):
            self.values[name] = value
        if control.live:
            self.changed(name, value)
        else:
            already = self._already
            self.reset(self.seed)
            self._already = already
        self._judge()

    def step(self) -> None:
        """Let one tick pass."""
        self.advance()
        self.ticks += 1
        self.tried.update(self.values.items())
        self._judge()

    def spent(self, name: str, accept: Callable[[Any], bool]) -> int:
        """Ticks that the reader has seen with an accepted value of the control `name`."""
        return sum(n for (key, value), n in self.tried.items() if key == name and accept(value))

    def tell(self, sentence: str) -> None:
        """Say in one sentence what just happened, for readers who do not see the picture."""
        self.sentences.append(sentence)

    def news(self) -> list[str]:
        """What was told since the last call."""
        told = [*self.sentences]
        self.sentences.clear()
        return told

    def frame(self) -> tuple[np.ndarray, Readouts]:
        """The drawing, shape (n,) float32 (see `pen`), and the readouts."""
        pen = Pen()
        self.draw(pen)
        return pen.array(), self.readouts()

    def describe(self) -> dict[str, Any]:
        """Everything a front end must know before the first frame, as plain data."""
        return {
            "name": self.name,
            "panel": self.panel_name,
            "title": self.panel.title,
            "alt": self.panel.alt,
            "size": list(self.size),
            "rate": self.rate,
            "seed": self.seed,
            "units": {name: gauge.unit for name, gauge in self.gauges.items()},
            "decimals": {name: gauge.decimals for name, gauge in self.gauges.items()},
            "controls": [
                {**self.by_name[n].describe(), "default": self.values.get(n)}
                for n in self.panel.controls
            ],
            "missions": [{"deed": m.deed, "text": m.text} for m in self.panel.missions],
        }

    def _deeds(self) -> list[bool]:
        return [bool(m.done(self)) for m in self.panel.missions]

    def _judge(self) -> None:
        now = self._deeds()
        for k, (done, already) in enumerate(zip(now, self._already, strict=True)):
            self.achieved[k] = self.achieved[k] or (done and not already)
        self._already = now

    # ---- what a subclass writes -------------------------------------------------------------
    def start(self) -> None:
        raise NotImplementedError

    def advance(self) -> None:
        raise NotImplementedError

    def changed(self, name: str, value: Any) -> None:
        """A live control moved. Scenes that read `self.values` each tick need nothing here."""

    def handles(self) -> list[tuple[float, float]]:
        """What can be taken hold of and dragged: places in data units of the first view."""
        return []

    def draw(self, pen: Pen) -> None:
        raise NotImplementedError

    def readouts(self) -> Readouts:
        raise NotImplementedError
