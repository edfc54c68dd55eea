"""Target and proposal: importance sampling under the reader's hands.

The chapter on importance weights as a machine. We want expectations under the *target* but can only
draw from the *proposal*. Each tick draws a fresh sample, weighs it by target over proposal, and
estimates the mean of the target. The lower strip shows the weights as stems, the right one the
estimates of many ticks: where the two densities disagree, a few particles carry everything and the
estimates scatter.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene

X = np.linspace(-8, 8, 801)
NEAR_BEST = 0.48  # of M: the predicted ESS of the best bell for two bumps is 0.486 M
TARGETS = {  # weights, means, standard deviations of normal components
    "one": ((1.0,), (0.0,), (1.0,)),
    "two": ((0.6, 0.4), (-2.0, 2.5), (0.6, 0.8)),
    "narrow": ((1.0,), (1.0,), (0.25,)),
}


def normal(x: np.ndarray, mu: float, sigma: float) -> np.ndarray:
    """Density of N(mu, sigma^2)."""
    return np.exp(-0.5 * ((x - mu) / sigma) ** 2) / (sigma * np.sqrt(2 * np.pi))


def student(x: np.ndarray, mu: float, sigma: float) -> np.ndarray:
    """Density of a Student t with three degrees of freedom: tails that never give up."""
    return 2 / (np.pi * np.sqrt(3) * sigma) / (1 + ((x - mu) / sigma) ** 2 / 3) ** 2


class Proposal(Scene):
    name = "proposal"
    size = (720, 430)
    rate = 3.0
    record_steps = 60
    record_every = 1
    still_at = 40
    gauges: ClassVar[dict[str, Gauge]] = {
        "ESS": Gauge("", 1),
        "ESS predicted": Gauge("", 1),
        "of M": Gauge(),
        "largest weight": Gauge("%", 1),
        "estimate": Gauge("", 2),
        "true mean": Gauge("", 2),
        "scatter": Gauge("sd of 100 estimates", 3),
    }
    all_controls = (
        Control(
            "target",
            "Target",
            "choice",
            "two",
            choices=(("one", "one bump"), ("two", "two bumps"), ("narrow", "a needle")),
            help="The density whose mean we want.",
        ),
        Control(
            "tails",
            "Proposal",
            "choice",
            "normal",
            choices=(("normal", "normal"), ("student", "heavy tails")),
            help="The density that we can draw from.",
        ),
        Control("mu", "Its centre", "range", 0.0, lo=-5, hi=5, step=0.1, help="Or drag the curve."),
        Control("sigma", "Its width", "range", 2.0, lo=0.2, hi=5, step=0.1, help="Scale."),
        Control(
            "M",
            "Particles M",
            "range",
            60,
            lo=5,
            hi=2000,
            step=5,
            log=True,
            help="Draws per tick.",
        ),
    )
    panels: ClassVar[dict[str, Panel]] = {
        "proposal": Panel(
            "Target and proposal",
            ("target", "tails", "mu", "sigma", "M"),
            missions=(
                Mission(
                    "the best bell",
                    "Find the centre and width of the normal proposal with the largest predicted "
                    "ESS. Does the best bell just cover both bumps, or does it reach well beyond "
                    "them?",
                    lambda s: (
                        s.values["target"] == "two"
                        and s.values["tails"] == "normal"
                        and s.predicted() > NEAR_BEST * s.values["M"]
                    ),
                ),
                Mission(
                    "blind to a bump",
                    "Put a narrow proposal on the right bump. The ESS may look healthy. What does "
                    "the estimate say, and why does nothing warn you?",
                    lambda s: (
                        s.values["target"] == "two"
                        and s.values["mu"] > 1.5
                        and s.ess > 0.6 * s.values["M"]
                        and abs(s.estimates[-1] - s.mean) > 1
                    ),
                ),
                Mission(
                    "half as wide",
                    "Take one bump and make the proposal half as wide, or less. Draw again and "
                    "again: how often does one stem tower over all others?",
                    lambda s: (
                        s.values["target"] == "one"
                        and s.values["tails"] == "normal"
                        and s.values["sigma"] <= 0.5
                        and len(s.estimates) >= 20
                    ),
                ),
            ),
            alt="Two density curves, target and proposal. Stems below show the weight of each "
            "particle; a strip on the right shows the estimated means of the last ticks.",
        )
    }

    def start(self) -> None:
        self.estimates: list[float] = []
        self._sample()

    def phases(self) -> tuple[str, ...]:
        return ("draw", "weigh")

    def advance(self) -> Phases:
        M = int(self.values["M"])
        self._draw()
        beyond = int((np.abs(self.x) > X[-1]).sum())
        mean = f"their plain mean is {self.x.mean():.2f}"
        yield "draw", f"Draw: {M} guesses from the proposal, {mean}, {beyond} beyond the edge."
        self._weigh()
        yield (
            "weigh",
            f"Weigh: the weighted mean is {self.estimates[-1]:.2f}, the true one {self.mean:.2f}; "
            f"the effective size is {self.ess:.0f} of {M}.",
        )

    def held(self, name: str, x: float, y: float, touch: str) -> None:
        if name == "centre":
            self.turn("mu", x)
        elif name == "width":
            self.turn("sigma", abs(x - self.values["mu"]))
        else:
            super().held(name, x, y, touch)

    def changed(self, name: str, value: Any) -> None:
        if name in ("target", "mu", "sigma", "tails"):
            self.estimates = []
        self._sample()
        self.tell(f"Effective size {self.ess:.0f} of {self.values['M']:.0f}.")

    def p(self, x: np.ndarray) -> np.ndarray:
        """The target's density."""
        parts = zip(*TARGETS[self.values["target"]], strict=True)
        return np.asarray(sum(w * normal(x, mu, sigma) for w, mu, sigma in parts))

    def q(self, x: np.ndarray) -> np.ndarray:
        """The proposal's density."""
        density = normal if self.values["tails"] == "normal" else student
        return density(x, self.values["mu"], self.values["sigma"])

    @property
    def mean(self) -> float:
        """The target's true mean."""
        w, mu, _ = TARGETS[self.values["target"]]
        return float(np.dot(w, mu))

    def _sample(self) -> None:
        self._draw()
        self._weigh()

    def _draw(self) -> None:
        """Draw from the proposal; every draw is worth the same so far."""
        v = self.values
        M = int(v["M"])
        noise = self.rng.standard_normal(M)
        if v["tails"] == "student":
            noise = noise / np.sqrt(self.rng.chisquare(3, M) / 3)
        self.x = v["mu"] + v["sigma"] * noise
        self.log_w = np.full(M, -np.log(M))

    def _weigh(self) -> None:
        """Weigh the draws by target over proposal."""
        with np.errstate(divide="ignore"):
            log_w = np.log(self.p(self.x)) - np.log(self.q(self.x))
        self.log_w, _ = pf.normalise(log_w)
        self.ess = float(pf.ess(self.log_w))
        self.estimates = [*self.estimates[-99:], float(self.x @ np.exp(self.log_w))]

    def predicted(self) -> float:
        """M / (1 + chi^2) with chi^2 by quadrature; 0 where the integral does not exist."""
        v = self.values
        widest = max(TARGETS[v["target"]][2])
        if v["tails"] == "normal" and v["sigma"] <= widest / np.sqrt(2):
            return 0.0
        x = np.linspace(-60, 60, 6001)
        p, q = self.p(x), self.q(x)
        ratio = np.where(p > 0, p * p / np.maximum(q, 1e-290), 0.0)
        return float(v["M"] / max(ratio.sum() * (x[1] - x[0]), 1.0))

    def readouts(self) -> Readouts:
        return {
            "ESS": self.ess,
            "ESS predicted": self.predicted(),
            "of M": float(self.values["M"]),
            "largest weight": float(100 * np.exp(self.log_w.max())),
            "estimate": self.estimates[-1],
            "true mean": self.mean,
            "scatter": float(np.std(self.estimates)),
        }

    def draw(self, pen: Pen) -> None:
        p, q, w = self.p(X), self.q(X), np.exp(self.log_w)
        top = 1.1 * max(p.max(), q.max())
        pen.view((0.02, 0.45, 0.74, 0.50), (-8, 8), (0, top))
        pen.area("exact", X, p, alpha=0.22)
        pen.line("exact", X, p, width=2)
        pen.line("dead reckoning", X, q, width=2.5, dash=6)
        mu, sigma = self.values["mu"], self.values["sigma"]
        pen.handle("centre", mu, float(self.q(np.array(mu))))
        if mu + sigma < X[-1]:
            pen.handle("width", mu + sigma, float(self.q(np.array(mu + sigma))))
        pen.text("ink", X[p.argmax()] + 0.7, 0.95 * p.max(), "target", size=12)
        pen.text("ink", X[q.argmax()] + 0.3, 0.6 * q.max(), "proposal", size=12)
        pen.view((0.02, 0.08, 0.74, 0.30), (-8, 8), (0, max(3.2 / w.size, 1.1 * w.max())))
        pen.segments("muted", -8, 1 / w.size, 8, 1 / w.size, width=1)
        heavy = np.argsort(w)[-400:]
        pen.stems("particles", self.x[heavy], w[heavy], size=6 if w.size < 200 else 3)
        pen.text("ink", -7.9, 1.1 * max(3.2 / w.size, 1.1 * w.max()), "weights (line: 1/M)", 12)
        pen.ticks(0, np.arange(-8, 9, 2))
        shown = np.clip(self.estimates, -7.9, 7.9)
        pen.view((0.80, 0.08, 0.18, 0.87), (-1, 100), (-4, 4))
        pen.segments("truth", -1, self.mean, 100, self.mean, width=2)
        pen.points("estimate", np.arange(shown.size), np.clip(shown, -3.95, 3.95), size=5)
        pen.text("ink", -1, 4.25, "estimates", size=11)
