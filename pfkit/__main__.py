"""``python -m pfkit localise FOLDER``: localise a recorded robot from the command line.

A log without ground truth is localised, too, from a global start; there is then nothing to score.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from pfkit.errors import ParameterError, PfkitError
from pfkit.judging.diagnostics import dead_reckoning
from pfkit.judging.localise import (
    Score,
    Track,
    calibrate_first,
    localise,
    score,
    scored_steps,
    settings_for,
)
from pfkit.judging.settings import rig_of
from pfkit.judging.study import Progress, silent
from pfkit.logs.calibration import Calibration
from pfkit.logs.datasets import LAYOUTS, load_log
from pfkit.logs.datasets.describe import describe
from pfkit.logs.odometry import Drift
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.rig import SENSORS, Rig

POSE_SD = 0.1  # radians: how well somebody knows the heading of a pose that he types


class OneLineParser(argparse.ArgumentParser):
    """Argument errors in one line, exit code 2."""

    def error(self, message: str) -> NoReturn:
        print(f"{self.prog}: {message}", file=sys.stderr)
        raise SystemExit(2)


def parser() -> argparse.ArgumentParser:
    """The command's arguments."""
    top = OneLineParser(prog="python -m pfkit", description="Particle filters for robots.")
    commands = top.add_subparsers(dest="command", required=True)
    _add_localise(commands)
    draft = commands.add_parser(
        "describe",
        help="draft a description of a folder of tables",
        description="Look at the tables of a folder and write log.yaml, a first guess at what "
        "they hold. Read it before you use it.",
    )
    draft.add_argument("folder", type=Path)
    return top


def _add_localise(commands: Any) -> None:
    say = commands.add_parser(
        "localise",
        help="localise a recorded robot and score the answer",
        description="Localise a recorded robot. Layouts that are known: " + ", ".join(LAYOUTS),
    )
    say.add_argument("folder", help="the log's folder, or its name in PFKIT_DATA or data/")
    say.add_argument("--start", choices=("known", "global"), default=None, help="default: known")
    say.add_argument("--pose", metavar="X,Y,THETA", help="start there, metres and radians")
    say.add_argument("--particles", type=int, metavar="N", help="default: by kind of log and start")
    say.add_argument("--seed", type=int, default=0, metavar="S")
    say.add_argument(
        "--calibrate",
        type=float,
        metavar="SECONDS",
        help="fit odometry, sensor and noise to the truth of the first SECONDS; "
        "default: a third of a range-only log, whose biases hide the robot, else 0 (off)",
    )
    say.add_argument("--sigma", metavar="R[,PHI]", help="noise of the sensor, metres and radians")
    say.add_argument(
        "--drift", metavar="D,TURN", help="noise of the odometry after a metre, metres and radians"
    )
    say.add_argument("--bounds", metavar="X0,X1,Y0,Y1", help="where the robot can be, metres")
    say.add_argument(
        "--mount",
        metavar="X,Y,YAW[,flipped]",
        help="where the sensor sits on the robot, metres and radians; flipped: upside down",
    )
    say.add_argument("--recover", action="store_true", help="look elsewhere when the log surprises")
    say.add_argument("--sensor", choices=tuple(SENSORS), help="where the log does not say")
    say.add_argument("--unnamed", action="store_true", help="landmarks carry no names, use none")
    say.add_argument("--map", type=Path, metavar="YAML", help="the map, if it lies elsewhere")
    for stream in ("odometry", "scan", "truth"):
        say.add_argument(f"--{stream}", metavar="TOPIC", help=f"of a bag, for the {stream}")
    say.add_argument("--out", type=Path, default=Path(), metavar="DIR", help="default: here")
    say.add_argument("--robot", type=int, metavar="N", help="which, if the folder holds several")
    say.add_argument("--drop-unknown", action="store_true", help="drop unlisted landmarks")


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit code: 0, or 2 after one line about bad input."""
    args = parser().parse_args(argv)
    try:
        if args.command == "describe":
            print(describe(args.folder))
        else:
            run(args)
    except (PfkitError, OSError) as error:
        print(f"pfkit: {' '.join(str(error).split())}", file=sys.stderr)
        return 2
    except MemoryError:
        print("pfkit: not enough memory for so many --particles; take fewer", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("\npfkit: interrupted", file=sys.stderr)
        return 130
    return 0


def run(args: argparse.Namespace) -> None:
    """Load, calibrate, filter, score, write."""
    if args.seed < 0:
        raise ParameterError(f"--seed must be >= 0, got {args.seed}")
    if args.start and args.pose:
        raise ParameterError(f"--start {args.start} and --pose {args.pose}: give one of them")
    start: Any = _numbers("--pose", args.pose, 3) if args.pose else args.start or "known"
    need_truth = start == "known" if isinstance(start, str) else False
    log = load_log(
        args.folder,
        args.robot,
        args.drop_unknown,
        need_truth or bool(args.calibrate),
        map=args.map,
        odometry=args.odometry,
        scan=args.scan,
        truth=args.truth,
    )
    log = _as_told(log, args)
    print(log)
    for note in log.notes:
        print(f"note: {note}")
    _require_writable(args.out)
    calibration = _calibration(log, args.calibrate)
    sigma = None if args.sigma is None else _numbers("--sigma", args.sigma, 1, 2)
    settings = settings_for(log, calibration, sigma, _drift(args.drift))
    if args.pose:
        near = max(settings.start_sd[0], settings.limit / 5)
        settings = replace(settings, start_sd=(near, near, POSE_SD))
    corrected = log if calibration is None else calibration.apply(log)
    rng = np.random.default_rng(args.seed)
    track = localise(
        corrected,
        rng,
        start,
        args.particles,
        settings=settings,
        progress=_progress(),
        recover=args.recover,
    )
    write_track(args.out / "track.csv", log, track)
    _report(log, track, settings.limit, track.first if start == "global" else -np.inf)
    _write_hypotheses(args.out / "hypotheses.csv", track)
    print(f"wrote {args.out / 'track.csv'}")
    _draw(args.out / "track.png", log, track.estimate[..., 0])


def _numbers(option: str, text: str, *counts: int) -> list[float]:
    """The numbers of an option, as many as it takes."""
    words = text.split(",")
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = []
    if len(values) not in counts or not np.isfinite(values).all():
        count = " or ".join(map(str, counts))
        raise ParameterError(f"{option} takes {count} numbers with commas between, got {text!r}")
    return values


def _drift(text: str | None) -> Drift | None:
    """Standard deviations after a metre as rates of a variance; a radian turns like a metre."""
    if text is None:
        return None
    drive, turn = _numbers("--drift", text, 2)
    return Drift((drive**2, 0.0, 0.0), (turn**2, turn**2, turn**2 / 50))


def _as_told(log: Log, args: argparse.Namespace) -> Log:
    """The log with what the options say of its rig and its bounds."""
    rig = log.rig
    if args.sensor and (rig is None or rig.sensor != args.sensor):
        if rig is not None:
            raise ParameterError(f"--sensor {args.sensor}: the log says it is a {rig.sensor}")
        rig = Rig(args.sensor)
    if args.unnamed and rig is not None and rig.named:
        log = replace(log, rig=None, z=[zk[:-1] for zk in log.z])
        rig = replace(rig, named=False)
    if args.mount and rig is not None:
        mount, _, word = args.mount.partition(",flipped")
        if word:
            raise ParameterError(f"--mount ends with ,flipped or with the yaw, got {args.mount!r}")
        x, y, yaw = _numbers("--mount", mount, 3)
        rig = replace(rig, mount=(x, y, yaw), flipped=mount != args.mount)
    world = log.world
    if args.bounds:
        if not isinstance(world, LandmarkMap):
            raise ParameterError("--bounds is for maps of landmarks; a grid has its own")
        x0, x1, y0, y1 = _numbers("--bounds", args.bounds, 4)
        world = LandmarkMap(world.positions, world.ids, (x0, x1, y0, y1))
    return replace(log, rig=rig, world=world)


def _require_writable(folder: Path) -> None:
    """Make the output folder and try it, before anybody waits for a result."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise ParameterError(
            f"--out: cannot write into {folder} ({error.strerror}); name another folder"
        ) from None


def _calibration(log: Log, seconds: float | None) -> Calibration | None:
    """Calibrate on the first seconds; if they are not given, only ranges whose truth is known."""
    if seconds is None:
        ranges_only = rig_of(log).sensor == "range"
        seconds = (log.t[-1] - log.t[0]) / 3 if ranges_only and log.truth is not None else 0.0
    if seconds == 0:
        return None
    calibration = calibrate_first(log, seconds)
    print(f"calibrated on the first {min(seconds, log.t[-1]):.0f} s: {calibration}")
    return calibration


def _progress() -> Progress:
    """A bar on standard error in a terminal, if `tqdm` is installed; NumPy alone has none."""
    if find_spec("tqdm") is None:
        return silent
    from tqdm import tqdm

    return partial(tqdm, desc="filtering", unit=" steps", disable=None)


def _report(log: Log, track: Track, limit: float, since: float) -> None:
    """Print the table of errors, if there is a truth, what else may be, and how fast it was."""
    if scored_steps(log, since).any():
        _print_errors(log, track, limit, since)
    else:
        print("no ground truth: the errors are unknown; the sd in track.csv is the filter's own")
    print(f"{len(log) / track.seconds:,.0f} steps/s ({len(log):,} steps in {track.seconds:.2f} s)")


def _print_errors(log: Log, track: Track, limit: float, since: float) -> None:
    print(f"{'':16}{'RMSE [m]':>10}{'median':>9}{'95 %':>9}{'heading RMSE [deg]':>20}")
    if log.start is not None:
        _row("dead reckoning", score(log, dead_reckoning(log), limit, since))
    own = score(log, track.estimate[..., 0], limit, since)
    _row("filter", own)
    if np.isfinite(since):
        print(f"errors from the first measurement on, at {track.first:.1f} s")
    when = f"{own.converged:.1f} s" if np.isfinite(own.converged) else "never"
    print(f"error below {limit:g} m for good from: {when}")


def _write_hypotheses(path: Path, track: Track) -> None:
    """Print the hypotheses that are left at the end, and write all that there were."""
    t, mass, mean = track.hypotheses
    if not t.size:
        return
    table = np.vstack((t, mass, mean)).T
    np.savetxt(path, table, "%.4f", ",", header="t,mass,x,y,theta", comments="", encoding="ascii")
    print(f"wrote {path}: {np.unique(t).size} instants with more than one hypothesis")
    for m, (x, y, theta) in zip(mass[t == t[-1]], mean[:, t == t[-1]].T, strict=True):
        print(f"  at {t[-1]:.1f} s: {m:4.0%} at ({x:.2f}, {y:.2f}) m, {np.degrees(theta):.0f} deg")


def _row(name: str, s: Score) -> None:
    heading = f"{np.degrees(s.heading_rmse):.2f}" if np.isfinite(s.heading_rmse) else "unknown"
    print(f"{name:16}{s.rmse:10.3f}{s.median:9.3f}{s.p95:9.3f}{heading:>20}")


def write_track(path: Path, log: Log, track: Track) -> None:
    """Write t, x, y, theta, sd at every odometry stamp (seconds since the start, m, rad, m)."""
    kept = slice(None) if log.scored is None else log.scored
    table = np.vstack((log.t, track.estimate[..., 0], track.sd[:, 0]))[:, kept]
    np.savetxt(path, table.T, "%.4f", ",", header="t,x,y,theta,sd", comments="", encoding="ascii")


def draw_track(ax: Any, log: Log, estimate: Any) -> None:
    """Draw landmarks, truth, dead reckoning and the filter's track into matplotlib axes."""
    from pfkit.plotting import draw_path, draw_world

    draw_world(ax, log.world)
    if log.truth is not None:
        draw_path(ax, log.truth, "truth")
        window = ax.axis()
        if log.start is not None:
            draw_path(ax, dead_reckoning(log), "dead reckoning", lw=0.8)
        ax.axis(window)  # dead reckoning may leave the picture: that is its message
    draw_path(ax, estimate, "estimate", lw=1.0, label="filter")
    ax.set(xlabel="x [m]", ylabel="y [m]", title=log.source, aspect="equal")
    ax.legend(loc="upper right", frameon=True)


def _draw(path: Path, log: Log, estimate: Any) -> None:
    try:
        import matplotlib
    except ImportError:
        print(f"{path.name} was not drawn: pip install 'pfkit[plotting]'", file=sys.stderr)
        return
    matplotlib.use("Agg")
    from matplotlib.figure import Figure

    figure = Figure(figsize=(6, 6), dpi=100, layout="constrained")
    draw_track(figure.subplots(), log, estimate)
    figure.savefig(path)
    print(f"wrote {path}")


if __name__ == "__main__":
    raise SystemExit(main())
