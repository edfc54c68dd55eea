"""The mower: a real robot, four radio beacons, and a filter whose settings you choose.

The chapter on a real robot as a machine. The log is Plaza 2: a mower on grass that hears one
distance at a time. Each tick of the scene is one recorded range. The reader may hide most ranges,
forget that the radios read long, trust them too much, or start without knowing where.
"""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.camera import ease, say_outside, wanted
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene, Score

BOUNDS = (-90.0, 20.0, -5.0, 95.0)
LAWN = (-90.0, 20.0, -12.0, 95.0)  # a beacon stands just below the bounds
DRIFT = pf.Drift((0.005, 0, 0), (5e-5, 0.002, 0))
WINDOW = 200  # ranges that the chart shows
SURE, FAR = 1.0, 2.5  # metres: what counts as sure of itself, and as wrong


@cache
def recorded() -> dict[str, Any]:
    """The log, unpacked into metres, seconds and radians; controls are composed once."""
    raw = json.loads(files("pfkit.explore").joinpath("mower.json").read_text("ascii"))
    seconds = np.array(raw["t [ms]"]) / 1e3
    dt = np.maximum(seconds, 1e-3)
    way, turn = np.array(raw["driven [mm]"]) / 1e3, np.array(raw["turned [0.1 mrad]"]) / 1e4
    truth = np.stack((raw["x [cm]"], raw["y [cm]"], raw["theta [mrad]"])) * [[0.01], [0.01], [1e-3]]
    z = np.stack((np.array(raw["range [cm]"]) / 100, raw["beacon"]))
    log = pf.Log(
        np.cumsum(seconds),
        np.stack((way / dt, turn / dt, dt)),
        [z[:, k : k + 1] for k in range(z.shape[1])],
        truth=truth,
        start=np.array(raw["start"]),
        world=pf.LandmarkMap(np.array(raw["beacons [m]"]), bounds=BOUNDS),
    )
    short = pf.preintegrate(log, DRIFT)
    blind = pf.compose(log.start[:, None], pf.Preintegrated(log.u, DRIFT).path[:, 1:])
    return {"log": short, "blind": blind, "bias": np.array(raw["bias [m]"])}


class Mower(Scene):
    name = "mower"
    size = (720, 460)
    rate = 20.0
    record_steps = 600
    record_every = 10
    gauges: ClassVar[dict[str, Gauge]] = {
        "time": Gauge("s", 1),
        "error": Gauge("m", 2),
        "spread": Gauge("m", 2),
        "dead reckoning": Gauge("m", 1),
        "ranges used": Gauge(),
        "ESS": Gauge(),
    }
    all_controls = (
        Control("bias", "Know the beacons' biases", "toggle", True, help="1.9 to 3.8 m, learnt."),
        Control(
            "keep",
            "Use one range in",
            "range",
            1,
            lo=1,
            hi=60,
            step=1,
            help="The others are thrown away before the filter sees them.",
        ),
        Control(
            "sigma_r",
            "Modelled noise of a range",
            "range",
            3.0,
            lo=0.3,
            hi=10,
            step=0.1,
            unit="m",
            log=True,
            help="The true errors have a standard deviation of about 1.6 m.",
        ),
        Control(
            "start",
            "Start",
            "choice",
            "known",
            choices=(("known", "known"), ("anywhere", "anywhere on the lawn")),
            help="Anywhere: uniform, and the measurements are let in by stages.",
            live=False,
        ),
        Control(
            "M",
            "Particles",
            "choice",
            "1000",
            choices=(("200", "200"), ("1000", "1,000"), ("4000", "4,000")),
            help="More particles: slower, and safer from an unknown start.",
            live=False,
        ),
        Control(
            "begin",
            "Scrub the log to",
            "range",
            0,
            lo=0,
            hi=90,
            step=5,
            unit="%",
            live=False,
            help="Where in the seven minutes the run begins.",
        ),
    )
    panels: ClassVar[dict[str, Panel]] = {
        "mower": Panel(
            "A real mower among four radio beacons",
            ("bias", "keep", "sigma_r", "start", "begin"),
            ("M",),
            score=Score("error", 200, FAR),
            missions=(
                Mission(
                    "sure and wrong",
                    "Let it run for ten seconds, then forget the biases and trust the ranges more: "
                    f"1.5 m. Find a moment when the spread is below {SURE:g} m and the error "
                    f"above {FAR:g} m.",
                    lambda s: s.values["bias"] is False and s.spread < SURE and s.error > FAR,
                ),
                Mission(
                    "one range in twenty",
                    "Know the biases and throw ranges away. Can it live on one range in twenty "
                    "for a minute, with an error below 5 m at the end?",
                    lambda s: s.thin_for > 260 and s.error < 5,
                ),
                Mission(
                    "found from anywhere",
                    "Start anywhere. How many ranges until error and spread are below 3 m? "
                    "Scrub the log to another place and count again.",
                    lambda s: s.values["start"] == "anywhere" and max(s.error, s.spread) < 3,
                ),
            ),
            alt="A lawn with four radio beacons. A mower drives in loops; a cloud of particles "
            "follows it while dead reckoning, a dotted track, wanders off. A chart below compares "
            "the error with the spread that the filter reports.",
        )
    }

    def start(self) -> None:
        self.log: pf.Log = recorded()["log"]
        self.k = int(self.values["begin"] / 100 * len(self.log))
        self.first, self.used, self.thin_for = self.k, 0, 0
        M = int(self.values["M"])
        self.truth = self.log.start if self.k == 0 else self.log.truth[:, self.k - 1]
        if self.values["start"] == "known":
            self.bel = pf.gaussian_prior(M, self.truth, (0.3, 0.3, 0.03), self.rng)
        else:
            self.bel = pf.uniform_prior(M, self.log.world, self.rng)
        self.ess = float(M)
        self.view, self.standing = LAWN, ""
        self.chart: list[tuple[float, float]] = []
        self.heard: tuple[int, float] | None = None
        self._judge_cloud()
        self._film()

    shared = ("log",)

    def phases(self) -> tuple[str, ...]:
        return ("predict", "weigh")

    def advance(self) -> Phases:
        if self.k >= len(self.log):
            yield "predict", "The log ends here."
            yield "weigh", f"After {self.used} ranges the error is {self.error:.2f} m."
            return
        before = self.spread
        u = self.log.u[:, self.k]
        self.bel = pf.predict(self.bel, u, pf.ComposedMotion(), self.rng)
        self._judge_cloud()
        yield "predict", f"Predict: the spread goes from {before:.2f} to {self.spread:.2f} m."
        keep = int(self.values["keep"])
        self.heard = None
        self.thin_for = self.thin_for + 1 if keep >= 20 else 0
        if self.k % keep == 0:
            self._listen(self.log.z[self.k])
        self.truth = self.log.truth[:, self.k]
        self.k += 1
        self._judge_cloud()
        self._film()
        if self.heard is None:
            yield "weigh", "Weigh: this range is thrown away."
        else:
            beacon, r = self.heard
            far = f"beacon {beacon + 1} is {r:.1f} m away"
            yield "weigh", f"Weigh: {far}; the spread is {self.spread:.2f} m now."

    def _listen(self, z: np.ndarray) -> None:
        bias = recorded()["bias"] if self.values["bias"] else 0.0
        sensor = pf.Range(self.log.world, self.values["sigma_r"], bias=bias, nu=4)
        self.bel, _ = pf.tempered_update(self.bel, z, sensor, self.rng)
        self.ess = float(self.bel.ess)
        if self.ess < self.bel.M / 2:
            self.bel = pf.resample(self.bel, pf.systematic, self.rng)
        s = int(z[1, 0])
        self.heard = s, float(z[0, 0] - (bias[s] if self.values["bias"] else 0.0))
        self.used += 1

    def _judge_cloud(self) -> None:
        self.mean, Sigma = pf.mean_pose(self.bel), pf.covariance(self.bel)
        self.error = float(np.hypot(*(self.mean - self.truth)[:2]))
        self.spread = float(np.sqrt(Sigma[0, 0] + Sigma[1, 1]))

    def _film(self) -> None:
        """The camera and the chart, once a tick."""
        self.chart.append((self.error, self.spread))
        self.view = ease(self.view, wanted(LAWN, *self.bel.state[:2]), self.rate)
        self._tell_standing()

    def _tell_standing(self) -> None:
        """One sentence when the filter has found the mower, and one when it is sure and wrong."""
        if max(self.error, self.spread) < FAR:
            standing = f"Found: {self.error:.1f} m off after {self.used} ranges."
        elif self.spread < SURE and self.error > FAR:
            standing = f"Sure and wrong: {self.error:.1f} m off, spread {self.spread:.1f} m."
        else:
            return
        if standing[0] != self.standing[:1]:
            self.tell(standing)
        self.standing = standing

    def readouts(self) -> Readouts:
        blind = recorded()["blind"][:2, max(self.k - 1, 0)]
        return {
            "time": float(self.log.t[min(self.k, len(self.log) - 1)]),
            "error": self.error,
            "spread": self.spread,
            "dead reckoning": float(np.hypot(*(blind - self.truth[:2]))),
            "ranges used": float(self.used),
            "ESS": self.ess,
        }

    # ---- drawing ----------------------------------------------------------------------------
    def draw(self, pen: Pen) -> None:
        pen.view((0.01, 0.02, 0.60, 0.96), self.view[:2], self.view[2:], equal=True)
        behind = slice(max(self.first, self.k - 160), max(self.k, 1), 4)
        pen.line("dead reckoning", *recorded()["blind"][:2, behind], width=1.2, dash=2)
        pen.line("truth", *self.log.truth[:2, behind], width=1.5)
        shown = slice(None, None, max(self.bel.M // 300, 1))
        pen.points("particles", *self.bel.state[:2, shown], size=2)
        mx, my = self.log.world.positions
        if self.heard is not None:
            s, r = self.heard
            pen.ellipses("measurement", mx[s], my[s], max(r, 0.1), max(r, 0.1), width=1.2)
        pen.symbols("landmarks", "diamond", mx, my, size=15)
        pen.robots("estimate", *self.mean, radius=1.6)
        pen.robots("truth", *self.truth, radius=2.0)
        say_outside(pen, self.view, self.mean)
        self._draw_chart(pen)

    def _draw_chart(self, pen: Pen) -> None:
        begin = max(0, (len(self.chart) - WINDOW) // 4 * 4)
        error, spread = np.array(self.chart[begin::4]).T
        at = begin + 4 * np.arange(len(error))
        top = max(6.0, float(np.ceil(max(error.max(), spread.max()))))
        pen.view((0.67, 0.12, 0.31, 0.62), (at[0], at[0] + WINDOW), (0, top))
        pen.line("estimate", at, error, width=2)
        pen.line("particles", at, spread, width=2, dash=5)
        pen.ticks(1, [0, top / 2, top])
        pen.view((0.67, 0.78, 0.31, 0.2), (0, 1), (0, 1), frame=False)
        pen.text("ink", 0, 0.75, "error: solid", size=11)
        pen.text("ink", 0, 0.4, "spread: dashed", size=11)
        pen.text("muted", 0, 0.05, f"m, {WINDOW} ranges", size=11)
