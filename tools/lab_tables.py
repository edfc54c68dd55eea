"""Long runs for lab 4: the full film, 1,000 particles, ten seeds. Writes long_runs.json of lab 4.

    python tools/lab_tables.py        about two minutes

The checks of the lab use shorter films, so that they answer in two seconds. These tables show that
the long film says the same, and how large the spread over seeds is.
"""

import json
from pathlib import Path

import numpy as np

import pfkit as pf
from pfkit.labs.lab4.given import circle as CIRCLE
from pfkit.labs.lab4.given import model_of, start_of
from pfkit.labs.lab4.modelled_noise import linear_errors
from pfkit.labs.target import AREA, anywhere, around, target_log, track

SEEDS, M = 10, 1000
FILM, FALSE = target_log("fixed", "low"), target_log("fixed", "outliers")
HOME = FILM.start[:2]
SWEEP = (1e-4, 1e-2, 1.0, 100.0, 1e4)
SIGMA = {"fixed": 6.0, "line": 1.0, "circle": 0.5}  # px per frame, as in the text of Q12
TARGET = Path(__file__).parent.parent / "pfkit" / "labs" / "long_runs.py"


def sensor(variance: float, rng: np.random.Generator) -> dict[str, np.ndarray]:
    bel = anywhere((SEEDS, M), rng)
    found = track(FILM, bel, pf.FixedTarget(2**0.5), pf.Position(variance**0.5), rng)
    linear = linear_errors(anywhere((SEEDS, M), rng), variance, rng, len(FILM))
    return {"mean error, px": found.error.mean(axis=0), "linear weights": linear.mean(axis=0)}


def motion(variance: float, rng: np.random.Generator) -> dict[str, np.ndarray]:
    bel = anywhere((SEEDS, M), rng)
    error = track(FILM, bel, pf.FixedTarget(variance**0.5), pf.Position(5.0), rng).error
    return {"mean error, px": error.mean(axis=0), "median error, px": np.median(error, axis=0)}


def needed(model: str, rng: np.random.Generator) -> dict[str, np.ndarray]:
    """Particles from which on the error is within a tenth of that with the largest number."""
    errors = []
    for size in SIZES:
        bel = start_of(model, CIRCLE, (SEEDS, size), rng)
        noise = model_of(model, SIGMA[model], 0.01 if model == "circle" else 0.05)
        run = track(CIRCLE, bel, noise, pf.Position(20.0), rng)
        errors.append(run.error[50:].mean(axis=0))
    near = np.array(errors) <= 1.1 * errors[-1]
    first = np.logical_and.accumulate(near[::-1])[::-1].argmax(axis=0)
    return {
        "error with 20 particles, px": errors[SIZES.index(20)],
        f"with {SIZES[-1]}": errors[-1],
        "particles to come within a tenth of that": np.array(SIZES)[first],
    }


def gated(variance: float, rng: np.random.Generator) -> dict[str, np.ndarray]:
    out = {}
    for name, bel in (
        ("rejected of 688, known start", around(HOME, (SEEDS, M), rng)),
        ("rejected of 688, from anywhere", anywhere((SEEDS, M), rng)),
    ):
        run = track(FILM, bel, pf.FixedTarget(2**0.5), pf.Position(variance**0.5), rng, gate=1e-4)
        out[name] = run.rejected.sum(axis=0)
    return out


def outliers(which: str, rng: np.random.Generator) -> dict[str, np.ndarray]:
    model, honest = pf.FixedTarget(2**0.5), pf.Position(5.0)
    mixed = pf.OutlierMixture(honest, 0.5, 1 / AREA)
    known = which.endswith("known start")
    bel = around(HOME, (SEEDS, M), rng) if known else anywhere((SEEDS, M), rng)
    film_sensor = mixed if which.startswith("mixture") else honest
    gate = 1e-4 if which.startswith("gate") else 0.0
    run = track(FALSE, bel, model, film_sensor, rng, gate=gate)
    out = {"median error, px": np.median(run.error, axis=0)}
    return out | ({"rejected of 688": run.rejected.sum(axis=0)} if gate else {})


SIZES = (10, 20, 40, 80, 160, 320, 640, 1280)
STARTS = ("naive, anywhere", "mixture, anywhere", "gate, known start", "gate, anywhere")
TABLES = {
    "q9": ("modelled sensor variance, px^2", SWEEP, sensor),
    "q10": ("modelled process variance, px^2", SWEEP, motion),
    "q12": ("motion model on the circling target", ("fixed", "line", "circle"), needed),
    "q15": ("modelled sensor variance, px^2", (1e-4, 0.01, 1, 10, 100, 1000, 2000, 1e4), gated),
    "q16": ("filter, start", STARTS, outliers),
}


def main() -> None:
    rows = {}
    for name, (what, values, measure) in TABLES.items():
        table = []
        for value in values:
            found = measure(value, np.random.default_rng(1))
            cells = {
                k: [round(float(np.median(v)), 3), round(float(np.std(v)), 3)]
                for k, v in found.items()
            }
            table.append((value, cells))
            print(name, value, cells, flush=True)
        rows[name] = {"what": what, "rows": table}
    TARGET.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
