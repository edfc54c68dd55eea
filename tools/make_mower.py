"""Pack Plaza 2 into the small file that the explorable `mower` runs on.

    python tools/make_mower.py

One column for each range: whole numbers, so that the file is small and the same everywhere.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

import pfkit as pf

ROOT = Path(__file__).resolve().parents[1]
TARGET = ROOT / "pfkit" / "explore" / "mower.json"


def pack(log: pf.Log) -> dict:
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
        "source": "Plaza 2, see data/README.md; made by tools/make_mower.py",
        "start": np.round(log.start, 4).tolist(),
        "beacons [m]": np.round(log.world.positions, 2).tolist(),
        "bias [m]": np.round(np.asarray(bias), 2).tolist(),
        **{name: np.round(values).astype(int).tolist() for name, values in columns.items()},
    }


def main() -> None:
    text = json.dumps(pack(pf.load_plaza(ROOT / "data" / "plaza2")), separators=(",", ":"))
    TARGET.write_text(text.replace(',"', ',\n"') + "\n", encoding="ascii", newline="\n")
    print(f"{TARGET.name}: {TARGET.stat().st_size} bytes")


if __name__ == "__main__":
    main()
