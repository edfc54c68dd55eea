"""Drive and localise: the course's robot, under the reader's hands.

A robot drives through an arena with a few landmarks. It measures ranges and bearings to those it
can see, and a particle filter guesses where it is. Everything here calls `pfkit` exactly as the
chapters do: `predict`, `update`, `resample`. Panels choose what the reader can move; see
`pfkit.explore.drive_panels`. The drawing is in `pfkit.explore.drive_view`.

Time runs in ticks of 1/30 s. The robot and the particles move in every tick; it looks every
twelfth, and the phases end then: predict (all twelve), weigh, resample. The robot's noise and the
filter's idea of it are two numbers, so that they can disagree.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.camera import ease, wanted
from pfkit.explore.drive_panels import CONTROLS, PANELS
from pfkit.explore.drive_view import draw_drive
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Gauge, Panel, Phases, Readouts, Scene

ALPHA = np.array([0.20, 0.02, 0.25, 0.20, 0.02, 0.02])
ROUTES = {
    "arena": np.array([[2.0, 8.0, 8.4, 5.0, 1.6], [2.4, 1.6, 6.0, 4.6, 6.6]]),
    "square": np.array([[7.5, 12.5, 12.5, 7.5, 2.5, 2.5], [2.5, 2.5, 12.5, 12.5, 12.5, 2.5]]),
}
SQUARE_TURNS = pf.symmetries(pf.worlds.square())  # (3, 4), the first is none
CARRIED = 3.0  # metres; a kidnapper takes the robot at least so far
REACHED = 0.25  # metres; so near to where it was sent, the robot has arrived
LOST = 1.5  # metres; a filter this wrong and still sure of itself is told of
LIGHT = 0.1  # of an equal share of the weight: a particle below it is nearly weightless
RANGE_MAX = 12.0  # metres; false readings are uniform up to here


class Drive(Scene):
    name = "drive"
    size = (700, 500)
    rate = 60.0
    dt: ClassVar[float] = 1 / 30  # seconds of robot time in a tick
    look_every: ClassVar[int] = 12
    record_steps = 480
    record_every = 10
    still_at = 150
    all_controls = CONTROLS
    panels: ClassVar[dict[str, Panel]] = PANELS
    gauges: ClassVar[dict[str, Gauge]] = {
        "time": Gauge("s", 1),
        "error": Gauge("m", 2),
        "heading error": Gauge("°", 1),
        "spread": Gauge("m", 2),
        "ESS": Gauge("", 0),
        "resampled": Gauge("times"),
        "hypotheses": Gauge("alive"),
        "heaviest": Gauge("%", 0),
        "false readings": Gauge(),
        "rejected": Gauge(),
        "likely area": Gauge("m²", 2),
        "information": Gauge("nats", 2),
        "in sight": Gauge(),
    }

    floor = True
    shared = ("world", "real", "faults", "model", "sight", "motion", "believed", "driver")

    # ---- the world --------------------------------------------------------------------------
    def start(self) -> None:
        v = self.values
        self.layout = "square" if v["world"] == "square" else "arena"
        world = pf.worlds.square() if self.layout == "square" else pf.worlds.arena()
        self.landmarks = world.positions[:, : 2 if v["world"] == "pair" else None].copy()
        self.bounds = world.bounds
        if self.layout == "square":
            self.bounds = (0.0, 15.0, 0.0, 15.0)
        self.selected = 0
        self.driver = pf.PurePursuit(ROUTES[self.layout], v=1.0, dt=self.dt, lookahead=0.9)
        first, second = ROUTES[self.layout].T[:2]
        self.truth = np.array([*first, np.arctan2(*(second - first)[::-1])])
        self._begin()

    def _begin(self) -> None:
        """The filter's start, once the world and the robot's place in it are known."""
        self.goal: tuple[float, float] | None = None
        self.carried_from: np.ndarray | None = None  # the robot is in the reader's hand
        self.errand = False  # the goal came from a tap: it is dropped when reached
        self.moved_from: np.ndarray | None = None  # a landmark is in the reader's hand
        self.z = np.empty((0, 0))
        self.z_age, self.false = 99, np.empty(0, bool)
        self.given: np.ndarray | None = None
        self.counts = {"resampled": 0, "false": 0, "rejected": 0}
        self.kidnapped = False
        self.alive = self.most_alive = 0  # hypotheses, now and at most so far
        self.rejected_before = 0  # readings, up to the kidnap
        self.standing = self.told_standing = ""  # found, or wrong and sure of itself
        self.lasting = 0.0  # seconds that it has stood so
        self.view = self.bounds
        self.history: list[tuple[float, float]] = []
        self.trail = self.truth[:2, None].copy()
        self._build()
        self.bel = self._prior(int(self.values["M"]))
        self.ess = float(self.bel.ess)
        self._judge_filter()
        self.before = self.truth, self.spread  # when the phase of prediction began
        self.lineage = np.arange(self.bel.M)

    def _prior(self, M: int) -> pf.Particles:
        if self.values["prior"] == "known":
            return pf.gaussian_prior(M, self.truth, np.array([0.2, 0.2, 0.1]), self.rng)
        return pf.uniform_prior(M, self.world, self.rng)

    def _build(self) -> None:
        """Make map, sensor and motion models from the controls as they stand."""
        v = self.values
        self.world = pf.LandmarkMap(self.landmarks, bounds=self.bounds)
        sigma_r, sigma_phi = v["sigma_r"], np.radians(v["sigma_phi"])
        if v["sense"] == "range":
            self.real = pf.Range(self.world, sigma_r)
            low, high = (0.0,), (RANGE_MAX,)
        elif v["sense"] == "bearing":
            self.real = pf.Bearing(self.world, sigma_phi)
            low, high = (-np.pi,), (np.pi,)
        else:
            self.real = pf.RangeBearing(self.world, sigma_r, sigma_phi)
            low, high = (0.0, -np.pi), (RANGE_MAX, np.pi)
        self.faults = pf.Outliers(v["outliers"] / 100, low, high)
        self.anonymous = not v["names"]
        model: Any = pf.MaximumLikelihood(self.real) if self.anonymous else self.real
        if v["defence"] == "gate":
            model = pf.Gate(model, 10 ** v["gate"])
        elif v["defence"] == "mixture":
            model = pf.OutlierMixture(model, max(v["epsilon"] / 100, 1e-6), self.faults.density)
        self.model = model
        self.sight = pf.FieldOfView(self.world, v["sight"])
        alpha = ALPHA * v["noise"] ** 2 / (30 * self.dt)  # the same drift per second at any dt
        self.motion = pf.VelocityMotion(tuple(alpha))
        self.believed = pf.VelocityMotion(tuple(alpha * v["trust"] ** 2))

    # ---- one tick ---------------------------------------------------------------------------
    def phases(self) -> tuple[str, ...]:
        return ("look",) if self.values["show"] == "map" else ("predict", "weigh", "resample")

    def advance(self) -> Phases:
        v = self.values
        self._move()
        if self.ticks % self.look_every == self.look_every - 1:
            if v["show"] == "map":
                self._look()
                self._judge_filter()
                area = self.readouts()["likely area"]
                yield "look", f"Look: {self._names_seen()} in sight; {area:.2f} m² are likely."
            else:
                self._judge_filter()
                yield "predict", self._say_prediction()
                yield "weigh", self._look()
                yield "resample", self._resample()
                self._judge_filter()
                self.before = self.truth, self.spread
        else:
            self._judge_filter()
        self._draw_charts_on()
        if v["show"] == "copies":
            self._count_hypotheses()

    def _move(self) -> None:
        v = self.values
        self.u = u = self._command()
        if v["moves"]:
            self.truth = self._inside(self.motion.sample(self.truth, u, self.rng))
        self.z_age += 1
        self.given = None
        if v["show"] == "map":
            return
        if v["do_predict"]:
            self.bel = pf.predict(self.bel, u, self.believed, self.rng)
        else:
            self.bel = pf.Particles(self.believed.mean(self.bel.state, u), self.bel.log_w)

    def _say_prediction(self) -> str:
        truth, spread = self.before
        driven, seconds = np.hypot(*(self.truth - truth)[:2]), self.look_every * self.dt
        noise = "" if self.values["do_predict"] else ", without noise"
        went = f"went from {spread:.2f} to {self.spread:.2f} m"
        if f"{spread:.2f}" == f"{self.spread:.2f}":
            went = f"stays {spread:.2f} m"
        return f"Predict{noise}: {driven:.2f} m in {seconds:.1f} s; the spread {went}."

    def _names_seen(self) -> str:
        """The landmarks of the last look in words."""
        if self.seen.size == 0:
            return "no landmark"
        if self.anonymous:
            return f"{self.seen.size} landmarks without names"
        numbers = [str(i + 1) for i in self.seen]
        if len(numbers) == 1:
            return f"landmark {numbers[0]}"
        return f"landmarks {', '.join(numbers[:-1])} and {numbers[-1]}"

    def _count_hypotheses(self) -> None:
        before, self.alive = self.alive, int((self.masses() > 0.02).sum())
        self.most_alive = max(self.most_alive, self.alive)
        if self.most_alive == 4 and self.alive < before:
            self.tell(f"A hypothesis died: {self.alive} of 4 are alive.")

    def _command(self) -> np.ndarray:
        """What the robot is told: (v, omega, dt), by autopilot, keys or pointer."""
        v = self.values
        if not v["moves"]:
            return np.array([0.0, 0.0, self.dt])
        if self.goal is not None:
            dx, dy = self.goal[0] - self.truth[0], self.goal[1] - self.truth[1]
            if self.errand and np.hypot(dx, dy) < REACHED:
                self.goal = None
            turn = float(pf.wrap(np.arctan2(dy, dx) - self.truth[2]))
            speed = min(1.4, 2 * np.hypot(dx, dy)) * max(0.0, np.cos(turn))
            return np.array([speed, np.clip(4 * turn, -2.2, 2.2), self.dt])
        if v["throttle"] or v["steer"]:
            return np.array([1.2 * v["throttle"], 1.8 * v["steer"], self.dt])
        if v["autopilot"]:
            return self.driver(self.ticks, self.truth)
        return np.array([0.0, 0.0, self.dt])

    def _inside(self, pose: np.ndarray) -> np.ndarray:
        x0, x1, y0, y1 = self.bounds
        pose[:2] = np.clip(pose[:2], (x0 + 0.2, y0 + 0.2), (x1 - 0.2, y1 - 0.2))
        return pose

    def _look(self) -> str:
        """Measure what is in sight, and weigh the particles with it."""
        v = self.values
        self.z_age = 0
        self.z = self._measure()
        if v["show"] == "map":
            return ""
        if self.z.size == 0:
            return "Weigh: nothing in sight, the weights stay."
        if not v["do_weigh"]:
            return f"Weigh: switched off; {self._names_seen()} seen and not used."
        self.given = given = self.z[:-1] if self.anonymous else self.z
        if v["defence"] == "gate":
            self.counts["rejected"] += int((~self.model.accepts(given, self.bel.state)).sum())
        self.bel, _ = pf.update(self.bel, given, self.model)
        self.ess = float(self.bel.ess)
        light = int((self.bel.log_w < np.log(LIGHT / self.bel.M)).sum())
        return (
            f"Weigh: {self._names_seen()} seen; {light} of {self.bel.M} particles are nearly "
            f"weightless, the effective size is {self.ess:.0f}."
        )

    def _resample(self) -> str:
        """Turn the weights into copies, if the effective size asks for it."""
        v, M = self.values, self.bel.M
        if not v["do_resample"]:
            return f"Resample: switched off; the effective size stays {self.ess:.0f} of {M}."
        if not (self.given is not None and self.ess < v["threshold"] * M):
            return f"Resample: not now; the effective size is {self.ess:.0f} of {M}."
        before, ancestors = self.ess, np.arange(M)

        def remembering(w: np.ndarray, rng: np.random.Generator, n: int) -> np.ndarray:
            ancestors[:] = pf.SCHEMES[v["scheme"]](w, rng, n)
            return ancestors

        self.bel = pf.resample(self.bel, remembering, self.rng)
        self.lineage = self.lineage[ancestors]
        self.counts["resampled"] += 1
        told = f"Resample: all {M} particles now descend from {np.unique(ancestors).size}"
        if v["fresh"]:
            share = v["fresh"] / 100
            self.bel, new = pf.inject(self.bel, share, self.world.sample_poses, self.rng)
            self.lineage = np.where(new, -1, self.lineage)
            told += f"; {new.sum()} are fresh"
        if (n := self.counts["resampled"]) in (1, 10, 100, 1000):
            times = "for the first time" if n == 1 else f"{n} times so far"
            self.tell(f"Resampled {times}; the effective size was {before:.0f}.")
        return told + "."

    def _measure(self) -> np.ndarray:
        """One reading of each landmark in sight, some of them false: (n, K)."""
        self.seen = self.world.ids[self.sight(self.truth)]
        if self.seen.size == 0:
            return np.empty((0, 0))
        z = self.real.sample(self.truth, self.rng, ids=self.seen)
        z, self.false = self.faults.spoil(z, self.rng)
        self.counts["false"] += int(self.false.sum())
        return z

    def _judge_filter(self) -> None:
        self.estimate = pf.mean_pose(self.bel)
        self.Sigma = pf.covariance(self.bel)
        dx, dy, turn = self.estimate - self.truth
        self.error, self.turn_error = float(np.hypot(dx, dy)), abs(float(pf.wrap(turn)))
        self.spread = float(np.sqrt(self.Sigma[0, 0] + self.Sigma[1, 1]))
        self._tell_standing()

    def _draw_charts_on(self) -> None:
        """The camera, the trail and the charts, once a tick."""
        self.view = ease(self.view, wanted(self.bounds, *self.bel.state[:2]), self.rate)
        if self.look_every == 1 or self.ticks % 4 == 0:
            self.history = [*self.history[-159:], (self.ess / self.bel.M, self.error)]
        if self.ticks % 4 == 0:
            self.trail = np.append(self.trail[:, -220:], self.truth[:2, None], axis=1)

    def _tell_standing(self) -> None:
        """One sentence when the filter has found the robot, or is sure and wrong, for a second."""
        if self.error < 0.4 and self.spread < 1.5:  # fresh particles keep the spread up
            now, sentence = "found", f"Found: the mean is {self.error:.2f} m from the robot."
        elif self.error > LOST and self.spread < 0.5:
            now = "wrong"
            sentence = f"Sure and wrong: {self.error:.1f} m off, spread {self.spread:.2f} m."
        else:
            now, sentence = "", ""
        self.lasting = self.lasting + self.dt if now and now == self.standing else 0.0
        self.standing = now
        if self.lasting >= 1 and now != self.told_standing:
            self.tell(sentence)
            self.told_standing = now

    def copies(self) -> np.ndarray:
        """Poses (3, G) that the square cannot tell from the truth; the truth is the first."""
        return pf.images(self.truth, SQUARE_TURNS)

    def masses(self) -> np.ndarray:
        """Share of the belief near each of those poses, shape (4,)."""
        return pf.hypothesis_mass(self.bel, self.copies(), radius=1.5, angle=0.8)

    # ---- the reader's hand ------------------------------------------------------------------
    def changed(self, name: str, value: Any) -> None:
        if name == "kidnap":
            self._carry_off(None)
        elif name == "add":
            self._place(self.world.sample_poses(1, self.rng)[:2, 0])
        elif name == "fifth":
            self._place(np.array([13.0, 7.5]))
        elif name == "remove" and self.landmarks.shape[1] > 1:
            self.landmarks = np.delete(self.landmarks, self.selected, axis=1)
            self.selected = min(self.selected, self.landmarks.shape[1] - 1)
            self.z = np.empty((0, 0))
        self._build()

    def _place(self, at: np.ndarray) -> None:
        if self.landmarks.shape[1] < 12:
            self.landmarks = np.append(self.landmarks, np.reshape(at, (2, 1)), axis=1)
            self.selected = self.landmarks.shape[1] - 1

    def _carry_off(self, to: np.ndarray | None) -> None:
        """Kidnap: the robot is put down well away from here and the filter is not told."""
        if to is None:
            poses = self.world.sample_poses(100, self.rng)
            away = np.hypot(*(poses[:2] - self.truth[:2, None]))
            to = poses[:, np.argmax(away > CARRIED)]
        before = self.truth
        self.truth = self._inside(np.array(to))
        self.kidnapped, self.rejected_before = True, self.counts["rejected"]
        carried = np.hypot(*(self.truth - before)[:2])
        self.told_standing = ""
        self.tell(f"The robot was carried off, {carried:.1f} m; the filter is not told.")
        self.trail = self.truth[:2, None].copy()
        self._judge_filter()
        self.before = self.truth, self.spread

    def held(self, name: str, x: float, y: float, touch: str) -> None:
        match name.split():
            case []:  # the floor: it drives there
                self.goal = None if touch in ("release", "cancel") else (x, y)
                self.errand = touch == "tap"
            case ["robot"]:
                self._carry(np.array([x, y, self.truth[2]]), touch)
            case ["landmark", number] if 0 < int(number) <= self.landmarks.shape[1]:
                self._move_landmark(int(number) - 1, np.array([x, y]), touch)
            case ["threshold"]:
                self.turn("threshold", y)
            case ["range", "noise"]:
                self.turn("sigma_r", abs(self._from_first(x, y)[0]) / 2)
            case ["bearing", "noise"]:
                self.turn("sigma_phi", np.degrees(abs(self._from_first(x, y)[1])) / 2)
            case _:
                super().held(name, x, y, touch)

    def _from_first(self, x: float, y: float) -> tuple[float, float]:
        """Range and bearing of a place less those of landmark 1, seen by the robot."""
        (r, phi), (r1, phi1) = (
            (np.hypot(*d), np.arctan2(*d[::-1]))
            for d in (np.array([x, y]) - self.truth[:2], self.landmarks[:, 0] - self.truth[:2])
        )
        return float(r - r1), float(pf.wrap(phi - phi1))

    def _move_landmark(self, i: int, to: np.ndarray, touch: str) -> None:
        if touch in ("press", "tap"):
            self.selected, self.moved_from = i, self.landmarks[:, i].copy()
            return
        if touch == "cancel" and self.moved_from is not None:
            to = self.moved_from
        x0, x1, y0, y1 = self.bounds
        self.landmarks[:, i] = np.clip(to, (x0, y0), (x1, y1))
        self._build()

    def _carry(self, to: np.ndarray, touch: str) -> None:
        """The reader carries the robot in the air, then puts it down: a kidnap."""
        if touch == "press":
            self.carried_from = self.truth
        elif touch == "drag":
            self.truth = self._inside(to)
        elif self.carried_from is not None and touch != "tap":
            put_down, self.truth = self._inside(to), self.carried_from
            if touch == "release" and self.values["show"] != "map":
                self._carry_off(put_down)
            elif touch == "release":
                self.truth = put_down
        if touch != "drag":
            self.carried_from = self.carried_from if touch == "press" else None

    # ---- what is shown ----------------------------------------------------------------------
    def likelihood_map(self) -> tuple[np.ndarray, np.ndarray]:
        """Log-likelihood over positions of the last reading, with the true heading: (ny, nx)."""
        x0, x1, y0, y1 = self.bounds
        nx, ny = 64, int(64 * (y1 - y0) / (x1 - x0))
        x = x0 + (np.arange(nx) + 0.5) * (x1 - x0) / nx
        y = y0 + (np.arange(ny) + 0.5) * (y1 - y0) / ny
        theta = np.full((ny, nx), self.truth[2])
        cells = np.stack((*np.meshgrid(x, y), theta)).reshape(3, -1)
        # the map is redrawn while landmarks move: ask what the robot would read now, without noise
        ids = self.world.ids[self.sight(self.truth)]
        if ids.size == 0:
            return np.zeros((ny, nx)), np.full((ny, nx), 1 / (nx * ny))
        z = self.real.expected(self.truth, ids=ids)
        log_p = self.model.log_likelihood(z[:-1] if self.anonymous else z, cells)
        p = np.exp(log_p - log_p.max())
        return log_p.reshape(ny, nx), (p / p.sum()).reshape(ny, nx)

    def draw(self, pen: Pen) -> None:
        draw_drive(self, pen)

    def readouts(self) -> Readouts:
        show = self.values["show"]
        if show == "map":
            x0, x1, y0, y1 = self.bounds
            _, p = self.likelihood_map()
            entropy = float(-(p * np.log(np.where(p > 0, p, 1.0))).sum())
            cell = (x1 - x0) * (y1 - y0) / p.size
            return {
                "likely area": float(np.exp(entropy) * cell),
                "information": float(np.log(p.size) - entropy),
                "in sight": float(self.sight(self.truth).sum()),
            }
        out: Readouts = {
            "time": self.ticks * self.dt,
            "error": self.error,
            "heading error": float(np.degrees(self.turn_error)),
            "spread": self.spread,
            "ESS": self.ess,
            "resampled": float(self.counts["resampled"]),
        }
        if show == "copies":
            masses = self.masses()
            out["hypotheses"] = float(self.alive)
            out["heaviest"] = float(100 * masses.max())
        if self.values["outliers"] or self.values["defence"] != "none":
            out["false readings"] = float(self.counts["false"])
            out["rejected"] = float(self.counts["rejected"])
        return out
