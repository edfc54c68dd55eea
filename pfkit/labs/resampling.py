"""Resampling variance. What does the copying cost?"""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment

PREDICT = Question("Predictions")

FIVE = np.array([0.40, 0.25, 0.15, 0.12, 0.08])

clock = Prediction("""Resamplings until one of two equal clusters of 100 particles is lost
    a  never, the weights are equal
    b  about 10
    c* about 140
    d  about 10,000""")

best = Prediction("""Does an average after systematic resampling always scatter less?
    a  yes, always
    b  yes, if there are enough particles
    c  no, but at worst it scatters a few per cent more
    d* no, its variance can be hundreds of times larger""")

HAND = Question("By hand")

hand = Numeric(
    """Copies for U = 0.2
    Where are the five teeth? The first is at 0.2 / 5.
    Teeth at .04, .24, .44, .64, .84; edges at .40, .65, .80, .92, 1.
    Two teeth lie below .40, two more below .65, none below .80, one below .92.""",
    (2, 2, 0, 1, 0),
    tol=0.01,
    names=("particle 1", "particle 2", "particle 3", "particle 4", "particle 5"),
)
hand.wrong("""indices: lists which particle each tooth picks, not how many copies each particle
         gets
    Do your five numbers add up to five?
    Count how often each particle is picked.
    Picks 1, 1, 2, 2, 4 make 2, 2, 0, 1, 0 copies.""")((1, 1, 2, 2, 4))
hand.wrong("""rounded: rounds M w to the nearest whole number, whatever U is
    Would another U change your answer?
    Put the teeth at (k + 0.2) / 5 and see what they touch.
    The third particle reaches from .65 to .80: is there a tooth?""")((2, 1, 1, 1, 0))

variance = Numeric(
    """Variance of the copies of the second particle
    Multinomial: M w (1 - w) with M = 5.
    Systematic: M w = 1.25, so the fraction is 0.25.
    5 * .25 * .75 and .25 * .75.""",
    (0.9375, 0.1875),
    tol=0.002,
    names=("multinomial", "systematic"),
)
variance.wrong("""no-m: forgets the factor M of the binomial variance
    How many points are thrown?
    Five points, each hits with .25.
    5 * .25 * .75.""")((0.1875, 0.1875))
variance.wrong("""sd: gives standard deviations
    The question asks for the variance.
    Do not take the root.
    5 * .25 * .75 and .25 * .75.""")((0.9682, 0.4330))

survive = Numeric(
    """Survival of w = .012 among 100
    Multinomial dies only if all 100 points miss.
    One point misses with probability 1 - .012.
    1 - .988^100; and M w = 1.2 teeth are at least one.""",
    (0.701, 1.0),
    tol=0.002,
    names=("multinomial", "systematic"),
)
survive.wrong("""sign: has the sign error of the printed formula
    Should a heavier particle be missed more often?
    A point misses with 1 - w = 1 - 1/M - eps.
    1 - .988^100, not 1 - .992^100.""")((0.552, 1.0))
survive.wrong("""above-one: gives a probability above 1
    Can a probability be 1.2?
    Where M w is 1 or more, a tooth is certain.
    min(1, M w) = 1.""")((0.701, 1.2))

CODE = Question("Code")


def _count(f, w, seed):
    found = np.asarray(f(w.copy(), np.random.default_rng(seed)))
    return np.bincount(found, minlength=w.size)


def _draws(f, w=FIVE, runs=300):
    return np.stack([_count(f, w, seed) for seed in range(runs)])


def _indices(f):
    found = np.asarray(f(FIVE.copy(), np.random.default_rng(0)))
    return found.shape == (5,) and found.dtype.kind in "iu" and found.max() < 5


def _unbiased(f):
    N = _draws(f)
    error = N.std(axis=0, ddof=1) / np.sqrt(len(N))
    return (np.abs(N.mean(axis=0) - 5 * FIVE) <= 5 * error + 1e-9).all()


def _floor_ceil(f):
    uneven = np.array([0.1, 0.2, 0.3, 0.4])  # strata can give the second of these two copies
    return all(
        bool((np.abs(_draws(f, w, 100) - w.size * w) < 1 + 1e-9).all()) for w in (FIVE, uneven)
    )


def _zeros(f):
    w = np.array([0.0, 0.5, 0.0, 0.5, 0.0])
    return (_draws(f, w, 100)[:, [0, 2, 4]] == 0).all()


def _rough(f):
    w = np.full(100, 0.9997 / 100)  # sums to one to three digits only
    return _draws(f, w, 200).max() <= 2


def _teeth(w, rng, spacing=None):
    M = w.size
    return (np.arange(M) / (spacing or M)) + rng.random() / M


def _edges(w):
    edges = np.cumsum(w / np.sum(w))
    edges[-1] = np.inf
    return edges


@code(
    """The comb as a function
    Teeth (k + U) / M, edges = summed weights.
    np.searchsorted(edges, teeth) finds the particle under each tooth.
    Divide the edges by the last one first.""",
    points=2,
    fingerprint=lambda f: np.stack([f(FIVE.copy(), np.random.default_rng(s)) for s in range(6)]),
)
def comb(w, rng):
    return pf.systematic(w, rng)


comb.holds("returns M whole numbers below M", _indices)
comb.holds("M w copies on average, within 5 standard errors over 300 draws", _unbiased)
comb.holds("floor or ceiling of M w copies, every time", _floor_ceil)
comb.holds("a weight of zero gets no copy", _zeros)
comb.holds("weights that sum to 0.9997 are no trouble", _rough)
comb.wrong("""off-by-one: picks the neighbour of the particle under the tooth
    Which particle does a tooth at .04 touch?
    The summed weights are right edges: the first is w of particle 0.
    No leading zero in the edges, and no + 1.""")(
    lambda w, rng: np.minimum(np.searchsorted(np.append(0, _edges(w)), _teeth(w, rng)), w.size - 1)
)
comb.wrong("""stratified: is stratified: it draws a random number for each tooth
    How many random numbers does a comb need?
    All teeth of a comb share one offset.
    Draw rng.random() without an argument.""")(
    lambda w, rng: pf.stratified(w, rng),
    when=lambda f: _unbiased(f) and not _floor_ceil(f) and _draws(f, runs=60)[:, 0].std() == 0,
)
comb.wrong("""multinomial: is multinomial: it throws M independent points
    How many random numbers does a comb need?
    Draw rng.random() once, without an argument.
    teeth = (np.arange(M) + rng.random()) / M""")(
    lambda w, rng: rng.choice(w.size, w.size, p=w / w.sum()),
    when=lambda f: _unbiased(f) and not _floor_ceil(f),
)
comb.wrong("""short: spaces the teeth by 1 / (M - 1)
    Where is your last tooth? Can it lie beyond the bar?
    M teeth cover the bar with M gaps of 1 / M.
    teeth = (np.arange(M) + rng.random()) / M""")(
    lambda w, rng: np.searchsorted(_edges(w), _teeth(w, rng, w.size - 1))
)
comb.wrong("""run-off: trusts that the weights sum to one
    What if the weights sum to 0.9997?
    A tooth at 0.9998 then lies beyond the last edge.
    Divide the edges by the last one.""")(
    lambda w, rng: np.searchsorted(np.cumsum(w), _teeth(w, rng)),
    when=lambda f: _floor_ceil(f) and _zeros(f) and _unbiased(f),
)


@code(
    """The leftovers of the residual scheme
    Particle 2 expects 1.25 copies and has 1 for certain.
    The leftover is M w minus its floor.
    rest = w.size * w - np.floor(w.size * w); divide by its sum.""",
    fingerprint=lambda f: np.concatenate((f(FIVE.copy()), f(np.array([0.7, 0.2, 0.1])))),
    atol=1e-6,
)
def leftover(w):
    rest = w.size * w - np.floor(w.size * w)
    return rest / rest.sum()


leftover.holds("none is negative", lambda f: (np.asarray(f(FIVE.copy())) >= 0).all())
leftover.holds("they sum to one", lambda f: np.isclose(np.sum(f(FIVE.copy())), 1))
leftover.holds(
    "the five particles have 0, .125, .375, .3, .2",
    lambda f: np.allclose(f(FIVE.copy()), [0, 0.125, 0.375, 0.3, 0.2], atol=1e-6),
)


@leftover.wrong("""subtracts the copies from w instead of from M w, as a popular library does
    Can a leftover be negative?
    Copies are counted in particles; so must be what they are subtracted from.
    w.size * w - np.floor(w.size * w)""")
def as_printed(w):
    rest = w - np.floor(w.size * w)
    return rest / rest.sum()


leftover.wrong("""not-normalised: leaves the leftovers unnormalised
    Do they sum to one?
    Here they sum to R = 2.
    Divide by the sum.""")(lambda w: w.size * w - np.floor(w.size * w))
leftover.wrong("""plain: draws the rest with the full weights
    Particle 1 already has both of its copies. May it win more?
    Draw the rest with what is left over.
    w.size * w - np.floor(w.size * w)""")(lambda w: w / w.sum())

LUCK = Question("Luck")


@experiment(
    """The drift clock
    Start with 50 of 100 particles in cluster A and resample until A has 0 or 100.
    Equal weights: the new number in A is rng.binomial(100, k / 100).
    Count how often the loop ran.""",
    points=2,
    after=clock,
    runs=150,
    pool=1_500,
    claim="two clusters of 50 last about 2 N ln 2 = 139 multinomial resamplings",
    test="mean of 150 runs between 95 and 185 (exact: 136.6)",
    margin="the mean of 150 has a standard error of about 8: 5 and 6 of them",
)
def clock_x(rng, N=100):
    k, age = N // 2, 0
    while 0 < k < N:
        k, age = rng.binomial(N, k / N), age + 1
    return age


clock_x.holds("whole numbers of at least 1", lambda x: (x >= 1).all() and (x % 1 == 0).all())
clock_x.holds("mean of the runs between 95 and 185", lambda x: 95 < x.mean() < 185)
clock_x.holds("the runs differ, as luck does", lambda x: x.std() > 20)
clock_x.wrong("""half: starts with 50 particles in all, not 50 in each cluster
    How many particles are there together?
    N is 100.
    k = 50; N = 100.""")(lambda rng: clock_x(rng, 50), when=lambda x: 45 < x.mean() < 95)
clock_x.wrong("""double: starts with 100 particles in each cluster
    How many particles are there together?
    N is 100.
    k = 50; N = 100.""")(lambda rng: clock_x(rng, 200), when=lambda x: x.mean() > 200)
clock_x.refuses("a constant at the right value")(lambda rng: 137)


@experiment(
    """Copies of the 500 heavy particles under the comb
    w = np.tile([1.5, 0.5], 500) / 1000; the heavy ones have even indices.
    pf.systematic(w, rng) returns indices; count the even ones.
    return np.sum(pf.systematic(w, rng) % 2 == 0)""",
    points=2,
    after=best,
    runs=100,
    pool=1_500,
    claim="with weights in step with the comb, the total of the heavy copies is 500 or 1,000",
    test="variance of 100 runs above 20,000 (multinomial: 188), mean between 600 and 900",
    margin="the mean has a standard error of 25: 6 of them",
)
def best_x(rng, scheme=pf.systematic, M=1000):
    w = np.tile([1.5, 0.5], M // 2) / M
    return np.sum(scheme(w, rng) % 2 == 0)


best_x.holds("mean between 600 and 900", lambda x: 600 < x.mean() < 900)
best_x.holds("variance above 20,000", lambda x: x.var() > 20_000)
best_x.wrong("""multinomial: uses a scheme whose points are independent: its total hardly
         scatters
    Which scheme is the claim about?
    Use pf.systematic, and do not shuffle.
    np.sum(pf.systematic(w, rng) % 2 == 0)""")(
    lambda rng: best_x(rng, pf.multinomial), when=lambda x: x.var() < 2000 and 700 < x.mean() < 800
)
best_x.refuses("a constant at the right value", named="multinomial")(lambda rng: 750)
best_x.wrong("""light: counts the light particles
    Which indices are heavy?
    The first weight is 1.5: even indices are heavy.
    % 2 == 0""")(lambda rng: 1000 - best_x(rng), when=lambda x: x.mean() < 500)

JUDGE = Question("Judgement")

when = Choice("""When can resampling only lose particles?
    a  when the effective sample size is below half of M
       = That is the usual moment to do it.
    b* after a prediction without a measurement
       = Yes: nothing was learnt since, so copying adds luck and nothing else.
    c  when the robot stands still and measures
       = It measures, so weights change; be sparing, but they do degenerate.
    d  when two hypotheses are left
       = Then prefer a comb and resample rarely, but weights still degenerate without it.""")

why = Text(
    """How can a filter lose a hypothesis to which all measurements agree?
    says that the number of copies is random, so the share drifts even with equal weights
    says that a lost hypothesis does not come back
    names both remedies: low-variance schemes and resampling less often""",
    model="The number of copies is random, so the share of a hypothesis drifts even when all "
    "weights are equal, and once it is zero it stays zero. "
    "Low-variance schemes slow the drift, and so does resampling only when the ESS is low.",
)


LAB = Lab.of(__name__, "Resampling variance")
__getattr__ = LAB.verb
