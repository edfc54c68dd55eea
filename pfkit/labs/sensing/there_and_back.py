"""From a pose to its reading, and from the reading to the landmark."""

import numpy as np

import pfkit as pf
from pfkit.labs import Question, code

CODE = Question("Code")


def poses_at_random(seed, M=40):
    """Poses (3, M), headings too."""
    rng = np.random.default_rng(seed)
    return rng.uniform((-5, -5, -3), (5, 5, 3), (M, 3)).T


LANDMARK = np.array([1.2, -0.7])


def _apart(a, b):
    """Largest difference of two sets of angles on the circle."""
    return float(np.abs(pf.wrap(np.asarray(a) - b)).max())


def _ranges(f):
    pose = poses_at_random(1)
    return np.allclose(f(pose, LANDMARK)[0], expected(pose, LANDMARK)[0])


def _bearings(f):
    pose = poses_at_random(2)
    return _apart(f(pose, LANDMARK)[1], expected(pose, LANDMARK)[1]) < 1e-9


def _wrapped(f):
    phi = np.asarray(f(poses_at_random(3, 400), LANDMARK)[1])
    return (phi > -np.pi - 1e-9).all() and (phi < np.pi + 1e-9).all()


def _rigid(f):
    """Turn and shift the world with the robot in it: nothing it measures changes."""
    pose, (c, s) = poses_at_random(4), (np.cos(0.9), np.sin(0.9))

    def move(x, y):
        return np.array((c * x - s * y + 2, s * x + c * y - 1))

    moved = np.vstack((move(*pose[:2]), pf.wrap(pose[2] + 0.9)))
    here, there = f(pose, LANDMARK), f(moved, move(*LANDMARK))
    return np.allclose(here[0], there[0]) and _apart(here[1], there[1]) < 1e-9


def _both(f):
    r, phi = f(poses_at_random(5), LANDMARK)
    return np.concatenate((np.ravel(r), np.ravel(phi)))


def _raw(pose, m):
    return np.arctan2(m[1] - pose[1], m[0] - pose[0])


def _with(bearing):
    """The right range with another bearing."""
    return lambda pose, m: (expected(pose, m)[0], bearing(pose, m))


@code(
    """Range and bearing that a pose expects
    Take the vector from robot to landmark: its length, and its direction on the map.
    np.hypot(dx, dy) and np.arctan2(dy, dx); then the heading.
    phi = pf.wrap(np.arctan2(dy, dx) - pose[2])""",
    fingerprint=_both,
)
def expected(pose, m):
    """Range and bearing that a pose expects of a landmark."""
    dx, dy = m[0] - pose[0], m[1] - pose[1]
    return np.hypot(dx, dy), pf.wrap(np.arctan2(dy, dx) - pose[2])


expected.holds("ranges are distances, in metres", _ranges)
expected.holds("bearings point from the robot's nose, up to whole turns", _bearings)
expected.holds("bearings lie between -pi and pi", _wrapped)
expected.holds("nothing changes when world and robot turn together", _rigid)
expected.wrong("""no-heading: forgets the heading
    The robot turns on the spot. Does your bearing change?
    A bearing is measured from the nose.
    Subtract pose[2], then wrap.""")(_with(_raw))
expected.wrong("""no-wrap: does not wrap
    Look at the largest of your bearings.
    A difference of two angles can be nearly two turns wide.
    Put pf.wrap(...) round the difference.""")(_with(lambda pose, m: _raw(pose, m) - pose[2]))
expected.wrong("""arctan: uses arctan of the quotient, which knows only half of the circle
    Put the landmark behind the robot.
    dy / dx forgets which of the two was negative.
    np.arctan2(dy, dx) keeps both signs.""")(
    _with(lambda x, m: pf.wrap(np.arctan((m[1] - x[1]) / (m[0] - x[0])) - x[2]))
)
expected.wrong("""reversed: looks from the landmark to the robot: half a turn off
    Where does your vector start?
    Landmark minus robot, not robot minus landmark.
    dx, dy = m[0] - pose[0], m[1] - pose[1]""")(
    _with(lambda pose, m: pf.wrap(_raw(pose, m) + np.pi - pose[2]))
)
expected.wrong("""plus-heading: adds the heading
    Turn left: does the landmark move to the left or to the right?
    The bearing falls as the heading grows.
    Subtract pose[2].""")(_with(lambda pose, m: pf.wrap(_raw(pose, m) + pose[2])))
expected.wrong("""degrees: answers in degrees
    Which unit has the heading?
    All angles here are in radians.
    Leave np.degrees away.""")(_with(lambda pose, m: np.degrees(expected(pose, m)[1])))


def _returns(poses):
    def holds(f):
        r, phi = expected(poses, LANDMARK)
        x, y = f(poses, r, phi)
        return np.allclose(x, LANDMARK[0]) and np.allclose(y, LANDMARK[1])

    return holds


@code(
    """Where a measurement puts its landmark
    In which direction of the map does the beam fly?
    The heading plus the bearing.
    x + r * cos(theta + phi), y + r * sin(theta + phi)""",
    fingerprint=lambda f: np.ravel(f(poses_at_random(8), *expected(poses_at_random(8), LANDMARK))),
)
def place(pose, r, phi):
    x, y, theta = pose
    return x + r * np.cos(theta + phi), y + r * np.sin(theta + phi)


place.holds(
    "3 m straight ahead of (2, 1), heading 0, is (5, 1)",
    lambda f: np.allclose(f(np.array([2.0, 1.0, 0.0]), 3.0, 0.0), (5.0, 1.0)),
)
place.holds(
    "the round trip comes home for heading 0",
    _returns(poses_at_random(6) * np.array([[1], [1], [0]])),
)
place.holds("the round trip comes home for every heading", _returns(poses_at_random(7)))
place.wrong("""no-heading: forgets the heading, which a test with heading 0 cannot notice
    Try a robot that looks along the y axis.
    The bearing counts from the nose; the map counts from the x axis.
    The direction on the map is theta + phi.""")(
    lambda pose, r, phi: place(np.array((*pose[:2], 0 * pose[2])), r, phi)
)
place.wrong("""minus-heading: subtracts the heading
    You subtracted it to get the bearing. How do you go back?
    Undo a subtraction by an addition.
    theta + phi""")(lambda pose, r, phi: place(np.array((*pose[:2], -pose[2])), r, phi))
place.wrong("""from-origin: starts at the origin instead of the robot
    Where does the beam start?
    r and phi give a vector; add it to a place.
    x + ..., y + ...""")(
    lambda pose, r, phi: place(pose * np.array([0, 0, 1]).reshape(3, *[1] * np.ndim(r)), r, phi)
)
place.wrong("""swapped: swaps sine and cosine
    What is straight ahead of a robot that looks along x?
    cos goes with x.
    x + r * cos(...), y + r * sin(...)""")(
    lambda pose, r, phi: (pose[0] + r * np.sin(pose[2] + phi), pose[1] + r * np.cos(pose[2] + phi))
)
