"""Q9 and Q10: what the filter believes about its noise."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, experiment
from pfkit.labs.lab4 import given as lab
from pfkit.labs.response import same_mean, same_scatter
from pfkit.labs.target import target_log

Q9 = Question("Modelled sensor noise")

FILM = target_log("fixed", "low")


def linear_errors(bel, variance, rng, frames):
    """Errors (frames, runs) with weights in the linear domain; all zero becomes all equal."""
    state, errors = bel.state, []
    for z in FILM.z[:frames]:
        state = state + 1.4 * rng.standard_normal(state.shape)
        d2 = ((z.reshape(2, 1, 1) - state) ** 2).sum(axis=0)
        with np.errstate(under="ignore"):
            w = np.exp(-d2 / (2 * variance))
        w[w.sum(axis=1) == 0] = 1.0
        ancestors = pf.systematic(w / w.sum(axis=1, keepdims=True), rng)
        state = np.take_along_axis(state, ancestors[None], axis=-1)
        errors.append(np.hypot(*(state.mean(axis=-1) - FILM.start[:2, None])))
    return np.array(errors)


def _sensors(rng):
    """Believed variances: far too small, about right, too large, far too large."""
    variance = 10 ** rng.uniform([-4, -0.3, 1.3, 2.6], [-3.5, 0.4, 1.9, 2.8])
    M = rng.integers([60, 20, 25, 60], [90, 30, 40, 90])
    return [(float(f"{v:.3g}"), int(m)) for v, m in zip(variance, M, strict=True)]


q9a = Prediction("""True variance 1 px^2. Which believed variance gives the smallest error?
    a  0.0001: the surest sensor
    b  0.01
    c  1: the true one
    d* 100: far too large""")


@experiment(
    """Error against the believed sensor variance
    One number per run: the mean error of frames 50 to 120.
    pf.Position wants a standard deviation; you get a variance.
    pf.Position(np.sqrt(variance)).""",
    id="q9b",
    after=q9a,
    points=2,
    claim="the error follows the believed variance and the number of particles",
    test="mean within 5 standard errors of a right experiment's at each of four settings, "
    "scatter within a factor of 5",
    runs=24,
    pool=900,
    settings=_sensors,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, four means and their sum: 1e-4 by Student's law",
)
def sensor_sweep(variance, M, rng, runs):
    """Mean error in px of frames 50 to 120, one per run."""
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=100.0)
    motion, sensor = pf.FixedTarget(1.4), pf.Position(np.sqrt(variance))
    return lab.track(lab.film[:120], bel, motion, sensor, rng).error[50:].mean(axis=0)


sensor_sweep.holds("the error follows variance and M", same_mean(5.0))
sensor_sweep.holds("the runs scatter as independent filters do", same_scatter(5.0))


def _settled(motion, sensor, M, rng, runs, first=50, film=FILM):
    bel = lab.around(FILM.start[:2], (runs, M), rng, sigma=100.0)
    return lab.track(film[:120], bel, motion, sensor, rng).error[first:].mean(axis=0)


@sensor_sweep.wrong("""passes the variance where a standard deviation is wanted
    For which variance would that make no difference?
    At 100 px^2 the sensor of your filter has an sd of 100 px.
    pf.Position(np.sqrt(variance)).""")
def variance_as_sd(variance, M, rng, runs):
    return sensor_sweep(variance**2, M, rng, runs)


@sensor_sweep.wrong("""believes 9 px^2, whatever it is asked
    Does your function use the variance?
    The variance is what the sensor believes.
    pf.Position(np.sqrt(variance)).""")
def variance_unused(variance, M, rng, runs):
    return sensor_sweep(9.0, M, rng, runs)


@sensor_sweep.wrong("""varies the process noise instead of the sensor noise
    Which noise did you change?
    The question changes what the sensor model believes.
    pf.FixedTarget(1.4) stays; pf.Position(np.sqrt(variance)) changes.""")
def process_noise(variance, M, rng, runs):
    return _settled(pf.FixedTarget(np.sqrt(variance)), pf.Position(1.0), M, rng, runs)


@sensor_sweep.wrong("""has 200 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.around(lab.film.start[:2], (runs, M), rng, sigma=100.0).""")
def always_200(variance, M, rng, runs):
    return sensor_sweep(variance, 200, rng, runs)


@sensor_sweep.wrong("""averages over all frames, the search included
    What do the first frames cost, before the filter has found the target?
    The question asks for frames 50 to 120.
    error[50:].mean(axis=0).""")
def all_frames(variance, M, rng, runs):
    return _settled(pf.FixedTarget(1.4), pf.Position(np.sqrt(variance)), M, rng, runs, first=0)


@sensor_sweep.wrong("""linear-weights: loses all weights to underflow and then resamples at
         random
    Your errors at small variances are tens of pixels. What is exp(-1000)?
    All weights were 0, and 'all zero, so all equal' forgets the measurement.
    Work with log-weights, as pf.update does.""")
def linear_weights(variance, M, rng, runs):
    bel = lab.around(FILM.start[:2], (runs, M), rng, sigma=100.0)
    return linear_errors(bel, variance, rng, 120)[50:].mean(axis=0)


def _drawn(variance):
    """The median errors that the text's figure shows, read off for any variance."""
    at, error = [-4, -2, 0, 2, 4], [1.22, 1.24, 0.95, 0.45, 3.41]
    return np.interp(np.log10(variance), at, error)


@sensor_sweep.refuses("the errors of the figure")
def told(variance, M, rng, runs):
    return np.full(runs, _drawn(variance))


@sensor_sweep.refuses("the errors of the figure, with scatter")
def told_with_scatter(variance, M, rng, runs):
    return _drawn(variance) * (1 + 0.05 * rng.standard_normal(runs))


@sensor_sweep.refuses("random in range")
def guessed(variance, M, rng, runs):
    return rng.uniform(0.4, 1.4, runs)


@sensor_sweep.refuses("half as many particles")
def half_as_many(variance, M, rng, runs):
    return sensor_sweep(variance, M // 2, rng, runs)


@sensor_sweep.refuses("one run, repeated")
def one_run(variance, M, rng, runs):
    return np.repeat(sensor_sweep(variance, M, rng, 1), runs)


@sensor_sweep.refuses("the error of the measurements")
def measured(variance, M, rng, runs):
    z = np.array(FILM.z[50:120])[:, :, 0]
    return np.full(runs, np.hypot(*(z - FILM.start[:2]).T).mean())


@sensor_sweep.refuses("the last frame only")
def last_frame(variance, M, rng, runs):
    return _settled(pf.FixedTarget(1.4), pf.Position(np.sqrt(variance)), M, rng, runs, first=119)


@sensor_sweep.refuses("no process noise")
def no_process_noise(variance, M, rng, runs):
    return _settled(pf.FixedTarget(0.0), pf.Position(np.sqrt(variance)), M, rng, runs)


q9c = Choice("""With weights exp(-d^2/2 sigma^2), all 0 at sigma^2 = .0001: what failed?
    a  Statistics: a sensor that is too sure makes any filter diverge
       = With log-weights the same sure sensor just copies the measurement.
    b* Arithmetic: the weights underflowed; with log-weights the error is 1.3 px
       = Yes: the famous failure is underflow; overconfidence alone costs far less.
    c  The motion model: it needs more noise
       = The motion model was the same in both filters.
    d  Resampling: it should have been systematic
       = No scheme can choose well between weights that are all 0.""")

Q10 = Question("Modelled process noise")


def _motions(rng):
    """Process variances: too small to search, about right, too large; particles and frames."""
    variance = 10 ** rng.uniform([-2.3, -0.4, 1.7], [-1.7, 0.4, 2.3])
    M = rng.integers([100, 80, 80], [150, 120, 120])
    frames = rng.integers(120, 180, 3)
    chosen = zip(variance, M, frames, strict=True)
    return [(float(f"{v:.3g}"), int(m), int(t)) for v, m, t in chosen]


q10a = Prediction("""Which process variance wins, by the mean of all frames (A) and of the last
         hundred (B)?
    a  The smallest wins both: the target does stand still
    b  1 px^2 wins both
    c* 1 px^2 wins A, .01 px^2 wins B
    d  100 px^2 wins both""")


@experiment(
    """Error against the modelled process variance
    Two rows: error.mean(axis=0) and error[-100:].mean(axis=0).
    pf.FixedTarget wants a standard deviation; you get a variance.
    pf.FixedTarget(np.sqrt(variance)).""",
    id="q10b",
    after=q10a,
    points=2,
    claim="both errors follow the modelled variance, the particles and the frames",
    test="both means within 5 standard errors of a right experiment's at each of three settings, "
    "scatter within a factor of 5",
    runs=24,
    pool=900,
    settings=_motions,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, six means and their sum: 1.5e-4 by Student's law",
)
def motion_sweep(variance, M, frames, rng, runs):
    """Mean error of all frames and of the last hundred: shape (2, runs)."""
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=100.0)
    motion, sensor = pf.FixedTarget(np.sqrt(variance)), pf.Position(5.0)
    error = lab.track(lab.film[:frames], bel, motion, sensor, rng).error
    return np.array([error.mean(axis=0), error[-100:].mean(axis=0)])


motion_sweep.holds("both errors follow variance, M and frames", same_mean(5.0))
motion_sweep.holds("the runs scatter as independent filters do", same_scatter(5.0))


def _both(motion, sensor, M, frames, rng, runs, sigma=100.0, last=100):
    bel = lab.around(FILM.start[:2], (runs, M), rng, sigma=sigma)
    error = lab.track(FILM[:frames], bel, motion, sensor, rng).error
    return np.array([error.mean(axis=0), error[-last:].mean(axis=0)])


@motion_sweep.wrong("""passes the variance where a standard deviation is wanted
    For which variance would that make no difference?
    At 100 px^2 your particles jump 100 px per frame.
    pf.FixedTarget(np.sqrt(variance)).""")
def variance_for_sd(variance, M, frames, rng, runs):
    return motion_sweep(variance**2, M, frames, rng, runs)


@motion_sweep.wrong("""returns the rows in the other order
    Which row holds the start of the film, where errors are large?
    All frames first, then the last hundred.
    np.array([error.mean(axis=0), error[-100:].mean(axis=0)]).""")
def rows_swapped(variance, M, frames, rng, runs):
    return motion_sweep(variance, M, frames, rng, runs)[::-1]


@motion_sweep.wrong("""models a process variance of 2 px^2, whatever it is asked
    Does your function use the variance?
    The check chooses the modelled noise.
    pf.FixedTarget(np.sqrt(variance)).""")
def always_two(variance, M, frames, rng, runs):
    return motion_sweep(1.4**2, M, frames, rng, runs)


@motion_sweep.wrong("""varies the sensor noise instead of the process noise
    Which noise did you change?
    The sensor is fixed at sd 5 px here.
    pf.FixedTarget(np.sqrt(variance)) changes; pf.Position(5.0) stays.""")
def sensor_noise(variance, M, frames, rng, runs):
    return _both(pf.FixedTarget(1.4), pf.Position(np.sqrt(variance)), M, frames, rng, runs)


@motion_sweep.wrong("""scores the first hundred frames, where the last are asked for
    Your second row still holds the search.
    A slice that counts from the end starts with a minus.
    error[-100:].mean(axis=0).""")
def first_hundred(variance, M, frames, rng, runs):
    bel = lab.around(FILM.start[:2], (runs, M), rng, sigma=100.0)
    motion, sensor = pf.FixedTarget(np.sqrt(variance)), pf.Position(5.0)
    error = lab.track(FILM[:frames], bel, motion, sensor, rng).error
    return np.array([error.mean(axis=0), error[:100].mean(axis=0)])


@motion_sweep.wrong("""starts close to the truth, so there is nothing to search for
    Where do your particles lie before the first frame?
    The start is poor: sd 100 px.
    lab.around(lab.film.start[:2], (runs, M), rng, sigma=100.0).""")
def good_start(variance, M, frames, rng, runs):
    motion, sensor = pf.FixedTarget(np.sqrt(variance)), pf.Position(5.0)
    return _both(motion, sensor, M, frames, rng, runs, sigma=1.0)


@motion_sweep.refuses("the errors of the text's table")
def told_rows(variance, M, frames, rng, runs):
    at = np.log10(variance)
    rows = ([3.58, 0.87, 0.51, 1.22, 7.36], [3.25, 0.18, 0.47, 1.20, 7.76])
    return np.array([np.full(runs, np.interp(at, [-4, -2, 0, 2, 4], row)) for row in rows])


@motion_sweep.refuses("the same with scatter")
def told_rows_with_scatter(variance, M, frames, rng, runs):
    noise = 1 + 0.1 * rng.standard_normal((2, runs))
    return told_rows(variance, M, frames, rng, runs) * noise


@motion_sweep.refuses("random in range")
def guessed_rows(variance, M, frames, rng, runs):
    return rng.uniform(0.2, 4.0, (2, runs))


@motion_sweep.refuses("half as many particles")
def half_the_particles(variance, M, frames, rng, runs):
    return motion_sweep(variance, M // 2, frames, rng, runs)


@motion_sweep.refuses("one run, repeated")
def one_run_twice(variance, M, frames, rng, runs):
    return np.repeat(motion_sweep(variance, M, frames, rng, 1), runs, axis=1)


@motion_sweep.refuses("the last score in both rows")
def one_score(variance, M, frames, rng, runs):
    return motion_sweep(variance, M, frames, rng, runs)[[1, 1]]


@motion_sweep.refuses("the last frame only")
def the_last_frame(variance, M, frames, rng, runs):
    motion, sensor = pf.FixedTarget(np.sqrt(variance)), pf.Position(5.0)
    return _both(motion, sensor, M, frames, rng, runs, last=1)
