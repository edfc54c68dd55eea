"""The exact answer beside the particles: the gauge that a filter of one's own never has.

The same robot as in `pfkit.explore.drive`, in larger steps, so that a grid filter can keep up. The
grid's posterior is the shading under the cloud; the divergence says in nats how far the cloud is
from it. A filter can be right about the robot and wrong about the posterior, and the other way
round: error and divergence are two questions.
"""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.drive import Drive
from pfkit.explore.drive_panels import CONTROLS, HANDS
from pfkit.explore.drive_view import draw_drive
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Gauge, Mission, Panel, Phases, Readouts, Score

CELLS = (25, 20, 24)
COARSE = {  # a grid sees nothing finer than its cells, so the noises start above them
    "sigma_r": {"default": 0.6, "lo": 0.4},
    "sigma_phi": {"default": 15, "lo": 10},
    "threshold": {"default": 1.0},
    "sight": {"default": 6.0},
    "noise": {"default": 1.5},
    "M": {"default": 500},
}


class Exact(Drive):
    name = "exact"
    rate = 2.0
    dt = 0.4
    look_every = 1
    record_steps = 40
    record_every = 1
    still_at = 4
    all_controls = tuple(replace(c, **COARSE.get(c.name, {})) for c in CONTROLS)
    panels: ClassVar[dict[str, Panel]] = {
        "exact": Panel(
            "The exact answer beside the cloud",
            ("M", "trust", "sense", "sigma_r", "kidnap"),
            ("prior", "sigma_phi", "scheme", "threshold", "fresh", *HANDS),
            score=Score("divergence", 20, 1.0),
            missions=(
                Mission(
                    "a hundred times the work",
                    "Start lost with 100 particles, then with 10,000. How many nats does a "
                    "hundred times the work buy after ten looks?",
                    lambda s: s.values["M"] >= 5000 and s.ticks >= 10 and s.nats < 0.3,
                ),
                Mission(
                    "right for the wrong reason",
                    "Take 200 particles or fewer and find a moment with a small error and a large "
                    "divergence: right, for the wrong reason.",
                    lambda s: s.values["M"] <= 200 and s.error < 0.3 and s.nats > 1,
                ),
                Mission(
                    "too much noise expected",
                    "Let the filter expect three times the motion noise there is. Does the error "
                    "tell you? Do the nats?",
                    lambda s: s.spent("trust", lambda times: times >= 3) >= 10,
                ),
            ),
            alt="The exact posterior of a grid filter as shading, the particles on top of it, the "
            "robot and its landmarks. A readout gives the divergence between the two in nats.",
        )
    }  # fmt: skip
    gauges: ClassVar[dict[str, Gauge]] = {**Drive.gauges, "divergence": Gauge("nats", 2)}

    def start(self) -> None:
        super().start()
        self.chance = np.random.default_rng([self.seed, 1])  # the grid must not move the cloud
        if self.values["prior"] == "known":
            self.grid = pf.gaussian_grid(CELLS, self.bounds, self.truth, np.array([0.3, 0.3, 0.2]))
        else:
            self.grid = pf.uniform_grid(CELLS, self.bounds)
        self.nats = 0.0

    def advance(self) -> Phases:
        for name, sentence in super().advance():
            if name == "weigh":
                self._weigh_grid()
                sentence = f"{sentence[:-1]}; to the exact belief it is {self.nats:.2f} nats."
            yield name, sentence

    def _weigh_grid(self) -> None:
        """The exact filter's step, and how far the weighted cloud is from it."""
        exact = self.motion  # what the robot really does; the filter's idea of it may differ
        self.grid = pf.predict_by_convolution(self.grid, self.u, exact, self.chance, draws=600)
        if self.given is not None:
            self.grid, _ = pf.update_grid(self.grid, self.given, self.model)
        bins = int(np.clip(self.bel.M // 10, 4, 48))
        self.nats = float(pf.kl_divergence(self.bel, self.grid, bins=bins).kl)

    def readouts(self) -> Readouts:
        return {"divergence": self.nats, **super().readouts()}

    def draw(self, pen: Pen) -> None:
        pen.view((0.01, 0.02, 0.735, 0.96), self.view[:2], self.view[2:], equal=True)
        p = self.grid.p.sum(axis=2).T
        pen.image("exact", 0.75 * np.sqrt(p / p.max()), self.bounds[:2], self.bounds[2:])
        draw_drive(self, pen)
