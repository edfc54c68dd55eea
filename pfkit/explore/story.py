"""The story of the course in half a minute: anywhere, a ring, two places, here.

A film, which the front page opens with. The robot has a compass and a map of radio beacons. It
hears how far away they are, and only those nearby. One range leaves a ring of guesses. Driving
straight on leaves two places, mirror images of each other. A second beacon tells them apart.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Panel, Phases, Readouts, Scene

BOUNDS = (0.0, 16.0, 0.0, 7.0)
BEACONS = np.array([[5.0, 13.4, 10.2], [3.4, 1.6, 6.2]])
START = np.array([1.9, 1.5, 0.0])
HEARD = 4.6  # metres: how far a beacon is heard
M, RATE = 1000, 30.0
STAND, RING, STRAIGHT = 75, 180, 420  # ticks: until the first range, the first metre, the turn
CLOSE = 1.0  # metres: a guess so near to the robot is one of the right place
SURE = 0.9  # share of such guesses from which on the story ends
STAGES = ("anywhere", "a ring", "two places", "here")
MOTION = pf.VelocityMotion((0.05, 0.01, 0.05, 0.05, 0.01, 0.01))


class Story(Scene):
    name = "story"
    size = (960, 440)
    rate = RATE
    record_steps = 640
    record_every = 8
    still_at = 200
    all_controls: tuple[Control, ...] = ()
    gauges: ClassVar[dict[str, Gauge]] = {"near the robot": Gauge("%"), "range": Gauge("m", 1)}
    panels: ClassVar[dict[str, Panel]] = {
        "story": Panel(
            "Where am I?",
            (),
            alt="A robot near a radio beacon, on a map full of guesses. A range leaves a ring of "
            "them round the beacon; driving on leaves two clouds, mirror images of each other; a "
            "second beacon leaves one, on the robot.",
        )
    }
    shared = ("world", "sensor", "sight")

    def start(self) -> None:
        self.world = pf.LandmarkMap(BEACONS, bounds=BOUNDS)
        self.sensor = pf.Range(self.world, 0.35)
        self.sight = pf.FieldOfView(self.world, r_max=HEARD)
        self.truth = START.copy()
        pose = self.world.sample_poses(M, self.rng)
        pose[2] = START[2] + 0.15 * self.rng.standard_normal(M)  # the compass
        self.bel = pf.from_weights(pose)
        self.lineage = np.arange(M)
        self.heard, self.age = np.empty((2, 0)), 99  # ranges, and which beacons
        self.stage = STAGES[0]
        self.trail = self.truth[:2, None].copy()

    def phases(self) -> tuple[str, ...]:
        return STAGES

    def advance(self) -> Phases:
        u = self._command()
        self.age += 1
        self.truth = MOTION.sample(self.truth, u, self.rng)
        self.bel = pf.predict(self.bel, u, MOTION, self.rng)
        if self.ticks % 4 == 0:
            self.trail = np.append(self.trail, self.truth[:2, None], axis=1)
        if self.ticks < STAND:
            if self.ticks == 0:
                yield STAGES[0], f"Anywhere: {M} guesses, and nothing heard yet."
        elif (self.ticks - STAND) % 15 == 0:
            self._hear()
            yield self.stage, self._say()

    def _command(self) -> np.ndarray:
        """Stand, drive straight on, then round to the left."""
        if self.ticks < RING:
            return np.array([0.0, 0.0, 1 / RATE])
        return np.array([0.9, 0.0 if self.ticks < STRAIGHT else 0.4, 1 / RATE])

    def _hear(self) -> None:
        near = self.world.ids[self.sight(self.truth)]
        z = self.heard = self.sensor.sample(self.truth, self.rng, ids=near)
        self.age = 0
        self.bel, _ = pf.update(self.bel, z, self.sensor)
        if self.bel.ess < M / 2:
            ancestors = np.arange(M)

            def remembering(w: np.ndarray, rng: np.random.Generator, n: int) -> np.ndarray:
                ancestors[:] = pf.systematic(w, rng, n)
                return ancestors

            self.bel = pf.resample(self.bel, remembering, self.rng)
            assert self.lineage is not None
            self.lineage = self.lineage[ancestors]
        if self.ticks < RING:
            self.stage = STAGES[1]
        else:
            self.stage = STAGES[3] if self.near() > SURE else STAGES[2]

    def near(self) -> float:
        """Share of the belief within a metre of the robot."""
        x, y, _ = self.bel.state
        here = np.hypot(x - self.truth[0], y - self.truth[1]) < CLOSE
        return float(np.exp(self.bel.log_w[here]).sum())

    def _say(self) -> str:
        right = f"{100 * self.near():.0f} % of the guesses are within {CLOSE:g} m of the robot"
        return {
            STAGES[1]: f"A ring: one beacon is {self._range():.1f} m away, somewhere. {right}.",
            STAGES[2]: f"Two places: left and right of the beacon sound the same. {right}.",
            STAGES[3]: f"Here: another beacon fits only one of the two. {right}.",
        }[self.stage]

    def _range(self) -> float:
        """The shortest range of the last look; none: infinite."""
        return float(self.heard[0].min(initial=np.inf))

    def readouts(self) -> Readouts:
        return {"near the robot": 100 * self.near(), "range": self._range()}

    def draw(self, pen: Pen) -> None:
        x0, x1, y0, y1 = BOUNDS
        pen.view((0.005, 0.01, 0.99, 0.98), (x0, x1), (y0, y1), equal=True, frame=True)
        pen.line("truth", *self.trail, width=1.5)
        pen.points("particles", *self.bel.state[:2], size=4)
        if self.age < 12 and self.heard.size:
            r, which = self.heard
            pen.ellipses("measurement", *BEACONS[:, which.astype(np.int64)], r, r, width=2)
        pen.symbols("landmarks", "diamond", *BEACONS, size=20)
        pen.robots("truth", *self.truth, radius=0.22)
