"""Classic wrong implementations, each with the hint it must earn.

A mutant is a `Misconception` whose example is a working, wrong function. The tests run every one:
it must fail its item, be recognised by name, and be mistaken for no other. To add one, write the
function in the module of its concept and append a `Misconception` to the tuple of its item.

``MUTANTS["lab3"]["q4b"]`` are the mutants of that item.
"""

from pfkit.labs.items import Misconception
from pfkit.labs.mutants import (
    angles,
    likelihoods,
    motion,
    outliers,
    resampling,
    summaries,
    survival,
    weights,
)

MUTANTS: dict[str, dict[str, tuple[Misconception, ...]]] = {"lab3": {}, "lab4": {}}
MODULES = (angles, likelihoods, motion, outliers, resampling, summaries, survival, weights)
for module in MODULES:
    for lab, items in module.MUTANTS.items():
        MUTANTS[lab].update(items)

__all__ = ["MUTANTS"]
