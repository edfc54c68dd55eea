"""Q7 and Q8: without process noise, and without resampling."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, experiment
from pfkit.labs.statistics import shaped
from pfkit.labs.target import anywhere, around, target_log, track

Q7 = Question("No process noise, fixed target")

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]


def _collapse(f, rng, runs):
    pairs = [shaped(f(sigma, rng, runs), 2, runs) for sigma in (0.0, 1.0)]
    return np.stack(pairs).transpose(2, 0, 1)


q7a = Prediction("""Resampling each of 400 frames, no process noise: distinct particles and
         ESS
    a  Both stay high: the model is exact
    b* Distinct particles fall to one or two; the ESS ends at 100 of 100
    c  Both fall to one
    d  Distinct particles stay many; the ESS falls""")


@experiment(
    """Distinct particles and ESS at the end
    Two rows: how many different particles, and the last ESS.
    np.unique of one row of x counts different particles.
    [[len(np.unique(row)) for row in run.bel.state[0]], run.ess[-1]].""",
    id="q7b",
    after=q7a,
    points=2,
    claim="without process noise at most 5 of 100 distinct particles are left, while the "
    "ESS is 100; with noise of 1 px more than 60 are distinct",
    test="largest count over runs <= 5; mean ESS > 97; smallest count with noise > 60",
    runs=5,
    pool=500,
    margin="1 or 2 distinct against 5; ESS 100; 81 (sd 1.8) against 60: 11 standard errors",
    measure=_collapse,
)
def collapse(sigma, rng, runs):
    """Distinct particles and ESS after 400 frames, for process noise ``sigma``: (2, runs)."""
    bel = around(HOME, (runs, 100), rng, sigma=20.0)
    found = track(FILM[:400], bel, pf.FixedTarget(sigma), pf.Position(3.0), rng)
    x = found.bel.state[0]
    return np.array([[len(np.unique(row)) for row in x], found.ess[-1]])


collapse.holds(
    "no noise: at most 5 of 100 particles are distinct",
    lambda x: x[:, 0, 0].max() <= 5 or f"{x[:, 0, 0].max():.0f} are",
)
collapse.holds(
    "and the ESS says 100", lambda x: x[:, 0, 1].mean() > 97 or f"it says {x[:, 0, 1].mean():.0f}"
)
collapse.holds(
    "noise of 1 px: more than 60 are distinct",
    lambda x: x[:, 1, 0].min() > 60 or f"{x[:, 1, 0].min():.0f} are",
)


@collapse.wrong(
    """does not resample, so nothing can be lost
    All your particles are distinct, yet the ESS is tiny.
    The question resamples at every frame.
    Leave the scheme of lab.track at its default.""",
    when=lambda x: x[:, 0, 0].min() > 60 and x[:, 0, 1].mean() < 50,
)
def never_resampled(sigma, rng, runs):
    bel = around(HOME, (runs, 100), rng, sigma=20.0)
    found = track(FILM[:400], bel, pf.FixedTarget(sigma), pf.Position(3.0), rng, None)
    return np.array([[len(np.unique(row)) for row in found.bel.state[0]], found.ess[-1]])


collapse.wrong("""noise-fixed: does not use its argument: both cases have noise
    Your two cases look alike.
    Where does sigma enter the motion model?
    pf.FixedTarget(sigma).""")(
    lambda sigma, rng, runs: collapse(1.0, rng, runs),
    when=lambda x: x[:, 0, 0].min() > 60 and x[:, 0, 1].mean() > 50,
)

q7c = Choice("""Why is the ESS blind to this?
    a* It looks at weights only, and copies of one particle weigh the same
       = Yes: equal weights give ESS = M, even if there is one particle M times.
    b  It is computed before the update
       = It is computed after the update; the weights are still all equal.
    c  It needs more particles to be precise
       = It is computed exactly; it answers another question.
    d  The log-weights underflow
       = Log-weights do not underflow here; they are simply all equal.""")

Q8 = Question("No resampling")

q8a = Prediction("""Order of the errors: plain mean (A) and weighted mean (B) without
         resampling, resampled (C)
    a* A far worse than B, B far worse than C
    b  A about as bad as B, both far worse than C
    c  B about as good as C: weights do the same work as copies
    d  A, B and C alike""")


@experiment(
    """Three filters
    Three rows, one number per run in each.
    scheme=None never resamples; weighted=False takes the plain mean.
    lab.track(...).error[100:].mean(axis=0) for each of the three.""",
    id="q8b",
    after=q8a,
    points=2,
    claim="plain mean above 150 px, weighted between 5 and 60 px, resampled below 1 px",
    test="means over runs within these bands",
    runs=10,
    pool=250,
    margin="201 (sd 2.7), 19.8 (2.3), .573 (.006) px: at least 6 standard errors",
    measure=lambda f, rng, runs: shaped(f(rng, runs), 3, runs).T,
)
def three_filters(rng, runs):
    """Mean errors of frames 100 to 200: plain and weighted without resampling; resampled."""
    motion, sensor = pf.FixedTarget(1.4), pf.Position(3.0)
    rows = []
    for scheme, weighted in ((None, False), (None, True), (pf.systematic, True)):
        bel = anywhere((runs, 300), rng)
        found = track(FILM[:200], bel, motion, sensor, rng, scheme, weighted=weighted)
        rows.append(found.error[100:].mean(axis=0))
    return np.array(rows)


three_filters.holds(
    "plain mean without resampling: above 150 px",
    lambda x: x[:, 0].mean() > 150 or f"{x[:, 0].mean():.1f} px",
)
three_filters.holds(
    "weighted mean without resampling: between 5 and 60 px",
    lambda x: 5 < x[:, 1].mean() < 60 or f"{x[:, 1].mean():.1f} px",
)
three_filters.holds(
    "resampled: below 1 px", lambda x: x[:, 2].mean() < 1 or f"{x[:, 2].mean():.2f} px"
)
three_filters.wrong("""always-resampled: resamples in all three cases
    Your first two errors are as small as the third.
    scheme=None switches resampling off.
    Pass scheme=None for the first two.""")(
    lambda rng, runs: np.tile(three_filters(rng, runs)[2], (3, 1)),
    when=lambda x: x[:, 0].mean() < 2 and x[:, 1].mean() < 2,
)
three_filters.wrong("""weights-ignored: ignores the weights in the second case, too
    Your first two errors are alike.
    Without resampling, all that was measured sits in the weights.
    weighted=False belongs to the first case only.""")(
    lambda rng, runs: three_filters(rng, runs)[[0, 0, 2]], when=lambda x: x[:, 1].mean() > 100
)
