"""One look for the whole book: same colours, same marker shapes, everywhere.

| thing | colour | shape |
|---|---|---|
| truth | black | solid line, robot as a filled arrowhead |
| estimate | blue | dashed line, robot as an open circle with a nose |
| dead reckoning | red-orange | dotted line, cross |
| particles | grey | small dots; size shows weight |
| landmarks | green | diamonds with their ids |
| exact posterior | purple | shaded cells or a filled curve |
| measurements | amber | thin lines or ticks |

The colours come from `pfkit.palette`, which the explorables use as well. Every function draws into
the `ax` it is given, returns what it drew, and never calls `show`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from pfkit.palette import COLOURS
from pfkit.particles.particle_set import Particles
from pfkit.worlds.maps import LandmarkMap

TRUTH, ESTIMATE, DEAD_RECKONING, PARTICLES, LANDMARKS, EXACT, MEASUREMENT = (
    COLOURS[name][0]
    for name in ("truth", "estimate", "dead reckoning", "particles", "landmarks", "exact",
                 "measurement")
)  # fmt: skip
INK = COLOURS["ink"][0]  # for words: green letters on white are hard to read

KINDS: dict[str, dict[str, Any]] = {
    "truth": {"color": TRUTH, "ls": "-", "marker": ">"},
    "estimate": {"color": ESTIMATE, "ls": "--", "marker": "o"},
    "dead reckoning": {"color": DEAD_RECKONING, "ls": ":", "marker": "x"},
}

STYLE: dict[str, Any] = {
    "figure.dpi": 100,
    "savefig.dpi": 100,
    "figure.figsize": (6.4, 3.6),
    "figure.constrained_layout.use": True,
    "font.size": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10,
    "axes.prop_cycle": plt.cycler(
        color=[ESTIMATE, DEAD_RECKONING, LANDMARKS, EXACT, MEASUREMENT, TRUTH],
        linestyle=["-", "--", ":", "-.", (0, (5, 1)), (0, (1, 1))],
    ),
    "legend.frameon": False,
    "image.cmap": "Purples",
}


def use_style() -> None:
    """Set the book's look for all figures that follow."""
    plt.rcParams.update(STYLE)


def panels(
    n: int, width: float = 8.0, height: float = 2.4, titles: Sequence[str] = ()
) -> tuple[Figure, NDArray[Any]]:
    """A film strip: one figure with n panels side by side.

    Parameters
    ----------
    n : int
    width, height : float, inches
    titles : sequence of str, one per panel

    Returns
    -------
    figure, array of n Axes
    """
    figure, axes = plt.subplots(1, n, figsize=(width, height), squeeze=False)
    for ax, title in zip(axes[0], titles, strict=False):
        ax.set_title(title)
    return figure, axes[0]


def draw_world(ax: Axes, world: LandmarkMap, ids: bool = True) -> Any:
    """Landmarks as green diamonds with their ids, axes equal and cut to the map's bounds.

    Parameters
    ----------
    ax : Axes
    world : LandmarkMap
    ids : bool, whether to write the landmark ids

    Returns
    -------
    the landmark artist
    """
    x0, x1, y0, y1 = world.bounds
    artist = ax.scatter(
        *world.positions, marker="D", s=36, color=LANDMARKS, edgecolor="white", zorder=4
    )
    if ids:
        for name, (x, y) in zip(world.ids, world.positions.T, strict=True):
            ax.annotate(str(name), (x, y), (5, 5), textcoords="offset points", color=INK, size=8)
    margin = 0.04 * max(x1 - x0, y1 - y0)
    ax.set(xlim=(x0 - margin, x1 + margin), ylim=(y0 - margin, y1 + margin), aspect="equal")
    return artist


def draw_particles(ax: Axes, bel: Particles, headings: bool = False, most: int = 2000) -> Any:
    """Particles as grey dots whose area is proportional to their weight.

    Parameters
    ----------
    ax : Axes
    bel : Particles (D, M); the first two components are drawn
    headings : bool, whether to add a short stroke along each heading
    most : int, draw at most this many (every k-th), so that files stay small

    Returns
    -------
    the scatter artist
    """
    every = slice(None, None, max(1, -(-bel.M // most)))
    x, y = bel.state[0, every], bel.state[1, every]
    area = np.clip(5.0 * bel.w[every] * bel.M, 0.15, 60.0)
    if headings:
        theta = bel.state[2, every]
        ax.quiver(
            x, y, np.cos(theta), np.sin(theta), color=PARTICLES, alpha=0.5, scale=40, width=0.002
        )
    return ax.scatter(x, y, s=area, color=PARTICLES, alpha=0.5, linewidth=0, zorder=2)


def draw_pose(ax: Axes, pose: ArrayLike, kind: str = "truth", size: float = 80) -> Any:
    """One robot: where it is and where its nose points.

    Parameters
    ----------
    ax : Axes
    pose : array_like (3,), metres and radians
    kind : "truth", "estimate" or "dead reckoning"
    size : float, marker area in points squared

    Returns
    -------
    the marker artist
    """
    x, y, theta = np.asarray(pose, dtype=float)
    look = KINDS[kind]
    if kind == "truth":
        turn = np.array(((np.cos(theta), np.sin(theta)), (-np.sin(theta), np.cos(theta))))
        arrow = np.array(((1.0, 0.0), (-0.7, 0.55), (-0.7, -0.55))) @ turn
        return ax.scatter(x, y, s=size, marker=arrow, color=look["color"], zorder=6)
    nose = 0.9 * np.sqrt(size)
    ax.annotate(
        "",
        (x, y),
        (nose * np.cos(theta), nose * np.sin(theta)),
        textcoords="offset points",
        arrowprops={"arrowstyle": "-", "color": look["color"], "lw": 2},
        zorder=6,
    )
    if look["marker"] == "x":
        return ax.scatter(x, y, s=size, marker="x", color=look["color"], zorder=7)
    return ax.scatter(x, y, s=size, facecolor="white", edgecolor=look["color"], zorder=7)


def draw_path(ax: Axes, path: ArrayLike, kind: str = "truth", **kwargs: Any) -> Any:
    """A track in its kind's colour and line style.

    Parameters
    ----------
    ax : Axes
    path : array_like (2 or more, T), metres
    kind : "truth", "estimate" or "dead reckoning"
    **kwargs : passed to ``ax.plot``

    Returns
    -------
    the line artist
    """
    look = KINDS[kind]
    x, y = np.asarray(path)[:2]
    options = {"color": look["color"], "ls": look["ls"], "lw": 1.5, "label": kind} | kwargs
    return ax.plot(x, y, **options)[0]


def draw_measurements(ax: Axes, pose: ArrayLike, z: ArrayLike) -> list[Any]:
    """Range-bearing measurements as amber rays from the pose they were taken at.

    Parameters
    ----------
    ax : Axes
    pose : array_like (3,)
    z : array_like (2 or 3, K), rows range (m) and bearing (rad)

    Returns
    -------
    list of line artists
    """
    x, y, theta = np.asarray(pose, dtype=float)
    r, phi = np.asarray(z, dtype=float)[:2]
    xs = np.stack((np.full_like(r, x), x + r * np.cos(theta + phi)))
    ys = np.stack((np.full_like(r, y), y + r * np.sin(theta + phi)))
    return ax.plot(xs, ys, color=MEASUREMENT, lw=1, ls="-", zorder=3)


def draw_ellipse(ax: Axes, mean: ArrayLike, Sigma: ArrayLike, sds: float = 2.0) -> Any:
    """The curve of constant Gaussian density at so many standard deviations.

    Parameters
    ----------
    ax : Axes
    mean : array_like (2 or more,), metres
    Sigma : array_like (2 or more square), m^2; its first two rows and columns are drawn
    sds : float, Mahalanobis radius

    Returns
    -------
    the line artist
    """
    mean, Sigma = np.asarray(mean)[:2], np.asarray(Sigma)[:2, :2]
    values, vectors = np.linalg.eigh(Sigma)
    circle = np.linspace(0, 2 * np.pi, 100)
    unit = np.stack((np.cos(circle), np.sin(circle)))
    x, y = mean[:, None] + sds * (vectors * np.sqrt(np.maximum(values, 0))) @ unit
    return ax.plot(x, y, color=ESTIMATE, lw=1.5, ls="-")[0]


def draw_density(
    ax: Axes, density: ArrayLike, bounds: tuple[float, float, float, float], **kwargs: Any
) -> Any:
    """An exact posterior (or a likelihood) over x and y as shaded cells.

    Parameters
    ----------
    ax : Axes
    density : array_like (nx, ny), any positive scale; the first axis is x
    bounds : (x_min, x_max, y_min, y_max), metres
    **kwargs : passed to ``ax.imshow``

    Returns
    -------
    the image artist
    """
    options = {"cmap": "Purples", "aspect": "equal", "interpolation": "nearest"} | kwargs
    return ax.imshow(np.asarray(density).T, origin="lower", extent=bounds, zorder=0, **options)


def draw_weights(ax: Axes, x: ArrayLike, w: ArrayLike) -> Any:
    """Weights as stems standing on their particles (one dimension).

    Parameters
    ----------
    ax : Axes
    x, w : array_like (M,)

    Returns
    -------
    the stem container
    """
    return ax.stem(x, w, linefmt=PARTICLES, markerfmt="o", basefmt=" ")
