"""Lab 4: tuning and outliers.

Q9 to Q12 change what the filter believes about noise and motion; in Q13 to Q16 half of the
measurements are false. The notebook is ``notebooks/labs/lab4_tuning_outliers.ipynb``.
"""

from pfkit.labs.lab import Lab
from pfkit.labs.lab4_outliers import FALSE, auc
from pfkit.labs.lab4_outliers import QUESTIONS as OUTLIERS
from pfkit.labs.lab4_tuning import CIRCLE, FILM, model_of, start_of
from pfkit.labs.lab4_tuning import QUESTIONS as TUNING
from pfkit.labs.target import AREA, anywhere, around, target_log, track

LAB = Lab("lab4", "Lab 4: tuning and outliers", (*TUNING, *OUTLIERS))
check, use, predict, answer, summary, save, load = LAB.verbs()
film, circle, half_false = FILM, CIRCLE, FALSE

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
    "model_of",
    "predict",
    "save",
    "start_of",
    "summary",
    "target_log",
    "track",
    "use",
]  # fmt: skip
