"""A camera that keeps the belief in sight.

A map shows its world. When the cloud leaves it, as after a kidnap, the view widens, slowly and at
most by half on each side; what is further away is named at the edge, with its distance.
"""

from __future__ import annotations

import numpy as np

from pfkit.explore.pen import Pen

Box = tuple[float, float, float, float]  # x0, x1, y0, y1
WIDEST = 0.5  # of the world's width and height, added on each side
SPILL = 0.03  # of them: what hangs over the edge so little moves no camera
HURRY = 2.5  # share of the way to the wanted view that a second goes
CLOSE = 0.01  # of the world's width: near enough to stop


def wanted(world: Box, x: np.ndarray, y: np.ndarray) -> Box:
    """The world and, as far as the widest view allows, the middle nine tenths of the cloud."""
    x0, x1, y0, y1 = world
    return (*_side(x0, x1, x), *_side(y0, y1, y))


def _side(low: float, high: float, cloud: np.ndarray) -> tuple[float, float]:
    few = cloud[:: max(1, cloud.size // 1000)]
    first, last = np.quantile(few, (0.05, 0.95))
    span = high - low
    before, after = max(low - first, 0.0), max(last - high, 0.0)
    before, after = (min(v, WIDEST * span) if v > SPILL * span else 0.0 for v in (before, after))
    return float(low - before), float(high + after)


def ease(now: Box, goal: Box, rate: float) -> Box:
    """The view one tick later, at `rate` ticks a second: part of the way to the goal, or there."""
    gap = np.subtract(goal, now)
    if np.abs(gap).max() < CLOSE * (goal[1] - goal[0]):
        return goal
    x0, x1, y0, y1 = (float(v) for v in now + min(1.0, HURRY / rate) * gap)
    return x0, x1, y0, y1


def say_outside(pen: Pen, view: Box, at: np.ndarray, name: str = "belief") -> None:
    """An arrowhead and words at the edge of the view if the pose `at` lies outside it."""
    x0, x1, y0, y1 = view
    inset = 0.04 * (x1 - x0)
    x, y = np.clip(at[:2], (x0 + inset, y0 + inset), (x1 - inset, y1 - inset))
    away = float(np.hypot(at[0] - np.clip(at[0], x0, x1), at[1] - np.clip(at[1], y0, y1)))
    if away == 0:
        return
    bearing = np.arctan2(at[1] - y, at[0] - x)
    length = 0.6 * inset
    wings = bearing + np.array([2.5, -2.5])
    pen.segments("estimate", x, y, x + length * np.cos(wings), y + length * np.sin(wings), width=2)
    left = x > (x0 + x1) / 2
    words = f"{name} {away:.0f} m outside" if away >= 1 else f"{name} just outside"
    pen.text("ink", x + (-inset if left else inset), y, words, size=12, anchor=1 if left else -1)
