"""A drawing as an SVG picture: what print, a reader without scripts, or a stored notebook shows.

Stills are made once, by Python, from the same array that the page draws; see `pfkit.explore.pen`.
Clouds are thinned, because a still need not carry every particle.
"""

from __future__ import annotations

from html import escape

import numpy as np

from pfkit.errors import ParameterError
from pfkit.explore.operations import SHAPES
from pfkit.explore.pen import records
from pfkit.palette import COLOURS

LIGHT = {name: light for name, (light, _) in COLOURS.items()}
MOST = 600  # points of one cloud that a still keeps


class Still:
    """Turns records into SVG elements; one method per operation, named after it."""

    def __init__(self, size: tuple[int, int]):
        self.width, self.height = size
        self.out: list[str] = []
        self.open = False
        self.view(np.array([0, 0, 1, 1, 0, 1, 0, 1, 0, 0], float), "paper")

    def view(self, d: np.ndarray, colour: str) -> None:
        left, bottom, width, height, x0, x1, y0, y1, equal, box = (float(v) for v in d)
        left, width = left * self.width, width * self.width
        bottom, height = (1 - bottom) * self.height, height * self.height
        sx, sy = width / (x1 - x0), height / (y1 - y0)
        if equal:
            s = min(sx, sy)
            left += (width - s * (x1 - x0)) / 2
            bottom -= (height - s * (y1 - y0)) / 2
            sx = sy = s
        self.left, self.bottom, self.x0, self.y0, self.sx, self.sy = left, bottom, x0, y0, sx, sy
        w, h = sx * (x1 - x0), sy * (y1 - y0)
        self.close()
        if equal:  # a map is cut at its edge; charts may write beside themselves
            self.out.append(
                f'<clipPath id="cut"><rect x="{left - 1:.1f}" y="{bottom - h - 1:.1f}" '
                f'width="{w + 2:.1f}" height="{h + 2:.1f}"/></clipPath><g clip-path="url(#cut)">'
            )
            self.open = True
        if box:
            self.out.append(
                f'<rect x="{left:.1f}" y="{bottom - h:.1f}" width="{w:.1f}" height="{h:.1f}" '
                f'fill="none" stroke="{LIGHT["grid"]}"/>'
            )

    def part(self, d: np.ndarray, colour: str) -> None:
        """A still shows one picture; of two, a still of each."""
        raise ParameterError("a still shows one world: draw each by itself")

    def handle(self, d: np.ndarray, colour: str) -> None:
        """Nothing can be dragged in a still."""

    def close(self) -> None:
        """End the group that is cut at the edge of the last view."""
        if self.open:
            self.out.append("</g>")
        self.open = False

    def _rows(self, d: np.ndarray, lead: int, rows: int, most: int | None = None) -> np.ndarray:
        table = np.asarray(d[lead:], float).reshape(rows, -1)
        if most and table.shape[1] > most:
            table = table[:, np.linspace(0, table.shape[1] - 1, most).astype(np.int64)]
        return table

    def X(self, x):
        return self.left + (x - self.x0) * self.sx

    def Y(self, y):
        return self.bottom - (y - self.y0) * self.sy

    def _discs(self, x, y, r, colour: str, opacity: float) -> None:
        dots = "".join(
            f'<circle cx="{a:.1f}" cy="{b:.1f}" r="{c:.1f}"/>'
            for a, b, c in zip(self.X(x), self.Y(y), np.broadcast_to(r, x.shape), strict=True)
        )
        self.out.append(f'<g fill="{colour}" fill-opacity="{opacity:.2f}">{dots}</g>')

    def points(self, d: np.ndarray, colour: str) -> None:
        x, y = self._rows(d, 1, 2, MOST)
        self._discs(x, y, d[0] / 2, colour, min(0.85, max(0.3, 11 / np.sqrt(x.size + 1))))

    def bubbles(self, d: np.ndarray, colour: str) -> None:
        x, y, s = self._rows(d, 0, 3, MOST)
        self._discs(x, y, s / 2, colour, 0.55)

    def _path(self, path: str, colour: str, width: float, dash: float = 0) -> None:
        dashes = f' stroke-dasharray="{dash:g}"' if dash else ""
        self.out.append(
            f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="{width:g}"{dashes}/>'
        )

    def segments(self, d: np.ndarray, colour: str) -> None:
        a, b, c, e = self._rows(d, 1, 4, 1500)
        ends = zip(self.X(a), self.Y(b), self.X(c), self.Y(e), strict=True)
        path = "".join(f"M{p:.1f} {q:.1f}L{r:.1f} {s:.1f}" for p, q, r, s in ends)
        self._path(path, colour, d[0])

    def _trace(self, d: np.ndarray, lead: int) -> str:
        x, y = self._rows(d, lead, 2)
        path, move = "", True
        for a, b in zip(self.X(x), self.Y(y), strict=True):
            if np.isnan(a + b):
                move = True
                continue
            path += f"{'M' if move else 'L'}{a:.1f} {b:.1f}"
            move = False
        return path

    def line(self, d: np.ndarray, colour: str) -> None:
        self._path(self._trace(d, 2), colour, d[0], d[1])

    def area(self, d: np.ndarray, colour: str) -> None:
        path = self._trace(d, 1)
        self.out.append(f'<path d="{path}" fill="{colour}" fill-opacity="{d[0]:.2f}"/>')

    def bars(self, d: np.ndarray, colour: str) -> None:
        for a, b, c, e in self._rows(d, 1, 4).T:
            x, y = sorted((self.X(a), self.X(b))), sorted((self.Y(c), self.Y(e)))
            self.out.append(
                f'<rect x="{x[0]:.1f}" y="{y[0]:.1f}" width="{x[1] - x[0]:.1f}" '
                f'height="{y[1] - y[0]:.1f}" fill="{colour}" fill-opacity="{d[0]:.2f}"/>'
            )

    def robots(self, d: np.ndarray, colour: str) -> None:
        r, hollow = max(float(d[0]) * self.sx, 5), bool(d[1])
        shape = (
            f'<circle r="{r:.1f}" fill="none"/><path d="M{r:.1f} 0H{1.7 * r:.1f}"/>'
            if hollow
            else f'<path fill="{colour}" d="M{1.5 * r:.1f} 0L{-r:.1f} {0.85 * r:.1f}'
            f'V{-0.85 * r:.1f}Z"/>'
        )
        edge, width = (colour, 2) if hollow else (LIGHT["paper"], 1)
        for x, y, theta in self._rows(d, 2, 3).T:
            self.out.append(
                f'<g transform="translate({self.X(x):.1f} {self.Y(y):.1f}) '
                f'rotate({-np.degrees(theta):.1f})" stroke="{edge}" stroke-width="{width}">'
                f"{shape}</g>"
            )

    def ellipses(self, d: np.ndarray, colour: str) -> None:
        dash = f' stroke-dasharray="{d[1]:g}"' if d[1] else ""
        for x, y, a, b, angle in self._rows(d, 2, 5).T:
            self.out.append(
                f'<ellipse rx="{abs(a * self.sx):.1f}" ry="{abs(b * self.sy):.1f}" fill="none" '
                f'transform="translate({self.X(x):.1f} {self.Y(y):.1f}) '
                f'rotate({-np.degrees(angle):.1f})" stroke="{colour}" '
                f'stroke-width="{d[0]:g}"{dash}/>'
            )

    def stems(self, d: np.ndarray, colour: str) -> None:
        x, y = self._rows(d, 2, 2, MOST)
        base = self.Y(float(d[0]))
        ends = zip(self.X(x), self.Y(y), strict=True)
        self._path("".join(f"M{a:.1f} {base:.1f}V{b:.1f}" for a, b in ends), colour, 1.2)
        self._discs(x, y, d[1] / 2, colour, 1)

    def image(self, d: np.ndarray, colour: str) -> None:
        nx, ny = int(d[0]), int(d[1])
        x0, x1, y0, y1 = (float(v) for v in d[2:6])
        wide, high = (x1 - x0) / nx, (y1 - y0) / ny
        cells = np.asarray(d[6:], float).reshape(ny, nx)
        rects = "".join(
            f'<rect x="{self.X(x0 + i * wide):.1f}" y="{self.Y(y0 + (j + 1) * high):.1f}" '
            f'width="{wide * self.sx + 0.3:.1f}" height="{high * self.sy + 0.3:.1f}" '
            f'fill-opacity="{cells[j, i]:.2f}"/>'
            for j, i in zip(*np.nonzero(cells > 0.03), strict=True)
        )
        self.out.append(f'<g fill="{colour}">{rects}</g>')

    def text(self, d: np.ndarray, colour: str) -> None:
        anchor = {-1: "start", 0: "middle", 1: "end"}[int(d[3])]
        words = escape("".join(chr(int(c)) for c in d[4:]))
        self.out.append(
            f'<text x="{self.X(d[0]):.1f}" y="{self.Y(d[1]):.1f}" dy=".35em" '
            f'font-size="{d[2]:g}" text-anchor="{anchor}" fill="{colour}">{words}</text>'
        )

    def symbols(self, d: np.ndarray, colour: str) -> None:
        shape, r = SHAPES[int(d[0])], float(d[1]) / 2
        unit = {
            "circle": None,
            "square": [(-1, -1), (1, -1), (1, 1), (-1, 1)],
            "triangle": [(0, -1), (0.87, 0.5), (-0.87, 0.5)],
        }.get(shape, [(0, -1), (1, 0), (0, 1), (-1, 0)])
        x, y = self._rows(d, 2, 2)
        if unit is None:
            return self._discs(x, y, r, colour, 1)
        for a, b in zip(self.X(x), self.Y(y), strict=True):
            if shape in ("cross", "plus"):
                e, f = (0.75 * r, 0.75 * r) if shape == "cross" else (0, r)
                self._path(
                    f"M{a - f:.1f} {b - e:.1f}L{a + f:.1f} {b + e:.1f}"
                    f"M{a + e:.1f} {b - f:.1f}L{a - e:.1f} {b + f:.1f}",
                    colour,
                    2,
                )
                continue
            corners = " ".join(f"{a + r * p:.1f},{b + r * q:.1f}" for p, q in unit)
            self.out.append(f'<polygon points="{corners}" fill="{colour}"/>')

    def quills(self, d: np.ndarray, colour: str) -> None:
        x, y, theta = self._rows(d, 2, 3, MOST)
        a, b = self.X(x), self.Y(y)
        c, e = a + d[0] * np.cos(theta), b - d[0] * np.sin(theta)
        ends = zip(a, b, c, e, strict=True)
        path = "".join(f"M{p:.1f} {q:.1f}L{r:.1f} {s:.1f}" for p, q, r, s in ends)
        self._path(path, colour, 0.8)
        self._discs(x, y, d[1] / 2, colour, 0.6)

    def ticks(self, d: np.ndarray, colour: str) -> None:
        for value in np.asarray(d[1:], float):
            if d[0]:
                x, y, anchor = self.left - 6, self.Y(value), "end"
            else:
                x, y, anchor = self.X(value), self.bottom + 13, "middle"
            self.out.append(
                f'<text x="{x:.1f}" y="{y:.1f}" dy=".35em" font-size="11" '
                f'text-anchor="{anchor}" fill="{colour}">{value:g}</text>'
            )


def to_svg(drawing: np.ndarray, size: tuple[int, int], title: str) -> str:
    """The drawing as a stand-alone SVG document."""
    still = Still(size)
    for op, style, numbers in records(drawing):
        getattr(still, op)(numbers, LIGHT[style])
    still.close()
    width, height = size
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" '
        f'font-family="system-ui, Arial, sans-serif"><title>{escape(title)}</title>'
        f'<rect width="{width}" height="{height}" fill="{LIGHT["paper"]}"/>'
        + "".join(still.out)
        + "</svg>\n"
    )
