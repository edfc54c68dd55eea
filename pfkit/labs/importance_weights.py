"""Importance sampling and weights. What is a draw from the wrong density worth?"""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment

PREDICT = Question("Predictions")

narrow = Prediction("""Mean weight of 1,000 draws from a proposal 0.4 times as wide as the target
    a  about 1, a little above or below
    b* usually below 1, and now and then a run far above
    c  usually above 1
    d  exactly 1""")

dim = Prediction("""Share of particles that count in three dimensions
    a  one in ten as well
    b  one in thirty
    c  one in a hundred
    d* one in a thousand""")

HAND = Question("By hand")

hand = Numeric(
    """Normalised weight of each room
    Each draw of room 3 weighs 0.4; there are three of them.
    The unnormalised weights are 2.5, 1 and 3 times 0.4.
    Divide 2.5, 1 and 1.2 by their sum, 4.7.""",
    (0.532, 0.213, 0.255),
    tol=0.006,
    names=("room 1", "room 2", "room 3"),
)
hand.wrong("""not-normalised: is not divided by the sum of the weights
    Do they sum to one?
    Their sum is 4.7.
    Divide each by 4.7.""")((2.5, 1.0, 1.2))
hand.wrong("""upside-down: divides proposal by target instead of target by proposal
    Which room does the proposal draw too rarely?
    Room 1 is drawn too rarely, so its draws must count more.
    The weight of room 1 is .5 / .2.""")((0.0449, 0.1124, 0.8427))
hand.wrong("""counts: counts the draws and forgets the weights
    Is every draw worth the same?
    Multiply the counts 1, 1, 3 by 2.5, 1, 0.4.
    2.5, 1 and 1.2; then divide by 4.7.""")((0.2, 0.2, 0.6))

ess = Numeric(
    """Effective sample size of the five draws
    Square the five normalised weights, one for each draw.
    Normalised: .532, .213, and three times .0851.
    1 / (.532^2 + .213^2 + 3 * .0851^2).""",
    2.86,
    tol=0.02,
)
ess.wrong("""by-room: squares the weights of rooms, not of draws
    How many draws are there?
    Room 3 holds three draws; square each before you add.
    3 * .0851^2 instead of .255^2.""")(2.54)
ess.wrong("""not-normalised: uses weights that do not sum to one
    An effective sample size is at least 1.
    Normalise first, or use (sum w)^2 / sum w^2.
    4.7^2 / 7.73.""")(0.129)

IDEA = Question("Bias and worth")

unbiased = Choice("""What is true of every proposal that covers the target?
    a  the self-normalised estimate is unbiased
       = A ratio of two unbiased estimates has a bias, here of order 1/M.
    b* the mean of the unnormalised weights is an unbiased estimate of the missing constant
       = Yes: each weight has that expectation, and so has their mean.
    c  the variance of the estimate is finite
       = Only if the integral of p^2 / q is finite; thin proposal tails break it.
    d  the plain average of the draws is unbiased after enough draws
       = More draws make it the average under the proposal, ever more precisely.""")

threshold = Numeric(
    """The report's threshold as an effective sample size
    Put M = 1000 and s^2 = 4e-10 into the formula.
    M (M - 1) s^2 = 999000 * 4e-10.
    That is 0.0004, so ESS = 1000 / 1.0004.""",
    999.6,
    tol=0.06,
)
threshold.wrong("""no-scale: leaves the scale of the weights out: nothing is left of the
         variance
    Weights are of size 1 / M. Did you include M (M - 1)?
    M (M - 1) s^2 = 999000 * 4e-10 = 0.0004.
    1000 / (1 + 999000 * 4e-10).""")(1000.0, when=lambda x: abs(float(x) - 1000) < 0.05)
threshold.wrong("""sd: puts the root of the variance into the formula
    Which power of s stands in the formula?
    Use 4e-10 as it is.
    1000 / (1 + 999000 * 4e-10).""")(47.7)


def _matches_sets(f):
    rng = np.random.default_rng(5)
    for M in (2, 7, 400):
        w = rng.random(M) ** 2
        w /= w.sum()
        if not np.isclose(f(w.var(ddof=1), M), 1 / np.sum(w**2)):
            return f"for a set of {M} it gives {f(w.var(ddof=1), M):.6g}, not {1 / (w @ w):.6g}"
    return True


@code(
    """From the variance of the weights to the ESS
    It is the last formula, in code.
    Mind the M - 1: the variance was taken with M - 1.
    return M / (1 + M * (M - 1) * s2)""",
    fingerprint=lambda f: [f(1e-4, 100), f(2e-3, 17), f(0.0, 9)],
)
def from_variance(s2, M):
    return M / (1 + M * (M - 1) * s2)


from_variance.holds("equals 1 / sum of squares for random sets", _matches_sets)
from_variance.holds("equal weights are worth M", lambda f: np.isclose(f(0.0, 50), 50))
from_variance.holds("one weight of 1 is worth 1 particle", lambda f: np.isclose(f(1 / 50, 50), 1))
from_variance.wrong("""m-squared: takes the variance as if it had M in its denominator
    Which denominator does the report's variance have?
    With M - 1 in the variance, M^2 becomes M (M - 1).
    return M / (1 + M * (M - 1) * s2)""")(lambda s2, M: M / (1 + M * M * s2))
from_variance.wrong("""no-scale: forgets that normalised weights are of size 1 / M
    CV compares the spread with the mean. What is the mean weight?
    The mean is 1 / M, so CV^2 is about M^2 s^2.
    return M / (1 + M * (M - 1) * s2)""")(lambda s2, M: M / (1 + s2))

CODE = Question("Code")


def _draws(seed):
    rng = np.random.default_rng(seed)
    return rng.normal(size=40), rng.normal(size=40) - 1, rng.normal(size=40)


def _right(f):
    for seed in range(4):
        x, log_p, log_q = _draws(seed)
        w = np.exp(log_p - log_q)
        if not np.isclose(f(x, log_p, log_q), np.sum(w * x) / w.sum()):
            return False
    return True


def _constant_cancels(f):
    x, log_p, log_q = _draws(7)
    return np.isclose(f(x, log_p + 3.0, log_q), f(x, log_p, log_q))


def _tiny(f):
    x, log_p, log_q = _draws(8)
    return np.isclose(f(x, log_p - 5000.0, log_q), estimate(x, log_p, log_q))


def _mean_of_ratio(f, log_p, log_q):
    return np.mean(np.exp(np.asarray(log_p) - log_q) * f)


@code(
    """The self-normalised estimate
    log of target over proposal is log_p - log_q.
    Subtract the largest before you exponentiate, then divide by the sum.
    w = np.exp(l - l.max()); w /= w.sum(); return np.sum(w * f)""",
    fingerprint=lambda f: [f(*_draws(s)) for s in (1, 2, 3)],
)
def estimate(f, log_p, log_q):
    w = np.exp(pf.normalise(np.asarray(log_p) - np.asarray(log_q))[0])
    return np.sum(w * f)


estimate.holds("weights are target over proposal, divided by their sum", _right)
estimate.holds("a constant factor of the target makes no difference", _constant_cancels)
estimate.holds("targets of exp(-5000) do not underflow", _tiny)
estimate.wrong("""upside-down: weighs by proposal over target
    What makes a draw worth more: a high target or a high proposal?
    The weight is target over proposal.
    l = log_p - log_q""")(lambda f, log_p, log_q: estimate(f, log_q, log_p))
estimate.wrong("""target-only: weighs by the target and forgets the proposal
    Where the proposal draws often, should each draw count as much?
    Divide by the proposal.
    l = log_p - log_q""")(lambda f, log_p, log_q: estimate(f, log_p, np.zeros_like(log_p)))
estimate.wrong("""not-normalised: averages over M instead of dividing by the sum of the weights
    The target is known only up to a constant. Does yours cancel it?
    Divide by the sum of the weights, not by M.
    return np.sum(w * f) / np.sum(w)""")(_mean_of_ratio)


@estimate.wrong(
    """exponentiates before it subtracts the largest
    What is exp(-5000) in a computer?
    Subtract the largest logarithm first.
    l = l - l.max()""",
    when=lambda f: _right(f) and not _tiny(f),
)
def underflow(f, log_p, log_q):
    return _mean_of_ratio(f, log_p, log_q) / np.mean(np.exp(np.asarray(log_p) - log_q))


BREAK = Question("Experiments")


@experiment(
    """Mean weight under a narrow proposal
    Draw x with standard deviation 0.4, weigh by N(x; 0, 1) / N(x; 0, 0.16), average.
    Use pf.log_gaussian(x, 1) - pf.log_gaussian(x, 0.4).
    return np.exp(pf.log_gaussian(x, 1) - pf.log_gaussian(x, 0.4)).mean()""",
    points=2,
    after=narrow,
    runs=100,
    pool=1_500,
    claim="an unbiased mean weight is below 1 in most runs when the proposal is too narrow",
    test="at least 60 of 100 runs below 1, median between 0.7 and 0.95",
    margin="5 standard errors on both counts: binomial share 0.81, median 0.87 with sd 0.015",
)
def narrow_x(rng, s=0.4, M=1000):
    x = s * rng.standard_normal(M)
    return np.mean(np.exp(pf.log_gaussian(x, 1.0) - pf.log_gaussian(x, s)))


narrow_x.holds("at least 60 of 100 runs lie below 1", lambda x: np.sum(x < 1) >= 0.6 * x.size)
narrow_x.holds("the median lies between 0.7 and 0.95", lambda x: 0.7 < np.median(x) < 0.95)
narrow_x.holds("the runs differ", lambda x: x.std() > 1e-6)
narrow_x.wrong("""wide: draws from a proposal that is not narrow: its runs lie on both sides of
         1
    Which standard deviation do your draws have?
    Multiply standard normal draws by 0.4.
    x = 0.4 * rng.standard_normal(1000)""")(
    lambda rng: narrow_x(rng, 2.0), when=lambda x: 0.96 < np.median(x) < 1.1
)
narrow_x.wrong("""normalised: averages normalised weights, which is 1 / M whatever happens
    What is the mean of weights that sum to one?
    Use the unnormalised weights p / q.
    Do not divide by the sum.""")(lambda rng: 1e-3, when=lambda x: np.allclose(x, 1e-3))


@experiment(
    """Effective share in three dimensions
    Weights multiply over the directions, so log-weights add.
    pf.log_gaussian(x, 0.3).sum(axis=0) for x of shape (3, M).
    return pf.ess(pf.normalise(log_w)[0]) / M""",
    points=2,
    after=dim,
    runs=20,
    pool=1_500,
    claim="in three dimensions about one particle in a thousand counts",
    test="mean of 20 runs between 0.0009 and 0.0016",
    margin="the mean of 20 has sd 0.00005: 7 standard errors from either edge",
)
def dim_x(rng, D=3, M=20_000):
    x = rng.uniform(-5, 5, (D, M))
    return pf.ess(pf.normalise(pf.log_gaussian(x, 0.3).sum(axis=0))[0]) / M


dim_x.holds("mean share between 0.0009 and 0.0016", lambda x: 0.0009 < x.mean() < 0.0016)
dim_x.holds("every share is between 0 and 1", lambda x: (x > 0).all() and (x < 1).all())
dim_x.wrong("""one-dimension: measures one direction only
    How many components has the state?
    All three directions are measured.
    Add the log-likelihoods of the three directions.""")(
    lambda rng: dim_x(rng, 1), when=lambda x: abs(x.mean() - 0.106) < 0.02
)
dim_x.wrong("""not-a-share: returns a number of particles, not a share
    Divide by what?
    A share is at most 1.
    Divide by M.""")(lambda rng: dim_x(rng) * 20_000, when=lambda x: (x > 1).all())

why = Text(
    """Why is a narrow proposal dangerous?
    says that weights in the tails are unbounded or their variance infinite
    says that such draws are rare, so a typical run misses what they carry
    says that the ESS is computed from the draws in hand only""",
    model="In its tails the weights grow without bound and their variance can be infinite. "
    "Draws out there are so rare that a typical run misses what they would have carried. "
    "The effective sample size knows only the draws in hand: it overrates the set, and of a "
    "place that none of them visited it says nothing.",
)


LAB = Lab.of(__name__, "Importance sampling and weights")
__getattr__ = LAB.verb
