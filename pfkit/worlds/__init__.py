"""Worlds: maps, what a robot recorded in them, and the course's own arenas.

Landmarks, occupancy grids and their distances, rays, symmetries. ``pf.worlds.arena()`` and the
other worlds of the book are in `arenas`, and are loaded when one is asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from pfkit.worlds.arenas import *  # noqa: F403


def __getattr__(name: str) -> Any:
    """Give what `arenas` offers."""
    arenas = import_module("pfkit.worlds.arenas")
    if name.startswith("_") or not hasattr(arenas, name):
        raise AttributeError(f"module 'pfkit.worlds' has no attribute {name!r}")
    return getattr(arenas, name)
