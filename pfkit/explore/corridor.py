"""The corridor: the Bayes filter on 24 cells, with a door detector that can be wrong.

The chapter on the Bayes filter as a machine. The corridor is a ring. Each *move* takes the robot
one cell on, most of the time; each *look* reports door or wall, most of the time rightly. Three
rows of bars show the two lines of the filter: the prediction, the likelihood of what was seen, and
their normalised product.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene

CELLS = 24
DOORS = {
    "five": (2, 5, 6, 12, 19),
    "three": (3, 6, 15),
    "even": (2, 8, 14, 20),
    "one": (9,),
    "none": (),
}


class Corridor(Scene):
    name = "corridor"
    size = (720, 440)
    rate = 2.0
    record_steps = 48
    record_every = 1
    still_at = 13
    gauges: ClassVar[dict[str, Gauge]] = {
        "looks": Gauge(),
        "belief there": Gauge("%", 1),
        "its belief": Gauge("%", 1),
        "entropy": Gauge("bit", 2),
        "evidence": Gauge("p(z)", 3),
    }
    all_controls = (
        Control(
            "hit",
            "Hit rate",
            "range",
            0.9,
            lo=0.0,
            hi=1.0,
            step=0.01,
            help="How often a door that is there is seen.",
        ),
        Control(
            "false",
            "False alarm rate",
            "range",
            0.08,
            lo=0.0,
            hi=1.0,
            step=0.01,
            help="How often a door is seen where there is wall.",
        ),
        Control(
            "slip",
            "Falls short",
            "range",
            0.1,
            lo=0,
            hi=0.5,
            step=0.05,
            help="How often a move ends one cell too early.",
        ),
        Control(
            "skid",
            "Goes too far",
            "range",
            0.1,
            lo=0,
            hi=0.5,
            step=0.05,
            help="How often a move ends one cell too late.",
        ),
        Control(
            "honest",
            "The detector is as the sliders say",
            "toggle",
            True,
            help="Off, it really has 90 % and 8 %, whatever the filter believes.",
        ),
        Control(
            "doors",
            "Doors",
            "choice",
            "five",
            choices=(
                ("five", "five"),
                ("three", "three"),
                ("even", "four, evenly"),
                ("one", "one"),
                ("none", "none"),
            ),
            help="Where they are; the robot has this map.",
            live=False,
        ),
        Control("auto", "By itself", "toggle", True, help="Move and look in turn."),
        Control("move", "Move", "button", help="Predict: one cell on.", keys={"m": True}),
        Control("look", "Look", "button", help="Correct: door or wall?", keys={"l": True}),
        Control("carry", "Carry it elsewhere", "button", help="The filter is not told."),
    )
    panels: ClassVar[dict[str, Panel]] = {
        "corridor": Panel(
            "Where in the corridor?",
            ("move", "look", "hit", "false", "honest"),
            ("slip", "skid", "doors", "auto", "carry"),
            missions=(
                Mission(
                    "half the belief",
                    "Step until one cell holds more than half of the belief. How many looks did "
                    "it take? Which pattern of doors did it recognise?",
                    lambda s: s.bel.max() > 0.5,
                ),
                Mission(
                    "a blind detector",
                    "Set the hit rate equal to the false alarm rate. What does a look change now, "
                    "and why?",
                    lambda s: s.looks > 0 and np.ptp(s.likelihood) < 0.005,
                ),
                Mission(
                    "shut out",
                    "Switch off “the detector is as the sliders say”, set the false alarm rate to "
                    "zero, and wait for a false alarm. Can the filter ever come back?",
                    lambda s: (
                        not s.values["honest"]
                        and s.values["false"] == 0
                        and s.saw is True
                        and not s.is_door[s.robot]
                    ),
                ),
            ),
            alt="A ring corridor of 24 cells with doors and a robot. Three rows of bars: the "
            "predicted belief, the likelihood of the last reading, and the corrected belief.",
        )
    }

    def start(self) -> None:
        self.is_door = np.zeros(CELLS, bool)
        self.is_door[list(DOORS[self.values["doors"]])] = True
        self.robot = int(self.rng.integers(CELLS))
        self.bel = np.full(CELLS, 1 / CELLS)
        self.predicted, self.likelihood = self.bel, np.ones(CELLS)
        self.saw: bool | None = None
        self.evidence = 1.0
        self.looks = 0
        self.told_half = False
        self.last = ""  # what was done last: "move" or "look"

    def phases(self) -> tuple[str, ...]:
        return ("move", "look")

    def advance(self) -> Phases:
        if not self.values["auto"]:
            yield self.last or "move", "Nothing moves by itself: press Move or Look."
        elif self.last == "move":
            yield "look", self._look()
        else:
            yield "move", self._move()

    def changed(self, name: str, value: Any) -> None:
        if name == "move":
            self.tell(self._move())
        elif name == "look":
            self.tell(self._look())
        elif name == "carry":
            self.robot = int(self.rng.integers(CELLS))
            self.tell(f"The robot was carried to cell {self.robot}; the filter is not told.")
        elif name in ("slip", "skid") and self.values["slip"] + self.values["skid"] > 0.95:
            self.values["skid" if name == "slip" else "slip"] = 0.95 - self.values[name]

    def _move(self) -> str:
        """The robot goes on, and the belief with it; says what that cost."""
        before = self._entropy()
        kernel = pf.shift_kernel(1, self.values["slip"], self.values["skid"])
        reach = kernel.size // 2
        self.robot = (self.robot + int(self.rng.choice(kernel.size, p=kernel)) - reach) % CELLS
        self.bel = self.predicted = pf.predict_1d(self.bel, kernel, ring=True)
        self.last = "move"
        return f"Move: the entropy goes from {before:.2f} to {self._entropy():.2f} bit."

    def _look(self) -> str:
        """The robot looks, and the belief is corrected; says what was seen."""
        hit, false = self.values["hit"], self.values["false"]
        real = (hit, false) if self.values["honest"] else (0.9, 0.08)
        self.saw = bool(self.rng.random() < real[0 if self.is_door[self.robot] else 1])
        self.predicted = self.bel
        self.likelihood = pf.door_likelihood(self.is_door, self.saw, hit, false)
        self.looks += 1
        self.last = "look"
        try:
            self.bel, evidence = pf.update_1d(self.bel, self.likelihood)
        except pf.DegenerateWeightsError:  # no cell can explain what was seen: show just that
            self.evidence = 0.0
            told = "What was seen is impossible in every cell: the belief stays as it was."
            self.tell(told)
            return told
        self.evidence = float(evidence)
        self._tell_best()
        best = int(self.bel.argmax())
        return (
            f"Look: saw {self._seen()}, as expected with {100 * self.evidence:.0f} %; cell {best} "
            f"holds {100 * self.bel[best]:.0f} %."
        )

    def _tell_best(self) -> None:
        """One sentence when a cell comes to hold half of the belief, and when none does."""
        best = int(self.bel.argmax())
        half = bool(self.bel[best] > 0.5)
        if half and not self.told_half:
            there = "the robot is there" if best == self.robot else "the robot is elsewhere"
            self.tell(f"Cell {best} holds {100 * self.bel[best]:.0f} % of the belief: {there}.")
        elif self.told_half and not half:
            self.tell("No cell holds half of the belief any more.")
        self.told_half = half

    def _entropy(self) -> float:
        p = self.bel[self.bel > 0]
        return float(-(p * np.log2(p)).sum())

    def readouts(self) -> Readouts:
        best = int(self.bel.argmax())
        return {
            "looks": float(self.looks),
            "robot in": f"cell {self.robot}",
            "belief there": float(100 * self.bel[self.robot]),
            "most likely": f"cell {best}",
            "its belief": float(100 * self.bel[best]),
            "entropy": self._entropy(),
            "saw": self._seen(),
            "evidence": self.evidence,
        }

    def _seen(self) -> str:
        if self.saw is None:
            return "nothing yet"
        return ("door" if self.saw else "wall") + (", impossible" if self.evidence == 0 else "")

    def draw(self, pen: Pen) -> None:
        cells = np.arange(CELLS)
        x = (-0.5, CELLS - 0.5)
        pen.view((0.02, 0.76, 0.96, 0.22), x, (0, 1), frame=False)
        pen.bars("grid", cells - 0.5, cells + 0.5, 0.15, 0.8, alpha=0.8)
        doors = cells[self.is_door]
        if doors.size:
            pen.bars("paper", doors - 0.42, doors + 0.42, 0.15, 0.8)
            pen.bars("landmarks", doors - 0.36, doors + 0.36, 0.15, 0.72, alpha=0.85)
            pen.symbols("paper", "circle", doors + 0.18, np.full(doors.shape, 0.42), size=5)
        pen.segments("wall", -0.5, 0.15, CELLS - 0.5, 0.15, width=2)
        pen.robots("truth", self.robot, 0.3, 0.0, radius=0.42)
        if self.saw is not None and self.last == "look":
            word = "door!" if self.saw else "wall"
            pen.text("ink", self.robot, 0.93, word, size=13, anchor=0)
        rows = (
            ("belief before the look", self.predicted, "exact", self.last == "move"),
            ("p(z | cell)", self.likelihood, "measurement", self.last == "look"),
            ("belief now", self.bel, "exact", True),
        )
        for row, (label, values, style, fresh) in enumerate(rows):
            top = 1.0 if row == 1 else max(0.12, float(np.max(values)) * 1.1)
            pen.view((0.02, 0.515 - row * 0.245, 0.96, 0.17), x, (0, top), frame=False)
            pen.bars(style, cells - 0.42, cells + 0.42, 0, values)
            pen.segments("grid", -0.5, 0, CELLS - 0.5, 0, width=1)
            pen.text("ink" if fresh else "muted", -0.45, top * 1.13, label, size=12)
            if row != 1:
                pen.segments(
                    "truth", self.robot, 0, self.robot, float(values[self.robot]), width=2.5
                )
