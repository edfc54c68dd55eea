"""Which modules of questions are there? Those in this folder that publish a `LAB`."""

import pkgutil
from functools import cache
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from pfkit import labs
from pfkit.labs.grade.cells import code_cells, labs_imported
from pfkit.labs.lab import Lab


@cache
def names() -> tuple[str, ...]:
    """Names of all question modules, sorted: ``("bayes_filter", ..., "lab3", "lab4")``."""
    found = []
    for module in pkgutil.iter_modules(labs.__path__):
        spec = find_spec(f"{labs.__name__}.{module.name}")
        if spec and spec.origin and "\nLAB = Lab.of(" in Path(spec.origin).read_text("utf-8"):
            found.append(module.name)
    return tuple(sorted(found))


def all_labs() -> dict[str, Lab]:
    """Name -> `Lab` of each question module."""
    return {name: import_module(f"{labs.__name__}.{name}").LAB for name in names()}


def asked_in(book: dict[str, Any]) -> set[str]:
    """Names of the question modules that the cells of a notebook (its JSON) import."""
    return set().union(*(labs_imported(s) for _, s in code_cells(book))).intersection(names())
