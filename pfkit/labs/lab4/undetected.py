"""Q16: outliers that nobody detects."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, experiment
from pfkit.labs.statistics import shaped
from pfkit.labs.target import AREA, anywhere, around, target_log, track

Q16 = Question("Outliers that nobody detects")

FALSE = target_log("fixed", "outliers")
HOME = FALSE.start[:2]


def _middle(x):
    return np.median(x, axis=0)


@experiment(
    """Naive, mixture, gate from a known start, gate from anywhere
    Four rows of medians over frames, one number per run in each.
    Only the sensor, the gate and the start differ.
    np.median(lab.track(...).error, axis=0) for each.""",
    id="q16a",
    points=2,
    claim="naive above 5 px; mixture and gate from a known start below 1 px; "
    "the same gate from anywhere above 100 px",
    test="medians over runs",
    runs=5,
    pool=250,
    margin="28.7 (sd 1.0), .66 (.02), .65 (.03), 199 (6) px: over 14 standard errors",
    measure=lambda f, rng, runs: shaped(f(rng, runs), 4, runs).T,
)
def four_filters(rng, runs):
    """Median error of 200 frames, half of them false: four filters, one number per run."""
    motion, sensor = pf.FixedTarget(1.4), pf.Position(5.0)
    mixed = pf.OutlierMixture(sensor, 0.5, 1 / AREA)
    known = around(HOME, (runs, 200), rng, sigma=5.0)
    film = FALSE[:200]
    results = (
        track(film, known, motion, sensor, rng),
        track(film, known, motion, mixed, rng),
        track(film, known, motion, sensor, rng, gate=1e-4),
        track(film, anywhere((runs, 200), rng), motion, sensor, rng, gate=1e-4),
    )
    return np.array([np.median(r.error, axis=0) for r in results])


four_filters.holds("naive: above 5 px", lambda x: _middle(x)[0] > 5 or f"{_middle(x)[0]:.1f} px")
four_filters.holds("mixture: below 1 px", lambda x: _middle(x)[1] < 1 or f"{_middle(x)[1]:.2f} px")
four_filters.holds(
    "gate from a known start: below 1 px", lambda x: _middle(x)[2] < 1 or f"{_middle(x)[2]:.2f} px"
)
four_filters.holds(
    "gate from anywhere: above 100 px, it never opens",
    lambda x: _middle(x)[3] > 100 or f"{_middle(x)[3]:.1f} px",
)
four_filters.wrong("""no-gate: has a gate that is never closed
    Your gate from a known start is as bad as no gate.
    Which argument of lab.track sets the threshold?
    gate=1e-4.""")(
    lambda rng, runs: four_filters(rng, runs)[[0, 1, 0, 0]],
    when=lambda x: 5 < _middle(x)[2] < 100 and _middle(x)[1] < 1,
)
four_filters.wrong("""order: returns the rows in another order
    Which of your rows is above 100 px? It belongs at the end.
    Naive, mixture, gate from a known start, gate from anywhere.
    Return the rows in the order of the list in the question.""")(
    lambda rng, runs: four_filters(rng, runs)[[0, 2, 3, 1]],
    when=lambda x: _middle(x)[:3].max() > 100,
)
four_filters.wrong("""known-start-always: starts the last filter near the truth, too
    Your last two filters are the same.
    What does a gate see if the filter does not know where the target is?
    lab.anywhere((runs, 200), rng) for the last one.""")(
    lambda rng, runs: four_filters(rng, runs)[[0, 1, 2, 2]], when=lambda x: _middle(x)[3] < 5
)

q16b = Choice("""A gate that works from a known start locks the filter out from anywhere.
         What would you build in?
    a  A lower threshold, found by trial
       = It must lie below 1/area at the start and above it later: no constant does.
    b  No gate at all
       = Then half of the measurements drag the filter away.
    c  More particles
       = The mean likelihood from anywhere is about 1/area for any number.
    d* A mixture in the likelihood, which needs no threshold and lets a lost filter listen
       = Yes: (1 - epsilon) N + epsilon / area, with both constants from the sensor.""")
