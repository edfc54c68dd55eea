"""How much faster is one prediction per measurement than one per row of odometry?

    python benchmarks/composed_odometry.py [FOLDER]      # default: the twin; best: a real log

Both run the same model on the same log, interleaved, three times; the ratio of the medians
counts, not the seconds. It cannot exceed the number of rows for each measurement; the program
ends with an error if it is below 5 or, on a log with few rows, below a third of that number.
"""

from __future__ import annotations

import statistics
import sys

import numpy as np

import pfkit as pf
from pfkit.judging.localise import localise
from pfkit.logs.odometry import informative_steps

ENOUGH, ROUNDS, MOST = 5.0, 3, 20_000


def main(folder: str = "mrclam_twin") -> int:
    log = pf.load_log(folder)[:MOST]
    rows = len(log) / len(informative_steps(log))
    seconds: dict[bool, list[float]] = {False: [], True: []}
    for seed in range(ROUNDS):
        for every_row in seconds:
            rng = np.random.default_rng(seed)
            track = localise(log, rng, M=1000, every_row=every_row)
            seconds[every_row].append(track.seconds)
    composed, single = (statistics.median(seconds[key]) for key in (False, True))
    ratio = single / composed
    print(f"{log}: {rows:.1f} steps for each measurement, 1,000 particles")
    print(f"every row   {len(log) / single:10,.0f} steps/s")
    print(f"composed    {len(log) / composed:10,.0f} steps/s   {ratio:.1f} times faster")
    wanted = min(ENOUGH, rows / 3)
    if ratio < wanted:
        print(f"less than {wanted:.1f} times faster: something became slow")
        return 1
    return 0


if __name__ == "__main__":
    raise SystemExit(main(*sys.argv[1:2]))
