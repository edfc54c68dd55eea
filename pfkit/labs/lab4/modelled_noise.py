"""Q9 and Q10: what the filter believes about its noise."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, experiment
from pfkit.labs.statistics import shaped
from pfkit.labs.target import anywhere, around, target_log, track

Q9 = Question("Modelled sensor noise")

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]
VARIANCES = (1e-4, 1e-2, 1.0, 100.0, 1e4)


def linear_weights(variance, rng, runs, M=300, frames=200):
    """Errors (frames, runs) with weights in the linear domain; all zero becomes all equal."""
    state = anywhere((runs, M), rng).state
    errors = []
    for k in range(frames):
        state = state + 1.4 * rng.standard_normal(state.shape)
        nu = FILM.z[k].reshape(2, 1, 1) - state
        with np.errstate(under="ignore"):
            w = np.exp(-0.5 * (nu**2).sum(axis=0) / variance)
        w[w.sum(axis=1) == 0] = 1.0
        ancestors = pf.systematic(w / w.sum(axis=1, keepdims=True), rng)
        state = np.take_along_axis(state, ancestors[None], axis=-1)
        errors.append(np.hypot(*(state.mean(axis=-1) - HOME[:, None])))
    return np.array(errors)


def _column(x):
    return np.median(x, axis=0)


q9a = Prediction("""True variance 1 px^2. Which believed variance gives the smallest error?
    a  0.0001: the surest sensor
    b  0.01
    c  1: the true one
    d* 100: far too large""")


@experiment(
    """Error against the believed sensor variance
    One number per run: the mean error of frames 50 to 200.
    pf.Position wants a standard deviation; you get a variance.
    pf.Position(np.sqrt(variance)).""",
    id="q9b",
    after=q9a,
    points=2,
    claim="understating by 100 or more copies the measurement (1.0 to 1.5 px); the "
    "smallest of the five errors is at 100 px^2, below .7 px; at 10,000 it rises again",
    test="medians over runs",
    runs=12,
    pool=500,
    margin="1.20 px (sd .005); .454 (.015) against .7; 1.22 (.13) against .45: 5.8 sd",
    measure=lambda f, rng, runs: np.stack(
        [shaped(f(v, rng, runs), runs) for v in VARIANCES], axis=1
    ),
)
def sensor_sweep(variance, rng, runs):
    """Mean error of frames 50 to 200, one per run, if the sensor is believed to have it."""
    bel = around(HOME, (runs, 200), rng, sigma=20.0)
    motion, sensor = pf.FixedTarget(1.4), pf.Position(np.sqrt(variance))
    return track(FILM[:200], bel, motion, sensor, rng).error[50:].mean(axis=0)


sensor_sweep.holds(
    "at .0001 and .01 the filter copies the measurement: 1.0 to 1.5 px",
    lambda x: (
        bool(((_column(x)[:2] > 1.0) & (_column(x)[:2] < 1.5)).all())
        or f"{_column(x)[:2].round(2)} px"
    ),
)
sensor_sweep.holds(
    "at 100 the error is the smallest, below .7 px",
    lambda x: (_column(x).argmin() == 3 and _column(x)[3] < 0.7) or f"{_column(x).round(2)} px",
)
sensor_sweep.holds(
    "at 10,000 it is larger again",
    lambda x: _column(x)[4] > _column(x)[3] or f"{_column(x).round(2)} px",
)
sensor_sweep.wrong("""variance-as-sd: passes the variance where a standard deviation is wanted
    For which of the five variances would that make no difference?
    At 100 px^2 the sensor of your filter has an sd of 100 px.
    pf.Position(np.sqrt(variance)).""")(
    lambda v, rng, runs: sensor_sweep(v**2, rng, runs),
    when=lambda x: _column(x)[3] > 0.7 and 0.9 < _column(x)[1] < 2,
)
sensor_sweep.wrong("""variance-unused: does not use the variance: all five errors are alike
    Your five errors agree.
    The variance is what the sensor believes.
    pf.Position(np.sqrt(variance)).""")(
    lambda v, rng, runs: sensor_sweep(9.0, rng, runs), when=lambda x: np.ptp(_column(x)) < 0.1
)


@sensor_sweep.wrong(
    """varies the process noise instead of the sensor noise
    Your error at .01 is smaller than at 100. Which noise did you change?
    The question changes what the sensor model believes.
    pf.FixedTarget(1.4) stays; pf.Position(np.sqrt(variance)) changes.""",
    when=lambda x: _column(x)[1] < 0.5 and _column(x)[4] > 3,
)
def process_noise(variance, rng, runs):
    bel = around(HOME, (runs, 200), rng, sigma=20.0)
    motion, sensor = pf.FixedTarget(np.sqrt(variance)), pf.Position(1.0)
    return track(FILM[:200], bel, motion, sensor, rng).error[50:].mean(axis=0)


sensor_sweep.wrong("""linear-weights: loses all weights to underflow and then resamples at
         random
    Your errors at small variances are tens of pixels. What is exp(-1000)?
    All weights were 0, and 'all zero, so all equal' forgets the measurement.
    Work with log-weights, as pf.update does.""")(
    lambda v, rng, runs: linear_weights(v, rng, runs)[50:].mean(axis=0),
    when=lambda x: _column(x)[0] > 5,
)

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


def _motion(f, rng, runs):
    pairs = [shaped(f(v, rng, runs), 2, runs) for v in VARIANCES]
    return np.stack(pairs, axis=2).transpose(1, 0, 2)  # (runs, metric, variance)


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
    claim="of .0001, .01, 1, 100, 10,000 px^2 the mean over all frames is best at 1, the "
    "mean of the last hundred at .01",
    test="smallest median over runs",
    runs=10,
    pool=250,
    margin="2.4 px (sd .6) against .58; .19 (.03) against .48: 5.6 sd of the logarithm",
    measure=_motion,
)
def motion_sweep(variance, rng, runs):
    """Mean error of all 400 frames, and of the last 100: two rows, one number per run."""
    bel = around(HOME, (runs, 200), rng, sigma=100.0)
    motion, sensor = pf.FixedTarget(np.sqrt(variance)), pf.Position(5.0)
    error = track(FILM[:400], bel, motion, sensor, rng).error
    return np.array([error.mean(axis=0), error[-100:].mean(axis=0)])


motion_sweep.holds(
    "all frames: the best is 1 px^2",
    lambda x: _column(x[:, 0]).argmin() == 2 or f"{_column(x[:, 0]).round(2)} px",
)
motion_sweep.holds(
    "last hundred frames: the best is .01 px^2",
    lambda x: _column(x[:, 1]).argmin() == 1 or f"{_column(x[:, 1]).round(2)} px",
)
motion_sweep.wrong("""variance-as-sd: passes the variance where a standard deviation is wanted
    For which of the five variances would that make no difference?
    At 100 px^2 your particles jump 100 px per frame.
    pf.FixedTarget(np.sqrt(variance)).""")(
    lambda v, rng, runs: motion_sweep(v**2, rng, runs), when=lambda x: _column(x[:, 1])[3] > 3
)
motion_sweep.wrong("""rows-swapped: returns the rows in the other order
    Which row holds the start of the film, where errors are large?
    All frames first, then the last hundred.
    np.array([error.mean(axis=0), error[-100:].mean(axis=0)]).""")(
    lambda v, rng, runs: motion_sweep(v, rng, runs)[::-1],
    when=lambda x: _column(x[:, 0]).argmin() == 1 and _column(x[:, 1]).argmin() == 2,
)
