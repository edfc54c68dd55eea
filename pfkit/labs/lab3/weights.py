"""P1 and P2: what particles are, and what they weigh."""

from __future__ import annotations

import math

import numpy as np

from pfkit.labs import Choice, Numeric, Question, code
from pfkit.labs.statistics import rng_of

P1 = Question("What are the particles?")

p1a = Choice("""What a particle set is
    a  The last M measurements
       = Measurements give particles their weights; they are not particles.
    b  The M cells of a grid over the room
       = Cells stay where they are; particles move, and crowd where belief is high.
    c* Weighted samples that together stand for the belief bel(x_t)
       = Yes: where particles are dense or heavy, the belief is high.
    d  M robots, of which one is real
       = None of them need be right: together they say how probable each place is.""")


def _some_empty(rooms, n):
    """Probability that n particles leave at least one room empty: inclusion and exclusion."""
    ways = (-1) ** np.arange(rooms) * [math.comb(rooms, k + 1) for k in range(rooms)]
    return float(sum(ways * (1 - np.arange(1, rooms + 1) / rooms) ** n))


def _three(law):
    """A law of rooms and particles, for each of the three numbers of particles."""
    return lambda rooms, few, many: tuple(law(rooms, n) for n in (1, few, many))


p1b = Numeric(
    """Probability that room A is empty, for 1, {few} and {many} particles over {rooms} rooms
    What is the probability that one particle misses room A?
    All must miss it, and they are drawn independently.
    (1 - 1/{rooms}) to the power of the number of particles.""",
    _three(lambda rooms, n: (1 - 1 / rooms) ** n),
    tol=0.002,
    names=("1 particle", "{few} particles", "{many} particles"),
    world={"rooms": 4, "few": 4, "many": 10},
    draw=lambda rng: {
        "rooms": int(rng.integers(3, 7)),
        "few": int(rng.integers(3, 7)),
        "many": int(rng.integers(8, 13)),
    },
)
p1b.wrong("""complement: is the probability that somebody is in the room
    Should an empty room become more or less likely with more particles?
    You computed the opposite event.
    Take one minus your values.""")(_three(lambda rooms, n: 1 - (1 - 1 / rooms) ** n))
p1b.wrong("""power-of-quarter: is the probability that all particles are in room A
    Which event has probability 1/{rooms} for one particle?
    Empty means that each particle is in one of the other rooms.
    The base of the power is 1 - 1/{rooms}.""")(_three(lambda rooms, n: (1 / rooms) ** n))
p1b.wrong("""linear: takes 1/{rooms} away for each particle
    With {few} particles, is it certain that room A has one? Throw a die 6 times.
    Probabilities of independent misses multiply; they do not subtract.
    (1 - 1/{rooms}) to the power of the number of particles.""")(
    _three(lambda rooms, n: max(0.0, 1 - n / rooms))
)
p1b.wrong("""any-room: is the probability that some room is empty, no matter which
    With one particle, is room A empty for certain?
    Room A was named before the particles fell.
    (1 - 1/{rooms}) to the power of the number of particles.""")(_three(_some_empty))

P2 = Question("Target, proposal, weights")


def _toy(seed, decades=1.0):
    """Values, target and proposal; the densities range over some powers of ten."""
    rng = rng_of(seed)
    values = rng.normal(size=30)
    target, proposal = 10 ** (decades * rng.uniform(-1, 0, (2, 30)))
    return values, target, proposal


def _as_reference(f):
    """Right on random sets of few and of very unequal weights."""
    for k, decades in enumerate((1.0, 1.0, 6.0, 6.0)):
        found, wanted = f(*_toy(10 + k, decades)), estimate(*_toy(10 + k, decades))
        if not np.isclose(found, wanted, rtol=1e-9):
            return f"set {k + 1}: you gave {found:.6g}, expected {wanted:.6g}"
    return True


def _scaled(f, target, proposal):
    values, p, q = _toy(1)
    return bool(np.isclose(f(values, target * p, proposal * q), f(values, p, q), rtol=1e-9))


def _estimates_normal_mean(f):
    """Samples of N(0, 2^2), target N(1, 1): the estimate lies within 4 standard errors of 1."""
    errors = []
    for seed in range(40):
        x = 2 * rng_of(seed).standard_normal(400)
        errors.append(f(x, np.exp(-0.5 * (x - 1) ** 2), np.exp(-0.5 * (x / 2) ** 2)) - 1)
    se = np.std(errors, ddof=1) / math.sqrt(len(errors))
    return True if abs(np.mean(errors)) < 4 * se else f"off by {np.mean(errors):.2f}"


def _written(shares):
    """``(.5, .3, .2)``, as the question prints it."""
    return f"({', '.join(f'{x:.2g}'.lstrip('0') for x in shares)})"


def _places(f, g):
    return {"f": f, "g": g, "target": _written(f), "proposal": _written(g)}


def _each(law):
    """A law of target and proposal, place by place."""
    return lambda f, g, **_: tuple(law(a, b) for a, b in zip(f, g, strict=True))


def _shares(law):
    """The same, as shares of the sum."""
    return lambda f, g, **_: tuple(np.divide(_each(law)(f, g), sum(_each(law)(f, g))).tolist())


WORLDS = (  # the proposal visits the first place too seldom
    ((0.5, 0.3, 0.2), (0.2, 0.3, 0.5)),
    ((0.6, 0.3, 0.1), (0.2, 0.3, 0.5)),
    ((0.6, 0.2, 0.2), (0.4, 0.1, 0.5)),
    ((0.4, 0.5, 0.1), (0.1, 0.4, 0.5)),
    ((0.7, 0.2, 0.1), (0.2, 0.5, 0.3)),
    ((0.6, 0.1, 0.3), (0.4, 0.4, 0.2)),
    ((0.8, 0.1, 0.1), (0.5, 0.2, 0.3)),
    ((0.4, 0.2, 0.4), (0.1, 0.4, 0.5)),
)


p2a = Numeric(
    """Weights for target {target} and proposal {proposal}
    Which place does the proposal visit too seldom? It must weigh more.
    A weight says how many times more the target wants a place.
    w = target / proposal, place by place.""",
    _each(lambda a, b: a / b),
    tol=0.005,
    world=_places(*WORLDS[0]),
    draw=lambda rng: _places(*WORLDS[rng.integers(len(WORLDS))]),
)
p2a.wrong("""inverse: is proposal over target: upside down
    The first place is drawn too seldom. Should its samples count for less?
    Weight times proposal must give the target back.
    w = target / proposal.""")(_each(lambda a, b: b / a))
p2a.wrong("""product: is target times proposal
    If target and proposal agree, all weights must be equal.
    Weight times proposal must give the target back.
    w = target / proposal.""")(_each(lambda a, b: a * b))
p2a.wrong("""normalised: is right up to a factor: you divided by the sum, which is not asked
         here
    Ratios of your values are right. What do they sum to?
    The question asks for the weights before they are normalised.
    w = target / proposal, nothing more.""")(_shares(lambda a, b: a / b))
p2a.wrong("""target-itself: is the target, as if all places were drawn equally often
    How often does the proposal visit the first place?
    A sample from a place that is drawn often must count for less.
    w = target / proposal.""")(_each(lambda a, b: a))
p2a.wrong("""difference: is target minus proposal
    A weight is never negative.
    Weights multiply the density of the samples.
    w = target / proposal.""")(_each(lambda a, b: a - b))


@code(
    """Estimate a mean under the target from samples of the proposal
    Give each sample a weight first.
    The estimate is a weighted mean.
    sum(w * values) / sum(w) with w = target / proposal.""",
    id="p2b",
    points=2,
    fingerprint=lambda f: [f(*_toy(s)) for s in range(4)],
)
def estimate(values, target, proposal):
    """Mean under the target; three arrays of one length."""
    w = target / proposal
    return np.sum(w * values) / np.sum(w)


estimate.holds(
    "equal densities give the plain mean",
    lambda f: np.isclose(f(np.array([1.0, 2, 6]), np.ones(3), np.ones(3)), 3),
)
estimate.holds(
    "a factor on the target or on the proposal changes nothing",
    lambda f: all(_scaled(f, *c) for c in ((7, 1), (1, 7), (1e-150, 1), (1, 1e-150))),
)
estimate.holds(
    "three samples by hand: (1, 2, 6), target (.5, .3, .2), proposal (.2, .3, .5)",
    lambda f: np.isclose(
        f(np.array([1.0, 2, 6]), np.array([0.5, 0.3, 0.2]), np.array([0.2, 0.3, 0.5])), 6.9 / 3.9
    ),
)
estimate.holds("right on random sets, also where one weight is a million others", _as_reference)
estimate.holds("within 4 standard errors over 40 repetitions", _estimates_normal_mean)
estimate.wrong("""mean-weight: averages the weights and forgets the values
    Shift all values by 10. What should happen to the estimate?
    A weight says how much a value counts; the value must appear, too.
    Return sum(w * values) / sum(w).""")(
    lambda values, target, proposal: np.mean(target / proposal)
)


@estimate.wrong("""divides the proposal by the target: the weights are upside down
    A value that the proposal draws too seldom must count more, not less.
    Check one sample: target .5, proposal .2. Should it weigh 2.5 or .4?
    The weight is target / proposal.""")
def inverse_ratio(values, target, proposal):
    w = proposal / target
    return np.sum(w * values) / np.sum(w)


estimate.wrong("""target-only: weighs by the target alone
    The samples are already dense where the proposal is high. Is that counted twice?
    The weight corrects for how the samples were drawn, so the proposal appears in it.
    The weight is target / proposal.""")(
    lambda values, target, proposal: np.sum(target * values) / np.sum(target)
)
estimate.wrong("""plain-mean: is the plain mean of the samples
    The samples come from the proposal, so their plain mean is the mean of the proposal.
    Weigh each sample by how much more the target wants it than the proposal gives it.
    Return sum(w * values) / sum(w) with w = target / proposal.""")(
    lambda values, target, proposal: np.mean(values)
)
estimate.wrong("""not-normalised: does not divide by the sum of the weights
    Multiply the target by 7. The estimate should not change.
    In a filter we know the target only up to a constant.
    Divide by sum(w), not by the number of samples.""")(
    lambda values, target, proposal: np.mean(target / proposal * values)
)

estimate.refuses("the weighted median")(
    lambda values, target, proposal: np.sort(values)[
        np.searchsorted(
            np.cumsum((target / proposal)[np.argsort(values)]), np.sum(target / proposal) / 2
        )
    ]
)
estimate.refuses("the value with the largest weight")(
    lambda values, target, proposal: values[np.argmax(target / proposal)]
)


@estimate.refuses("squared weights")
def squared_weights(values, target, proposal):
    return np.average(values, weights=(target / proposal) ** 2)


@estimate.refuses("cuts large weights off at 10")
def clipped(values, target, proposal):
    return np.average(values, weights=np.minimum(target / proposal, 10))


@estimate.refuses("a small number against 0/0")
def small_number(values, target, proposal):
    w = target / (proposal + 1e-12)
    return np.sum(w * values) / (np.sum(w) + 1e-12)


@estimate.refuses("resamples by chance and takes the plain mean")
def resampled(values, target, proposal):
    w = target / proposal
    return np.random.choice(values, 10_000, p=w / w.sum()).mean()  # noqa: NPY002


@estimate.refuses("normalises by the plain sum of the target")
def target_sum(values, target, proposal):
    return np.sum(target / proposal * values) / np.sum(target)


p2c = Choice("""Why the weight is just p(z | x)
    a  Because target and proposal are both normalised
       = Normalised or not, their ratio need not be the likelihood.
    b* Because the proposal is the motion prediction and earlier weights were reset
       = Yes: bel / bel_bar = eta p(z | x); another proposal needs another weight.
    c  Because p(z | x) equals the belief bel(x)
       = The likelihood scores one measurement; the belief holds all of them.
    d  Because measurements are independent of the pose
       = If they were, measuring were useless; they are independent given the pose.""")
