"""Q6: which noise is which?"""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, code
from pfkit.labs.response import calls
from pfkit.labs.statistics import rng_of

Q6 = Question("Which noise is which?")


M = 4000
SIGMA = 3.0


def _sample(f, sigma=SIGMA, at=0.0):
    """The noise alone: what a cloud that starts at one place became, minus that place."""
    return np.asarray(f(np.full((2, M), at), sigma, rng_of(11)), dtype=float) - at


def _added(f):
    """Does each particle step from its own place, on average by nothing, wherever it is?"""
    far = [_sample(f, at=place) for place in (1000.0, -1000.0)]
    cloud = rng_of(14).uniform(-1000, 1000, (2, 200))
    return bool(
        all(abs(x.mean()) < 5 * max(x.std(), 0.1) / np.sqrt(x.size) for x in far)
        and np.abs(f(cloud.copy(), SIGMA, rng_of(15)) - cloud).max() < 100
    )


def _draws(f):
    """Does chance come from rng, and afresh at each call?"""
    one, two = rng_of(4), rng_of(4)
    first, again, second = (f(np.zeros((2, 5)), 1.0, rng) for rng in (one, two, one))
    return np.array_equal(first, again) and not np.array_equal(first, second)


def _spread(f):
    """The sd of x and of y is sigma, for two sigmas."""
    for sigma in (SIGMA, 0.5):
        sd = _sample(f, sigma).std(axis=1)
        if np.abs(sd - sigma).max() > 5 * sigma / np.sqrt(2 * M):
            return f"sd {sd.round(2)} for sigma = {sigma:g}"
    return True


def _own_noise(f, particles=4, runs=1500):
    """Every x and every y of a small cloud has a draw of its own: nothing varies together."""
    rng, start = rng_of(12), np.zeros((2, particles))
    found = np.stack([np.ravel(f(start, 1.0, rng)) for _ in range(runs)])
    together = found.T @ found / runs - np.eye(2 * particles)
    limit = 6 / np.sqrt(runs) * (1 + (np.sqrt(2) - 1) * np.eye(2 * particles))
    worst = np.unravel_index(np.argmax(np.abs(together) / limit), limit.shape)
    if np.abs(together[worst]) <= limit[worst]:
        return True
    a, b = (f"{'xy'[k // particles]} of particle {k % particles}" for k in worst)
    return f"{a} and {b} vary together" if a != b else f"{a} has variance {1 + together[worst]:.2f}"


def _bell(f):
    """Shares within one and within two sigma are those of a Gaussian, within 5 standard errors."""
    off = np.abs(_sample(f) / SIGMA)
    for k, p in ((1, 0.6827), (2, 0.9545)):
        share = (off < k).mean()
        if abs(share - p) > 5 * np.sqrt(p * (1 - p) / (2 * M)):
            return f"{100 * share:.0f} % lie within {k} sigma, not {100 * p:.0f} %"
    return True


def _fingerprint(f):
    """How wide, where, how it varies together, whose chance, which shape."""
    x, small = _sample(f), _sample(f, 0.5)
    rng = rng_of(13)
    pairs = np.stack([f(np.zeros((2, 2)), 1.0, rng) for _ in range(800)])
    return [
        *x.std(axis=1), *small.std(axis=1), *np.clip(x.mean(axis=1), -3, 3),
        *np.mean(pairs[:, 0] * pairs[:, 1], axis=0),
        np.mean(pairs[:, :, 0] * pairs[:, :, 1]),
        float(_sample(f, at=100.0).mean() < -50), float(_draws(f)),
        3 * (np.abs(x) < SIGMA).mean(), 10 * (np.abs(x) < 2 * SIGMA).mean(),
    ]  # fmt: skip


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
    fingerprint=_fingerprint,
    atol=0.2,
)
def diffuse(state, sigma, rng):
    """State (2, M) plus noise of sd sigma (px) on x and y of every particle."""
    return state + sigma * rng.standard_normal(state.shape)


diffuse.holds("the shape stays (2, M)", lambda f: _sample(f).shape == (2, M))
diffuse.holds("noise is added to the state, wherever it is", _added)
diffuse.holds("its chance comes from rng, afresh at each call", _draws)
diffuse.holds("the sd is sigma in x and in y, within 5 standard errors", _spread)
diffuse.holds(
    "mean 0, within 5 standard errors",
    lambda f: np.abs(_sample(f).mean(axis=1)).max() < 5 * SIGMA / np.sqrt(M),
)
diffuse.holds("every x and every y has a draw of its own", _own_noise)
diffuse.holds("the noise is Gaussian", _bell)
diffuse.holds(
    "it is your own: no call of pf.FixedTarget",
    lambda f: not calls(lambda: f(np.zeros((2, 3)), 1.0, rng_of(1)), pf.FixedTarget),
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
diffuse.wrong("""always-3: has the same sd, whatever sigma is
    Does your function use sigma?
    The check tries two sigmas.
    Multiply by sigma.""")(
    lambda state, sigma, rng: state + SIGMA * rng.standard_normal(state.shape)
)
diffuse.wrong("""uniform: draws from another distribution than the Gaussian
    How many of 1,000 particles lie further than two sigma away? A Gaussian has 46.
    The name of the distribution is part of the model.
    rng.standard_normal(state.shape), or rng.normal(0, sigma, state.shape).""")(
    lambda state, sigma, rng: state + sigma * np.sqrt(12) * (rng.random(state.shape) - 0.5)
)


@diffuse.refuses("draws for half of the cloud, and takes the opposite for the other")
def antithetic(state, sigma, rng):
    half = rng.standard_normal((2, -(-state.shape[1] // 2)))
    return state + sigma * np.concatenate([half, -half], axis=1)[:, : state.shape[1]]


@diffuse.refuses("heavy tails with the right variance")
def laplace(state, sigma, rng):
    return state + rng.laplace(0, sigma / np.sqrt(2), state.shape)


@diffuse.refuses("steps of exactly sigma to either side")
def coin(state, sigma, rng):
    return state + sigma * rng.choice([-1.0, 1.0], state.shape)


@diffuse.refuses("global chance", named="own-generator")
def global_chance(state, sigma, rng):
    return state + sigma * np.random.standard_normal(state.shape)  # noqa: NPY002


@diffuse.refuses("noise on one axis of each particle, chosen by chance")
def one_axis_by_chance(state, sigma, rng):
    axis = rng.integers(0, 2, state.shape[1])
    chosen = np.stack([axis == 0, axis == 1])
    return state + np.sqrt(2) * sigma * chosen * rng.standard_normal(state.shape)


@diffuse.refuses("noise of sd sigma in all, shared by x and y")
def shared_out(state, sigma, rng):
    return state + sigma / np.sqrt(2) * rng.standard_normal(state.shape)


@diffuse.refuses("scales the state, too")
def scaled(state, sigma, rng):
    return 1.02 * state + sigma * rng.standard_normal(state.shape)


@diffuse.refuses("steps from the middle of the cloud")
def from_the_middle(state, sigma, rng):
    return rng.normal(state.mean(axis=1, keepdims=True), sigma, state.shape)


@diffuse.refuses("calls the library")
def library(state, sigma, rng):
    return pf.FixedTarget(sigma).sample(state, [0, 0, 1], rng)


@diffuse.refuses("leaves the state without noise")
def still(state, sigma, rng):
    return state.copy()
