"""P7: the luck of resampling."""

from __future__ import annotations

import math

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, experiment
from pfkit.labs.statistics import shaped
from pfkit.labs.target import around, target_log

P7 = Question("Sample variance")

FILM = target_log("fixed", "low")
HOME = FILM.start[:2]
W5 = np.array([0.40, 0.25, 0.15, 0.12, 0.08])


def _copies(f, rng, runs):
    schemes = (pf.multinomial, pf.systematic)
    return np.stack([shaped(f(s, W5, rng, runs), runs, 5) for s in schemes], axis=1)


def _multinomial_variance(x):
    """Each variance within 30 % of M w (1 - w): five standard errors for 1,000 runs."""
    ratio = x[:, 0].var(axis=0, ddof=1) / (5 * W5 * (1 - W5))
    return (np.abs(ratio - 1) < 0.3).all()


@experiment(
    """Variance of the number of copies
    Count how often each index occurs in the result of scheme(w, rng).
    np.bincount counts; minlength keeps particles that got no copy.
    np.bincount(scheme(w, rng), minlength=len(w)), once per run, stacked.""",
    id="p7a",
    points=2,
    claim="both schemes give M w copies on average; the variance is M w (1 - w) for "
    "multinomial and at most 1/4 for systematic",
    test="means within 5 standard errors, variances within 30 %, systematic at most .26",
    runs=1000,
    pool=10_000,
    margin="5 standard errors in 15 comparisons: 1e-5",
    measure=_copies,
)
def copies(scheme, w, rng, runs):
    """How many copies each particle got in each run: (runs, M)."""
    return np.stack([np.bincount(scheme(w, rng), minlength=len(w)) for _ in range(runs)])


copies.holds(
    "mean number of copies is M w, both schemes",
    lambda x: (
        np.abs(x.mean(0) - 5 * W5) <= 5 * x.std(0, ddof=1) / math.sqrt(len(x)) + 1e-12
    ).all(),
)
copies.holds("multinomial variance is M w (1 - w)", _multinomial_variance)
copies.holds(
    "systematic variance is at most 1/4", lambda x: x[:, 1].var(axis=0, ddof=1).max() <= 0.26
)
copies.wrong("""shares: gives shares of the set, not numbers of copies
    Your row sums are 1. How many particles are there?
    Copies are whole numbers that sum to M.
    Do not divide by M.""")(
    lambda s, w, rng, runs: copies(s, w, rng, runs) / len(w),
    when=lambda x: np.allclose(x.sum(axis=-1), 1),
)
copies.wrong("""yes-or-no: tells only whether a particle survived
    Can a particle have two copies in your table?
    Survival is 0 or 1; copies are 0, 1, 2, ...
    Count with np.bincount(scheme(w, rng), minlength=len(w)).""")(
    lambda s, w, rng, runs: (copies(s, w, rng, runs) > 0).astype(float),
    when=lambda x: x.max() == 1 and x.sum(axis=-1).max() > 1,
)
copies.wrong("""one-call: calls the scheme once and repeats the result
    All your rows are equal.
    Each run needs a call of its own.
    Put scheme(w, rng) inside the loop over runs.""")(
    lambda s, w, rng, runs: np.tile(copies(s, w, rng, 1), (runs, 1)),
    when=lambda x: (x == x[0]).all(),
)


@experiment(
    """Resample always, or only when the ESS is low?
    One number per run: the mean of x at the end, minus the true x.
    pf.step has the arguments scheme and threshold.
    Loop over lab.film[:50] with pf.step(..., pf.multinomial, threshold).""",
    id="p7b",
    points=2,
    claim="with measurements that say little, resampling at every frame makes the final "
    "estimate more than twice as variable as resampling below ESS = M/2",
    test="ratio of the variances over runs > 2",
    runs=100,
    margin="ratio 45, sd of its logarithm .2: 15 standard errors above 2",
    measure=lambda f, rng, runs: np.stack(
        [shaped(f(threshold, rng, runs), runs) for threshold in (1.0, 0.5)], axis=1
    ),
)
def final_error(threshold, rng, runs):
    """Error in x after 50 frames that say little: 100 particles, multinomial resampling."""
    bel = around(HOME, (runs, 100), rng, sigma=20.0)
    motion, sensor = pf.FixedTarget(0.0), pf.Position(300.0)
    for _, u, z, _ in FILM[:50]:
        bel, _ = pf.step(bel, u, z, motion, sensor, rng, pf.multinomial, threshold)
    return pf.mean_pose(bel)[0] - HOME[0]


final_error.holds(
    "the errors average out: mean within 5 standard errors of 0",
    lambda x: (np.abs(x.mean(0)) < 5 * x.std(0, ddof=1) / math.sqrt(len(x)) + 0.1).all(),
)
final_error.holds(
    "always resampling: more than twice the variance",
    lambda x: x[:, 0].var() > 2 * x[:, 1].var() or f"variances {x.var(0).round(1)} px^2",
)
final_error.wrong("""threshold-unused: gives the same in both cases: it ignores the threshold,
         or the scheme is not multinomial
    Your two variances agree. Where do threshold and scheme enter?
    pf.step resamples if ESS < threshold * M, by the scheme you pass.
    End the call with pf.multinomial, threshold.""")(
    lambda threshold, rng, runs: final_error(0.5, rng, runs),
    when=lambda x: 0.5 < x[:, 0].var() / x[:, 1].var() < 2,
)
final_error.wrong("""absolute-error: returns distances, whose mean is not zero
    Can your errors be negative?
    The variance of an estimate needs the signed error.
    Return the mean of x minus the true x, without abs or hypot.""")(
    lambda threshold, rng, runs: np.abs(final_error(threshold, rng, runs)),
    when=lambda x: x.min() >= 0,
)

p7c = Choice("""Which schemes never make an estimate more variable than multinomial?
    a  Systematic, because its numbers of copies vary least
       = Its teeth are linked; with alternating weights it was 333 times worse.
    b  All schemes that are unbiased
       = Unbiased says nothing about variance, and multinomial is unbiased too.
    c* Stratified and residual
       = Yes, this is proved for both; systematic is often better still, not always.
    d  None: it depends on the particles
       = It does for systematic; for stratified and residual there is a proof.""")
