"""Pack excerpts of the logs into pfkit, for what must run in a page, where there is no data/.

    python tools/make_excerpts.py

* ``pfkit/explore/mower.json``: Plaza 2, one column for each range, in whole numbers.
* ``pfkit/labs/real_robot_stretch.json``: ten seconds of the MRCLAM twin, odometry composed.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import pfkit as pf

ROOT = Path(__file__).resolve().parents[1]
MOWER = ROOT / "pfkit" / "explore" / "mower.json"
STRETCH = ROOT / "pfkit" / "labs" / "real_robot_stretch.json"


def pack_mower(log: pf.Log) -> dict:
    """Times, motions, ranges and truths at the instants of the ranges."""
    steps = np.flatnonzero([zk.shape[1] for zk in log.z])
    v, omega, dt = log.u
    ends = np.append(0, steps + 1)
    way, turn = (np.append(0, np.cumsum(row * dt))[ends] for row in (v, omega))
    r, s = np.hstack([log.z[k] for k in steps])
    order = [int(i) for i in log.world.ids]
    third = log[: int(np.searchsorted(log.t, log.t[-1] / 3))]
    bias = pf.calibrate(third).range_bias
    columns = {
        "t [ms]": np.diff(log.t[steps] * 1e3, prepend=0),
        "driven [mm]": np.diff(way) * 1e3,
        "turned [0.1 mrad]": np.diff(turn) * 1e4,
        "beacon": [order.index(int(i)) for i in s],
        "range [cm]": r * 100,
        "x [cm]": log.truth[0, steps] * 100,
        "y [cm]": log.truth[1, steps] * 100,
        "theta [mrad]": log.truth[2, steps] * 1e3,
    }
    return {
        "source": "Plaza 2, see data/README.md; made by tools/make_excerpts.py",
        "start": np.round(log.start, 4).tolist(),
        "beacons [m]": np.round(log.world.positions, 2).tolist(),
        "bias [m]": np.round(np.asarray(bias), 2).tolist(),
        **{name: np.round(values).astype(int).tolist() for name, values in columns.items()},
    }


def pack_stretch(log: pf.Log) -> dict:
    """Ten seconds in which a global start is hard: 39 pictures."""
    i, j = np.searchsorted(log.t, (60.0, 70.0))
    short = pf.preintegrate(log[i:j], pf.Drift((0.02, 0, 0), (0.05, 0.05, 0.001)))
    return {
        "source": "seconds 60 to 70 of data/mrclam_twin; made by tools/make_excerpts.py",
        "t": short.t.round(3).tolist(),
        "u": short.u.round(9).tolist(),
        "z": [zk.round(4).tolist() for zk in short.z],
        "truth": short.truth.round(4).tolist(),
        "ids": short.world.ids.tolist(),
        "landmarks": short.world.positions.tolist(),
        "bounds": list(short.world.bounds),
    }


def write(path: Path, packed: dict) -> None:
    text = json.dumps(packed, separators=(",", ":"))
    path.write_text(text.replace(',"', ',\n"') + "\n", encoding="ascii", newline="\n")
    print(f"{path.name}: {path.stat().st_size} bytes")


def main() -> None:
    write(MOWER, pack_mower(pf.load_plaza(ROOT / "data" / "plaza2")))
    write(STRETCH, pack_stretch(pf.load_mrclam(ROOT / "data" / "mrclam_twin")))


if __name__ == "__main__":
    main()
