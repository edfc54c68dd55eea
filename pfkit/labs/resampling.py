"""Resampling variance. What does the copying cost?"""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, copying, experiment
from pfkit.labs.response import same_mean, same_scatter

PREDICT = Question("Predictions")

FIVE = copying.FIVE

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


def _bar(w, U):
    """A bar of five weights under a comb that starts at U / 5, as numbers and in words."""
    at, ends = (np.arange(5) + U) / 5, np.cumsum(w)
    return {
        "w": tuple(w),
        "U": U,
        "picks": tuple(int(k) + 1 for k in np.searchsorted(ends, at)),
        "teeth": ", ".join(f"{x:.2f}" for x in at),
        "edges": ", ".join(f"{x:.2f}" for x in ends),
    }


def _other_bar(rng):
    """Weights in another order; rounding M w must not give what the comb gives."""
    while True:
        w, U = rng.permutation(FIVE).tolist(), int(rng.integers(1, 10)) / 10
        bar = _bar(w, U)
        far = np.abs(np.subtract.outer((np.arange(5) + U) / 5, np.cumsum(w))).min()
        if far > 0.005 and _copies_of(**bar) != _rounded(**bar):
            return bar


def _copies_of(picks, **_):
    return tuple(picks.count(k) for k in range(1, 6))


def _rounded(w, **_):
    return tuple(round(5 * x) for x in w)


hand = Numeric(
    """Copies of five particles of weights {w} for U = {U}
    Where are the five teeth? The first is at {U} / 5.
    Teeth at {teeth}; edges at {edges}.
    The teeth pick particles {picks}: count how often each is picked.""",
    _copies_of,
    tol=0.01,
    names=("particle 1", "particle 2", "particle 3", "particle 4", "particle 5"),
    world=_bar(FIVE.tolist(), 0.2),
    draw=_other_bar,
)
hand.wrong("""indices: lists which particle each tooth picks, not how many copies each particle
         gets
    Do your five numbers add up to five?
    Count how often each particle is picked.
    A particle that stands twice in your list has 2 copies.""")(lambda picks, **_: picks)
hand.wrong("""indices-from-zero: lists the index that each tooth picks, not how many copies each
         particle gets
    What would your numbers add up to if they were copies?
    Count how often each index occurs.
    np.bincount counts, or your fingers do.""")(lambda picks, **_: tuple(k - 1 for k in picks))
hand.wrong("""rounded: is M w rounded to whole numbers, whatever U is
    Would another U change your answer?
    Put the teeth at (k + {U}) / 5 and see what they touch.
    Edges at {edges}: which stretch holds no tooth, or one more than you think?""")(_rounded)
hand.wrong("""shares: gives weights where copies are asked for
    Copies are whole numbers.
    How many teeth stand on each stretch of the bar?
    The five copies sum to five.""")(lambda w, **_: w)


def _one_weight(rng):
    return {"w": [0.13, 0.17, 0.22, 0.25, 0.28, 0.31, 0.35, 0.37][int(rng.integers(8))]}


variance = Numeric(
    """Variance of the copies of a particle of weight {w} among five
    Multinomial: M w (1 - w) with M = 5.
    Systematic: phi is what M w = 5 * {w} is above a whole number.
    5 * {w} * (1 - {w}), and phi (1 - phi).""",
    lambda w: (5 * w * (1 - w), 5 * w % 1 * (1 - 5 * w % 1)),
    tol=0.002,
    names=("multinomial", "systematic"),
    world={"w": 0.25},
    draw=_one_weight,
)
variance.wrong("""no-m: forgets the factor M of the binomial variance
    How many points are thrown?
    Five points, each hits with {w}.
    5 * {w} * (1 - {w}).""")(lambda w: (w * (1 - w), 5 * w % 1 * (1 - 5 * w % 1)))
variance.wrong("""sd: gives standard deviations
    The question asks for the variance.
    Do not take the root.
    Square both of your numbers.""")(
    lambda w: (np.sqrt(5 * w * (1 - w)), np.sqrt(5 * w % 1 * (1 - 5 * w % 1)))
)
variance.wrong("""mean: gives M w for multinomial, which is the mean
    How many copies on average, and how far do they scatter?
    A binomial scatters less than its mean.
    Multiply by 1 - {w}.""")(lambda w: (5 * w, 5 * w % 1 * (1 - 5 * w % 1)))
variance.wrong("""fraction: gives the fraction phi itself for systematic
    One more copy comes with probability phi: what is the variance of a yes or no?
    p (1 - p).
    phi (1 - phi).""")(lambda w: (5 * w * (1 - w), 5 * w % 1))


def _heavy(rng):
    M = int(rng.choice([50, 80, 100, 125, 200, 250]))
    return {"M": M, "w": round(int(rng.integers(12, 19)) / 10 / M, 5)}


survive = Numeric(
    """Survival of a particle of weight {w} among {M}
    Multinomial dies only if all {M} points miss.
    One point misses with probability 1 - {w}.
    1 - (1 - {w})^{M}; and the comb has at least one tooth in a stretch of {w} or more than
         1 / {M}.""",
    lambda M, w: (1 - (1 - w) ** M, min(1.0, M * w)),
    tol=0.002,
    names=("multinomial", "systematic"),
    world={"M": 100, "w": 0.012},
    draw=_heavy,
)
survive.wrong("""sign: has the sign error of the printed formula
    Should a heavier particle be missed more often?
    A point misses with 1 - w = 1 - 1/M - eps.
    1 - (1 - {w})^{M}, and {w} is 1/M + eps.""")(lambda M, w: (1 - (1 - 2 / M + w) ** M, 1.0))
survive.wrong("""above-one: gives a probability above 1
    Can a probability be larger than 1?
    Where M w is 1 or more, a tooth is certain.
    min(1, M w) = 1.""")(lambda M, w: (1 - (1 - w) ** M, M * w))
survive.wrong("""death: gives the chances to die
    Which of the two did the question ask for?
    P(dies) + P(survives) = 1.
    Subtract both from one.""")(lambda M, w: ((1 - w) ** M, 0.0))
survive.wrong("""one-point: is the chance that a single point hits
    How many points are thrown?
    {M} points, and the particle dies only if all of them miss.
    1 - (1 - {w})^{M}.""")(lambda M, w: (w, 1.0))

CODE = Question("Code")


def _zeros(f):
    ends = np.append(np.full(99, 0.9997 / 99), 0.0)  # and they do not quite sum to one
    return all(
        bool((copying.counts(f, w, 200)[:, w == 0] == 0).all()) for w in (copying.GAPS, ends)
    )


@code(
    """The comb as a function
    Teeth (k + U) / M, edges = summed weights.
    np.searchsorted(edges, teeth) finds the particle under each tooth.
    Divide the edges by the last one first, and let no tooth pick beyond the last weight that is
         not zero.""",
    points=2,
)
def comb(w, rng):
    edges = np.cumsum(w) / np.sum(w)
    teeth = (np.arange(w.size) + rng.random()) / w.size
    last = np.flatnonzero(w)[-1]
    return np.minimum(np.searchsorted(edges, teeth), last)


comb.holds(f"returns M whole numbers below M, for each M to {copying.LARGEST}", copying.all_sizes)
comb.holds("M w copies on average, within 5 standard errors over 800 draws", copying.fair)
comb.holds("floor or ceiling of M w copies, every time", copying.floor_or_ceiling)
comb.holds("a weight of zero gets no copy", _zeros)
comb.holds("weights that sum to 0.9997 are no trouble", copying.rough)
comb.holds("all luck comes from rng: the same rng, the same copies", copying.luck_from_rng)

comb.wrong(
    """global-luck: draws from a generator of its own, not from rng
    Call it twice with np.random.default_rng(1): should the copies differ?
    np.random.random() does not know your rng.
    U = rng.random()""",
    when=lambda f: not copying.luck_from_rng(f),
)(lambda w, rng: copying.of_comb(w, np.random.default_rng()))
comb.wrong(
    """off-by-one: picks the neighbour of the particle under the tooth
    Which particle does a tooth at .04 touch?
    The summed weights are right edges: the first is w of particle 0.
    No leading zero in the edges, and no + 1 or - 1.""",
    when=copying.is_off_by_one,
)(copying.off_by_one)
comb.wrong(
    """one-too-many: has a tooth too many for some sizes, such as M = 49
    How long is np.arange(0, 1, 1 / 49)?
    Steps of 1 / M add up with rounding errors, and the end may slip in.
    np.arange(M) / M has M entries for certain.""",
    when=copying.has_one_too_many,
)(copying.one_too_many)
comb.wrong(
    """no-luck: gives the same copies whatever rng says
    Where is the random number?
    The comb starts at a random place within one spacing.
    teeth = (np.arange(M) + rng.random()) / M""",
    when=copying.never_varies,
)(copying.in_the_middle)
comb.wrong(
    """stratified: is stratified: it draws a random number for each tooth
    How many random numbers does a comb need?
    All teeth of a comb share one offset.
    Draw rng.random() without an argument.""",
    when=copying.is_stratified,
)(lambda w, rng: pf.stratified(w, rng))
comb.wrong(
    """multinomial: is multinomial: it throws M independent points
    How many random numbers does a comb need?
    Draw rng.random() once, without an argument.
    teeth = (np.arange(M) + rng.random()) / M""",
    when=copying.is_multinomial,
)(lambda w, rng: rng.choice(w.size, w.size, p=w / w.sum()))
comb.wrong("""short: spaces the teeth by 1 / (M - 1)
    Where is your last tooth? Can it lie beyond the bar?
    M teeth cover the bar with M gaps of 1 / M.
    teeth = (np.arange(M) + rng.random()) / M""",
    when=lambda f: copying.draws_as(f, copying.too_wide, copying.too_wide_throughout),
)(lambda w, rng: copying.too_wide(w, rng) if w.size > 1 else np.zeros(1, dtype=int))  # fmt: skip
comb.wrong(
    """run-off: trusts that the weights sum to one
    What if the weights sum to 0.9997?
    A tooth at 0.9998 then lies beyond the last edge.
    Divide the edges by the last one.""",
    when=copying.runs_off,
)(copying.trusting)
comb.refuses("teeth 1/(M - 1) apart, their start as well", named="short")(
    copying.too_wide_throughout
)
comb.refuses("an index too low", named="off-by-one")(lambda w, rng: copying.of_comb(w, rng) - 1)
comb.refuses("NumPy's global generator", named="global-luck")(
    lambda w, rng: np.searchsorted(
        copying.edges(w),
        (np.arange(w.size) + np.random.rand()) / w.size,  # noqa: NPY002
    )
)
comb.refuses("an offset that is not uniform")(
    lambda w, rng: np.searchsorted(copying.edges(w), (np.arange(w.size) + rng.beta(2, 2)) / w.size)
)
comb.refuses("the resampling wheel")(lambda w, rng: pf.resampling_wheel(w, rng))
comb.refuses("the residual scheme")(lambda w, rng: pf.residual(w, rng))
comb.refuses("the last particle takes what is left, though its weight is zero")(
    lambda w, rng: np.searchsorted(np.cumsum(w)[:-1], copying.teeth(w.size, rng))
)
comb.refuses("copies in numbers, not indices")(
    lambda w, rng: np.bincount(copying.of_comb(w, rng), minlength=w.size)
)


def _sets(f):
    for M in (2, 3, 5, 8, 20):
        for seed in range(3):
            w = np.random.default_rng(seed).dirichlet(np.ones(M))
            if not np.allclose(f(w.copy()), leftover(w), rtol=0, atol=1e-8):
                return f"not for a set of {M}"
    return True


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
leftover.holds("sets of other sizes have theirs", _sets)


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


@leftover.wrong("""takes every set for one of five
    How many particles has a set of three?
    M is the number of weights that came in.
    w.size""")
def always_five(w):
    rest = 5 * w - np.floor(5 * w)
    return rest / rest.sum()


@leftover.wrong("""rounds M w to the nearest whole number where it should round down
    What does 0.75 round to, and is that copy safe?
    Only whole copies below M w are certain.
    np.floor, not np.round""")
def nearest(w):
    rest = w.size * w - np.round(w.size * w)
    return np.abs(rest) / np.abs(rest).sum()


leftover.refuses("the five by heart")(lambda w: np.array([0, 0.125, 0.375, 0.3, 0.2]))
leftover.refuses("what is missing to the next copy")(
    lambda w: (np.ceil(w.size * w) - w.size * w) / np.sum(np.ceil(w.size * w) - w.size * w)
)
leftover.refuses("divided by M instead of the sum")(
    lambda w: (w.size * w - np.floor(w.size * w)) / w.size
)

LUCK = Question("Luck")


def _half_kept(w, rng):
    """Every second particle is kept, the others are replaced by independent draws."""
    kept = rng.permutation(w.size)[: w.size // 2]
    return np.append(kept, rng.choice(w.size, w.size - kept.size, p=w))


def _in_pairs(w, rng):
    """Independent draws, two copies of each."""
    return np.repeat(rng.choice(w.size, (w.size + 1) // 2, p=w), 2)[: w.size]


def _clocks(f, rng, runs):
    """Answer, reference, calls of the scheme, and (mean size of the sets, all equal?), each run."""
    found = np.zeros((runs, 3, 5))
    for i, child in enumerate(rng.spawn(runs)):
        for k, scheme in enumerate((pf.multinomial, _half_kept, _in_pairs)):
            N, seed = 2 * int(child.integers(2, 6)), child.integers(2**32)
            seen: list[np.ndarray] = []

            def watched(w, rng, n=None, *, seen=seen, scheme=scheme):
                seen.append(np.array(w, dtype=float))
                return scheme(seen[-1], rng)

            theirs = np.asarray(f(watched, N, np.random.default_rng(seed)), dtype=float).item()
            ours = clock_x(scheme, N, np.random.default_rng(seed))
            size = np.mean([w.size for w in seen]) / N if seen else 0
            equal = all(np.ptp(w) < 1e-9 for w in seen)
            found[i, k] = theirs, ours, len(seen), size, equal
    return found


@experiment(
    """The drift clock of any scheme
    Mark N / 2 of N particles as cluster A, and resample until all or none of them are of A.
    Equal weights, np.full(N, 1 / N), go into the scheme; the marks follow the ancestors.
    in_a = in_a[scheme(np.full(N, 1 / N), rng)] while in_a is mixed; count how often.""",
    points=2,
    after=clock,
    runs=250,
    pool=1_500,
    measure=_clocks,
    claim="chance alone loses one of two equal clusters; how soon depends on N and on the scheme",
    test="three schemes, N from 4 to 10: as many resamplings as calls, and the mean within 4.5 "
    "standard errors of a right experiment's",
    margin="two equal means within 4.5 standard errors in four comparisons: 3e-5",
)
def clock_x(scheme, N, rng):
    in_a, age = np.arange(N) < N // 2, 0
    while in_a.any() and not in_a.all():
        in_a, age = in_a[scheme(np.full(N, 1 / N), rng)], age + 1
    return age


clock_x.holds(
    "a whole number of at least 1",
    lambda x: bool((x[..., 0] >= 1).all() and (x[..., 0] % 1 == 0).all()),
)
clock_x.holds(
    "it is how often your function called the scheme",
    lambda x: bool((x[..., 0] == x[..., 2]).all()),
)
clock_x.holds("with N equal weights", lambda x: bool((x[..., 3:] == 1).all()))
clock_x.holds(
    "the mean is that of a right experiment, for each scheme",
    lambda x: same_mean()(x[..., :2]),
)
clock_x.holds("the runs differ, as luck does", lambda x: same_scatter(2.5)(x[..., :2]))
clock_x.wrong("""own-scheme: never calls the scheme that it was given
    Whose luck does your number measure?
    The check hands over three schemes, and two of them are not multinomial.
    Call scheme(np.full(N, 1 / N), rng) for each resampling, and let the marks follow.""")(
    lambda scheme, N, rng: clock_x(pf.multinomial, N, rng),
    when=lambda x: bool((x[..., 2] == 0).all()),
)
clock_x.wrong("""half: resamples N / 2 particles where there are N
    How many particles are there together?
    Each cluster has N / 2.
    np.arange(N) < N // 2""")(
    lambda scheme, N, rng: clock_x(scheme, N // 2, rng),
    when=lambda x: bool((x[..., 3] == 0.5).all()),
)
clock_x.wrong("""double: resamples 2 N particles: N in each cluster
    How many particles are there together?
    Each cluster has N / 2.
    np.arange(N) < N // 2""")(
    lambda scheme, N, rng: clock_x(scheme, 2 * N, rng),
    when=lambda x: bool((x[..., 3] == 2).all()),
)
clock_x.wrong("""off-by-one: is off by one from the number of resamplings that it made
    How often was the scheme called when it returned?
    Count inside the loop, once per call.
    Start the count at 0.""")(
    lambda scheme, N, rng: clock_x(scheme, N, rng) + 1,
    when=lambda x: bool((np.abs(x[..., 0] - x[..., 2]) == 1).all() and np.ptp(x[..., 2]) > 1),
)
clock_x.wrong("""per-particle: divides by N
    In which unit is the clock asked for?
    2 ln 2 = 1.39 is the clock in units of N.
    Return the number of resamplings itself.""")(
    lambda scheme, N, rng: clock_x(scheme, N, rng) / N,
    when=lambda x: bool((x[..., 0] < x[..., 2]).all() and _is_ratio(x)),
)


def _is_ratio(x):
    """Calls over answers are even numbers, each of the sizes that the check used."""
    ratio = x[..., 2] / np.maximum(x[..., 0], 1e-9)
    return bool((np.abs(ratio - ratio.round()) < 1e-6).all() and ratio.round().max() <= 20)


@clock_x.wrong("""waits until all particles descend from a single one
    How many founders has a cluster that won?
    It is enough that all particles are of one cluster.
    Follow a mark, A or not A, in place of the particle's number.""")
def coalescence(scheme, N, rng):
    founder, age = np.arange(N), 0
    while np.ptp(founder):
        founder, age = founder[scheme(np.full(N, 1 / N), rng)], age + 1
    return age


clock_x.refuses("a constant at the right value", named="own-scheme")(lambda scheme, N, rng: 137)
clock_x.refuses("the formula", named="own-scheme")(lambda scheme, N, rng: round(2 * N * np.log(2)))
clock_x.refuses("right mean, law of its own", named="own-scheme")(
    lambda scheme, N, rng: 1 + int(rng.exponential(2 * N * np.log(2)))
)
clock_x.refuses("random in range", named="own-scheme")(
    lambda scheme, N, rng: int(rng.integers(1, 300))
)
clock_x.refuses("the chain of the chapter, which knows one scheme", named="own-scheme")(
    lambda scheme, N, rng: clock_x(pf.multinomial, N, rng)
)


@clock_x.refuses("calls the scheme as often as the formula says")
def _formula_with_calls(scheme, N, rng):
    age = round(2 * N * np.log(2))
    for _ in range(age):
        scheme(np.full(N, 1 / N), rng)
    return age


@clock_x.refuses("stops when a cluster has a single particle left")
def _one_left(scheme, N, rng):
    in_a, age = np.arange(N) < N // 2, 0
    while 1 < in_a.sum() < N - 1:
        in_a, age = in_a[scheme(np.full(N, 1 / N), rng)], age + 1
    return age


@clock_x.refuses("waits for cluster A to win, and starts again if it loses")
def _one_side(scheme, N, rng):
    in_a, age = np.arange(N) < N // 2, 0
    while not in_a.all():
        in_a = in_a[scheme(np.full(N, 1 / N), rng)] if in_a.any() else np.arange(N) < N // 2
        age += 1
    return age


def _orders(f, rng, runs):
    """Variance of the heavy total, over multinomial's: of the order, of the best, of its inverse.

    Then what was returned (1: an order, 0: something else, -1: the weights), and whether it is
    the order in which the weights came.
    """
    found = np.zeros((runs, 5))
    for i, child in enumerate(rng.spawn(runs)):
        M, a = 2 * int(child.integers(30, 100)), child.uniform(1.25, 1.75)
        w = child.permutation(np.repeat([a, 2 - a], M // 2)) / M
        order = np.asarray(f(w.copy()))
        best = _scatter(w, best_x(w))
        if order.shape == (M,) and np.array_equal(np.sort(order), np.arange(M)):
            order = order.astype(int)
            back = _scatter(w, np.argsort(order))
            found[i] = _scatter(w, order), best, back, 1, np.array_equal(order, np.arange(M))
        else:
            weights = order.shape == (M,) and np.allclose(np.sort(order), np.sort(w))
            found[i] = 0, best, 0, -1 if weights else 0, 0
    return found


def _scatter(w, order):
    """Exact variance of the copies that the heavy ones get from the comb, over multinomial's."""
    M, offsets = w.size, (np.arange(100) + 0.5) / 100
    points = (np.arange(M) + offsets[:, None]) / M
    under = np.minimum(np.searchsorted(np.cumsum(w[order]), points), M - 1)
    total = (w[order] > 1 / M)[under].sum(axis=1)
    p = w[w > 1 / M].sum()
    return total.var() / (M * p * (1 - p))


@experiment(
    """An order in which the comb is at its worst
    Two particles of the text hold two teeth together: heavy, light, heavy, light.
    Where do the heavy ones stand, and where the light ones? np.flatnonzero(w > 1 / w.size)
    Take one of each in turn: np.stack((heavy, light), axis=1).ravel()""",
    points=2,
    after=best,
    runs=20,
    pool=400,
    measure=_orders,
    claim="with weights in step with the comb, the total of the heavy copies scatters many times "
    "more than with independent points",
    test="twenty sets of 60 to 198 particles in any order: over ten times multinomial's variance "
    "on average, and at least half of what a right order reaches in each set",
    false_fail=1e-9,
    margin="the variance under the comb is computed, not drawn",
)
def best_x(w):
    heavy, light = np.flatnonzero(w > 1 / w.size), np.flatnonzero(w < 1 / w.size)
    return np.stack((heavy, light), axis=1).ravel()


best_x.holds("an order: each index from 0 to M - 1 once", lambda x: bool((x[:, 3] == 1).all()))
best_x.holds(
    "the comb scatters over ten times as much as independent points",
    lambda x: True if x[:, 0].mean() > 10 else f"{x[:, 0].mean():.2g} times",
)
best_x.holds(
    "and at least half as much as it can",
    lambda x: bool((x[:, 0] >= x[:, 1] / 2).all()),
)
best_x.wrong("""as-it-came: leaves the particles in the order in which they came
    Are heavy and light in step with the comb there?
    The weights that come in are in no order.
    Find the heavy and the light ones first: np.flatnonzero.""")(
    lambda w: np.arange(w.size), when=lambda x: bool((x[:, 4] == 1).all())
)
best_x.wrong("""sorts: gives an order in which the comb hardly scatters at all
    How much of the bar do the heavy ones cover together, and how many teeth stand there?
    Like beside like is the best that can happen to a comb.
    Mix them: heavy, light, heavy, light.""")(
    lambda w: np.argsort(-w),
    when=lambda x: bool((x[:, 3] == 1).all() and (x[:, 0] < 0.06).all()),
)
best_x.wrong("""weights: returns weights, where an order is asked for
    Which particle comes first in your bar?
    The check lays w[order] on the bar.
    Return the indices of the particles.""")(
    lambda w: w[best_x(w)], when=lambda x: bool((x[:, 3] == -1).all())
)
best_x.wrong("""places: tells each particle its place, where the check reads which particle comes
         at each place
    What does w[order] do with your numbers?
    order[0] is the particle that comes first.
    np.argsort turns places into an order.""")(
    lambda w: np.argsort(best_x(w)),
    when=lambda x: bool((x[:, 3] == 1).all() and (x[:, 2] >= x[:, 1] / 2).all()),
)
best_x.refuses("a shuffle")(lambda w: np.random.default_rng(0).permutation(w.size))
best_x.refuses("backwards")(lambda w: np.arange(w.size)[::-1])
best_x.refuses("even indices first")(lambda w: np.argsort(np.arange(w.size) % 2, kind="stable"))
best_x.refuses("blocks of two")(
    lambda w: (
        best_x(w).reshape(-1, 2)[: w.size // 4 * 2].reshape(-1, 2, 2).swapaxes(1, 2).ravel()
        if w.size % 4 == 0
        else np.argsort(-w).reshape(2, -1).T.ravel()[np.argsort(np.arange(w.size) // 2 % 3)]
    )
)
best_x.refuses("the alternating weights of the text, whatever came in")(
    lambda w: np.tile([1.5, 0.5], w.size // 2) / w.size
)
best_x.refuses("a number")(lambda w: 500)

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
