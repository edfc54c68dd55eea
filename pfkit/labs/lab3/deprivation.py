"""P3 and P4: what is lost without particles near the truth, and without resampling."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Prediction, Question, Text, experiment
from pfkit.labs.statistics import shaped, z_of_fall
from pfkit.labs.target import anywhere, around, target_log, track

P3 = Question("Deprivation")

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]
SIZES = (25, 100, 400)


def _deprivation(f, rng, runs):
    found = np.stack([shaped(f(M, rng, runs), runs) for M in SIZES], axis=1)
    if not np.isin(found, (0, 1)).all():
        raise ValueError("each run must give True or False")
    return found


@experiment(
    """Share of runs without a particle near the truth
    One True or False per run: is nobody near the truth?
    Take the distance of every particle, then ask whether all are far.
    (distance > 30).all(axis=-1), shape (runs,).""",
    id="p3a",
    points=2,
    claim="the share falls with the number of particles; with 100 it is below 1 in 4",
    test="two-proportion z > 3 from 25 to 100 and from 100 to 400 particles; share < .25",
    runs=400,
    margin="z is 14.6 and 7.8 on average, sd .6: 8 standard errors above 3; share .13: 7",
    measure=_deprivation,
)
def deprived(M, rng, runs):
    """After ten frames from anywhere: is no particle within 30 px of the truth?"""
    bel = anywhere((runs, M), rng)
    bel = track(FILM[:10], bel, pf.FixedTarget(1.0), pf.Position(10.0), rng).bel
    x, y = bel.state
    return (np.hypot(x - HOME[0], y - HOME[1]) > 30).all(axis=-1)


deprived.holds(
    "fewer runs are deprived with 100 particles than with 25",
    lambda x: z_of_fall(x[:, 0], x[:, 1]) > 3 or f"shares {x.mean(0).round(3)}",
)
deprived.holds(
    "fewer still with 400",
    lambda x: z_of_fall(x[:, 1], x[:, 2]) > 3 or f"shares {x.mean(0).round(3)}",
)
deprived.holds(
    "with 100 fewer than 1 in 4", lambda x: x[:, 1].mean() < 0.25 or f"share {x[:, 1].mean():.3f}"
)


@deprived.wrong(
    """asks whether some particle is far, which is nearly always true
    Is a set deprived when one of its particles is lost?
    Deprived means that not one particle is near the truth.
    Use .all(axis=-1) where you have .any(axis=-1).""",
    when=lambda x: x.mean(0).min() > 0.9,
)
def somebody_far(M, rng, runs):
    bel = track(
        FILM[:10], anywhere((runs, M), rng), pf.FixedTarget(20.0), pf.Position(30.0), rng
    ).bel
    return (np.hypot(bel.state[0] - HOME[0], bel.state[1] - HOME[1]) > 30).any(axis=-1)


deprived.wrong("""somebody-near: counts the runs that are well, not those that are deprived
    Your share rises with the number of particles. Should it?
    You answer the opposite question.
    Negate it: True means that nobody is near.""")(
    lambda M, rng, runs: ~deprived(M, rng, runs), when=lambda x: z_of_fall(x[:, 2], x[:, 0]) > 4
)


@deprived.wrong(
    """looks at the particles as they were drawn, before any measurement
    Your shares are those of darts thrown at the image. Who aims them?
    Ten frames of the film must pass first.
    Use run.bel.state, after lab.track(lab.film[:10], ...).""",
    when=lambda x: 0.25 < x[:, 1].mean() < 0.6 and x[:, 2].mean() < 0.1,
)
def no_filter(M, rng, runs):
    x, y = anywhere((runs, M), rng).state
    return (np.hypot(x - HOME[0], y - HOME[1]) > 30).all(axis=-1)


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


def _histories(f, rng, runs):
    with_, without = (shaped(f(r, rng, runs), 50, runs) for r in (True, False))
    return np.stack([with_.T, without.T], axis=1)


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
    claim="without resampling the ESS ends at 3 or less on average; "
    "with it, it keeps a median between 800 and 950",
    test="mean over runs of the last ESS < 3; median over frames 5 to 50 in the band",
    runs=10,
    pool=500,
    margin="last ESS 1.7, sd .22: 6 standard errors below 3; median 892, sd .8",
    measure=_histories,
)
def ess_history(resample, rng, runs):
    """ESS before each resampling decision: 50 frames, 1,000 particles around a known start."""
    bel = around(HOME, (runs, 1000), rng, sigma=5.0)
    scheme = pf.systematic if resample else None
    return track(FILM[:50], bel, pf.FixedTarget(1.0), pf.Position(3.0), rng, scheme).ess


ess_history.holds(
    "without resampling it ends at 3 or less",
    lambda x: x[:, 1, -1].mean() < 3 or f"it ends at {x[:, 1, -1].mean():.1f}",
)
ess_history.holds(
    "with resampling its median lies between 800 and 950",
    lambda x: 800 < np.median(x[:, 0, 5:]) < 950 or f"the median is {np.median(x[:, 0, 5:]):.0f}",
)
ess_history.wrong(
    """after-resampling: measures the ESS after resampling, when all weights are equal
    Your ESS with resampling is always the number of particles. Why?
    Equal weights have ESS M, whatever happened before.
    Take the ESS after the update and before the resampling.""",
    when=lambda x: np.median(x[:, 0]) > 999,
)(lambda r, rng, runs: np.full((50, runs), 1000.0) if r else ess_history(False, rng, runs))
ess_history.wrong("""never-resampled: does not resample in either case
    Your two curves look alike.
    Does your function use its first argument?
    scheme = pf.systematic if resample else None.""")(
    lambda r, rng, runs: ess_history(False, rng, runs), when=lambda x: x[:, 0, -1].mean() < 10
)
ess_history.wrong("""always-resampled: resamples in both cases
    Your two curves look alike.
    Does your function use its first argument?
    scheme = pf.systematic if resample else None.""")(
    lambda r, rng, runs: ess_history(True, rng, runs), when=lambda x: x[:, 1, -1].mean() > 100
)
