"""What every explorable is: a *scene*. This page is the contract.

A scene is a small world computed in pure NumPy. A front end (the page, or a notebook) knows it by
six calls, and needs no other knowledge of it:

    scene.reset(seed)                    start again: same seed, same history
    scene.set(name, value)               move one control
    scene.hold(name, x, y, touch)        the reader's hand on something in the picture
    scene.step()                         let one tick pass
    scene.to_phase(n)                    go on to the end of a phase, at most n ticks
    scene.frame()                        (flat float32 drawing, named readouts)

**Time.** A tick is the smallest time a scene knows, `rate` of them make a second. `advance` is one
tick, written as a generator: it does its work, and at the end of each phase it yields the phase's
name and *one sentence made from the numbers*:

    def advance(self):
        self.bel = pf.predict(self.bel, self.u, self.motion, self.rng)
        yield "predict", f"Predict: the spread went from {before:.2f} to {self.spread:.2f} m."
        ...
        yield "weigh", f"Weigh: {light} of {M} particles are nearly weightless."

`phases()` names them in their order. A phase may last several ticks (most ticks of *Drive and
localise* only predict, and end no phase), but each must end in the same ticks whatever the controls
are, with a sentence that says so if nothing was done: two worlds side by side keep step by it. The
sentence stands beside the picture and is what a screen reader says.
`tell` adds what is rare and must not be missed (found, kidnapped).

**Picture.** `draw` puts primitives into one array (`pfkit.explore.pen` gives its layout), so one
renderer draws every scene. `pen.handle(name, x, y)` there makes a place that can be dragged, in the
units of the view that it stands in: a landmark, the rim of a noise ellipse, a threshold in a chart.
What the hand does arrives in `held(name, x, y, touch)`, touch being one of `TOUCHES`; name "" is
the empty floor of the first view. A handle that moves a control calls `self.turn(name, value)`. The
keyboard takes hold of the same handles.
Readouts are numbers or short texts: what a picture shows, a reader who does not see it can read.

**Panels** are named ways of showing the same world. A panel has at most five `controls` beside the
picture; the rest are `more`, folded away. It has three missions, and a `score`: the readout that is
compared over 100 seeds, after so many ticks.

**Copies.** A front end keeps copies of the last minute, to go back in time, and runs two scenes on
one seed, side by side. Attributes that a scene only replaces and never changes in place can be
named in `shared`: copies then share them, and are cheap. For a recorded run, which stores a few
frames a second and moves between them, a scene may keep `lineage`: for each particle of the cloud
that it draws, which one it was in the last recorded frame (-1: none).

A scene never draws on a screen, sleeps or reads a clock, and takes all its chance from one seeded
generator. So a run is a value: scene, panel, seed and the list of what was done name it completely.
"""

from __future__ import annotations

import copy
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import ParameterError
from pfkit.explore.pen import Pen

Kind = Literal["range", "choice", "toggle", "button"]
Readouts = dict[str, float | str]
Phases = Iterator[tuple[str, str]]  # name of a phase that has ended, and its sentence
# A tap is pressed and released in one place; called off: the touch became something else.
TOUCHES = ("press", "drag", "release", "tap", "cancel")
MOST_CONTROLS = 5  # beside the picture


def finite(name: str, value: Any) -> float:
    """The value as a float; `ParameterError` if it is no finite number."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not np.isfinite(value):
        raise ParameterError(f"{name} = {value!r}: give a finite number")
    return float(value)


@dataclass(frozen=True)
class Control:
    """One thing the reader can move.

    Parameters
    ----------
    name, label, help
        Identifier, visible name, and one sentence that says what it does.
    kind
        "range" (number in [lo, hi]), "choice" (one of `choices`), "toggle" (bool), or "button"
        (an event, no value).
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
            return float(np.clip(finite(self.name, value), self.lo, self.hi))
        if self.kind == "choice":
            allowed = [key for key, _ in self.choices]
            if value not in allowed:
                raise ParameterError(f"{self.name} = {value!r}: choose one of {allowed}")
            return value
        if self.kind == "toggle":
            if not isinstance(value, bool):
                raise ParameterError(f"{self.name} = {value!r}: give true or false")
            return value
        return None

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
class Score:
    """What 100 seeds are compared by.

    Parameters
    ----------
    readout : str
        Its name.
    ticks : int
        When it is read.
    limit : float
        Above it a run counts as failed.
    moves : tuple of (tick, control, value)
        What happens in every run on the way, such as a kidnap.
    """

    readout: str
    ticks: int
    limit: float
    moves: tuple[tuple[int, str, Any], ...] = ()


@dataclass(frozen=True)
class Panel:
    """One way of showing a scene: which controls, from which values, with which missions."""

    title: str
    controls: tuple[str, ...]  # beside the picture, at most five
    more: tuple[str, ...] = ()  # folded away
    values: Mapping[str, Any] = field(default_factory=dict)
    missions: tuple[Mission, ...] = ()
    alt: str = ""
    record: tuple[int, int] | None = None  # ticks, and ticks per frame, of its recorded run
    score: Score | None = None


class Scene:
    """Base of all scenes: keeps the values, the seed and the generator; subclasses keep the world.

    Subclasses define the class attributes below and `start`, `phases`, `advance`, `draw`,
    `readouts`, and may define `changed(name, value)` for what must happen at once when a control
    moves, and `held` for what a hand in the picture does.

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
    floor: ClassVar[bool] = False  # a press on the floor does something
    shared: ClassVar[tuple[str, ...]] = ()  # attributes that copies share
    lineage: NDArray[np.int64] | None = None

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
        self._tick: Phases | None = None  # the tick that has begun, if one has
        self.values: dict[str, Any] = {
            c.name: c.default for c in self.all_controls if c.kind != "button"
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
        self._tick = None
        self.ended, self.phase, self.sentence = 0, "", ""  # phases so far; the last one
        self.rng = np.random.default_rng(seed)
        self.start()
        self._already = self._deeds()

    def set(self, name: str, value: Any) -> None:
        """Move the control `name` to `value` (clipped into its range), between two ticks."""
        if name not in self.by_name:
            raise ParameterError(f"{self.name} has no control {name!r}")
        control = self.by_name[name]
        value = control.clean(value)
        self.finish()
        if control.kind != "button":
            self.values[name] = value
        if control.live:
            self.changed(name, value)
        else:
            already = self._already
            self.reset(self.seed)
            self._already = already
        self._judge()

    def turn(self, name: str, value: float) -> None:
        """A handle moves the control `name`: to the nearest step that it can take."""
        control = self.by_name[name]
        self.set(name, control.clean(round(round(value / control.step) * control.step, 9)))

    def hold(self, name: str, x: float, y: float, touch: str) -> None:
        """The reader's hand on the handle `name`, or on the floor (""), at (x, y)."""
        if touch not in TOUCHES:
            raise ParameterError(f"touch = {touch!r}: give one of {TOUCHES}")
        self.finish()
        self.held(str(name), finite("x", x), finite("y", y), touch)
        self._judge()

    def step(self) -> None:
        """Let one tick pass, or end the one that has begun."""
        self._tick = self._tick or self.advance()
        for ended in self._tick:
            self._note(*ended)
        self._end_tick()

    @property
    def begun(self) -> bool:
        """Is a tick under way?"""
        return self._tick is not None

    def finish(self) -> None:
        """End the tick that has begun, if one has."""
        if self.begun:
            self.step()

    def to_phase(self, most: int) -> bool:
        """Go on until a phase ends, for at most so many ticks; False if none did."""
        for _ in range(most):
            self._tick = self._tick or self.advance()
            for ended in self._tick:
                self._note(*ended)
                return True
            self._end_tick()
        return False

    def _note(self, phase: str, sentence: str) -> None:
        self.ended += 1
        self.phase, self.sentence = phase, sentence

    def _end_tick(self) -> None:
        self._tick = None
        self.ticks += 1
        self.tried.update(self.values.items())
        self._judge()

    def copy(self) -> Scene:
        """This scene once more, between two ticks; what `shared` names is not copied."""
        self.finish()
        kept = [self.panel, self.by_name, *(getattr(self, name) for name in self.shared)]
        return copy.deepcopy(self, {id(thing): thing for thing in kept})

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
            "phases": list(self.phases()),
            "controls": [
                {**self.by_name[n].describe(), "default": self.values.get(n), "main": main}
                for names, main in ((self.panel.controls, True), (self.panel.more, False))
                for n in names
            ],
            "floor": self.floor,
            "score": self.panel.score and self.panel.score.readout,
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

    def phases(self) -> tuple[str, ...]:
        """Names of the phases, in their order."""
        raise NotImplementedError

    def advance(self) -> Phases:
        """One tick; yields (name, sentence) at the end of each phase."""
        raise NotImplementedError

    def changed(self, name: str, value: Any) -> None:
        """A live control moved. Scenes that read `self.values` each tick need nothing here."""

    def held(self, name: str, x: float, y: float, touch: str) -> None:
        """The hand did something to the handle `name`, or to the floor."""
        if name:
            raise ParameterError(f"{self.name} has nothing called {name!r} that can be held")

    def draw(self, pen: Pen) -> None:
        raise NotImplementedError

    def readouts(self) -> Readouts:
        raise NotImplementedError
