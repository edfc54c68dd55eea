"""Motion. Where can a robot be that did what it was told, a little wrong at every step?

Every arc here is a function of (pose, v, omega, dt), every sampler one of (pose, u, alpha, rng),
every density one of (pose1, u, alpha, pose0).
"""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment
from pfkit.labs.response import calls, same_mean, same_scatter

PREDICT = Question("Predictions")

rigid = Prediction("""One error for the whole cloud, twelve steps long
    a  as wide: the errors are equally large
    b  half as wide
    c* as wide as at the start: it has not grown at all
    d  wider, because the errors no longer cancel""")

split = Prediction("""Four seconds in one step, or in sixteen
    a  the same: it is the same robot
    b* four times as large with the single step
    c  sixteen times as large with the single step
    d  four times as large with the sixteen steps""")

HAND = Question("By hand")


def _side(side):
    return 1 if side == "left" else -1


def _another_quarter(rng):
    length = int(rng.integers(3, 13)) / 10
    return {"length": length, "side": ("left", "right")[int(rng.integers(2))]}


hand = Numeric(
    """End of a quarter circle of {length} m to the {side}
    The robot drives a quarter of a circle. How long is the whole circle?
    {length} m is a quarter of it, so the circumference is 4 x {length} m.
    The radius is the circumference over 2 pi, and the robot ends one radius ahead and one radius
         to the {side}.""",
    lambda length, side: (2 * length / np.pi, _side(side) * 2 * length / np.pi),
    tol=0.002,
    unit="m",
    names=("x", "y"),
    world={"length": 0.5, "side": "right"},
    draw=_another_quarter,
)
hand.wrong("""drive-then-turn: drives straight on and turns at the end
    When does the robot turn: during the drive, or after it?
    It turns all the time, so its track bends to the {side}.
    The track is a quarter of a circle with a circumference of 4 x {length} m.""")(
    lambda length, side: (length, 0.0)
)
hand.wrong("""turn-then-drive: turns first and drives afterwards
    Does the robot know its final heading from the first moment on?
    It starts towards +x and only ends looking to the {side}.
    The track is a quarter of a circle with a circumference of 4 x {length} m.""")(
    lambda length, side: (0.0, _side(side) * length)
)
hand.wrong("""full-chord: goes the length of the arc in the middle direction
    The direction is right. Is the straight way as long as the bent one?
    The chord of an arc is shorter than the arc.
    The chord is {length} sin(pi/4) / (pi/4).""")(
    lambda length, side: (length * np.sqrt(0.5), _side(side) * length * np.sqrt(0.5))
)
hand.wrong("""other-side: turns to the other side
    Which way does a positive turn rate turn?
    Counter-clockwise is positive, which is to the left.
    A turn to the {side} decides the sign of y.""")(
    lambda length, side: (2 * length / np.pi, -_side(side) * 2 * length / np.pi)
)

CODE = Question("Code")


CURVED = [
    ((1.0, 2.0, 0.5), 1.0, 0.7, 0.5),
    ((0.0, 0.0, -1.0), 2.0, -1.1, 1.5),
    ((-3.0, 1.0, 3.0), -0.5, 0.4, 2.0),
]


def sinc(half):
    return np.sinc(half / np.pi)


def full(half):
    return np.ones_like(half)


def along(share, chord=sinc):
    """Drive along theta + share * turn; `chord` shortens the way, or (`full`) does not."""

    def drive(pose, v, omega, dt):
        x, y, theta = pose
        turn = omega * dt
        c = v * dt * chord(turn / 2)
        way = theta + share * turn
        return np.array([x + c * np.cos(way), y + c * np.sin(way), pf.wrap(theta + turn)])

    return drive


def _call(f, pose, v, omega, dt):
    with np.errstate(all="ignore"):
        return np.asarray(f(np.array(pose), v, omega, dt), dtype=float)


def near(found, wanted, atol=1e-8):
    return (
        np.shape(found) == np.shape(wanted)
        and np.allclose(found[:2], wanted[:2], rtol=0, atol=atol)
        and np.allclose(np.cos(found[2] - wanted[2]), 1, rtol=0, atol=1e-12)
    )


def _ends_as(f, *case):
    return near(_call(f, *case), arc(np.array(case[0]), *case[1:]))


def _on_arc(f):
    return all(_ends_as(f, *case) for case in CURVED)


def _straight(f):
    return near(_call(f, (1.0, 2.0, 0.5), 2.0, 0.0, 0.5), [1 + np.cos(0.5), 2 + np.sin(0.5), 0.5])


SLOW = ((0.0, 0.0, 0.2), 1.0, 4e-3, 1.0)


def _turns_slowly(f):
    return np.isclose(_call(f, *SLOW)[2], 0.204, rtol=0, atol=1e-9)


def _tiny(f):
    return _ends_as(f, (1.0, 2.0, 0.5), 1.0, 1e-11, 1.0)


def _cloud_of_turns(f):
    pose = np.array([[0.0, 1.0, 2.0], [0.0, 0.0, 1.0], [0.1, 0.2, 0.3]])
    omega = np.array([0.0, 0.5, -1.0])
    return near(_call(f, pose, 1.0, omega, 0.5), arc(pose, 1.0, omega, 0.5))


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


@code(
    """Follow an arc, straight ones too
    Use the chord: its length, and its direction.
    The chord has length v dt sinc(omega dt / 2) and points to theta + omega dt / 2.
    np.sinc(t) is sin(pi t) / (pi t), so ask for np.sinc(omega * dt / 2 / np.pi).""",
    points=2,
    fingerprint=lambda f: np.concatenate([_call(f, *case) for case in CURVED]),
)
def arc(pose, v, omega, dt):
    x, y, theta = pose
    half = omega * dt / 2
    chord = v * dt * np.sinc(half / np.pi)
    way = theta + half
    return np.array([x + chord * np.cos(way), y + chord * np.sin(way), pf.wrap(way + half)])


arc.holds("ends where the exact arc ends", _on_arc)
arc.holds("drives straight when omega is 0", _straight)
arc.holds(
    "a turn rate of 0.004 rad/s bends the way and turns the heading", lambda f: _ends_as(f, *SLOW)
)
arc.holds("a turn rate of 1e-11 rad/s costs no digits", _tiny)
arc.holds("takes a cloud in which each particle has its own omega", _cloud_of_turns)
arc.holds("the heading stays in (-pi, pi]", _wrapped)
arc.holds(
    "you wrote it yourself",
    lambda f: not calls(lambda: _call(f, *CURVED[0]), pf.drive_arc),
)
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
    naive, when=lambda f: _on_arc(f) and _breaks(_straight, f)
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
    when=lambda f: _on_arc(f) and not _turns_slowly(f),
)
def _stiff(pose, v, omega, dt):
    found = arc(pose, v, omega, dt)
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
    found = arc(pose, v, omega, dt)
    found[2] = pose[2] + omega * dt
    return found


@arc.refuses("a straight line below 0.01 rad/s, with the heading turned")
def _no_slow_bend(pose, v, omega, dt):
    found, slow = arc(pose, v, omega, dt), np.abs(omega) < 1e-2
    found[:2] = np.where(slow, along(0.5, full)(pose, v, 0 * omega, dt)[:2], found[:2])
    return found


arc.refuses("two terms of the series for the chord")(along(0.5, lambda half: 1 - half**2 / 6))
arc.refuses("the sinc of the whole turn")(along(0.5, lambda half: sinc(2 * half)))


@arc.refuses("headings from 0 to 2 pi", named="unwrapped")
def _from_zero(pose, v, omega, dt):
    found = arc(pose, v, omega, dt)
    found[2] %= 2 * np.pi
    return found


arc.refuses("calls the package")(lambda pose, v, omega, dt: pf.drive_arc(pose, v * dt, omega * dt))


def _variances(u, alpha):
    v, omega, _ = u
    return np.array((alpha[0] * v**2 + alpha[1] * omega**2, alpha[2] * v**2 + alpha[3] * omega**2))


def _drive(pose, u, errors):
    return arc(pose, u[0] + errors[0], u[1] + errors[1], u[2])


def _with(variances):
    """A sampler whose errors have other variances; it draws speeds before turn rates."""

    def sample(pose, u, alpha, rng):
        draws = rng.standard_normal((2, pose.shape[1]))
        return _drive(pose, u, np.sqrt(variances(u, alpha))[:, None] * draws)

    return sample


def _ends(f, u, alpha, M=4000, seed=5):
    found = f(np.zeros((3, M)), np.array(u), alpha, np.random.default_rng(seed))
    return np.asarray(found, dtype=float)


BUSY, TOLD = (1.0, 0.8, 0.5), (0.04, 0.01, 0.02, 0.09)


def _errors(f, u=BUSY, alpha=TOLD):
    """Errors (2, M) of speed and turn rate that the ends of a cloud tell of."""
    distance, turn, _ = pf.inverse_arc(np.zeros(3), _ends(f, u, alpha))
    return np.array((distance / u[2] - u[0], turn / u[2] - u[1]))


def _of(f, u, alpha, row):
    """Is the standard deviation of one error right, within 8 %?"""
    found = _errors(f, u, alpha)[row].std()
    wanted = np.sqrt(_variances(u, alpha)[row])
    ok = abs(found - wanted) < 0.08 * wanted
    return True if ok else f"found a standard deviation of {found:.4f}, not {wanted:.4f}"


def _scatters_as(variances):
    """Have the errors those variances, within 15 %, and not those that are right?"""
    wanted = variances(BUSY, TOLD)

    def holds(f):
        z = _errors(f)
        return np.unique(z[0]).size > 50 and np.allclose(z.var(axis=1), wanted, 0.15, 1e-9)

    return holds


def _noise_free(f):
    pose = np.array([[0.0, 1.0], [2.0, 3.0], [0.5, -2.0]])
    found = f(pose.copy(), np.array((1.0, 0.4, 0.5)), (0, 0, 0, 0), np.random.default_rng(1))
    return near(np.asarray(found), arc(pose, 1.0, 0.4, 0.5))


def _own(f):
    x, _, theta = _ends(f, BUSY, (0.02, 0.01, 0.05, 0.05), 50)
    return np.unique(x).size == 50 and np.unique(theta).size == 50


def _still(f):
    return np.abs(_ends(f, (0.0, 0.0, 0.5), (0.1, 0.1, 0.1, 0.1), 20)).max() == 0


def _slips(f):
    x, y, _ = _ends(f, (0.0, 1.0, 0.5), (0, 0.04, 0, 0))
    return abs(np.sqrt(np.mean(x**2 + y**2)) / (0.1 * sinc(0.25)) - 1) < 0.08


def _bends(f):
    ends = _ends(f, BUSY, TOLD, 200)
    distance, turn, extra = pf.inverse_arc(np.zeros(3), ends)
    return np.abs(extra).max() < 1e-9 and bool(np.ptp(turn) > 0 and np.ptp(distance) > 0)


def _apart(f):
    return abs(np.corrcoef(_errors(f))[0, 1]) < 0.08


def _normal(f):
    z = _errors(f)
    z = (z - z.mean(axis=1, keepdims=True)) / z.std(axis=1, keepdims=True)
    return bool((np.abs((z**4).mean(axis=1) - 3) < 0.5).all())


def _from_rng(f):
    a, b, c = (_ends(f, BUSY, TOLD, 20, seed) for seed in (1, 1, 2))
    return np.array_equal(a, b) and not np.allclose(a, c)


@code(
    """Each particle with errors of its own
    First draw M wrong speeds and M wrong turn rates, then drive M arcs.
    np.sqrt(variance) * rng.standard_normal(M), with M = pose.shape[1].
    v_hat = v + np.sqrt(a1 * v**2 + a2 * omega**2) * rng.standard_normal(M), and arc(...).""",
    points=2,
)
def sample(pose, u, alpha, rng):
    (v, omega, dt), M = u, pose.shape[1]
    v_hat = v + np.sqrt(alpha[0] * v**2 + alpha[1] * omega**2) * rng.standard_normal(M)
    omega_hat = omega + np.sqrt(alpha[2] * v**2 + alpha[3] * omega**2) * rng.standard_normal(M)
    return arc(pose, v_hat, omega_hat, dt)


sample.holds("with all alphas 0 it is the arc", _noise_free)
sample.holds("every particle ends somewhere else", _own)
sample.holds("each drives its own wrong arc exactly", _bends)
sample.holds(
    "speed has the variance alpha_1 v^2, within 8 % of its root",
    lambda f: _of(f, (2.0, 0.0, 0.5), (0.04, 0.3, 1e-4, 0), 0),
)
sample.holds("turning on the spot slips by alpha_2 omega^2", _slips)
sample.holds(
    "turn rate has alpha_3 v^2 + alpha_4 omega^2", lambda f: _of(f, BUSY, (0, 0, 0.04, 0.09), 1)
)
sample.holds("a robot at rest gets no error", _still)
sample.holds("errors of speed and of turn rate have nothing to do with each other", _apart)
sample.holds("they are normal", _normal)
sample.holds("all luck comes from rng: the same rng, the same cloud", _from_rng)
sample.wrong(
    """one-error: draws one error for the whole cloud
    How many random numbers does your function draw for 50 particles?
    One robot errs once, but each particle is a different guess at that robot.
    rng.standard_normal(M) gives each particle its own.""",
    when=lambda f: np.unique(_ends(f, BUSY, TOLD, 50).round(9), axis=1).shape[1] == 1,
)(
    lambda pose, u, alpha, rng: _drive(
        pose, u, np.sqrt(_variances(u, alpha)) * rng.standard_normal(2)
    )
)


@sample.wrong(
    """adds its errors to the pose after a perfect drive
    A wheel slips during the drive. Where does the robot end that turned too far?
    Put the error into v and omega, and drive the wrong arc exactly.
    Draw v_hat and omega_hat first, then call arc with them.""",
    when=lambda f: _noise_free(f) and _own(f) and _still(f) and not _bends(f),
)
def _on_pose(pose, u, alpha, rng):
    moved = arc(pose, *u)
    sd_v, sd_omega = np.sqrt(_variances(u, alpha))
    sd = u[2] * np.array((sd_v, sd_v, sd_omega))
    return moved + sd[:, None] * rng.standard_normal(moved.shape)


sample.wrong(
    """constant: gives the same error to a robot at rest and to one at full speed
    Should a parked robot drift?
    The variances multiply v^2 and omega^2.
    alpha_1 * v**2 + alpha_2 * omega**2""",
    when=lambda f: not _still(f),
)(_with(lambda u, alpha: np.array((alpha[0], alpha[2]))))
sample.wrong(
    """one-draw: uses the same draw for the speed and for the turn rate
    Does a robot that is too fast always turn too far as well?
    Each of the two errors has a draw of its own.
    Call rng.standard_normal(M) twice.""",
    when=lambda f: abs(np.corrcoef(_errors(f))[0, 1]) > 0.99,
)(
    lambda pose, u, alpha, rng: _drive(
        pose,
        u,
        np.sqrt(_variances(u, alpha))[:, None] * rng.standard_normal(pose.shape[1]),
    )
)


def _other_variances(text, variances):
    sample.wrong(text, when=_scatters_as(variances))(_with(variances))


_other_variances(
    """no-root: takes the variance for a standard deviation
    What does a standard normal draw have to be multiplied by?
    By the standard deviation, the root of the variance.
    np.sqrt(alpha_1 * v**2 + alpha_2 * omega**2)""",
    lambda u, alpha: _variances(u, alpha) ** 2,
)
_other_variances(
    """exchanged: gives the speed the errors of the turn rate, and the other way round
    Which two alphas belong to the speed?
    alpha_1 and alpha_2 to the speed, alpha_3 and alpha_4 to the turn rate.
    Exchange the two variances.""",
    lambda u, alpha: _variances(u, alpha)[::-1],
)
_other_variances(
    """crossed: multiplies alpha_1 with the turn rate and alpha_2 with the speed
    How large is the error of a robot that drives straight on?
    In each pair the first alpha belongs to v^2, the second to omega^2.
    alpha_1 * v**2 + alpha_2 * omega**2""",
    lambda u, alpha: _variances((u[1], u[0], u[2]), alpha),
)
_other_variances(
    """no-turn-noise: leaves the turn rate without an error
    Do all your robots turn by the same angle?
    There is a second line: omega_hat has an error as well.
    omega_hat = omega + np.sqrt(alpha_3 * v**2 + alpha_4 * omega**2) * rng.standard_normal(M)""",
    lambda u, alpha: _variances(u, alpha) * (1, 0),
)
_other_variances(
    """extra-dt: multiplies the errors by dt, which the arc does once more
    Is alpha_1 v^2 the variance of a speed or of a distance?
    Of a speed; the arc makes a distance of it.
    No dt in the errors.""",
    lambda u, alpha: _variances(u, alpha) * u[2] ** 2,
)
sample.refuses("NumPy's global generator")(
    lambda pose, u, alpha, rng: sample(pose, u, alpha, np.random.default_rng())
)
sample.refuses("uniform errors of the right variance")(
    lambda pose, u, alpha, rng: _drive(
        pose,
        u,
        np.sqrt(3 * _variances(u, alpha))[:, None] * rng.uniform(-1, 1, (2, pose.shape[1])),
    )
)
sample.refuses("only the speed's own alpha")(
    _with(lambda u, alpha: _variances(u, (alpha[0], 0, alpha[2], alpha[3])))
)
sample.refuses("absolute values of the errors")(
    lambda pose, u, alpha, rng: _drive(
        pose,
        u,
        np.abs(np.sqrt(_variances(u, alpha))[:, None] * rng.standard_normal((2, pose.shape[1]))),
    )
)

BACK = Question("From poses back to controls")


def _two_poses(start, radius, turn, extra, dt):
    """Two poses in print, rounded, and what an arc between them is made of."""
    pose0 = np.array((1.0, 2.0, np.radians(start)))
    pose1 = pf.drive_arc(pose0, radius * abs(np.radians(turn)), np.radians(turn))
    x1, y1 = pose1[:2].round(3).tolist()
    end = round(float(np.degrees(pf.wrap(np.radians(start + turn + extra)))))
    return {"start": start, "x1": x1, "y1": y1, "end": end, "dt": dt}


def _another_move(rng):
    start = int(rng.integers(-5, 6)) * 30
    turn = int(rng.choice([-120, -90, -60, -40, 40, 60, 90, 120]))
    extra = int(rng.choice([-15, -10, -5, 5, 10, 15]))
    return _two_poses(start, int(rng.integers(4, 13)) / 4, turn, extra, int(rng.integers(1, 3)) * 2)


def _move(start, x1, y1, end, dt):
    distance, turn, extra = pf.inverse_arc((1.0, 2.0, np.radians(start)), (x1, y1, np.radians(end)))
    return distance, turn, extra, dt


def _rates(distance, turn, extra, dt):
    return float(distance / dt), float(turn / dt), float(extra / dt)


def _as_if(change):
    """The answer of somebody who takes the parts of the move otherwise."""
    return lambda **world: _rates(*change(*_move(**world)))


recover = Numeric(
    """v, omega and gamma that lead in {dt} s from (1, 2) at {start} degrees to ({x1}, {y1}) at
         {end} degrees
    First the chord: how long is it, and how far beside the nose does it point?
    The arc turns by twice that angle, and the arc is the chord over sinc of that angle. The place
         alone fixes both.
    v and omega are arc and turn over {dt} s; gamma is what is still missing to the last heading,
         over {dt} s.""",
    lambda **world: _rates(*_move(**world)),
    tol=0.01,
    names=("v in m/s", "omega in rad/s", "gamma in rad/s"),
    world=_two_poses(90, 1.5, -60, 10, 2),
    draw=_another_move,
)
recover.wrong("""chord: takes the chord for the way
    Is the way of a robot that turns as short as the straight line between its two places?
    The arc is longer than its chord.
    Divide the chord by sinc(beta) = sin(beta) / beta, with beta its angle beside the nose.""")(
    _as_if(lambda d, turn, extra, dt: (d * sinc(turn / 2), turn, extra, dt))
)
recover.wrong("""headings: takes the turn from the two headings
    With that v and omega, where does the arc end?
    Where a robot is fixes its arc; the headings need not agree with it.
    omega comes from the direction of the chord, gamma from what is left.""")(
    _as_if(lambda d, turn, extra, dt: (d, pf.wrap(turn + extra), 0.0, dt))
)
recover.wrong("""half: takes the direction of the chord for the turn
    Halfway along the arc, how far has the robot turned?
    The chord points halfway between first and last heading of the arc.
    The arc turns by twice the angle between nose and chord.""")(
    _as_if(lambda d, turn, extra, dt: (d, turn / 2, extra + turn / 2, dt))
)
recover.wrong("""no-time: gives a way and two angles, not their rates
    How long did the move take?
    Speeds are metres and radians per second.
    Divide all three by {dt} s.""")(_as_if(lambda d, turn, extra, dt: (d, turn, extra, 1)))
recover.wrong("""degrees: gives its turns in degrees
    In which unit does the question ask?
    A radian is 57.3 degrees.
    Multiply by pi / 180.""")(
    _as_if(lambda d, turn, extra, dt: (d, np.degrees(turn), np.degrees(extra), dt))
)


def _pairs(n=60, seed=3):
    rng = np.random.default_rng(seed)
    return tuple(rng.uniform((-2, -2, -np.pi), (2, 2, np.pi), (n, 3)).T for _ in range(2))


def _inverted(f, pose0, pose1):
    with np.errstate(all="ignore"):
        return np.asarray(f(np.array(pose0), np.array(pose1)), dtype=float)


def _one_by_one(f):
    pose0, pose1 = _pairs(8)
    return [_inverted(f, a, b) for a, b in zip(pose0.T, pose1.T, strict=True)]


def _leads_there(f):
    pose0, pose1 = _pairs()
    distance, turn, _ = _inverted(f, pose0, pose1)
    reached = pf.drive_arc(pose0, distance, turn)
    return bool(np.allclose(reached[:2], pose1[:2], rtol=0, atol=1e-7))


def _extra_is_left(f):
    pose0, pose1 = _pairs()
    _, turn, extra = _inverted(f, pose0, pose1)
    left = extra - pf.wrap(pose1[2] - pose0[2] - turn)
    return bool(np.allclose(np.cos(left), 1, rtol=0, atol=1e-12))


def _inside(f):
    found = _inverted(f, *_pairs())[2]
    return bool((np.abs(found) <= np.pi + 1e-12).all())


def _ahead(f):
    return bool(np.allclose(_inverted(f, (1.0, 1.0, 0.0), (3.0, 1.0, 0.2)), (2, 0, 0.2), atol=1e-9))


@code(
    """From two poses to the arc between them
    Look at the second pose from the first: pf.between(pose0, pose1) has dx, dy and the turn.
    The chord is np.hypot(dx, dy), and it points np.arctan2(dy, dx) beside the nose.
    turn = 2 * beta, distance = chord / np.sinc(beta / np.pi), and pf.wrap(change - turn) is
         left.""",
    points=2,
    fingerprint=lambda f: np.concatenate([x.ravel() for x in _one_by_one(f)]),
    atol=1e-7,
)
def invert(pose0, pose1):
    dx, dy, change = pf.between(pose0, pose1)
    chord, beta = np.hypot(dx, dy), np.arctan2(dy, dx)
    return np.array([chord / np.sinc(beta / np.pi), 2 * beta, pf.wrap(change - 2 * beta)])


invert.holds("the arc of its distance and turn ends at the second pose", _leads_there)
invert.holds("what is left is the turn that is still missing there", _extra_is_left)
invert.holds("what is left lies in (-pi, pi]", _inside)
invert.holds(
    "forwards: no distance is negative",
    lambda f: bool((_inverted(f, *_pairs())[0] >= 0).all()),
)
invert.holds("a straight line costs no digits", _ahead)
invert.holds(
    "you wrote it yourself",
    lambda f: not calls(lambda: _inverted(f, *_pairs(3)), pf.inverse_arc),
)


def _inverse(distance=None, turn=None, frame=pf.between, angle=np.arctan2, wrap=pf.wrap):
    """A wrong inverse: one of its parts is another."""

    def f(pose0, pose1):
        dx, dy, change = frame(pose0, pose1)
        chord, beta = np.hypot(dx, dy), angle(dy, dx)
        phi = 2 * beta if turn is None else turn(beta, change)
        d = chord / np.sinc(beta / np.pi) if distance is None else distance(chord, beta)
        return np.array([d, phi, wrap(change - phi)])

    return f


def _on_the_map(pose0, pose1):
    return np.asarray(pose1) - np.asarray(pose0)


invert.wrong("""chord: takes the chord for the way
    Drive your distance along your arc: do you arrive?
    The arc is longer than its chord.
    Divide the chord by sin(beta) / beta.""")(_inverse(distance=lambda c, beta: c))
invert.wrong("""shorter: makes the arc shorter than its chord
    Which is longer, the arc or the chord?
    Forwards the chord is the arc times sinc; backwards it is the other way round.
    Divide by np.sinc(beta / np.pi).""")(
    _inverse(distance=lambda c, beta: c * np.sinc(beta / np.pi))
)
invert.wrong("""headings: takes the turn from the two headings
    Drive your arc: do you arrive?
    Where the robot is fixes the arc; its heading there may be another.
    turn = 2 * beta, and what is missing is the extra turn.""")(
    _inverse(turn=lambda beta, change: change)
)
invert.wrong("""half: takes the direction of the chord for the turn
    Halfway along the arc, how far has the robot turned?
    The chord points halfway between first and last heading.
    turn = 2 * beta""")(_inverse(turn=lambda beta, change: beta))
invert.wrong("""map: takes the direction on the map, not as seen from the nose
    Which direction has the chord for a robot that already looks along it?
    Subtract the first heading, or look from the first pose.
    pf.between(pose0, pose1)""")(_inverse(frame=_on_the_map))
invert.wrong("""arctan: takes an arctangent that cannot tell front from back
    Where is the second pose if dx and dy are both negative?
    np.arctan(dy / dx) is the same for (1, 1) and (-1, -1).
    np.arctan2(dy, dx)""")(_inverse(angle=lambda dy, dx: np.arctan(dy / dx)))
invert.wrong("""pi-sinc: uses NumPy's sinc as if it were sin(t) / t
    What does np.sinc compute?
    np.sinc(t) is sin(pi t) / (pi t).
    np.sinc(beta / np.pi)""")(_inverse(distance=lambda c, beta: c / np.sinc(beta)))
invert.wrong(
    """unwrapped: leaves what is missing outside of (-pi, pi]
    Is there a shorter turn to the same heading?
    Every difference of angles wants wrapping.
    pf.wrap(change - turn)""",
    when=lambda f: _leads_there(f) and _extra_is_left(f) and not _inside(f),
)(_inverse(wrap=lambda a: a))


@invert.refuses("a circle's centre, which straight lines lack")
def _by_centre(pose0, pose1):
    dx, dy, change = pf.between(pose0, pose1)
    turn = 2 * np.arctan2(dy, dx)
    return np.array([(dx**2 + dy**2) / (2 * dy) * turn, turn, pf.wrap(change - turn)])


@invert.refuses("the arc that drives backwards")
def _backwards(pose0, pose1):
    dx, dy, change = pf.between(pose0, pose1)
    chord, beta = np.hypot(dx, dy), np.arctan2(-dy, -dx)
    return np.array([-chord / np.sinc(beta / np.pi), 2 * beta, pf.wrap(change - 2 * beta)])


invert.refuses("calls the package")(lambda pose0, pose1: pf.inverse_arc(pose0, pose1))
invert.refuses("the whole change of heading as what is left")(
    lambda pose0, pose1: np.array([*invert(pose0, pose1)[:2], pf.between(pose0, pose1)[2]])
)


jacobian = Choice("""Equally likely errors, a chord of 0.2 m and one of 0.4 m: where is p larger?
    a  at 0.4 m, twice as large
       = The same errors sweep a larger box of poses there, so the density is smaller.
    b* at 0.2 m, about twice as large
       = Yes: the box of poses grows with the chord, and the same probability is spread over it.
    c  equally large: the errors are equally likely
       = Equal in errors; poses are what p is a density of.
    d  it depends on the resampling scheme
       = No particle has been drawn yet.""")

U0, ALPHAS = np.array((1.0, 0.5, 0.8)), (0.02, 0.01, 0.01, 0.05, 0.005, 0.01)


def _moves(n=40, seed=8):
    """Poses before and after, of n drives with the model, each from a place of its own."""
    rng = np.random.default_rng(seed)
    pose0 = rng.uniform((-2, -2, -np.pi), (2, 2, np.pi), (n, 3)).T
    return pf.VelocityMotion(ALPHAS).sample(pose0, U0, rng), pose0


def _log_density(jacobian, variances=None, gamma=True):
    """A log density with another Jacobian (of chord, sinc and dt) or other variances."""

    def f(pose1, u, alpha, pose0):
        v, omega, dt = u
        distance, turn, extra = invert(pose0, pose1)
        squares = np.array((v**2, omega**2))
        var = np.array([np.dot(alpha[k : k + 2], squares) for k in (0, 2, 4)])
        var = var if variances is None else variances(var)
        errors = np.array([distance / dt - v, turn / dt - omega, extra / dt])
        logs = [-0.5 * (e**2 / s + np.log(2 * np.pi * s)) for e, s in zip(errors, var, strict=True)]
        bend = sinc(turn / 2)
        return sum(logs if gamma else logs[:2]) - np.log(jacobian(distance * bend, bend, dt))

    return f


MOVES = _moves()


def _dense(f, u=U0, alpha=ALPHAS):
    pose1, pose0 = MOVES
    return np.asarray(f(pose1, np.array(u), alpha, pose0), dtype=float)


def _mass(f):
    """Integral over poses: polar coordinates, in which the pole at a chord of 0 is none."""
    chord, beta, turn = (
        low + (np.arange(n) + 0.5) * (high - low) / n
        for low, high, n in ((0.1, 1.5, 32), (-0.2, 0.6, 32), (-0.4, 1.2, 32))
    )
    c, b, t = np.meshgrid(chord, beta, turn, indexing="ij")
    poses = np.stack((c * np.cos(b), c * np.sin(b), t)).reshape(3, -1)
    cell = np.prod([x[1] - x[0] for x in (chord, beta, turn)])
    density = np.exp(np.asarray(f(poses, U0, ALPHAS, np.zeros((3, 1))), dtype=float))
    return float((density * c.ravel()).sum() * cell)


def _sums_to_one(f):
    found = _mass(f)
    return True if abs(found - 1) < 0.02 else f"it integrates to {found:.3g}"


def _right_values(f):
    others = ((U0, ALPHAS), ((0.8, 0.6, 0.7), (0.05, 0.02, 0.03, 0.02, 0.01, 0.02)))
    return all(np.allclose(_dense(f, *x), _dense(density, *x), rtol=0, atol=1e-8) for x in others)


@code(
    """Log density of a move by one arc forwards
    Which three errors explain the move? invert tells what really happened.
    distance / dt - v, turn / dt - omega and extra / dt are normal, with two alphas each: sum their
         log densities.
    Then subtract the log of 0.5 * chord * sinc(turn / 2) * dt**3, with
         chord = distance * sinc(turn / 2).""",
    points=3,
    fingerprint=_dense,
    atol=1e-7,
)
def density(pose1, u, alpha, pose0):
    v, omega, dt = u
    distance, turn, extra = invert(pose0, pose1)
    log_p = 0.0
    for k, error in enumerate((distance / dt - v, turn / dt - omega, extra / dt)):
        var = alpha[2 * k] * v**2 + alpha[2 * k + 1] * omega**2
        log_p = log_p - 0.5 * (error**2 / var + np.log(2 * np.pi * var))
    bend = np.sinc(turn / 2 / np.pi)
    return log_p - np.log(0.5 * distance * bend**2 * dt**3)


density.holds("it integrates to one over all poses, within 2 %", _sums_to_one)
density.holds("it has the right value, for 40 moves and two controls", _right_values)
density.holds(
    "you wrote it yourself",
    lambda f: not calls(lambda: _dense(f), pf.VelocityMotion),
)
density.wrong("""no-jacobian: is the density of the errors, not of the poses
    What does it integrate to, over poses?
    A small box of poses becomes one of errors, of another size.
    Subtract np.log(0.5 * chord * sinc(turn / 2) * dt**3).""")(
    _log_density(lambda c, bend, dt: 1.0)
)
density.wrong("""upside-down: multiplies by the box of poses where it should divide
    Which box is larger, that of the errors or that of the poses?
    p(poses) times its box is p(errors) times its box.
    Subtract the logarithm of d(poses) / d(errors).""")(
    _log_density(lambda c, bend, dt: 1 / (0.5 * c * bend * dt**3))
)
density.wrong("""no-time: leaves the time out of the Jacobian
    The errors are rates. How does a rate become a distance or an angle?
    Each of the three is multiplied by dt.
    dt**3""")(_log_density(lambda c, bend, dt: 0.5 * c * bend))
density.wrong("""no-half: forgets that an arc turns twice as far as its chord
    How far does the chord swing if the turn grows by one degree?
    By half a degree.
    A factor of 0.5""")(_log_density(lambda c, bend, dt: c * bend * dt**3))
density.wrong("""no-bend: takes the change of the arc's length for that of its chord
    By how much does the chord grow if the arc grows by 1 cm?
    By sinc(turn / 2) cm.
    0.5 * chord * sinc(turn / 2) * dt**3""")(_log_density(lambda c, bend, dt: 0.5 * c * dt**3))
density.wrong("""no-root: takes variances for standard deviations
    alpha_1 v^2 is a variance. What stands below the square of the error?
    -e**2 / (2 variance), and the root of 2 pi variance.
    -0.5 * (e**2 / var + np.log(2 * np.pi * var))""")(
    _log_density(lambda c, bend, dt: 0.5 * c * bend * dt**3, variances=np.square)
)
density.wrong("""no-extra: leaves the extra turn out
    How probable is a final heading that no arc explains?
    There are three errors, and gamma is the third.
    Add the log density of extra / dt.""")(
    _log_density(lambda c, bend, dt: 0.5 * c * bend * dt**3, gamma=False)
)
density.refuses("the density, not its logarithm")(lambda *args: np.exp(density(*args)))
density.refuses("one sinc too many")(_log_density(lambda c, bend, dt: 0.5 * c * bend**2 * dt**3))
density.refuses("calls the package")(
    lambda pose1, u, alpha, pose0: pf.VelocityMotion(alpha).log_density(pose1, u, pose0)
)
density.refuses("scaled so that its mass is one at this control only")(
    lambda *args: _log_density(lambda c, bend, dt: 1.0)(*args) - np.log(0.5 * 0.8 * 0.8**3)
)

STEPS = Question("Steps")


def _another_step(rng):
    alpha = int(rng.integers(2, 10)) / 100
    short, long = [(0.1, 0.5), (0.05, 0.4), (0.1, 0.25), (0.2, 0.5)][int(rng.integers(4))]
    return dict(zip(("alpha", "dt", "new"), (alpha, short, long), strict=True))


rescale = Numeric(
    """alpha_1 for steps of {new} s that is worth alpha_1 = {alpha} at steps of {dt} s
    What must stay the same: the variance of a step, or that of a second?
    A second has 1 / dt steps, each with a variance of alpha_1 (v dt)^2.
    alpha_1 dt stays: {alpha} * {dt} / {new}.""",
    lambda alpha, dt, new: alpha * dt / new,
    tol=0.0005,
    world={"alpha": 0.08, "dt": 0.1, "new": 0.5},
    draw=_another_step,
)
rescale.wrong("""same: keeps alpha_1
    How large is the error of a second, with many short steps and with few long ones?
    Independent errors of short steps cancel in part.
    alpha_1 dt stays the same.""")(lambda alpha, dt, new: alpha)
rescale.wrong("""upside-down: grows with the step
    Which cloud is wider after a second, that of one long step or that of many short ones?
    The long step's, with the same alpha. So its alpha has to be smaller.
    alpha_1 * dt / new""")(lambda alpha, dt, new: alpha * new / dt)
rescale.wrong("""squared: scales by the square of the steps
    alpha_1 is a variance. How do variances of independent steps add?
    Like their number, not like its square.
    alpha_1 * dt / new""")(lambda alpha, dt, new: alpha * (dt / new) ** 2)
rescale.wrong("""root: scales by the root of the steps
    Is alpha_1 a variance or a standard deviation?
    Standard deviations scale with the root, variances do not.
    alpha_1 * dt / new""")(lambda alpha, dt, new: alpha * (dt / new) ** 0.5)

BREAK = Question("Experiments")

motion = pf.VelocityMotion((0.02, 0.002, 0.05, 0.05, 0.005, 0.005))
u = np.array((1.0, 0.3, 0.5))


def together(cloud, u, rng):
    """All particles suffer one common error."""
    error = np.sqrt(motion.variances(u)) * rng.standard_normal(3)
    moved = motion.mean(cloud, u + error * (1, 1, 0))
    moved[2] = pf.wrap(moved[2] + error[2] * u[2])
    return moved


def _clouds(rng):
    """Sizes and numbers of steps: few of each, more of each."""
    return [
        (int(rng.integers(8, 12)), int(rng.integers(2, 4))),
        (int(rng.integers(20, 30)), int(rng.integers(5, 8))),
        (int(rng.integers(40, 60)), int(rng.integers(10, 15))),
    ]


@experiment(
    """Own errors against common ones
    Start both clouds from the same M poses: 0.1 m of spread in x and y, heading 0.
    motion.sample(cloud, u, rng) for one, together(cloud, u, rng) for the other, steps times.
    The spread is np.sqrt(cloud[:2].var(axis=1).sum()); return own / common.""",
    points=2,
    after=rigid,
    runs=120,
    pool=2_400,
    settings=_clouds,
    claim="a cloud with common errors does not grow; one with errors of its own does",
    test="three sizes and numbers of steps: mean ratio within 4.5 standard errors of a right "
    "experiment's, and its scatter within a factor of 1.7",
    margin="two equal means within 4.5 standard errors in four comparisons: 3e-5",
)
def rigid_x(M, steps, rng):
    own = common = rng.standard_normal((3, M)) * [[0.1], [0.1], [0.0]]
    for _ in range(steps):
        own, common = motion.sample(own, u, rng), together(common, u, rng)
    spread = [np.sqrt(cloud[:2].var(axis=1).sum()) for cloud in (own, common)]
    return spread[0] / spread[1]


rigid_x.holds("the mean ratio follows M and steps", same_mean())
rigid_x.holds("the runs scatter as clouds of M do", same_scatter(1.7))
rigid_x.wrong("""upside-down: divides the common spread by the own one
    Which cloud is the wide one?
    The ratio should say how much wider own errors make the cloud.
    Return own / common.""")(lambda M, steps, rng: 1 / rigid_x(M, steps, rng))


@rigid_x.wrong("""gives both clouds errors of their own
    How many random numbers does a step of the second cloud draw?
    Three numbers for the whole cloud, not three for each particle.
    Use together(cloud, u, rng) for the second cloud.""")
def both_own(M, steps, rng):
    first = second = rng.standard_normal((3, M)) * [[0.1], [0.1], [0.0]]
    for _ in range(steps):
        first, second = motion.sample(first, u, rng), motion.sample(second, u, rng)
    return np.sqrt(first[:2].var(axis=1).sum() / second[:2].var(axis=1).sum())


rigid_x.wrong("""variances: compares variances instead of standard deviations
    Is your ratio one of lengths or of squared lengths?
    A spread is a length: take the root.
    np.sqrt(cloud[:2].var(axis=1).sum())""")(lambda M, steps, rng: rigid_x(M, steps, rng) ** 2)
rigid_x.wrong("""always-twelve: drives twelve steps, whatever is asked for
    How many steps does your loop make for steps = 2?
    The check chooses steps.
    for _ in range(steps)""")(lambda M, steps, rng: rigid_x(M, 12, rng))
rigid_x.refuses("a constant of the text")(lambda M, steps, rng: 9.47)
rigid_x.refuses("random in range")(lambda M, steps, rng: rng.uniform(1, 10))
rigid_x.refuses("500 particles, whatever is asked for")(
    lambda M, steps, rng: rigid_x(500, steps, rng)
)
rigid_x.refuses("a quarter of the particles")(
    lambda M, steps, rng: rigid_x(max(M // 4, 2), steps, rng)
)
rigid_x.refuses("one step")(lambda M, steps, rng: rigid_x(M, 1, rng))
rigid_x.refuses("the common cloud has not grown, and the own one is not asked")(
    lambda M, steps, rng: 1.0
)


def _driven(M, n, rng, alpha=0.02):
    """Standard deviation (m) of the distance after four seconds at 1 m/s in n steps."""
    model, cloud = pf.VelocityMotion((alpha, 0, 0, 0)), np.zeros((3, M))
    for _ in range(n):
        cloud = model.sample(cloud, np.array((1.0, 0.0, 4.0 / n)), rng)
    return cloud[0].std()


def _parts(rng):
    """Numbers of particles and of steps."""
    return [
        (int(rng.integers(12, 20)), int(rng.integers(2, 4))),
        (int(rng.integers(30, 50)), int(rng.integers(6, 10))),
        (int(rng.integers(60, 90)), int(rng.integers(17, 25))),
    ]


@experiment(
    """One step against n
    Drive M particles straight for four seconds, twice: in one step and in n.
    u is (1, 0, 4) once, and (1, 0, 4 / n) n times; alpha is (0.02, 0, 0, 0) both times.
    Return the standard deviation of x after one step over that after n.""",
    points=2,
    after=split,
    runs=120,
    pool=2_400,
    settings=_parts,
    claim="a drive cut into n steps has 1 / root n of the standard deviation",
    test="three sizes and numbers of steps: mean ratio within 4.5 standard errors of a right "
    "experiment's, and its scatter within a factor of 1.7",
    margin="two equal means within 4.5 standard errors in four comparisons: 3e-5",
)
def split_x(M, n, rng):
    model, spread = pf.VelocityMotion((0.02, 0, 0, 0)), []
    for steps in (1, n):
        cloud = np.zeros((3, M))
        for _ in range(steps):
            cloud = model.sample(cloud, np.array([1.0, 0.0, 4 / steps]), rng)
        spread.append(cloud[0].std())
    return spread[0] / spread[1]


split_x.holds("the mean ratio follows M and n", same_mean())
split_x.holds("the runs scatter as clouds of M do", same_scatter(1.7))
split_x.wrong("""variances: compares variances
    Is it a ratio of lengths or of squared lengths?
    The prediction speaks of standard deviations.
    Use .std(), not .var().""")(lambda M, n, rng: split_x(M, n, rng) ** 2)
split_x.wrong("""upside-down: finds the larger spread after the many steps
    Is the ratio turned over, or do your two drives last differently long?
    n steps of 4 / n s each; the spread of the single step goes on top.
    Return whole / parts, with dt = 4 and dt = 4 / n.""")(lambda M, n, rng: 1 / split_x(M, n, rng))
split_x.wrong("""scaled: scales the noise with the number of steps
    Did you change alpha between the drives?
    The question is what happens to the same alpha.
    Keep alpha = (0.02, 0, 0, 0) for both.""")(
    lambda M, n, rng: _driven(M, 1, rng) / _driven(M, n, rng, 0.02 * n)
)
split_x.wrong("""sixteen: makes sixteen steps, whatever is asked for
    How many steps does your second drive make for n = 2?
    The check chooses n.
    dt = 4 / n, n times""")(lambda M, n, rng: split_x(M, 16, rng))
split_x.refuses("a constant of the text")(lambda M, n, rng: 4.0)
split_x.refuses("the formula, not an experiment")(lambda M, n, rng: np.sqrt(n))
split_x.refuses("the formula, scattered")(
    lambda M, n, rng: np.sqrt(n) * (1 + 0.02 * rng.standard_normal())
)
split_x.refuses("2,000 particles, whatever is asked for")(lambda M, n, rng: split_x(2000, n, rng))
split_x.refuses("a quarter of the particles")(lambda M, n, rng: split_x(max(M // 4, 2), n, rng))
split_x.refuses("random in range")(lambda M, n, rng: rng.uniform(1, 5))

why = Text(
    """Why a banana, and why draw anew?
    says that an error in the turn rate changes heading and position together
    says that an early heading error acts on the whole way that follows
    says that particles are different guesses, so each needs errors of its own""",
    model="A wrong turn rate bends the track, so heading and position are wrong together. "
    "An early error acts over the whole way that follows, which bends the cloud into a banana. "
    "Each particle is a guess at what the robot did and needs errors of its own.",
)


LAB = Lab.of(__name__, "Motion")
__getattr__ = LAB.verb
