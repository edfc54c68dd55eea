"""Interleaved CPU times: round after round, every contestant once, so that noise hits all."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Mapping

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before NumPy starts its threads

import numpy as np  # noqa: E402

# glibc keeps freed memory for the next call only up to the largest block it has seen freed. Without
# this block each call at 100,000 particles would fetch its pages from the system anew, which takes
# every contestant longer than the work that is to be measured.
np.empty(30_000_000, dtype=np.uint8)


def interleave(
    tasks: Mapping[str, Callable[[], object]], rounds: int, repeats: int = 1
) -> dict[str, np.ndarray]:
    """CPU seconds of each task in each round, after one round of warming up."""
    seconds = {name: np.empty(rounds) for name in tasks}
    for k in range(-1, rounds):
        for name, task in tasks.items():
            begin = time.process_time_ns()
            for _ in range(repeats if k >= 0 else 1):
                task()
            if k >= 0:
                seconds[name][k] = (time.process_time_ns() - begin) * 1e-9 / repeats
    return seconds


def ratio(other: np.ndarray, ours: np.ndarray) -> float:
    """How many times longer the other takes: the median over rounds of the paired ratio."""
    return float(np.median(other / ours))
