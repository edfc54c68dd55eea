"""Q3: the constant in the likelihood."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, code
from pfkit.labs.response import calls
from pfkit.labs.statistics import rng_of

Q3 = Question("The constant in the likelihood")

_LOGS = np.array([-1.0, -3.0, -2.5, -0.2])

_FAR_APART = np.array([0.0, -800.0, 1700.0, 1699.0])


def _fix(seed):
    rng = rng_of(seed)
    return rng.normal(0, 2, 2), rng.normal(0, 2, (2, 12)), 1.7


def _shifted(seed, by=(40.0, -30.0)):
    z, state, sigma = _fix(seed)
    return z + by, state + np.array(by)[:, None], sigma


def _integrates(f):
    """Sums of the density over a fine grid, for two sigmas."""
    axis = np.arange(-25.0, 25.0, 0.5)
    grid = np.stack(np.meshgrid(axis, axis)).reshape(2, -1)
    found = [float(np.exp(f(np.zeros(2), grid, s)).sum() * 0.25) for s in (2.0, 3.0)]
    return max(abs(v - 1) for v in found) < 1e-3 or f"it gives {found[0]:.3g} and {found[1]:.3g}"


q3a = Choice("""Leave the constant out: what happens to the normalised weights?
    a* Nothing
       = Yes: every particle has the same factor, and normalising divides it out.
    b  They become larger
       = All likelihoods do, by the same factor; then the weights are normalised.
    c  They no longer sum to one
       = They are divided by their sum, whatever it is.
    d  Particles far away gain weight
       = A common factor changes no ratio between particles.""")

q3b = Choice("""Where does it matter, then?
    a  Nowhere in a particle filter
       = It cancels in the weights; some steps use likelihoods not yet normalised.
    b  In the mean of the particles
       = The mean uses normalised weights.
    c  In the effective sample size
       = The ESS uses normalised weights.
    d* In a gate on the likelihood, in a mixture with outliers, in the evidence
       = Yes: there likelihoods are compared with a number, or with each other.""")


@code(
    """Log-likelihood of a position, with its constant
    Write down the density of a Gaussian in two dimensions, then take its logarithm.
    The logarithm of exp(a) is a: no exp is needed.
    -(dx^2 + dy^2)/(2 sigma^2) - log(2 pi sigma^2).""",
    id="q3c",
    points=3,
    fingerprint=lambda f: [*f(*_fix(1)), *f(np.array([60.0, 0]), np.zeros((2, 1)), 1.0)],
)
def log_likelihood(z, state, sigma):
    """log p(z | x) at every particle: z (2,), state (2, M), sigma in px; result (M,)."""
    dx, dy = z[0] - state[0], z[1] - state[1]
    return -(dx**2 + dy**2) / (2 * sigma**2) - np.log(2 * np.pi * sigma**2)


log_likelihood.holds("one number per particle", lambda f: np.shape(f(*_fix(0))) == (12,))
log_likelihood.holds(
    "a distance of one sigma costs 1/2",
    lambda f: np.isclose(
        f(np.zeros(2), np.zeros((2, 1)), 3.0)[0] - f(np.array([3.0, 0]), np.zeros((2, 1)), 3.0)[0],
        0.5,
    ),
)
log_likelihood.holds(
    "x and y errors add up: (3, 4) px costs as much as (5, 0)",
    lambda f: np.isclose(
        f(np.array([3.0, 4]), np.zeros((2, 1)), 2.0)[0],
        f(np.array([5.0, 0]), np.zeros((2, 1)), 2.0)[0],
    ),
)
log_likelihood.holds(
    "only the difference counts: shift z and all particles, and nothing changes",
    lambda f: np.allclose(f(*_fix(2)), f(*_shifted(2))),
)
log_likelihood.holds("the density integrates to one", _integrates)
log_likelihood.holds(
    "finite and ordered at 5,000 and 10,000 sigma",
    lambda f: (
        -np.inf
        < f(np.array([1e4, 0.0]), np.zeros((2, 1)), 1.0)[0]
        < f(np.array([5e3, 0.0]), np.zeros((2, 1)), 1.0)[0]
    ),
)
log_likelihood.holds(
    "it is your own: no call of pf.Position",
    lambda f: not calls(lambda: f(*_fix(3)), pf.Position),
)


def _d2(z, state):
    return (z[0] - state[0]) ** 2, (z[1] - state[1]) ** 2


@log_likelihood.wrong("""lacks the 1/2 in the exponent
    Integrate your density over the image. You get one half.
    Compare your exponent with the one in the question, factor by factor.
    Exponent: -(dx^2 + dy^2) / (2 sigma^2).""")
def no_half(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / sigma**2 - np.log(2 * np.pi * sigma**2)


@log_likelihood.wrong("""returns the density itself, not its logarithm
    Far away your value is 0. What should a logarithm be there?
    The question asks for log p, which is negative and large far away.
    Take the logarithm on paper: -(dx^2 + dy^2)/(2 sigma^2) - log(2 pi sigma^2).""")
def no_logarithm(z, state, sigma):
    dx, dy = _d2(z, state)
    return np.exp(-(dx + dy) / (2 * sigma**2)) / (2 * np.pi * sigma**2)


@log_likelihood.wrong("""behaves like an average of the two likelihoods, where both must hold at
         once
    Put a particle right in x and 100 px wrong in y. Is it half right?
    Independent measurements multiply: p(zx, zy | x) = p(zx | x) p(zy | x).
    In logarithms: add the two terms, with no division by two.""")
def averaged(z, state, sigma):
    dx, dy = _d2(z, state)
    one = 1 / (np.sqrt(2 * np.pi) * sigma)
    return np.log((one * np.exp(-dx / 2 / sigma**2) + one * np.exp(-dy / 2 / sigma**2)) / 2)


@log_likelihood.wrong("""uses sigma where the density has sigma squared
    Check the units: px^2 in the exponent must be divided by px^2.
    sigma is a standard deviation; the Gaussian divides by its square.
    Exponent: -(dx^2 + dy^2) / (2 sigma^2).""")
def sigma_for_variance(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / (2 * sigma) - np.log(2 * np.pi * sigma)


@log_likelihood.wrong("""has the normalising constant of one dimension
    Integrate your density over the image. Do you get 1?
    Two independent components bring their constant twice.
    The constant is 1/(2 pi sigma^2).""")
def constant_1d(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / (2 * sigma**2) - np.log(np.sqrt(2 * np.pi) * sigma)


@log_likelihood.wrong("""leaves the normalising constant out
    It cancels in the weights. This item asks for the density itself.
    Integrate your density over the image. Do you get 1?
    Subtract log(2 pi sigma^2).""")
def no_constant(z, state, sigma):
    dx, dy = _d2(z, state)
    return -(dx + dy) / (2 * sigma**2)


@log_likelihood.wrong("""takes the logarithm of an exponential, which is 0 far away, so you get
         -inf
    What is np.exp(-1000)? And its logarithm?
    Write the logarithm of the formula down, and let exp and log cancel on paper.
    log p = -(dx^2 + dy^2)/(2 sigma^2) - log(2 pi sigma^2), without any exp.""")
def underflow(z, state, sigma):
    dx, dy = _d2(z, state)
    return np.log(np.exp(-(dx + dy) / (2 * sigma**2)) / (2 * np.pi * sigma**2))


@log_likelihood.wrong("""hides the underflow behind a small added number
    Two particles at 50 and at 5,000 sigma: does yours still prefer the nearer one?
    The floor makes all far particles equal, and the filter then resamples at random.
    Stay with logarithms; then no floor is needed.""")
def floor(z, state, sigma):
    dx, dy = _d2(z, state)
    return np.log(np.exp(-(dx + dy) / (2 * sigma**2)) / (2 * np.pi * sigma**2) + 1e-300)


@log_likelihood.refuses("adds z and the state")
def added(z, state, sigma):
    return log_likelihood(z, -state, sigma)


@log_likelihood.refuses("takes the distance itself, not its square")
def distance_itself(z, state, sigma):
    dx, dy = _d2(z, state)
    return -np.sqrt(dx + dy) / (2 * sigma) - np.log(2 * np.pi * sigma**2)


@log_likelihood.refuses("adds up |dx| and |dy| before it squares")
def city_block(z, state, sigma):
    d = np.abs(z[0] - state[0]) + np.abs(z[1] - state[1])
    return -(d**2) / (2 * sigma**2) - np.log(2 * np.pi * sigma**2)


@log_likelihood.refuses("has a constant with pi for 2 pi")
def half_constant(z, state, sigma):
    return log_likelihood(z, state, sigma) + np.log(2)


@log_likelihood.refuses("cuts the exponent off at -700")
def cut_off(z, state, sigma):
    return np.maximum(log_likelihood(z, state, sigma), -700)


@log_likelihood.refuses("adds the logarithms of all particles up")
def added_up(z, state, sigma):
    return log_likelihood(z, state, sigma).sum()


@log_likelihood.refuses("has the tails of another distribution")
def student(z, state, sigma):
    dx, dy = _d2(z, state)
    return -2 * np.log1p((dx + dy) / (2 * sigma**2)) - np.log(2 * np.pi * sigma**2)


@log_likelihood.refuses("calls the library")
def library(z, state, sigma):
    return pf.Position(sigma).log_likelihood(z[:, None], state)


@code(
    """Weights from log-likelihoods
    A constant added to all logarithms cancels when you normalise. Add a good one.
    Subtract the largest logarithm before exp: then the best particle has exp(0) = 1.
    w = np.exp(log_l - log_l.max()); w / w.sum().""",
    id="q3d",
    fingerprint=lambda f: [*f(_LOGS), *np.nan_to_num(f(_LOGS - 2e4), nan=-1.0)],
)
def weights_of(log_l):
    """Normalised weights (M,) from log-likelihoods log_l (M,)."""
    w = np.exp(log_l - log_l.max())
    return w / w.sum()


weights_of.holds(
    "they sum to one, in the right proportions",
    lambda f: np.allclose(f(_LOGS), np.exp(_LOGS) / np.exp(_LOGS).sum()),
)
weights_of.holds(
    "a constant added to all changes nothing: the factor cancels",
    lambda f: np.allclose(f(_LOGS - np.log(2 * np.pi * 9.0)), f(_LOGS)),
)
weights_of.holds(
    "20,000 below zero they are still right",
    lambda f: np.allclose(f(_LOGS - 2e4), weights_of(_LOGS)),
)


weights_of.holds(
    "they are right where the best is 2,500 above the worst, whatever stands first",
    lambda f: np.allclose(f(_FAR_APART), weights_of(_FAR_APART)),
)


@weights_of.wrong("""divides 0 by 0 where all likelihoods underflow
    What is np.exp(-20000)? And the sum of such numbers?
    Only differences between the logarithms matter.
    Subtract the largest logarithm before you take exp.""")
def underflow_(log_l):
    w = np.exp(log_l)
    return w / w.sum()


@weights_of.wrong("""makes all weights equal where all likelihoods underflow: the measurement is
         forgotten
    One of four particles is 16 times as likely as another. Do yours show it far away?
    That repair hides the underflow; it does not undo it.
    Subtract the largest logarithm before you take exp.""")
def all_equal(log_l):
    w = np.exp(log_l)
    return w / w.sum() if w.sum() > 0 else np.full(len(w), 1 / len(w))


weights_of.wrong("""not-normalised: gives the best particle the weight 1 and does not normalise
    What do your weights sum to?
    Subtracting the maximum is the first half of the work.
    Divide by w.sum().""")(lambda log_l: np.exp(log_l - np.max(log_l)))
weights_of.wrong("""logarithms: normalises the logarithms themselves
    Your least likely particle has the largest weight.
    A weight is proportional to the likelihood, not to its logarithm.
    Take exp first, then divide by the sum.""")(lambda log_l: log_l / np.sum(log_l))


@weights_of.wrong("""has the sign of the exponent wrong
    Which particle has the largest log-likelihood, and which the largest weight?
    The likelihood is exp(log_l), not exp(-log_l).
    w = np.exp(log_l - log_l.max()).""")
def sign(log_l):
    w = np.exp(np.min(log_l) - log_l)
    return w / w.sum()


@weights_of.refuses("subtracts the mean: large ones overflow")
def minus_mean(log_l):
    w = np.exp(log_l - np.mean(log_l))
    return w / w.sum()


@weights_of.refuses("subtracts the least: large ones overflow")
def minus_least(log_l):
    w = np.exp(log_l - np.min(log_l))
    return w / w.sum()


@weights_of.refuses("subtracts the first, so all depends on the order")
def minus_first(log_l):
    w = np.exp(log_l - log_l[0])
    return w / w.sum()


@weights_of.refuses("takes powers of 2 for those of e")
def powers_of_two(log_l):
    w = 2.0 ** (log_l - np.max(log_l))
    return w / w.sum()


@weights_of.refuses("adds a small number against 0/0", named="all-equal")
def small_number(log_l):
    w = np.exp(log_l) + 1e-300
    return w / w.sum()


@weights_of.refuses("cuts the logarithms off at -700", named="all-equal")
def cut_logarithms(log_l):
    w = np.exp(np.maximum(log_l, -700))
    return w / w.sum()


@weights_of.refuses("gives all weight to the best")
def winner(log_l):
    return (log_l == np.max(log_l)) / np.sum(log_l == np.max(log_l))
