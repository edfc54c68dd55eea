"""What averaging and underflow do, measured."""

import numpy as np

import pfkit as pf
from pfkit.labs import Question, Text, experiment
from pfkit.labs.sensing.predictions import average, beams

BREAK = Question("Experiments")


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


@experiment(
    """Spread after averaging over spread after multiplying
    Weigh the same cloud twice: once by the sum of the logs, once by the log of the mean.
    look(rng, K=2) of the chapter returns both spreads.
    product, average = look(rng, 2)[0]; return average / product""",
    points=2,
    after=average,
    runs=20,
    pool=300,
    claim="averaging leaves the belief three to five times as wide",
    test="median of 20 runs between 3 and 5, none below 2",
    margin="median 3.6, the median of 20 runs has sd 0.11: 5 standard errors",
)
def average_x(rng):
    product, mean = _spreads(rng)
    return mean / product


average_x.holds("the averaged belief is the wider one in every run", lambda x: x.min() > 1)
average_x.holds("median ratio between 3 and 5", lambda x: 3 < np.median(x) < 5)
average_x.holds("the runs differ", lambda x: x.std() > 1e-6)
average_x.wrong("""inverse: returns the ratio upside down
    Which belief is wider?
    Average over product was asked for.
    Turn the fraction over.""")(
    lambda rng: 1 / average_x(rng), when=lambda x: (x < 1).all() and (x > 0).all()
)
average_x.wrong("""squared: compares variances, not standard deviations
    In which unit is your spread?
    The trace of a covariance is in square metres.
    Take the square root of the trace.""")(
    lambda rng: average_x(rng) ** 2, when=lambda x: 8 < np.median(x) < 25
)
average_x.wrong("""one-landmark: uses one landmark only
    How many measurements enter your sum?
    Two landmarks, range and bearing each: four parts.
    Draw z with ids=[0, 1].""")(
    lambda rng: float(np.divide(*_spreads(rng, 1)[::-1])), when=lambda x: 1.4 < np.median(x) < 2.6
)


def _zeros(rng, K=5, sigma=0.1, M=1000):
    office = pf.worlds.office()
    laser = pf.BeamModel(office, np.linspace(-np.pi / 2, np.pi / 2, K), r_max=12.0)
    poses = office.sample_poses(M + 1, rng)
    length = laser.lengths(poses)
    r = length[:, :1] + sigma * rng.standard_normal((K, 1))
    return np.exp(pf.log_gaussian(r - length[:, 1:], sigma)).prod(axis=0)


@experiment(
    """Weights that are exactly zero after five beams
    Draw a pose for the robot and 1,000 for the cloud, all from office.sample_poses.
    Multiply exp(log_gaussian(r - length, 0.1)) over the five beams, as numbers.
    return np.mean(p == 0)""",
    points=2,
    after=beams,
    runs=30,
    pool=300,
    claim="the plain product of five beams is exactly zero for more than half of a lost cloud",
    test="mean of 30 runs between 0.45 and 0.75",
    margin="mean 0.6, the mean of 30 runs has sd 0.03: 5 standard errors",
)
def beams_x(rng):
    return np.mean(_zeros(rng) == 0)


beams_x.holds("shares between 0 and 1", lambda x: (x >= 0).all() and (x <= 1).all())
beams_x.holds("mean share between 0.45 and 0.75", lambda x: 0.45 < x.mean() < 0.75)
beams_x.holds("the runs differ", lambda x: x.std() > 1e-6)
beams_x.wrong("""logs: keeps the logarithms, which never underflow
    You did what a filter should do. What happens without it?
    Multiply the densities themselves here.
    np.exp(...).prod(axis=0) == 0""")(lambda rng: 0.0, when=lambda x: (x == 0).all())
beams_x.wrong("""vague: uses a far wider sensor than 0.1 m
    Which standard deviation have your beams?
    0.1 m was asked for.
    pf.log_gaussian(error, 0.1)""")(
    lambda rng: np.mean(_zeros(rng, sigma=0.25) == 0), when=lambda x: 0 < x.mean() < 0.35
)
beams_x.wrong("""count: returns a number of particles, not a share
    Can a share be 600?
    Divide by the number of particles.
    np.mean, not np.sum""")(lambda rng: np.sum(_zeros(rng) == 0), when=lambda x: (x > 1).any())

why = Text(
    """Why multiply, and why in logarithms?
    says that the measurements are independent given the pose, so that densities multiply
    says that an average lets one good measurement excuse an impossible one
    says that products of small numbers underflow to zero and sums of logarithms do not""",
    model="Given the pose the errors of the measurements are independent, so their densities "
    "multiply. An average adds densities of different units, and lets one good reading excuse "
    "an impossible one. Products of many small numbers round to zero, while their logarithms "
    "only add up.",
)
