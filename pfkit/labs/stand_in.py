"""Stand-ins for what the page does not have: matplotlib, and the front end of Jupyter.

Cells with figures run for the numbers that they compute, and draw nothing. `Nothing.calls` counts
how often a stand-in was called, so that the page can say where a figure is missing.
"""

from __future__ import annotations

import sys
import types
from typing import Any

import numpy as np

STAND_INS = (
    "matplotlib",
    "matplotlib.pyplot",
    "matplotlib.patches",
    "matplotlib.animation",
    "matplotlib.colors",
    "pfkit.plotting",
    "pfkit.widgets",
    "ipywidgets",
    "IPython",
    "IPython.display",
)


class Nothing:
    """Absorbs any use: attribute, call, item, context. Stands in for figures and axes."""

    calls = 0

    def __getattr__(self, name: str) -> Nothing:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __call__(self, *args: Any, **kwargs: Any) -> Nothing:
        Nothing.calls += 1
        return self

    def __getitem__(self, key: Any) -> Nothing:
        return self

    def __setitem__(self, key: Any, value: Any) -> None:
        return None

    def __iter__(self):
        return iter(())

    def __enter__(self) -> Nothing:
        return self

    def __exit__(self, *args: Any) -> None:
        return None

    def subplots(self, nrows: int = 1, ncols: int = 1, **kwargs: Any) -> tuple[Any, Any]:
        """A figure and its axes in the shape that pyplot gives them."""
        Nothing.calls += 1
        axes = np.empty((nrows, ncols), object)
        axes.fill(Nothing())
        axes = axes if not kwargs.get("squeeze", True) else axes.squeeze()
        return self, axes[()] if axes.ndim == 0 else axes

    def panels(self, n: int, **kwargs: Any) -> tuple[Any, list[Any]]:
        """What `pfkit.plotting.panels` gives: a figure and n axes."""
        Nothing.calls += 1
        return self, [self] * n


def stand_in_for_figures() -> None:
    """Let ``import matplotlib...``, ``pfkit.plotting`` and ``pfkit.widgets`` succeed."""

    def module(name: str) -> types.ModuleType:
        nothing = Nothing()
        made = types.ModuleType(name)
        made.__getattr__ = lambda attribute: getattr(nothing, attribute)  # type: ignore[method-assign]
        made.__path__ = []  # type: ignore[attr-defined]
        if name == "IPython":
            made.get_ipython = lambda: None  # type: ignore[attr-defined]
        return made

    for name in STAND_INS:
        sys.modules.setdefault(name, module(name))
