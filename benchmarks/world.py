"""The one piece of work that every contestant does.

A robot drives arcs with noise on v and omega among L known landmarks and measures range and
bearing to all of them at each step. The filter predicts, weighs, answers with the mean pose
(circular mean of the heading) and resamples systematically when ESS < M / 2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SIGMA_V, SIGMA_OMEGA = 0.1, 0.05  # m/s, rad/s
SIGMA_R, SIGMA_PHI = 0.3, 0.1  # m, rad
V, OMEGA, DT = 1.0, 0.2, 0.5
START = np.array((4.0, 2.0, 0.5))
START_SD = np.array((0.5, 0.5, 0.1))


@dataclass(frozen=True)
class Work:
    """What one contestant gets: landmarks (2, L), measurements (T, 3, L), the truth (3, T).

    A measurement is (range, bearing, number of the landmark).
    """

    landmarks: np.ndarray
    z: np.ndarray
    truth: np.ndarray


def make_work(L: int, T: int, seed: int = 0) -> Work:
    """Drive once, measure everything; written out so that it depends on no package."""
    rng = np.random.default_rng(seed)
    landmarks = rng.uniform(0, 10, (2, L))
    x, y, theta = START
    truth, z = [], []
    for _ in range(T):
        v, omega = V + SIGMA_V * rng.normal(), OMEGA + SIGMA_OMEGA * rng.normal()
        half = 0.5 * omega * DT
        chord = v * DT * np.sinc(half / np.pi)
        x, y = x + chord * np.cos(theta + half), y + chord * np.sin(theta + half)
        theta += omega * DT
        truth.append((x, y, theta))
        dx, dy = landmarks[0] - x, landmarks[1] - y
        r = np.hypot(dx, dy) + SIGMA_R * rng.normal(size=L)
        phi = np.arctan2(dy, dx) - theta + SIGMA_PHI * rng.normal(size=L)
        z.append((r, np.mod(phi + np.pi, 2 * np.pi) - np.pi, np.arange(L)))
    return Work(landmarks, np.array(z), np.array(truth).T)


def position_rmse(estimate: np.ndarray, work: Work) -> float:
    """Root mean square of the position error, metres; estimate (T, 3)."""
    return float(np.sqrt(np.mean(np.sum((estimate.T[:2] - work.truth[:2]) ** 2, axis=0))))
