"""Explorables: small worlds that a reader moves, in the book's page and in Jupyter.

>>> from pfkit.explore import scene
>>> comb = scene("comb", seed=7)
>>> comb.step()
>>> drawing, readouts = comb.frame()

`scene` opens one by name; `SCENES` lists them. What a scene is, and how to write one, is told in
`pfkit.explore.scene`; how it becomes a picture, in `pfkit.explore.pen`. In a notebook use
`pfkit.widgets.explore`. In a chapter use the `explorable` directive of the book.
"""

from __future__ import annotations

from importlib import import_module

from pfkit.errors import ParameterError
from pfkit.explore.scene import Control, Mission, Panel, Scene, Score

__all__ = ["FRONT_END", "SCENES", "Control", "Mission", "Panel", "Scene", "Score", "scene"]

FRONT_END = (  # in web/, in the order in which they are loaded
    "render.js",
    "loading.js",
    "hand.js",
    "controls.js",
    "missions.js",
    "transport.js",
    "many.js",
    "explorable.js",
)
SCENES = {
    "banana": ("pfkit.explore.banana", "Banana"),
    "comb": ("pfkit.explore.comb", "Comb"),
    "corridor": ("pfkit.explore.corridor", "Corridor"),
    "drive": ("pfkit.explore.drive", "Drive"),
    "kalman": ("pfkit.explore.kalman", "Kalman"),
    "mower": ("pfkit.explore.mower", "Mower"),
    "estimates": ("pfkit.explore.estimates", "Estimates"),
    "exact": ("pfkit.explore.exact", "Exact"),
    "office": ("pfkit.explore.office", "Office"),
    "story": ("pfkit.explore.story", "Story"),
    "proposal": ("pfkit.explore.proposal", "Proposal"),
    "tuning": ("pfkit.explore.tuning", "Tuning"),
    "square": ("pfkit.explore.square", "Square"),
}


def scene(name: str, panel: str | None = None, seed: int = 1) -> Scene:
    """Open the scene `name` (see `SCENES`) on one of its panels; the first one if left out."""
    if name not in SCENES:
        raise ParameterError(f"no explorable is called {name!r}; choose one of {sorted(SCENES)}")
    module, cls = SCENES[name]
    return getattr(import_module(module), cls)(panel=panel, seed=seed)
