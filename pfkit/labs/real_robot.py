"""A real robot. Questions on reading, calibrating and judging recorded logs."""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment
from pfkit.labs import real_robot_logs as lab
from pfkit.labs.real_robot_logs import minute as minute
from pfkit.labs.real_robot_logs import stretch as stretch

BY_HAND = Question("By hand", id="1")

held = Numeric(
    """Distance between two sightings, commands held
    Mark the rows and the sightings on one time line.
    From 0.3 to 0.4 s the first command still holds.
    0.1 s at 0.2 m/s, 0.6 s at 0.1 m/s, 0.2 s at 0.3 m/s.""",
    0.14,
    tol=0.002,
)
held.wrong("""one-command: uses the command at the first sighting for the whole time
    Does the robot get no new command for 0.9 s?
    Two more rows arrive, at 0.4 and at 1.0 s.
    Split the 0.9 s at 0.4 and at 1.0 s.""")(0.18)
held.wrong("""next-command: lets each command hold backwards, from the row before
    Does a robot obey a command before it is given?
    A row's command begins at its own time.
    Between 0.4 and 1.0 s the robot drives at 0.1 m/s.""")(0.25)
held.wrong("""whole-rows: counts whole rows and forgets where the sightings cut them
    The first sighting comes 0.3 s after the first row.
    Only 0.1 s of the first command lie between the sightings.
    0.02 + 0.06 + 0.06 m.""")(0.20)

lever = Numeric(
    """Sideways error after {way} m with the heading {off} degrees off
    Draw the two straight lines; they open like scissors.
    The gap is the way times the sine of the angle.
    {way} m times sin({off} degrees), and a degree is pi / 180 rad.""",
    lambda way, off: round(way * np.sin(np.radians(off)), 4),
    tol=0.02,
    world={"way": 40, "off": 3},
    draw=lambda rng: {"way": int(rng.integers(25, 60)), "off": int(rng.integers(2, 7))},
)
lever.wrong("""degrees: takes the sine of {off} radians
    Which unit does np.sin want?
    {off} degrees are {off} pi / 180 rad.
    np.sin(np.radians({off})).""")(lambda way, off: way * np.sin(off))
lever.wrong("""cosine: is the error along the way, not across it
    Which error is larger, along the way or across?
    Along the way it is 1 - cos, across it is sin.
    Use the sine.""")(lambda way, off: way * (1 - np.cos(np.radians(off))))

READING_AND_CALIBRATING = Question("Reading and calibrating", id="2")


def _rows(seed, T=12):
    rng = np.random.default_rng(seed)
    return np.stack((rng.uniform(-0.2, 1, T), rng.normal(0, 0.9, T), rng.uniform(0.1, 0.5, T)))


def _like_reference(f, u):
    found = np.asarray(f(u), dtype=float)
    return found.shape == (3,) and np.allclose(pf.between(follow(u), found), 0, atol=1e-9)


def _euler(u, early=0.0, chord=False):
    x = y = theta = 0.0
    for v, omega, dt in np.asarray(u, dtype=float).T:
        d = v * dt * (np.sinc(omega * dt / 2 / np.pi) if chord else 1.0)
        direction = theta + early * omega * dt
        x, y, theta = x + d * np.cos(direction), y + d * np.sin(direction), theta + omega * dt
    return np.array([x, y, theta])


def _square():
    turn = [[0.0], [np.pi / 2], [1.0]]
    side = [[2.0], [0.0], [1.0]]
    return np.hstack([side, turn] * 4)


@code(
    """Compose many rows of odometry into one motion
    Keep x, y, theta and carry out one row after the other.
    A row is an arc: its chord points half the turn ahead.
    d = v dt sinc(omega dt / 2 / pi), along theta + omega dt / 2; then theta += omega dt.""",
    fingerprint=lambda f: np.asarray(f(_rows(9)), dtype=float),
)
def follow(u):
    x = y = theta = 0.0
    for v, omega, dt in np.asarray(u, dtype=float).T:
        x, y, theta = pf.VelocityMotion().mean(np.array([x, y, theta]), np.array([v, omega, dt]))
    return x, y, theta


follow.holds("a straight line", lambda f: _like_reference(f, np.array([[1.0, 2], [0, 0], [1, 1]])))
follow.holds("a square ends where it began", lambda f: np.allclose(f(_square())[:2], 0))
follow.holds(
    "rows that drive and turn at once follow exact arcs",
    lambda f: all(_like_reference(f, _rows(seed)) for seed in range(4)),
)
follow.holds("a standing robot stays", lambda f: np.allclose(f(np.array([[0.0], [0], [5]])), 0))
follow.wrong("""straight-sum: adds up the distances and forgets where the robot looks
    Does a metre after a turn lead where a metre before it led?
    Each distance goes along the heading of its moment.
    Use cos and sin of the heading, row by row.""")(
    lambda u: np.array([np.sum(u[0] * u[2]), 0.0, np.sum(u[1] * u[2])])
)
follow.wrong("""start-heading: drives each row along the heading that it started with
    The robot turns while it drives.
    On average it looks half a turn further.
    The chord points along theta + omega dt / 2.""")(_euler)
follow.wrong("""end-heading: turns first and drives afterwards
    The robot turns while it drives.
    On average it has done half of the turn.
    The chord points along theta + omega dt / 2.""")(lambda u: _euler(u, 1.0))
follow.wrong("""arc-for-chord: has the direction right but goes the length of the arc, not of
         the chord
    Which is longer, an arc or its chord?
    The chord is shorter by the factor sin(h) / h, h half the turn.
    np.sinc(x) is sin(pi x) / (pi x): use np.sinc(h / np.pi).""")(lambda u: _euler(u, 0.5))


def _ranges(seed, noise=0.0):
    rng = np.random.default_rng(seed)
    ids, bias = np.array([7, 1, 6, 0]), rng.uniform(-4, 4, 4)
    index = np.concatenate((np.arange(4), rng.integers(0, 4, 36)))
    expected = rng.uniform(5, 70, index.size)
    return expected + bias[index] + noise * rng.normal(size=index.size), expected, ids[index], ids


def _finds(f, noise=0.0):
    return all(
        np.allclose(f(*_ranges(seed, noise)), bias(*_ranges(seed, noise))) for seed in range(4)
    )


@code(
    """One bias for each beacon
    What does least squares give when only a constant is fitted?
    A mean: of measured minus expected, of one beacon at a time.
    For each i in ids: np.mean((r - expected)[s == i]).""",
    fingerprint=lambda f: np.asarray(f(*_ranges(8, 1.0)), dtype=float),
)
def bias(r, expected, s, ids):
    return np.array([np.mean((r - expected)[s == i]) for i in ids])


bias.holds("four biases come back exactly when there is no noise", _finds)
bias.holds("with noise, the least-squares answer", lambda f: _finds(f, 1.5))
bias.holds(
    "in the order of ids",
    lambda f: np.allclose(
        np.asarray(f(*_ranges(3)[:3], np.array([0, 1, 6, 7]))),
        bias(*_ranges(3)[:3], np.array([0, 1, 6, 7])),
    ),
)
bias.wrong("""sign: has the sign turned round
    The radios read long. Which sign should a bias have?
    Bias is measured minus true.
    r - expected, not expected - r.""")(lambda r, expected, s, ids: -bias(r, expected, s, ids))
bias.wrong("""one-for-all: gives all beacons the same bias
    Are the four radios equally wrong?
    Take the errors of one beacon at a time.
    Select with s == i before you average.""")(
    lambda r, expected, s, ids: np.full(len(ids), np.mean(r - expected))
)
bias.wrong("""sorted: returns the biases in the order of sorted ids
    In which order are the beacons of the map?
    np.unique sorts; the map need not.
    Loop over ids.""")(lambda r, expected, s, ids: bias(r, expected, s, np.unique(ids)))
bias.wrong("""scale: fits a ratio, not an offset
    Is the error of a radio proportional to the distance?
    The question asks for metres, not for per cent.
    Subtract, do not divide.""")(
    lambda r, expected, s, ids: np.array([np.mean((r / expected)[s == i]) for i in ids])
)

WRONG_AND_SURE = Question("Wrong and sure", id="3")

biased = Prediction("""Ranges that read three metres long, and a model without a bias
    a  nothing much: the beacons stand on different sides, so the biases cancel
    b  the error grows to metres, and the cloud grows with it, so we are warned
    c* the error grows to metres, and the cloud says it is good to a metre
    d  the filter loses the mower for good""")


def _two_columns(run, rng, runs):
    found = np.array([run(rng) for _ in range(runs)], dtype=float)
    if found.shape != (runs, 2):
        raise ValueError(f"return two numbers, error and spread, got shape {found.shape[1:]}")
    return found


@experiment(
    """Wrong, and sure of it
    The first minute is lab.minute(); the model is pf.ComposedMotion().
    The sensor is pf.Range without a bias; start from a Gaussian about log.start.
    pf.run gives a History: rmse of its estimate, and the mean of its position_sd.""",
    after=biased,
    runs=12,
    pool=36,
    claim="without a bias in the model the error is more than twice the spread that is reported",
    test="median of error / spread over 12 runs is above 1.6, median error above 1.5 m",
    measure=_two_columns,
    false_fail=1e-4,
    margin="the ratio's median lies 10 of its own standard deviations above 1.6",
)
def biased_x(rng):
    log = lab.minute()
    sensor = pf.Range(log.world, sigma_r=3.0, nu=4)
    bel = pf.gaussian_prior(500, log.start, (0.2, 0.2, 0.02), rng)
    history = pf.run(log, bel, pf.ComposedMotion(), sensor, rng)
    return pf.rmse(history.estimate, log.truth), np.mean(history.position_sd)


biased_x.holds("the error is above 1.5 m", lambda x: np.median(x[:, 0]) > 1.5)
biased_x.holds("the spread is below 2 m", lambda x: 0.2 < np.median(x[:, 1]) < 2.0)
biased_x.holds("error over spread is above 1.6", lambda x: np.median(x[:, 0] / x[:, 1]) > 1.6)
biased_x.wrong("""knows-biases: still knows the biases, so nothing goes wrong
    What does your sensor believe about the mean error of a range?
    Leave the bias out of pf.Range.
    pf.Range(log.world, sigma_r=3.0, nu=4).""")(
    lambda rng: (0.9, 1.3), when=lambda x: np.median(x[:, 0]) <= 1.5
)
biased_x.wrong("""no-deviation: returns a spread that is no standard deviation in metres
    How large is a cloud of a mower on a lawn?
    Take the mean of history.position_sd.
    Return (error, spread), in this order, in metres.""")(
    lambda rng: (4.0, 12.0),
    when=lambda x: np.median(x[:, 0]) > 1.5 and not 0.2 < np.median(x[:, 1]) < 2.0,
)

LOST_AND_FOUND = Question("Lost and found", id="4")

lost = Prediction("""Thirty global starts with 1,000 particles, weighed plainly
    a  none or one of the thirty is lost
    b  about a third
    c* more than two thirds
    d  all thirty""")


@experiment(
    """Found from anywhere
    Start with pf.uniform_prior(1000, log.world, rng) on lab.stretch().
    Predict, pf.tempered_update, and resample if the effective sample size is low.
    Return pf.position_error(pf.mean_pose(bel), log.truth[:, -1]).""",
    after=lost,
    runs=15,
    pool=75,
    claim="with staged weighting most global starts end within half a metre",
    test="at least 9 of 15 runs end with an error below 0.5 m",
    measure=lambda run, rng, runs: np.array([float(run(rng)) for _ in range(runs)]),
    false_fail=1e-4,
    margin="a run fails with probability below 0.07; seven failures or more of 15: 4e-5",
)
def lost_x(rng, staged=True):
    log = lab.stretch()
    sensor = pf.RangeBearing(log.world, sigma_r=0.45, sigma_phi=0.02, nu=4)
    bel = pf.uniform_prior(1000, log.world, rng)
    for _, u, z, _ in log:
        bel = pf.predict(bel, u, pf.ComposedMotion(), rng)
        bel = (pf.tempered_update(bel, z, sensor, rng) if staged else pf.update(bel, z, sensor))[0]
        if bel.ess < bel.M / 2:
            bel = pf.resample(bel, pf.systematic, rng)
    return pf.position_error(pf.mean_pose(bel), log.truth[:, -1])


lost_x.holds("errors are finite metres", lambda x: np.isfinite(x).all() and (x >= 0).all())
lost_x.holds("9 of 15 runs end below 0.5 m", lambda x: np.sum(x < 0.5) >= 9)
lost_x.wrong("""plain: weighs plainly, and loses the robot most of the time
    How many of the first particles survive the first measurement?
    Let the measurement in by stages.
    bel, stages = pf.tempered_update(bel, z, sensor, rng).""")(
    lambda rng: lost_x(rng, staged=False), when=lambda x: np.sum(x < 0.5) < 9
)

JUDGING = Question("Judging", id="5")

third = Choice("""Two errors for the same log: whose number says more about the next drive?
    a  Ann's: she used all the data there is
       = Ann's settings were chosen because they suit these data: 5.5 cm is their best case.
    b* Ben's: what he scored on is mostly data that his settings have not seen
       = Yes: two thirds of his score come from data that had no part in the choice.
    c  both say the same, as it is the same log
       = The log is the same, but Ann scored on the very data that chose her settings.
    d  neither says anything, since there is only one log
       = One log says something, with a wide margin: another day may differ by more.""")

since = Choice("""A global start, and eleven seconds without any measurement: what do you
         report?
    a  the RMSE of the whole run, and no more
       = Eleven seconds in which nobody could know anything would hide all the rest.
    b  the RMSE after the filter has converged, and no more
       = Then a filter that is lost for ten minutes and lucky for one looks perfect.
    c* the RMSE from the first measurement on, and the time until the error stays small
       = Yes: it starts when knowing becomes possible, and says when it was achieved.
    d  the smallest error that was reached
       = A stopped clock is right twice a day.""")

cause = Choice("""Which single fault puts the filter behind dead reckoning?
    a  likelihoods averaged instead of multiplied
       = It blunts every measurement; the table shows a larger error, but no disaster.
    b* a bearing that is compared without the heading
       = Yes: the measurement then denies the true heading, and pulls the particles off it.
    c  an initial heading spread of 1.5 rad
       = A wide start costs a few seconds; the landmarks then settle the heading.
    d  resampling after every measurement
       = It costs diversity; with this much motion noise the cloud has enough of it.""")

report = Text(
    """A report that you could trust
    asks for a baseline, such as dead reckoning, in numbers
    asks for several seeds and an interval, or says that one run is an example
    asks which part of the data the settings were chosen on""",
    model="I would ask for the error of dead reckoning and of the filter in metres, over several "
    "seeds and with an interval, scored at stated times. I would ask on which data the settings "
    "were chosen. A picture of two tracks answers neither.",
)


LAB = Lab.of(__name__, "A real robot")
__getattr__ = LAB.verb
