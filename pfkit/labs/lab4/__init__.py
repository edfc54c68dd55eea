"""Lab 4: tuning and outliers.

Q9 to Q12 change what the filter believes about noise and motion; in Q13 to Q16 half of the
measurements are false. The notebook is ``notebooks/labs/lab4_tuning_outliers.ipynb``.
"""

import json
from importlib.resources import files

from pfkit.labs.lab import Lab
from pfkit.labs.lab4 import detection, gates, modelled_noise, motion_models, precision, undetected
from pfkit.labs.lab4.given import (
    AREA,
    anywhere,
    around,
    auc,
    circle,
    film,
    half_false,
    measurement_error,
    model_of,
    start_of,
    target_log,
    track,
)  # fmt: skip

LAB = Lab.of(
    __name__, "Lab 4: tuning and outliers",
    modelled_noise, motion_models, detection, precision, gates, undetected,
)  # fmt: skip
__getattr__ = LAB.verb


def long_run(question: str) -> None:
    """Print what the full film says: 688 frames, 1,000 particles, median (sd) of ten seeds."""
    table = json.loads(files(__name__).joinpath("long_runs.json").read_text("ascii"))[question]
    print(f"{table['what']}: median over ten seeds (sd)")
    for value, cells in table["rows"]:
        shown = f"{value:g}" if isinstance(value, float | int) else value
        told = "; ".join(f"{name} {mid:g} ({sd:g})" for name, (mid, sd) in cells.items())
        print(f"  {shown}: {told}")


__all__ = [
    "AREA",
    "LAB",
    "answer",
    "anywhere",
    "around",
    "auc",
    "check",
    "circle",
    "film",
    "half_false",
    "load",
    "long_run",
    "measurement_error",
    "model_of",
    "predict",
    "save",
    "start_of",
    "summary",
    "target_log",
    "track",
    "use",
]  # fmt: skip
