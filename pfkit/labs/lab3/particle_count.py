"""P8: how many particles are enough."""

from __future__ import annotations

import math

import numpy as np

from pfkit.labs import Choice, Numeric, Question, experiment
from pfkit.labs.response import same_mean

P8 = Question("Pose uncertainty and number of particles")

ONE_SIDED = {".95": 1.645, ".99": 2.326}  # z below which a standard normal lies
TWO_SIDED = {".95": 1.960, ".99": 2.576}


def _kld(k: int, eps: float, z: float) -> float:
    """Number of particles that keeps the KL distance below eps (Fox 2003)."""
    a = 2 / (9 * (k - 1))
    return (k - 1) / (2 * eps) * (1 - a + math.sqrt(a) * z) ** 3


p8a = Numeric(
    """KLD bound for k = {k} bins, error {eps} nats, probability {p}
    Put k - 1 into the formula of the text, in both places.
    z is the point below which a standard normal lies with probability {p}: {z}.
    n = (k-1)/(2 eps) (1 - a + sqrt(a) z)^3 with a = 2/(9 (k-1)).""",
    lambda k, eps, p, z: float(round(_kld(k, float(eps), z))),
    tol=1.5,
    unit="particles",
    world={"k": 100, "eps": ".05", "p": ".99", "z": ONE_SIDED[".99"]},
    draw=lambda rng: {
        "k": int(rng.choice([60, 80, 120, 150])),
        "eps": str(rng.choice([".04", ".05", ".08"])),
        "p": (p := str(rng.choice([".95", ".99"]))),
        "z": ONE_SIDED[p],
    },
)

p8a.wrong("""two-sided: takes the two-sided quantile
    Which probability lies below your z?
    The bound is one-sided.
    z = {z} for {p}.""")(lambda k, eps, p, z: _kld(k, float(eps), TWO_SIDED[p]))
p8a.wrong("""k-not-k-minus-1: uses k = {k} where the formula has k - 1
    A table of k bins has k - 1 degrees of freedom.
    Replace k by k - 1 everywhere.
    Put {k} - 1 in both places.""")(lambda k, eps, p, z: _kld(k + 1, float(eps), z))
p8a.wrong("""missing-half: forgets the 2 in 2 eps
    Your number is twice too large.
    Look at the denominator of the first factor.
    The first factor is (k-1)/(2 eps).""")(lambda k, eps, p, z: 2 * _kld(k, float(eps), z))
p8a.wrong("""lower-quantile: takes the quantile with the wrong sign
    Should more certainty need more or fewer particles?
    z belongs to {p}, not to one minus that.
    z is +{z}.""")(lambda k, eps, p, z: _kld(k, float(eps), -z))
p8a.wrong("""no-cube: forgets the third power
    Compare your bracket with the one in the text.
    The first factor is right; the bracket is raised to a power.
    (1 - a + sqrt(a) z)^3.""")(
    lambda k, eps, p, z: ((k - 1) / (2 * float(eps))) ** (2 / 3) * _kld(k, float(eps), z) ** (1 / 3)
)
p8a.wrong("""first-factor: is the first factor alone
    What does your number say about the probability {p}?
    The bracket holds z, and so how sure you want to be.
    Multiply by (1 - a + sqrt(a) z)^3.""")(lambda k, eps, p, z: (k - 1) / (2 * float(eps)))


def _squares(rng):
    """Squares of different sides, circles, and particles; one circle that the square cuts."""
    small, large = float(rng.uniform(100, 140)), float(rng.uniform(240, 320))
    near, far = float(rng.uniform(14, 20)), float(rng.uniform(26, 34))
    few, some, many = (int(rng.integers(*ends)) for ends in ((4, 8), (12, 20), (40, 60)))
    return [
        (small, near, some),
        (large, far, some),
        (large, near, many),
        (small, far, few),
        (1.8 * far, far, 1),
    ]


@experiment(
    """Particles needed against the area of the prior
    One True or False per run: is a particle within the radius of the centre?
    Draw x and y uniformly over the square, shape (runs, M).
    (np.hypot(x, y) < radius).any(axis=-1) with x, y between -side/2 and side/2.""",
    id="p8b",
    points=2,
    claim="the share of successes depends on side, radius and particles as that of a right "
    "experiment",
    test="share within 4.5 standard errors of a right one at each of five settings",
    runs=1000,
    pool=24_000,
    settings=_squares,
    together=True,
    margin="4.5 standard errors in six comparisons: 4e-5",
)
def success(side, radius, M, rng, runs):
    """One True or False per run: is somebody within ``radius`` px of the centre?"""
    x, y = side * (rng.random((2, runs, M)) - 0.5)
    return (np.hypot(x, y) < radius).any(axis=-1)


success.holds("each run gives True or False", lambda x: bool(np.isin(x[..., 0], (0, 1)).all()))
success.holds("the share follows side, radius and number of particles", same_mean())


@success.wrong("""moves x and y together, so particles lie on a line
    Plot your particles: do they fill the square?
    x and y need draws of their own.
    rng.random((2, runs, M)): two numbers per particle.""")
def diagonal(side, radius, M, rng, runs):
    x = side * (rng.random((runs, M)) - 0.5)
    return (np.hypot(x, x) < radius).any(axis=-1)


success.wrong("""side-ignored: draws from a square of 240 px, whatever it is asked
    Which of your arguments does not occur in your function?
    Scale the draws by the side.
    x = side * (rng.random((runs, M)) - .5).""")(
    lambda side, radius, M, rng, runs: success(240.0, radius, M, rng, runs)
)
success.wrong("""radius-ignored: takes 30 px for near, whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses how near is near.
    (np.hypot(x, y) < radius).any(axis=-1).""")(
    lambda side, radius, M, rng, runs: success(side, 30.0, M, rng, runs)
)
success.wrong("""larger-square: draws from a square of twice the side, or with the centre in a
         corner
    You need four times as many particles. How far from the centre is an edge?
    A square of side s reaches s/2 to each side of its centre.
    x and y between -side/2 and side/2.""")(
    lambda side, radius, M, rng, runs: success(2 * side, radius, M, rng, runs)
)
success.wrong("""nobody: is True where nobody is near
    Your share falls with the number of particles. Should it?
    You answer the opposite question.
    Take .any of "near", not .all of "far".""")(
    lambda side, radius, M, rng, runs: ~success(side, radius, M, rng, runs)
)


@success.wrong("""asks whether all particles are near
    Your share falls with the number of particles. Should it?
    One particle near the centre is enough.
    Use .any(axis=-1) where you have .all(axis=-1).""")
def everybody(side, radius, M, rng, runs):
    x, y = side * (rng.random((2, runs, M)) - 0.5)
    return (np.hypot(x, y) < radius).all(axis=-1)


@success.wrong("""draws from a normal distribution, not evenly over the square
    Plot your particles: are the corners as full as the middle?
    Uniform over a square: every place in it is as likely as any other.
    x, y = side * (rng.random((2, runs, M)) - .5).""")
def normal(side, radius, M, rng, runs):
    x, y = side / 2 * rng.standard_normal((2, runs, M))
    return (np.hypot(x, y) < radius).any(axis=-1)


success.refuses("a coin that comes true nine times in ten")(
    lambda side, radius, M, rng, runs: rng.random(runs) < 0.9
)
success.refuses("the share of the circle in the square, as if the circle always fitted")(
    lambda side, radius, M, rng, runs: (
        rng.random(runs) < 1 - (1 - np.pi * (radius / side) ** 2) ** M
    )
)
success.refuses("always")(lambda side, radius, M, rng, runs: np.ones(runs, dtype=bool))
success.refuses("one run, repeated")(
    lambda side, radius, M, rng, runs: np.repeat(success(side, radius, M, rng, 1), runs)
)
success.refuses("half as many particles")(
    lambda side, radius, M, rng, runs: success(side, radius, (M + 1) // 2, rng, runs)
)
success.refuses("100 particles, whatever is asked")(
    lambda side, radius, M, rng, runs: success(side, radius, 100, rng, runs)
)
success.refuses("the number of particles that are near")(
    lambda side, radius, M, rng, runs: (
        np.hypot(*(side * (rng.random((2, runs, M)) - 0.5))) < radius
    ).sum(axis=-1)
)
success.refuses("near in x and near in y: a square for a circle")(
    lambda side, radius, M, rng, runs: (
        np.abs(side * (rng.random((2, runs, M)) - 0.5)).max(axis=0) < radius
    ).any(axis=-1)
)
success.refuses("a disc for the square")(
    lambda side, radius, M, rng, runs: (side / 2 * np.sqrt(rng.random((runs, M))) < radius).any(
        axis=-1
    )
)

p8c = Choice("""Which way does the cause run?
    a  More particles make the pose more uncertain
       = Particles describe the belief; their number does not widen it.
    b* A more uncertain pose needs more particles for the same quality
       = Yes: a wider belief has more places to cover.
    c  More particles make the pose more certain
       = They describe the same belief more precisely; the belief stays as wide.
    d  The two are not related
       = You have just measured a slope near 1.""")
