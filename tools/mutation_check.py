"""Mutation check: break one line of pfkit at a time and see which test notices.

    python tools/mutation_check.py [--list] [NAME ...]

Each of the mutations below changes a sign, a wrap, a normalisation or an off-by-one in a copy of
the package; the tests named beside it then run against the copy and must fail. A mutation that
survives means that nobody would notice the mistake: the command then exits with 1. The working
tree is never touched.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[1]


class Mutation(NamedTuple):
    """One wrong line: `old` becomes `new` in pfkit.`module`; `tests` should notice."""

    name: str
    module: str
    old: str
    new: str
    tests: str


MUTATIONS = [
    Mutation(
        "wrap-half-open",
        "geometry",
        "np.ceil(angle / TWO_PI - 0.5)",
        "np.floor(angle / TWO_PI + 0.5)",
        "test_geometry",
    ),
    Mutation(
        "compose-sign", "geometry", "x + c * dx - s * dy", "x + c * dx + s * dy", "test_geometry"
    ),
    Mutation(
        "normalise-sum",
        "particles.particle_set",
        "return shifted - log_sum, (peak + log_sum)",
        "return shifted, (peak + log_sum)",
        "particles/test_particle_set",
    ),
    Mutation(
        "ess-square",
        "particles.particle_set",
        "return total * total / squares",
        "return total / np.sqrt(squares)",
        "particles/test_particle_set",
    ),
    Mutation(
        "comb-off-by-one",
        "particles.resampling",
        "np.ceil(edges - u)",
        "np.floor(edges - u)",
        "particles/test_resampling",
    ),
    Mutation(
        "ticks-off-by-one",
        "particles.ticks",
        "edges += ticks - 1 - tooth",
        "edges += 2 * ticks - 1 - tooth",
        "particles/test_resampling",
    ),
    Mutation(
        "residual-fraction",
        "particles.resampling",
        "rest = np.maximum(expected - copies, 0.0)",
        "rest = np.maximum(w / edges[-1] - copies / w.size**2, 0.0)",
        "particles/test_resampling",
    ),
    Mutation(
        "arc-direction",
        "models.motion",
        "direction = theta + half",
        "direction = theta + turn",
        "models/test_motion",
    ),
    Mutation(
        "bearing-heading",
        "models.landmark_sensors",
        "bearing_error = _wrap(phi - self.bias_phi - np.arctan2(dy, dx) + theta)",
        "bearing_error = _wrap(phi - self.bias_phi - np.arctan2(dy, dx) - theta)",
        "models/test_landmark_sensors filters/test_particle_filter",
    ),
    Mutation(
        "bearing-wrap",
        "models.landmark_sensors",
        "bearing_error = _wrap(phi - self.bias_phi - np.arctan2(dy, dx) + theta)",
        "bearing_error = phi - self.bias_phi - np.arctan2(dy, dx) + theta",
        "models/test_landmark_sensors filters/test_particle_filter",
    ),
    Mutation(
        "gaussian-constant",
        "densities",
        "log_p -= math.log(sigma * math.sqrt(2 * math.pi))",
        "log_p -= math.log(sigma)",
        "models/test_sensors filters/test_particle_filter",
    ),
    Mutation(
        "update-forgets-weights",
        "filters.particle_filter",
        "normalise(bel.log_w + log_likelihood)",
        "normalise(log_likelihood)",
        "filters/test_particle_filter",
    ),
    Mutation(
        "resample-without-measurement",
        "filters.particle_filter",
        "if how_many(z) > 0:",
        "if how_many(z) >= 0:",
        "particles/test_triggers filters/test_particle_filter",
    ),
    Mutation(
        "heading-mean",
        "particles.estimators",
        "mean[2] = direction(_average(np.sin(theta), w), _average(np.cos(theta), w))",
        "mean[2] = _average(theta, w)",
        "particles/test_estimators filters/test_particle_filter",
    ),
    Mutation(
        "covariance-wrap",
        "particles.estimators",
        "difference[2] = wrap(difference[2])",
        "difference[2] = difference[2]",
        "particles/test_estimators",
    ),
]


def source_of(mutation: Mutation, folder: Path) -> Path:
    """The file in a copy of the repository that holds the mutation's module."""
    return folder / "pfkit" / Path(*mutation.module.split(".")).with_suffix(".py")


def killer(mutation: Mutation, folder: Path) -> str | None:
    """The first test that fails when the copy in `folder` has this mistake, or None."""
    path = source_of(mutation, folder)
    source = path.read_text(encoding="utf-8")
    if source.count(mutation.old) != 1:
        raise SystemExit(
            f"{mutation.name}: the line {mutation.old!r} stands {source.count(mutation.old)} times "
            f"in {path.relative_to(folder)}; mend the table in {Path(__file__).name}"
        )
    path.write_text(source.replace(mutation.old, mutation.new), encoding="utf-8")
    try:
        tests = [f"tests/{name}.py" for name in mutation.tests.split()]
        run = subprocess.run(
            [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *tests],
            cwd=folder,
            env={**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"},
            capture_output=True,
            text=True,
        )
    finally:
        path.write_text(source, encoding="utf-8")
    found = re.search(r"^(?:FAILED|ERROR) (\S+)", run.stdout, re.M)
    return found[1] if found else None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", help="only these mutations")
    parser.add_argument("--list", action="store_true", help="print the mutations and stop")
    options = parser.parse_args()
    chosen = [m for m in MUTATIONS if not options.names or m.name in options.names]
    if options.list:
        print("\n".join(f"{m.name:28} pfkit.{m.module}: {m.old}  ->  {m.new}" for m in chosen))
        return 0
    alive = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for part in ("pfkit", "tests"):
            shutil.copytree(ROOT / part, folder / part)
        shutil.copy(ROOT / "pyproject.toml", folder)
        for mutation in chosen:
            test = killer(mutation, folder)
            print(f"{mutation.name:28} {'killed by ' + test if test else 'SURVIVED'}", flush=True)
            alive += [] if test else [mutation.name]
    return 1 if alive else 0


if __name__ == "__main__":
    sys.exit(main())
