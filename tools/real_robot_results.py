"""Measure the filter on the real MRCLAM log, which may not be shipped, and keep the result.

    python tools/real_robot_results.py [FOLDER]       # else found through PFKIT_DATA
    python tools/real_robot_results.py FOLDER "known start"     # this row anew, the others kept

Writes ``data/results/mrclam_ds0.csv`` (one row per experiment: means over seeds with 95 %
intervals), ``mrclam_ds0.json`` (date, version, settings) and ``book/images/mrclam_track.png``.
``tests/test_real_robot.py`` computes the same table wherever the log is found.
"""

from __future__ import annotations

import csv
import datetime
import json
import sys
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

import pfkit as pf
from pfkit.__main__ import draw_track
from pfkit.judging.localise import OUTLIER_SHARE, calibrate_first, localise, score, settings_for

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "data" / "results"
COLUMNS = ("experiment", "seeds", "particles", "rmse_m", "ci_m", "median_m", "p95_m")
COLUMNS += ("heading_rmse_deg", "ci_deg", "converged_s", "converged_within_20_s")
EXPERIMENTS: dict[str, dict[str, Any]] = {
    "known start": {"start": "known", "seeds": 5},
    "known start, calibrated": {"start": "known", "seeds": 5, "calibrated": True},
    "global start": {"start": "global", "seeds": 20},
    "global start, calibrated": {"start": "global", "seeds": 5, "calibrated": True},
    "first minute, global start": {"start": "global", "seeds": 20, "until": 60.0},
    "first minute, plain weighting": dict(start="global", seeds=20, until=60.0, plain=True),
    "as the 2019 report tells it": {"start": "known", "seeds": 5, "as_told": True},
}


class AsTold(pf.RangeBearing):
    """Likelihoods averaged, the bearing without the heading: the 2019 report, eq. 1.6 and 1.9."""

    def log_density(self, zk: Any, pose: Any) -> Any:
        x, y, theta = pose
        pose = np.stack((x, y, np.zeros_like(theta)))
        r = pf.Range(self.world, self.sigma_r).log_density(zk[[0, 2]], pose)
        phi = pf.Bearing(self.world, self.sigma_phi).log_density(zk[[1, 2]], pose)
        return np.logaddexp(r, phi) - np.log(2)

    def log_likelihood(self, z: Any, pose: Any) -> Any:
        each = [self.log_density(z[:, k], pose) for k in range(z.shape[1])]
        return np.logaddexp.reduce(each) - np.log(len(each))


def measure(
    log: pf.Log,
    start: str,
    seeds: int,
    calibrated: bool = False,
    plain: bool = False,
    as_told: bool = False,
    until: float = np.inf,
) -> tuple[Any, Any, Any, Any]:
    """Run one experiment on all seeds; returns settings, calibration, estimate and score."""
    calibration = calibrate_first(log, log.t[-1] / 3) if calibrated else None
    log = log[: int(np.searchsorted(log.t, until))]
    settings = settings_for(log, calibration)
    if as_told:  # sd of the sensor: root of 4e-10, the variance of the weights
        sensor = AsTold(log.world, 2e-5, 2e-5)
        settings = replace(settings, sensor=sensor, start_sd=(2e-4, 2e-4, 1.5))
    corrected = calibration.apply(log) if calibration else log
    rng = np.random.default_rng(0)
    parts = [5] * (seeds // 5)  # five side by side: what fits the processor's cache
    tracks = [
        localise(corrected, rng, start, batch=part, settings=settings, plain=plain)
        for part in parts
    ]
    since = tracks[0].first if start == "global" else 0.0
    estimate = np.concatenate([track.estimate for track in tracks], axis=-1)
    return settings, calibration, estimate, score(log, estimate, settings.limit, since)


def row(name: str, particles: int, s: Any) -> dict[str, Any]:
    """One line of the table."""
    rmse, heading = np.atleast_1d(s.rmse), np.degrees(np.atleast_1d(s.heading_rmse))
    n, settled = rmse.size, np.atleast_1d(s.converged)
    half = [1.96 * v.std(ddof=1) / np.sqrt(n) if n > 1 else 0.0 for v in (rmse, heading)]
    values = (name, n, particles, rmse.mean(), half[0], np.mean(s.median), np.mean(s.p95))
    values += (heading.mean(), half[1], np.median(settled), int((settled <= 20).sum()))
    text = [f"{v:.4f}" if isinstance(v, float) else v for v in values]
    return dict(zip(COLUMNS, text, strict=True))


def table(log: pf.Log, names: Any = EXPERIMENTS) -> tuple[list[dict[str, Any]], dict, Any]:
    """All rows, the settings by experiment, and the first estimate of the calibrated run."""
    rows = [row("dead reckoning", 0, score(log, pf.dead_reckoning(log), 0.5))]
    notes, drawn = {}, None
    for name in names:
        settings, calibration, estimate, s = measure(log, **EXPERIMENTS[name])
        particles = settings.M[EXPERIMENTS[name]["start"] == "global"]
        rows.append(row(name, particles, s))
        notes[name] = {"drift": asdict(settings.drift), "sensor": _sensor(settings.sensor)}
        notes[name] |= {"calibration": str(calibration)} if calibration else {}
        drawn = estimate[..., 0] if name == "known start, calibrated" else drawn
        print(rows[-1], flush=True)
    return rows, notes, drawn


def _sensor(sensor: Any) -> dict[str, float]:
    names = ("sigma_r", "sigma_phi", "nu", "bias_phi")
    return {name: round(float(getattr(sensor, name)), 5) for name in names}


def main(folder: str | None = None, *names: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    log = pf.load_mrclam(folder or "mrclam_ds0")
    rows, notes, drawn = table(log, names or EXPERIMENTS)
    RESULTS.mkdir(parents=True, exist_ok=True)
    about = {
        "log": "UTIAS MRCLAM data set 4, robot 3 (not shipped; see data/README.md)",
        "scored": "every odometry stamp; global starts from the first measurement on",
        "settings chosen on": "the first third of the log only; calibrations fitted there, too",
        "global start": {
            "weighed in stages while wider than": "0.5 m, the error that counts as found",
            "share of false measurements": OUTLIER_SHARE,
            "chosen on": "variants of the log: other starts, fewer landmarks, false measurements",
        },
        "seed": 0,
        "date": datetime.date.today().isoformat(),
        "pfkit": pf.__version__,
        "numpy": np.__version__,
        "settings": notes,
    }
    if names:
        rows, about["settings"] = _merged(rows, notes)
    with (RESULTS / "mrclam_ds0.csv").open("w", newline="", encoding="ascii") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    (RESULTS / "mrclam_ds0.json").write_text(json.dumps(about, indent=1) + "\n", newline="\n")
    if drawn is not None:
        draw(log, drawn)


def _merged(rows: list[dict[str, Any]], notes: dict) -> tuple[list[dict[str, Any]], dict]:
    """Rows and settings of the table on disk, with those just measured in their places."""
    with (RESULTS / "mrclam_ds0.csv").open(encoding="ascii") as file:
        found = {row["experiment"]: row for row in csv.DictReader(file)}
    found |= {row["experiment"]: row for row in rows}
    before = json.loads((RESULTS / "mrclam_ds0.json").read_text())["settings"]
    order = ["dead reckoning", *EXPERIMENTS]
    return [found[name] for name in order if name in found], before | notes


def draw(log: pf.Log, estimate: Any) -> None:
    """Save the picture: the tracks, and how far off they are over time."""
    from matplotlib.figure import Figure

    from pfkit import plotting

    picture = ROOT / "book" / "images" / "mrclam_track.png"
    picture.parent.mkdir(exist_ok=True)
    figure = Figure(figsize=(7.5, 4.6), dpi=100, layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.5))
    draw_track(left, log, estimate)
    left.legend().remove()
    left.set(title="the tracks")
    minutes, shown = log.t / 60, slice(None, None, 200)
    for label, path in (("dead reckoning", pf.dead_reckoning(log)), ("filter", estimate)):
        look = plotting.KINDS["estimate" if label == "filter" else label]
        off = np.hypot(*(path - log.truth)[:2])
        right.semilogy(
            minutes[shown], off[shown], color=look["color"], ls=look["ls"], lw=1.2, label=label
        )
    right.set(
        title="how far off", xlabel="time [min]", ylabel="position error [m]", ylim=(3e-3, 80)
    )
    right.plot([], [], color=plotting.TRUTH, label="truth (left)")
    right.legend(loc="upper left", ncols=3, fontsize=9)
    figure.savefig(picture)


if __name__ == "__main__":
    main(*sys.argv[1:])
