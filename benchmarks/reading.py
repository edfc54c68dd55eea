"""How fast is a log read, and what do the checks cost?

    python benchmarks/reading.py [FOLDER]      # default: the twin; best: the full MRCLAM log

Reads the whole log with every check, and its odometry alone with `numpy.loadtxt`, which checks
little, interleaved. The program ends with an error if the whole log takes more than eight
times as long as the odometry alone.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

import pfkit as pf
from pfkit.logs.datasets import find_folder

MOST, ROUNDS = 8.0, 9


def main(folder: str = "mrclam_twin") -> int:
    where: Path = find_folder(folder)
    odometry = next(where.glob("*_Odometry.dat"))
    whole, alone = [], []
    for _ in range(ROUNDS):
        began = time.process_time()
        log = pf.load_mrclam(where)
        middle = time.process_time()
        np.loadtxt(odometry)
        whole.append(middle - began)
        alone.append(time.process_time() - middle)
    seconds, base = min(whole), min(alone)
    print(f"{log}: {seconds:.3f} s, {seconds / base:.1f} times loadtxt of the odometry alone")
    return int(seconds > MOST * base)


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:2]))
