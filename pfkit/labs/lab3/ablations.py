"""Q7 and Q8: without process noise, and without resampling."""

from __future__ import annotations

from typing import Any

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, experiment
from pfkit.labs.lab3 import given as lab
from pfkit.labs.response import same_mean, same_scatter

Q7 = Question("No process noise, fixed target")


def _noises(rng):
    """No noise for a few frames, two amounts of noise, no noise for many frames."""
    sigma = 0.0, rng.uniform(0.2, 0.5), rng.uniform(1.5, 3.0), 0.0
    M = rng.integers([60, 60, 90, 40], [90, 90, 120, 60])
    frames = rng.integers([2, 20, 20, 80], [5, 40, 40, 120])
    return [(float(s), int(m), int(t)) for s, m, t in zip(sigma, M, frames, strict=True)]


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
    claim="distinct particles and ESS follow the process noise, the particles and the frames",
    test="both means within 5.5 standard errors of a right experiment's at each of four settings, "
    "scatter within a factor of 5 where there is any",
    runs=24,
    pool=900,
    settings=_noises,
    together=True,
    false_fail=1e-3,
    margin="5.5 standard errors, eight means: 2e-5 by Student's law",
)
def collapse(sigma, M, frames, rng, runs):
    """Distinct particles and last ESS: shape (2, runs)."""
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=20.0)
    run = lab.track(lab.film[:frames], bel, pf.FixedTarget(sigma), pf.Position(3.0), rng)
    distinct = [len(np.unique(x)) for x in run.bel.state[0]]
    return np.array([distinct, run.ess[-1]])


collapse.holds("distinct particles and ESS follow sigma, M and frames", same_mean(5.5))
collapse.holds("the runs scatter as independent filters do", lambda x: same_scatter(5.0)(x[:, :3]))


def _last(bel, frames, sigma, rng, scheme=pf.systematic):
    return lab.track(
        lab.film[:frames], bel, pf.FixedTarget(sigma), pf.Position(3.0), rng, scheme=scheme
    )


def _distinct(state):
    return [len(np.unique(x)) for x in state[0]]


@collapse.wrong("""does not resample, so nothing can be lost
    All your particles are distinct, yet the ESS is tiny.
    The question resamples at every frame.
    Leave the scheme of lab.track at its default.""")
def never_resampled(sigma, M, frames, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=20.0)
    run = _last(bel, frames, sigma, rng, None)
    return np.array([_distinct(run.bel.state), run.ess[-1]])


@collapse.wrong("""does not use sigma: all cases have noise of 1 px
    Your cases with and without noise look alike.
    Where does sigma enter the motion model?
    pf.FixedTarget(sigma).""")
def noise_fixed(sigma, M, frames, rng, runs):
    return collapse(1.0, M, frames, rng, runs)


@collapse.wrong("""does not use sigma: no case has noise
    Your cases with and without noise look alike.
    Where does sigma enter the motion model?
    pf.FixedTarget(sigma).""")
def never_noise(sigma, M, frames, rng, runs):
    return collapse(0.0, M, frames, rng, runs)


@collapse.wrong("""follows 400 frames, whatever it is asked
    How many frames does the check ask for?
    What is lost in 400 frames may be there after three.
    lab.film[:frames].""")
def always_400(sigma, M, frames, rng, runs):
    return collapse(sigma, M, 400, rng, runs)


@collapse.wrong("""has 100 particles, whatever it is asked
    How many particles does the check ask for?
    The ESS is at most M.
    lab.around(start, (runs, M), rng, sigma=20.0).""")
def always_100(sigma, M, frames, rng, runs):
    return collapse(sigma, 100, frames, rng, runs)


@collapse.wrong("""takes the ESS after resampling, when all weights are equal again
    Your ESS is M in every case. Could it be anything else where you look?
    run.bel is what resampling left behind.
    run.ess[-1] is the ESS before the last resampling.""")
def after_resampling(sigma, M, frames, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=20.0)
    run = _last(bel, frames, sigma, rng)
    return np.array([_distinct(run.bel.state), run.bel.ess])


@collapse.wrong("""starts anywhere in the image
    How many of your particles are near the ball in the first frame?
    The question starts around the truth, with sd 20 px.
    lab.around(lab.film.start[:2], (runs, M), rng, sigma=20.0).""")
def from_anywhere(sigma, M, frames, rng, runs):
    run = _last(lab.anywhere((runs, M), rng), frames, sigma, rng)
    return np.array([_distinct(run.bel.state), run.ess[-1]])


@collapse.wrong("""returns the ESS first
    Which of your rows holds whole numbers only?
    The order asked for is: distinct particles, ESS.
    np.array([distinct, run.ess[-1]]).""")
def ess_first(sigma, M, frames, rng, runs):
    return collapse(sigma, M, frames, rng, runs)[::-1]


@collapse.refuses("the numbers of the figure, without a filter")
def remembered(sigma, M, frames, rng, runs):
    row = np.ones(runs)
    return np.array([row, M * row]) if sigma == 0 else M * np.array([0.84 * row, 0.88 * row])


@collapse.refuses("the same with scatter")
def remembered_with_scatter(sigma, M, frames, rng, runs):
    return remembered(sigma, M, frames, rng, runs) + rng.normal(0, 2, (2, runs))


@collapse.refuses("random in range")
def by_chance(sigma, M, frames, rng, runs):
    return np.array([rng.integers(1, M + 1, runs), rng.uniform(1, M, runs)])


@collapse.refuses("half as many particles")
def half_as_many(sigma, M, frames, rng, runs):
    return collapse(sigma, M // 2, frames, rng, runs)


@collapse.refuses("one run, repeated")
def repeated(sigma, M, frames, rng, runs):
    return np.repeat(collapse(sigma, M, frames, rng, 1), runs, axis=1)


@collapse.refuses("distinct particles in both rows")
def distinct_twice(sigma, M, frames, rng, runs):
    return collapse(sigma, M, frames, rng, runs)[[0, 0]]


@collapse.refuses("counts the distinct particles of all runs together")
def all_runs_together(sigma, M, frames, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=20.0)
    run = _last(bel, frames, sigma, rng)
    return np.array([np.full(runs, len(np.unique(run.bel.state[0]))), run.ess[-1]])


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


def _filters(rng):
    """Few particles with a sharp sensor model, many with a blunt one."""
    few, many = rng.integers([30, 120], [50, 160])
    sharp, blunt = rng.uniform([3, 20], [5, 30])
    return [(int(few), float(sharp)), (int(many), float(blunt))]


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
    claim="the three errors follow the number of particles and the modelled noise",
    test="each mean within 5 standard errors of a right experiment's at both settings, scatter "
    "within a factor of 3.5",
    runs=24,
    pool=600,
    settings=_filters,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, six means: 6e-5 by Student's law",
)
def three_filters(M, sigma, rng, runs):
    """Mean errors in px of A, B, C: shape (3, runs)."""
    rows = []
    for options in ({"scheme": None, "weighted": False}, {"scheme": None}, {}):
        bel = lab.anywhere((runs, M), rng)
        motion, sensor = pf.FixedTarget(1.4), pf.Position(sigma)
        run = lab.track(lab.film[:200], bel, motion, sensor, rng, **options)
        rows.append(run.error[100:].mean(axis=0))
    return np.array(rows)


three_filters.holds("the errors of A, B and C follow M and sigma", same_mean(5.0))
three_filters.holds("the runs scatter as independent filters do", same_scatter(3.5))


def _errors(M, sigma, rng, runs, first=100, **options):
    """Row of one filter: mean error from frame ``first`` on."""
    bel, motion = lab.anywhere((runs, M), rng), pf.FixedTarget(1.4)
    run = lab.track(lab.film[:200], bel, motion, pf.Position(sigma), rng, **options)
    return run.error[first:].mean(axis=0)


PLAIN: dict[str, Any] = {"scheme": None, "weighted": False}
WEIGHTED: dict[str, Any] = {"scheme": None}
RESAMPLED: dict[str, Any] = {}


@three_filters.wrong("""resamples in all three cases
    Your first two errors are as small as the third.
    scheme=None switches resampling off.
    Pass scheme=None for the first two.""")
def always_resampled(M, sigma, rng, runs):
    return np.array([_errors(M, sigma, rng, runs) for _ in range(3)])


@three_filters.wrong("""ignores the weights in the second case, too
    Your first two errors are alike.
    Without resampling, all that was measured sits in the weights.
    weighted=False belongs to the first case only.""")
def weights_ignored(M, sigma, rng, runs):
    return np.array([_errors(M, sigma, rng, runs, **o) for o in (PLAIN, PLAIN, RESAMPLED)])


@three_filters.wrong("""weights the first mean, too
    Your first two errors are alike.
    A takes the plain mean of its particles.
    weighted=False for A.""")
def weights_everywhere(M, sigma, rng, runs):
    return np.array([_errors(M, sigma, rng, runs, **o) for o in (WEIGHTED, WEIGHTED, RESAMPLED)])


@three_filters.wrong("""has its rows in another order
    Which of the three should be the worst?
    A: no resampling, plain mean. B: no resampling, weighted mean. C: resampled.
    Stack the errors as A, B, C.""")
def another_order(M, sigma, rng, runs):
    return three_filters(M, sigma, rng, runs)[::-1]


@three_filters.wrong("""averages over all 200 frames
    What does the first frame of C cost, before it has found the ball?
    The question asks for frames 100 to 200.
    run.error[100:].mean(axis=0).""")
def all_frames(M, sigma, rng, runs):
    options = (PLAIN, WEIGHTED, RESAMPLED)
    return np.array([_errors(M, sigma, rng, runs, 0, **o) for o in options])


@three_filters.wrong("""has 300 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.anywhere((runs, M), rng).""")
def always_300(M, sigma, rng, runs):
    return three_filters(300, sigma, rng, runs)


@three_filters.wrong("""has the sensor sd of the example, whatever it is asked
    Does your function use sigma?
    The check chooses the modelled noise of the sensor.
    pf.Position(sigma).""")
def always_three(M, sigma, rng, runs):
    return three_filters(M, 3.0, rng, runs)


@three_filters.wrong("""starts around the truth, so no filter has anything to find
    Where do your particles lie before the first frame?
    All three filters start anywhere in the image.
    lab.anywhere((runs, M), rng).""")
def known_start(M, sigma, rng, runs):
    rows = []
    for options in (PLAIN, WEIGHTED, RESAMPLED):
        bel, motion = lab.around(lab.film.start[:2], (runs, M), rng), pf.FixedTarget(1.4)
        run = lab.track(lab.film[:200], bel, motion, pf.Position(sigma), rng, **options)
        rows.append(run.error[100:].mean(axis=0))
    return np.array(rows)


@three_filters.wrong("""takes the plain mean of its particles in all three cases
    Which filter is it that ignores its weights?
    Before it resamples, C has learned something that only its weights know.
    weighted=False belongs to the first case only.""")
def plain_mean_in_all(M, sigma, rng, runs):
    options = (PLAIN, PLAIN, {"weighted": False})
    return np.array([_errors(M, sigma, rng, runs, **o) for o in options])


@three_filters.refuses("the plain mean in case C")
def plain_mean_in_c(M, sigma, rng, runs):
    options = (PLAIN, WEIGHTED, {"weighted": False})
    return np.array([_errors(M, sigma, rng, runs, **o) for o in options])


@three_filters.refuses("the three numbers of the text")
def told(M, sigma, rng, runs):
    return np.tile([[201.0], [19.8], [0.57]], runs)


@three_filters.refuses("the same with scatter")
def told_with_scatter(M, sigma, rng, runs):
    return np.abs(told(M, sigma, rng, runs) * (1 + 0.1 * rng.standard_normal((3, runs))))


@three_filters.refuses("random in range")
def guessed(M, sigma, rng, runs):
    return rng.uniform([[150], [5], [0]], [[250], [60], [1]], (3, runs))


three_filters.refuses("half as many particles")(
    lambda M, sigma, rng, runs: three_filters(M // 2, sigma, rng, runs)
)


@three_filters.refuses("one run, repeated")
def one_run(M, sigma, rng, runs):
    return np.repeat(three_filters(M, sigma, rng, 1), runs, axis=1)


@three_filters.refuses("makes two filters, and guesses the third")
def third_guessed(M, sigma, rng, runs):
    found = [_errors(M, sigma, rng, runs, **o) for o in (PLAIN, WEIGHTED)]
    return np.array([*found, np.full(runs, 0.57)])


@three_filters.refuses("the last frame only")
def last_frame(M, sigma, rng, runs):
    options = (PLAIN, WEIGHTED, RESAMPLED)
    return np.array([_errors(M, sigma, rng, runs, 199, **o) for o in options])
