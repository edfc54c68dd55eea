"""Systematic resampling (and its fellows): pfkit, `particles` 0.4 with numba, filterpy.

    .cache/benchmarks/bin/python benchmarks/resampling.py [--check]

Weights are those of a filter: likelihoods of one measurement, ESS near M / 2 or M / 10. Prints
microseconds and the time of each rival in units of pfkit's. ``--check`` fails if systematic
resampling by `particles` at M = 100,000 and ESS near M / 2 does not take 1.7 times as long.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from filterpy import monte_carlo
from measure import interleave, ratio  # first: it keeps NumPy to one thread
from particles import resampling as numba_resampling

import pfkit as pf

ROUNDS = {1_000: 200, 10_000: 100, 100_000: 40, 1_000_000: 7}


def weights(M: int, spread: float) -> np.ndarray:
    w = np.exp(-0.5 * (spread * np.random.default_rng(1).standard_normal(M)) ** 2)
    return w / w.sum()


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="fail if the target is missed")
    options = parser.parse_args()
    rng, level = np.random.default_rng(0), np.inf
    for spread in (2.3, 12.0):
        for M, rounds in ROUNDS.items():
            w = weights(M, spread)
            print(f"M {M:9,d}  ESS/M {1 / np.sum(w * w) / M:.2f}", end="")
            for name, scheme in pf.SCHEMES.items():
                tasks = {
                    "pfkit": lambda s=scheme, w=w: s(w, rng),
                    "particles": lambda n=name, w=w: getattr(numba_resampling, n)(w, w.size),
                }
                if name == "systematic" and M <= 10_000:
                    tasks["filterpy"] = lambda w=w: monte_carlo.systematic_resample(w)
                seconds = interleave(tasks, rounds)
                times = {k: ratio(v, seconds["pfkit"]) for k, v in seconds.items() if k != "pfkit"}
                micros = np.median(seconds["pfkit"]) * 1e6
                text = ", ".join(f"{k} {v:.2f} x" for k, v in times.items())
                print(f"  {name} {micros:.0f} us ({text})", end="")
                if (name, M, spread) == ("systematic", 100_000, 2.3):
                    level = times["particles"]
            print()
    print(f"systematic at 100,000, ESS near M / 2: particles takes {level:.2f} times as long")
    return int(options.check and level < 1.7)


if __name__ == "__main__":
    sys.exit(main())
