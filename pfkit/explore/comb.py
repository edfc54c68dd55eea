"""The comb: one bar of cumulative weights, five ways to pick from it, and what luck each adds.

The chapter on resampling as a machine. Five particles share a bar of length one in proportion to
their weights. Every scheme drops n teeth on the same bar; a particle gets a copy for each tooth
that hits it. All schemes but one are right on average. They differ in how far a single draw strays
from n w, and the bars on the right measure that: the summed variance of the five offspring counts.

The strip below follows 24 particles with equal weights through repeated resampling: which of the
first generation still have descendants?
"""

from __future__ import annotations

import copy
from typing import Any, ClassVar

import numpy as np

from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Gauge, Mission, Panel, Phases, Readouts, Scene, Score
from pfkit.particles.resampling import SCHEMES
from pfkit.particles.resampling_wheel import resampling_wheel

LETTERS = "12345"
COLOURS = tuple(f"particle {k}" for k in LETTERS)
WEIGHTS = {
    "chapter": (0.40, 0.25, 0.15, 0.12, 0.08),
    "halves": (0.5, 0.5, 0.0, 0.0, 0.0),
    "equal": (0.2, 0.2, 0.2, 0.2, 0.2),
    "one": (0.90, 0.04, 0.03, 0.02, 0.01),
    "fifths": (0.30, 0.30, 0.20, 0.10, 0.10),
}
FAMILY = 24  # particles in the genealogy strip
STRIP = 32  # generations that it shows


def wheel(w: np.ndarray, rng: np.random.Generator, n: int) -> np.ndarray:
    """The wheel of `pf.resampling_wheel`, its picks in the order of the bar."""
    return np.sort(resampling_wheel(w, rng, n))


FIVE = {**SCHEMES, "wheel": wheel}


def teeth(name: str, w: np.ndarray, picks: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Where the teeth fell on the bar, shape (n,): `rng` must be as it was before the draw.

    Residual and wheel do not point at places of this bar; their teeth are spread evenly inside the
    particle that each one picked.
    """
    n = picks.size
    if name == "multinomial":
        sums = np.cumsum(rng.standard_exponential(n + 1))
        return sums[:-1] / sums[-1]
    if name == "stratified":
        return (np.arange(n) + rng.random(n)) / n
    if name == "systematic":
        return (np.arange(n) + rng.random()) / n
    first = np.concatenate(([0.0], np.cumsum(w)))[picks]
    count = np.bincount(picks, minlength=w.size)[picks]
    rank = np.arange(n) - np.searchsorted(picks, picks)
    return first + w[picks] * (rank + 0.5) / count


class Comb(Scene):
    name = "comb"
    size = (720, 520)
    rate = 6.0
    record_steps = 60
    record_every = 1
    gauges: ClassVar[dict[str, Gauge]] = {
        "draws": Gauge(),
        **dict.fromkeys(FIVE, Gauge("", 3)),
        "generation": Gauge(),
        "founders left": Gauge("of 24"),
    }
    all_controls = (
        Control(
            "weights",
            "Weights",
            "choice",
            "chapter",
            choices=(
                ("chapter", "of the chapter"),
                ("fifths", "n·w nearly whole"),
                ("halves", "two halves"),
                ("equal", "equal"),
                ("one", "one takes nearly all"),
            ),
            help="The five weights that share the bar.",
            live=False,
        ),
        Control(
            "n", "Teeth n", "range", 5, lo=2, hi=20, step=1, live=False, help="Draws per resampling"
        ),
        Control(
            "pace",
            "Draws per tick",
            "range",
            1,
            lo=1,
            hi=200,
            step=1,
            log=True,
            help="Raise it and the measured variances settle quickly.",
        ),
        Control(
            "scheme",
            "Scheme of the family tree",
            "choice",
            "multinomial",
            choices=tuple((k, k) for k in FIVE),
            help="Resamples the 24 particles of the strip once per tick.",
            live=False,
        ),
        Control(
            "spread",
            "Spread of their weights",
            "range",
            0.0,
            lo=0,
            hi=2,
            step=0.1,
            help="Standard deviation of the log-weights; 0 makes all 24 equal.",
        ),
    )
    panels: ClassVar[dict[str, Panel]] = {
        "comb": Panel(
            "The comb: five ways to pick from one bar",
            ("weights", "n", "pace", "scheme", "spread"),
            score=Score("founders left", 20, 6),
            missions=(
                Mission(
                    "a hundred draws",
                    "Draw a hundred times. Which counters settle first? Which schemes never give "
                    "particle 1 more or fewer than two copies, and why?",
                    lambda s: s.draws >= 100,
                ),
                Mission(
                    "two halves",
                    "Make two weights equal to one half and three zero. Which schemes can still "
                    "lose one of the two?",
                    lambda s: s.values["weights"] == "halves" and s.draws >= 20,
                ),
                Mission(
                    "two family trees",
                    "Watch the family tree with equal weights. How many founders are left after "
                    "ten generations of multinomial, and of systematic?",
                    lambda s: (
                        s.values["spread"] == 0
                        and min(s.spent("scheme", k.__eq__) for k in ("multinomial", "systematic"))
                        >= 10
                    ),
                ),
            ),
            alt="A bar of length one split between five particles in proportion to their "
            "weights. Below it five rows, one per resampling scheme, with teeth that fall on the "
            "bar; beside each row a bar with the measured variance of the offspring counts. At the "
            "bottom the family tree of 24 particles, whose lines of descent merge.",
        )
    }

    def start(self) -> None:
        self.w = np.array(WEIGHTS[self.values["weights"]])
        self.n = int(self.values["n"])
        self.draws = 0
        self.sum = {k: np.zeros(5) for k in FIVE}
        self.square = {k: np.zeros(5) for k in FIVE}
        self.shown: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        self.parents: list[np.ndarray] = []
        self.family = np.arange(FAMILY)
        self.founders = FAMILY
        self._draw_once()

    def phases(self) -> tuple[str, ...]:
        return ("pick", "descend")

    def advance(self) -> Phases:
        for k in range(int(self.values["pace"]) - 1, -1, -1):
            self._draw_once(show=k == 0)
        yield "pick", self._say_counts()
        log_w = self.values["spread"] * self.rng.standard_normal(FAMILY)
        w = np.exp(log_w - log_w.max())
        parents = FIVE[self.values["scheme"]](w / w.sum(), self.rng, FAMILY)
        self.parents.append(parents)
        self.family, childless = self.family[parents], FAMILY - np.unique(parents).size
        before, self.founders = self.founders, np.unique(self.family).size
        told = (
            f"Generation {len(self.parents)} under {self.values['scheme']}: {childless} of "
            f"{FAMILY} have no child, {self.founders} founders are left."
        )
        if self.founders < before and self.founders in (12, 6, 3, 1):
            self.tell(told)
        yield "descend", told

    def _say_counts(self) -> str:
        """Who strays furthest from n w in this draw."""
        nw = self.n * self.w
        gaps = {
            name: np.bincount(picks, minlength=5) - nw for name, (picks, _) in self.shown.items()
        }
        name = max(gaps, key=lambda k: float(np.abs(gaps[k]).max()))
        i = int(np.abs(gaps[name]).argmax())
        copies = round(float(gaps[name][i] + nw[i]))
        return (
            f"Draw {self.draws}: {name} strays furthest, particle {LETTERS[i]} gets {copies} "
            f"copies where n w is {nw[i]:.2f}."
        )

    def _draw_once(self, show: bool = True) -> None:
        for name, scheme in FIVE.items():
            before = copy.deepcopy(self.rng) if show else self.rng
            picks = scheme(self.w, self.rng, self.n)
            count = np.bincount(picks, minlength=5)
            self.sum[name] += count
            self.square[name] += count**2
            if show:
                self.shown[name] = (picks, teeth(name, self.w, picks, before))
        self.draws += 1

    def variance(self, name: str) -> float:
        """Summed mean square of count minus n w over all draws so far, in copies squared."""
        nw = self.n * self.w
        mean, square = self.sum[name] / self.draws, self.square[name] / self.draws
        return float((square - 2 * nw * mean + nw**2).sum())

    def readouts(self) -> Readouts:
        out: Readouts = {"draws": float(self.draws)}
        out.update({k: self.variance(k) for k in FIVE})
        out["generation"] = float(len(self.parents))
        out["founders left"] = float(self.founders)
        return out

    # ---- drawing ----------------------------------------------------------------------------
    def draw(self, pen: Pen) -> None:
        edges = np.concatenate(([0.0], np.cumsum(self.w)))
        pen.view((0.02, 0.87, 0.64, 0.11), (0, 1), (0, 1), frame=False)
        for i, colour in enumerate(COLOURS):
            pen.bars(colour, edges[i], edges[i + 1], 0, 1, alpha=0.9)
            if self.w[i] > 0.035:
                middle = (edges[i] + edges[i + 1]) / 2
                pen.text("paper", middle, 0.52, LETTERS[i], size=15, anchor=0)
        pen.view((0.69, 0.87, 0.29, 0.11), (0, 1), (0, 1), frame=False)
        pen.text("muted", 0, 0.72, "variance of counts", size=11)
        pen.text("muted", 0, 0.22, f"{self.draws} draws", size=11)
        reference = float((self.n * self.w * (1 - self.w)).sum())
        for row, name in enumerate(FIVE):
            self._draw_row(pen, name, 0.755 - 0.107 * row, edges, reference)
        self._draw_family(pen)

    def _draw_row(
        self, pen: Pen, name: str, bottom: float, edges: np.ndarray, reference: float
    ) -> None:
        picks, at = self.shown[name]
        pen.view((0.02, bottom, 0.64, 0.085), (0, 1), (0, 1), frame=False)
        pen.segments("grid", edges, 0, edges, 0.62, width=1)
        pen.segments("grid", 0, 0, 1, 0, width=1)
        for i, colour in enumerate(COLOURS):
            mine = at[picks == i]
            pen.segments(colour, mine, 0, mine, 0.5, width=2.5)
            pen.symbols(colour, "circle", mine, np.full(mine.shape, 0.55), size=7)
        counts = np.bincount(picks, minlength=5)
        tally = "copies " + " ".join(str(c) for c in counts)
        pen.text("ink", 0, 0.92, name, size=12)
        pen.text("muted", 1, 0.92, tally, size=11, anchor=1)
        pen.view((0.69, bottom, 0.29, 0.085), (0, 1), (0, 1), frame=False)
        value = self.variance(name)
        pen.bars("grid", 0, 0.72, 0.1, 0.5, alpha=0.6)
        pen.bars("estimate", 0, 0.72 * min(value / (1.4 * reference), 1.0), 0.1, 0.5)
        mark = 0.72 / 1.4
        pen.segments("ink", mark, 0.02, mark, 0.6, width=1.5)
        pen.text("ink", 0.75, 0.3, f"{value:.3f}", size=12)

    def _draw_family(self, pen: Pen) -> None:
        pen.view((0.02, 0.03, 0.96, 0.22), (0, STRIP), (-0.5, FAMILY - 0.5), frame=True)
        recent: list[Any] = self.parents[-STRIP:]
        offset = len(self.parents) - len(recent)
        alive = np.ones(FAMILY, bool)
        for column in range(len(recent) - 1, -1, -1):
            parents = recent[column]
            child = np.arange(FAMILY)
            for keep, style, width in ((~alive, "grid", 1.0), (alive, "estimate", 1.6)):
                pen.segments(style, column, parents[keep], column + 1, child[keep], width=width)
            before = np.zeros(FAMILY, bool)
            before[parents[alive]] = True
            alive = before
        pen.text(
            "muted",
            0,
            FAMILY + 1.6,
            f"family tree, {self.values['scheme']}: {self.founders} of {FAMILY} founders left "
            f"after {offset + len(recent)} generations",
            size=11,
        )
