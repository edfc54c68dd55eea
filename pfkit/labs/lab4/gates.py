"""Q15: what moves a gate."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Numeric, Prediction, Question, experiment
from pfkit.labs.statistics import shaped
from pfkit.labs.target import anywhere, around, target_log, track

Q15 = Question("What moves the detector?")

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]
BELIEVED = (1e-4, 1.0, 100.0, 1000.0, 2000.0, 1e4)

q15a = Prediction("""Rejected share of honest frames as the believed sensor variance grows
    a  It falls: a modest sensor forgives
    b  It rises
    c* It falls from nearly all to none, then jumps to all
    d  It does not depend on it""")


@experiment(
    """A U-shape
    lab.track(..., gate=1e-4).rejected is True where the gate was closed.
    One number per run: the mean over frames.
    pf.Position(np.sqrt(variance)).""",
    id="q15b",
    after=q15a,
    points=2,
    claim="above .8 at variance .0001, below .05 from 1 to 1,000, all at 2,000 and 10,000",
    test="mean share over runs at each variance",
    runs=4,
    pool=250,
    margin=".992 (sd .004), 0, 1: over 12 standard errors",
    measure=lambda f, rng, runs: np.stack(
        [shaped(f(v, rng, runs), runs) for v in BELIEVED], axis=1
    ),
)
def rejected(variance, rng, runs):
    """Share of 150 honest frames that a gate at 1e-4 rejects; known start, target stands still."""
    bel = around(HOME, (runs, 300), rng, sigma=1.0)
    sensor = pf.Position(np.sqrt(variance))
    run = track(FILM[:150], bel, pf.FixedTarget(1.4), sensor, rng, gate=1e-4)
    return run.rejected.mean(axis=0)


rejected.holds(
    "an overconfident sensor: more than .8 rejected",
    lambda x: x[:, 0].mean() > 0.8 or f"{x[:, 0].mean():.2f}",
)
rejected.holds(
    "in between: below .05",
    lambda x: x[:, 1:4].mean(0).max() < 0.05 or f"{x.mean(0)[1:4].round(2)}",
)
rejected.holds(
    "too modest: all rejected", lambda x: bool((x[:, 4:] == 1).all()) or f"{x.mean(0)[4:].round(2)}"
)
rejected.wrong("""counts: counts frames, where a share is asked for
    A share lies between 0 and 1.
    Divide by the number of frames.
    run.rejected.mean(axis=0), not sum.""")(
    lambda v, rng, runs: 150 * rejected(v, rng, runs), when=lambda x: x.max() > 1
)
rejected.wrong("""accepted: gives the share that is accepted
    Your curve is upside down.
    rejected is True where the gate was closed.
    run.rejected.mean(axis=0), without one minus.""")(
    lambda v, rng, runs: 1 - rejected(v, rng, runs),
    when=lambda x: x[:, 1:4].mean() > 0.95 and x[:, 4:].mean() < 0.05,
)


@rejected.wrong(
    """starts anywhere, where the mean likelihood is about 1/area for any sensor
    Your gate never opens. How likely is any measurement if you know nothing?
    1/area is 3.3e-6, far below the threshold of 1e-4.
    Start around the truth: lab.around(lab.film.start[:2], (runs, 300), rng).""",
    when=lambda x: x[:, 2:].mean() > 0.95 and x[:, 1].mean() > 0.02,
)
def from_anywhere(v, rng, runs):
    run = track(
        FILM[:150],
        anywhere((runs, 300), rng),
        pf.FixedTarget(1.4),
        pf.Position(np.sqrt(v)),
        rng,
        gate=1e-4,
    )
    return run.rejected.mean(axis=0)


rejected.wrong("""variance-as-sd: passes the variance where a standard deviation is wanted
    Your gate is closed at 100 px^2 already. What is the sd there?
    pf.Position wants a standard deviation; you get a variance.
    pf.Position(np.sqrt(variance)).""")(
    lambda v, rng, runs: rejected(v**2, rng, runs),
    when=lambda x: x[:, 2:].mean() > 0.95 and x[:, 1].mean() <= 0.02,
)
rejected.wrong("""no-gate: has a gate that is never closed
    You reject nothing at any variance.
    Which argument of lab.track sets the threshold?
    gate=1e-4.""")(lambda v, rng, runs: np.zeros(runs), when=lambda x: x.max() == 0)

q15c = Numeric(
    """Variance at which even a perfect hit has a density of 1e-4
    What is the highest value of the density in two dimensions?
    The peak is 1/(2 pi variance).
    variance = 1/(2 pi 1e-4).""",
    1e4 / (2 * np.pi),
    tol=5.0,
    unit="px^2",
)
q15c.wrong("""one-dimension: uses the peak of a one-dimensional Gaussian
    The measurement has two components.
    In two dimensions the peak is 1/(2 pi variance), without a root.
    variance = 1/(2 pi 1e-4).""")(
    1e8 / (2 * np.pi), when=lambda x: abs(x / (1e8 / (2 * np.pi)) - 1) < 0.01
)
q15c.wrong("""deviation: is a standard deviation
    Square your number.
    The unit asked for is px^2.
    variance = 1/(2 pi 1e-4).""")(
    np.sqrt(1e4 / (2 * np.pi)), when=lambda x: abs(x - np.sqrt(1e4 / (2 * np.pi))) < 1
)
q15c.wrong("""no-two-pi: leaves 2 pi out
    Write the constant of the density down.
    The peak is 1/(2 pi variance).
    variance = 1/(2 pi 1e-4).""")(1e4)
