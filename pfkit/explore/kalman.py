"""Gaussian beside grid: three beliefs from the same evidence, and what each costs.

The chapter on exact beliefs as a machine. A robot drives to and fro in a straight corridor and
looks for doors, for a beacon, or for both. Narrow cells hold the exact belief. Beside it stand a
grid whose cells the reader chooses and one Gaussian, which is Kalman's filter where the beacon
speaks and matches mean and variance where the doors do. Divergences say in nats what each lacks,
products say what it costs.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

import pfkit as pf
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene

Array = NDArray[np.float64]

LOW, HIGH, FINE = -8.0, 18.0, 0.0625  # the corridor and its narrow cells, metres
SPAN = 0.0, 10.0  # where the robot drives
DOORS = (1, 2, 6)
HIT, FALSE = 0.8, 0.1
LEAST = 1e-12  # of a share, below which a cell is not worth a logarithm


def normal(error: Array, var: float) -> Array:
    """Density of N(0, var)."""
    return np.exp(-0.5 * error * error / var) / np.sqrt(2 * np.pi * var)


def beacon(z: float, x: Array, sigma: float) -> Array:
    """Likelihood of a measured place up to a factor: one at the cell that explains it best."""
    log_p = pf.log_gaussian(z - x, sigma)
    return np.exp(log_p - log_p.max())


class Cells:
    """A belief on cells of one width."""

    def __init__(self, width: float) -> None:
        self.width = width
        self.x = np.arange(LOW + width / 2, HIGH, width)
        inside = (self.x > SPAN[0]) & (self.x < SPAN[1])
        self.p = inside / inside.sum()

    @property
    def p_door(self) -> Array:
        """Probability of the report "door" at each centre."""
        return np.where(np.isin(np.floor(self.x), DOORS), HIT, FALSE)

    def move(self, u: float, var: float) -> None:
        """The integral of the prediction, as a sum over all pairs of cells."""
        moved = self.p @ normal(self.x - self.x[:, None] - u, var)
        self.p = moved / moved.sum()

    def look(self, likelihood: Array) -> None:
        """Bayes' rule, cell by cell."""
        self.p, _ = pf.update_1d(self.p, likelihood)


class Kalman(Scene):
    name = "kalman"
    size = (720, 400)
    rate = 2.0
    record_steps = 40
    record_every = 1
    still_at = 6
    gauges: ClassVar[dict[str, Gauge]] = {
        "Gaussian lacks": Gauge("nats", 3),
        "cells lack": Gauge("nats", 3),
        "products a move": Gauge(),
        "robot": Gauge("m", 1),
        "Gaussian's mean": Gauge("m", 1),
        "its deviation": Gauge("m", 2),
    }
    all_controls = (
        Control(
            "sense",
            "The robot looks for",
            "choice",
            "both",
            choices=(("both", "doors and beacon"), ("doors", "doors"), ("beacon", "the beacon")),
            help="The beacon measures the place; the detector says door or wall.",
        ),
        Control(
            "width",
            "Width of the cells",
            "choice",
            "0.5",
            choices=(("2", "2 m"), ("1", "1 m"), ("0.5", "50 cm"), ("0.25", "25 cm"),
                     ("0.125", "12.5 cm")),
            help="Each cell takes the likelihood at its centre.",
            live=False,
        ),
        Control(
            "sigma_z", "Error of the beacon", "range", 1.0, lo=0.1, hi=3.0, step=0.1, unit="m",
            help="Standard deviation of the measured place.",
        ),
        Control(
            "sigma_u", "Error of a move", "range", 0.5, lo=0.3, hi=1.5, step=0.1, unit="m",
            help="Standard deviation of each metre driven.",
        ),
        Control("auto", "By itself", "toggle", True, help="Move and look in turn."),
        Control("move", "Move", "button", help="Predict: one metre.", keys={"m": True}),
        Control("look", "Look", "button", help="Correct: doors, beacon or both.", keys={"l": True}),
    )  # fmt: skip
    panels: ClassVar[dict[str, Panel]] = {
        "kalman": Panel(
            "Gaussian beside grid",
            ("sense", "width", "sigma_z", "move", "look"),
            ("sigma_u", "auto"),
            missions=(
                Mission(
                    "a mean where nobody is",
                    "Let the robot look for doors alone, until the Gaussian's mean stands where "
                    "the exact belief is five times smaller than at its peak. Who is wrong, the "
                    "mean or the Gaussian?",
                    lambda s: s.values["sense"] == "doors" and s.seen() and s.at_mean() < 0.2,
                ),
                Mission(
                    "exact after all",
                    "Let it look for the beacon alone. How many looks until the Gaussian lacks "
                    "less than a hundredth of a nat? Why does it get better?",
                    lambda s: s.values["sense"] == "beacon" and s.seen() and s.gaussian < 0.01,
                ),
                Mission(
                    "too good for its cells",
                    "Take cells of a metre and a beacon of 20 cm or better. Then halve the cells "
                    "until they lack less than 0.04 nats. What does each halving cost?",
                    lambda s: (
                        s.values["sigma_z"] <= 0.2
                        and s.values["sense"] != "doors"
                        and s.seen()
                        and s.cells < 0.04
                    ),
                ),
            ),
            alt="A corridor with three doors and a robot. Below it the exact belief as a shaded "
            "area, the belief on wider cells as bars, and one Gaussian as a dashed line.",
        )
    }

    def start(self) -> None:
        self.exact, self.grid = Cells(FINE), Cells(float(self.values["width"]))
        self.mean = sum(SPAN) / 2
        self.var = (SPAN[1] - SPAN[0]) ** 2 / 12
        self.robot = float(self.rng.uniform(1, 4))
        self.forward, self.last = True, ""
        self.looks, self.report = 0, ""
        self._measure()

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

    def held(self, name: str, x: float, y: float, touch: str) -> None:
        if name != "robot":
            super().held(name, x, y, touch)
        elif touch == "drag":
            self.robot = float(np.clip(x, *SPAN))

    def _move(self) -> str:
        """The robot drives a metre, and all three beliefs with it."""
        if not SPAN[0] + 1 < self.robot < SPAN[1] - 1:
            self.forward = self.robot < sum(SPAN) / 2
        u, sigma = (1.0 if self.forward else -1.0), self.values["sigma_u"]
        self.robot += u + sigma * float(self.rng.standard_normal())
        self.robot = float(np.clip(self.robot, -2.0, 12.0))
        for cells in (self.exact, self.grid):
            cells.move(u, sigma**2)
        self.mean, self.var = self.mean + u, self.var + sigma**2
        self.last, self.report = "move", ""
        self._measure()
        return f"Move: {u:+.0f} m; the Gaussian's deviation grows to {self.var**0.5:.2f} m."

    def _look(self) -> str:
        """The robot looks, and all three beliefs are corrected."""
        said = []
        if self.values["sense"] != "beacon":
            door = bool(self.rng.random() < (HIT if np.floor(self.robot) in DOORS else FALSE))
            for cells in (self.exact, self.grid):
                cells.look(cells.p_door if door else 1 - cells.p_door)
            self._match(door)
            said.append("door" if door else "wall")
        if self.values["sense"] != "doors":
            sigma = self.values["sigma_z"]
            z = self.robot + sigma * float(self.rng.standard_normal())
            for cells in (self.exact, self.grid):
                cells.look(np.exp(pf.log_gaussian(z - cells.x, sigma)))
            bel, _, _ = pf.kalman_update(
                pf.Gaussian([self.mean], [[self.var]]), [z], [[1.0]], [[sigma**2]]
            )
            self.mean, self.var = float(bel.mean[0]), float(bel.Sigma[0, 0])
            said.append(f"beacon {z:.1f} m")
        self.last, self.report = "look", ", ".join(said)
        self.looks += 1
        self._measure()
        return (
            f"Look: {self.report}; the Gaussian lacks {self.gaussian:.2f} nats, "
            f"the cells {self.cells:.2f}."
        )

    def _match(self, door: bool) -> None:
        """Mean and variance of the Gaussian times the report's likelihood."""
        x, p_door = self.exact.x, self.exact.p_door
        product = normal(x - self.mean, self.var) * (p_door if door else 1 - p_door)
        product /= product.sum()
        self.mean = float(product @ x)
        self.var = float(product @ (x - self.mean) ** 2)

    def _measure(self) -> None:
        """Divergences KL(exact || Gaussian) and KL(exact || cells), in nats."""
        p, x = self.exact.p / FINE, self.exact.x
        held = self.exact.p > LEAST
        cell = ((x - LOW) / self.grid.width).astype(int).clip(0, self.grid.x.size - 1)
        coarse = np.maximum(self.grid.p[cell], LEAST * FINE) / self.grid.width
        log_p, weight = np.log(p[held]), self.exact.p[held]
        bell = pf.log_gaussian(x[held] - self.mean, self.var**0.5)
        self.gaussian = float(weight @ (log_p - bell))
        self.cells = float(weight @ (log_p - np.log(coarse[held])))

    def seen(self) -> bool:
        """Was the last thing a look, and not the first?"""
        return self.looks > 2 and self.last == "look"

    def at_mean(self) -> float:
        """The exact belief at the Gaussian's mean, as a share of its peak."""
        p = self.exact.p
        return float(np.interp(self.mean, self.exact.x, p) / p.max())

    def readouts(self) -> Readouts:
        return {
            "Gaussian lacks": self.gaussian,
            "cells lack": self.cells,
            "products a move": float(self.grid.x.size**2),
            "robot": self.robot,
            "Gaussian's mean": self.mean,
            "its deviation": self.var**0.5,
            "saw": self.report or "nothing since it moved",
        }

    def draw(self, pen: Pen) -> None:
        wide = (-5.0, 16.0)
        pen.view((0.02, 0.74, 0.96, 0.22), wide, (0, 1), frame=False)
        doors = np.array(DOORS, float)
        pen.bars("landmarks", doors, doors + 1, 0.15, 0.75, alpha=0.7)
        pen.segments("wall", *wide[:1], 0.15, wide[1], 0.15, width=2)
        pen.handle("robot", self.robot, 0.35)
        pen.robots("truth", self.robot, 0.35, 0.0 if self.forward else np.pi, radius=0.4)
        pen.text("ink", self.robot, 0.9, self.report, size=13, anchor=0)
        exact, grid = self.exact, self.grid
        curve = normal(exact.x - self.mean, self.var)
        top = 1.1 * max(float(exact.p.max()) / FINE, float(grid.p.max()) / grid.width, 0.2)
        pen.view((0.02, 0.08, 0.96, 0.6), wide, (0, top))
        shown = (grid.x > wide[0]) & (grid.x < wide[1])
        left = np.maximum(grid.x[shown] - grid.width / 2, wide[0])
        right = np.minimum(grid.x[shown] + grid.width / 2, wide[1])
        pen.bars("measurement", left, right, 0, grid.p[shown] / grid.width, alpha=0.35)
        seen = (exact.x > wide[0]) & (exact.x < wide[1])
        shape = np.pad(exact.p[seen] / FINE, 1)  # from the axis and back to it
        pen.area("exact", np.pad(exact.x[seen], 1, mode="edge"), shape, alpha=0.35)
        pen.line("exact", exact.x[seen], exact.p[seen] / FINE, width=2)
        pen.line("estimate", exact.x[seen], np.minimum(curve[seen], top), width=2.5, dash=6)
        pen.segments("truth", self.robot, 0, self.robot, 0.06 * top, width=3)
        pen.text("ink", wide[0] + 0.2, 0.9 * top, "area: exact; bars: cells; dashed: Gaussian", 12)
        pen.ticks(0, np.arange(-4, 17, 2))
