"""P3 and P4: what is lost without particles near the truth, and without resampling."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, Text, experiment
from pfkit.labs.lab3 import given as lab
from pfkit.labs.response import same_mean, same_scatter
from pfkit.labs.target import anywhere, around, target_log, track

P3 = Question("Deprivation")

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]


def _how_near(rng):
    """Few and many particles, and circles of which the cloud fills all or a part."""
    few, more, many = (int(rng.integers(*ends)) for ends in ((20, 36), (60, 101), (120, 161)))
    wide, middle, narrow, tiny = (
        float(rng.uniform(*ends)) for ends in ((35, 45), (22, 32), (12, 18), (4, 7))
    )
    return [(few, wide), (more, middle), (more, narrow), (many, tiny)]


@experiment(
    """Share of runs without a particle near the truth
    One True or False per run: is nobody near the truth?
    Take the distance of every particle, then ask whether all are far.
    (distance > radius).all(axis=-1), shape (runs,).""",
    id="p3a",
    points=2,
    claim="the share of deprived runs depends on the number of particles and on the radius as "
    "that of a right experiment",
    test="share within 4.5 standard errors of a right one at each of four settings",
    runs=400,
    pool=12_000,
    settings=_how_near,
    together=True,
    margin="4.5 standard errors in five comparisons: 4e-5",
)
def deprived(M, radius, rng, runs):
    """After ten frames from anywhere: is no particle within ``radius`` px of the truth?"""
    bel = lab.anywhere((runs, M), rng)
    run = lab.track(lab.film[:10], bel, pf.FixedTarget(1.0), pf.Position(10.0), rng)
    x, y = run.bel.state
    true_x, true_y = lab.film.truth[:2, 9]
    return (np.hypot(x - true_x, y - true_y) > radius).all(axis=-1)


deprived.holds(
    "each run gives True or False",
    lambda x: bool(np.isin(x[..., 0], (0, 1)).all()),
)
deprived.holds("the share follows the number of particles and the radius", same_mean())


def _distances(M, rng, runs, frames=10, scheme=pf.systematic):
    """Of all particles from the truth, (runs, M), after some frames."""
    bel = anywhere((runs, M), rng)
    if frames:
        bel = track(FILM[:frames], bel, pf.FixedTarget(1.0), pf.Position(10.0), rng, scheme).bel
    x, y = bel.state
    return np.hypot(x - HOME[0], y - HOME[1])


def _shares(x):
    """Mostly none or all, as where a cloud is narrow, but now and then something between."""
    between = ((x > 0) & (x < 1)).mean()
    return bool(x.min() >= 0 and x.max() <= 1 and 0.02 < between < 0.5)


deprived.wrong("""somebody-far: asks whether some particle is far
    Is a set deprived when one of its particles is lost?
    Deprived means that not one particle is near the truth.
    Use .all(axis=-1) where you have .any(axis=-1).""")(
    lambda M, radius, rng, runs: (_distances(M, rng, runs) > radius).any(axis=-1)
)
deprived.wrong("""somebody-near: counts the runs that are well, not those that are deprived
    Your share rises with the number of particles. Should it?
    You answer the opposite question.
    Negate it: True means that nobody is near.""")(
    lambda M, radius, rng, runs: ~deprived(M, radius, rng, runs)
)
deprived.wrong("""no-filter: looks at particles that still lie as they were drawn: too early, or
         never resampled
    Your shares are those of darts thrown at the image. Who aims them?
    Deprivation comes with resampling: ten frames of the film must pass, each with its own.
    Use run.bel.state, after lab.track(lab.film[:10], ...).""")(
    lambda M, radius, rng, runs: (_distances(M, rng, runs, 0) > radius).all(axis=-1)
)


@deprived.wrong("""asks whether the mean is far, not whether every particle is
    Can a particle stand near the truth while the mean of all does not?
    A filter that still has one good particle can recover.
    Take the distance of every particle: (distance > radius).all(axis=-1).""")
def mean_far(M, radius, rng, runs):
    bel = track(
        FILM[:10], anywhere((runs, M), rng), pf.FixedTarget(1.0), pf.Position(10.0), rng
    ).bel
    x, y = bel.state.mean(axis=-1)
    return np.hypot(x - HOME[0], y - HOME[1]) > radius


deprived.wrong("""share-far: gives the share of particles that are far
    How many different numbers should your function return?
    One good particle is enough, so a run is deprived or it is not.
    Use .all(axis=-1) where you have .mean(axis=-1).""")(
    lambda M, radius, rng, runs: (_distances(M, rng, runs) > radius).mean(axis=-1),
    when=lambda x: _shares(x[..., 0]),
)
deprived.wrong("""radius-ignored: takes 30 px for near, whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses how near is near.
    (distance > radius).all(axis=-1).""")(lambda M, radius, rng, runs: deprived(M, 30.0, rng, runs))
deprived.wrong("""size-ignored: takes 100 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.anywhere((runs, M), rng).""")(lambda M, radius, rng, runs: deprived(100, radius, rng, runs))
deprived.refuses("a coin with the right share for 100 particles and 30 px")(
    lambda M, radius, rng, runs: rng.random(runs) < 0.12
)
deprived.refuses("darts, by the law of a circle's share in the image", named="no-filter")(
    lambda M, radius, rng, runs: rng.random(runs) < (1 - np.pi * radius**2 / 640 / 480) ** M
)
deprived.refuses("a fair coin")(lambda M, radius, rng, runs: rng.random(runs) < 0.5)
deprived.refuses("never")(lambda M, radius, rng, runs: np.zeros(runs, dtype=bool))
deprived.refuses("always")(lambda M, radius, rng, runs: np.ones(runs, dtype=bool))
deprived.refuses("half as many particles")(
    lambda M, radius, rng, runs: deprived(M // 2, radius, rng, runs)
)
deprived.refuses("twice the radius")(
    lambda M, radius, rng, runs: deprived(M, 2 * radius, rng, runs)
)
deprived.refuses("one run, repeated")(
    lambda M, radius, rng, runs: np.repeat(deprived(M, radius, rng, 1), runs)
)
deprived.refuses("one frame instead of ten", named="no-filter")(
    lambda M, radius, rng, runs: (_distances(M, rng, runs, 1) > radius).all(axis=-1)
)
deprived.refuses("ten frames without resampling", named="no-filter")(
    lambda M, radius, rng, runs: (_distances(M, rng, runs, scheme=None) > radius).all(axis=-1)
)
deprived.refuses("the distance along x alone")(
    lambda M, radius, rng, runs: (
        np.abs(
            track(
                FILM[:10], anywhere((runs, M), rng), pf.FixedTarget(1.0), pf.Position(10.0), rng
            ).bel.state[0]
            - HOME[0]
        )
        > radius
    ).all(axis=-1)
)


p3b = Choice("""What causes deprivation
    a  Only resampling when nothing new was measured
       = That is one cause; you have just seen another, with every frame informative.
    b  Only too few particles
       = That is one cause; 400 particles die out too if resampled without need.
    c  A wrong map
       = A wrong map misleads any filter; deprivation happens with a right one.
    d* Few particles, a sharp likelihood, little process noise, needless resampling
       = Yes: each makes it likelier that the last particle near the truth is lost.""")

p3c = Text(
    """Why deprivation is dangerous
    says that no particle is near the truth, so resampling cannot bring one back (1)
    says that the spread of the cloud shows confidence, so nothing warns us (1)""",
    points=2,
    model="No particle is left near the truth, and resampling only copies what is there. "
    "The cloud is narrow, so the filter is sure and wrong, and its spread does not "
    "warn us.",
)

P4 = Question("Why resample at all?")


FRAMES = (0, 9, -1)  # the first, the tenth and the last


def _clouds(rng):
    """With and without resampling, small and large clouds, a sharp and a blunt sensor."""
    small, large = int(rng.integers(60, 100)), int(rng.integers(300, 400))
    sharp, blunt = float(rng.uniform(2.0, 2.6)), float(rng.uniform(4.5, 6.0))
    return [(r, M, sd) for r in (True, False) for M, sd in ((small, blunt), (large, sharp))]


p4a = Prediction("""ESS after 50 frames without resampling, of 1,000 particles
    a  It stays near the number of particles
    b  It settles near half of them
    c* It falls to a few particles
    d  It goes up and down without trend""")


@experiment(
    """ESS with and without resampling
    Return the ESS before the decision to resample, one row per frame.
    lab.track(...).ess has this shape: frames by runs.
    Pass scheme=pf.systematic or scheme=None.""",
    id="p4b",
    after=p4a,
    points=2,
    claim="the ESS with and without resampling depends on the number of particles and on the "
    "sensor as that of a right experiment",
    test="mean ESS of the first, the tenth and the last frame within 5 standard errors of a right "
    "one at each of four settings; scatter from run to run within a factor of 3",
    runs=32,
    pool=1_200,
    settings=_clouds,
    together=True,
    rows=FRAMES,
    false_fail=1e-3,
    margin="5 standard errors in 13 comparisons: 7e-5 by Student's law",
)
def ess_history(resample, M, sd, rng, runs):
    """ESS before each decision to resample, 50 frames: shape (50, runs)."""
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=5.0)
    scheme = pf.systematic if resample else None
    return lab.track(lab.film[:50], bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme).ess


ess_history.holds(
    "first and tenth frame: the ESS follows resampling, particles and sensor",
    lambda x: same_mean(5.0)(x[:, :, :2]),
)
ess_history.holds(
    "last frame: without resampling a few particles are left",
    lambda x: same_mean(5.0)(x[:, :, 2:]),
)
ess_history.holds(
    "the runs scatter as independent filters do",
    lambda x: same_scatter(3.0)(x[:, :, :2]),
)


@ess_history.wrong("""measures the ESS after resampling, when all weights are equal
    Your ESS with resampling is always the number of particles. Why?
    Equal weights have ESS M, whatever happened before.
    Take the ESS after the update and before the resampling.""")
def after_resampling(resample, M, sd, rng, runs):
    if resample:
        return np.full((50, runs), float(M))
    return ess_history(False, M, sd, rng, runs)


ess_history.wrong("""never-resampled: does not resample in either case
    Your curves look alike, with and without.
    Does your function use its first argument?
    scheme = pf.systematic if resample else None.""")(
    lambda resample, M, sd, rng, runs: ess_history(False, M, sd, rng, runs)
)
ess_history.wrong("""always-resampled: resamples in both cases
    Your curves look alike, with and without.
    Does your function use its first argument?
    scheme = pf.systematic if resample else None.""")(
    lambda resample, M, sd, rng, runs: ess_history(True, M, sd, rng, runs)
)
ess_history.wrong("""exchanged: resamples when it should not, and does not when it should
    In which of your two cases does the ESS fall?
    Without resampling the weights multiply up.
    scheme = pf.systematic if resample else None.""")(
    lambda resample, M, sd, rng, runs: ess_history(not resample, M, sd, rng, runs)
)
ess_history.wrong("""share: is the ESS as a share of the particles
    Your numbers lie between 0 and 1. How many particles is that?
    The effective sample size counts particles, from 1 to M.
    Do not divide by M: lab.track(...).ess as it is.""")(
    lambda resample, M, sd, rng, runs: ess_history(resample, M, sd, rng, runs) / M
)
ess_history.wrong("""size-ignored: takes 1,000 particles, whatever it is asked
    Can the ESS be larger than M?
    The check chooses the number of particles.
    lab.around(lab.film.start[:2], (runs, M), rng, sigma=5.0).""")(
    lambda resample, M, sd, rng, runs: ess_history(resample, 1000, sd, rng, runs)
)
ess_history.wrong("""sensor-ignored: takes pf.Position(3.0), whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses how sharp the sensor is.
    pf.Position(sd).""")(
    lambda resample, M, sd, rng, runs: ess_history(resample, M, 3.0, rng, runs)
)
ess_history.refuses("constants at the right values for 1,000 particles and 3 px")(
    lambda resample, M, sd, rng, runs: np.full((50, runs), 892.0 if resample else 1.7)
)


@ess_history.refuses("a curve that falls, in proportion to M, and a flat one")
def curves(resample, M, sd, rng, runs):
    fall = 1 + M * np.exp(-np.arange(50.0) / 4)
    return np.repeat((np.full(50, 0.89 * M) if resample else fall)[:, None], runs, axis=1)


ess_history.refuses("random in range")(
    lambda resample, M, sd, rng, runs: rng.uniform(1, M, (50, runs))
)
ess_history.refuses("half as many particles")(
    lambda resample, M, sd, rng, runs: ess_history(resample, M // 2, sd, rng, runs)
)
ess_history.refuses("one run, repeated")(
    lambda resample, M, sd, rng, runs: np.repeat(ess_history(resample, M, sd, rng, 1), runs, axis=1)
)
ess_history.refuses("five frames instead of 50")(
    lambda resample, M, sd, rng, runs: ess_history(resample, M, sd, rng, runs)[:5]
)
ess_history.refuses("the frames in reverse order")(
    lambda resample, M, sd, rng, runs: ess_history(resample, M, sd, rng, runs)[::-1]
)


@ess_history.refuses("the errors instead of the ESS")
def errors(resample, M, sd, rng, runs):
    bel = around(HOME, (runs, M), rng, sigma=5.0)
    scheme = pf.systematic if resample else None
    return track(FILM[:50], bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme).error


@ess_history.refuses("particles from anywhere")
def from_anywhere(resample, M, sd, rng, runs):
    scheme = pf.systematic if resample else None
    bel = anywhere((runs, M), rng)
    return track(FILM[:50], bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme).ess
