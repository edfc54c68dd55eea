"""P3 and P4: what is lost without particles near the truth, and without resampling."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, Text, experiment
from pfkit.labs.lab3 import given as lab
from pfkit.labs.response import same_mean, same_scatter
from pfkit.labs.target import target_log

P3 = Question("Deprivation")


def _film(path, rng, least, most):
    """The first frames of a fresh film, between least and most of them."""
    frames = int(rng.integers(least, most + 1))
    return target_log(path, seed=int(rng.integers(2**31)))[:frames]


def _how_near(rng):
    """Films, few and many particles, and circles of which the cloud fills all or a part."""
    few, more, many = (int(rng.integers(*ends)) for ends in ((20, 36), (60, 101), (120, 161)))
    wide, middle, narrow, tiny = (
        float(rng.uniform(*ends)) for ends in ((35, 45), (22, 32), (12, 18), (4, 7))
    )
    still, along = _film("fixed", rng, 8, 14), _film("line", rng, 8, 14)
    round_ = _film("circle", rng, 20, 28)  # so long that the first frames are forgotten
    return [
        (still, few, wide), (round_, more, middle), (along, more, narrow), (still, many, tiny),
        (round_, many, narrow),
    ]  # fmt: skip


@experiment(
    """Share of runs without a particle near the truth
    One True or False per run: is nobody near the truth?
    Take the distance of every particle, then ask whether all are far.
    (distance > radius).all(axis=-1), shape (runs,).""",
    id="p3a",
    points=2,
    claim="the share of deprived runs depends on the film, the number of particles and the radius "
    "as that of a right experiment",
    test="share within 4.5 standard errors of a right one at each of five settings",
    runs=400,
    pool=12_000,
    settings=_how_near,
    together=True,
    margin="4.5 standard errors in six comparisons: 4e-5",
)
def deprived(film, M, radius, rng, runs):
    """After the film, from anywhere: is no particle within ``radius`` px of the truth?"""
    bel = lab.anywhere((runs, M), rng)
    run = lab.track(film, bel, pf.FixedTarget(1.0), pf.Position(10.0), rng)
    x, y = run.bel.state
    true_x, true_y = film.truth[:2, -1]
    return (np.hypot(x - true_x, y - true_y) > radius).all(axis=-1)


deprived.holds(
    "each run gives True or False",
    lambda x: bool(np.isin(x[..., 0], (0, 1)).all()),
)
deprived.holds("the share follows film, number of particles and radius", same_mean())


def _last(film, M, rng, runs, scheme=pf.systematic):
    """Where the particles lie after a film: x and y, each (runs, M)."""
    bel, models = lab.anywhere((runs, M), rng), (pf.FixedTarget(1.0), pf.Position(10.0))
    return lab.track(film, bel, *models, rng, scheme).bel.state


def _from(place, x, y):
    return np.hypot(x - place[0], y - place[1])


def _distances(film, M, rng, runs, scheme=pf.systematic):
    """Of all particles from the truth at the end of the film, (runs, M)."""
    return _from(film.truth[:2, -1], *_last(film, M, rng, runs, scheme))


def _repeated(film, k):
    """A film that shows one of its frames all the time."""
    return replace(film, z=[film.z[k]] * len(film))


def _shares(x):
    """Mostly none or all, as where a cloud is narrow, but now and then something between."""
    between = ((x > 0) & (x < 1)).mean()
    return bool(x.min() >= 0 and x.max() <= 1 and 0.02 < between < 0.5)


deprived.wrong("""somebody-far: asks whether some particle is far
    Is a set deprived when one of its particles is lost?
    Deprived means that not one particle is near the truth.
    Use .all(axis=-1) where you have .any(axis=-1).""")(
    lambda film, M, radius, rng, runs: (_distances(film, M, rng, runs) > radius).any(axis=-1)
)
deprived.wrong("""somebody-near: counts the runs that are well, not those that are deprived
    Your share rises with the number of particles. Should it?
    You answer the opposite question.
    Negate it: True means that nobody is near.""")(
    lambda film, M, radius, rng, runs: ~deprived(film, M, radius, rng, runs)
)
deprived.wrong("""no-filter: looks at particles that still lie as they were drawn: too early, or
         never resampled
    Your shares are those of darts thrown at the image. Who aims them?
    Deprivation comes with resampling: the film must pass, each frame with its own.
    Use run.bel.state, after lab.track(film, ...).""")(
    lambda film, M, radius, rng, runs: (
        _from(film.truth[:2, -1], *lab.anywhere((runs, M), rng).state) > radius
    ).all(axis=-1)
)


@deprived.wrong("""asks whether the mean is far, not whether every particle is
    Can a particle stand near the truth while the mean of all does not?
    A filter that still has one good particle can recover.
    Take the distance of every particle: (distance > radius).all(axis=-1).""")
def mean_far(film, M, radius, rng, runs):
    x, y = _last(film, M, rng, runs).mean(axis=-1)
    return _from(film.truth[:2, -1], x, y) > radius


@deprived.wrong("""takes the frames of the lab's film, whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses the film, and how many frames it has.
    lab.track(film, ...), and the truth is film.truth[:2, -1].""")
def film_ignored(film, M, radius, rng, runs):
    return deprived(lab.film[:10], M, radius, rng, runs)


deprived.wrong("""share-far: gives the share of particles that are far
    How many different numbers should your function return?
    One good particle is enough, so a run is deprived or it is not.
    Use .all(axis=-1) where you have .mean(axis=-1).""")(
    lambda film, M, radius, rng, runs: (_distances(film, M, rng, runs) > radius).mean(axis=-1),
    when=lambda x: _shares(x[..., 0]),
)
deprived.wrong("""radius-ignored: takes 30 px for near, whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses how near is near.
    (distance > radius).all(axis=-1).""")(
    lambda film, M, radius, rng, runs: deprived(film, M, 30.0, rng, runs)
)
deprived.wrong("""size-ignored: takes 100 particles, whatever it is asked
    Does your function use M?
    The check chooses the number of particles.
    lab.anywhere((runs, M), rng).""")(
    lambda film, M, radius, rng, runs: deprived(film, 100, radius, rng, runs)
)
deprived.refuses("a coin with the right share for 100 particles and 30 px")(
    lambda film, M, radius, rng, runs: rng.random(runs) < 0.12
)
deprived.refuses("darts, by the law of a circle's share in the image", named="no-filter")(
    lambda film, M, radius, rng, runs: rng.random(runs) < (1 - np.pi * radius**2 / 640 / 480) ** M
)
deprived.refuses("a fair coin")(lambda film, M, radius, rng, runs: rng.random(runs) < 0.5)
deprived.refuses("never")(lambda film, M, radius, rng, runs: np.zeros(runs, dtype=bool))
deprived.refuses("always")(lambda film, M, radius, rng, runs: np.ones(runs, dtype=bool))
deprived.refuses("half as many particles")(
    lambda film, M, radius, rng, runs: deprived(film, M // 2, radius, rng, runs)
)
deprived.refuses("twice the radius")(
    lambda film, M, radius, rng, runs: deprived(film, M, 2 * radius, rng, runs)
)
deprived.refuses("one run, repeated")(
    lambda film, M, radius, rng, runs: np.repeat(deprived(film, M, radius, rng, 1), runs)
)
deprived.refuses("one frame instead of all")(
    lambda film, M, radius, rng, runs: (
        _from(film.truth[:2, -1], *_last(film[:1], M, rng, runs)) > radius
    ).all(axis=-1)
)
deprived.refuses("the first frame, as often as there are frames")(
    lambda film, M, radius, rng, runs: deprived(_repeated(film, 0), M, radius, rng, runs)
)
deprived.refuses("the last frame, as often as there are frames")(
    lambda film, M, radius, rng, runs: deprived(_repeated(film, -1), M, radius, rng, runs)
)
deprived.refuses("the frames in reverse order")(
    lambda film, M, radius, rng, runs: deprived(replace(film, z=film.z[::-1]), M, radius, rng, runs)
)
deprived.refuses("the truth of the first frame for that of the last")(
    lambda film, M, radius, rng, runs: (
        _from(film.truth[:2, 0], *_last(film, M, rng, runs)) > radius
    ).all(axis=-1)
)
deprived.refuses("the whole film without resampling", named="no-filter")(
    lambda film, M, radius, rng, runs: (_distances(film, M, rng, runs, scheme=None) > radius).all(
        axis=-1
    )
)
deprived.refuses("the distance along x alone")(
    lambda film, M, radius, rng, runs: (
        np.abs(_last(film, M, rng, runs)[0] - film.truth[0, -1]) > radius
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


def keep_the_heaviest(w, rng):
    """A scheme that no course teaches: copies of the ten heaviest particles, in turn."""
    return np.resize(np.argsort(w)[-10:], w.size)


def _clouds(rng):
    """With and without resampling, small and large clouds, a sharp and a blunt sensor."""
    small, large = int(rng.integers(60, 100)), int(rng.integers(300, 400))
    sharp, blunt = float(rng.uniform(2.0, 2.6)), float(rng.uniform(4.5, 6.0))
    return [
        (None, small, blunt), (None, large, sharp), (pf.systematic, small, blunt),
        (pf.systematic, large, sharp), (keep_the_heaviest, small, blunt),
    ]  # fmt: skip


p4a = Prediction("""ESS after 50 frames without resampling, of 1,000 particles
    a  It stays near the number of particles
    b  It settles near half of them
    c* It falls to a few particles
    d  It goes up and down without trend""")


@experiment(
    """ESS with and without resampling
    Return the ESS before the decision to resample, one row per frame.
    lab.track(...).ess has this shape: frames by runs.
    Pass the scheme on: lab.track(..., scheme=scheme).""",
    id="p4b",
    after=p4a,
    points=2,
    claim="the ESS depends on the scheme, on the number of particles and on the sensor as that of "
    "a right experiment",
    test="mean ESS of the first, the tenth and the last frame within 5 standard errors of a right "
    "one at each of five settings; scatter from run to run within a factor of 3",
    runs=32,
    pool=1_200,
    settings=_clouds,
    together=True,
    rows=FRAMES,
    false_fail=1e-3,
    margin="5 standard errors in 16 comparisons: 8e-5 by Student's law",
)
def ess_history(scheme, M, sd, rng, runs):
    """ESS before each resampling by the scheme, 50 frames: shape (50, runs)."""
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=5.0)
    return lab.track(lab.film[:50], bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme).ess


ess_history.holds(
    "first and tenth frame: the ESS follows scheme, particles and sensor",
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
def after_resampling(scheme, M, sd, rng, runs):
    if scheme is not None:
        return np.full((50, runs), float(M))
    return ess_history(None, M, sd, rng, runs)


ess_history.wrong("""never-resampled: never resamples
    Your curves look alike, with and without a scheme.
    Does your function use its first argument?
    lab.track(..., scheme=scheme).""")(
    lambda scheme, M, sd, rng, runs: ess_history(None, M, sd, rng, runs)
)
ess_history.wrong("""always-resampled: resamples by one scheme, whatever it is asked
    Your curves look alike, with and without a scheme.
    Does your function use its first argument?
    lab.track(..., scheme=scheme).""")(
    lambda scheme, M, sd, rng, runs: ess_history(pf.systematic, M, sd, rng, runs)
)
ess_history.wrong("""own-scheme: resamples by a scheme of its own where it gets one
    Which scheme did the check hand to your function?
    None means never; any other scheme is to be called as it is.
    lab.track(..., scheme=scheme).""")(
    lambda scheme, M, sd, rng, runs: ess_history(scheme and pf.systematic, M, sd, rng, runs)
)
ess_history.wrong("""share: is the ESS as a share of the particles
    Your numbers lie between 0 and 1. How many particles is that?
    The effective sample size counts particles, from 1 to M.
    Do not divide by M: lab.track(...).ess as it is.""")(
    lambda scheme, M, sd, rng, runs: ess_history(scheme, M, sd, rng, runs) / M
)
ess_history.wrong("""size-ignored: takes 1,000 particles, whatever it is asked
    Can the ESS be larger than M?
    The check chooses the number of particles.
    lab.around(lab.film.start[:2], (runs, M), rng, sigma=5.0).""")(
    lambda scheme, M, sd, rng, runs: ess_history(scheme, 1000, sd, rng, runs)
)
ess_history.wrong("""sensor-ignored: takes pf.Position(3.0), whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses how sharp the sensor is.
    pf.Position(sd).""")(lambda scheme, M, sd, rng, runs: ess_history(scheme, M, 3.0, rng, runs))
ess_history.refuses("constants at the right values for 1,000 particles and 3 px")(
    lambda scheme, M, sd, rng, runs: np.full((50, runs), 892.0 if scheme else 1.7)
)


@ess_history.refuses("a curve that falls, in proportion to M, and a flat one")
def curves(scheme, M, sd, rng, runs):
    fall = 1 + M * np.exp(-np.arange(50.0) / 4)
    return np.repeat((np.full(50, 0.89 * M) if scheme else fall)[:, None], runs, axis=1)


ess_history.refuses("random in range")(
    lambda scheme, M, sd, rng, runs: rng.uniform(1, M, (50, runs))
)
ess_history.refuses("half as many particles")(
    lambda scheme, M, sd, rng, runs: ess_history(scheme, M // 2, sd, rng, runs)
)
ess_history.refuses("one run, repeated")(
    lambda scheme, M, sd, rng, runs: np.repeat(ess_history(scheme, M, sd, rng, 1), runs, axis=1)
)
ess_history.refuses("five frames instead of 50")(
    lambda scheme, M, sd, rng, runs: ess_history(scheme, M, sd, rng, runs)[:5]
)
ess_history.refuses("the frames in reverse order")(
    lambda scheme, M, sd, rng, runs: ess_history(scheme, M, sd, rng, runs)[::-1]
)


@ess_history.refuses("the errors instead of the ESS")
def errors(scheme, M, sd, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=5.0)
    return lab.track(lab.film[:50], bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme).error


@ess_history.refuses("particles from anywhere")
def from_anywhere(scheme, M, sd, rng, runs):
    bel = lab.anywhere((runs, M), rng)
    return lab.track(lab.film[:50], bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme).ess


@ess_history.refuses("one frame, 50 times")
def one_frame(scheme, M, sd, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=5.0)
    film = _repeated(lab.film[:50], 0)
    return lab.track(film, bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme).ess


ess_history.refuses("the multinomial scheme, whatever it is asked", named="always-resampled")(
    lambda scheme, M, sd, rng, runs: ess_history(pf.multinomial, M, sd, rng, runs)
)
ess_history.refuses("the multinomial scheme wherever it gets one", named="own-scheme")(
    lambda scheme, M, sd, rng, runs: ess_history(scheme and pf.multinomial, M, sd, rng, runs)
)
