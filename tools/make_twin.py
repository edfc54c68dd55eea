"""Make a simulated twin of an MRCLAM log: same layout, same arena, errors as measured.

    python tools/make_twin.py data/mrclam_twin            # the one that is shipped
    python tools/make_twin.py other_twin --seed 5 --seconds 600 --outliers 0.05

The real log may not be redistributed, its errors may be described. So the twin has what was
measured on data set 4, robot 3: odometry that is commanded, not measured, and differs from the
drive by a speed scale, a turn scale, a delay, moments of slip and noise; a camera that sees
30 degrees to each side, four frames a second, and is mounted slightly askew; range errors that
grow with the distance and hardly change from one frame to the next; heavy tails; other robots
in sight. One thing is better than in reality: false measurements are labelled, in a sixth file.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

from pfkit import wrap
from pfkit.models.motion import drive_arc

SUBJECTS = np.arange(6, 21)
LANDMARKS = np.array(  # one a row, metres, to the centimetre
    [
        *[(0.49, -4.95), (3.13, -5.56), (2.65, -3.75), (0.97, -3.19), (0.85, -1.62)],
        *[(3.72, -1.98), (1.92, -0.82), (0.92, 0.60), (2.76, 0.24), (4.67, 0.84)],
        *[(0.95, 2.71), (3.27, 2.53), (0.89, 4.41), (2.39, 3.80), (4.14, 3.60)],
    ]
).T
CODES = {1: 5, 2: 14, 3: 41, 4: 32, 5: 23, 6: 45, 7: 90, 8: 72, 9: 9, 10: 63, 11: 18, 12: 81}
CODES |= {13: 27, 14: 61, 15: 7, 16: 16, 17: 36, 18: 54, 19: 25, 20: 70}
AREA = np.array([[0.7, 4.4], [-3.0, 3.2]])  # where the robots drive, metres

DT = 0.04  # seconds between two rows of odometry
FRAME = 0.236  # seconds between two pictures
SPEED_SCALE, TURN_SCALE, DELAY = 0.90, 0.95, 0.22
CAMERA_ASKEW = -0.007  # radians
FIELD_OF_VIEW, NEAREST, FARTHEST = 0.52, 1.0, 6.0
SEEN = 0.5  # probability that a landmark in view is recognised in a picture
BLIND = 10.0  # seconds before the camera starts


def commands(steps: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Follow waypoints with the true pose fed back; returns commands and truth at each row."""
    low, high = AREA[:, 0], AREA[:, 1]
    pose = np.array([*rng.uniform(low, high), rng.uniform(-np.pi, np.pi)])
    target, pause, slip = rng.uniform(low, high), 0, 0
    lag = round(DELAY / DT)
    u, truth = np.zeros((2, steps)), np.empty((3, steps + 1))
    truth[:, 0] = pose
    for k in range(steps):
        while np.hypot(*(target - pose[:2])) < 0.4:
            target = rng.uniform(low, high)
            pause = int(rng.exponential(1.5) / DT)
        bearing = wrap(np.arctan2(*(target - pose[:2])[::-1]) - pose[2])
        if pause > 0:
            pause -= 1
        else:
            u[0, k] = 0.085 if abs(bearing) < 0.4 else 0.02
            u[1, k] = np.round(np.clip(1.2 * bearing, -0.45, 0.45), 2) * (abs(bearing) > 0.06)
        slip = slip - 1 if slip > 0 else int(rng.random() < 0.0004) * int(rng.exponential(1.5) / DT)
        v, omega = u[:, max(k - lag, 0)] if k >= lag else (0.0, 0.0)
        distance = SPEED_SCALE * v * DT * (slip == 0) + 0.0008 * rng.standard_normal() * (v > 0)
        turn = TURN_SCALE * omega * DT + 0.004 * rng.standard_normal() * (v + abs(omega) > 0)
        pose = drive_arc(pose, distance, turn)
        truth[:, k + 1] = pose
    return u, truth


def pictures(
    t: np.ndarray, truth: np.ndarray, outliers: float, rng: np.random.Generator
) -> list[tuple[float, int, float, float, bool]]:
    """Rows (time, barcode, range, bearing, false) of what the camera saw."""
    offset = 0.045 * rng.standard_normal(len(SUBJECTS))  # range error per metre, slowly changing
    rows = []
    for now in np.arange(t[0] + BLIND, t[-1], FRAME):
        x, y, theta = (np.interp(now, t, row) for row in (truth[0], truth[1], np.unwrap(truth[2])))
        offset = 0.95 * offset + np.sqrt(1 - 0.95**2) * 0.045 * rng.standard_normal(len(offset))
        dx, dy = LANDMARKS - [[x], [y]]
        r, phi = np.hypot(dx, dy), wrap(np.arctan2(dy, dx) - theta)
        seen = (abs(phi) < FIELD_OF_VIEW) & (r > NEAREST) & (r < FARTHEST)
        for i in np.flatnonzero(seen & (rng.random(len(r)) < SEEN)):
            z_r = r[i] * (1 - 0.015 + offset[i]) + 0.02 * rng.standard_t(4)
            z_phi = wrap(phi[i] + CAMERA_ASKEW + 0.008 * rng.standard_t(4))
            rows.append((now, CODES[int(SUBJECTS[i])], z_r, z_phi, False))
        if rng.random() < 0.25:  # another robot passes
            code = CODES[int(rng.integers(1, 6))]
            rows.append((now, code, rng.uniform(1, 3), rng.uniform(-0.5, 0.5), False))
    for k in np.flatnonzero(rng.random(len(rows)) < outliers):
        code = CODES[int(rng.choice(SUBJECTS))]
        rows[k] = (rows[k][0], code, rng.uniform(1, 6), rng.uniform(-0.52, 0.52), True)
    return rows


def write(folder: Path, seconds: float, seed: int, outliers: float) -> None:
    """Write the six files; times start at a made-up Unix time."""
    rng = np.random.default_rng(seed)
    t = 1_250_000_000 + DT * np.arange(round(seconds / DT) + 1)
    u, truth = commands(len(t) - 1, rng)
    rows = pictures(t, truth, outliers, rng)
    folder.mkdir(parents=True, exist_ok=True)

    def table(name: str, columns: str, lines: list[str]) -> None:
        head = f"# Simulated twin of an MRCLAM log (seed {seed}); not a recording\n# {columns}\n"
        (folder / name).write_text(head + "\n".join(lines) + "\n", encoding="ascii", newline="\n")

    v, omega = np.hstack((u, u[:, -1:]))
    odometry = [f"{a:.3f} {b:.3f} {c:.3f}" for a, b, c in zip(t, v, omega, strict=True)]
    table("Robot1_Odometry.dat", "time [s]  v [m/s]  omega [rad/s]", odometry)
    seen = [f"{a:.3f} {code} {r:.3f} {phi:.3f}" for a, code, r, phi, _ in rows]
    table("Robot1_Measurement.dat", "time [s]  barcode  range [m]  bearing [rad]", seen)
    labels = [f"{row[0]:.3f} {row[4]:d}" for row in rows]
    table("Robot1_Outlier.dat", "time [s]  1 where that row of measurements is false", labels)
    every = slice(None, None, 2)
    filmed = zip(t[every], *truth[:, every], strict=True)
    poses = [f"{a:.3f} {x:.3f} {y:.3f} {theta:.3f}" for a, x, y, theta in filmed]
    table("Robot1_Groundtruth.dat", "time [s]  x [m]  y [m]  heading [rad]", poses)
    marks = zip(SUBJECTS, *LANDMARKS, strict=True)
    lines = [f"{s} {x:.2f} {y:.2f} 0.0001 0.0002" for s, x, y in marks]
    table("Landmark_Groundtruth.dat", "subject  x [m]  y [m]  sd of x  sd of y", lines)
    table("Barcodes.dat", "subject  barcode", [f"{s} {code}" for s, code in CODES.items()])


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seconds", type=float, default=300.0)
    parser.add_argument("--seed", type=int, default=11)
    parser.add_argument("--outliers", type=float, default=0.02, help="share of false measurements")
    args = parser.parse_args()
    write(args.folder, args.seconds, args.seed, args.outliers)


if __name__ == "__main__":
    main()
