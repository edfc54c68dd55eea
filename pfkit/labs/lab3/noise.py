"""Q6: which noise is which?"""

from __future__ import annotations

import numpy as np

from pfkit.labs import Choice, Question, code
from pfkit.labs.statistics import rng_of

Q6 = Question("Which noise is which?")


def _sample(f, M=4000, sigma=3.0, at=0.0):
    """The noise alone: what a cloud that starts at one place became, minus that place."""
    return np.asarray(f(np.full((2, M), at), sigma, rng_of(11)), dtype=float) - at


def _draws(f):
    """Does chance come from rng, and afresh at each call?"""
    one, two = rng_of(4), rng_of(4)
    first, again, second = (f(np.zeros((2, 5)), 1.0, rng) for rng in (one, two, one))
    return np.array_equal(first, again) and not np.array_equal(first, second)


q6a = Choice("""pf.FixedTarget(sigma=2), pf.Position(sigma=3)
    a  Process variance 2 px^2, measurement variance 3 px^2
       = In pfkit every sigma is a standard deviation; square it for the variance.
    b  Measurement sd 2 px, process sd 3 px
       = Motion models hold the process noise, sensors the measurement noise.
    c* Process sd 2 px per step, so variance 4 px^2; measurement variance 9 px^2
       = Yes. In the literature Q and R change places: say which noise, and sd or variance.
    d  Process variance 2 px^2, measurement sd 3 px
       = Both are standard deviations.""")


@code(
    """Process noise
    Every particle gets its own noise, in x and in y.
    A standard normal times s has standard deviation s.
    state + sigma * rng.standard_normal(state.shape).""",
    id="q6b",
    points=2,
    fingerprint=lambda f: [
        *_sample(f).std(axis=1),
        *np.clip(_sample(f).mean(axis=1), -3, 3),
        np.mean(_sample(f)[0] * _sample(f)[1]) if _sample(f).std() > 0.1 else 0.0,
        float(_sample(f, at=100.0).mean() < -50),
        2 * float(_draws(f) is True),
    ],
    atol=0.6,
)
def diffuse(state, sigma, rng):
    """One step of a target that stands still: fresh noise for every particle and axis."""
    return state + sigma * rng.standard_normal(state.shape)


diffuse.holds("the shape stays (2, M)", lambda f: _sample(f).shape == (2, 4000))
diffuse.holds("noise is added to the state", lambda f: abs(_sample(f, at=100.0).mean()) < 10)
diffuse.holds("its chance comes from rng, afresh at each call", _draws)
diffuse.holds(
    "sd 3 in x and in y, within 5 standard errors",
    lambda f: (
        np.abs(_sample(f).std(axis=1) - 3).max() < 5 * 3 / np.sqrt(8000)
        or f"sd {_sample(f).std(axis=1).round(2)}"
    ),
)
diffuse.holds(
    "mean 0, within 5 standard errors",
    lambda f: np.abs(_sample(f).mean(axis=1)).max() < 15 / np.sqrt(4000),
)
diffuse.holds(
    "x and y are independent",
    lambda f: abs(np.mean(_sample(f)[0] * _sample(f)[1])) < 5 * 9 / np.sqrt(4000),
)
diffuse.wrong("""noise-alone: returns the noise without the state
    Start at (100, 100). Where does your cloud end up?
    Noise is a step: it starts from where the particle is.
    state + sigma * rng.standard_normal(state.shape).""")(
    lambda state, sigma, rng: sigma * rng.standard_normal(state.shape)
)
diffuse.wrong("""own-generator: takes its chance from elsewhere than rng, or the same at each call
    Call it twice with one rng. Are the two clouds different, as they must be?
    One generator, passed on, makes a run that is random and can be repeated.
    Draw with rng, and make no generator of your own.""")(
    lambda state, sigma, rng: state + sigma * np.random.default_rng(0).standard_normal(state.shape)
)
diffuse.wrong("""root: scales the noise by the root of sigma
    Measure the spread for sigma = 3. Do you get 3?
    sigma is a standard deviation already: no root is needed.
    Multiply by sigma itself.""")(
    lambda state, sigma, rng: state + np.sqrt(sigma) * rng.standard_normal(state.shape)
)
diffuse.wrong("""shared-noise: draws the noise once for all particles: the cloud moves as a
         block
    Compare two particles that start at one place. Do they part?
    Each particle is a guess of its own, with its own luck.
    Draw an array as large as the state: rng.standard_normal(state.shape).""")(
    lambda state, sigma, rng: state + sigma * rng.standard_normal((2, 1))
)
diffuse.wrong("""variance: scales the noise by sigma squared
    Measure the spread for sigma = 3. Do you get 3?
    A standard normal times s has standard deviation s.
    Multiply by sigma, not by its square.""")(
    lambda state, sigma, rng: state + sigma**2 * rng.standard_normal(state.shape)
)
diffuse.wrong("""one-axis: adds noise to x only
    Look at the spread of y.
    The state has two components, and both are uncertain.
    Draw noise of the shape of the state.""")(
    lambda state, sigma, rng: state + np.array([[sigma], [0.0]]) * rng.standard_normal(state.shape)
)
diffuse.wrong("""same-draw: gives x and y the same draw, so the cloud spreads along a diagonal
    Plot y against x. What shape do you see?
    x and y err independently.
    Draw a (2, M) array of noise, not (M,).""")(
    lambda state, sigma, rng: state + sigma * rng.standard_normal(state.shape[1])
)
diffuse.wrong("""positive-noise: adds noise that is never negative: the cloud drifts
    Where is the mean of the cloud after 100 steps?
    Noise has mean zero.
    Leave the sign of the draws alone: no abs, no square.""")(
    lambda state, sigma, rng: state + sigma * np.abs(rng.standard_normal(state.shape))
)
