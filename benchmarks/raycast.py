"""Ray casting against a plain C traversal: 10,000 poses times 30 beams, one thread.

    python benchmarks/raycast.py            # prints the rates and their ratio
    python benchmarks/raycast.py --check    # and fails if a ratio is below 0.7

The C code is benchmarks/traversal.c, compiled with ``cc -O3``; it needs a C compiler. Both give
the same lengths, to 1e-9 m, or the benchmark stops. CPU time, interleaved, medians of 15.
"""

from __future__ import annotations

import argparse
import ctypes
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import pfkit as pf

TARGET = 0.7
HERE = Path(__file__).parent


def compile_traversal(folder: Path) -> ctypes.CDLL:
    """Compile the C traversal and declare its arguments."""
    library = folder / "traversal.so"
    source = str(HERE / "traversal.c")
    subprocess.run(["cc", "-O3", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
    c = ctypes.CDLL(str(library))
    table, cells = np.ctypeslib.ndpointer(float), np.ctypeslib.ndpointer(np.uint8)
    whole = ctypes.c_int64
    c.cast.argtypes = [cells, whole, whole, table, whole, table, whole, ctypes.c_double, table]
    c.cast.restype = None
    return c


def rooms(n: int, room: int, rng: np.random.Generator) -> pf.OccupancyGrid:
    """A square building of n x n cells: square rooms with doors, and furniture."""
    wall = np.zeros((n, n), dtype=bool)
    wall[::room] = wall[:, ::room] = True
    for j in range(0, n, room):
        for i in range(0, n, room):
            wall[j + room // 3 : j + room // 2, i] = wall[j, i + room // 3 : i + room // 2] = False
    for j, i in rng.integers(1, n - 6, (n * n // 1000, 2)):
        wall[j : j + rng.integers(1, 5), i : i + rng.integers(1, 5)] = True
    wall[0] = wall[-1] = wall[:, 0] = wall[:, -1] = True
    return pf.OccupancyGrid(wall, 0.05)


def compare(world: pf.OccupancyGrid, c: ctypes.CDLL, rng: np.random.Generator) -> float:
    """Print both rates on one map; return the ratio of NumPy's to C's."""
    M, K, r_max = 10_000, 30, 30.0
    pose, angles = world.sample_poses(M, rng), np.linspace(-np.pi, np.pi, K, endpoint=False)
    caster = pf.RayCaster(world)
    occupied = world.occupied.astype(np.uint8)
    in_cells = np.stack((*world.to_cells(pose[0], pose[1]), pose[2]))
    traversed = np.empty((K, M))
    seconds = []
    for _ in range(15):
        start = time.process_time()
        c.cast(occupied, *occupied.shape, in_cells, M, angles, K, r_max / 0.05, traversed)
        middle = time.process_time()
        lengths = caster.cast(pose, angles, r_max)
        seconds.append((middle - start, time.process_time() - middle))
    if np.abs(lengths - 0.05 * traversed).max() > 1e-9:
        raise SystemExit("the two disagree: one of them is wrong")
    for_c, for_numpy = np.median(seconds, axis=0)
    ratio = for_c / for_numpy
    print(
        f"{world}: mean length {lengths.mean():.2f} m; million rays/s: C {M * K / for_c / 1e6:.1f},"
        f" NumPy {M * K / for_numpy / 1e6:.1f}; ratio {ratio:.2f} (target {TARGET})"
    )
    return float(ratio)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="fail below the target")
    check = parser.parse_args().check
    rng = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        c = compile_traversal(Path(folder))
        ratios = [compare(rooms(400, room, rng), c, rng) for room in (50, 100)]
    return int(check and min(ratios) < TARGET)


if __name__ == "__main__":
    sys.exit(main())
