"""The six types of item, as declarations.

======  ===============  ====================================================================
letter  class            the student gives
======  ===============  ====================================================================
N       `Numeric`        one or several numbers
C       `Code`           a function
M       `Choice`         a letter
X       `Experiment`     a function that runs an experiment many times
P       `Prediction`     a letter, and how sure: locked before the experiment
R       `Text`           at most three sentences, marked by hand
======  ===============  ====================================================================

An item judges an answer. It knows nothing about notebooks, files or hints already given:
that is `pfkit.labs.lab`. `base` is what all share, `numbers` and `words` hold the answers that
are values, `functions` those that are run.
"""

from pfkit.labs.items.base import (
    Item,
    Judgement,
    Misconception,
    Property,
    Refused,
    is_unanswered,
    tested,
)
from pfkit.labs.items.functions import Code, Experiment, Function, code, experiment
from pfkit.labs.items.numbers import Numeric
from pfkit.labs.items.words import Choice, Prediction, Text

__all__ = [
    "Choice",
    "Code",
    "Experiment",
    "Function",
    "Item",
    "Judgement",
    "Misconception",
    "Numeric",
    "Prediction",
    "Property",
    "Refused",
    "Text",
    "code",
    "experiment",
    "is_unanswered",
    "tested",
]
