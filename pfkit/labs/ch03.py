"""Chapter 3: motion. Questions on arcs, wheels, odometry, and where the errors enter."""

import numpy as np

import pfkit as pf
from pfkit.labs import (
    Choice,
    Code,
    Experiment,
    Lab,
    Misconception,
    Numeric,
    Prediction,
    Property,
    Question,
    Text,
)

# -- predictions --------------------------------------------------------------------------------

rigid = Prediction(
    id="rigid",
    title="One error for the whole cloud, twelve steps long",
    options={
        "a": "as wide: the errors are equally large",
        "b": "half as wide",
        "c": "as wide as at the start: it has not grown at all",
        "d": "wider, because the errors no longer cancel",
    },
    key="c",
)

split = Prediction(
    id="split",
    title="Four seconds in one step, or in sixteen",
    options={
        "a": "the same: it is the same robot",
        "b": "four times as large with the single step",
        "c": "sixteen times as large with the single step",
        "d": "four times as large with the sixteen steps",
    },
    key="b",
)

# -- by hand ------------------------------------------------------------------------------------

hand = Numeric(
    id="hand",
    title="A quarter circle to the right",
    key=(0.318, -0.318),
    tol=0.002,
    unit="m",
    names=("x", "y"),
    hints=(
        "The robot drives a quarter of a circle. How long is the whole circle?",
        "Half a metre is a quarter of the circle, so its circumference is 2 m.",
        "The radius is 2 / (2 pi) = 0.318 m, and a quarter to the right ends at (radius, -radius).",
    ),
    misconceptions=(
        Misconception(
            "drive-then-turn",
            "drives straight on and turns at the end",
            (
                "When does the robot turn: during the second, or after it?",
                "It turns all the time, so its track bends to the right.",
                "The track is a quarter of a circle with a circumference of 2 m.",
            ),
            (0.5, 0.0),
        ),
        Misconception(
            "turn-then-drive",
            "turns first and drives afterwards",
            (
                "Does the robot know its final heading from the first moment on?",
                "It starts towards +x and only ends towards -y.",
                "The track is a quarter of a circle with a radius of 0.318 m.",
            ),
            (0.0, -0.5),
        ),
        Misconception(
            "full-chord",
            "goes the whole half metre in the middle direction",
            (
                "The direction is right. Is the straight way as long as the bent one?",
                "The chord of an arc is shorter than the arc.",
                "The chord is 0.5 sin(pi/4) / (pi/4) = 0.450 m.",
            ),
            (0.354, -0.354),
        ),
        Misconception(
            "left",
            "turns left",
            (
                "Which way does a positive turn rate turn?",
                "Counter-clockwise is positive, and this one is negative.",
                "The robot ends at a negative y.",
            ),
            (0.318, 0.318),
        ),
    ),
)

drift = Numeric(
    id="drift",
    title="Sideways spread after ten steps",
    key=0.392,
    tol=0.004,
    unit="m",
    hints=(
        "How far does the robot still drive after the first turn? And after the last?",
        "The turns act over 10, 9, ... 1 m; independent errors add as squares.",
        "0.02 times the root of 1 + 4 + 9 + ... + 100, which is the root of 385.",
    ),
    misconceptions=(
        Misconception(
            "linear",
            "adds the errors as if all had the same sign",
            (
                "Do ten independent errors all point the same way?",
                "Variances add, standard deviations do not.",
                "Take the root of the sum of squares, 385, not the sum, 55.",
            ),
            1.1,
        ),
        Misconception(
            "final-heading",
            "lets the final heading error act on all ten metres",
            (
                "Was the heading as wrong at the start as it is at the end?",
                "The last turn acts on one metre only.",
                "The levers are 10, 9, ... 1 m.",
            ),
            0.632,
        ),
        Misconception(
            "no-lever",
            "lets each turn act on its own metre only",
            (
                "After a wrong turn, which of the later metres point the right way?",
                "A wrong turn is never taken back: it acts on all metres that follow.",
                "The levers are 10, 9, ... 1 m, not 1 m each.",
            ),
            0.0632,
        ),
    ),
)

# -- vehicles -----------------------------------------------------------------------------------

wheels = Numeric(
    id="wheels",
    title="Speed, turn rate and radius of a robot with two wheels",
    key=(1.0, 0.8, 1.25),
    tol=0.005,
    names=("speed in m/s", "turn rate in rad/s", "radius in m"),
    hints=(
        "How fast does each wheel's rim run? Radius times rad/s.",
        "The rims run at 0.8 and 1.2 m/s; the middle of the axle at their mean.",
        "The turn rate is the difference, 0.4 m/s, over the axle; the radius is v / omega.",
    ),
    misconceptions=(
        Misconception(
            "sum",
            "adds the wheels instead of averaging them",
            (
                "If both rims ran at 1 m/s, how fast would the robot be?",
                "The middle of the axle moves at the mean of the two rims.",
                "v = (0.8 + 1.2) / 2.",
            ),
            (2.0, 0.8, 2.5),
        ),
        Misconception(
            "half-axle",
            "takes half of the difference over the axle",
            (
                "If the left wheel stood still, about which point would the robot turn?",
                "About the left wheel, and the right one is a whole axle away.",
                "omega = (1.2 - 0.8) / 0.5.",
            ),
            (1.0, 0.4, 2.5),
        ),
        Misconception(
            "sign",
            "turns to the wrong side",
            (
                "The right wheel is faster. To which side does the robot turn?",
                "To the left, and left is positive.",
                "omega is right minus left.",
            ),
            (1.0, -0.8, -1.25),
            lambda x: bool(abs(x[1] + 0.8) < 0.005),
        ),
    ),
)

odometry = Numeric(
    id="odometry",
    title="Turn, drive, turn",
    key=(45.0, 1.414, 75.0),
    tol=0.1,
    names=("rot1 in degrees", "trans in m", "rot2 in degrees"),
    hints=(
        "Draw the two poses. In which direction of the map lies the second?",
        "The way goes by (-1, 1): that is 135 degrees on the map, and the nose points to 90.",
        "rot1 = 135 - 90; rot2 = -150 - 90 - rot1, wrapped.",
    ),
    misconceptions=(
        Misconception(
            "no-wrap",
            "turns nearly all the way round at the end",
            (
                "Is there a shorter turn to the same heading?",
                "A turn of -285 degrees ends where one of 75 does, but nobody drives it.",
                "Wrap every difference of angles.",
            ),
            (45.0, 1.414, -285.0),
        ),
        Misconception(
            "map-direction",
            "gives the direction on the map, not the turn",
            (
                "Where does the robot look before it moves?",
                "It already looks at 90 degrees, so it has to turn less.",
                "Subtract the first heading from the direction of the way.",
            ),
            (135.0, 1.414, 75.0),
            lambda x: bool(abs(x[0] - 135) < 0.1),
        ),
        Misconception(
            "arctan",
            "takes an arctangent that cannot tell front from back",
            (
                "In which quadrant does the way (-1, 1) lie?",
                "arctan(1 / -1) and arctan(-1 / 1) are the same number.",
                "Use atan2(1, -1), which is 135 degrees.",
            ),
            (-135.0, 1.414, -105.0),
            lambda x: bool(abs(x[0] + 135) < 0.1),
        ),
    ),
)

vehicle = Choice(
    id="vehicle",
    title="Which robot moves like the assignment's equation?",
    options={
        "a": "a bicycle: it turns only while it rolls",
        "b": "a robot that drives along its old heading and then turns on the spot",
        "c": "a robot that turns on the spot and then drives along its new heading",
        "d": "a robot with two driven wheels, on an exact arc",
    },
    key="b",
    feedback={
        "a": "Put d = 0: the equation still turns the robot, and no bicycle can do that.",
        "b": "Yes: position uses the old heading only, and the turn comes with no condition.",
        "c": "The equation's cosine holds the old heading, not the new one.",
        "d": "On an arc the chord points halfway between old and new heading.",
    },
)

literal = Choice(
    id="literal",
    title="What does the printed equation do?",
    options={
        "a": "it is the usual motion model",
        "b": "it forgets where the robot was, and pushes it along one diagonal only",
        "c": "it forgets the noise of the heading",
        "d": "it turns the robot twice as fast as its wheels say",
    },
    key="b",
    feedback={
        "a": "Look for the previous state on the right-hand side.",
        "b": "Yes: no previous position is added, and x and y share one number as their noise.",
        "c": "The third row has a noise of its own.",
        "d": "The third row is the right turn for one second; what is it added to?",
    },
)

# -- code ---------------------------------------------------------------------------------------


def _sinc(half):
    return np.sinc(half / np.pi)


def _arc(pose, v, omega, dt):
    x, y, theta = pose
    half = omega * dt / 2
    c = v * dt * _sinc(half)
    return np.array(
        [x + c * np.cos(theta + half), y + c * np.sin(theta + half), pf.wrap(theta + 2 * half)]
    )


CURVED = [
    ((1.0, 2.0, 0.5), 1.0, 0.7, 0.5),
    ((0.0, 0.0, -1.0), 2.0, -1.1, 1.5),
    ((-3.0, 1.0, 3.0), -0.5, 0.4, 2.0),
]


def _call(f, pose, v, omega, dt):
    with np.errstate(all="ignore"):
        return np.asarray(f(np.array(pose), v, omega, dt), dtype=float)


def _near(found, wanted, atol=1e-8):
    return bool(
        np.shape(found) == np.shape(wanted)
        and np.allclose(found[:2], wanted[:2], rtol=0, atol=atol)
        and np.allclose(np.cos(found[2] - wanted[2]), 1, rtol=0, atol=1e-12)
    )


def _on_arc(f):
    return all(_near(_call(f, *case), _arc(np.array(case[0]), *case[1:])) for case in CURVED)


def _straight(f):
    return _near(_call(f, (1.0, 2.0, 0.5), 2.0, 0.0, 0.5), [1 + np.cos(0.5), 2 + np.sin(0.5), 0.5])


def _slow(f):
    found = _call(f, (0.0, 0.0, 0.2), 1.0, 4e-3, 1.0)
    return bool(np.isclose(found[2], 0.204, rtol=0, atol=1e-9))


def _tiny(f):
    case = (np.array((1.0, 2.0, 0.5)), 1.0, 1e-11, 1.0)
    return _near(_call(f, *case), _arc(*case))


def _cloud_of_turns(f):
    pose = np.array([[0.0, 1.0, 2.0], [0.0, 0.0, 1.0], [0.1, 0.2, 0.3]])
    omega = np.array([0.0, 0.5, -1.0])
    return _near(_call(f, pose, 1.0, omega, 0.5), _arc(pose, 1.0, omega, 0.5))


def _breaks(test, f):
    """Is the test failed, or not even survived?"""
    try:
        return not test(f)
    except Exception:
        return True


def _wrapped(f):
    found = _call(f, (0.0, 0.0, 3.0), 1.0, 1.0, 0.5)[2]
    return bool(-np.pi < found <= np.pi)


def _along(share, bend=False):
    """Drive along theta + share * turn, with the arc's chord or its full length."""

    def arc(pose, v, omega, dt):
        x, y, theta = pose
        turn = omega * dt
        c = v * dt * (_sinc(turn / 2) if bend else 1.0)
        way = theta + share * turn
        return np.array([x + c * np.cos(way), y + c * np.sin(way), pf.wrap(theta + turn)])

    return arc


def _naive(pose, v, omega, dt):
    x, y, theta = pose
    end = theta + np.asarray(omega) * dt
    with np.errstate(all="ignore"):
        radius = np.divide(v, omega)
        x1 = x + radius * (np.sin(end) - np.sin(theta))
        y1 = y + radius * (np.cos(theta) - np.cos(end))
    return np.array([x1, y1, pf.wrap(end)])


def _if(pose, v, omega, dt):
    if abs(omega) < 1e-6:
        return _along(0.5)(pose, v, omega, dt)
    return _naive(pose, v, omega, dt)


def _two_cases(pose, v, omega, dt):
    straight, curved = _along(0.5)(pose, v, omega, dt), _naive(pose, v, omega, dt)
    return np.where(np.asarray(omega) == 0, straight, curved)


def _stiff(pose, v, omega, dt):
    found = _arc(pose, v, omega, dt)
    found[2] = np.where(np.abs(omega) < 1e-2, pose[2], found[2])
    return found


def _unwrapped(pose, v, omega, dt):
    found = _arc(pose, v, omega, dt)
    found[2] = pose[2] + omega * dt
    return found


arc = Code(
    id="arc",
    title="Follow an arc, straight ones too",
    points=2,
    reference=_arc,
    properties=(
        Property("ends where the exact arc ends", _on_arc),
        Property("drives straight when omega is 0", _straight),
        Property("a turn rate of 0.004 rad/s turns the heading as well", _slow),
        Property("a turn rate of 1e-11 rad/s costs no digits", _tiny),
        Property("takes a cloud in which each particle has its own omega", _cloud_of_turns),
        Property("the heading stays in (-pi, pi]", _wrapped),
    ),
    fingerprint=lambda f: np.concatenate([_call(f, *case) for case in CURVED]),
    hints=(
        "Use the chord: its length, and its direction.",
        "The chord has length v dt sinc(omega dt / 2) and points to theta + omega dt / 2.",
        "np.sinc(t) is sin(pi t) / (pi t), so ask for np.sinc(omega * dt / 2 / np.pi).",
    ),
    misconceptions=(
        Misconception(
            "old-heading",
            "drives along the old heading and turns afterwards",
            (
                "Does the robot keep its heading during the step?",
                "On an arc the chord points halfway between the headings.",
                "Use theta + omega * dt / 2 in the cosine and the sine.",
            ),
            _along(0.0),
        ),
        Misconception(
            "new-heading",
            "turns first and drives along the new heading",
            (
                "Which heading does the robot have at the start of the step?",
                "On an arc the chord points halfway between the headings.",
                "Half of the turn, theta + omega * dt / 2, belongs in the cosine.",
            ),
            _along(1.0),
        ),
        Misconception(
            "full-length",
            "goes the length of the arc along the chord",
            (
                "Which is longer, an arc or its chord?",
                "Shorten the way by sinc(omega dt / 2).",
                "c = v * dt * np.sinc(omega * dt / 2 / np.pi)",
            ),
            _along(0.5),
        ),
        Misconception(
            "pi-sinc",
            "uses NumPy's sinc as if it were sin(t) / t",
            (
                "Look up what np.sinc computes.",
                "np.sinc(t) is sin(pi t) / (pi t).",
                "Divide the argument by pi.",
            ),
            lambda pose, v, omega, dt: _along(0.5)(pose, v * np.sinc(omega * dt / 2), omega, dt),
        ),
        Misconception(
            "divides-by-zero",
            "divides by a turn rate that may be zero",
            (
                "What is v / omega when the robot drives straight?",
                "sin(t) / t has a limit at zero; a quotient of floats has not.",
                "Write the arc with np.sinc, which knows the limit.",
            ),
            _naive,
            lambda f: _on_arc(f) and not _straight(f),
        ),
        Misconception(
            "one-if",
            "asks one question for the whole cloud",
            (
                "Each particle will have its own turn rate. Which one does your `if` ask?",
                "An array has no single truth value; work on all entries at once.",
                "With np.sinc no case has to be told apart.",
            ),
            _if,
            lambda f: _on_arc(f) and _straight(f) and _breaks(_cloud_of_turns, f),
        ),
        Misconception(
            "cancels",
            "subtracts two nearly equal sines and divides by a tiny turn rate",
            (
                "How many digits has sin(0.50000000001) - sin(0.5) left?",
                "Exactly zero is not the only dangerous turn rate.",
                "Turn the difference of sines into a product: that is the chord with its sinc.",
            ),
            _two_cases,
            lambda f: _straight(f) and _cloud_of_turns(f) and not _tiny(f),
        ),
        Misconception(
            "stiff",
            "keeps the heading of a robot that turns slowly",
            (
                "A thousand slow steps are a turn. Does yours turn?",
                "The heading's line holds for every omega.",
                "theta + omega * dt, also in the straight case.",
            ),
            _stiff,
            lambda f: _on_arc(f) and not _slow(f),
        ),
        Misconception(
            "unwrapped",
            "lets the heading run over half a turn",
            (
                "In which interval do headings live in this course?",
                "In (-pi, pi].",
                "pf.wrap(theta + omega * dt)",
            ),
            _unwrapped,
            lambda f: _on_arc(f) and not _wrapped(f),
        ),
    ),
)


def _sample(pose, u, alpha, rng):
    v, omega, dt = u
    M = pose.shape[1]
    v_hat = v + np.sqrt(alpha[0] * v**2 + alpha[1] * omega**2) * rng.standard_normal(M)
    omega_hat = omega + np.sqrt(alpha[2] * v**2 + alpha[3] * omega**2) * rng.standard_normal(M)
    return _arc(pose, v_hat, omega_hat, dt)


def _ends(f, u, alpha, M=4000, seed=5):
    found = f(np.zeros((3, M)), np.array(u), alpha, np.random.default_rng(seed))
    return np.asarray(found, dtype=float)


def _says(found, wanted):
    ok = abs(found / wanted - 1) < 0.08
    return True if ok else f"found a standard deviation of {found:.4f}, not {wanted:.4f}"


def _noise_free(f):
    pose = np.array([[0.0, 1.0], [2.0, 3.0], [0.5, -2.0]])
    found = f(pose.copy(), np.array((1.0, 0.4, 0.5)), (0, 0, 0, 0), np.random.default_rng(1))
    return _near(np.asarray(found), _arc(pose, 1.0, 0.4, 0.5))


def _own(f):
    x, _, theta = _ends(f, (1.0, 0.3, 0.5), (0.02, 0.01, 0.05, 0.05), 50)
    return bool(np.unique(x).size == 50 and np.unique(theta).size == 50)


def _speed(f):
    return _says(_ends(f, (2.0, 0.0, 0.5), (0.04, 0, 0, 0))[0].std(), 0.2)


def _turns(f):
    return _says(_ends(f, (1.0, 0.8, 0.5), (0, 0, 0.04, 0.09))[2].std(), 0.1562)


def _cross(f):
    x, y, _ = _ends(f, (0.0, 1.0, 0.5), (0, 0.04, 0, 0))
    return _says(np.sqrt(np.mean(x**2 + y**2)), 0.1 * _sinc(0.25))


def _still(f):
    return bool(np.abs(_ends(f, (0.0, 0.0, 0.5), (0.1, 0.1, 0.1, 0.1), 20)).max() == 0)


def _bends(f):
    x, y, theta = _ends(f, (1.0, 0.0, 1.0), (0, 0, 0.05, 0), 200)
    return bool(
        np.allclose(x, _sinc(theta / 2) * np.cos(theta / 2), atol=1e-9)
        and np.allclose(y, _sinc(theta / 2) * np.sin(theta / 2), atol=1e-9)
        and theta.std() > 0
    )


def _one_error(pose, u, alpha, rng):
    v, omega, dt = u
    v_hat = v + np.sqrt(alpha[0] * v**2 + alpha[1] * omega**2) * rng.standard_normal()
    omega_hat = omega + np.sqrt(alpha[2] * v**2 + alpha[3] * omega**2) * rng.standard_normal()
    return _arc(pose, v_hat, omega_hat, dt)


def _on_pose(pose, u, alpha, rng):
    v, omega, dt = u
    moved, M = _arc(pose, v, omega, dt), pose.shape[1]
    sd = np.sqrt(alpha[0] * v**2 + alpha[1] * omega**2) * dt
    moved[:2] += sd * rng.standard_normal((2, M))
    moved[2] += np.sqrt(alpha[2] * v**2 + alpha[3] * omega**2) * dt * rng.standard_normal(M)
    return moved


def _constant(pose, u, alpha, rng):
    v, omega, dt = u
    M = pose.shape[1]
    v_hat = v + np.sqrt(alpha[0]) * rng.standard_normal(M)
    omega_hat = omega + np.sqrt(alpha[2]) * rng.standard_normal(M)
    return _arc(pose, v_hat, omega_hat, dt)


def _no_root(pose, u, alpha, rng):
    v, omega, dt = u
    M = pose.shape[1]
    v_hat = v + (alpha[0] * v**2 + alpha[1] * omega**2) * rng.standard_normal(M)
    omega_hat = omega + (alpha[2] * v**2 + alpha[3] * omega**2) * rng.standard_normal(M)
    return _arc(pose, v_hat, omega_hat, dt)


sample = Code(
    id="sample",
    title="Each particle with errors of its own",
    points=2,
    reference=_sample,
    properties=(
        Property("with all alphas 0 it is the arc", _noise_free),
        Property("every particle ends somewhere else", _own),
        Property("speed has the variance alpha_1 v^2, within 8 %", _speed),
        Property("turn rate has alpha_3 v^2 + alpha_4 omega^2, within 8 %", _turns),
        Property("turning on the spot slips by alpha_2 omega^2, within 8 %", _cross),
        Property("a robot at rest gets no error", _still),
        Property("an error in omega bends the track and turns the heading", _bends),
    ),
    hints=(
        "First draw M wrong speeds and M wrong turn rates, then drive M arcs.",
        "np.sqrt(variance) * rng.standard_normal(M), with M = pose.shape[1].",
        "v_hat = v + np.sqrt(a1 * v**2 + a2 * omega**2) * rng.standard_normal(M), and arc(...).",
    ),
    misconceptions=(
        Misconception(
            "one-error",
            "draws one error for the whole cloud",
            (
                "How many random numbers does your function draw for 50 particles?",
                "One robot errs once, but each particle is a different guess at that robot.",
                "rng.standard_normal(M) gives each particle its own.",
            ),
            _one_error,
            lambda f: not _own(f),
        ),
        Misconception(
            "on-pose",
            "adds its errors to the pose after a perfect drive",
            (
                "A wheel slips during the drive. Where does the robot end that turned too far?",
                "Put the error into v and omega, and drive the wrong arc exactly.",
                "Draw v_hat and omega_hat first, then call arc with them.",
            ),
            _on_pose,
            lambda f: _own(f) and _still(f) and not _bends(f),
        ),
        Misconception(
            "constant",
            "gives the same error to a robot at rest and to one at full speed",
            (
                "Should a parked robot drift?",
                "The variances multiply v^2 and omega^2.",
                "alpha_1 * v**2 + alpha_2 * omega**2",
            ),
            _constant,
            lambda f: not _still(f),
        ),
        Misconception(
            "no-root",
            "takes the variance for a standard deviation",
            (
                "What does a standard normal draw have to be multiplied by?",
                "By the standard deviation, the root of the variance.",
                "np.sqrt(alpha_1 * v**2 + alpha_2 * omega**2)",
            ),
            _no_root,
            lambda f: _own(f) and _still(f) and _bends(f) and _speed(f) is not True,
        ),
    ),
)

# -- experiments --------------------------------------------------------------------------------


ALPHA = (0.02, 0.002, 0.05, 0.05, 0.005, 0.005)
U = (1.0, 0.3, 0.5)


def _spreads(rng, M=500, steps=12):
    """Spread (m) of a cloud after twelve steps: with own errors, and with common ones."""
    motion, u = pf.VelocityMotion(ALPHA), np.array(U)
    own = together = np.array([[0.1], [0.1], [0.0]]) * rng.standard_normal((3, M))
    for _ in range(steps):
        own = motion.sample(own, u, rng)
        error = np.sqrt(motion.variances(u)) * rng.standard_normal(3)
        together = motion.mean(together, u + error * (1, 1, 0))
        together[2] = pf.wrap(together[2] + error[2] * u[2])
    return [np.sqrt(cloud[:2].var(axis=1).sum()) for cloud in (own, together)]


def _rigid_run(rng):
    own, together = _spreads(rng)
    return own / together


rigid_x = Experiment(
    id="rigid_x",
    title="Own errors against common ones",
    points=2,
    after="rigid",
    runs=20,
    claim="a cloud with common errors does not grow; one with errors of its own does",
    test="mean ratio of the spreads over 20 runs between 8.5 and 10.5",
    reference=_rigid_run,
    properties=(
        Property("the mean ratio lies between 8.5 and 10.5", lambda x: bool(8.5 < x.mean() < 10.5)),
        Property("the runs differ", lambda x: bool(x.std() > 1e-6)),
    ),
    margin="the ratio has mean 9.47 and sd 0.35; the mean of 20 has 0.08: 12 standard errors",
    hints=(
        "Start both clouds from the same 500 poses: 0.1 m of spread in x and y, heading 0.",
        "Use motion.sample(cloud, u, rng) for one, together(cloud, u, rng) for the other.",
        "The spread is np.sqrt(cloud[:2].var(axis=1).sum()); return own / common.",
    ),
    misconceptions=(
        Misconception(
            "upside-down",
            "divides the common spread by the own one",
            (
                "Which cloud is the wide one?",
                "The ratio should say how much wider own errors make the cloud.",
                "Return own / common.",
            ),
            lambda rng: 1 / _rigid_run(rng),
            lambda x: bool((x < 0.5).all()),
        ),
        Misconception(
            "both-own",
            "gives both clouds errors of their own",
            (
                "How many random numbers does a step of the second cloud draw?",
                "Three numbers for the whole cloud, not three for each particle.",
                "Use together(cloud, u, rng) for the second cloud.",
            ),
            lambda rng: _spreads(rng)[0] / _spreads(rng)[0],
            lambda x: bool(0.6 < x.mean() < 1.6),
        ),
        Misconception(
            "variances",
            "compares variances instead of standard deviations",
            (
                "Is your ratio one of lengths or of squared lengths?",
                "A spread is a length: take the root.",
                "np.sqrt(cloud[:2].var(axis=1).sum())",
            ),
            lambda rng: _rigid_run(rng) ** 2,
            lambda x: bool(60 < x.mean() < 220),
        ),
    ),
)


def _split_sds(rng, M=2000, parts=16, scaled=False):
    """Standard deviations (m) of the distance: one step of four seconds, and in parts."""
    found = []
    for n in (1, parts):
        motion = pf.VelocityMotion((0.02 * (n if scaled else 1), 0, 0, 0))
        cloud = np.zeros((3, M))
        for _ in range(n):
            cloud = motion.sample(cloud, np.array((1.0, 0.0, 4.0 / n)), rng)
        found.append(cloud[0].std())
    return found


def _split_run(rng, **kwargs):
    whole, parts = _split_sds(rng, **kwargs)
    return whole / parts


split_x = Experiment(
    id="split_x",
    title="One step against sixteen",
    points=2,
    after="split",
    runs=20,
    claim="a drive cut into 16 steps has a quarter of the standard deviation",
    test="mean ratio over 20 runs between 3.8 and 4.2",
    reference=_split_run,
    properties=(
        Property("the mean ratio lies between 3.8 and 4.2", lambda x: bool(3.8 < x.mean() < 4.2)),
        Property("the runs differ", lambda x: bool(x.std() > 1e-6)),
    ),
    margin="the ratio has mean 4 and sd 0.09; the mean of 20 has 0.02: 10 standard errors",
    hints=(
        "Drive 2,000 particles straight for four seconds, twice: in one step and in sixteen.",
        "u is (1, 0, 4) once, and (1, 0, 0.25) sixteen times; alpha is (0.02, 0, 0, 0) both times.",
        "Return the standard deviation of x after one step over that after sixteen.",
    ),
    misconceptions=(
        Misconception(
            "variances",
            "compares variances",
            (
                "Is it a ratio of lengths or of squared lengths?",
                "The prediction speaks of standard deviations.",
                "Use .std(), not .var().",
            ),
            lambda rng: _split_run(rng) ** 2,
            lambda x: bool(14 < x.mean() < 18),
        ),
        Misconception(
            "upside-down",
            "finds the larger spread after the sixteen steps",
            (
                "Is the ratio turned over, or do your two drives last differently long?",
                "Sixteen steps of 4 / 16 s each; the spread of the single step goes on top.",
                "Return whole / parts, with dt = 4 and dt = 0.25.",
            ),
            lambda rng: 1 / _split_run(rng),
            lambda x: bool(0.2 < x.mean() < 0.3),
        ),
        Misconception(
            "scaled",
            "scales the noise with the number of steps",
            (
                "Did you change alpha between the drives?",
                "The question is what happens to the same alpha.",
                "Keep alpha = (0.02, 0, 0, 0) for both.",
            ),
            lambda rng: _split_run(rng, scaled=True),
            lambda x: bool(0.9 < x.mean() < 1.1),
        ),
    ),
)

why = Text(
    id="why",
    title="Why a banana, and why draw anew?",
    rubric=(
        "says that an error in the turn rate changes heading and position together",
        "says that an early heading error acts on the whole way that follows",
        "says that particles are different guesses, so each needs errors of its own",
    ),
    model=(
        "A wrong turn rate bends the track, so heading and position are wrong together. "
        "An early error acts over the whole way that follows, which bends the cloud into a banana. "
        "Each particle is a guess at what the robot did and needs errors of its own."
    ),
)

LAB = Lab(
    "ch03",
    "Chapter 3: motion",
    [
        Question("predict", "Predictions", (rigid, split)),
        Question("hand", "By hand", (hand, drift)),
        Question("vehicles", "Vehicles and odometers", (wheels, odometry, vehicle, literal)),
        Question("code", "Code", (arc, sample)),
        Question("break", "Experiments", (rigid_x, split_x, why)),
    ],
)
check, use, predict, answer, summary, save, load = LAB.verbs()
