"""The drawing operations, declared once: for scenes, recordings, stills and the page's renderer.

An operation has a number, its place in `OPERATIONS`, and a name. A recording stores its first
``lead`` numbers exactly and the others in ``rows`` of equal length as quantised differences; one
without rows is stored exactly throughout. What the numbers mean is said in `pfkit.explore.pen`.

`script` hands the table to `web/render.js`. This module imports nothing of the package, so that a
build can read it alone.
"""

from __future__ import annotations

import json
from typing import NamedTuple


class Operation(NamedTuple):
    """How a recording stores an operation's numbers (``rows`` 0: exactly) and moves between frames.

    ``move`` says which numbers may lie between those of two frames: none, all behind the lead, or
    all with a last row of angles, which turn the short way. What is ``loose`` is a set: its members
    move only if the recording knows which one became which.
    """

    name: str
    lead: int = 0
    rows: int = 0
    move: str = ""  # "", "all", "angle"
    loose: bool = False


OPERATIONS = (
    Operation("view", move="all"),
    Operation("points", lead=1, rows=2, move="all", loose=True),
    Operation("bubbles", rows=3),
    Operation("segments", lead=1, rows=4, move="all"),
    Operation("line", lead=2, rows=2, move="all"),
    Operation("area", lead=1, rows=2, move="all"),
    Operation("bars", lead=1, move="all"),
    Operation("robots", lead=2, move="angle"),
    Operation("ellipses", lead=2, rows=5, move="angle"),
    Operation("stems", lead=2, rows=2, move="all", loose=True),
    Operation("image", lead=6, rows=1, move="all"),
    Operation("text"),
    Operation("symbols", lead=2, move="all"),
    Operation("quills", lead=2, rows=3, move="angle", loose=True),
    Operation("ticks"),
    Operation("handle"),
    Operation("part"),
)
NUMBER = {operation.name: k for k, operation in enumerate(OPERATIONS, start=1)}
SHAPES = ("circle", "square", "diamond", "cross", "triangle", "plus", "star")
FEWEST = 24  # numbers beside the lead that are worth quantising


def operation(number: int) -> Operation:
    """The operation of a record's number, which counts from 1."""
    return OPERATIONS[number - 1]


def script() -> str:
    """The table as a classic script, for the page and for Jupyter: it sets ``PF.drawing``."""
    data = json.dumps(
        {
            "operations": [None, *(o._asdict() for o in OPERATIONS)],
            "shapes": SHAPES,
            "fewest": FEWEST,
        }
    )
    return f"(globalThis.PF = globalThis.PF || {{}}).drawing = {data};\n"
