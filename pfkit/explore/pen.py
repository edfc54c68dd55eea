"""One flat array for any drawing: the contract between scenes and the renderer.

A drawing is a sequence of records, each

    op, style, n, then n numbers

all in one float32 array. `op` says what is drawn, `style` is an index into `STYLES`, the names of
`pfkit.palette`, which gives each its colour in a light and a dark theme. Arrays inside a record are
components first: all x, then all y. Coordinates are data units of the last `view`, and sizes are
pixels. A view with equal scales is a map: what leaves it is cut off.

====  ==========  ==================================================================================
 op   name        numbers
====  ==========  ==================================================================================
  1   view        left, bottom, width, height (fractions of the canvas), x0, x1, y0, y1, equal, box
  2   points      size, x.., y..
  3   bubbles     x.., y.., size..
  4   segments    width, x0.., y0.., x1.., y1..
  5   line        width, dash, x.., y..            (NaN breaks the line)
  6   area        alpha, x.., y..
  7   bars        alpha, x0.., x1.., y0.., y1..
  8   robots      radius, open, x.., y.., theta.. (radius in data units; open 0: a filled
                  arrowhead, 1: an empty circle with a nose)
  9   ellipses    width, dash, x.., y.., a.., b.., angle..       (half axes in data units)
 10   stems       base, size, x.., y..
 11   image       nx, ny, x0, x1, y0, y1, cells..  (row by row from y0; 0 clear, 1 full colour)
 12   text        x, y, size, anchor (-1 left, 0 middle, 1 right), code points..
 13   symbols     shape, size, x.., y..            (shape: index into `SHAPES`)
 14   quills      length, size, x.., y.., theta..     (dots with a short tick for the heading)
 15   ticks       side (0 below, 1 left), values..
 16   handle      x, y, grip (1: drawn as a small ring), code points of its name..
 17   part        k, n  (what follows is the k-th of n pictures: side by side, or one below the
                  other where there is no room)
====  ==========  ==================================================================================
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from pfkit.explore.operations import NUMBER, SHAPES, operation
from pfkit.palette import COLOURS

STYLES = tuple(COLOURS)
_STYLE = {name: i for i, name in enumerate(STYLES)}
_SHAPE = {name: i for i, name in enumerate(SHAPES)}


class Pen:
    """Collects records; each method adds one. Arrays broadcast as NumPy arrays do."""

    def __init__(self) -> None:
        self._parts: list[np.ndarray] = []

    def array(self) -> np.ndarray:
        """Everything drawn so far, shape (n,), float32."""
        return np.concatenate(self._parts) if self._parts else np.empty(0, np.float32)

    def _add(self, op: str, style: str, *numbers: ArrayLike) -> None:
        payload = [np.asarray(v, np.float32).ravel() for v in numbers]
        head = np.array([NUMBER[op], _STYLE[style], sum(p.size for p in payload)], np.float32)
        self._parts.extend([head, *payload])

    def view(
        self,
        box: tuple[float, float, float, float],
        x: tuple[float, float],
        y: tuple[float, float],
        equal: bool = False,
        frame: bool = True,
    ) -> None:
        """Following records use data range x, y inside box = (left, bottom, width, height)."""
        self._add("view", "paper", *box, *x, *y, float(equal), float(frame))

    def points(self, style: str, x: ArrayLike, y: ArrayLike, size: float = 3) -> None:
        self._add("points", style, size, *np.broadcast_arrays(x, y))

    def bubbles(self, style: str, x: ArrayLike, y: ArrayLike, size: ArrayLike) -> None:
        self._add("bubbles", style, *np.broadcast_arrays(x, y, size))

    def segments(
        self, style: str, x0: ArrayLike, y0: ArrayLike, x1: ArrayLike, y1: ArrayLike, width=1.5
    ) -> None:
        self._add("segments", style, width, *np.broadcast_arrays(x0, y0, x1, y1))

    def line(self, style: str, x: ArrayLike, y: ArrayLike, width=2.0, dash=0.0) -> None:
        self._add("line", style, width, dash, *np.broadcast_arrays(x, y))

    def area(self, style: str, x: ArrayLike, y: ArrayLike, alpha=0.25) -> None:
        self._add("area", style, alpha, *np.broadcast_arrays(x, y))

    def bars(
        self, style: str, x0: ArrayLike, x1: ArrayLike, y0: ArrayLike, y1: ArrayLike, alpha=1.0
    ) -> None:
        self._add("bars", style, alpha, *np.broadcast_arrays(x0, x1, y0, y1))

    def robots(
        self, style: str, x: ArrayLike, y: ArrayLike, theta: ArrayLike, radius: float = 0.25
    ) -> None:
        """Poses, in the shapes of `pfkit.plotting.draw_pose`: filled if true, empty if guessed."""
        self._add("robots", style, radius, style != "truth", *np.broadcast_arrays(x, y, theta))

    def ellipses(
        self,
        style: str,
        x: ArrayLike,
        y: ArrayLike,
        a: ArrayLike,
        b: ArrayLike,
        angle: ArrayLike = 0.0,
        width=1.5,
        dash=0.0,
    ) -> None:
        self._add("ellipses", style, width, dash, *np.broadcast_arrays(x, y, a, b, angle))

    def stems(self, style: str, x: ArrayLike, y: ArrayLike, base=0.0, size=4.0) -> None:
        self._add("stems", style, base, size, *np.broadcast_arrays(x, y))

    def image(
        self, style: str, cells: np.ndarray, x: tuple[float, float], y: tuple[float, float]
    ) -> None:
        """Cells of shape (ny, nx) with values in [0, 1], row 0 at y[0]."""
        ny, nx = cells.shape
        self._add("image", style, nx, ny, *x, *y, cells)

    def text(
        self, style: str, x: float, y: float, text: str, size: float = 12, anchor: int = -1
    ) -> None:
        self._add("text", style, x, y, size, anchor, [ord(c) for c in text])

    def symbols(self, style: str, shape: str, x: ArrayLike, y: ArrayLike, size=9.0) -> None:
        self._add("symbols", style, _SHAPE[shape], size, *np.broadcast_arrays(x, y))

    def quills(
        self, style: str, x: ArrayLike, y: ArrayLike, theta: ArrayLike, length=7, size=3.0
    ) -> None:
        self._add("quills", style, length, size, *np.broadcast_arrays(x, y, theta))

    def ticks(self, side: int, values: ArrayLike) -> None:
        self._add("ticks", "muted", side, values)

    def handle(self, name: str, x: float, y: float, grip: bool = True) -> None:
        """Something that can be dragged, in units of the present view; see `Scene.held`."""
        self._add("handle", "ink", x, y, float(grip), [ord(c) for c in name])

    def part(self, k: int, n: int) -> None:
        """What follows belongs to the k-th of n pictures."""
        self._add("part", "paper", k, n)


def words(numbers: np.ndarray) -> str:
    """The text that code points spell."""
    return "".join(chr(int(c)) for c in numbers)


def handles(drawing: np.ndarray) -> dict[str, tuple[float, float]]:
    """What can be dragged in a drawing: name -> place, in units of the view that it is in."""
    held = (d for op, _, d in records(drawing) if op == "handle")
    return {words(d[3:]): (float(d[0]), float(d[1])) for d in held}


def records(drawing: np.ndarray):
    """Yield (op name, style name, numbers) for each record of a drawing."""
    i = 0
    while i < drawing.size:
        op, style, n = (int(v) for v in drawing[i : i + 3])
        yield operation(op).name, STYLES[style], drawing[i + 3 : i + 3 + n]
        i += 3 + n
