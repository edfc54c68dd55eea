"""The log-likelihood of a set of readings."""

import numpy as np

import pfkit as pf
from pfkit.labs import code
from pfkit.labs.sensing.there_and_back import expected, poses_at_random


def _errors(z, m, pose):
    """Range and bearing errors (2, K, M), bearings not wrapped."""
    d = np.asarray(m)[:, :, None] - pose[:2, None]
    r, phi = np.asarray(z)[:, :, None]
    return r - np.hypot(*d), phi - (np.arctan2(d[1], d[0]) - pose[2])


def _parts(z, m, pose, sigma_r, sigma_phi):
    e_r, e_phi = _errors(z, m, pose)
    return pf.log_gaussian(e_r, sigma_r), pf.log_gaussian(pf.wrap(e_phi), sigma_phi)


def readings(seed=0, K=3, M=30):
    """Readings, landmarks, poses and both sigmas."""
    rng = np.random.default_rng(seed)
    m, pose = rng.uniform(-5, 5, (2, K)), poses_at_random(seed + 50, M)
    z = np.array([expected(pose[:, 0], mk) for mk in m.T]).T
    return z + 0.1 * rng.standard_normal(z.shape), m, pose, 0.5, 0.4


def _scores(f):
    case = readings(2)
    return np.allclose(f(*case), score(*case), rtol=1e-9, atol=1e-9)


def _one_at_a_time(f):
    z, m, pose, *sigmas = readings(3)
    alone = [f(z[:, k : k + 1], m[:, k : k + 1], pose, *sigmas) for k in range(3)]
    return np.allclose(f(z, m, pose, *sigmas), np.sum(alone, axis=0), rtol=1e-9, atol=1e-9)


def _seam(f):
    """A landmark right behind the robot, seen over the seam of the circle."""
    pose = np.array([[0.0, 0.0], [0.0, 0.0], [3.1, -3.1]])
    z, m = np.array([[2.0], [0.0]]), np.array([[-2.0], [0.0]])
    return np.allclose(f(z, m, pose, 0.5, 0.4), score(z, m, pose, 0.5, 0.4))


def _tiny(f):
    z, m, pose, _, _ = readings(4)
    found = np.asarray(f(z, m, pose, 1e-3, 1e-3))
    return np.isfinite(found).all()


@code(
    """Log-likelihood of K ranges and bearings
    Errors first: range minus expected range, bearing minus expected bearing, wrapped.
    pf.log_gaussian(error, sigma) for each; logs of a product add up.
    Sum over the K measurements, axis 0 of an array (K, M), ranges and bearings both.""",
    points=2,
    fingerprint=lambda f: np.ravel(f(*readings(5))),
)
def score(z, m, pose, sigma_r, sigma_phi):
    r, phi = _parts(z, m, pose, sigma_r, sigma_phi)
    return (r + phi).sum(axis=0)


score.holds("the sum of all Gaussian log densities", _scores)
score.holds("three together say what each says alone, added up", _one_at_a_time)
score.holds("a bearing error is short, even across the seam at pi", _seam)
score.holds("thousands of deviations off stay finite", _tiny)


@score.wrong("""averages the likelihoods
    Which excuse does a good range give a bad bearing?
    Independent densities multiply, so their logs add up.
    Return the sum of the log densities.""")
def averages(*case):
    parts = np.concatenate(_parts(*case))
    return np.logaddexp.reduce(parts) - np.log(len(parts))


score.wrong("""mean-log: averages the log-likelihoods
    Should ten measurements count no more than one?
    Logs of a product add up; do not divide.
    Use sum, not mean.""")(lambda *case: score(*case) / case[0].shape[1])


@score.wrong("""does not wrap the bearing error
    How far is a bearing of 3.1 from one of -3.1?
    Wrap the difference before you square it.
    pf.wrap(phi - phi_hat)""")
def no_wrap(z, m, pose, sigma_r, sigma_phi):
    e_r, e_phi = _errors(z, m, pose)
    return (pf.log_gaussian(e_r, sigma_r) + pf.log_gaussian(e_phi, sigma_phi)).sum(axis=0)


score.wrong("""no-heading: forgets the heading in the bearing
    Two particles at one place look in two directions. Do they score alike?
    Subtract the heading from the direction on the map.
    arctan2(dy, dx) - theta""")(
    lambda z, m, pose, *sigmas: score(z, m, pose * np.array([[1], [1], [0]]), *sigmas)
)
score.wrong("""first-only: scores the first landmark only
    How many columns has z?
    Every column is a measurement.
    Sum over all K of them.""")(lambda z, m, *rest: score(z[:, :1], m[:, :1], *rest))
score.wrong("""variance: takes the standard deviation for a variance
    Which unit has sigma_r?
    Metres, not square metres: it is squared in the exponent.
    pf.log_gaussian takes the standard deviation as it is.""")(
    lambda z, m, pose, a, b: score(z, m, pose, np.sqrt(a), np.sqrt(b))
)


@score.wrong("""leaves out the constant of the Gaussians
    Your weights are right. Is your density?
    The constant cancels in the weights, but not in the evidence.
    Add -log(sigma sqrt(2 pi)) for each, or use pf.log_gaussian.""")
def _no_constant(z, m, pose, sigma_r, sigma_phi):
    e_r, e_phi = _errors(z, m, pose)
    return -0.5 * ((e_r / sigma_r) ** 2 + (pf.wrap(e_phi) / sigma_phi) ** 2).sum(axis=0)


@score.wrong(
    """multiplies ordinary densities, which underflow to zero
    What is exp(-1000) in a computer?
    Never leave the logarithms.
    Add log densities; do not take the log of a product.""",
    when=lambda f: _scores(f) and not _tiny(f),
)
def underflow(z, m, pose, sigma_r, sigma_phi):
    with np.errstate(divide="ignore"):
        parts = np.exp(_parts(z, m, pose, sigma_r, sigma_phi))
        return np.log(parts.prod(axis=(0, 1)))
