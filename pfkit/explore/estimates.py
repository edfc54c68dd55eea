"""Estimates: two heaps that the reader drags, and what each report of them costs.

The belief is two heaps on a floor with a wall across it. Each tick draws a cloud from it, and a
robot from the same belief, and every report pays for its distance to the robot. The bars on the
right are the average prices so far: squared error, distance, and the share of misses beyond the
reach. Which report is cheapest depends on which bars you pay.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene, Score

FLOOR = (8.0, 6.0)
WALL = (0.8, 7.2, 2.8, 3.2)  # x0, x1, y0, y1, metres
M = 300
REPORTS = {  # name -> symbol and style
    "mean": ("circle", "estimate"),
    "median": ("square", "particle 2"),
    "heaviest cluster": ("triangle", "particle 3"),
    "mode": ("diamond", "particle 4"),
}
PRICES = (("squared error, m2", 4), ("distance, m", 4), ("missed", 1))


class Estimates(Scene):
    name = "estimates"
    size = (720, 380)
    rate = 3.0
    record_steps = 60
    record_every = 1
    still_at = 40
    gauges: ClassVar[dict[str, Gauge]] = {
        "squared error of the mean": Gauge("m2", 2),
        "squared error of the mode": Gauge("m2", 2),
        "misses of the mean": Gauge("%", 0),
        "misses of the mode": Gauge("%", 0),
        "robots": Gauge(),
    }
    all_controls = (
        Control("share", "Mass of heap A", "range", 65, lo=5, hi=95, step=5, unit="%",
                help="Heap B holds the rest."),
        Control("width_a", "Width of heap A", "range", 0.4, lo=0.1, hi=1.2, step=0.1, unit="m",
                help="Standard deviation; or drag its rim."),
        Control("width_b", "Width of heap B", "range", 0.4, lo=0.1, hi=1.2, step=0.1, unit="m",
                help="Standard deviation; or drag its rim."),
        Control("reach", "Near enough", "range", 0.5, lo=0.2, hi=1.5, step=0.1, unit="m",
                help="Beyond it a report has missed; it sets the bandwidth of the mode, too."),
    )  # fmt: skip
    panels: ClassVar[dict[str, Panel]] = {
        "estimates": Panel(
            "Reports of a cloud",
            ("share", "width_a", "width_b", "reach"),
            missions=(
                Mission(
                    "into the wall",
                    "Drag the heaps until the mean stands in the wall. How far is the nearest "
                    "particle?",
                    lambda s: s.in_wall and s.apart() > 2,
                ),
                Mission(
                    "the light heap wins",
                    "Pull the heaps apart and make the mode stand in the lighter one. What must "
                    "be true of its width?",
                    lambda s: s.apart() > 2 and s.values["share"] != 50 and s.mode_in_the_light(),
                ),
                Mission(
                    "best and useless",
                    "Find two heaps for which the mean has the smallest squared error of all, and "
                    "misses nine robots of ten. Wait for thirty robots.",
                    lambda s: (
                        s.robots >= 30
                        and s.price("mean")[0] == min(s.price(name)[0] for name in REPORTS)
                        and s.price("mean")[2] >= 0.9
                    ),
                ),
            ),
            score=Score("squared error of the mean", 30, 1.0),
            alt="Two heaps of particles on a floor with a wall across it, markers for mean, "
            "median, heaviest cluster and mode, and bars that say what each report costs on "
            "average: squared error, distance, share of misses.",
        )
    }

    def start(self) -> None:
        self.centres = {"A": (3.4, 1.4), "B": (4.4, 1.4)}
        self._forget()
        self._cloud()

    def _forget(self) -> None:
        """New heaps, new prices."""
        self.paid, self.robots, self.truth = np.zeros((len(REPORTS), 3)), 0, None

    def phases(self) -> tuple[str, ...]:
        return ("report", "pay")

    def advance(self) -> Phases:
        self._cloud()
        x, y = self.at["mean"]
        yield "report", f"Report: {M} particles, their mean at ({x:.1f}, {y:.1f})."
        self.truth = self._draw(1)[:, 0]
        d = np.array([np.hypot(*(at - self.truth)) for at in self.at.values()])
        self.paid = self.paid + np.stack((d**2, d, d > self.values["reach"]), axis=1)
        self.robots += 1
        best = list(REPORTS)[int(d.argmin())]
        yield "pay", f"Pay: robot {self.robots} is {d[0]:.1f} m from the mean; nearest is {best}."

    def changed(self, name: str, value: Any) -> None:
        self._forget()
        self._cloud()
        self.tell(f"The mean is {'in' if self.in_wall else 'outside'} the wall.")

    def held(self, name: str, x: float, y: float, touch: str) -> None:
        heap = name[-1:]
        if name in ("heap A", "heap B"):
            x, y = np.clip(x, 0.3, FLOOR[0] - 0.3), np.clip(y, 0.3, FLOOR[1] - 0.3)
            self.centres = {**self.centres, heap: (float(x), float(y))}
            self.changed(name, (x, y))
        elif name in ("width A", "width B"):
            self.turn(f"width_{heap.lower()}", abs(x - self.centres[heap][0]))
        else:
            super().held(name, x, y, touch)

    def _draw(self, n: int) -> np.ndarray:
        """Places drawn from the belief, (2, n)."""
        in_a = self.rng.random(n) < self.values["share"] / 100
        sd = np.where(in_a, self.values["width_a"], self.values["width_b"])
        centre = np.where(in_a, *(np.reshape(self.centres[h], (2, 1)) for h in "AB"))
        return centre + sd * self.rng.standard_normal((2, n))

    def _cloud(self) -> None:
        bel = pf.from_weights(self._draw(M))
        distance = np.hypot(*(bel.state[:, :, None] - bel.state[:, None]))
        density = pf.kde(bel, bel.state, [self.values["reach"] / 1.5] * 2)
        self.x = bel.state
        self.at = {
            "mean": pf.mean_pose(bel),
            "median": bel.state[:, distance.sum(axis=0).argmin()],
            "heaviest cluster": pf.clusters(bel, (0.5, 0.5)).mean[:, 0],
            "mode": bel.state[:, density.argmax()],
        }

    @property
    def in_wall(self) -> bool:
        """Does the mean stand in the wall?"""
        x, y = self.at["mean"]
        return bool(WALL[0] < x < WALL[1] and WALL[2] < y < WALL[3])

    def apart(self) -> float:
        """Distance of the two heaps, m."""
        return float(np.hypot(*np.subtract(self.centres["A"], self.centres["B"])))

    def mode_in_the_light(self) -> bool:
        """Is the mode nearer to the heap of less mass?"""
        to = {h: np.hypot(*(self.at["mode"] - self.centres[h])) for h in "AB"}
        light, heavy = "BA" if self.values["share"] > 50 else "AB"
        return bool(to[light] < to[heavy])

    def price(self, name: str) -> np.ndarray:
        """Average loss of a report so far: squared error, distance, share of misses."""
        return self.paid[list(REPORTS).index(name)] / max(self.robots, 1)

    def readouts(self) -> Readouts:
        mean, mode = self.price("mean"), self.price("mode")
        return {
            "squared error of the mean": float(mean[0]),
            "squared error of the mode": float(mode[0]),
            "misses of the mean": float(100 * mean[2]),
            "misses of the mode": float(100 * mode[2]),
            "robots": float(self.robots),
            "the mean stands": "in the wall" if self.in_wall else "on the floor",
        }

    def draw(self, pen: Pen) -> None:
        pen.view((0.02, 0.06, 0.60, 0.90), (0, FLOOR[0]), (0, FLOOR[1]), equal=True)
        pen.bars("wall", *WALL)
        pen.points("particles", *self.x, size=3)
        if self.truth is not None:
            pen.robots("truth", *self.truth, 0.0, radius=0.2)
        for name, at in self.at.items():
            pen.symbols(REPORTS[name][1], REPORTS[name][0], *at[:, None], size=11)
        for heap, (x, y) in self.centres.items():
            width = self.values[f"width_{heap.lower()}"]
            pen.ellipses("muted", x, y, 2 * width, 2 * width, dash=4)
            pen.text("ink", x, y + 2 * width + 0.1, f"heap {heap}", 12, anchor=0)
            pen.handle(f"heap {heap}", x, y)
            if x + width < FLOOR[0]:
                pen.handle(f"width {heap}", x + width, y)
        for k, (title, top) in enumerate(PRICES):
            self._bars(pen, k, title, top)

    def _bars(self, pen: Pen, k: int, title: str, top: float) -> None:
        """One price of every report, as a chart."""
        pen.view((0.65, 0.70 - 0.31 * k, 0.33, 0.23), (0, top), (0, 4))
        for row, (name, (symbol, style)) in enumerate(REPORTS.items()):
            paid = float(self.price(name)[k])
            pen.bars(style, 0, min(paid, top), 3.15 - row, 3.85 - row, alpha=0.4)
            pen.symbols(style, symbol, [0.04 * top], [3.5 - row], size=8)
            pen.text("ink", 0.09 * top, 3.3 - row, f"{name} {paid:.2f}", size=10)
        pen.text("ink", 0, 4.2, title, size=11)
