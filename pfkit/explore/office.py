"""The office: five laser beams, a floor plan, and a robot that may be anywhere on it.

The capstone's robot. Each look measures how far the beams fly before they meet a wall. A beam tells
little, many poses fit it, and rooms look alike. Drive on: what one look cannot tell, the next can.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

import pfkit as pf
from pfkit.explore.camera import say_outside
from pfkit.explore.drive import ALPHA, Drive
from pfkit.explore.drive_panels import CONTROLS, HANDS
from pfkit.explore.drive_view import (
    draw_charts,
    draw_cloud,
    draw_estimate,
    draw_readings,
    draw_robot,
)
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Control, Mission, Panel, Score
from pfkit.worlds.arenas import OFFICE_DOORS, OFFICE_FURNITURE, OFFICE_ROUTE, OFFICE_WALLS

REACH = 5.0  # metres, the laser's
BODY = 0.22  # metres, the robot's radius
CORNERS = np.array([[0, 0, BODY, -BODY, 0], [BODY, -BODY, 0, 0, 0]])
ROUTE = np.array([[1.5, 9.5, 10.5, 10.5, 6.5, 1.5, 1.5], [4.0, 4.0, 3.6, 1.5, 1.5, 1.5, 3.4]])
OWN = (
    Control(
        "model",
        "Sensor model",
        "choice",
        "field",
        choices=(("beam", "beam model"), ("field", "likelihood field")),
        help="Cast every beam for every particle, or look up where its end lies.",
    ),
    Control(
        "K", "Laser beams", "range", 5, lo=1, hi=15, step=2, help="Spread over the front half."
    ),
    Control(
        "sigma_hit",
        "Beam noise σ",
        "range",
        0.2,
        lo=0.05,
        hi=1,
        step=0.05,
        unit="m",
        help="Standard deviation, of the laser and in the filter's model.",
    ),
    Control(
        "clutter",
        "People in the way",
        "range",
        5,
        lo=0,
        hi=50,
        step=5,
        unit="%",
        help="Share of beams that end too early; the filter allows for 10 %.",
    ),
)
KEPT = ("M", "prior", "noise", "trust", "scheme", "threshold", "fresh", "kidnap", "autopilot",
        "throttle", "steer", "do_predict", "do_weigh", "do_resample", "show", "moves",
        "outliers", "defence")  # fmt: skip


class Office(Drive):
    name = "office"
    size = (760, 440)
    record_steps = 500
    record_every = 12
    still_at = 60
    all_controls = OWN + tuple(
        replace(c, **({"default": 1000} if c.name == "M" else {}))
        for c in CONTROLS
        if c.name in KEPT
    )
    panels: ClassVar[dict[str, Panel]] = {
        "office": Panel(
            "Lost in the office",
            ("kidnap", "M", "K", "model", "fresh"),
            ("prior", "sigma_hit", "clutter", "noise", "threshold", *HANDS),
            score=Score("error", 900, 1.0),
            missions=(
                Mission(
                    "found",
                    "Count the clusters after the first few looks. Which rooms does the robot "
                    "confuse, and what settles it?",
                    lambda s: s.values["prior"] == "lost" and s.error < 0.4 and s.spread < 0.6,
                ),
                Mission(
                    "two beams",
                    "How few particles still find the robot in most of five runs? Then use two "
                    "beams instead of five. Is one beam enough?",
                    lambda s: s.values["K"] <= 2 and s.error < 0.4 and s.spread < 0.6,
                ),
                Mission(
                    "carried off and found",
                    "Carry the robot into another room. Which share of fresh particles brings the "
                    "filter back, and how long does it take?",
                    lambda s: s.kidnapped and s.error < 0.4 and s.spread < 0.8,
                ),
            ),
            values={"M": 1000, "noise": 1.0},
            alt="The plan of an office with five rooms and a corridor. A robot sends out laser "
            "beams; a cloud of particles gathers in the places that would measure the same.",
            record=(440, 20),
        )
    }  # fmt: skip

    shared = ("world", "real", "model", "motion", "believed", "driver")

    def start(self) -> None:
        self.layout = "office"
        self.world = pf.worlds.office()
        self.bounds = self.world.bounds
        self.driver = pf.PurePursuit(ROUTE, v=1.0, dt=self.dt, lookahead=0.5)
        first, second = OFFICE_ROUTE.T[:2]
        self.truth = np.array([*first, np.arctan2(*(second - first)[::-1])])
        self._begin()

    def _build(self) -> None:
        v = self.values
        self.anonymous, K = False, int(v["K"])
        directions = np.linspace(-np.pi / 2, np.pi / 2, K) if K > 1 else np.zeros(1)
        shares = {"z_hit": 0.95 - v["clutter"] / 100, "z_short": v["clutter"] / 100, "z_max": 0.02}
        sigma, rest = v["sigma_hit"], {"z_rand": 0.03, "lambda_short": 0.5}
        self.real = pf.BeamModel(self.world, directions, REACH, sigma, **shares, **rest)
        if v["model"] == "field":
            self.model: Any = pf.LikelihoodField(self.world, REACH, sigma, z_hit=0.85, z_rand=0.15)
        else:
            expected = {"z_hit": 0.85, "z_short": 0.1, "z_max": 0.02}
            self.model = pf.BeamModel(self.world, directions, REACH, sigma, **expected, **rest)
        self.motion = pf.VelocityMotion(tuple(ALPHA * v["noise"] ** 2))
        self.believed = pf.VelocityMotion(tuple(ALPHA * (v["noise"] * v["trust"]) ** 2))

    def _names_seen(self) -> str:
        return "one beam" if self.z.shape[-1] == 1 else f"{self.z.shape[-1]} beams"

    def _measure(self) -> np.ndarray:
        z = self.real.sample(self.truth, self.rng)
        self.false = z[0] < 0.6 * self.real.expected(self.truth)[0]
        return z

    def _inside(self, pose: np.ndarray) -> np.ndarray:
        """Bump into walls: stay where the whole body has room, but turn."""
        if self.world.contains(*(pose[:2, None] + CORNERS)).all():
            return pose
        return np.array([*self.truth[:2], pose[2]])

    def changed(self, name: str, value: Any) -> None:
        if name == "kidnap":
            self._carry_off(None)
        else:
            self._build()

    def draw(self, pen: Pen) -> None:
        pen.view((0.01, 0.02, 0.745, 0.96), self.view[:2], self.view[2:], equal=True, frame=False)
        for boxes, style in (
            (OFFICE_WALLS, "wall"),
            (OFFICE_DOORS, "paper"),
            (OFFICE_FURNITURE, "muted"),
        ):
            left, right, low, high = np.array(boxes).T
            pen.bars(style, left, right, low, high)
        pen.line("truth", *self.trail, width=1.5)
        draw_cloud(self, pen)
        if self.z_age < 10 and self.z.size:
            x, y, theta = self.truth
            ends = self.z[0] * np.exp(1j * (theta + self.z[1])) + x + 1j * y
            draw_readings(self, pen, ends.real, ends.imag, width=1.5)
        draw_estimate(self, pen)
        draw_robot(self, pen, BODY)
        say_outside(pen, self.view, self.estimate)
        draw_charts(self, pen, landmarks=False)
