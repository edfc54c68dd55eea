"""The whole filter: pfkit against four libraries and a C bound, in nine cells of M and L.

    .cache/benchmarks/bin/python benchmarks/filters.py [--quick] [--check]

Prints microseconds per step, the time of each rival in units of pfkit's, and the share of the
C bound. ``--check`` fails unless pfkit is level with `particles` (ratio above 1 in the median of
the cells, none under 0.85) and all filters reach the same error. Ratios are medians of paired
rounds; absolute times are of this machine and are never asserted.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from contestants import CONTESTANTS
from measure import interleave, ratio  # first: it keeps NumPy to one thread
from world import make_work, position_rmse

MEDIAN_TARGET, WORST_TARGET = 1.0, 0.85
STEPS = {1_000: 40, 10_000: 20, 100_000: 8}
SLOW = {"stone soup": 1_000, "filterpy": 1_000, "PythonRobotics": 1_000}  # --quick stops here


def same_error(L: int, M: int, names: list[str]) -> bool:
    """Whether every filter follows the robot equally well (RMSE over 3 drives of 40 steps)."""
    works = [make_work(L, 40, seed) for seed in range(3)]
    errors = {
        name: np.mean([position_rmse(CONTESTANTS[name](w, M, 1), w) for w in works])
        for name in names
    }
    print("RMSE in m:", ", ".join(f"{name} {error:.3f}" for name, error in errors.items()))
    middle = np.median(list(errors.values()))
    return all(abs(error / middle - 1) < 0.15 for error in errors.values())


def cell(M: int, L: int, names: list[str], rounds: int) -> float:
    """Measure and print one cell; return the ratio of `particles` to pfkit."""
    work = make_work(L, STEPS[M])
    tasks = {name: (lambda f=CONTESTANTS[name]: f(work, M)) for name in names}
    seconds = interleave(tasks, rounds)
    ours = seconds["pfkit"]
    micros = np.median(ours) / STEPS[M] * 1e6
    others = [f"{n} {ratio(seconds[n], ours):6.2f} x" for n in names if n not in ("pfkit", "C")]
    share = f"{100 * ratio(seconds['C'], ours):4.1f} % of C" if "C" in names else ""
    print(f"M {M:7,d}  L {L:2d}  pfkit {micros:9.0f} us/step  {'  '.join(others)}  {share}")
    return ratio(seconds["particles"], ours)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="particles and C only, fewer rounds")
    parser.add_argument("--check", action="store_true", help="fail if a target is missed")
    options = parser.parse_args()
    names = ["pfkit", "particles", "C"] if options.quick else list(CONTESTANTS)
    level = same_error(4, 1_000, names)
    ratios = []
    for M in STEPS:
        for L in (1, 4, 15):
            few = [n for n in names if not (n == "PythonRobotics" and M > 1_000)]
            rounds = {1_000: 15, 10_000: 9, 100_000: 5}[M]
            if len(few) > 3:  # the slow ones need no many rounds: their ratios are far from 1
                few_rounds = [n for n in few if n in SLOW]
                if M > 1_000:
                    few = [n for n in few if n not in few_rounds]
                    cell(M, L, ["pfkit", "particles", *few_rounds], 1)
            ratios.append(cell(M, L, few, rounds))
    print(f"particles / pfkit: median {np.median(ratios):.2f}, worst {min(ratios):.2f}")
    passed = level and np.median(ratios) > MEDIAN_TARGET and min(ratios) >= WORST_TARGET
    print("targets met" if passed else "targets MISSED")
    return 0 if passed or not options.check else 1


if __name__ == "__main__":
    sys.exit(main())
