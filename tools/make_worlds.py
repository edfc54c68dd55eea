"""Make the simulated worlds that the labs share: a map and a drive each, as small text tables.

    python tools/make_worlds.py                    # writes data/worlds/
    python tools/make_worlds.py elsewhere square   # into that folder, only some

All are ours: the places follow the sources, the noise is drawn here from a fixed seed. Known
ids are in the last row of z; leave it out and the landmarks have no names. `pf.read_log` reads
a folder back.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np

import pfkit as pf
from pfkit import worlds
from pfkit.labs.target import target_log

HERE = Path(__file__).resolve().parents[1] / "data" / "worlds"
DIGITS = 6  # micrometres in a world of metres
MOTION = pf.VelocityMotion((0.01, 0.005, 0.005, 0.01))


def landmarks(
    name: str,
    world: pf.LandmarkMap,
    start: np.ndarray,
    u: np.ndarray | pf.PurePursuit,
    steps: int | None,
    r_max: float = np.inf,
    sensor: type = pf.RangeBearing,
    sigmas: tuple[float, ...] = (0.2, 0.05),
    motion: pf.MotionModel = MOTION,
) -> pf.Log:
    """Drive among landmarks that are seen from within r_max."""
    return pf.simulate_log(
        start,
        u,
        motion,
        sensor(world, *sigmas),
        np.random.default_rng(list(name.encode())),
        steps=steps,
        sight=pf.FieldOfView(world, r_max),
        source=f"{name}: simulated by tools/make_worlds.py",
    )


def arena() -> pf.Log:
    return landmarks("arena", worlds.arena(), worlds.ARENA_START, worlds.arena_route(2), None)


def square() -> pf.Log:
    driver = pf.PurePursuit(worlds.SQUARE_ROUTE, v=1.0, dt=0.5)
    return landmarks("square", worlds.square(), worlds.SQUARE_START, driver, 240)


def broken_square() -> pf.Log:
    driver = pf.PurePursuit(worlds.BROKEN_SQUARE_ROUTE, v=1.0, dt=0.5, closed=False)
    world, start = worlds.broken_square(), worlds.BROKEN_SQUARE_START
    return landmarks("broken_square", world, start, driver, 116, r_max=6.0)


def pentagon(L: int) -> pf.Log:
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    driver = pf.PurePursuit(7.0 * np.stack((np.cos(angle), np.sin(angle))), v=1.0, dt=0.5)
    start = np.array([7.0, 0.0, np.pi / 2])
    return landmarks(f"pentagon_{L}", worlds.pentagon(L), start, driver, 100, r_max=5.0)


def six_beacons() -> pf.Log:
    """Twenty-five strides of sqrt 2 m; range sd 3 m, motion sd 1 m per stride and 0.1 rad."""
    u = np.tile(np.array([[np.sqrt(2.0)], [0.0], [1.0]]), 25)
    start, motion = worlds.SIX_BEACONS_START, pf.VelocityMotion((0.125, 0.0, 0.005, 0.0))
    return landmarks(
        "six_beacons",
        worlds.six_beacons(),
        start,
        u,
        None,
        sensor=pf.Range,
        sigmas=(3.0,),
        motion=motion,
    )


def one_landmark() -> pf.Log:
    """Two rounds; noise sd 0.1 m/s and 0.15 rad/s, ranges 0.05 m, bearings 0.075 rad."""
    v, _, dt = worlds.circle_route()[:, 0]
    angle = np.linspace(0, 2 * np.pi, 36, endpoint=False)
    circle = 10.0 + 5.0 * np.stack((np.cos(angle), np.sin(angle)))
    return landmarks(
        "one_landmark",
        worlds.one_landmark(),
        worlds.CIRCLE_START,
        pf.PurePursuit(circle, v, dt, lookahead=1.0),
        252,
        sigmas=(0.05, 0.075),
        motion=pf.VelocityMotion(((0.1 / v) ** 2, 0.0, (0.15 / v) ** 2, 0.0)),
    )


def office() -> pf.Log:
    """A laser of 24 beams; 5 cm noise, and one beam in twenty is false, with a label."""
    angles = np.linspace(-np.pi, np.pi, 24, endpoint=False) + np.pi / 24
    return pf.simulate_log(
        worlds.OFFICE_START,
        pf.PurePursuit(worlds.OFFICE_ROUTE, v=0.5, dt=0.2),
        pf.VelocityMotion((0.005, 0.001, 0.001, 0.01)),
        pf.BeamModel(worlds.office(), angles, 8.0, 0.05, z_hit=1, z_short=0, z_max=0, z_rand=0),
        np.random.default_rng(list(b"office")),
        steps=240,
        every=2,
        outliers=pf.Outliers(0.05, (0.0,), (8.0,)),
        source="office: simulated by tools/make_worlds.py",
    )


WORLDS: dict[str, Callable[[], pf.Log]] = {
    "arena": arena,
    "square": square,
    "broken_square": broken_square,
    "pentagon_10": lambda: pentagon(10),
    "pentagon_40": lambda: pentagon(40),
    "six_beacons": six_beacons,
    "one_landmark": one_landmark,
    "office": office,
    **{
        f"target_{path}_{noise}": lambda path=path, noise=noise: target_log(path, noise)
        for path in ("fixed", "line", "circle")
        for noise in ("low", "high", "outliers")
    },
}


def main() -> None:
    """Write the named worlds, or all."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, default=HERE)
    parser.add_argument("names", nargs="*", choices=[[], *WORLDS], default=[])
    arguments = parser.parse_args()
    for name in arguments.names or WORLDS:
        log = WORLDS[name]()
        pf.save_log(log, arguments.folder / name, DIGITS)
        print(f"{name:24} {log!r}")


if __name__ == "__main__":
    main()
