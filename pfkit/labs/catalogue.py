"""Which modules of questions are there? Those called ``lab*`` and ``ch*`` in this folder."""

import pkgutil
from importlib import import_module

from pfkit import labs
from pfkit.labs.lab import Lab


def names() -> list[str]:
    """Names of all question modules, sorted: ``["ch01", ..., "lab3", "lab4"]``."""
    found = (m.name for m in pkgutil.iter_modules(labs.__path__))
    return sorted(n for n in found if n != "lab" and n.startswith(("ch", "lab")))


def all_labs() -> dict[str, Lab]:
    """Name -> `Lab` of each question module."""
    return {name: import_module(f"pfkit.labs.{name}").LAB for name in names()}
