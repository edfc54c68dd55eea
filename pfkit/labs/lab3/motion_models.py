"""Q1 and Q2: what a motion model can learn, and what it takes for granted."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.geometry import wrap
from pfkit.labs import Choice, Numeric, Question, code, experiment
from pfkit.labs.lab3 import given as lab
from pfkit.labs.response import calls, same_mean, same_scatter
from pfkit.labs.statistics import rng_of
from pfkit.labs.target import target_log

Q1 = Question("Fixed heading, or heading in the state?")

LINE = target_log("line", "high")


def _headings(rng):
    """Both models with few particles and a small error, and with many and a large one."""
    small, large = rng.choice([-1, 1], 2) * np.deg2rad(rng.uniform([12, 35], [18, 50]))
    few, many = int(rng.integers(6, 11)), int(rng.integers(60, 91))
    return [(D, float(a), M) for a, M in ((small, few), (large, many)) for D in (2, 3)]


q1a = Choice("""What a third state component buys
    a  Nothing: the heading is known, so both models are the same
       = They are, as long as the known heading is right.
    b* It can learn the heading; the price is one dimension more to cover
       = Yes: ability to learn against particles needed.
    c  It is faster, because the heading need not be passed on
       = It costs more: a sine and a cosine per particle, and more particles.
    d  It removes the need for process noise
       = Without noise on the heading, no particle would ever try a new one.""")


@experiment(
    """A heading that is wrong
    For D = 2 use HeadingTarget with the wrong heading, for D = 3 LineTarget.
    Start both at lab.line.start + (0, 0, wrong), cut to D components.
    lab.track(...).error has one row per frame: rows 200 to 300, averaged over axis 0.""",
    id="q1b",
    points=2,
    claim="error against D, wrong heading and number of particles is that of the two models",
    test="mean within 5 standard errors of a right experiment's at each of four settings, scatter "
    "from run to run within a factor of 3.5",
    runs=24,
    pool=600,
    settings=_headings,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors, four settings: 3e-5 by Student's law",
)
def follow(D, wrong, M, rng, runs):
    """Mean error in px of frames 200 to 300, shape (runs,)."""
    start = lab.line.start + np.array([0, 0, wrong])
    motion = pf.HeadingTarget(0.1, heading=start[2]) if D == 2 else pf.LineTarget(0.1, 0.02)
    bel = lab.around(start[:D], (runs, M), rng)
    run = lab.track(lab.line[:300], bel, motion, pf.Position(20.0), rng)
    return run.error[200:].mean(axis=0)


follow.holds("the error follows D, the wrong heading and M", same_mean(5.0))
follow.holds("the runs scatter as independent filters do", same_scatter(3.5))


@follow.wrong("""starts with the right heading, so there is nothing to recover from
    Your 2-D error does not grow. Which heading does the model assume?
    wrong is in radians already, and belongs to the start of both filters.
    start = lab.line.start + np.array([0, 0, wrong]); heading=start[2].""")
def right_heading(D, wrong, M, rng, runs):
    return follow(D, 0.0, M, rng, runs)


@follow.wrong("""has a heading that is wrong by 20 degrees, whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses how wrong the heading is: wrong, in radians.
    start = lab.line.start + np.array([0, 0, wrong]).""")
def always_twenty(D, wrong, M, rng, runs):
    return follow(D, np.deg2rad(20.0), M, rng, runs)


@follow.wrong("""has the heading in the state in both cases
    Your two errors agree. Does your function use D?
    For D = 2 nobody can question the heading.
    pf.HeadingTarget(0.1, heading=start[2]) for D = 2.""")
def always_three(D, wrong, M, rng, runs):
    return follow(3, wrong, M, rng, runs)


@follow.wrong("""keeps the heading fixed in both cases
    Your two errors agree. Does your function use D?
    For D = 3 the heading is a component of the state, with noise of its own.
    pf.LineTarget(0.1, 0.02) and start[:3] for D = 3.""")
def always_two(D, wrong, M, rng, runs):
    return follow(2, wrong, M, rng, runs)


@follow.wrong("""cannot turn: with D = 3 its error is that of a heading without noise
    Your 3-D filter starts with headings within .01 rad. How could it turn?
    What a model can learn, its noise must be able to explore.
    pf.LineTarget(0.1, 0.02): the second number is the sd of the heading.""")
def no_heading_noise(D, wrong, M, rng, runs):
    start = LINE.start + np.array([0, 0, wrong])
    motion = pf.HeadingTarget(0.1, heading=start[2]) if D == 2 else pf.LineTarget(0.1, 0.0)
    bel = lab.around(start[:D], (runs, M), rng)
    return lab.track(LINE[:300], bel, motion, pf.Position(20.0), rng).error[200:].mean(axis=0)


@follow.wrong("""averages over all 300 frames
    When has the second filter recovered?
    The first frames have not yet gone astray, or not yet recovered.
    run.error[200:].mean(axis=0).""")
def all_frames(D, wrong, M, rng, runs):
    start = LINE.start + np.array([0, 0, wrong])
    motion = pf.HeadingTarget(0.1, heading=start[2]) if D == 2 else pf.LineTarget(0.1, 0.02)
    bel = lab.around(start[:D], (runs, M), rng)
    return lab.track(LINE[:300], bel, motion, pf.Position(20.0), rng).error.mean(axis=0)


@follow.wrong("""takes 200 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.around(start[:D], (runs, M), rng).""")
def always_200(D, wrong, M, rng, runs):
    return follow(D, wrong, 200, rng, runs)


@follow.refuses("a constant at the right value for 20 degrees")
def constant(D, wrong, M, rng, runs):
    return np.full(runs, 75.2 if D == 2 else 4.1)


@follow.refuses("the geometry of a heading that nobody corrects, without a filter")
def geometry(D, wrong, M, rng, runs):
    return np.full(runs, 2 * np.sin(abs(wrong) / 2) * 250 if D == 2 else 4.0)


@follow.refuses("the same with scatter")
def geometry_and_noise(D, wrong, M, rng, runs):
    return geometry(D, wrong, M, rng, runs) + rng.normal(0, 1, runs)


follow.refuses("random in range")(lambda D, wrong, M, rng, runs: rng.uniform(3, 140, runs))
follow.refuses("half as many particles")(
    lambda D, wrong, M, rng, runs: follow(D, wrong, M // 2, rng, runs)
)


@follow.refuses("one run, repeated")
def repeated(D, wrong, M, rng, runs):
    return np.repeat(follow(D, wrong, M, rng, 1), runs)


@follow.refuses("starts the three-dimensional filter with the right heading only")
def three_right(D, wrong, M, rng, runs):
    return follow(D, wrong if D == 2 else 0.0, M, rng, runs)


Q2 = Question("Which circles does the model cover?")


def _states(seed, *shape):
    rng = rng_of(seed)
    scale = np.array([50, 50, 3, 2, 0.5]).reshape(5, *(1,) * len(shape))
    return scale * rng.uniform(-1, 1, (5, *shape))


q2a = Numeric(
    """Radius of the circle, in px to within .5, for a speed of {v} px per frame and one full turn
         in {T} frames
    How long is the way of one turn?
    One turn takes {T} frames at {v} px each.
    radius = v0 / omega0, with omega0 = 2 pi / {T}.""",
    lambda v, T: v * T / (2 * np.pi),
    tol=0.5,
    unit="px",
    world={"v": 2, "T": 688},
    draw=lambda rng: {
        "v": float(rng.choice([1.5, 2.5, 3, 4])),
        "T": int(rng.choice([450, 500, 560, 600, 640, 720, 800])),
    },
)
q2a.wrong("""inverted: is omega0 / v0
    Check the unit: rad/px is not a length.
    A faster target on the same turn rate draws a larger circle.
    radius = v0 / omega0.""")(lambda v, T: 2 * np.pi / T / v)
q2a.wrong("""diameter: is the diameter
    Twice too large.
    The radius is asked for.
    radius = v0 / omega0.""")(lambda v, T: v * T / np.pi)
q2a.wrong("""circumference: is the length of the circle
    You found the way of one turn.
    Divide by 2 pi.
    radius = v0 / omega0.""")(lambda v, T: v * T)
q2a.wrong("""degrees: takes omega0 in degrees
    omega0 is in radians per frame.
    An arc is radius times angle only for radians.
    {v} / (2 pi / {T}).""")(lambda v, T: v * T / 360)
q2a.wrong("""half-turn: takes half a turn for a whole one, or pi for 2 pi
    How many radians has a full turn?
    A full turn is 2 pi, and takes {T} frames.
    {v} / (2 pi / {T}).""")(lambda v, T: v * T / (4 * np.pi))

q2b = Choice("""What the circle model leaves free
    a  Radius, centre and phase
       = The radius is v0/omega0, and both are given.
    b  Only the phase
       = Any (x, y, theta) is allowed, so the centre is free too.
    c* Centre and phase; speed, rate and so the radius and the sense are given
       = Yes: one size and one sense of circle, anywhere.
    d  Speed and rate; centre and phase are given
       = It is the other way round.""")


def _apart(found, wanted):
    """Largest difference of two states, headings modulo a turn."""
    off = np.asarray(found, dtype=float) - wanted
    off[2] = wrap(off[2])
    return float(np.abs(off).max())


def _follows(f, shape, dt):
    state = _states(len(shape), *shape)
    return (
        np.shape(f(state, dt)) == state.shape
        and _apart(f(state, dt), circle_mean(state, dt)) < 1e-9
    )


TURNING = np.array([[0, 0], [0, 0], [3.1, -3.1], [1, 1], [0.5, -0.5]])


def _one_turn(f):
    """Headings in (-pi, pi], or in [0, 2 pi): both name each direction once."""
    cases = [(TURNING[:, k], dt) for dt in (3.0, 40.0) for k in (0, 1)] + [(_states(3, 200), 40.0)]
    if max(_apart(f(state, dt), circle_mean(state, dt)) for state, dt in cases) > 1e-9:
        return "some are not right"
    found = np.concatenate([np.atleast_1d(f(state, dt)[2]) for state, dt in cases])
    low, high = found.min(), found.max()
    ok = (low >= -np.pi and high <= np.pi) or (low >= 0 and high < 2 * np.pi)
    return ok or f"they reach from {low:.3g} to {high:.3g}"


@code(
    """Speed and rate in the state
    Unpack five components: x, y, theta, v, omega = state.
    Speed and rate stay as they are; the rest is the circle model.
    np.stack([x + v dt cos, y + v dt sin, wrap(theta + omega dt), v, omega]).""",
    id="q2c",
    points=2,
    fingerprint=lambda f: [f(_states(4, 20), dt) for dt in (1.7, 9.0)],
)
def circle_mean(state, dt):
    """State (5, ...) after dt: the position moves along theta, then theta turns."""
    x, y, theta, v, omega = state
    x, y = x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)
    return np.stack([x, y, pf.wrap(theta + omega * dt), v, omega])


circle_mean.holds(
    "one state by hand: (0, 0, 0, 2, .1), dt = 3 gives (6, 0, .3, 2, .1)",
    lambda f: _apart(f(np.array([0.0, 0, 0, 2, 0.1]), 3.0), [6, 0, 0.3, 2, 0.1]) < 1e-9,
)
circle_mean.holds(
    "every particle of a cloud (5, 7) moves by its own speed and heading",
    lambda f: _follows(f, (7,), 0.5),
)
circle_mean.holds("so does a batch (5, 3, 7)", lambda f: _follows(f, (3, 7), 1.5))
circle_mean.holds(
    "speed and rate stay as they are",
    lambda f: np.array_equal(f(_states(5, 9), 2.0)[3:], _states(5, 9)[3:]),
)
circle_mean.holds("headings stay within one turn, also after several turns", _one_turn)
circle_mean.holds(
    "it is your own: no call of pf.CircleTarget",
    lambda f: not calls(lambda: f(_states(6, 4), 1.0), pf.CircleTarget),
)


@circle_mean.wrong("""drives along the exact arc, and divides by omega
    The question moves the position straight ahead, before the turn.
    An arc is more exact, and fails at omega = 0. This model takes short straight steps.
    x + v dt cos(theta), y + v dt sin(theta), with the old theta.""")
def arc(state, dt):
    x, y, theta, v, omega = state
    later = theta + omega * dt
    ahead = [x + v / omega * (np.sin(later) - np.sin(theta))]
    ahead += [y - v / omega * (np.cos(later) - np.cos(theta))]
    return np.stack([*ahead, wrap(later), v, omega])


@circle_mean.wrong("""turns before it drives
    The equations of the text use the heading before the turn.
    Which theta stands in your cosine?
    Compute x and y from the old theta, then update theta.""")
def turn_first(state, dt):
    x, y, theta, v, omega = state
    theta = wrap(theta + omega * dt)
    return np.stack([x + v * dt * np.cos(theta), y + v * dt * np.sin(theta), theta, v, omega])


@circle_mean.wrong("""lets the heading grow past pi
    Start at theta = 3.1 and turn on. What is your new heading?
    Headings of this course lie in (-pi, pi].
    Pass the new heading through pf.wrap.""")
def not_wrapped(state, dt):
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)]
    return np.stack([*ahead, theta + omega * dt, v, omega])


@circle_mean.wrong("""does not use dt
    Halve dt. What should happen to the way driven?
    v and omega are per second (or frame); a step lasts dt.
    Multiply both v and omega by dt.""")
def no_dt(state, dt):
    x, y, theta, v, omega = state
    return np.stack([x + v * np.cos(theta), y + v * np.sin(theta), wrap(theta + omega), v, omega])


@circle_mean.wrong("""swaps sine and cosine
    Heading 0 points along x. Where does your target go?
    cos belongs to x, sin to y.
    x + v dt cos(theta), y + v dt sin(theta).""")
def sine_cosine(state, dt):
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.sin(theta), y + v * dt * np.cos(theta)]
    return np.stack([*ahead, wrap(theta + omega * dt), v, omega])


def _moved(state, dt, heading):
    """The circle model with another rule for the new heading."""
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)]
    return np.stack([*ahead, heading(theta + omega * dt), v, omega])


@circle_mean.refuses("takes a turn off at pi, but adds none at -pi")
def one_side(state, dt):
    return _moved(state, dt, lambda a: np.where(a > np.pi, a - 2 * np.pi, a))


@circle_mean.refuses("takes off one turn only")
def one_turn_only(state, dt):
    return _moved(state, dt, lambda a: a - 2 * np.pi * np.sign(a) * (np.abs(a) > np.pi))


@circle_mean.refuses("cuts headings off at pi")
def clipped(state, dt):
    return _moved(state, dt, lambda a: np.clip(a, -np.pi, np.pi))


@circle_mean.refuses("drives along the heading in the middle of the step")
def midpoint(state, dt):
    x, y, theta, v, omega = state
    half = theta + omega * dt / 2
    x, y = x + v * dt * np.cos(half), y + v * dt * np.sin(half)
    return np.stack([x, y, wrap(theta + omega * dt), v, omega])


@circle_mean.refuses("moves all by the speed of the first particle")
def one_speed(state, dt):
    x, y, theta, v, omega = state
    first = np.ravel(v)[0]
    x, y = x + first * dt * np.cos(theta), y + first * dt * np.sin(theta)
    return np.stack([x, y, wrap(theta + omega * dt), v, omega])


@circle_mean.refuses("calls the library, particle by particle")
def library(state, dt):
    x, y, theta, v, omega = state.reshape(5, -1)
    model, moved = pf.CircleTarget(0.0), np.array(state, dtype=float)
    pose = zip(x, y, theta, v, omega, strict=True)
    found = [model.mean(np.array([[a], [b], [c]]), [s, r, dt])[:, 0] for a, b, c, s, r in pose]
    moved[:3] = np.array(found).T.reshape(moved[:3].shape)
    return moved
