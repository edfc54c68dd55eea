"""Q1 and Q2: what a motion model can learn, and what it takes for granted."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.geometry import wrap
from pfkit.labs import Choice, Numeric, Question, code, experiment
from pfkit.labs.statistics import rng_of, shaped
from pfkit.labs.target import TURN, around, target_log, track

Q1 = Question("Fixed heading, or heading in the state?")

LINE = target_log("line", "high")


def _started(D, rng, runs, wrong, sigma_theta=0.02):
    start = LINE.start + np.array([0.0, 0.0, wrong])
    motion = pf.HeadingTarget(0.1, heading=start[2]) if D == 2 else pf.LineTarget(0.1, sigma_theta)
    bel = around(start[:D], (runs, 200), rng)
    return track(LINE[:300], bel, motion, pf.Position(20.0), rng).error


def _follow(f, rng, runs):
    flat, full = (shaped(f(D, rng, runs), 300, runs) for D in (2, 3))
    return np.stack([e[k : k + 100].mean(axis=0) for e in (flat, full) for k in (0, 200)], axis=1)


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
    """A heading that is wrong by 20 degrees
    Return the errors of lab.track, one row per frame.
    For D = 2 use HeadingTarget with the wrong heading, for D = 3 LineTarget.
    Start both at lab.line.start + (0, 0, 20 degrees), cut to D components.""",
    id="q1b",
    points=2,
    claim="with the heading fixed the error grows; with the heading in the state it recovers",
    test="mean error in frames 200-300: 2-D more than twice that of frames 0-100; "
    "3-D below 10 px and below a quarter of 2-D",
    runs=8,
    pool=250,
    margin="ratio 4.66 (sd .03) against 2; 4.1 px (.2) against 10: over 25 standard errors",
    measure=_follow,
)
def follow(D, rng, runs):
    """Errors (300, runs) on the line, from a start whose heading is wrong by 20 degrees."""
    return _started(D, rng, runs, np.deg2rad(20.0))


follow.holds(
    "fixed heading: the error more than doubles",
    lambda x: (
        x[:, 1].mean() > 2 * x[:, 0].mean() or f"{x[:, 0].mean():.1f}, then {x[:, 1].mean():.1f} px"
    ),
)
follow.holds(
    "heading in the state: below 10 px, and below a quarter of the other",
    lambda x: x[:, 3].mean() < min(10, x[:, 1].mean() / 4) or f"{x[:, 3].mean():.1f} px",
)
follow.wrong("""degrees: adds 20 to a heading in radians
    Your fixed heading is off by 66 degrees: 20 rad less three turns.
    Headings are in radians.
    start = lab.line.start + np.array([0, 0, np.deg2rad(20)]).""")(
    lambda D, rng, runs: _started(D, rng, runs, 20.0), when=lambda x: x[:, 1].mean() > 150
)
follow.wrong("""always-three: has the heading in the state in both cases
    Your two errors agree. Does your function use D?
    For D = 2 nobody can question the heading.
    pf.HeadingTarget(0.1, heading=start[2]) for D = 2.""")(
    lambda D, rng, runs: follow(3, rng, runs),
    when=lambda x: x[:, 1].mean() < 12 and x[:, 0].mean() > 6,
)
follow.wrong("""right-heading: starts with the right heading, so there is nothing to recover
         from
    Your 2-D error does not grow. Which heading does the model assume?
    The question makes the assumed heading wrong by 20 degrees.
    heading = lab.line.start[2] + np.deg2rad(20).""")(
    lambda D, rng, runs: _started(D, rng, runs, 0.0),
    when=lambda x: x[:, 1].mean() < 12 and x[:, 0].mean() <= 6,
)
follow.wrong("""no-heading-noise: cannot turn: with D = 3 its error is that of the fixed heading
    Your 3-D filter starts with headings within .01 rad. How could it turn?
    What a model can learn, its noise must be able to explore.
    pf.LineTarget(0.1, 0.02): the second number is the sd of the heading.""")(
    lambda D, rng, runs: _started(D, rng, runs, np.deg2rad(20.0), 0.0),
    when=lambda x: x[:, 1].mean() > 30 and x[:, 3].mean() > 25,
)

Q2 = Question("Which circles does the model cover?")


def _states(seed, *shape):
    rng = rng_of(seed)
    scale = np.array([50, 50, 3, 2, 0.5]).reshape(5, *(1,) * len(shape))
    return scale * rng.uniform(-1, 1, (5, *shape))


q2a = Numeric(
    """Radius for v0 = 2 px/frame and omega0 = 2 pi/688 rad/frame
    How long is the way of one turn?
    One turn takes 688 frames at 2 px each.
    radius = v0 / omega0.""",
    2.0 / TURN,
    tol=0.5,
    unit="px",
)
q2a.wrong("""inverted: is omega0 / v0
    Check the unit: rad/px is not a length.
    A faster target on the same turn rate draws a larger circle.
    radius = v0 / omega0.""")(TURN / 2.0, when=lambda x: abs(x - TURN / 2.0) < 1e-3)
q2a.wrong("""diameter: is the diameter
    Twice too large.
    The radius is asked for.
    radius = v0 / omega0.""")(4.0 / TURN)
q2a.wrong("""circumference: is the length of the circle
    You found the way of one turn.
    Divide by 2 pi.
    radius = v0 / omega0.""")(1376.0)
q2a.wrong("""degrees: takes omega0 in degrees
    omega0 is in radians per frame.
    An arc is radius times angle only for radians.
    2 / (2 pi / 688).""")(2.0 / np.rad2deg(TURN))

q2b = Choice("""What the circle model leaves free
    a  Radius, centre and phase
       = The radius is v0/omega0, and both are given.
    b  Only the phase
       = Any (x, y, theta) is allowed, so the centre is free too.
    c* Centre and phase; speed, rate and so the radius and the sense are given
       = Yes: one size and one sense of circle, anywhere.
    d  Speed and rate; centre and phase are given
       = It is the other way round.""")


@code(
    """Speed and rate in the state
    Unpack five components: x, y, theta, v, omega = state.
    Speed and rate stay as they are; the rest is the circle model.
    np.stack([x + v dt cos, y + v dt sin, wrap(theta + omega dt), v, omega]).""",
    id="q2c",
    points=2,
    fingerprint=lambda f: f(_states(4, 20), 1.7),
)
def circle_mean(state, dt):
    """Mean motion of (x, y, theta, v, omega): speed and rate are part of the state."""
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)]
    return np.stack([*ahead, pf.wrap(theta + omega * dt), v, omega])


circle_mean.holds(
    "one state by hand: (0, 0, 0, 2, .1), dt = 3 gives (6, 0, .3, 2, .1)",
    lambda f: np.allclose(f(np.array([0.0, 0, 0, 2, 0.1]), 3.0), [6, 0, 0.3, 2, 0.1]),
)
circle_mean.holds(
    "a cloud (5, 7) moves like its columns",
    lambda f: np.allclose(f(_states(1, 7), 0.5)[:, 3], circle_mean(_states(1, 7)[:, 3], 0.5)),
)
circle_mean.holds(
    "a batch (5, 3, 7) keeps its shape", lambda f: np.shape(f(_states(2, 3, 7), 0.5)) == (5, 3, 7)
)
circle_mean.holds(
    "headings stay in (-pi, pi]", lambda f: np.abs(f(_states(3, 50), 3.0)[2]).max() <= np.pi
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
