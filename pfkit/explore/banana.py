"""The banana: which errors made this cloud?

The chapter on motion as a machine. A robot carries out the same short route many times, and each
time errs a little. Its ends form a cloud whose shape tells which part of the motion is noisy. A
hidden robot leaves the grey cloud; the reader turns the four noises of the velocity model until the
coloured cloud lies on it. Both clouds use the same random numbers at every setting, so that a cloud
bends smoothly while a slider moves.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.camera import say_outside, wanted
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene

M = 300
STEPS, DT = 24, 0.25
ROUTES = {  # v (m/s), omega (rad/s) for each quarter of the route
    "straight": ((1.0, 0.0),) * 4,
    "arc": ((1.0, 0.30),) * 4,
    "corner": ((1.0, 0.0), (0.5, np.pi / 3), (1.0, 0.0), (1.0, 0.0)),
}
ROBOTS = {  # standard deviations: speed per speed, turn per speed, turn per turn, extra turn
    "A": (0.50, 0.05, 0.05, 0.02),
    "B": (0.06, 0.55, 0.10, 0.02),
    "C": (0.06, 0.06, 1.20, 0.02),
    "D": (0.35, 0.35, 0.30, 0.10),
}
NAMES = {
    "A": "A, worn wheels: wrong speed",
    "B": "B, crooked axle: drifts as it drives",
    "C": "C, loose steering: wrong turns",
    "D": "D, all of it",
}


def energy_distance(a: np.ndarray, b: np.ndarray) -> float:
    """2 E|a - b| - E|a - a'| - E|b - b'| of two clouds (2, M), estimated without bias, in metres.

    Zero on average if both clouds obey one law, so by chance a little below zero as well. No point
    is compared with itself: that would add the law's own mean gap over M, 2 cm for a wide cloud.
    """

    def gaps(p: np.ndarray, q: np.ndarray) -> float:
        return float(np.sqrt(((p[:, :, None] - q[:, None, :]) ** 2).sum(axis=0)).sum())

    m, n = a.shape[1], b.shape[1]
    within = gaps(a, a) / (m * (m - 1)) + gaps(b, b) / (n * (n - 1))
    return 2 * gaps(a, b) / (m * n) - within


class Banana(Scene):
    name = "banana"
    size = (720, 430)
    rate = 12.0
    record_steps = 36
    record_every = 1
    still_at = 24
    gauges: ClassVar[dict[str, Gauge]] = {
        "along": Gauge("m", 2),
        "across": Gauge("m", 2),
        "hidden along": Gauge("m", 2),
        "hidden across": Gauge("m", 2),
        "mismatch": Gauge("cm", 1),
    }
    all_controls = (
        Control(
            "route",
            "Route",
            "choice",
            "arc",
            choices=(("straight", "straight"), ("arc", "arc"), ("corner", "corner")),
            help="What the robot is told to do.",
            live=False,
        ),
        Control(
            "a1",
            "Speed error per speed, √α₁",
            "range",
            0.2,
            lo=0,
            hi=1.5,
            step=0.01,
            help="Each step's speed is wrong by this share.",
        ),
        Control(
            "a3",
            "Turn error per speed, √α₃",
            "range",
            0.2,
            lo=0,
            hi=1.5,
            step=0.01,
            unit="rad/m",
            help="Drifts while it drives.",
        ),
        Control(
            "a4",
            "Turn error per turn, √α₄",
            "range",
            0.2,
            lo=0,
            hi=2,
            step=0.02,
            help="Turns too far or too little.",
        ),
        Control(
            "a5",
            "Extra turn, √α₅",
            "range",
            0.02,
            lo=0,
            hi=1,
            step=0.01,
            unit="rad/m",
            help="Heading that no arc explains.",
        ),
        Control(
            "guess",
            "Which robot made the grey cloud?",
            "choice",
            "none",
            choices=(("none", "not yet"), *NAMES.items()),
            help="One of four; a new seed hides another one.",
        ),
    )
    panels: ClassVar[dict[str, Panel]] = {
        "banana": Panel(
            "Which robot made this banana?",
            ("a1", "a3", "a4", "a5", "guess"),
            ("route",),
            missions=(
                Mission(
                    "one noise alone",
                    "Set three of the four noises to zero and move the fourth, one after the "
                    "other. Which ones bend the cloud, and which only stretch it?",
                    lambda s: (
                        sum(s.values[k] == 0 for k in ("a1", "a3", "a4", "a5")) == 3
                        and s.ticks >= 5
                    ),
                ),
                Mission(
                    "on top of it",
                    "Lay your cloud on the grey one: bring the mismatch under 2 cm.",
                    lambda s: s.mismatch < 0.02,
                ),
                Mission(
                    "named",
                    "Name the robot. If two seem possible, choose another route: which route "
                    "tells B from C?",
                    lambda s: s.values["guess"] == s.hidden,
                ),
            ),
            alt="A route drawn as a line and two clouds of end points: grey for the hidden robot, "
            "coloured for yours. The clouds are bent like a banana.",
        )
    }

    def start(self) -> None:
        self.hidden = "ABCD"[int(self.rng.integers(4))]
        self.noise_seed = int(self.rng.integers(2**31))
        jitter = np.exp(0.15 * self.rng.standard_normal(4))
        self.hidden_sd = np.array(ROBOTS[self.hidden]) * jitter
        plan = np.repeat(ROUTES[self.values["route"]], STEPS // 4, axis=0)
        self.u = np.column_stack((plan, np.full(STEPS, DT)))
        self.theirs = self._paths(self.hidden_sd, self.noise_seed + 1)
        self.mean = self._paths(np.zeros(4), 0)[:, :, 0]
        self._mine()

    def _paths(self, sd: np.ndarray, seed: int) -> np.ndarray:
        """Poses (STEPS + 1, 3, M) of M robots with these noises."""
        rng = np.random.default_rng(seed)
        a1, a3, a4, a5 = sd**2
        motion = pf.VelocityMotion((a1, 0.0, a3, a4, a5 + 1e-12, 0.0))
        pose = np.zeros((3, M))
        out = [pose]
        for u in self.u:
            pose = motion.sample(pose, u, rng)
            out.append(pose)
        return np.stack(out)

    def _mine(self) -> None:
        sd = np.array([self.values[k] for k in ("a1", "a3", "a4", "a5")])
        self.mine = self._paths(sd, self.noise_seed)
        self.mismatch = energy_distance(self.mine[-1, :2], self.theirs[-1, :2])

    def changed(self, name: str, value: Any) -> None:
        if name != "guess":
            self._mine()
            self.tell(f"The mismatch is now {100 * self.mismatch:.1f} cm.")
        elif value != "none":
            self.tell(f"Robot {value} is {'right' if value == self.hidden else 'wrong'}.")

    def phases(self) -> tuple[str, ...]:
        return ("drive",)

    def advance(self) -> Phases:
        step = min(self.ticks + 1, STEPS)
        (along, across), (their_along, their_across) = (
            self._spread(cloud[step], step) for cloud in (self.mine, self.theirs)
        )
        yield (
            "drive",
            f"Step {step} of {STEPS}: your cloud is {along:.2f} m long and {across:.2f} m wide, "
            f"the hidden one {their_along:.2f} and {their_across:.2f} m.",
        )

    @property
    def now(self) -> int:
        """Step of the route to show: it is driven once, then stays at its end."""
        return min(self.ticks, STEPS)

    def _spread(self, cloud: np.ndarray, step: int) -> tuple[float, float]:
        """Standard deviations along and across the direction of motion."""
        heading = self.mean[step, 2]
        dx, dy = cloud[:2] - cloud[:2].mean(axis=1, keepdims=True)
        along = dx * np.cos(heading) + dy * np.sin(heading)
        across = dy * np.cos(heading) - dx * np.sin(heading)
        return float(along.std()), float(across.std())

    def readouts(self) -> Readouts:
        along, across = self._spread(self.mine[self.now], self.now)
        h_along, h_across = self._spread(self.theirs[self.now], self.now)
        guess = self.values["guess"]
        return {
            "along": along,
            "across": across,
            "hidden along": h_along,
            "hidden across": h_across,
            "mismatch": 100 * self.mismatch,
            "your guess": "–" if guess == "none" else "right" if guess == self.hidden else "wrong",
        }

    def draw(self, pen: Pen) -> None:
        span = {"straight": (-0.6, 9.4, -3, 3), "arc": (-3.2, 6.4, -0.8, 5.0)}.get(
            self.values["route"], (-0.8, 6.2, -1.2, 4.6)
        )
        ends = np.concatenate((self.mine[-1], self.theirs[-1]), axis=1)
        span = wanted(span, *ends[:2])
        pen.view((0.01, 0.02, 0.98, 0.96), span[:2], span[2:], equal=True)
        pen.line("muted", self.mean[:, 0], self.mean[:, 1], width=1.5, dash=4)
        for step in range(0, self.now, 8):
            pen.points("grid", *self.mine[step, :2], size=2)
        x, y, _ = self.theirs[self.now]
        pen.points("particles", x, y, size=5)
        pen.quills("estimate", *self.mine[self.now], length=8, size=4)
        pen.robots("truth", *self.mean[self.now], radius=0.14)
        say_outside(pen, span, self.mine[self.now].mean(axis=1), "your cloud")
        left, top = span[0] + 0.1, span[3] - 0.2
        pen.points("particles", left, top, size=6)
        pen.text("ink", left + 0.15, top, "hidden robot", size=12)
        pen.points("estimate", left, top - 0.4, size=6)
        pen.text("ink", left + 0.15, top - 0.4, "yours, with headings", size=12)
