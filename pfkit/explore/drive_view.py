"""The picture of `pfkit.explore.drive`: the arena on the left, how the filter does on the right."""

from __future__ import annotations

import numpy as np

from pfkit.explore.camera import say_outside
from pfkit.explore.pen import Pen
from pfkit.explore.scene import Scene

FADE = 10  # ticks for which the beams of a reading stay


def draw_drive(s: Scene, pen: Pen) -> None:
    """The arena and the strip charts; in the sensing panel the likelihood map alone."""
    x0, x1, y0, y1 = s.bounds
    alone = s.values["show"] == "map"
    pen.view((0.01, 0.02, 0.98 if alone else 0.735, 0.96), s.view[:2], s.view[2:], equal=True)
    if alone:
        _, p = s.likelihood_map()
        pen.image("exact", np.sqrt(p / p.max()), (x0, x1), (y0, y1))
    else:
        pen.line("wall", [x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], width=1)
        pen.line("truth", *s.trail, width=1.5)
        draw_cloud(s, pen)
    _landmarks(s, pen)
    _noise(s, pen)
    if s.z_age < FADE and s.z.size and not alone:
        _beams(s, pen)
    if s.values["show"] == "copies":
        x, y, theta = s.copies()[:, 1:]
        pen.ellipses("muted", x, y, 0.45, 0.45, width=1.5, dash=3)
        pen.quills("muted", x, y, theta, length=24)
    if not alone:
        draw_estimate(s, pen)
    draw_robot(s, pen, 0.18)
    if not alone:
        say_outside(pen, s.view, s.estimate)
        draw_charts(s, pen)


def draw_cloud(s: Scene, pen: Pen) -> None:
    x, y, theta = s.bel.state
    if s.bel.M <= 1500:
        pen.quills("particles", x, y, theta, length=6, size=3)
    else:
        pen.points("particles", x, y, size=2)
    if s.ess < 0.25 * s.bel.M:  # say which particles carry the weight
        heavy = np.argsort(s.bel.log_w)[-40:]
        size = 4 + 16 * np.sqrt(np.exp(s.bel.log_w[heavy] - s.bel.log_w[heavy[-1]]))
        pen.bubbles("particles", x[heavy], y[heavy], size)


def _landmarks(s: Scene, pen: Pen) -> None:
    mx, my = s.landmarks
    pen.symbols("landmarks", "diamond", mx, my, size=17)
    for i in range(mx.size):
        if not s.anonymous:
            pen.text("ink", mx[i] + 0.25, my[i] + 0.25, str(i + 1), size=11)
        pen.handle(f"landmark {i + 1}", mx[i], my[i], grip=False)
    if "remove" in s.panel.controls:
        pen.ellipses("landmarks", mx[s.selected], my[s.selected], 0.35, 0.35, width=2, dash=3)


def _noise(s: Scene, pen: Pen) -> None:
    """Two standard deviations of a reading of landmark 1, with grips to pull them."""
    if "sigma_r" not in s.panel.controls:
        return
    sense, v = s.values["sense"], s.values
    m = s.landmarks[:, 0]
    r, phi = np.hypot(*(m - s.truth[:2])), np.arctan2(*(m - s.truth[:2])[::-1])
    along = 2 * v["sigma_r"] * np.array([np.cos(phi), np.sin(phi)])
    turn = phi + 2 * np.radians(v["sigma_phi"]) * np.linspace(-1, 1, 13)
    arc = s.truth[:2, None] + r * np.array([np.cos(turn), np.sin(turn)])
    if sense == "both":
        around = np.linspace(0, 2 * np.pi, 49)
        reach = r + 2 * v["sigma_r"] * np.cos(around)
        bearing = phi + 2 * np.radians(v["sigma_phi"]) * np.sin(around)
        pen.line("measurement", s.truth[0] + reach * np.cos(bearing),
                 s.truth[1] + reach * np.sin(bearing), width=1, dash=3)  # fmt: skip
    elif sense == "range":
        pen.segments("measurement", *(m - along), *(m + along), width=1)
    else:
        pen.line("measurement", *arc, width=1)
    x0, x1, y0, y1 = s.view
    ends = {"range noise": m - along, "bearing noise": arc[:, -1]}
    for name, at in ends.items():
        used = sense in ("both", name.split()[0])
        if used and x0 < at[0] < x1 and y0 < at[1] < y1:
            pen.handle(name, *at)


def draw_robot(s: Scene, pen: Pen, radius: float) -> None:
    """The true robot, which a hand can carry off."""
    pen.robots("truth", *s.truth, radius=radius)
    pen.handle("robot", *s.truth[:2], grip=False)


def _beams(s: Scene, pen: Pen) -> None:
    """Each reading as the robot took it: a beam of the measured length and direction."""
    x, y, theta = s.truth
    width = 2.2 * (1 - s.z_age / FADE) + 0.4
    ids = s.seen
    mx, my = s.landmarks[:, np.minimum(ids, s.landmarks.shape[1] - 1)]
    r = np.hypot(mx - x, my - y) if s.values["sense"] == "bearing" else s.z[0]
    phi = np.arctan2(my - y, mx - x) - theta
    if s.values["sense"] == "both":
        phi = s.z[1]
    elif s.values["sense"] == "bearing":
        phi = s.z[0]
    ends = x + r * np.cos(theta + phi), y + r * np.sin(theta + phi)
    draw_readings(s, pen, *ends, width)


def draw_readings(s: Scene, pen: Pen, x: np.ndarray, y: np.ndarray, width: float) -> None:
    """Beams from the robot to (x, y): honest ones solid, false ones dashed and crossed out."""
    x0, y0, _ = s.truth
    honest, false = ~s.false, s.false
    if honest.any():
        pen.segments("measurement", x0, y0, x[honest], y[honest], width=width)
        pen.symbols("measurement", "circle", x[honest], y[honest], size=6)
    if false.any():
        ends = np.stack((x[false], y[false]))
        starts = np.broadcast_to([[x0], [y0]], ends.shape)
        gaps = np.full(ends.shape, np.nan)
        xs, ys = np.stack((starts, ends, gaps), axis=-1).reshape(2, -1)
        pen.line("false reading", xs, ys, width=width, dash=5)
        pen.symbols("false reading", "cross", x[false], y[false], size=9)


def draw_estimate(s: Scene, pen: Pen) -> None:
    """Mean and two-sigma ellipse: an empty ring, to be drawn before the robot."""
    x, y, theta = s.estimate
    (a, c), (_, b) = s.Sigma[0, :2], s.Sigma[1, :2]
    middle, half = (a + b) / 2, np.hypot((a - b) / 2, c)
    big, small = np.sqrt(middle + half), np.sqrt(max(middle - half, 0.0))
    angle = 0.5 * np.arctan2(2 * c, a - b)
    pen.ellipses("estimate", x, y, 2 * big, 2 * small, angle, width=2)
    pen.robots("estimate", x, y, theta, radius=0.14)


def draw_charts(s: Scene, pen: Pen, landmarks: bool = True) -> None:
    """Legend, effective share of the particles, and error, over the last ten seconds."""
    left, width = 0.765, 0.215
    pen.view((left, 0.74, width, 0.24), (0, 1), (0, 4), frame=False)
    pen.robots("truth", 0.06, 3.5, 0.0, radius=0.001)
    pen.text("ink", 0.18, 3.5, "robot", size=11)
    pen.robots("estimate", 0.05, 2.6, 0.0, radius=0.001)
    pen.text("ink", 0.18, 2.6, "mean, 2σ", size=11)
    pen.points("particles", np.array([0.03, 0.06, 0.09]), np.array([1.6, 1.85, 1.6]), size=4)
    pen.text("ink", 0.18, 1.7, f"M = {s.bel.M}", size=11)
    if landmarks:
        pen.symbols("landmarks", "diamond", 0.06, 0.8, size=13)
        pen.text("ink", 0.18, 0.8, "landmark", size=11)
    share, error = np.array(s.history).reshape(-1, 2).T
    at = np.arange(160 - share.size, 160)
    pen.view((left, 0.40, width, 0.24), (0, 159), (0, 1))
    pen.line("muted", [0, 159], [s.values["threshold"]] * 2, width=1, dash=3)
    _chart(pen, "particles", at, share)
    pen.text("ink", 0, 1.13, "ESS / M, of 1", size=11)
    if "threshold" in (*s.panel.controls, *s.panel.more):
        pen.handle("threshold", 159, s.values["threshold"])
    top = next((top for top in (1.0, 2.0, 5.0) if error.max(initial=0.0) < top), 12.0)
    pen.view((left, 0.04, width, 0.24), (0, 159), (0, top))
    _chart(pen, "estimate", at, np.minimum(error, top))
    pen.text("ink", 0, 1.13 * top, f"error, of {top:g} m", size=11)


def _chart(pen: Pen, style: str, at: np.ndarray, values: np.ndarray) -> None:
    """A curve above its own shade."""
    if values.size:
        pen.area(style, [at[0], *at, at[-1]], [0, *values, 0], alpha=0.18)
        pen.line(style, at, values, width=2)
