"""Tuning: two modelled noises on frozen seeds, and the error of every pair under the pointer.

A target moves along a line. The filter believes that it stands still, or, if it is told, that it
moves as it does. What it models as process and sensor noise is for the reader to choose: in the
picture, or with the sliders. The surface shows the error of each pair on the same twenty seeds;
each tick runs one more seed with the chosen pair.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene, Score

T, M, SEEDS = 30, 60, 20
SPEED, SENSOR = 0.3, 0.5  # of the target, m a step; true standard deviation of a reading, m
LOG_Q, LOG_R = (-1.7, 0.5), (-1.3, 0.7)  # decimal logarithms of the modelled noises
GRID = 9


def tracks(z: np.ndarray, q: Any, r: Any, v: float, rng: np.random.Generator) -> np.ndarray:
    """Estimates (T, ...) of filters along readings z (T, ...), with noises q and r for each."""
    shape = (*np.broadcast_shapes(z.shape[1:], np.shape(q)), M)
    q, r = np.asarray(q)[..., None], np.asarray(r)[..., None]
    x, found = rng.normal(0, SENSOR, shape), []
    for reading in z:
        x = x + v + q * rng.standard_normal(shape)
        log_w, _ = pf.normalise(-0.5 * ((reading[..., None] - x) / r) ** 2)
        w = np.exp(log_w)
        found.append(np.sum(w * x, axis=-1))
        flat = pf.systematic(w.reshape(-1, M), rng).reshape(shape)
        x = np.take_along_axis(x, flat, axis=-1)
    return np.array(found)


def readings(rng: np.random.Generator, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Truth (T,) and readings (T, n)."""
    truth = SPEED * np.arange(1, T + 1)
    return truth, truth[:, None] + SENSOR * rng.standard_normal((T, n))


class Tuning(Scene):
    name = "tuning"
    size = (720, 340)
    rate = 3.0
    record_steps = 30
    record_every = 1
    gauges: ClassVar[dict[str, Gauge]] = {
        "error": Gauge("m", 2),
        "average error": Gauge("m", 2),
        "smallest on the surface": Gauge("m", 2),
        "process noise": Gauge("m a step", 2),
        "sensor noise": Gauge("m", 2),
        "seeds": Gauge(),
    }
    all_controls = (
        Control("model", "The filter believes", "choice", "still",
                choices=(("still", "that it stands still"), ("moves", "in the true speed")),
                help="The model of the motion."),
        Control("log_q", "Process noise, power of ten", "range", -1.5, lo=LOG_Q[0], hi=LOG_Q[1],
                step=0.1, help="Modelled standard deviation a step; or drag the cross."),
        Control("log_r", "Sensor noise, power of ten", "range", -0.3, lo=LOG_R[0], hi=LOG_R[1],
                step=0.1, help="Modelled standard deviation of a reading; or drag the cross."),
    )  # fmt: skip
    panels: ClassVar[dict[str, Panel]] = {
        "tuning": Panel(
            "Two noises on frozen seeds",
            ("model", "log_q", "log_r"),
            missions=(
                Mission(
                    "the lie that helps",
                    "Leave the model wrong and find a pair whose average error over ten seeds is "
                    "below that of the bare readings, 0.5 m. Is it the true pair?",
                    lambda s: (
                        s.values["model"] == "still" and s.seeds >= 10 and s.average() < SENSOR
                    ),
                ),
                Mission(
                    "along the valley",
                    "With the wrong model, find a second good pair whose sensor noise is more "
                    "than twice the true one. What do good pairs have in common?",
                    lambda s: (
                        s.values["model"] == "still"
                        and s.values["log_r"] > 0.05
                        and s.seeds >= 5
                        and s.average() < SENSOR
                    ),
                ),
                Mission(
                    "an honest model",
                    "Tell the filter the true speed, and find a pair with less than half the "
                    "error of the bare readings, over ten seeds.",
                    lambda s: (
                        s.values["model"] == "moves"
                        and s.seeds >= 10
                        and s.average() < 0.5 * SENSOR
                    ),
                ),
            ),
            score=Score("average error", 10, 0.5),
            alt="An error surface over modelled process and sensor noise with a cross that can be "
            "dragged, and beside it the target's track, its readings and the filter's estimate.",
        )
    }

    def start(self) -> None:
        self._chart()
        self._run()

    def _chart(self) -> None:
        """The error of every pair of noises, on seeds that never change."""
        frozen = np.random.default_rng(7)
        truth, z = readings(frozen, SEEDS)
        q = 10 ** np.linspace(*LOG_Q, GRID)[None, :, None]
        r = 10 ** np.linspace(*LOG_R, GRID)[:, None, None]
        pair = np.broadcast_to(z[:, None, None], (T, GRID, GRID, SEEDS))
        found = tracks(pair, q, r, self.speed, frozen)
        off = found[10:] - truth[10:, None, None, None]
        self.surface = np.sqrt(np.mean(off**2, axis=(0, 3)))
        self.errors: list[float] = []

    def _run(self) -> None:
        self.truth, z = readings(self.rng, 1)
        self.z = z[:, 0]
        self.track = tracks(z, self.q, self.r, self.speed, self.rng)[:, 0]
        self.errors = [*self.errors, float(np.sqrt(np.mean((self.track - self.truth)[10:] ** 2)))]

    @property
    def q(self) -> float:
        """Modelled process noise, m a step."""
        return float(10 ** self.values["log_q"])

    @property
    def r(self) -> float:
        """Modelled sensor noise, m."""
        return float(10 ** self.values["log_r"])

    @property
    def speed(self) -> float:
        """What the filter believes, m a step."""
        return SPEED if self.values["model"] == "moves" else 0.0

    @property
    def seeds(self) -> int:
        """Runs with the present pair."""
        return len(self.errors)

    def average(self) -> float:
        """Root mean square of the errors with the present pair, m."""
        return float(np.sqrt(np.mean(np.square(self.errors))))

    def phases(self) -> tuple[str, ...]:
        return ("run",)

    def advance(self) -> Phases:
        self._run()
        yield (
            "run",
            f"Run: seed {self.seeds} errs by {self.errors[-1]:.2f} m, all so far by "
            f"{self.average():.2f} m; bare readings by {SENSOR} m.",
        )

    def changed(self, name: str, value: Any) -> None:
        if name == "model":
            self._chart()
        self.errors = []
        self._run()
        self.tell(f"With this pair the first seed errs by {self.errors[-1]:.2f} m.")

    def held(self, name: str, x: float, y: float, touch: str) -> None:
        if name == "pair":
            self.turn("log_q", x)
            self.turn("log_r", y)
        else:
            super().held(name, x, y, touch)

    def readouts(self) -> Readouts:
        return {
            "error": self.errors[-1],
            "average error": self.average(),
            "smallest on the surface": float(self.surface.min()),
            "process noise": self.q,
            "sensor noise": self.r,
            "seeds": float(self.seeds),
        }

    def draw(self, pen: Pen) -> None:
        pen.view((0.11, 0.14, 0.36, 0.76), LOG_Q, LOG_R)
        shade = np.clip(self.surface / (2 * SENSOR), 0, 1)
        pen.image("exact", shade, LOG_Q, LOG_R)
        q, r = np.linspace(*LOG_Q, GRID), np.linspace(*LOG_R, GRID)
        j, i = np.unravel_index(self.surface.argmin(), self.surface.shape)
        pen.symbols("landmarks", "star", q[[i]], r[[j]], size=12)
        at = self.values["log_q"], self.values["log_r"]
        pen.symbols("estimate", "cross", *np.reshape(at, (2, 1)), size=12)
        pen.handle("pair", *at)
        pen.text("ink", LOG_Q[0], LOG_R[1] + 0.06, "sensor against process noise", 10)
        pen.text("ink", LOG_Q[0] + 0.05, LOG_R[0] + 0.06, "dark: large error", 10)
        pen.ticks(0, np.arange(-1.5, 0.6, 0.5))
        pen.ticks(1, np.arange(-1, 0.8, 0.5))
        t = np.arange(1, T + 1)
        pen.view((0.55, 0.14, 0.43, 0.76), (0, T), (-1, SPEED * T + 2))
        pen.line("truth", t, self.truth, width=2)
        pen.points("measurement", t, self.z, size=5)
        pen.line("estimate", t, np.clip(self.track, -1, SPEED * T + 2), width=2, dash=5)
        pen.text("ink", 1, SPEED * T + 2.3, "target line, filter dashes", size=10)
        pen.ticks(0, np.arange(0, T + 1, 10))
