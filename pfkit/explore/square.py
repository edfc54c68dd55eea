"""The square: a robot drives by its books, and a tape measures where it stands.

The chapter on drift as a machine. The hidden robot has wheels of unequal size and another axle than
its books say. By its encoders it drives a square that it believes to be closed; the chart on the
right keeps where each square really ended, in both directions. The reader changes the books. One
direction can be closed in many ways, both together in one.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene, Score

SIDE, RADIUS, AXLE = 4.0, 0.1, 0.5  # metres
ROWS = 6  # of the encoders, for each side and each corner
CLOSED = 0.03  # metres: a square that ends this near has closed
KEPT = 24  # ends that the chart shows
CHART = 1.2  # metres from its middle to its edge
FAR = 0.8  # metres: no square of a new robot misses by more
WAYS = {"ccw": "counter-clockwise", "cw": "clockwise"}


class Square(Scene):
    name = "square"
    size = (720, 400)
    rate = 16.0
    record_steps = 192
    record_every = 2
    still_at = 136
    gauges: ClassVar[dict[str, Gauge]] = {
        "miss": Gauge("cm", 1),
        "ahead": Gauge("cm", 1),
        "to the left": Gauge("cm", 1),
        "squares": Gauge(),
    }
    all_controls = (
        Control(
            "way",
            "Way round",
            "choice",
            "ccw",
            choices=tuple(WAYS.items()),
            help="Which way the square goes. The first side is the same.",
        ),
        Control(
            "axle",
            "Axle in the books",
            "range",
            0.0,
            lo=-6,
            hi=6,
            step=0.1,
            unit="%",
            help="Longer or shorter than the data sheet says.",
        ),
        Control(
            "uneven",
            "Right wheel larger by",
            "range",
            0.0,
            lo=-2,
            hi=2,
            step=0.05,
            unit="%",
            help="Than the left one, in the books.",
        ),
        Control(
            "slip",
            "Slip",
            "range",
            0.5,
            lo=0,
            hi=5,
            step=0.1,
            unit="%",
            help="Noise: each wheel's way is wrong by so much, anew in each row.",
        ),
    )
    panels: ClassVar[dict[str, Panel]] = {
        "square": Panel(
            "Close the square, both ways round",
            ("way", "axle", "uneven", "slip"),
            missions=(
                Mission(
                    "one way round",
                    "Close the counter-clockwise square by the axle alone, to 3 cm but for slip. "
                    "Watch the ends gather in the middle of the chart.",
                    lambda s: (
                        s.values["way"] == "ccw"
                        and s.values["uneven"] == 0
                        and s.expected("ccw") < CLOSED
                    ),
                ),
                Mission(
                    "the other way",
                    "Keep these books and drive clockwise, one whole square. Is the robot "
                    "calibrated? Compare its miss with that of the data sheet.",
                    lambda s: (
                        s.values["uneven"] == 0
                        and s.expected("ccw") < CLOSED
                        and s.spent("way", lambda way: way == "cw") >= s.length
                        and s.values["way"] == "cw"
                    ),
                ),
                Mission(
                    "both ways",
                    "Close both squares to 3 cm, but for slip, with one set of books. Which of the "
                    "two numbers moves both ends ahead together, which one apart?",
                    lambda s: max(s.expected("ccw"), s.expected("cw")) < CLOSED,
                ),
            ),
            score=Score("miss", 8 * ROWS, 100 * CLOSED),
            alt="A square track and the track that the robot really drives, which ends beside its "
            "start. A chart on the right shows where the last squares ended.",
        )
    }

    def start(self) -> None:
        while True:
            k, e = self.rng.uniform((0.015, 0.004), (0.04, 0.012)) * self.rng.choice((-1, 1), 2)
            self.robot = pf.WheelGeometry(
                RADIUS * (1 - e / 2), RADIUS * (1 + e / 2), AXLE * (1 + k)
            )
            if all(4 * CLOSED < self._miss(way, 0.0, 0.0) < FAR for way in WAYS):
                break
        self.ends: list[tuple[str, float, float]] = []
        self._set_out()

    @property
    def length(self) -> int:
        """Rows of a square."""
        return 8 * ROWS

    def _books(self, axle: float, uneven: float) -> pf.WheelGeometry:
        e = uneven / 100
        return pf.WheelGeometry(RADIUS * (1 - e / 2), RADIUS * (1 + e / 2), AXLE * (1 + axle / 100))

    def _turns(self, way: str, axle: float, uneven: float) -> np.ndarray:
        return pf.square_turns(SIDE, self._books(axle, uneven), way == "cw", ROWS)

    def _miss(self, way: str, axle: float, uneven: float) -> float:
        """Metres by which these books miss the start, without slip."""
        path = pf.encoder_odometry(self._turns(way, axle, uneven), self.robot)
        return float(np.hypot(*path[:2, -1]))

    def expected(self, way: str) -> float:
        """Metres by which a square misses without slip, by the books as they are."""
        return self._miss(way, self.values["axle"], self.values["uneven"])

    def _set_out(self) -> None:
        """Begin a square: what the wheels will turn, what the books make of it, what is true."""
        v = self.values
        turns = self._turns(v["way"], v["axle"], v["uneven"])
        slip = 1 + v["slip"] / 100 * self.rng.standard_normal(turns.shape)
        at_rest = np.zeros((3, 1))
        self.way, self.row = v["way"], 0
        self.believed, self.truth = (
            np.hstack((at_rest, path))
            for path in (
                pf.encoder_odometry(turns, self._books(v["axle"], v["uneven"])),
                pf.encoder_odometry(turns * slip, self.robot),
            )
        )

    def phases(self) -> tuple[str, ...]:
        return ("drive",)

    def advance(self) -> Phases:
        if self.row == self.length:
            self._set_out()
        self.row += 1
        x, y, _ = self.truth[:, self.row]
        if self.row == self.length:
            self.ends = [*self.ends[1 - KEPT :], (self.way, float(x), float(y))]
            self.tell(
                f"A {WAYS[self.way]} square ends {100 * x:.0f} cm ahead of its start and "
                f"{100 * y:.0f} cm to the left."
            )
        apart = np.hypot(*(self.truth - self.believed)[:2, self.row])
        yield (
            "drive",
            f"Row {self.row} of {self.length}, {WAYS[self.way]}: the robot is {100 * apart:.0f} cm "
            "from where its books put it.",
        )

    def changed(self, name: str, value: Any) -> None:
        if name != "way":
            self.ends = []
        self._set_out()

    def readouts(self) -> Readouts:
        _, x, y = self.ends[-1] if self.ends else (self.way, *self.truth[:2, self.row])
        return {
            "way": WAYS[self.way],
            "miss": float(100 * np.hypot(x, y)),
            "ahead": float(100 * x),
            "to the left": float(100 * y),
            "squares": float(len(self.ends)),
        }

    def draw(self, pen: Pen) -> None:
        low, high = (-1.0, SIDE + 1) if self.way == "ccw" else (-SIDE - 1, 1.0)
        pen.view((0.02, 0.03, 0.58, 0.94), (-1.5, SIDE + 1.5), (low, high), equal=True)
        for style, path in (("dead reckoning", self.believed), ("truth", self.truth)):
            width, dash = (1.5, 5) if style == "dead reckoning" else (2.5, 0)
            pen.line(style, *path[:2, : self.row + 1], width=width, dash=dash)
            pen.robots(style, *path[:, self.row], radius=0.2)
        pen.symbols("exact", "diamond", 0.0, 0.0, size=9)
        pen.text("ink", -1.4, high - 0.25, "solid: the robot, dashed: its books", size=11)
        pen.view((0.64, 0.19, 0.34, 0.612), (-CHART, CHART), (-CHART, CHART))
        pen.segments("muted", (-CHART, 0), (0, -CHART), (CHART, 0), (0, CHART), width=1)
        for way, style, shape in (("ccw", "estimate", "circle"), ("cw", "measurement", "square")):
            ends = np.array([(x, y) for w, x, y in self.ends if w == way]).reshape(-1, 2).T
            if ends.size:
                pen.symbols(style, shape, *np.clip(ends, -CHART, CHART), size=8)
        pen.text("ink", -CHART, CHART + 0.1, "ends: o ccw, square cw", 10)
        pen.text("ink", 0.05 - CHART, 0.1 - CHART, f"{100 * CHART:.0f} cm to the edge", size=10)
