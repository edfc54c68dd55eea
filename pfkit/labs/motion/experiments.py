"""The experiments that decide the predictions."""

import numpy as np

import pfkit as pf
from pfkit.labs import Question, Text, experiment
from pfkit.labs.motion.predictions import rigid, split

BREAK = Question("Experiments")

ALPHA = (0.02, 0.002, 0.05, 0.05, 0.005, 0.005)
U = (1.0, 0.3, 0.5)


def _spreads(rng, M=500, steps=12):
    """Spread (m) of a cloud after twelve steps: with own errors, and with common ones."""
    motion, u = pf.VelocityMotion(ALPHA), np.array(U)
    own = together = np.array([[0.1], [0.1], [0.0]]) * rng.standard_normal((3, M))
    for _ in range(steps):
        own = motion.sample(own, u, rng)
        error = np.sqrt(motion.variances(u)) * rng.standard_normal(3)
        together = motion.mean(together, u + error * (1, 1, 0))
        together[2] = pf.wrap(together[2] + error[2] * u[2])
    return [np.sqrt(cloud[:2].var(axis=1).sum()) for cloud in (own, together)]


@experiment(
    """Own errors against common ones
    Start both clouds from the same 500 poses: 0.1 m of spread in x and y, heading 0.
    Use motion.sample(cloud, u, rng) for one, together(cloud, u, rng) for the other.
    The spread is np.sqrt(cloud[:2].var(axis=1).sum()); return own / common.""",
    points=2,
    after=rigid,
    runs=20,
    pool=300,
    claim="a cloud with common errors does not grow; one with errors of its own does",
    test="mean ratio of the spreads over 20 runs between 8.5 and 10.5",
    margin="the ratio has mean 9.47 and sd 0.35; the mean of 20 has 0.08: 12 standard errors",
)
def rigid_x(rng):
    own, together = _spreads(rng)
    return own / together


rigid_x.holds("the mean ratio lies between 8.5 and 10.5", lambda x: 8.5 < x.mean() < 10.5)
rigid_x.holds("the runs differ", lambda x: x.std() > 1e-6)
rigid_x.wrong("""upside-down: divides the common spread by the own one
    Which cloud is the wide one?
    The ratio should say how much wider own errors make the cloud.
    Return own / common.""")(lambda rng: 1 / rigid_x(rng), when=lambda x: (x < 0.5).all())
rigid_x.wrong("""both-own: gives both clouds errors of their own
    How many random numbers does a step of the second cloud draw?
    Three numbers for the whole cloud, not three for each particle.
    Use together(cloud, u, rng) for the second cloud.""")(
    lambda rng: _spreads(rng)[0] / _spreads(rng)[0], when=lambda x: 0.6 < x.mean() < 1.6
)
rigid_x.wrong("""variances: compares variances instead of standard deviations
    Is your ratio one of lengths or of squared lengths?
    A spread is a length: take the root.
    np.sqrt(cloud[:2].var(axis=1).sum())""")(
    lambda rng: rigid_x(rng) ** 2, when=lambda x: 60 < x.mean() < 220
)


def _split_sds(rng, M=2000, parts=16, scaled=False):
    """Standard deviations (m) of the distance: one step of four seconds, and in parts."""
    found = []
    for n in (1, parts):
        motion = pf.VelocityMotion((0.02 * (n if scaled else 1), 0, 0, 0))
        cloud = np.zeros((3, M))
        for _ in range(n):
            cloud = motion.sample(cloud, np.array((1.0, 0.0, 4.0 / n)), rng)
        found.append(cloud[0].std())
    return found


@experiment(
    """One step against sixteen
    Drive 2,000 particles straight for four seconds, twice: in one step and in sixteen.
    u is (1, 0, 4) once, and (1, 0, 0.25) sixteen times; alpha is (0.02, 0, 0, 0) both times.
    Return the standard deviation of x after one step over that after sixteen.""",
    points=2,
    after=split,
    runs=20,
    pool=300,
    claim="a drive cut into 16 steps has a quarter of the standard deviation",
    test="mean ratio over 20 runs between 3.8 and 4.2",
    margin="the ratio has mean 4 and sd 0.09; the mean of 20 has 0.02: 10 standard errors",
)
def split_x(rng, **kwargs):
    whole, parts = _split_sds(rng, **kwargs)
    return whole / parts


split_x.holds("the mean ratio lies between 3.8 and 4.2", lambda x: 3.8 < x.mean() < 4.2)
split_x.holds("the runs differ", lambda x: x.std() > 1e-6)
split_x.wrong("""variances: compares variances
    Is it a ratio of lengths or of squared lengths?
    The prediction speaks of standard deviations.
    Use .std(), not .var().""")(lambda rng: split_x(rng) ** 2, when=lambda x: 14 < x.mean() < 18)
split_x.wrong("""upside-down: finds the larger spread after the sixteen steps
    Is the ratio turned over, or do your two drives last differently long?
    Sixteen steps of 4 / 16 s each; the spread of the single step goes on top.
    Return whole / parts, with dt = 4 and dt = 0.25.""")(
    lambda rng: 1 / split_x(rng), when=lambda x: 0.2 < x.mean() < 0.3
)
split_x.wrong("""scaled: scales the noise with the number of steps
    Did you change alpha between the drives?
    The question is what happens to the same alpha.
    Keep alpha = (0.02, 0, 0, 0) for both.""")(
    lambda rng: split_x(rng, scaled=True), when=lambda x: 0.9 < x.mean() < 1.1
)

why = Text(
    """Why a banana, and why draw anew?
    says that an error in the turn rate changes heading and position together
    says that an early heading error acts on the whole way that follows
    says that particles are different guesses, so each needs errors of its own""",
    model="A wrong turn rate bends the track, so heading and position are wrong together. "
    "An early error acts over the whole way that follows, which bends the cloud into a banana. "
    "Each particle is a guess at what the robot did and needs errors of its own.",
)
