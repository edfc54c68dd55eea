"""Lab 3: the particle filter.

P1 to P8 prepare; Q1 to Q8 run a filter on a target in an image. The notebook is
``notebooks/labs/lab3_particle_filter.ipynb``.
"""

from pfkit.labs.lab import Lab
from pfkit.labs.lab3_preparation import FILM
from pfkit.labs.lab3_preparation import QUESTIONS as PREPARATION
from pfkit.labs.lab3_target import LINE
from pfkit.labs.lab3_target import QUESTIONS as TARGET
from pfkit.labs.target import anywhere, around, target_log, track

LAB = Lab("lab3", "Lab 3: the particle filter", (*PREPARATION, *TARGET))
check, use, predict, answer, summary, save, load = LAB.verbs()
film, line = FILM, LINE

__all__ = [
    "LAB",
    "answer",
    "anywhere",
    "around",
    "check",
    "film",
    "line",
    "load",
    "predict",
    "save",
    "summary",
    "target_log",
    "track",
    "use",
]  # fmt: skip
