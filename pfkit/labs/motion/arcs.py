"""Follow an arc: the reference, what it must satisfy, and nine ways to get it wrong.

Every arc here is a function of (pose, v, omega, dt).
"""

import numpy as np

import pfkit as pf
from pfkit.labs import Question, code

CODE = Question("Code")


def sinc(half):
    return np.sinc(half / np.pi)


def full(half):
    return np.ones_like(half)


def along(share, chord=sinc):
    """Drive along theta + share * turn; `chord` shortens the way, or (`full`) does not."""

    def arc(pose, v, omega, dt):
        x, y, theta = pose
        turn = omega * dt
        c = v * dt * chord(turn / 2)
        way = theta + share * turn
        return np.array([x + c * np.cos(way), y + c * np.sin(way), pf.wrap(theta + turn)])

    return arc


exact = along(0.5)

CURVED = [
    ((1.0, 2.0, 0.5), 1.0, 0.7, 0.5),
    ((0.0, 0.0, -1.0), 2.0, -1.1, 1.5),
    ((-3.0, 1.0, 3.0), -0.5, 0.4, 2.0),
]


def _call(f, pose, v, omega, dt):
    with np.errstate(all="ignore"):
        return np.asarray(f(np.array(pose), v, omega, dt), dtype=float)


def near(found, wanted, atol=1e-8):
    return (
        np.shape(found) == np.shape(wanted)
        and np.allclose(found[:2], wanted[:2], rtol=0, atol=atol)
        and np.allclose(np.cos(found[2] - wanted[2]), 1, rtol=0, atol=1e-12)
    )


def _on_arc(f):
    return all(near(_call(f, *case), exact(np.array(case[0]), *case[1:])) for case in CURVED)


def _straight(f):
    return near(_call(f, (1.0, 2.0, 0.5), 2.0, 0.0, 0.5), [1 + np.cos(0.5), 2 + np.sin(0.5), 0.5])


def _slow(f):
    found = _call(f, (0.0, 0.0, 0.2), 1.0, 4e-3, 1.0)
    return np.isclose(found[2], 0.204, rtol=0, atol=1e-9)


def _tiny(f):
    case = (np.array((1.0, 2.0, 0.5)), 1.0, 1e-11, 1.0)
    return near(_call(f, *case), exact(*case))


def _cloud_of_turns(f):
    pose = np.array([[0.0, 1.0, 2.0], [0.0, 0.0, 1.0], [0.1, 0.2, 0.3]])
    omega = np.array([0.0, 0.5, -1.0])
    return near(_call(f, pose, 1.0, omega, 0.5), exact(pose, 1.0, omega, 0.5))


def _breaks(test, f):
    """Is the test failed, or not even survived?"""
    try:
        return not test(f)
    except Exception:
        return True


def _wrapped(f):
    found = _call(f, (0.0, 0.0, 3.0), 1.0, 1.0, 0.5)[2]
    return -np.pi < found <= np.pi


def naive(pose, v, omega, dt):
    x, y, theta = pose
    end = theta + np.asarray(omega) * dt
    with np.errstate(all="ignore"):
        radius = np.divide(v, omega)
        x1 = x + radius * (np.sin(end) - np.sin(theta))
        y1 = y + radius * (np.cos(theta) - np.cos(end))
    return np.array([x1, y1, pf.wrap(end)])


arc = code(
    """Follow an arc, straight ones too
    Use the chord: its length, and its direction.
    The chord has length v dt sinc(omega dt / 2) and points to theta + omega dt / 2.
    np.sinc(t) is sin(pi t) / (pi t), so ask for np.sinc(omega * dt / 2 / np.pi).""",
    points=2,
    fingerprint=lambda f: np.concatenate([_call(f, *case) for case in CURVED]),
)(exact)
arc.holds("ends where the exact arc ends", _on_arc)
arc.holds("drives straight when omega is 0", _straight)
arc.holds("a turn rate of 0.004 rad/s turns the heading as well", _slow)
arc.holds("a turn rate of 1e-11 rad/s costs no digits", _tiny)
arc.holds("takes a cloud in which each particle has its own omega", _cloud_of_turns)
arc.holds("the heading stays in (-pi, pi]", _wrapped)
arc.wrong("""old-heading: drives along the old heading and turns afterwards
    Does the robot keep its heading during the step?
    On an arc the chord points halfway between the headings.
    Use theta + omega * dt / 2 in the cosine and the sine.""")(along(0.0, full))
arc.wrong("""new-heading: turns first and drives along the new heading
    Which heading does the robot have at the start of the step?
    On an arc the chord points halfway between the headings.
    Half of the turn, theta + omega * dt / 2, belongs in the cosine.""")(along(1.0, full))
arc.wrong("""full-length: goes the length of the arc along the chord
    Which is longer, an arc or its chord?
    Shorten the way by sinc(omega dt / 2).
    c = v * dt * np.sinc(omega * dt / 2 / np.pi)""")(along(0.5, full))
arc.wrong("""pi-sinc: uses NumPy's sinc as if it were sin(t) / t
    Look up what np.sinc computes.
    np.sinc(t) is sin(pi t) / (pi t).
    Divide the argument by pi.""")(along(0.5, np.sinc))
arc.wrong("""divides-by-zero: divides by a turn rate that may be zero
    What is v / omega when the robot drives straight?
    sin(t) / t has a limit at zero; a quotient of floats has not.
    Write the arc with np.sinc, which knows the limit.""")(
    naive, when=lambda f: _on_arc(f) and not _straight(f)
)


@arc.wrong(
    """asks one question for the whole cloud
    Each particle will have its own turn rate. Which one does your `if` ask?
    An array has no single truth value; work on all entries at once.
    With np.sinc no case has to be told apart.""",
    when=lambda f: _on_arc(f) and _straight(f) and _breaks(_cloud_of_turns, f),
)
def one_if(pose, v, omega, dt):
    if abs(omega) < 1e-6:
        return along(0.5, full)(pose, v, omega, dt)
    return naive(pose, v, omega, dt)


@arc.wrong(
    """subtracts two nearly equal sines and divides by a tiny turn rate
    How many digits has sin(0.50000000001) - sin(0.5) left?
    Exactly zero is not the only dangerous turn rate.
    Turn the difference of sines into a product: that is the chord with its sinc.""",
    when=lambda f: _straight(f) and _cloud_of_turns(f) and not _tiny(f),
)
def cancels(pose, v, omega, dt):
    straight, curved = along(0.5, full)(pose, v, omega, dt), naive(pose, v, omega, dt)
    return np.where(np.asarray(omega) == 0, straight, curved)


@arc.wrong(
    """keeps the heading of a robot that turns slowly
    A thousand slow steps are a turn. Does yours turn?
    The heading's line holds for every omega.
    theta + omega * dt, also in the straight case.""",
    when=lambda f: _on_arc(f) and not _slow(f),
)
def _stiff(pose, v, omega, dt):
    found = exact(pose, v, omega, dt)
    found[2] = np.where(np.abs(omega) < 1e-2, pose[2], found[2])
    return found


@arc.wrong(
    """lets the heading run over half a turn
    In which interval do headings live in this course?
    In (-pi, pi].
    pf.wrap(theta + omega * dt)""",
    when=lambda f: _on_arc(f) and not _wrapped(f),
)
def _unwrapped(pose, v, omega, dt):
    found = exact(pose, v, omega, dt)
    found[2] = pose[2] + omega * dt
    return found
