"""Q11 and Q12: wrong models, and what particles cannot repair."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, experiment
from pfkit.labs.lab4 import given as lab
from pfkit.labs.response import same_mean, same_scatter
from pfkit.labs.target import target_log

Q11 = Question("Motion model and process noise")

CIRCLE = target_log("circle", "high")


MODELS = ("fixed", "line", "circle")


def _ratios(rng):
    """Each model with two ratios: fixed with less than it wants, the others with more."""
    ratio = 10 ** rng.uniform(
        [-1.9, -1.1, -2.4, -1.1, -2.4, -1.1], [-1.5, -0.7, -1.9, -0.7, -1.9, -0.7]
    )
    M = rng.integers(20, 40, 6)
    models = np.repeat(MODELS, 2)
    return [(str(m), float(f"{r:.2g}"), int(n)) for m, r, n in zip(models, ratio, M, strict=True)]


q11a = Prediction("""On the circling target: which model wants the largest process noise?
    a* Fixed, the most wrong
    b  Line
    c  Circle, the most flexible
    d  All want the same: the noise is a property of the target""")


@experiment(
    """Error against the ratio of process to sensor variance, per model
    One number per run: the mean error of frames 50 to 120.
    lab.model_of(name, sigma) and lab.start_of(name, log, shape, rng) help.
    sigma = np.sqrt(400 * ratio).""",
    id="q11b",
    after=q11a,
    points=2,
    claim="the error follows the model, the ratio and the number of particles",
    test="mean within 5 standard errors of a right experiment's at each of six settings, "
    "scatter within a factor of 8",
    runs=16,
    pool=600,
    settings=_ratios,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, six means and their sum: 1.6e-4 by Student's law",
)
def ratio_sweep(model, ratio, M, rng, runs):
    """Mean error in px of frames 50 to 120 on the circle, one per run."""
    bel = lab.start_of(model, lab.circle, (runs, M), rng)
    motion = lab.model_of(model, np.sqrt(400 * ratio))
    run = lab.track(lab.circle[:120], bel, motion, pf.Position(20.0), rng)
    return run.error[50:].mean(axis=0)


ratio_sweep.holds("the error follows model, ratio and M", same_mean(5.0))
ratio_sweep.holds("the runs scatter as independent filters do", same_scatter(8.0))


@ratio_sweep.wrong("""has a ratio of .05, whatever it is asked
    Does your function use the ratio?
    The ratio says how much process noise the model has.
    lab.model_of(model, np.sqrt(400 * ratio)).""")
def ratio_unused(model, ratio, M, rng, runs):
    return ratio_sweep(model, 0.05, M, rng, runs)


@ratio_sweep.wrong("""takes ratio times 400 as a standard deviation
    How far do your particles jump in one frame at ratio .25?
    The ratio is one of variances.
    sigma = np.sqrt(400 * ratio).""")
def ratio_as_sd(model, ratio, M, rng, runs):
    return ratio_sweep(model, 400 * ratio**2, M, rng, runs)


@ratio_sweep.wrong("""takes the ratio as one of standard deviations
    Your particles jump less than the question says. What is 20 px squared?
    Process variance is ratio times 400 px^2.
    sigma = np.sqrt(400 * ratio).""")
def ratio_of_deviations(model, ratio, M, rng, runs):
    return ratio_sweep(model, ratio**2, M, rng, runs)


@ratio_sweep.wrong("""does not use its first argument: all models are the fixed one
    Does your function use the model?
    The name says which motion model to use.
    lab.model_of(model, sigma).""")
def one_model(model, ratio, M, rng, runs):
    return ratio_sweep("fixed", ratio, M, rng, runs)


@ratio_sweep.wrong("""has 200 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.start_of(model, lab.circle, (runs, M), rng).""")
def always_200(model, ratio, M, rng, runs):
    return ratio_sweep(model, ratio, 200, rng, runs)


@ratio_sweep.wrong("""has the process sd of a sensor with variance 1 px^2
    The ratio of which two variances is it?
    The sensor variance on this film is 20 px squared.
    sigma = np.sqrt(400 * ratio).""")
def of_one_pixel(model, ratio, M, rng, runs):
    return ratio_sweep(model, ratio / 400, M, rng, runs)


def _follow(model, ratio, M, rng, runs, film=CIRCLE, sensor=20.0):
    bel = lab.start_of(model, film, (runs, M), rng)
    motion = lab.model_of(model, np.sqrt(400 * ratio))
    return lab.track(film[:120], bel, motion, pf.Position(sensor), rng).error[50:].mean(axis=0)


@ratio_sweep.refuses("the errors of the figure")
def told(model, ratio, M, rng, runs):
    row = {"fixed": [77.2, 26.5, 10.3, 12.0], "line": [6.1, 6.9, 9.9, 12.3]}
    drawn = row.get(model, [5.1, 5.6, 8.9, 11.8])
    return np.full(runs, np.interp(np.log(ratio), np.log([0.0025, 0.01, 0.09, 0.25]), drawn))


@ratio_sweep.refuses("the errors of the figure, with scatter")
def told_with_scatter(model, ratio, M, rng, runs):
    return told(model, ratio, M, rng, runs) * (1 + 0.08 * rng.standard_normal(runs))


@ratio_sweep.refuses("random in range")
def guessed(model, ratio, M, rng, runs):
    return rng.uniform(5, 20, runs)


@ratio_sweep.refuses("a third of the particles")
def third(model, ratio, M, rng, runs):
    return ratio_sweep(model, ratio, M // 3, rng, runs)


@ratio_sweep.refuses("one run, repeated")
def one_run(model, ratio, M, rng, runs):
    return np.repeat(ratio_sweep(model, ratio, M, rng, 1), runs)


@ratio_sweep.refuses("the film with noise of 1 px")
def low_noise(model, ratio, M, rng, runs):
    return _follow(model, ratio, M, rng, runs, film=target_log("circle", "low"))


@ratio_sweep.refuses("a sensor believed at 5 px")
def sure_sensor(model, ratio, M, rng, runs):
    return _follow(model, ratio, M, rng, runs, sensor=5.0)


Q12 = Question("Precision and number of particles")


def _sizes(rng):
    """Each model with few particles, fixed and circle with many, too."""
    M = rng.integers([8, 12, 8, 50, 30], [14, 18, 14, 80, 50])
    models = (*MODELS, "fixed", "circle")
    return [(m, int(n)) for m, n in zip(models, M, strict=True)]


@experiment(
    """Three models with few and with many particles
    One number per run: the mean error of frames 50 to 150.
    Use the noise of the text for each model.
    lab.model_of(model, sigma, sigma_theta); lab.start_of(model, log, shape, rng).""",
    id="q12a",
    points=2,
    claim="the error follows the model and the number of particles",
    test="mean within 5 standard errors of a right experiment's at each of five settings, "
    "scatter within a factor of 8",
    runs=40,
    pool=900,
    settings=_sizes,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, five means and their sum: 6e-5 by Student's law",
)
def error_with(model, M, rng, runs):
    """Mean error in px of frames 50 to 150, each model with noise that suits it."""
    sigma, sigma_theta = {"fixed": (6.0, 0.0), "line": (1.0, 0.05), "circle": (0.5, 0.01)}[model]
    bel = lab.start_of(model, lab.circle, (runs, M), rng)
    motion = lab.model_of(model, sigma, sigma_theta)
    run = lab.track(lab.circle[:150], bel, motion, pf.Position(20.0), rng)
    return run.error[50:].mean(axis=0)


error_with.holds("the error follows model and M", same_mean(5.0))
error_with.holds("the runs scatter as independent filters do", same_scatter(8.0))


@error_with.wrong("""does not use the number of particles
    Your errors with few and with many particles agree.
    Where does M enter?
    lab.start_of(model, lab.circle, (runs, M), rng).""")
def number_unused(model, M, rng, runs):
    return error_with(model, 200, rng, runs)


def _with_noise(model, M, rng, runs, sigma, sigma_theta):
    bel = lab.start_of(model, CIRCLE, (runs, M), rng)
    motion = lab.model_of(model, sigma, sigma_theta)
    run = lab.track(CIRCLE[:150], bel, motion, pf.Position(20.0), rng)
    return run.error[50:].mean(axis=0)


@error_with.wrong("""gives all models the noise that suits the fixed one
    Which process noise does your circle have?
    An accurate model needs little noise; large noise throws that away.
    Use sigma 6, 1 and .5 px for fixed, line and circle.""")
def same_noise(model, M, rng, runs):
    return _with_noise(model, M, rng, runs, 6.0, 0.05)


@error_with.wrong("""gives all models the small noise that suits the circle
    Your fixed model has lost the target.
    A target that moves 2 px per frame leaves particles that hardly move.
    Use sigma 6, 1 and .5 px for fixed, line and circle.""")
def small_noise(model, M, rng, runs):
    return _with_noise(model, M, rng, runs, 0.5, 0.01)


@error_with.wrong("""follows the target with the circle, whatever model it is asked for
    Does your function use the model?
    The name says which motion model to use.
    lab.model_of(model, sigma, sigma_theta).""")
def always_circle(model, M, rng, runs):
    return error_with("circle", M, rng, runs)


@error_with.refuses("the errors of the text")
def told_errors(model, M, rng, runs):
    few, many = {"fixed": (11.9, 10.6), "line": (9.1, 7.8), "circle": (3.2, 3.6)}[model]
    return np.full(runs, few if M < 60 else many)


@error_with.refuses("the errors of the text, with scatter")
def told_errors_with_scatter(model, M, rng, runs):
    return told_errors(model, M, rng, runs) * (1 + 0.08 * rng.standard_normal(runs))


@error_with.refuses("random in range")
def guessed_errors(model, M, rng, runs):
    return rng.uniform(3, 13, runs)


@error_with.refuses("half as many particles")
def half_as_many(model, M, rng, runs):
    return error_with(model, M // 2, rng, runs)


@error_with.refuses("one run, repeated")
def one_filter(model, M, rng, runs):
    return np.repeat(error_with(model, M, rng, 1), runs)


@error_with.refuses("an error that falls with the root of M")
def by_the_root(model, M, rng, runs):
    one = {"fixed": 45.0, "line": 35.0, "circle": 20.0}[model] / np.sqrt(M)
    return one * (1 + 0.1 * rng.standard_normal(runs))


q12b = Choice("""Why does the line with 160 particles not reach the circle with 20?
    a  160 particles are too few for three dimensions
       = With 1,000 particles it gains a few tenths of a pixel more, not pixels.
    b  Systematic resampling favours the circle
       = Both use the same scheme.
    c* Its model is wrong at each step; the noise that mends this blurs the answer
       = Yes: particles lower the Monte-Carlo error, not the error of the model.
    d  The circle uses the true positions
       = It uses the true speed and rate; positions come from the measurements.""")
