"""The target of labs 3 and 4: a ball in an image of 640 x 480 pixels, seen in 688 frames.

It stands still, or rolls along a line at 1 px per frame, or on a circle at 2 px per frame.
A camera reports its position with noise of sd 1 px, or sd 20 px, or sd 1 px where about half of
the reports are outliers, uniform over the image. We simulate it, so the truth and the label of
every outlier are known.

The set-up follows the KTH course EL2320, lab 2; the data are our own.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import pfkit as pf
from pfkit.models.targets import CircleTarget, FixedTarget, LineTarget
from pfkit.particles.particle_set import equal_log_weights
from pfkit.particles.resampling import Resampler, systematic

Array = NDArray[np.float64]

WIDTH, HEIGHT, FRAMES = 640.0, 480.0, 688
AREA = WIDTH * HEIGHT
SPEED = {"fixed": 0.0, "line": 1.0, "circle": 2.0}  # px per frame
TURN = 2 * np.pi / FRAMES  # one turn in the whole film, rad per frame
STARTS = {"fixed": (440.0, 400.0, 0.0), "line": (27.0, 60.0, 0.55), "circle": (320.0, 21.0, 0.0)}
NOISE = {"low": (1.0, 0.0), "high": (20.0, 0.0), "outliers": (1.0, 0.5)}  # sd in px, share


def target_log(
    path: str = "circle", noise: str = "low", seed: int = 4, runs: int | None = None
) -> pf.Log:
    """Simulate the film, or ``runs`` films of one target with fresh noise in each.

    Parameters
    ----------
    path : "fixed", "line" or "circle"
    noise : "low" (sd 1 px), "high" (sd 20 px) or "outliers" (sd 1 px, half of them false)
    seed : int
    runs : int, optional
        Number of films.

    Returns
    -------
    Log
        Per frame u = (v, omega, dt) with dt = 1 frame and z (2, 1), or (2, 1, runs, 1), in px;
        ``truth`` (3, 688) in px and rad, ``outlier`` the labels.
    """
    rng = np.random.default_rng(seed)
    sigma, share = NOISE[noise]
    u = np.array([SPEED[path], TURN if path == "circle" else 0.0, 1.0])
    model = CircleTarget(0.0)
    truth = np.empty((3, FRAMES))
    state = np.array(STARTS[path])[:, None]
    for k in range(FRAMES):
        state = model.mean(state, u)
        truth[:, k] = state[:, 0]
    shape = (FRAMES, 1) if runs is None else (FRAMES, 1, runs, 1)
    honest = truth[:2].reshape(2, FRAMES, *(1,) * (len(shape) - 1))
    z = honest + sigma * rng.standard_normal((2, *shape))
    outlier = rng.random(shape) < share
    image = np.array([WIDTH, HEIGHT]).reshape(2, *(1,) * len(shape))
    z = np.where(outlier, image * rng.random((2, *shape)), z)
    return pf.Log(
        t=np.arange(1.0, FRAMES + 1),
        u=np.repeat(u[:, None], FRAMES, axis=1),
        z=list(np.moveaxis(z, 1, 0)),
        truth=truth,
        start=np.array(STARTS[path]),
        source=f"target, {path}, {noise} noise",
        outlier=list(outlier),
    )


def anywhere(shape: int | tuple[int, ...], rng: np.random.Generator, D: int = 2) -> pf.Particles:
    """Particles uniform over the image: state (2, M), or (3, M) with a heading; batches too."""
    shape = (shape,) if isinstance(shape, int) else shape
    state = np.empty((D, *shape))
    state[0], state[1] = WIDTH * rng.random(shape), HEIGHT * rng.random(shape)
    if D > 2:
        state[2] = 2 * np.pi * rng.random(shape) - np.pi
    return pf.Particles(state, equal_log_weights(shape))


def around(
    start: Array, shape: int | tuple[int, ...], rng: np.random.Generator, sigma: float = 1.0
) -> pf.Particles:
    """Particles around a known start (D,): sd ``sigma`` px, and 0.01 rad for a heading."""
    shape = (shape,) if isinstance(shape, int) else shape
    sd = np.array([sigma, sigma, 0.01][: len(start)])
    state = start.reshape(-1, *(1,) * len(shape)) + sd.reshape(-1, *(1,) * len(shape)) * (
        rng.standard_normal((len(start), *shape))
    )
    return pf.Particles(state, equal_log_weights(shape))


class Track(NamedTuple):
    """What `track` measured, one row per frame.

    Attributes
    ----------
    error : array (T,) or (T, B), px: distance of the weighted mean from the truth
    ess : array (T,) or (T, B): effective sample size before any resampling
    likelihood : array (T,) or (T, B): mean likelihood of the measurement over the particles
    rejected : bool array (T,) or (T, B): the gate was closed
    bel : Particles, the last belief
    """

    error: Array
    ess: Array
    likelihood: Array
    rejected: NDArray[np.bool_]
    bel: pf.Particles


def track(
    log: pf.Log,
    bel: pf.Particles,
    motion: FixedTarget,
    sensor: pf.Sensor,
    rng: np.random.Generator,
    scheme: Resampler | None = systematic,
    gate: float = 0.0,
    weighted: bool = True,
) -> Track:
    """Follow the target, resampling after every accepted measurement.

    Parameters
    ----------
    log : Log from `target_log`
    bel : Particles (D, M), or (D, B, M) for B runs side by side
    motion, sensor, rng
        As in `pf.step`.
    scheme : Resampler or None
        None never resamples: the weights multiply up.
    gate : float, 1/px^2
        A measurement whose mean likelihood over the particles is below it is rejected.
    weighted : bool
        False ignores the weights in the estimate (an error to look at).
    """
    batch = bel.log_w.shape[:-1]
    T = len(log)
    error, ess, likelihood = (np.empty((T, *batch)) for _ in range(3))
    rejected = np.zeros((T, *batch), dtype=bool)
    assert log.truth is not None
    for k, (_, u, z, _) in enumerate(log):
        bel = pf.predict(bel, u, motion, rng)
        new, log_evidence = pf.update(bel, z, sensor)
        likelihood[k] = np.exp(log_evidence)
        rejected[k] = likelihood[k] < gate
        keep = rejected[k][..., None]
        bel = pf.Particles(bel.state, np.where(keep, bel.log_w, new.log_w))
        ess[k] = bel.ess
        w = bel.w if weighted else np.full(bel.log_w.shape, 1 / bel.M)
        mean = np.einsum("d...m,...m->d...", bel.state[:2], w)
        error[k] = np.hypot(*(mean - log.truth[:2, k].reshape(2, *(1,) * len(batch))))
        if scheme is not None:
            bel = pf.resample(bel, _row_by_row(scheme), rng, where=~rejected[k])
    return Track(error, ess, likelihood, rejected, bel)


def _row_by_row(scheme: Resampler) -> Resampler:
    """A scheme that may know only single sets and their own size (a student's), for batches."""

    def rows(w: Array, rng: np.random.Generator, n: int) -> NDArray[np.int64]:
        if w.ndim == 1:
            return scheme(w, rng)
        return np.stack([scheme(row, rng) for row in w])

    return scheme if scheme in pf.SCHEMES.values() else rows


__all__ = [
    "AREA",
    "FRAMES",
    "HEIGHT",
    "TURN",
    "WIDTH",
    "CircleTarget",
    "FixedTarget",
    "LineTarget",
    "Track",
    "anywhere",
    "around",
    "target_log",
    "track",
]
