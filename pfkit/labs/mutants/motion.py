"""Motion models with shared noise, mixed-up order, or variance for deviation."""

import numpy as np

from pfkit.geometry import wrap
from pfkit.labs.items import Misconception


def noise_for_all(state, sigma, rng):
    return state + sigma * rng.standard_normal((2, 1))


def variance_for_deviation(state, sigma, rng):
    return state + sigma**2 * rng.standard_normal(state.shape)


def only_one_axis(state, sigma, rng):
    return state + np.array([[sigma], [0.0]]) * rng.standard_normal(state.shape)


def same_draw_for_both(state, sigma, rng):
    return state + sigma * rng.standard_normal(state.shape[1])


def not_negative(state, sigma, rng):
    return state + sigma * np.abs(rng.standard_normal(state.shape))


def noise_alone(state, sigma, rng):
    return sigma * rng.standard_normal(state.shape)


def own_generator(state, sigma, rng):
    return state + sigma * np.random.default_rng(0).standard_normal(state.shape)


def root_of_deviation(state, sigma, rng):
    return state + np.sqrt(sigma) * rng.standard_normal(state.shape)


DIFFUSE = (
    Misconception(
        "noise-alone",
        "returns the noise without the state",
        (
            "Start at (100, 100). Where does your cloud end up?",
            "Noise is a step: it starts from where the particle is.",
            "state + sigma * rng.standard_normal(state.shape).",
        ),
        noise_alone,
    ),
    Misconception(
        "own-generator",
        "takes its chance from elsewhere than rng, or the same at each call",
        (
            "Call it twice with one rng. Are the two clouds different, as they must be?",
            "One generator, passed on, makes a run that is random and can be repeated.",
            "Draw with rng, and make no generator of your own.",
        ),
        own_generator,
    ),
    Misconception(
        "root",
        "scales the noise by the root of sigma",
        (
            "Measure the spread for sigma = 3. Do you get 3?",
            "sigma is a standard deviation already: no root is needed.",
            "Multiply by sigma itself.",
        ),
        root_of_deviation,
    ),
    Misconception(
        "shared-noise",
        "draws the noise once for all particles: the cloud moves as a block",
        (
            "Compare two particles that start at one place. Do they part?",
            "Each particle is a guess of its own, with its own luck.",
            "Draw an array as large as the state: rng.standard_normal(state.shape).",
        ),
        noise_for_all,
    ),
    Misconception(
        "variance",
        "scales the noise by sigma squared",
        (
            "Measure the spread for sigma = 3. Do you get 3?",
            "A standard normal times s has standard deviation s.",
            "Multiply by sigma, not by its square.",
        ),
        variance_for_deviation,
    ),
    Misconception(
        "one-axis",
        "adds noise to x only",
        (
            "Look at the spread of y.",
            "The state has two components, and both are uncertain.",
            "Draw noise of the shape of the state.",
        ),
        only_one_axis,
    ),
    Misconception(
        "same-draw",
        "gives x and y the same draw, so the cloud spreads along a diagonal",
        (
            "Plot y against x. What shape do you see?",
            "x and y err independently.",
            "Draw a (2, M) array of noise, not (M,).",
        ),
        same_draw_for_both,
    ),
    Misconception(
        "positive-noise",
        "adds noise that is never negative: the cloud drifts",
        (
            "Where is the mean of the cloud after 100 steps?",
            "Noise has mean zero.",
            "Leave the sign of the draws alone: no abs, no square.",
        ),
        not_negative,
    ),
)


def turn_first(state, dt):
    x, y, theta, v, omega = state
    theta = wrap(theta + omega * dt)
    return np.stack([x + v * dt * np.cos(theta), y + v * dt * np.sin(theta), theta, v, omega])


def not_wrapped(state, dt):
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)]
    return np.stack([*ahead, theta + omega * dt, v, omega])


def time_forgotten(state, dt):
    x, y, theta, v, omega = state
    return np.stack([x + v * np.cos(theta), y + v * np.sin(theta), wrap(theta + omega), v, omega])


def sine_for_cosine(state, dt):
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.sin(theta), y + v * dt * np.cos(theta)]
    return np.stack([*ahead, wrap(theta + omega * dt), v, omega])


def along_the_arc(state, dt):
    x, y, theta, v, omega = state
    later = theta + omega * dt
    ahead = [x + v / omega * (np.sin(later) - np.sin(theta))]
    ahead += [y - v / omega * (np.cos(later) - np.cos(theta))]
    return np.stack([*ahead, wrap(later), v, omega])


CIRCLE = (
    Misconception(
        "arc",
        "drives along the exact arc, and divides by omega",
        (
            "The question moves the position straight ahead, before the turn.",
            "An arc is more exact, and fails at omega = 0. This model takes short straight steps.",
            "x + v dt cos(theta), y + v dt sin(theta), with the old theta.",
        ),
        along_the_arc,
    ),
    Misconception(
        "turn-first",
        "turns before it drives",
        (
            "The equations of the text use the heading before the turn.",
            "Which theta stands in your cosine?",
            "Compute x and y from the old theta, then update theta.",
        ),
        turn_first,
    ),
    Misconception(
        "not-wrapped",
        "lets the heading grow past pi",
        (
            "Start at theta = 3.1 and turn on. What is your new heading?",
            "Headings of this course lie in (-pi, pi].",
            "Pass the new heading through pf.wrap.",
        ),
        not_wrapped,
    ),
    Misconception(
        "no-dt",
        "does not use dt",
        (
            "Halve dt. What should happen to the way driven?",
            "v and omega are per second (or frame); a step lasts dt.",
            "Multiply both v and omega by dt.",
        ),
        time_forgotten,
    ),
    Misconception(
        "sine-cosine",
        "swaps sine and cosine",
        (
            "Heading 0 points along x. Where does your target go?",
            "cos belongs to x, sin to y.",
            "x + v dt cos(theta), y + v dt sin(theta).",
        ),
        sine_for_cosine,
    ),
)

MUTANTS = {"lab3": {"q2c": CIRCLE, "q6b": DIFFUSE}}
