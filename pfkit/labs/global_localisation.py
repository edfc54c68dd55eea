"""Global localisation and symmetry. Questions on copies that look alike."""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment

PREDICT = Question("Predictions")

CENTRE = np.array([7.5, 7.5])

keep = Prediction("""Hypotheses of four alive after a lap of the square, 5,000 particles
    a  all four in nearly every run: nothing the robot saw tells them apart
    b  about three
    c* about two
    d  one in nearly every run""")

luck = Prediction("""Share of 200 filters whose heaviest cloud is the robot's own
    a  nearly all of them
    b  about half
    c* about a quarter
    d  nearly none""")

HAND = Question("By hand")

hand = Numeric(
    """Three particles, one in each of three rooms: all three kept, and rooms
         kept on average
    Three draws out of three, with replacement. In how many of the 27 is nobody missing?
    All three kept: 3! orders. One room is missed by all draws with probability (2/3)^3.
    3! / 3^3, and 3 (1 - (2/3)^3).""",
    (0.222, 2.111),
    tol=0.006,
    names=("probability that all three are kept", "rooms kept on average"),
)
hand.wrong("""one-draw: counts one draw where the scheme makes three
    How many particles are drawn?
    A room is lost only if all three draws miss it.
    (2/3)^3 is the chance to lose one room; 3! / 27 to keep all.""")((1 / 3, 1.0))
hand.wrong("""four: is the answer for four rooms, as in the text
    How many rooms are there now?
    Replace 4 by 3.
    3! / 3^3 and 3 (1 - (2/3)^3).""")((0.094, 2.734))
hand.wrong("""independent: multiplies the three chances of survival as if the draws did not
         compete
    If two rooms are kept by two draws, how many draws are left for the third?
    The chances are not independent; count the orders instead.
    3! of the 27 outcomes name each room once.""")((0.348, 2.111))

IDEA = Question("Copies and chances")

mirror = Choice("""A square also has four mirror symmetries. Why are they no hypotheses?
    a  a mirror image changes the ranges
       = A mirror keeps all distances.
    b* a mirror image changes the sign of every bearing
       = Yes: left and right change places, and a bearing knows left from right.
    c  a robot cannot drive through a mirror line
       = The question is what it would measure there, not how it would get there.
    d  they are: there are eight hypotheses
       = Look at one landmark ahead on the left; in the mirrored world it is on the right.""")

unnamed = Numeric(
    """Number of hypotheses: two unnamed landmarks, and the pentagon world with
         40
    Which turns of the plane send the set of landmarks onto itself?
    Two points: half a turn about their midpoint. A ring of five: fifths of a turn.
    More rings of five about one centre add no symmetry and remove none.""",
    (2, 5),
    tol=0.1,
    names=("two unnamed landmarks", "forty landmarks in rings of five"),
)
unnamed.wrong("""mirrors: counts mirror images as well
    What happens to the bearings in a mirror?
    A mirror image swaps left and right.
    Count turns only.""")((4, 10))
unnamed.wrong("""landmarks: counts landmarks, not symmetries
    Is every landmark the image of every other under some turn of the whole map?
    Landmarks of different rings cannot change places.
    The turns are those of one ring.""")((2, 40))
unnamed.wrong("""named: lets the robot know which landmark is which
    Has the robot read a name?
    Exchange the two landmarks by half a turn: what does the robot notice?
    Without names the half turn is a symmetry.""")((1, 5))

founders = Numeric(
    """A hypothesis takes up 0.0002 of the prior; 5,000 particles: chance that it
         is empty
    How many particles do you expect there?
    One on average. Their number is nearly Poisson.
    exp(-5000 * 0.0002)""",
    0.368,
    tol=0.004,
)
founders.wrong("""not-empty: is the chance that it is not empty
    Which of the two did the question ask for?
    P(empty) + P(not empty) = 1.
    exp(-1), not 1 - exp(-1).""")(0.632)
founders.wrong("""mean-enough: takes an average of one for a certainty
    One on average: does that mean one in every run?
    Some runs have two, so others must have none.
    exp(-1)""")(0.0)
founders.wrong("""all-four: is the chance that all four hypotheses are empty
    How many hypotheses does the question name?
    Just one of them.
    Do not take the fourth power.""")(0.0183)

nats = Numeric(
    """Two of four hypotheses left, with masses 3/4 and 1/4: how many nats
    Compare each mass with the 1/4 that the exact belief gives it.
    Sum of W log(W / 0.25); an empty hypothesis adds nothing.
    0.75 log 3 + 0.25 log 1""",
    0.824,
    tol=0.005,
    unit="nats",
)
nats.wrong("""bits: is in bits
    Which logarithm?
    Nats come from the natural logarithm.
    0.75 ln 3""")(1.189)
nats.wrong("""equal: takes the two masses as equal
    Are both clouds equally heavy?
    log 2 would be right for masses of one half each.
    Use 3/4 and 1/4.""")(0.693)
nats.wrong("""entropy: is the entropy of the masses itself
    Should four equal masses give zero?
    The divergence is log 4 minus the entropy.
    1.386 - 0.562""")(0.562)

CODE = Question("Code")

POSE = np.array([2.0, 1.0, 2.5])


def _shape(f):
    found = np.asarray(f(POSE, 5, np.zeros(2)), dtype=float)
    return True if found.shape == (3, 5) else f"shape {found.shape}, expected (3, 5)"


def _in_square(f):
    """Whether all copies measure the same, landmark by landmark, in the square and a pentagon."""
    for world, n, centre in ((pf.worlds.square(), 4, CENTRE), (pf.worlds.pentagon(), 5, (0, 0))):
        poses = np.asarray(f(POSE, n, np.array(centre, dtype=float)), dtype=float)
        r, phi, _ = pf.RangeBearing(world, 1.0, 1.0).expected(poses)
        seen = np.sort_complex((r * np.exp(1j * phi)).round(6).T)
        if not np.allclose(seen, seen[0], atol=1e-5):
            return False
    return True


def _different(f):
    poses = np.asarray(f(POSE, 4, CENTRE), dtype=float)
    return len({tuple(c) for c in poses[:2].round(6).T}) == 4


def _wrapped(f):
    theta = np.asarray(f(POSE, 4, CENTRE), dtype=float)[2]
    return (np.abs(theta) <= np.pi + 1e-9).all()


@code(
    """The n copies of a pose under turns about a centre
    Subtract the centre, turn, add the centre. And which way does the robot look then?
    turn = 2 pi / n * arange(n); the heading turns with the position.
    x = cx + cos(turn) dx - sin(turn) dy; theta = wrap(theta + turn)""",
    points=2,
    fingerprint=lambda f: np.asarray(f(POSE, 4, CENTRE), dtype=float),
)
def copies(pose, n=4, centre=CENTRE):
    turn = 2 * np.pi / n * np.arange(n)
    c, s = np.cos(turn), np.sin(turn)
    dx, dy = pose[0] - centre[0], pose[1] - centre[1]
    x, y = centre[0] + c * dx - s * dy, centre[1] + s * dx + c * dy
    return np.stack((x, y, pf.wrap(pose[2] + turn)))


copies.holds("shape (3, n)", _shape)
copies.holds(
    "the first copy is the pose itself",
    lambda f: np.allclose(np.asarray(f(POSE, 4, CENTRE))[:, 0], POSE),
)
copies.holds("a robot at any copy measures the same set of ranges and bearings", _in_square)
copies.holds("the copies stand at n different places", _different)
copies.holds("headings lie in (-pi, pi]", _wrapped)


@copies.wrong("""turns the position and leaves the heading
    Stand at one copy: is the landmark still ahead on the left?
    When the robot is carried round the centre it must turn as well.
    Add the turn to theta, and wrap.""")
def _keeps_heading(pose, n=4, centre=CENTRE):
    found = copies(pose, n, centre)
    found[2] = pose[2]
    return found


copies.wrong("""origin: turns about the origin instead of the centre
    Where is the centre of the landmarks?
    Subtract the centre before you turn and add it afterwards.
    dx, dy = pose[0] - centre[0], pose[1] - centre[1]""")(
    lambda pose, n=4, centre=CENTRE: copies(pose, n, np.zeros(2))
)


@copies.wrong("""lets headings run past pi
    Print the four headings.
    2.5 + 3 pi / 2 is a heading, but not in (-pi, pi].
    pf.wrap(pose[2] + turn)""")
def _unwrapped(pose, n=4, centre=CENTRE):
    found = copies(pose, n, centre)
    found[2] = pose[2] + 2 * np.pi / n * np.arange(n)
    return found


@copies.wrong("""mirrors where it should turn
    What happens to a landmark on the left?
    Mirror images swap left and right.
    Use turns by 2 pi / n only.""")
def mirror_(pose, n=4, centre=CENTRE):
    found = copies(pose, n, centre)
    x, y, theta = found[:, 1::2]
    found[:, 1::2] = 2 * centre[0] - x, y, pf.wrap(np.pi - theta)
    return found


@copies.wrong("""goes half way round only: its turns are steps of pi / n
    How large is a full turn?
    n equal steps make 2 pi.
    turn = 2 * np.pi / n * np.arange(n)""")
def half_steps(pose, n=4, centre=CENTRE):
    turn = np.pi / n * np.arange(n)
    about = np.stack((0 * turn + centre[0], 0 * turn + centre[1], turn))
    return pf.compose(about, pose - np.array([*centre, 0.0]))


def _missing_is(W, value):
    def holds(f):
        with np.errstate(all="ignore"):
            found = float(f(np.array(W, dtype=float)))
        return True if np.isclose(found, value, atol=1e-9) else f"{found:.4g} for {W}"

    return holds


def _print_missing(f):
    with np.errstate(all="ignore"):
        cases = ([1, 1, 1, 1], [1, 1, 0, 0], [0.6, 0.3, 0.1], [2, 1, 1, 4])
        return [float(f(np.array(W, dtype=float))) for W in cases]


@code(
    """Nats lost when hypotheses that should be equal are not
    Compare each mass with an equal share.
    Sum of W log(W / (1 / G)); an empty hypothesis adds nothing.
    log G + sum of W log W over the W above zero, after W = W / W.sum().""",
    fingerprint=_print_missing,
    atol=1e-6,
)
def missing(W):
    W = np.asarray(W, dtype=float) / np.sum(W)
    some = W[W > 0]
    return float(np.log(W.size) + np.sum(some * np.log(some)))


missing.holds("zero for four equal masses", _missing_is([0.25] * 4, 0.0))
missing.holds("log 4 when one of four is left", _missing_is([0, 1, 0, 0], np.log(4)))
missing.holds("log 2 when two equal ones are left", _missing_is([0.5, 0.5, 0, 0], np.log(2)))
missing.holds("any number of hypotheses", _missing_is([0.6, 0.3, 0.1], 0.200667))
missing.holds("masses that do not sum to one are scaled", _missing_is([2, 2], 0.0))


@missing.wrong("""stumbles over empty hypotheses: 0 log 0 came out as nan
    What does NumPy make of 0 * log(0)?
    The limit of W log W at zero is zero.
    Sum over W[W > 0] only.""")
def nan(W):
    with np.errstate(all="ignore"):
        W = W / np.sum(W)
        return np.log(W.size) + np.sum(W * np.log(W))


missing.wrong("""entropy: returns the entropy: largest where it should be zero
    What should four equal masses give?
    The divergence is log G minus the entropy.
    np.log(W.size) - entropy""")(lambda W: np.log(np.size(W)) - missing(W))
missing.wrong("""bits: counts in bits
    Which logarithm did you take?
    Nats need the natural one.
    np.log""")(lambda W: missing(W) / np.log(2))
missing.wrong("""mean: averages over the hypotheses where it should weigh by mass
    Which density does the expectation belong to?
    The particles' own: weigh each logarithm by W.
    np.sum(W * ...), not np.mean(...)""")(lambda W: missing(W) / np.size(W))

EXPERIMENTS = Question("Experiments")


def _sensor(world):
    return pf.MaximumLikelihood(pf.RangeBearing(world, 0.3, 0.1))


def _even(x):
    shares = np.array([np.mean(x == h) for h in range(4)])
    off = np.abs(shares - 0.25).max()
    return True if off < 0.135 else f"shares {shares.round(2).tolist()}"


@experiment(
    """Hypotheses alive after one look, with 1,000 and with 10,000 particles
    Draw a uniform prior, weigh it once, count the copies with more than 1 % of the mass.
    pf.update(bel, sensor.sample(start, rng), sensor); pf.hypothesis_mass near the images.
    np.sum(pf.hypothesis_mass(bel, pf.images(start, g), 1.5) > 0.01)""",
    points=2,
    after=keep,
    runs=40,
    pool=200,
    claim="more particles found more of the four hypotheses, and 1,000 do not found them all",
    test="mean at 10,000 above mean at 1,000 by 1 or more; mean at 1,000 below 2.4",
    measure=(
        lambda f, rng, runs: (
            [
                [f(1000, a), f(10_000, b)]
                for a, b in zip(rng.spawn(runs), rng.spawn(runs), strict=True)
            ]
        )
    ),
    margin="6 standard errors: the difference is 2.0 with sd 1.05 over 40 pairs; the mean, 1.5",
)
def alive_x(M, rng, floor=0.01, named=False):
    world = pf.worlds.square()
    known = pf.RangeBearing(world, 0.3, 0.1)
    sensor = known if named else _sensor(world)
    bel = pf.uniform_prior(M, world, rng)
    bel, _ = pf.update(bel, sensor.sample(pf.worlds.SQUARE_START, rng), sensor)
    poses = pf.images(pf.worlds.SQUARE_START, pf.symmetries(world))
    return np.sum(pf.hypothesis_mass(bel, poses, 1.5) > floor)


alive_x.holds(
    "whole numbers from 0 to 4", lambda x: (x >= 0).all() and (x <= 4).all() and (x % 1 == 0).all()
)
alive_x.holds(
    "10,000 particles found at least one hypothesis more, on average",
    lambda x: np.mean(x[:, 1] - x[:, 0]) >= 1,
)
alive_x.holds("1,000 particles found less than 2.4", lambda x: x[:, 0].mean() < 2.4)
alive_x.wrong("""named: lets the landmarks have names, so that there is one hypothesis only
    Does your sensor know which landmark is which?
    Wrap the sensor in pf.MaximumLikelihood.
    sensor = pf.MaximumLikelihood(pf.RangeBearing(world, 0.3, 0.1))""")(
    lambda M, rng: alive_x(M, rng, named=True), when=lambda x: (x <= 1).all() and (x % 1 == 0).all()
)
alive_x.wrong("""no-look: counts before the look: four in every run
    Where does the prior put its particles?
    Weigh the set with one measurement first.
    bel, _ = pf.update(bel, z, sensor)""")(lambda M, rng: 4, when=lambda x: (x == 4).all())
alive_x.wrong("""mass: returns a mass, not a count
    How many hypotheses can be alive?
    Compare each mass with 0.01 and count.
    np.sum(masses > 0.01)""")(
    lambda M, rng: alive_x(M, rng, 0.01) / 4, when=lambda x: x.max() <= 1 and (x % 1 != 0).any()
)


@experiment(
    """Which of the four copies do 200 filters end at?
    Simulate a batch of logs, run a batch of filters, ask pf.hypothesis_mass for the copies.
    pf.hypothesis_mass(bel, poses, 3.0) is (4, runs); argmax(axis=0) names the heaviest.
    poses = pf.images(log.truth[:, -1, :, 0], pf.symmetries(world)); start from
         pf.uniform_prior((runs, 300), world, rng).""",
    points=2,
    after=luck,
    runs=200,
    pool=1_500,
    claim="in an exactly symmetric world the filter ends at the robot once in four runs",
    test="each of the four shares of 200 runs within 0.135 of a quarter",
    measure=lambda f, rng, runs: np.asarray(f(rng, runs)),
    margin="4.4 standard errors of a share of a quarter in 200 runs, four binomial shares: 8e-5",
)
def luck_x(rng, runs, M=300, world=None, named=False, start=None):
    """Index of the heaviest copy after six looks along the first side of the square."""
    world = pf.worlds.square() if world is None else world
    sensor = pf.RangeBearing(world, 0.3, 0.1) if named else _sensor(world)
    motion = pf.VelocityMotion(alpha=(0.02, 0.002, 0.002, 0.02, 0.002, 0.002))
    u = np.tile([[1.0], [0.0], [2.0]], 6)
    log = pf.simulate_log(pf.worlds.SQUARE_START, u, motion, sensor, rng, batch=runs)
    bel = pf.uniform_prior((runs, M), world, rng)
    if start is not None:
        bel = pf.gaussian_prior((runs, M), start, [0.2, 0.2, 0.05], rng)
    bel = pf.run(log, bel, motion, sensor, rng).bel
    poses = pf.images(log.truth[:, -1, :, 0], pf.symmetries(pf.worlds.square()))
    return pf.hypothesis_mass(bel, poses, 3.0).argmax(axis=0)


luck_x.holds("one whole number from 0 to 3 for each run", lambda x: np.isin(x, range(4)).all())
luck_x.holds("each copy is the heaviest in a quarter of the runs", _even)
luck_x.wrong("""yes-no: returns yes or no instead of the number of the copy
    Which values occur in your result?
    Return 0, 1, 2 or 3: the place of the heaviest copy.
    masses.argmax(axis=0)""")(
    lambda rng, runs: luck_x(rng, runs) == 0, when=lambda x: set(np.unique(x)) == {0.0, 1.0}
)
luck_x.wrong("""told: is always right: somebody told the filter where it is
    What does your filter know that the measurements do not say?
    Look for names of landmarks, a known start, or a prior that leaves copies out.
    Use pf.MaximumLikelihood and pf.uniform_prior over pf.worlds.square().""")(
    lambda rng, runs: luck_x(rng, runs, named=True), when=lambda x: np.mean(x == 0) > 0.6
)
luck_x.wrong("""wrong-corner: always ends at one and the same wrong copy
    Which copy did you start from?
    Every copy must have the same chance.
    Start from pf.uniform_prior over the whole box.""")(
    lambda rng, runs: luck_x(rng, runs, start=[15.0, 15.0, np.pi]),
    when=lambda x: any(np.mean(x == h) > 0.6 for h in (1, 2, 3)),
)

prior = Choice("""Exact square, no names: which prior makes the filter find the true corner
         every time?
    a  one over a box so large that all four copies lie well inside
       = This one is honest, and leaves four answers.
    b* one over a box that holds the robot but none of its copies
       = Yes: the box already says which corner it is.
    c  one over the landmarks' own box, which holds neither
       = It holds no right answer at all; what survives is whatever drives out to one.
    d  none: no prior can help where measurements cannot
       = A prior is information like any other; it can break a symmetry by itself.""")

report = Text(
    """A colleague: with 1,000 particles it failed, with 5,000 it converged to
         the true pose
    says that the exact belief has four equal modes, so converging to one is a loss
    says that the true one survives by chance, one time in four: one run shows nothing
    asks for many seeds and for the share of runs with the true hypothesis alive""",
    model="In this map four poses explain everything, so the honest belief keeps four clouds, and "
    "one cloud means that three were lost. "
    "That the robot's own was left is luck, one chance in four whatever the number of "
    "particles. "
    "Repeat it over many seeds, and report how often the true hypothesis is still alive.",
)


LAB = Lab.of(__name__, "Global localisation and symmetry")
__getattr__ = LAB.verb
