"""Drift. What do counted wheels know of a pose, and how does it get lost?"""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment
from pfkit.labs.response import calls, same_mean, same_scatter

PREDICT = Question("Predictions")

aside = Prediction("""Four times as many steps with wrong turns: how much further aside?
    a  twice as far
    b  four times as far
    c* eight times as far
    d  sixteen times as far""")

oneway = Prediction("""Counter-clockwise squares closed by a new axle: and clockwise?
    a  they still close, and now both directions do
    b* they now miss by as much as the others did before
    c  they miss by half as much
    d  they miss by more and more, lap by lap, in both directions""")

WHEELS = Question("Wheels and odometers")


def _two_wheels(rng):
    left, right = rng.choice(np.arange(3, 15), 2, replace=False).tolist()
    r, L = (float(rng.choice(x)) for x in ((0.05, 0.08, 0.1, 0.15), (0.3, 0.4, 0.5, 0.6)))
    return {"r": r, "L": L, "left": left, "right": right}


def _body(r, L, left, right):
    v, omega = r * (left + right) / 2, r * (right - left) / L
    return v, omega, v / omega


wheels = Numeric(
    """Speed, turn rate and radius for wheels of {r} m, an axle of {L} m, {left} rad/s left and
         {right} rad/s right
    How fast does each wheel's rim run? Radius times rad/s.
    The middle of the axle moves at the mean of {r} * {left} and {r} * {right}.
    The turn rate is right rim minus left rim, over {L}; the radius is v / omega.""",
    _body,
    tol=0.005,
    names=("speed in m/s", "turn rate in rad/s", "radius in m"),
    world={"r": 0.1, "L": 0.5, "left": 8, "right": 12},
    draw=_two_wheels,
)
wheels.wrong("""sum: adds the wheels instead of averaging them
    If both rims ran at 1 m/s, how fast would the robot be?
    The middle of the axle moves at the mean of the two rims.
    v = {r} * ({left} + {right}) / 2""")(
    lambda **w: (2 * _body(**w)[0], _body(**w)[1], 2 * _body(**w)[2])
)
wheels.wrong("""half-axle: takes half of the difference over the axle
    If the left wheel stood still, about which point would the robot turn?
    About the left wheel, and the right one is a whole axle away.
    omega = {r} * ({right} - {left}) / {L}""")(
    lambda **w: (_body(**w)[0], _body(**w)[1] / 2, 2 * _body(**w)[2])
)
wheels.wrong("""half-axle-radius: halves the turn rate, but not the radius
    If the left wheel stood still, about which point would the robot turn?
    About the left wheel, and the right one is a whole axle away.
    omega = {r} * ({right} - {left}) / {L}""")(
    lambda **w: (_body(**w)[0], _body(**w)[1] / 2, _body(**w)[2])
)
wheels.wrong("""sign: turns to the wrong side
    To which side does a robot turn whose right wheel is faster?
    To the left, and left is positive.
    omega is right minus left.""")(lambda **w: (_body(**w)[0], -_body(**w)[1], -_body(**w)[2]))


def _wrapped(degrees):
    return (degrees + 180) % 360 - 180


def _seen(start, dx, dy, end, arctan=np.arctan2):
    rot1 = _wrapped(float(np.degrees(arctan(dy, dx))) - start)
    return rot1, float(np.hypot(dx, dy)), _wrapped(end - start - rot1)


def _another_pair(rng):
    dx, dy = (int(rng.integers(1, 4) * rng.choice((-1, 1))) for _ in range(2))
    start, end = (int(rng.integers(-5, 7)) * 30 for _ in range(2))
    return {"start": start, "dx": dx, "dy": dy, "end": end}


odometry = Numeric(
    """Turn, drive, turn of an odometer that looked to {start} degrees, went {dx} m in x and {dy} m
         in y, and looks to {end} degrees
    Draw the two poses. In which direction of the map lies the second?
    The way goes by ({dx}, {dy}); subtract the heading of {start} degrees from its direction.
    rot2 is {end} - {start} - rot1. Wrap every difference.""",
    _seen,
    tol=0.1,
    names=("rot1 in degrees", "trans in m", "rot2 in degrees"),
    world={"start": 90, "dx": -1, "dy": 1, "end": -150},
    draw=_another_pair,
)
odometry.wrong("""no-wrap: turns nearly all the way round
    Is there a shorter turn to the same heading?
    Nobody drives a turn of more than half a circle where a shorter one ends alike.
    Wrap every difference of angles.""")(
    lambda start, dx, dy, end: (
        *_seen(start, dx, dy, end)[:2],
        end - start - _seen(start, dx, dy, end)[0],
    )
)
odometry.wrong("""map-direction: gives the direction on the map, not the turn
    Where does the robot look before it moves?
    It already looks to {start} degrees.
    Subtract the first heading from the direction of the way.""")(
    lambda start, dx, dy, end: (
        float(np.degrees(np.arctan2(dy, dx))),
        *_seen(start, dx, dy, end)[1:],
    )
)
odometry.wrong("""arctan: takes an arctangent that cannot tell front from back
    In which quadrant does the way ({dx}, {dy}) lie?
    The quotient of {dy} and {dx} is that of -{dy} and -{dx} as well.
    Use atan2({dy}, {dx}).""")(
    lambda **move: _seen(**move, arctan=lambda dy, dx: np.arctan(dy / dx))
)
odometry.wrong("""whole-turn: gives the whole change of heading as the second turn
    How much of the change has the first turn made already?
    The two turns together change the heading.
    rot2 = {end} - {start} - rot1, wrapped""")(
    lambda start, dx, dy, end: (*_seen(start, dx, dy, end)[:2], _wrapped(end - start))
)


printed = Numeric(
    """Where the printed equation puts the robot after three steps
    Do exactly what is printed, and nothing that should be there.
    What of the pose before stands on the right-hand side? One cosine and one sine of its heading.
    After the first step the heading is 0; and each step starts from nowhere.""",
    (1.0, 0.0, 0.0),
    tol=0.01,
    names=("x in m", "y in m", "heading in degrees"),
)
printed.wrong("""as-meant: is where the robot should be, not where the equation puts it
    Where on the right-hand side does the place before the step stand?
    Nowhere: it is not added.
    Put the numbers in, line by line.""")((5.0, 8.0, 90.0))
printed.wrong("""keeps-heading: forgets the place and keeps the heading
    Which line of the equation says what the heading becomes?
    The third, and no heading from before is added there either.
    Straight on, it says 0.""")((0.0, 1.0, 90.0))
printed.wrong("""keeps-place: adds the place of before, which is not printed
    Where on the right-hand side does the place before the step stand?
    Only its heading stands there, in the cosine and the sine.
    Each step starts from nowhere.""")((7.0, 6.0, 0.0))
printed.wrong("""one-step: stops after the first step
    Which heading does the second step start from?
    From 0, because the first one said so.
    Do the step twice more.""")((0.0, 1.0, 0.0))

vehicle = Choice("""Which robot moves like the assignment's equation?
    a  a bicycle: it turns only while it rolls
       = Put d = 0: the equation still turns the robot, and no bicycle can do that.
    b* a robot that drives along its old heading and then turns on the spot
       = Yes: position uses the old heading only, and the turn comes with no condition.
    c  a robot that turns on the spot and then drives along its new heading
       = The equation's cosine holds the old heading, not the new one.
    d  a robot with two driven wheels, on an exact arc
       = On an arc the chord points halfway between old and new heading.""")

CODE = Question("Code")


def _counts(T=12, seed=4, N=512):
    return np.random.default_rng(seed).integers(-N // 8, N // 2, (2, T)), N, 0.08, 0.4


CASES = (_counts(), _counts(5, 5, 360), (np.array([[100], [300]]), 1000, 0.1, 0.5))


def _pose(f, ticks, N, r, L):
    return np.asarray(f(np.array(ticks), N, r, L), dtype=float)


def _same_pose(found, wanted):
    if found.shape != (3,):
        return f"expected a pose of shape (3,), got {found.shape}"
    off = np.array([*(found[:2] - wanted[:2]), pf.wrap(found[2] - wanted[2])])
    return bool(np.abs(off).max() < 1e-8)


def _as_reference(*case):
    return lambda f: _same_pose(_pose(f, *case), odometer(*case))


def _each_case(f):
    return all(_as_reference(*case)(f) is True for case in CASES)


@code(
    """Dead reckoning from counted ticks
    How many metres does a rim run in one tick? The circumference over N.
    d is the mean of the two rims, the turn their difference over L: pf.drive_arc does the rest.
    One arc for each row: for d, turn in zip(...): pose = pf.drive_arc(pose, d, turn)""",
    points=2,
    fingerprint=lambda f: np.concatenate([_pose(f, *case) for case in CASES]),
    atol=1e-7,
)
def odometer(ticks, N, r, L):
    left, right = 2 * np.pi * r * ticks / N
    pose = np.zeros(3)
    for d, turn in zip((left + right) / 2, (right - left) / L, strict=True):
        pose = pf.drive_arc(pose, d, turn)
    return pose


odometer.holds(
    "straight ahead: one turn of both wheels is one circumference",
    _as_reference(np.array([[100], [100]]), 100, 0.1, 0.5),
)
odometer.holds(
    "on the spot: opposite ticks turn, and do not move",
    _as_reference(np.array([[-50, -20], [50, 20]]), 400, 0.1, 0.5),
)
odometer.holds("many rows, one after the other", _each_case)
odometer.holds(
    "the heading stays in (-pi, pi]",
    lambda f: abs(_pose(f, np.array([[0] * 9, [90] * 9]), 100, 0.1, 0.4)[2]) <= np.pi + 1e-12,
)
odometer.holds(
    "you wrote it yourself", lambda f: not calls(lambda: _pose(f, *CASES[0]), pf.encoder_odometry)
)


def _rows(change=None, wheel=lambda ticks, N, r: 2 * np.pi * r * ticks / N, step=pf.drive_arc):
    """An odometer that makes something else of the rims, or of the rows."""

    def f(ticks, N, r, L):
        left, right = wheel(ticks, N, r)
        d, turn = (left + right) / 2, (right - left) / L
        d, turn = (d, turn) if change is None else change(d, turn)
        pose = np.zeros(3)
        for a, b in zip(d, turn, strict=True):
            pose = step(pose, a, b)
        return pose

    return f


odometer.wrong("""no-circumference: takes ticks over N for radians
    How many radians is a whole turn?
    2 pi, and not 1.
    2 * np.pi * r * ticks / N""")(_rows(wheel=lambda ticks, N, r: r * ticks / N))
odometer.wrong("""diameter: takes the radius for a diameter
    How long is the rim of a wheel of radius r?
    2 pi r.
    2 * np.pi * r * ticks / N""")(_rows(wheel=lambda ticks, N, r: np.pi * r * ticks / N))
odometer.wrong("""exchanged: takes the left wheel for the right one
    Which row of ticks is the left wheel?
    The first. If the right wheel is faster, the robot turns to the left.
    turn = (right - left) / L""")(_rows(lambda d, turn: (d, -turn)))
odometer.wrong("""sum: adds the wheels instead of averaging them
    If both rims run 1 m, how far does the robot get?
    The middle of the axle moves by the mean.
    (left + right) / 2""")(_rows(lambda d, turn: (2 * d, turn)))
odometer.wrong("""half-axle: turns about half the axle
    If the left wheel stood still, about which point would the robot turn?
    About the left wheel, and the right one is a whole axle away.
    (right - left) / L""")(_rows(lambda d, turn: (d, 2 * turn)))
odometer.wrong("""all-at-once: adds all rows up and drives a single arc
    Does a robot end alike that first turns and then drives, and one that drives first?
    Rows come one after the other, and each starts where the last one ended.
    for d, turn in zip(...): pose = pf.drive_arc(pose, d, turn)""")(
    _rows(lambda d, turn: (d.sum(keepdims=True), turn.sum(keepdims=True)))
)


@odometer.wrong("""drives along the old heading and turns afterwards
    When does the robot turn: during the row, or after it?
    All the time, so its chord points halfway.
    pf.drive_arc(pose, d, turn)""")
def old_heading(ticks, N, r, L):
    def step(pose, d, turn):
        x, y, theta = pose
        return np.array([x + d * np.cos(theta), y + d * np.sin(theta), pf.wrap(theta + turn)])

    return _rows(step=step)(ticks, N, r, L)


@odometer.wrong("""starts each row from nowhere, as the printed equation does
    Where was the robot before this row?
    A step leads on from the pose before.
    pose = pf.drive_arc(pose, d, turn)""")
def from_nowhere(ticks, N, r, L):
    return _rows(step=lambda pose, d, turn: pf.drive_arc(np.zeros(3), d, turn))(ticks, N, r, L)


odometer.refuses("whole turns only")(_rows(wheel=lambda ticks, N, r: 2 * np.pi * r * (ticks // N)))
odometer.refuses("1,024 ticks a turn, whatever N is")(
    lambda ticks, N, r, L: odometer(ticks, 1024, r, L)
)
odometer.refuses("a heading that runs on")(
    lambda ticks, N, r, L: (
        odometer(ticks, N, r, L) * [1, 1, 0]
        + [0, 0, float(np.sum(2 * np.pi * r * (ticks[1] - ticks[0]) / N / L))]
    )
)
odometer.refuses("calls the package")(
    lambda ticks, N, r, L: pf.encoder_odometry(2 * np.pi * ticks / N, pf.WheelGeometry(r, r, L))[
        :, -1
    ]
)
odometer.refuses("the path in place of its end")(
    lambda ticks, N, r, L: np.stack([odometer(ticks, N, r, L)] * 2, axis=1)
)

GROWTH = Question("How errors grow")


def _another_drift(rng):
    step, sd = (float(rng.choice(x)) for x in ((0.5, 1.0, 2.0), (0.02, 0.03, 0.04, 0.05)))
    return {"n": int(rng.integers(6, 16)), "step": step, "sd": sd}


def _lever(n):
    return float(np.sqrt(np.sum(np.arange(1, n + 1) ** 2)))


drift = Numeric(
    """Sideways spread after {n} times a turn with an error of {sd} rad and {step} m straight on
    How far does the robot still drive after the first turn? And after the last?
    The turns act over {n}, {n} - 1, ... 1 steps of {step} m; independent errors add as squares.
    {sd} * {step} times the root of 1 + 4 + 9 + ... + {n} squared.""",
    lambda n, step, sd: sd * step * _lever(n),
    tol=0.004,
    unit="m",
    world={"n": 10, "step": 1.0, "sd": 0.02},
    draw=_another_drift,
)
drift.wrong("""linear: adds the errors as if all had the same sign
    Do {n} independent errors all point the same way?
    Variances add, standard deviations do not.
    Take the root of the sum of squares, not the sum of 1 to {n}.""")(
    lambda n, step, sd: sd * step * n * (n + 1) / 2
)
drift.wrong("""final-heading: lets the final heading error act on the whole way
    Was the heading as wrong at the start as it is at the end?
    The last turn acts on one step only.
    The levers are {n}, {n} - 1, ... 1 steps.""")(lambda n, step, sd: sd * step * n * np.sqrt(n))
drift.wrong("""no-lever: lets each turn act on its own step only
    After a wrong turn, which of the later steps point the right way?
    A wrong turn is never taken back: it acts on all that follows.
    The levers are {n}, {n} - 1, ... 1 steps, not 1 each.""")(
    lambda n, step, sd: sd * step * np.sqrt(n)
)


def _another_race(rng):
    e, s, step = (
        float(rng.choice(x)) for x in ((0.5, 1.0, 2.0), (4, 5, 6, 8, 10, 12), (0.2, 0.25, 0.4, 0.5))
    )
    return {"e": e, "s": s, "step": step}


crossover = Numeric(
    """Metres after which a radius that is {e} % wrong errs more than a slip of {s} % in each step
         of {step} m
    After n steps: how large is the error that repeats itself, and how large the sum of n
         independent ones?
    n steps times {e} %, against the root of n times {s} %: equal at n = ({s} / {e})^2.
    Metres, not steps: times {step}.""",
    lambda e, s, step: (s / e) ** 2 * step,
    tol=0.02,
    unit="m",
    world={"e": 2.0, "s": 12.0, "step": 0.5},
    draw=_another_race,
)
crossover.wrong("""steps: counts steps
    In which unit does the question ask?
    Each step is {step} m long.
    ({s} / {e})^2 * {step}""")(lambda e, s, step: (s / e) ** 2)
crossover.wrong("""ratio: takes both errors to grow alike
    Do independent errors add up like equal ones?
    n equal ones make n times the error, n independent ones root n times.
    The ratio is to be squared.""")(lambda e, s, step: s / e * step)
crossover.wrong("""root: takes the root where the square belongs
    n * {e} = root(n) * {s}: what is n?
    Divide by root(n): root(n) = {s} / {e}.
    Square both sides.""")(lambda e, s, step: (s / e) ** 0.5 * step)
crossover.wrong("""upside-down: divides the bias by the slip
    Which of the two leads at the start?
    The larger the slip, the longer it leads.
    ({s} / {e})^2 * {step}""")(lambda e, s, step: (e / s) ** 2 * step)

SQUARE = Question("The square")


def _ends(delta, beta, side):
    """What a tape measures after squares both ways, in print."""
    x_ccw, x_cw = (2 * side * np.radians(delta + way * beta) for way in (1, -1))
    return {"side": side, "ccw": round(float(x_ccw), 3), "cw": round(float(x_cw), 3)}


def _another_square(rng):
    delta, beta = (float(rng.integers(3, 16) * rng.choice((-1, 1))) / 10 for _ in range(2))
    return _ends(delta, beta, int(rng.integers(3, 9)))


def _solved(side, ccw, cw):
    return np.degrees((ccw + cw) / (4 * side)), np.degrees((ccw - cw) / (4 * side))


square = Numeric(
    """Turn error delta and bend beta of squares with sides of {side} m that end at x = {ccw} m
         (counter-clockwise) and x = {cw} m (clockwise)
    Which of the two errors keeps its sign when the direction changes?
    x = 2 * side * (delta + beta) one way and 2 * side * (delta - beta) the other.
    Add the two and divide by 4 * {side}; subtract for beta. Then degrees.""",
    lambda **w: tuple(map(float, _solved(**w))),
    tol=0.02,
    names=("delta in degrees", "beta in degrees"),
    world=_ends(-0.9, 1.2, 4),
    draw=_another_square,
)
square.wrong("""radians: gives radians
    In which unit does the question ask?
    A radian is 57.3 degrees.
    Multiply by 180 / pi.""")(lambda **w: tuple(np.radians(_solved(**w))))
square.wrong("""exchanged: takes the bend for the turn error
    Which of the two keeps its sign in x when the direction changes?
    The turn error: a robot that turns too far does so both ways, and so does its mirror image.
    delta is in the sum, beta in the difference.""")(lambda **w: _solved(**w)[::-1])
square.wrong("""twice: divides by 2 sides where the sum of both ends asks for 4
    How often does delta stand in the sum of the two ends?
    Twice: once in each.
    (x_ccw + x_cw) / (4 * {side})""")(lambda **w: tuple(2 * x for x in _solved(**w)))
square.wrong("""one-way: blames all of one square's miss on the turns
    What would the clockwise square have shown, if that were so?
    Two unknowns need two numbers.
    x_ccw holds the sum of delta and beta, x_cw their difference.""")(
    lambda side, ccw, cw: (np.degrees(ccw / (2 * side)), 0.0)
)
square.wrong("""sign-of-beta: gives the bend the wrong sign
    Does a positive bend add to the left turns or to the right turns?
    To the left turns: beta is counted counter-clockwise.
    beta = (x_ccw - x_cw) / (4 * {side})""")(lambda **w: (_solved(**w)[0], -_solved(**w)[1]))

scale = Choice("""What does no closed square tell, however often it is driven, in both directions?
    a  which of the two wheels is larger
       = It bends the sides, and the two directions tell it from the axle.
    b* that wheels and axle are all larger by the same share
       = Yes: such a robot drives a larger square that closes as well; a straight line tells.
    c  that the axle is longer than the books say
       = Then every corner turns by too little, and the square does not close.
    d  anything about noise
       = Repeated squares scatter, and the scatter is the noise.""")

TRY = Question("Experiments")


def _roads(rng):
    """Numbers of steps, biases and noises: each of the three leads somewhere."""
    sign = int(rng.choice((-1, 1)))
    return [
        (int(rng.integers(6, 10)), sign * rng.uniform(0.008, 0.012), rng.uniform(0.01, 0.02)),
        (int(rng.integers(16, 22)), -sign * rng.uniform(0.003, 0.005), rng.uniform(0.02, 0.03)),
        (int(rng.integers(32, 40)), sign * rng.uniform(0.002, 0.003), rng.uniform(0.004, 0.008)),
    ]


@experiment(
    """How far aside after n wrong turns
    Draw all n turns at once: bias + sigma * rng.standard_normal(n).
    Each step is an arc of 1 m: pf.drive_arc(pose, 1.0, turn), from np.zeros(3) on.
    Return pose[1] after the last step.""",
    points=2,
    after=aside,
    runs=200,
    pool=2_400,
    settings=_roads,
    claim="errors of the heading act on all that follows: noise grows like n^1.5, bias like n^2",
    test="three numbers of steps, biases and noises: mean within 4.5 standard errors of a right "
    "experiment's, and its scatter within a factor of 1.45",
    margin="two equal means within 4.5 standard errors in four comparisons: 3e-5",
)
def aside_x(n, bias, sigma, rng):
    pose = np.zeros(3)
    for turn in bias + sigma * rng.standard_normal(n):
        pose = pf.drive_arc(pose, 1.0, turn)
    return pose[1]


def _aside(turns):
    """Sideways end (m) of steps of 1 m with these turns."""
    direction = np.cumsum(turns) - turns / 2
    return float(np.sum(np.sinc(turns / 2 / np.pi) * np.sin(direction)))


aside_x.holds("the mean follows n and bias", same_mean())
aside_x.holds("the runs scatter as n and sigma say", same_scatter(1.45))
aside_x.wrong("""no-lever: takes every wrong turn back before the next step
    After a wrong turn, where does the robot look in the next step?
    Where the wrong turn has left it: headings add up.
    pose = pf.drive_arc(pose, 1.0, turn), never from a heading of 0 again""")(
    lambda n, bias, sigma, rng: np.sum(np.sin(bias + sigma * rng.standard_normal(n)) / 2)
)
aside_x.wrong("""one-error: draws one error for the whole drive
    How many random numbers do n steps need?
    Noise is new in every step; what is the same in all of them is bias.
    rng.standard_normal(n)""")(
    lambda n, bias, sigma, rng: _aside(np.full(n, bias + sigma * rng.standard_normal()))
)
aside_x.wrong("""no-bias: leaves the bias out
    What is the mean of your turns?
    It should be `bias`.
    bias + sigma * rng.standard_normal(n)""")(
    lambda n, bias, sigma, rng: _aside(sigma * rng.standard_normal(n))
)
aside_x.wrong("""unsigned: gives a distance, where a side is asked for
    Can your number be negative?
    Left is positive, right is negative.
    pose[1], not its absolute value""")(
    lambda n, bias, sigma, rng: abs(_aside(bias + sigma * rng.standard_normal(n)))
)
aside_x.wrong("""heading: gives the final heading
    In which unit is your number?
    The question asks for metres to the left.
    pose[1]""")(lambda n, bias, sigma, rng: np.sum(bias + sigma * rng.standard_normal(n)))
aside_x.refuses("zero, as on average without a bias")(lambda n, bias, sigma, rng: 0.0)
aside_x.refuses("the law of the bias, not an experiment")(
    lambda n, bias, sigma, rng: bias * n**2 / 2
)
aside_x.refuses("the bias, and scatter like root n")(
    lambda n, bias, sigma, rng: bias * n**2 / 2 + sigma * n**0.5 * rng.standard_normal()
)
aside_x.refuses("half of the steps")(
    lambda n, bias, sigma, rng: _aside(bias + sigma * rng.standard_normal(n // 2))
)
aside_x.refuses("random in range")(lambda n, bias, sigma, rng: rng.uniform(-1, 1))
aside_x.refuses("the variance for the standard deviation")(
    lambda n, bias, sigma, rng: _aside(bias + sigma**2 * rng.standard_normal(n))
)

books = pf.WheelGeometry(0.1, 0.1, 0.5)
TAPE = 0.01  # metres


def _robots(rng):
    """Robots whose wheels and axle are not those of the books, and sides of squares."""
    found = []
    for side in rng.choice((3, 4, 5, 6), 3, replace=False).tolist():
        uneven, longer = (rng.uniform(0.004, 0.01) * rng.choice((-1, 1)) for _ in range(2))
        robot = pf.WheelGeometry(0.1 * (1 - uneven / 2), 0.1 * (1 + uneven / 2), 0.5 + longer)
        found.append((robot, side))
    return found


@experiment(
    """Calibrated in one direction, driven in the other
    Drive a square by the books, counter-clockwise, and measure x at its end with the tape.
    Put the new axle into the books: pf.WheelGeometry(0.1, 0.1, axle); drive clockwise by them.
    The robot drives with `robot`: pf.encoder_odometry(turns, robot)[:2, -1]. Return its distance
         from the start.""",
    points=2,
    after=oneway,
    runs=60,
    pool=1_200,
    settings=_robots,
    claim="what one direction hides the other one shows",
    test="three robots and squares: mean miss within 4.5 standard errors (and 1 cm) of a right "
    "experiment's, and its scatter within a factor of 2",
    margin="two equal means within 4.5 standard errors in four comparisons: 3e-5",
)
def oneway_x(robot, side, rng):
    turns = pf.square_turns(side, books)
    x = pf.encoder_odometry(turns, robot)[0, -1] + 0.01 * rng.standard_normal()
    axle = books.L * (1 - x / (2 * side) / (np.pi / 2))
    turns = pf.square_turns(side, pf.WheelGeometry(0.1, 0.1, axle), clockwise=True)
    return np.hypot(*pf.encoder_odometry(turns, robot)[:2, -1])


def _axle(x, side):
    return pf.WheelGeometry(0.1, 0.1, books.L * (1 - x / (2 * side) / (np.pi / 2)))


def _end(robot, side, by, clockwise):
    return pf.encoder_odometry(pf.square_turns(side, by, clockwise), robot)[:2, -1]


def _tape(rng):
    return TAPE * rng.standard_normal()


oneway_x.holds("the mean miss follows the robot and the side", same_mean(slack=0.01))
oneway_x.holds("it scatters as the tape does", same_scatter(2.0))


@oneway_x.wrong("""drives the second square counter-clockwise as well
    Which way round did you calibrate, and which way do you drive?
    The second square goes clockwise.
    pf.square_turns(side, new, clockwise=True)""")
def same_way(robot, side, rng):
    x = _end(robot, side, books, False)[0] + _tape(rng)
    return np.hypot(*_end(robot, side, _axle(x, side), False))


@oneway_x.wrong("""calibrates on the clockwise square, which it then drives
    Which square did you measure?
    The first one goes counter-clockwise.
    pf.square_turns(side, books)""")
def wrong_way(robot, side, rng):
    x = _end(robot, side, books, True)[0] + _tape(rng)
    return np.hypot(*_end(robot, side, _axle(x, side), True))


oneway_x.wrong("""not-calibrated: drives the second square by the old books
    Which axle did your second square use?
    The new one goes into the books before the second drive.
    pf.WheelGeometry(0.1, 0.1, axle)""")(
    lambda robot, side, rng: np.hypot(*(_end(robot, side, books, True) + _tape(rng)))
)


@oneway_x.wrong("""changes the axle in the wrong direction
    A robot that turns too far: is its axle shorter or longer than the books say?
    It turned too far because the books' axle is too long; the new one is shorter.
    books.L * (1 - eps / (np.pi / 2))""")
def wrong_sign(robot, side, rng):
    x = _end(robot, side, books, False)[0] + _tape(rng)
    return np.hypot(*_end(robot, side, _axle(-x, side), True))


@oneway_x.wrong("""puts the new axle into the robot, not into the books
    Which of the two can you change with a keyboard?
    The robot is what it is: it drives with `robot`.
    pf.square_turns takes the books, pf.encoder_odometry the robot.""")
def rebuilt(robot, side, rng):
    x = _end(robot, side, books, False)[0] + _tape(rng)
    other = pf.WheelGeometry(robot.r_l, robot.r_r, _axle(x, side).L)
    return np.hypot(*_end(other, side, books, True))


oneway_x.refuses("it closes: zero")(lambda robot, side, rng: abs(_tape(rng)))
oneway_x.refuses("a constant of the text")(lambda robot, side, rng: 0.5)
oneway_x.refuses("the miss of the first square")(
    lambda robot, side, rng: np.hypot(*(_end(robot, side, books, False) + _tape(rng)))
)
oneway_x.refuses("without a tape")(
    lambda robot, side, rng: np.hypot(
        *_end(robot, side, _axle(_end(robot, side, books, False)[0], side), True)
    )
)
oneway_x.refuses("random in range")(lambda robot, side, rng: rng.uniform(0, 1))
oneway_x.refuses("the axle and the uneven wheels calibrated in both directions")(
    lambda robot, side, rng: np.hypot(
        *_end(robot, side, robot, True) + 2 * TAPE * rng.standard_normal(2)
    )
)
oneway_x.refuses("squares of 4 m, whatever is asked for")(
    lambda robot, side, rng: oneway_x(robot, 4 if side != 4 else 5, rng)
)

why = Text(
    """Calibrate, or model as noise?
    says that what repeats itself grows faster than what is independent, so no noise covers it
         for long
    says that a bias is measured and taken out, and what is left is modelled as noise
    says that it takes both directions, or two different drives, to tell two biases apart""",
    model="An error that repeats itself grows like n, or n squared through the heading, so noise "
    "that grows like root n covers it only for a while. "
    "Measure it, take it out, and model what is left as noise. "
    "Drive the square in both directions, because one direction cannot tell the axle from the "
    "wheels.",
)

LAB = Lab.of(__name__, "Drift")
__getattr__ = LAB.verb
