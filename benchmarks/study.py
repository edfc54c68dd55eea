"""A study of 200 runs of 200 particles and 40 steps: one batched call against a loop of runs.

    .cache/benchmarks/bin/python benchmarks/study.py [--check]

``--check`` fails unless the batch is at least 3 times faster. Both answer the same question: the
mean RMSE over the runs is printed with its standard error.
"""

from __future__ import annotations

import argparse
import sys

import numpy as np
from measure import interleave, ratio  # first: it keeps NumPy to one thread
from world import DT, OMEGA, SIGMA_OMEGA, SIGMA_PHI, SIGMA_R, SIGMA_V, START, START_SD, V, make_work

import pfkit as pf

RUNS, M, STEPS, TARGET = 200, 200, 40, 3.0
WORK = make_work(4, STEPS)
MOTION = pf.VelocityMotion((SIGMA_V**2 / V**2, 0.0, SIGMA_OMEGA**2 / V**2, 0.0))
SENSOR = pf.RangeBearing(pf.LandmarkMap(WORK.landmarks), SIGMA_R, SIGMA_PHI)
LOG = pf.Log(
    DT * np.arange(1, STEPS + 1),
    np.tile(np.array(((V,), (OMEGA,), (DT,))), STEPS),
    list(WORK.z),
    WORK.truth,
)


def errors(shape: int | tuple[int, int], seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    bel = pf.gaussian_prior(shape, START, START_SD, rng)
    return pf.rmse(pf.run(LOG, bel, MOTION, SENSOR, rng).estimate, LOG.truth)


def batched() -> np.ndarray:
    return errors((RUNS, M), 0)


def serial() -> np.ndarray:
    return np.array([errors(M, seed) for seed in range(RUNS)])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="fail if under 3 times faster")
    options = parser.parse_args()
    for name, run in (("batched", batched), ("serial", serial)):
        error = run()
        print(f"{name}: RMSE {error.mean():.4f} +- {error.std() / np.sqrt(RUNS):.4f} m")
    seconds = interleave({"batched": batched, "serial": serial}, 5)
    times = ratio(seconds["serial"], seconds["batched"])
    print(
        f"batched {np.median(seconds['batched']):.3f} s; the loop takes {times:.2f} times as long"
    )
    return int(options.check and times < TARGET)


if __name__ == "__main__":
    sys.exit(main())
