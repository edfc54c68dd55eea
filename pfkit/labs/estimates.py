"""Estimates. One pose, several, or none: what should a cloud answer?"""

import numpy as np

from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment
from pfkit.labs.response import same_mean, same_scatter

PREDICT = Question("Predictions")

halfway = Prediction("""Two heaps of equal mass, 4 m apart. Which report has the smallest mean
          squared error?
    a* the point halfway between them, where no particle is
    b  the centre of either heap
    c  all of these are equally good
    d  the heaviest particle""")

cancel = Prediction("""1,000 headings, each as likely as any other: the length of their mean vector
    a  exactly 0
    b* a few hundredths
    c  about one half
    d  nearly 1""")

HAND = Question("By hand")


def _five(rng):
    """Five places on a corridor and their weights; three summaries that differ."""
    while True:
        x = np.sort(rng.choice(12, 5, replace=False)).tolist()
        w = rng.permutation([0.10, 0.15, 0.20, 0.25, 0.30]).tolist()
        three = _summaries(x, w)
        if len({round(v, 6) for v in (*three, np.mean(x), np.median(x), 0.5 * (x[0] + x[4]))}) == 6:
            return {"x": x, "w": w}


def _summaries(x, w):
    k = int(np.searchsorted(np.cumsum(w), 0.5 - 1e-9))
    return float(np.dot(x, w)), float(x[k]), float(x[int(np.argmax(w))])


hand = Numeric(
    """Three summaries of particles at {x} m with weights {w}
    Mean: multiply and add. Median: walk from the left. Mode: which one is heaviest?
    The median is where the weights, summed from the left, first reach one half.
    Sum x w; the first place with half of the weight behind it; the place of the largest w.""",
    _summaries,
    tol=0.01,
    unit="m",
    names=("weighted mean", "weighted median", "heaviest particle"),
    world={"x": [1, 2, 4, 9, 10], "w": [0.30, 0.25, 0.10, 0.15, 0.20]},
    draw=_five,
)
hand.wrong("""unweighted: counts each particle once, whatever it weighs
    Is the particle of weight .10 worth as much as that of .30?
    The weights say how often a particle is meant.
    Sum x w for the mean; sum w from the left for the median.""")(
    lambda x, w: (float(np.mean(x)), float(np.median(x)), _summaries(x, w)[2])
)
hand.wrong("""middle-particle: has the weighted mean, but the middle particle for the median
    How much weight lies to the left of your median, how much to its right?
    Not the third of five: the place where half of the weight is behind you.
    Add {w} from the left until you pass .5.""")(
    lambda x, w: (_summaries(x, w)[0], float(np.median(x)), _summaries(x, w)[2])
)
hand.wrong("""weight-for-place: gives the largest weight where its place is asked for
    In which unit is your third number?
    The heaviest particle stands somewhere.
    The place under the largest of {w}.""")(lambda x, w: (*_summaries(x, w)[:2], max(w)))


def _counts(rng):
    while True:
        a, b, c = (int(n) for n in rng.integers(1, 7, 3))
        if a > c + 1 and b != a:
            return {"a": a, "b": b, "c": c}


def _vector(a, b, c):
    return (
        float(np.degrees(np.arctan2(b, a - c))),
        float(np.hypot(b, a - c)) / (a + b + c),
    )


turn = Numeric(
    """{a} headings of 0 degrees, {b} of 90, {c} of 180: mean direction in degrees, and R
    Draw the arrows one after another: east, north, west.
    The sum goes {a} - {c} to the east and {b} to the north.
    atan2({b}, {a} - {c}), and the length of the sum over the number of arrows.""",
    _vector,
    tol=0.005,
    names=("mean direction in degrees", "resultant length"),
    world={"a": 4, "b": 1, "c": 2},
    draw=_counts,
)
turn.wrong("""plain: averages the degrees as plain numbers
    Would your mean survive if 180 were written as -180?
    Add arrows, not numbers.
    East {a} - {c}, north {b}.""")(
    lambda a, b, c: ((90 * b + 180 * c) / (a + b + c), _vector(a, b, c)[1])
)
turn.wrong("""sum: gives the length of the sum, not of the mean
    Can the mean of arrows of length 1 be longer than 1?
    How many arrows are there?
    Divide by {a} + {b} + {c}.""")(lambda a, b, c: (_vector(a, b, c)[0], float(np.hypot(b, a - c))))
turn.wrong("""radians: is in radians
    A quarter turn has 90 of the unit that is asked for.
    np.degrees turns one into the other.
    Multiply by 180 and divide by pi.""")(
    lambda a, b, c: (float(np.arctan2(b, a - c)), _vector(a, b, c)[1])
)
turn.wrong("""opposite: lets the headings of 180 degrees add to those of 0
    Where does an arrow of 180 degrees point?
    West takes away from east.
    {a} - {c} to the east.""")(
    lambda a, b, c: (
        float(np.degrees(np.arctan2(b, a + c))),
        float(np.hypot(b, a + c)) / (a + b + c),
    )
)


def _two_heaps(rng):
    return {
        "p": float(rng.choice([0.6, 0.7, 0.8])),
        "d": int(rng.integers(3, 9)),
        "s": float(rng.choice([0.3, 0.4, 0.5, 0.6])),
    }


total = Numeric(
    """Variance within and between two heaps of masses {p} and the rest, {d} m apart, sd {s} m each
    How far is each heap from the mean of the cloud?
    Within: the mean of the two variances. Between: the variance of the two centres.
    {s}^2, and p (1 - p) d^2 with p = {p}.""",
    lambda p, d, s: (s**2, p * (1 - p) * d**2),
    tol=0.005,
    names=("within, m^2", "between, m^2"),
    world={"p": 0.7, "d": 4, "s": 0.5},
    draw=_two_heaps,
)
total.wrong("""sd: gives standard deviations
    In square metres, says the question.
    Do not take the root.
    Square both.""")(lambda p, d, s: (s, float(np.sqrt(p * (1 - p))) * d))
total.wrong("""doubled: adds the two variances within where it should average them
    Of a hundred particles, how many have the first heap's spread and how many the second's?
    Masses sum to one.
    p s^2 + (1 - p) s^2 = s^2.""")(lambda p, d, s: (2 * s**2, p * (1 - p) * d**2))
total.wrong("""equal: takes the heaps for equally heavy
    The mean lies nearer to the heavier heap.
    A yes with probability p has which variance?
    p (1 - p) with p = {p}, not one quarter.""")(lambda p, d, s: (s**2, d**2 / 4))
total.wrong("""distance: is the squared distance itself
    Is the mean of the cloud at one of the two centres?
    It lies between, (1 - p) d from one and p d from the other.
    p ((1 - p) d)^2 + (1 - p) (p d)^2.""")(lambda p, d, s: (s**2, float(d**2)))


def _costs(rng):
    wrong = int(rng.choice([8, 10, 20, 25, 40, 50]))
    return {"wrong": wrong, "ask": int(rng.integers(1, wrong // 3 + 1))}


ask = Numeric(
    """A wrong answer costs {wrong}, another look costs {ask}: from which mass of the heaviest heap
         on should the robot answer?
    What does answering cost on average, if the heap holds the mass p?
    The answer is wrong with probability 1 - p.
    {wrong} (1 - p) = {ask}.""",
    lambda wrong, ask: 1 - ask / wrong,
    tol=0.005,
    world={"wrong": 20, "ask": 3},
    draw=_costs,
)
ask.wrong("""complement: is the mass that may be elsewhere
    A costly mistake should make the robot more careful. Does it?
    You have the probability to be wrong at which both cost the same.
    One minus it.""")(lambda wrong, ask: ask / wrong)
ask.wrong("""odds: takes the costs for odds
    Does a right answer cost anything?
    Answering costs {wrong} (1 - p), looking costs {ask} whatever is true.
    1 - {ask} / {wrong}.""")(lambda wrong, ask: wrong / (wrong + ask))
ask.wrong("""half: answers as soon as the heap holds most of the mass
    At one half, what does answering cost on average?
    Half of {wrong}. And looking?
    1 - {ask} / {wrong}.""")(0.5)

CODE = Question("Code")


def _headings(seed, M=30):
    rng = np.random.default_rng(seed)
    return rng.uniform(-4, 7, M), rng.random(M)


def _direction_is(f, theta, w):
    z = np.sum(w * np.exp(1j * theta)) / np.sum(w)
    mean, R = f(theta.copy(), w.copy())
    return bool(abs(R - abs(z)) < 1e-9), bool(abs(np.exp(1j * mean) - z / abs(z)) < 1e-6)


def _none(f, pairs):
    for theta, w in pairs:
        mean, R = f(np.array(theta), np.array(w))
        if not np.isnan(mean) or abs(R) > 1e-9:
            return f"({mean:.4g}, {R:.4g}) for headings {np.round(theta, 2).tolist()}"
    return True


BALANCED = (
    ([0.0, np.pi], [0.5, 0.5]),
    ([0.3, 0.3 - np.pi], [2.0, 2.0]),
    ((2 * np.pi * np.arange(5) / 5).tolist(), [0.2] * 5),
)


@code(
    """A mean direction that says when there is none
    Average sines and cosines, with weights.
    R is the length of that mean vector: divide by the sum of the weights.
    Below 1e-9 nothing but rounding is left: return (np.nan, R).""",
    points=2,
    fingerprint=lambda f: np.concatenate(
        [np.ravel(f(*_headings(s))) for s in (5, 6)]
        + [np.ravel(f(np.array([0, np.pi]), np.ones(2)))]
    ),
)
def direction(theta, w):
    east, north = w @ np.cos(theta) / w.sum(), w @ np.sin(theta) / w.sum()
    R = np.hypot(east, north)
    return (np.arctan2(north, east) if R > 1e-9 else np.nan), R


direction.holds(
    "the mean direction of weighted headings",
    lambda f: all(_direction_is(f, *_headings(s))[1] for s in range(20)),
)
direction.holds(
    "and R, whatever the weights sum to",
    lambda f: all(_direction_is(f, *_headings(s))[0] for s in range(20)),
)
direction.holds("no direction, and R = 0, for balanced headings", lambda f: _none(f, BALANCED))
direction.holds(
    "but one for headings that nearly balance",
    lambda f: bool(abs(f(np.array([0.4, 0.4 - np.pi]), np.array([0.501, 0.499]))[0] - 0.4) < 1e-6),
)


@direction.wrong("""returns a direction for headings that cancel
    What is left of two opposite arrows?
    arctan2 of two rounding errors is a number all the same.
    Where R is below 1e-9, return np.nan for the direction.""")
def always(theta, w):
    east, north = w @ np.cos(theta) / w.sum(), w @ np.sin(theta) / w.sum()
    return np.arctan2(north, east), np.hypot(east, north)


@direction.wrong("""gives every heading the same say
    What is w for?
    A heavy particle pulls harder.
    w @ np.cos(theta)""")
def no_weights(theta, w):
    return direction(theta, np.ones_like(w))


@direction.wrong("""does not divide by the sum of the weights
    Can R be above 1?
    The weights need not sum to one.
    Divide both sums by w.sum().""")
def not_divided(theta, w):
    mean, R = direction(theta, w)
    return mean, R * w.sum()


@direction.wrong("""averages the angles as plain numbers
    Would 359 degrees and 1 degree give 180?
    Angles are directions: add arrows.
    np.arctan2(w @ np.sin(theta), w @ np.cos(theta))""")
def plain(theta, w):
    return w @ theta / w.sum(), direction(theta, w)[1]


direction.refuses("no direction as soon as R is small, not only when it is zero")(
    lambda theta, w: direction(theta, w) if direction(theta, w)[1] > 0.01 else (np.nan, 0.0)
)
direction.refuses("zero for a direction that does not exist")(
    lambda theta, w: tuple(np.nan_to_num(direction(theta, w)))
)
direction.refuses("R squared")(
    lambda theta, w: (direction(theta, w)[0], direction(theta, w)[1] ** 2)
)


LOSSES = {
    "squared": lambda d: d**2,
    "distance": lambda d: d,
    "hit or miss": lambda d: (d > 0.6) * 1.0,
    "capped": lambda d: np.minimum(d, 2.0),
}


def _plane(seed, M=25):
    rng = np.random.default_rng(seed)
    x = rng.normal(0, 0.6, (2, M)) + 4.0 * (rng.random(M) < 0.4)
    return x, rng.dirichlet(np.full(M, 0.8))


def _risk(x, w, at, loss):
    return float(w @ loss(np.hypot(*(x - np.reshape(at, (2, 1))))))


def _best_for(name):
    def holds(f):
        loss = LOSSES[name]
        for seed in range(12):
            x, w = _plane(seed)
            at = np.asarray(f(x.copy(), w.copy(), loss), dtype=float)
            if at.shape != (2,):
                return f"a place of shape {at.shape}, not (2,)"
            if not (np.abs(x - at[:, None]) < 1e-9).all(axis=0).any():
                return "a place where no particle is"
            if _risk(x, w, at, loss) > min(_risk(x, w, p, loss) for p in x.T) + 1e-9:
                return "another particle has a smaller expected loss"
        return True

    return holds


@code(
    """The best report among the particles, for any loss
    Try each particle as the report: how far is each other particle from it?
    d[k, m] is the distance of particle m from report k; the expected loss of report k is
         loss(d) @ w.
    d = np.hypot(*(x[:, :, None] - x[:, None, :])), then argmin.""",
    points=2,
    fingerprint=lambda f: np.concatenate(
        [np.ravel(f(*_plane(s), LOSSES[n])) for s in (20, 21, 22) for n in LOSSES]
    ),
)
def best(x, w, loss):
    d = np.hypot(*(x[:, :, None] - x[:, None, :]))
    return x[:, np.argmin(loss(d) @ w)]


for _name in LOSSES:
    best.holds(f"the particle of smallest expected loss: {_name}", _best_for(_name))


@best.wrong("""gives every particle the same say
    Where does w enter?
    Expected means weighted: a loss at a heavy particle counts more.
    loss(d) @ w""")
def best_unweighted(x, w, loss):
    return best(x, np.full(w.size, 1 / w.size), loss)


@best.wrong("""squares the distance whatever loss was asked for
    What does your function do with its third argument?
    The check hands over four losses.
    loss(d), not d**2""")
def best_squared(x, w, loss):
    return best(x, w, LOSSES["squared"])


@best.wrong("""weighs the reports, not the truths
    Whose weight says how likely a loss is?
    Row k is the report, column m a possible truth: the weight belongs to the truth.
    loss(d) @ w sums over the truths.""")
def weighed_reports(x, w, loss):
    d = np.hypot(*(x[:, :, None] - x[:, None, :]))
    return x[:, np.argmin(w * loss(d).sum(axis=1))]


@best.wrong("""finds the largest expected loss
    Is a loss good or bad?
    The best report loses least.
    np.argmin""")
def worst(x, w, loss):
    d = np.hypot(*(x[:, :, None] - x[:, None, :]))
    return x[:, np.argmax(loss(d) @ w)]


best.refuses("the heaviest particle")(lambda x, w, loss: x[:, np.argmax(w)])
best.refuses("the mean, where no particle is")(lambda x, w, loss: x @ w)
best.refuses("the loss of the mean distance")(
    lambda x, w, loss: x[:, np.argmin(loss(np.hypot(*(x[:, :, None] - x[:, None, :])) @ w))]
)
best.refuses("the index of the particle")(
    lambda x, w, loss: int(np.argmin(loss(np.hypot(*(x[:, :, None] - x[:, None, :]))) @ w))
)

EXPERIMENTS = Question("Experiments")


def _halves(rng):
    """Masses, distances and widths that the student did not choose."""
    return [
        (round(rng.uniform(0.55, 0.9), 2), round(rng.uniform(2, 4), 1), round(s, 2))
        for s in rng.uniform(0.8, 1.4, 3)
    ]


@experiment(
    """The price of two reports
    Draw the truths first: with probability p at heap 0, else at heap d, each with sd s.
    The mean of the cloud is (1 - p) d; the heavier heap's centre is 0.
    np.array(((truth - (1 - p) * d) ** 2, truth**2)) with runs truths.""",
    points=2,
    after=halfway,
    runs=1_000,
    pool=6_000,
    settings=_halves,
    together=True,
    claim="the mean has the smaller squared error, though no particle need be near it",
    test="three pairs of heaps: both mean squared errors within 5 standard errors of a right "
    "experiment's, and as much scatter",
    margin="equal means within 5 standard errors in seven comparisons: 4e-6",
)
def halfway_x(p, d, s, rng, runs):
    truth = np.where(rng.random(runs) < p, 0, d) + s * rng.standard_normal(runs)
    return np.array(((truth - (1 - p) * d) ** 2, truth**2))


halfway_x.holds("both errors as in a right experiment", same_mean(5.0))
halfway_x.holds("they scatter as truths do", same_scatter())


@halfway_x.wrong("""measures distances, not their squares
    Which error does the question price?
    Far misses hurt more than in proportion.
    Square the differences.""")
def distances(p, d, s, rng, runs):
    return np.sqrt(halfway_x(p, d, s, rng, runs))


@halfway_x.wrong("""puts half of the truths into each heap
    How often is the truth in the heavier heap?
    With probability p.
    rng.random(runs) < p""")
def half_half(p, d, s, rng, runs):
    truth = np.where(rng.random(runs) < 0.5, 0, d) + s * rng.standard_normal(runs)
    return np.array(((truth - (1 - p) * d) ** 2, truth**2))


@halfway_x.wrong("""lets every truth stand exactly in a centre
    Does the robot stand in the centre of its heap?
    Each heap has a width.
    Add s * rng.standard_normal(runs).""")
def points_only(p, d, s, rng, runs):
    return halfway_x(p, d, 0.0, rng, runs)


@halfway_x.wrong("""reports the middle, not the mean
    Does the mean lie halfway if one heap is heavier?
    It lies nearer to the heavier one.
    (1 - p) * d""")
def middle(p, d, s, rng, runs):
    truth = np.where(rng.random(runs) < p, 0, d) + s * rng.standard_normal(runs)
    return np.array(((truth - d / 2) ** 2, truth**2))


halfway_x.refuses("the expected values, without an experiment")(
    lambda p, d, s, rng, runs: np.tile(
        [[s**2 + p * (1 - p) * d**2], [s**2 + (1 - p) * d**2]], (1, runs)
    )
)
halfway_x.refuses("one truth for all runs")(
    lambda p, d, s, rng, runs: np.tile(halfway_x(p, d, s, rng, 1), (1, runs))
)
halfway_x.refuses("random in range")(lambda p, d, s, rng, runs: rng.uniform(0, d**2, (2, runs)))
halfway_x.refuses("the two reports exchanged")(
    lambda p, d, s, rng, runs: halfway_x(p, d, s, rng, runs)[::-1]
)
halfway_x.refuses("a heap half as wide")(
    lambda p, d, s, rng, runs: halfway_x(p, d, s / 3, rng, runs)
)


def _lengths(rng):
    return [
        (int(rng.integers(20, 60)), 4.0),
        (int(rng.integers(100, 300)), 4.0),
        (int(rng.integers(20, 60)), round(rng.uniform(0.4, 0.9), 2)),
        (int(rng.integers(20, 60)), round(rng.uniform(1.2, 1.8), 2)),
    ]


@experiment(
    """Resultant lengths by chance
    M headings for each run: sigma * rng.standard_normal((runs, M)).
    The mean vector has two components, means over axis 1.
    np.hypot(np.cos(theta).mean(axis=1), np.sin(theta).mean(axis=1))""",
    points=2,
    after=cancel,
    runs=300,
    pool=3_000,
    settings=_lengths,
    together=True,
    claim="without a common direction R is about .9 / sqrt(M) by chance, else exp(-sigma^2 / 2)",
    test="four settings of M and sigma: the mean of R within 5 standard errors of a right "
    "experiment's, and as much scatter",
    margin="equal means within 5 standard errors in five comparisons: 3e-6",
)
def length_x(M, sigma, rng, runs):
    theta = sigma * rng.standard_normal((runs, M))
    return np.hypot(np.cos(theta).mean(axis=1), np.sin(theta).mean(axis=1))


length_x.holds("R on average as in a right experiment", same_mean(5.0))
length_x.holds("and from run to run", same_scatter())


@length_x.wrong("""keeps the cosine alone
    A vector has two components. Where is the sine?
    With a common direction of 0 the sine is small, without one it is not.
    np.hypot of both means""")
def cosine_only(M, sigma, rng, runs):
    return np.abs(np.cos(sigma * rng.standard_normal((runs, M))).mean(axis=1))


@length_x.wrong("""returns R squared
    Which power has a length?
    np.hypot takes the root.
    Take the root of your number.""")
def squared(M, sigma, rng, runs):
    return length_x(M, sigma, rng, runs) ** 2


@length_x.wrong("""adds the arrows up without dividing by M
    Can the mean of unit arrows be longer than 1?
    Mean, not sum.
    .mean(axis=1)""")
def summed(M, sigma, rng, runs):
    return M * length_x(M, sigma, rng, runs)


@length_x.wrong("""draws headings that know no sigma
    What does sigma do in your experiment?
    Small sigma, headings that agree.
    sigma * rng.standard_normal((runs, M))""")
def uniform(M, sigma, rng, runs):
    return length_x(M, 9.0, rng, runs)


length_x.refuses("the formula")(lambda M, sigma, rng, runs: np.full(runs, np.exp(-(sigma**2) / 2)))
length_x.refuses("a hundred headings, whatever M is")(
    lambda M, sigma, rng, runs: length_x(100, sigma, rng, runs)
)
length_x.refuses("one cloud for all runs")(
    lambda M, sigma, rng, runs: np.full(runs, length_x(M, sigma, rng, 1)[0])
)
length_x.refuses("random in range")(lambda M, sigma, rng, runs: rng.random(runs))
length_x.refuses("sigma taken for a variance")(
    lambda M, sigma, rng, runs: length_x(M, np.sqrt(sigma), rng, runs)
)

JUDGE = Question("Judgement")

which = Choice("""A gripper closes on the reported place. Within 2 cm it holds the part, beyond
          that it misses, by however much. What do you report?
    a  the mean of the cloud
       = It loses least when far misses cost more, and here they do not.
    b  the median of the cloud
       = It loses least when a miss costs in proportion to its size.
    c* the place where a density with a bandwidth of about 2 cm is largest
       = Yes: all that counts is how much mass lies within reach.
    d  the mean of the heaviest cluster
       = Near, but a heavy heap that is wide may hold little within 2 cm of its middle.""")

stale = Choice("""A filter resamples, and then reports the particle of largest weight. What is that
          particle?
    a  the best guess at the most probable pose
       = Before resampling it might be, but those weights are gone.
    b  the particle with most copies
       = Copies are separate particles with equal weights; nobody counts them.
    c* any particle: all weights are equal now
       = Yes: ask before resampling, or ask the density of the cloud.
    d  the particle nearest to the mean
       = Nothing in a weight knows about the mean.""")

why = Text(
    """A colleague says that averaging is wrong as soon as a cloud has two heaps. Is it?
    says that the mean still has the smallest expected squared error
    says that it can lie where the robot cannot be, or far from every particle
    says that the loss, or the decision to be made, settles what to report""",
    model="The mean still has the smallest expected squared error, two heaps or not. "
    "But it may lie in a wall, far from every particle, and if only a near hit helps it is nearly "
    "always a miss. What to report follows from what an error costs.",
)

LAB = Lab.of(__name__, "Estimates")
__getattr__ = LAB.verb
