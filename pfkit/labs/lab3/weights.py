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

p1b = Numeric(
    """Probability that room A is empty, for 1, 4 and 10 particles over 4 rooms
    What is the probability that one particle misses room A?
    All must miss it, and they are drawn independently.
    (3/4) to the power of the number of particles.""",
    (0.75, 0.75**4, 0.75**10),
    tol=0.002,
    names=("1 particle", "4 particles", "10 particles"),
)
p1b.wrong("""complement: is the probability that somebody is in the room
    Should an empty room become more or less likely with more particles?
    You computed the opposite event.
    Take one minus your values.""")((0.25, 1 - 0.75**4, 1 - 0.75**10))
p1b.wrong("""power-of-quarter: is the probability that all particles are in room A
    Which event has probability 1/4 for one particle?
    Empty means that each particle is in one of the other three rooms.
    The base of the power is 3/4.""")((0.25, 0.25**4, 0.25**10))
p1b.wrong("""linear: takes a quarter away for each particle
    With 4 particles, is it certain that room A has one? Throw a die 6 times.
    Probabilities of independent misses multiply; they do not subtract.
    (3/4) to the power of the number of particles.""")((0.75, 0.0, 0.0))

P2 = Question("Target, proposal, weights")


def _toy(seed):
    rng = rng_of(seed)
    values, target, proposal = rng.normal(size=30), rng.random(30) + 0.1, rng.random(30) + 0.1
    return values, target, proposal


def _estimates_normal_mean(f):
    """Samples of N(0, 2^2), target N(1, 1): the estimate lies within 4 standard errors of 1."""
    errors = []
    for seed in range(40):
        x = 2 * rng_of(seed).standard_normal(400)
        errors.append(f(x, np.exp(-0.5 * (x - 1) ** 2), np.exp(-0.5 * (x / 2) ** 2)) - 1)
    se = np.std(errors, ddof=1) / math.sqrt(len(errors))
    return True if abs(np.mean(errors)) < 4 * se else f"off by {np.mean(errors):.2f}"


p2a = Numeric(
    """Weights for target (.5, .3, .2) and proposal (.2, .3, .5)
    Which place does the proposal visit too seldom? It must weigh more.
    A weight says how many times more the target wants a place.
    w = target / proposal, place by place.""",
    (2.5, 1.0, 0.4),
    tol=0.005,
)
p2a.wrong("""inverse: is proposal over target: upside down
    The first place is drawn too seldom. Should its samples count for less?
    Weight times proposal must give the target back.
    w = target / proposal.""")((0.4, 1.0, 2.5))
p2a.wrong("""product: is target times proposal
    If target and proposal agree, all weights must be equal.
    Weight times proposal must give the target back.
    w = target / proposal.""")((0.10, 0.09, 0.10))
p2a.wrong("""normalised: is right up to a factor: you divided by the sum, which is not asked
         here
    Ratios of your values are right. Compare their sum with 2.5 + 1 + .4.
    The question asks for the weights before they are normalised.
    w = target / proposal, nothing more.""")((2.5 / 3.9, 1 / 3.9, 0.4 / 3.9))
p2a.wrong("""difference: is target minus proposal
    A weight is never negative.
    Weights multiply the density of the samples.
    w = target / proposal.""")((0.3, 0.0, -0.3))


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
    """Self-normalised importance sampling estimate of the mean under the target."""
    w = target / proposal
    return np.sum(w * values) / np.sum(w)


estimate.holds(
    "equal densities give the plain mean",
    lambda f: np.isclose(f(np.array([1.0, 2, 6]), np.ones(3), np.ones(3)), 3),
)
estimate.holds(
    "a factor on the target changes nothing",
    lambda f: np.isclose(f(*_toy(1)), f(_toy(1)[0], 7 * _toy(1)[1], _toy(1)[2])),
)
estimate.holds(
    "three samples by hand: (1, 2, 6), target (.5, .3, .2), proposal (.2, .3, .5)",
    lambda f: np.isclose(
        f(np.array([1.0, 2, 6]), np.array([0.5, 0.3, 0.2]), np.array([0.2, 0.3, 0.5])), 6.9 / 3.9
    ),
)
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

p2c = Choice("""Why the weight is just p(z | x)
    a  Because target and proposal are both normalised
       = Normalised or not, their ratio need not be the likelihood.
    b* Because the proposal is the motion prediction and earlier weights were reset
       = Yes: bel / bel_bar = eta p(z | x); another proposal needs another weight.
    c  Because p(z | x) equals the belief bel(x)
       = The likelihood scores one measurement; the belief holds all of them.
    d  Because measurements are independent of the pose
       = If they were, measuring were useless; they are independent given the pose.""")
