"""Exact answers we can afford: integrals on cells, Kalman's filter, and nats between beliefs."""

import math

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment
from pfkit.labs.response import same_mean, same_scatter

PREDICT = Question("Predictions")

between = Prediction("""After five looks, how often is the filter with one Gaussian right?
    a  as often as the exact one, for mean and variance are the right ones
    b  nine times where the exact one is right ten times
    c* about half as often as the exact one
    d  almost never""")

toowide = Prediction("""Cells three times as wide lose
    a  nothing, as long as the cells sum to one
    b  about as much
    c  about three times as much
    d* about nine times as much""")

HAND = Question("By hand")


def _product(m, s, z, r):
    """Mean and variance of N(m, s^2) times N(z, r^2)."""
    gain = s**2 / (s**2 + r**2)
    return (m + gain * (z - m), s**2 * (1 - gain))


def _another_product(rng):
    m, s, r = int(rng.integers(2, 7)), int(rng.integers(2, 5)), int(rng.integers(1, 3))
    return {"m": m, "s": s, "z": m + int(rng.integers(3, 8)), "r": r}


product = Numeric(
    """A belief with mean {m} m and deviation {s} m, a beacon that says {z} m with deviation {r} m:
         mean and variance of their product
    Precisions add: one over a variance is a precision.
    The new mean lies between {m} and {z}, nearer to the one with the larger precision.
    Gain {s}² / ({s}² + {r}²); mean {m} + gain ({z} - {m}); variance {s}² (1 - gain).""",
    _product,
    tol=0.02,
    names=("mean", "variance"),
    world={"m": 4, "s": 3, "z": 9, "r": 1},
    draw=_another_product,
)
product.wrong("""average: takes the middle of the two means
    Which of the two knows more?
    Weigh each mean by its precision.
    (mean / variance of one + mean / variance of the other) times the new variance.""")(
    lambda m, s, z, r: ((m + z) / 2, _product(m, s, z, r)[1])
)
product.wrong("""swapped: lies nearer to the one that knows less
    Whose deviation is larger, that of the belief or of the beacon?
    The gain is the share of the belief's variance, because that is the share of its error.
    {s}² / ({s}² + {r}²)""")(
    lambda m, s, z, r: (m + r**2 / (s**2 + r**2) * (z - m), _product(m, s, z, r)[1])
)
product.wrong("""adds: adds the variances
    Does the robot know less after a reading?
    Variances add when errors add, in a move. In a product precisions add.
    1 / (1 / {s}² + 1 / {r}²)""")(lambda m, s, z, r: (_product(m, s, z, r)[0], s**2 + r**2))
product.wrong("""deviation: gives the standard deviation for the variance
    Which of the two was asked for?
    Square it.
    {s}² (1 - gain)""")(
    lambda m, s, z, r: (_product(m, s, z, r)[0], math.sqrt(_product(m, s, z, r)[1]))
)
product.wrong("""not-squared: weighs by deviations instead of variances
    What is a precision?
    One over the square of the deviation.
    {s}² / ({s}² + {r}²)""")(lambda m, s, z, r: (m + s / (s + r) * (z - m), s * r / (s + r)))

IDEA = Question("The idea")

surprise = Choice("""After which reading is the Kalman filter less sure?
    a  after 40 m, because it contradicts the belief
       = The variance is that of the prior times one minus the gain, and no reading stands in it.
    b  after 7 m, because it moves the mean less
       = The mean moves with the reading; the variance does not know it.
    c* after neither
       = Yes: it says how sure it is before it reads, and a filter that is wrong does not notice.
    d  after 40 m, because the evidence is small
       = The evidence is small and the model in doubt, but the variance does not ask it.""")

gain = Numeric(
    """Position and speed after a beacon: new position, new speed, new variance of the speed
    The innovation is 3 m, and its variance 4 + 1.
    The gain is (4, 2) / 5: the covariances with the position, divided by that variance.
    10 + 0.8 * 3; 1 + 0.4 * 3; 2 - 0.4 * 5 * 0.4.""",
    (12.4, 2.2, 1.2),
    tol=0.02,
    names=("position", "speed", "variance of the speed"),
)
gain.wrong("""speed-untouched: leaves the speed as it was
    Position and speed err together. What does a robot that is further on than expected tell?
    Their covariance is 2, so the gain of the speed is 2 / 5.
    1 + 0.4 * 3, and 2 - 0.4 * 5 * 0.4""")((12.4, 1, 2))
gain.wrong("""no-sensor-noise: forgets the variance of the beacon
    Is the position after the reading known without error?
    The innovation errs by the belief and by the beacon: 4 + 1.
    The gain is (4, 2) / 5.""")((13, 2.5, 1))
gain.wrong("""backwards: moves the wrong way
    The beacon sees the robot further on than expected. Which sign has the innovation?
    Measured minus expected, 13 - 10.
    10 + 0.8 * 3 and 1 + 0.4 * 3""")((7.6, -0.2, 1.2))
gain.wrong("""variance-grows: adds what the reading should take away
    Can a reading make the speed less known?
    The new covariance is the old one minus K S K^T.
    2 - 0.4 * 5 * 0.4""")((12.4, 2.2, 2.8))
gain.wrong("""one-gain: uses the gain of the position for the speed, too
    How much does the speed err with the position, and how much the position with itself?
    The gain has one number for each: (4, 2) / 5.
    1 + 0.4 * 3""")((12.4, 3.4, -1.2))

CODE = Question("Code by hand")

CASES = [(4.0, 4.0, 1.0, 0.5, 7.0, 1.0), (0.0, 1.0, 2.0, 0.25, 1.0, 4.0), (9, 0.3, -1, 2, 8, 0.1)]


def _agrees(part):
    """Does one of the three results agree with the reference's on every case?"""

    def holds(f):
        for case in CASES:
            found, right = f(*case)[part], kalman_1d(*case)[part]
            if not np.isclose(found, right, rtol=1e-7):
                return f"for {case} I got {found:.5g}"
        return True

    return holds


@code(
    """Kalman's filter in one dimension
    A move adds to the mean, and its variance to the variance.
    The gain is the moved variance over that variance plus the sensor's.
    S = var + var_u + var_z; K = (var + var_u) / S""",
    points=2,
    fingerprint=lambda f: np.ravel([f(*case) for case in CASES]),
)
def kalman_1d(mean, var, u, var_u, z, var_z):
    mean, var = mean + u, var + var_u
    S = var + var_z
    K, innovation = var / S, z - mean
    evidence = np.exp(-0.5 * innovation**2 / S) / np.sqrt(2 * np.pi * S)
    return mean + K * innovation, (1 - K) * var, evidence


kalman_1d.holds("the mean", _agrees(0))
kalman_1d.holds("the variance", _agrees(1))
kalman_1d.holds("the evidence", _agrees(2))


def _mended(change):
    """The reference with one part changed: ``change(mean, var, S, innovation, var_z)``."""

    def wrong(mean, var, u, var_u, z, var_z):
        mean, var = mean + u, var + var_u
        return change(mean, var, var + var_z, z - mean, var_z)

    return wrong


def _normal(error, var):
    return np.exp(-0.5 * error**2 / var) / np.sqrt(2 * np.pi * var)


kalman_1d.wrong("""no-motion-noise: forgets that a move makes less sure
    A robot that only moves: what happens to its variance?
    Add var_u before the reading.
    var + var_u""")(lambda mean, var, u, var_u, z, var_z: kalman_1d(mean, var, u, 0, z, var_z))
kalman_1d.wrong("""not-moved: compares the reading with the place before the move
    Where does the filter expect the robot when the reading comes?
    Add u to the mean first.
    innovation = z - (mean + u)""")(
    lambda mean, var, u, var_u, z, var_z: (
        kalman_1d(mean, var, 0, var_u, z, var_z)[0] + u,
        *kalman_1d(mean, var, 0, var_u, z, var_z)[1:],
    )
)
kalman_1d.wrong("""swapped: trusts the sensor the more, the worse it is
    A beacon with a huge variance: how far should the mean move?
    The gain is the belief's share of the variance.
    K = var / (var + var_z)""")(
    _mended(lambda m, v, S, e, r: (m + r / S * e, (1 - r / S) * v, _normal(e, S)))
)
kalman_1d.wrong("""deviation: takes variances for standard deviations
    What is squared already?
    var, var_u and var_z are variances.
    S = var + var_u + var_z""")(
    lambda mean, var, u, var_u, z, var_z: (
        *kalman_1d(mean, var**2, u, var_u**2, z, var_z**2)[:1],
        kalman_1d(mean, var**2, u, var_u**2, z, var_z**2)[1] ** 0.5,
        kalman_1d(mean, var**2, u, var_u**2, z, var_z**2)[2],
    )
)
kalman_1d.wrong("""sensor-only: gives the evidence as if the place were known
    How far from its expectation may the reading be?
    It errs by the sensor and by the belief.
    The evidence is normal with variance S.""")(
    _mended(lambda m, v, S, e, r: (m + v / S * e, v * r / S, _normal(e, r)))
)
kalman_1d.wrong("""variance-kept: leaves the variance as the move left it
    Does a reading teach nothing?
    The new variance is smaller by the factor 1 - K.
    (1 - K) * var""")(_mended(lambda m, v, S, e, r: (m + v / S * e, v, _normal(e, S))))
kalman_1d.refuses("the middle of prediction and reading")(
    _mended(lambda m, v, S, e, r: (m + e / 2, v * r / S, _normal(e, S)))
)
kalman_1d.refuses("the logarithm of the evidence")(
    _mended(lambda m, v, S, e, r: (m + v / S * e, v * r / S, np.log(_normal(e, S))))
)
kalman_1d.refuses("the smaller of the two variances")(
    _mended(lambda m, v, S, e, r: (m + v / S * e, min(v, r), _normal(e, S)))
)
kalman_1d.refuses("reads first and moves afterwards")(
    lambda mean, var, u, var_u, z, var_z: (
        kalman_1d(mean, var, 0, 0, z, var_z)[0] + u,
        kalman_1d(mean, var, 0, 0, z, var_z)[1] + var_u,
        kalman_1d(mean, var, 0, 0, z, var_z)[2],
    )
)
kalman_1d.refuses("an evidence without its constant")(
    _mended(lambda m, v, S, e, r: (m + v / S * e, v * r / S, np.exp(-0.5 * e**2 / S)))
)

P, Q = np.array([0.5, 0.3, 0.2, 0.0]), np.array([0.1, 0.2, 0.3, 0.4])
HOLE = np.array([0.6, 0.4, 0.0, 0.0])


@code(
    """Divergence of two lists of cells
    Each cell counts with its share of p: p log(p / q).
    A cell where p is zero adds nothing; one where only q is zero makes it infinite.
    held = p > 0; np.sum(p[held] * np.log(p[held] / q[held]))""",
    fingerprint=lambda f: [f(P, Q), f(Q, np.full(4, 0.25)), f(HOLE, P)],
)
def kl(p, q):
    held = p > 0
    with np.errstate(divide="ignore"):
        return np.sum(p[held] * np.log(p[held] / q[held]))


kl.holds(
    "it is the mean of log p - log q under p",
    lambda f: bool(np.isclose(f(Q, P + 0.1), kl(Q, P + 0.1))),
)
kl.holds("cells where p is zero add nothing", lambda f: bool(np.isclose(f(HOLE, Q), kl(HOLE, Q))))
kl.holds("of a belief and itself it is zero", lambda f: bool(abs(f(P, P)) < 1e-12))
kl.holds("it is infinite where q denies what p allows", lambda f: f(P, HOLE) == np.inf)


def _safe(p, q, log=np.log):
    """``p log(p / q)`` cell by cell, infinite where only q is zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(p > 0, p * log(np.where(p > 0, p, 1) / q), 0.0)


kl.wrong("""bits: counts in bits
    Which logarithm makes nats?
    The natural one.
    np.log, not np.log2""")(lambda p, q: _safe(p, q, np.log2).sum())
kl.wrong("""other-direction: is KL(q || p), the other direction
    Under which of the two is the mean taken?
    Under the first, p.
    p * np.log(p / q)""")(lambda p, q: _safe(q, p).sum())
kl.wrong("""both-directions: adds both directions
    How many sums does the definition have?
    One: the mean of log p - log q under p.
    p * np.log(p / q)""")(lambda p, q: _safe(p, q).sum() + _safe(q, p).sum())
kl.wrong(
    """floor: adds a small number, so that it is never infinite
    A belief that excludes the robot's place: how bad is that?
    Infinitely: no later reading brings it back.
    Leave the small number out and sum over the cells with p > 0.""",
    when=lambda f: np.isfinite(f(P, HOLE)) and abs(f(Q, P + 0.1) - kl(Q, P + 0.1)) < 1e-3,
)(lambda p, q: np.sum(p * np.log((p + 1e-12) / (q + 1e-12))))
kl.wrong(
    """nan: is not a number where a cell of p is zero
    What is p log p for p close to zero?
    It tends to zero, so such cells are left out.
    held = p > 0""",
    when=lambda f: bool(np.isnan(f(HOLE, Q))),
)(lambda p, q: np.sum(p * (np.log(p) - np.log(q))))
kl.refuses("sums over the cells that both allow", named="floor")(
    lambda p, q: _safe(p, q)[(p > 0) & (q > 0)].sum()
)
kl.refuses("absolute differences of the logarithms")(lambda p, q: np.abs(_safe(p, q)).sum())
kl.refuses("half the sum of absolute differences")(lambda p, q: 0.5 * np.abs(p - q).sum())
kl.refuses("the mean over the cells")(lambda p, q: _safe(p, q).mean())
kl.refuses("the entropy of p")(lambda p, q: _safe(p, np.ones_like(p)).sum())

NATS = Question("Nats")

direction = Choice("""Which divergence should the planner's Gaussian q make small?
    a* KL(p || q), which is infinite as soon as q denies a place that p allows
       = Yes: its mean is taken where the robot may be, so q must cover all of that.
    b  KL(q || p), which is infinite as soon as q allows a place that p denies
       = That one punishes driving slowly for nothing, and forgives a lost bump for little.
    c  either, they are small together
       = Near zero they are; with two bumps and one Gaussian one is large whatever you do.
    d  neither, the distance of the means is enough
       = Two beliefs with one mean may share no place at all.""")


def _another_loss(rng):
    shares = [(0.2, 0.3, 0.5), (0.1, 0.3, 0.6), (0.1, 0.2, 0.7), (0.15, 0.25, 0.6)]
    return dict(zip("abc", map(float, rng.permutation(shares[rng.integers(4)])), strict=True))


lost = Numeric(
    """Divergence KL(q || p) of a cloud that kept the bumps of {a} and {b} and lost that of {c}
    On what is left, how much larger is q than p?
    By the same factor everywhere: one over {a} + {b}.
    The mean of a constant logarithm is that logarithm: log(1 / ({a} + {b})).""",
    lambda a, b, c: -math.log(a + b),
    tol=0.004,
    unit="nats",
    world={"a": 0.5, "b": 0.2, "c": 0.3},
    draw=_another_loss,
)
lost.wrong("""share: is the share that was lost, not its price in nats
    In which unit is a divergence?
    In that of a logarithm.
    log(1 / ({a} + {b}))""")(lambda a, b, c: c)
lost.wrong("""lost-only: is the logarithm of what was lost
    Under which belief is the mean taken?
    Under q, which holds nothing of the lost bump.
    The two that are left hold {a} + {b} of p.""")(lambda a, b, c: -math.log(c))
lost.wrong("""bits: is in bits
    Which logarithm makes nats?
    The natural one; a bit is 0.693 nats.
    math.log, not math.log2""")(lambda a, b, c: -math.log2(a + b))
lost.wrong("""counts: counts bumps as if they were equally heavy
    How heavy is what was lost?
    The two that are left hold {a} + {b}, not two thirds.
    log(1 / ({a} + {b}))""")(lambda a, b, c: math.log(1.5))

bent = Numeric(
    """y = x² for x with mean 2 and deviation 0.5: the tangent's mean, the mean of the two points,
         and the deviation that they find
    The tangent's mean is the square of the mean.
    The two points are one deviation to each side: 1.5 and 2.5.
    Their squares are 2.25 and 6.25. Mean, and half their distance.""",
    (4.0, 4.25, 2.0),
    tol=0.01,
    names=("tangent's mean", "mean of the points", "deviation of the points"),
)
bent.wrong("""straight: takes the square of the mean both times
    Where do the two points go?
    Square each, then average.
    (2.25 + 6.25) / 2""")((4, 4, 2))
bent.wrong("""variance: gives the variance of the two values, not their deviation
    Which was asked for?
    Two values at equal distance from their mean: that distance is the deviation.
    (6.25 - 2.25) / 2""")((4, 4.25, 4))
bent.wrong("""step: goes one variance to each side instead of one deviation
    How far from 2 are the points?
    One deviation, 0.5; 0.25 is its square.
    1.5 and 2.5""")((4, 4.0625, 1))

BREAK = Question("Experiments")

CELL = 0.1
X = np.arange(-5 + CELL / 2, 25, CELL)
MOVE = np.exp(pf.log_gaussian(X - X[:, None] - 1, math.sqrt(0.2)))
MOVE /= MOVE.sum(axis=1, keepdims=True)


def bell(mean, var):
    """Gaussians on the cells: (B,) means and variances -> (B, n)."""
    p = np.exp(-0.5 * (X - mean[:, None]) ** 2 / var[:, None])
    return p / p.sum(axis=1, keepdims=True)


def match(bel):
    """Mean and variance of beliefs (B, n)."""
    mean = bel @ X
    return mean, bel @ X**2 - mean**2


def move(bel):
    """One metre on, with the chapter's wheels."""
    return bel @ MOVE


def look(bel, doors, z, rates=(0.8, 0.1)):
    """Reports z (B,) of a door or none, seen by beliefs (B, n)."""
    p_door = np.where(doors, *rates)
    return pf.update_1d(bel, np.where(z[:, None], p_door, 1 - p_door))[0]


def robots(doors, steps, rng, runs, rates=(0.8, 0.1)):
    """Cells (steps, runs) of robots that start anywhere in (0, 10), and what they report."""
    at = rng.uniform(0, 10, runs) + np.zeros((steps, runs))
    at[1:] += np.cumsum(1 + math.sqrt(0.2) * rng.standard_normal((steps - 1, runs)), axis=0)
    cell = np.floor((at + 5) / CELL).astype(int)
    return cell, rng.random((steps, runs)) < np.where(doors[cell], *rates)


def even(runs):
    """The belief before the first look, for each robot."""
    return np.tile(((X > 0) & (X < 10)) * CELL / 10, (runs, 1))


def _corridors(rng):
    """Three corridors: doors, the detector's rates, and the number of looks: one, some, many."""
    cells = [rng.choice(10, size=n, replace=False) for n in (2, 4, 5)]
    looks = [1, int(rng.integers(5, 7)), int(rng.integers(9, 11))]
    rates = [(0.95, 0.02), (0.8, 0.1), (0.9, 0.05)]
    return [
        (np.isin(np.floor(X), c), pair, k) for c, pair, k in zip(cells, rates, looks, strict=True)
    ]


@experiment(
    """What one Gaussian loses
    Keep two beliefs of each robot: the exact one and one that becomes a Gaussian after each look.
    Both move and look in the same way; only the second goes through bell(*match(...)).
    own = np.arange(runs), cell[-1]; return np.log([exact[own], gauss[own]])""",
    points=2,
    after=between,
    runs=800,
    pool=8_000,
    together=True,
    settings=_corridors,
    claim="a filter that keeps mean and variance gives the robot's place less than the exact one",
    test="mean and scatter of both logarithms are those of a right experiment, in corridors of "
    "our choice",
    margin="5.5 standard errors of the difference in each of three corridors",
)
def gauss_x(doors, rates, steps, rng, runs):
    cell, z = robots(doors, steps, rng, runs, rates)
    exact = gauss = even(runs)
    for k in range(steps):
        if k:
            exact, gauss = move(exact), move(gauss)
        exact = look(exact, doors, z[k], rates)
        gauss = bell(*match(look(gauss, doors, z[k], rates)))
    own = np.arange(runs), cell[-1]
    return np.log([exact[own], gauss[own]])


gauss_x.holds("both follow doors and looks", same_mean(5.5))
gauss_x.holds("both scatter as robots do", same_scatter(3.0))
gauss_x.wrong("""exchanged: gives the Gaussian first and the exact belief second
    Which of your two rows is larger on average?
    The exact belief gives the robot's place more.
    np.log([exact[own], gauss[own]])""")(lambda *knobs: gauss_x(*knobs)[::-1])
gauss_x.wrong("""bits: is in bits
    Which logarithm makes nats?
    The natural one.
    np.log, not np.log2""")(lambda *knobs: gauss_x(*knobs) / math.log(2))
gauss_x.wrong("""density: divides by the width of a cell
    A belief on cells sums to one. What was asked for, a probability or a density?
    The probability of the robot's cell.
    np.log([exact[own], gauss[own]])""")(lambda *knobs: gauss_x(*knobs) - math.log(CELL))
gauss_x.wrong("""difference: is the loss twice, not the two logarithms
    How many numbers belong to each robot?
    Two: what the exact belief gives to its cell, and what the Gaussian gives.
    np.log([exact[own], gauss[own]])""")(
    lambda *knobs: np.tile(-np.diff(gauss_x(*knobs), axis=0), (2, 1))
)


def _slipped(place=None, still=False, blind=False):
    """The experiment with one slip."""

    def run(doors, rates, steps, rng, runs):
        cell, z = robots(doors, steps, rng, runs, rates)
        exact = gauss = even(runs)
        for k in range(steps):
            if k and not still:
                exact, gauss = move(exact), move(gauss)
            if not blind:
                exact = look(exact, doors, z[k], rates)
                gauss = look(gauss, doors, z[k], rates)
            gauss = bell(*match(gauss))
        at = cell[-1] if place is None else place(exact, cell)
        return np.log([exact[np.arange(runs), at], gauss[np.arange(runs), at]])

    return run


gauss_x.wrong("""best-cell: takes the most probable cell, not the robot's
    Does the most probable cell know where the robot is?
    The robots stand in cell[-1] after the last look.
    own = np.arange(runs), cell[-1]""")(_slipped(place=lambda exact, cell: exact.argmax(axis=1)))
gauss_x.refuses("two constants")(
    lambda doors, rates, steps, rng, runs: np.full((runs, 2), (-4.2, -4.6)).T
)
gauss_x.refuses("one look, however many were asked for")(
    lambda doors, rates, steps, rng, runs: gauss_x(doors, rates, 1, rng, runs)
)
gauss_x.refuses("robots that do not move in the filter")(_slipped(still=True))
gauss_x.refuses("the text's detector instead of the one it was given")(
    lambda doors, rates, steps, rng, runs: gauss_x(doors, (0.8, 0.1), steps, rng, runs)
)
gauss_x.refuses("filters that do not look")(_slipped(blind=True))
gauss_x.refuses("where the robots were at the start")(_slipped(place=lambda exact, cell: cell[0]))
gauss_x.refuses("other doors than it was given")(
    lambda doors, rates, steps, rng, runs: gauss_x(
        np.isin(np.floor(X), (1, 2, 6)), rates, steps, rng, runs
    )
)
gauss_x.refuses("normal numbers")(
    lambda doors, rates, steps, rng, runs: rng.normal(-4.4, 0.7, (2, runs))
)
gauss_x.refuses("the exact belief twice")(lambda *knobs: gauss_x(*knobs)[[0, 0]])


def _widths(rng):
    """Width of the cells and deviation of the beacon: about as wide, twice, three times."""
    sigma = rng.uniform(0.1, 0.4, 3)
    return [
        (float(s * ratio), float(s))
        for s, ratio in zip(sigma, (rng.uniform(1, 1.4), rng.uniform(1.8, 2.3), 3), strict=True)
    ]


@experiment(
    """What wide cells lose
    Draw places x in (3, 7) and readings z about them.
    Cells over (0, 10): the likelihood at each centre, divided by its sum, then by h: a density.
    Return log N(z; x, sigma²) minus the logarithm of the density in the cell that holds x.""",
    points=2,
    after=toowide,
    runs=4_000,
    pool=40_000,
    together=True,
    settings=_widths,
    claim="cells wider than the sensor's noise lose nats, in the square of their width",
    test="mean and scatter of the loss are those of a right experiment, for widths of our choice",
    margin="4.5 standard errors of the difference at each of three widths",
)
def coarse_x(h, sigma, rng, runs):
    x = rng.uniform(3, 7, runs)
    z = x + sigma * rng.standard_normal(runs)
    centre = np.arange(h / 2, 10, h)
    like = np.exp(pf.log_gaussian(z[:, None] - centre, sigma))
    density = like / like.sum(axis=1, keepdims=True) / h
    own = density[np.arange(runs), (x / h).astype(int)]
    return pf.log_gaussian(z - x, sigma) - np.log(own)


coarse_x.holds("the loss follows width and noise", same_mean(4.5))
coarse_x.holds("it scatters as readings do", same_scatter(1.6))


def _slip(centred=False, at_z=False, noiseless=False, wide=1.0):
    """The experiment with one slip."""

    def run(h, sigma, rng, runs):
        x = rng.uniform(3, 7, runs)
        h = h * wide
        if centred:
            x = (np.floor(x / h) + 0.5) * h
        z = x if noiseless else x + sigma * rng.standard_normal(runs)
        like = np.exp(pf.log_gaussian(z[:, None] - np.arange(h / 2, 10, h), sigma))
        density = like / like.sum(axis=1, keepdims=True) / h
        own = density[np.arange(runs), ((z if at_z else x) / h).astype(int)]
        return pf.log_gaussian(z - x, sigma) - np.log(own)

    return run


coarse_x.wrong("""sign: has the sign the wrong way round
    Which of the two gives the robot's place more, on average?
    A loss is positive on average: exact minus cells.
    pf.log_gaussian(z - x, sigma) - np.log(own)""")(lambda *knobs: -coarse_x(*knobs))
coarse_x.wrong("""mass: compares a density with the probability of a cell
    Which unit has a density over a corridor?
    One per metre: divide the probability by h.
    density = p / h""")(lambda h, sigma, rng, runs: coarse_x(h, sigma, rng, runs) - math.log(h))
coarse_x.wrong("""reading: takes the cell that holds the reading, not the robot
    What is a good belief about?
    About the robot's place x.
    (x / h).astype(int)""")(_slip(at_z=True))
coarse_x.wrong("""centred: puts its robots at the middle of a cell
    Does a robot know about cells?
    Draw it anywhere: rng.uniform(3, 7, runs).
    Its cell is the one that holds it, (x / h).astype(int).""")(_slip(centred=True))
coarse_x.refuses("the square law of the text")(
    lambda h, sigma, rng, runs: np.full(runs, h**2 / (24 * sigma**2))
)
coarse_x.refuses("a constant")(lambda h, sigma, rng, runs: np.full(runs, 0.2))
coarse_x.refuses("readings without noise")(_slip(noiseless=True))
coarse_x.refuses("cells of half the width")(_slip(wide=0.5))
coarse_x.refuses("cells of twice the width")(_slip(wide=2.0))
coarse_x.refuses("random in range")(lambda h, sigma, rng, runs: rng.uniform(0, 0.6, runs))
coarse_x.refuses("bits")(lambda *knobs: coarse_x(*knobs) / math.log(2))

CHECK = Question("Check yourself")

table = Choice("""Which entry of the table would you change?
    a  Histogram filter: approximate, because its sums are exact
       = Its sums are, but in a continuous corridor the cells are an approximation.
    b  Extended Kalman filter: uni-modal, because it may hold several peaks
       = It holds one mean and one covariance: one peak.
    c* Particle filter: discrete, because the particles lie in a continuous space
       = Yes: no grid holds them; it is the belief that consists of points.
    d  Extended Kalman filter: approximate, because Kalman's filter is exact
       = Kalman's is, in a linear world; the extended one replaces bent functions by tangents.""")

when = Text(
    """Three robots: Gaussian, grid or neither?
    gives the first robot a Gaussian, because one bump is enough and costs almost nothing
    gives the second a grid, because several bumps must be kept and the cells are few
    counts the cells of the third (tens of millions or more) and gives it neither""",
    points=2,
    model="The first needs one bump only, so a Kalman filter or its extended form is right and "
    "costs a few products. The second has several bumps on a line, so a few hundred cells hold "
    "its exact belief. "
    "The third would need 800 times 400 times 72 cells, 23 million, and one Gaussian cannot say "
    "'in one of these places': it waits for particles.",
)


LAB = Lab.of(__name__, "Exact answers we can afford")
__getattr__ = LAB.verb
