"""Lab 3: the particle filter.

P1 to P8 prepare; Q1 to Q8 run a filter on a target in an image. The notebook is
``notebooks/labs/lab3_particle_filter.ipynb``.
"""

from pfkit.labs.lab import Lab
from pfkit.labs.lab3 import (
    ablations,
    densities,
    deprivation,
    likelihood,
    motion_models,
    noise,
    particle_count,
    resamplers,
    sample_variance,
    summaries,
    survival,
    weights,
)
from pfkit.labs.lab3.given import anywhere, around, film, line, target_log, track

LAB = Lab.of(
    __name__, "Lab 3: the particle filter",
    weights, deprivation, summaries, densities, sample_variance, particle_count,
    motion_models, likelihood, resamplers, survival, noise, ablations,
)  # fmt: skip
__getattr__ = LAB.verb

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
