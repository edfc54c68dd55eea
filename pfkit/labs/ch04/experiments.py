"""What averaging and underflow do, predicted and then measured."""

import numpy as np

import pfkit as pf
from pfkit.labs.items import Experiment, Misconception, Prediction, Property

average = Prediction(
    id="average",
    title="Averaging likelihoods instead of multiplying them",
    options={
        "a": "as wide: both use all four numbers",
        "b": "wider by a few per cent",
        "c": "three to five times as wide",
        "d": "narrower, because averaging removes noise",
    },
    key="c",
)

beams = Prediction(
    id="beams",
    title="Share of weights that are exactly zero after five laser beams",
    options={
        "a": "none: a Gaussian is never zero",
        "b": "about one in a hundred",
        "c": "about one in ten",
        "d": "more than half",
    },
    key="d",
)


def _spread(bel):
    return np.sqrt(np.trace(pf.covariance(bel)[:2, :2]))


def _spreads(rng, K=2, M=3000):
    world, guess = pf.worlds.arena(), np.array([6.0, 3.0, np.pi / 2])
    truth, bel = (pf.gaussian_prior(n, guess, [1.0, 1.0, 0.1], rng) for n in (1, M))
    z = pf.RangeBearing(world, 0.3, 0.1).sample(truth.state[:, 0], rng, ids=np.arange(K))
    r, phi = pf.Range(world, 0.3), pf.Bearing(world, 0.1)
    parts = np.array(
        [r.log_density(zk, bel.state) for zk in z[[0, 2]].T]
        + [phi.log_density(zk, bel.state) for zk in z[[1, 2]].T]
    )
    scores = parts.sum(axis=0), np.logaddexp.reduce(parts)
    return [_spread(pf.Particles(bel.state, pf.normalise(s)[0])) for s in scores]


def _average_run(rng):
    product, mean = _spreads(rng)
    return mean / product


average_x = Experiment(
    id="average_x",
    title="Spread after averaging over spread after multiplying",
    points=2,
    after="average",
    runs=20,
    claim="averaging leaves the belief three to five times as wide",
    test="median of 20 runs between 3 and 5, none below 2",
    reference=_average_run,
    properties=(
        Property("the averaged belief is the wider one in every run", lambda x: bool(x.min() > 1)),
        Property("median ratio between 3 and 5", lambda x: bool(3 < np.median(x) < 5)),
        Property("the runs differ", lambda x: bool(x.std() > 1e-6)),
    ),
    margin="median 3.6, the median of 20 runs has sd 0.11: 5 standard errors",
    hints=(
        "Weigh the same cloud twice: once by the sum of the logs, once by the log of the mean.",
        "look(rng, K=2) of the chapter returns both spreads.",
        "product, average = look(rng, 2)[0]; return average / product",
    ),
    misconceptions=(
        Misconception(
            "inverse",
            "returns the ratio upside down",
            (
                "Which belief is wider?",
                "Average over product was asked for.",
                "Turn the fraction over.",
            ),
            lambda rng: 1 / _average_run(rng),
            lambda x: bool((x < 1).all() and (x > 0).all()),
        ),
        Misconception(
            "squared",
            "compares variances, not standard deviations",
            (
                "In which unit is your spread?",
                "The trace of a covariance is in square metres.",
                "Take the square root of the trace.",
            ),
            lambda rng: _average_run(rng) ** 2,
            lambda x: bool(8 < np.median(x) < 25),
        ),
        Misconception(
            "one-landmark",
            "uses one landmark only",
            (
                "How many measurements enter your sum?",
                "Two landmarks, range and bearing each: four parts.",
                "Draw z with ids=[0, 1].",
            ),
            lambda rng: float(np.divide(*_spreads(rng, 1)[::-1])),
            lambda x: bool(1.4 < np.median(x) < 2.6),
        ),
    ),
)


def _zeros(rng, K=5, sigma=0.1, M=1000):
    office = pf.worlds.office()
    laser = pf.BeamModel(office, np.linspace(-np.pi / 2, np.pi / 2, K), r_max=12.0)
    poses = office.sample_poses(M + 1, rng)
    length = laser.lengths(poses)
    r = length[:, :1] + sigma * rng.standard_normal((K, 1))
    return np.exp(pf.log_gaussian(r - length[:, 1:], sigma)).prod(axis=0)


def _beams_run(rng):
    return np.mean(_zeros(rng) == 0)


beams_x = Experiment(
    id="beams_x",
    title="Weights that are exactly zero after five beams",
    points=2,
    after="beams",
    runs=30,
    claim="the plain product of five beams is exactly zero for more than half of a lost cloud",
    test="mean of 30 runs between 0.45 and 0.75",
    reference=_beams_run,
    properties=(
        Property("shares between 0 and 1", lambda x: bool((x >= 0).all() and (x <= 1).all())),
        Property("mean share between 0.45 and 0.75", lambda x: bool(0.45 < x.mean() < 0.75)),
        Property("the runs differ", lambda x: bool(x.std() > 1e-6)),
    ),
    margin="mean 0.6, the mean of 30 runs has sd 0.03: 5 standard errors",
    hints=(
        "Draw a pose for the robot and 1,000 for the cloud, all from office.sample_poses.",
        "Multiply exp(log_gaussian(r - length, 0.1)) over the five beams, as numbers.",
        "return np.mean(p == 0)",
    ),
    misconceptions=(
        Misconception(
            "logs",
            "keeps the logarithms, which never underflow",
            (
                "You did what a filter should do. What happens without it?",
                "Multiply the densities themselves here.",
                "np.exp(...).prod(axis=0) == 0",
            ),
            lambda rng: 0.0,
            lambda x: bool((x == 0).all()),
        ),
        Misconception(
            "vague",
            "uses a far wider sensor than 0.1 m",
            (
                "Which standard deviation have your beams?",
                "0.1 m was asked for.",
                "pf.log_gaussian(error, 0.1)",
            ),
            lambda rng: np.mean(_zeros(rng, sigma=0.25) == 0),
            lambda x: bool(0 < x.mean() < 0.35),
        ),
        Misconception(
            "count",
            "returns a number of particles, not a share",
            ("Can a share be 600?", "Divide by the number of particles.", "np.mean, not np.sum"),
            lambda rng: np.sum(_zeros(rng) == 0),
            lambda x: bool((x > 1).any()),
        ),
    ),
)
