"""pfkit: particle filters for robot localisation, small and readable.

``import pfkit as pf`` gives every name of the core, each loaded when it is first used: a notebook
depends on what it uses and on nothing else. The core needs NumPy and the standard library only, so
that the same code runs in Jupyter, in the tests and in the page. `pfkit.plotting`, `pfkit.widgets`,
`pfkit.explore` and `pfkit.labs` are imported by name. `pfkit.rooms` is the table of contents.
"""

from importlib import import_module
from typing import Any

from pfkit.rooms import HOME, MODULES

__version__ = "0.1.0"
__all__ = sorted([*HOME, *MODULES])


def __getattr__(name: str) -> Any:
    """Load a public name on first use, and keep it."""
    if name in MODULES:
        return import_module(MODULES[name])
    if name not in HOME:
        raise AttributeError(f"module 'pfkit' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(HOME[name]), name)
    return value


def __dir__() -> list[str]:
    """Every public name, loaded or not."""
    return ["__version__", *__all__]
