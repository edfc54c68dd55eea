"""Diversity. How does a cloud die out, and what keeps it alive?"""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment
from pfkit.labs.response import same_mean, same_scatter

PREDICT = Question("Predictions")

gauge = Prediction("""1,000 particles were resampled until all are copies of one: their effective
          sample size
    a  1
    b  about 30
    c* 1,000
    d  it cannot be computed""")

lie = Prediction("""A target moves steadily, the filter believes that it stands still: which process
          noise gives the smallest error?
    a  none: the target's motion has none
    b* more than the target has
    c  the target's own
    d  it makes no difference""")

HAND = Question("By hand")


def _room(rng):
    return {
        "M": int(rng.choice([50, 100, 200, 400])),
        "A": int(rng.choice([40, 60, 80, 120])),
        "rho": float(rng.choice([0.2, 0.3, 0.4])),
    }


near = Numeric(
    """Chance that none of {M} particles, uniform over {A} m2, lies within {rho} m of the robot
    One particle lies that near with probability pi rho^2 / A.
    All of them must miss, and they are independent.
    (1 - pi {rho}^2 / {A})^{M}""",
    lambda M, A, rho: (1 - np.pi * rho**2 / A) ** M,
    tol=0.002,
    world={"M": 200, "A": 80, "rho": 0.3},
    draw=_room,
)
near.wrong("""complement: is the chance that some particle is near
    Did the question ask for luck or for deprivation?
    The two sum to one.
    One minus your number.""")(lambda M, A, rho: 1 - (1 - np.pi * rho**2 / A) ** M)
near.wrong("""one: is the chance for a single particle
    How many particles must miss?
    Independent chances multiply.
    To the power {M}.""")(lambda M, A, rho: 1 - np.pi * rho**2 / A)
near.wrong("""square: takes a square of side rho for the disc
    Which area lies within rho of a point?
    A disc.
    pi {rho}^2""")(lambda M, A, rho: (1 - rho**2 / A) ** M)


def _bandwidth(rng):
    return {"h": int(rng.integers(2, 8)) / 10, "S": int(rng.integers(2, 9)) / 2}


shrink = Numeric(
    """Variance of a cloud of variance {S} after noise of bandwidth {h}; the factor that undoes it
    The noise has variance h^2 S and is independent of the cloud.
    Shrink the cloud about its mean by a first: a^2 S + h^2 S = S.
    (1 + {h}^2) {S}, and the root of 1 - {h}^2.""",
    lambda h, S: ((1 + h**2) * S, float(np.sqrt(1 - h**2))),
    tol=0.005,
    names=("variance after noise alone", "shrinkage a"),
    world={"h": 0.3, "S": 2.0},
    draw=_bandwidth,
)
shrink.wrong("""linear: adds standard deviations
    Which of the two add up for independent errors?
    Variances do.
    (1 + h^2) S""")(lambda h, S: ((1 + h) ** 2 * S, float(np.sqrt(1 - h**2))))
shrink.wrong("""one-minus-h: shrinks by 1 - h
    Square your factor and add h^2: is it 1?
    a^2 = 1 - h^2.
    The root of 1 - {h}^2.""")(lambda h, S: ((1 + h**2) * S, 1 - h))
shrink.wrong("""squared: gives the square of the factor
    By what are the distances from the mean multiplied?
    a^2 = 1 - h^2 is for variances.
    Take the root.""")(lambda h, S: ((1 + h**2) * S, 1 - h**2))


def _cells(rng):
    return {"k": int(rng.choice([5, 10, 20, 50, 80])), "eps": float(rng.choice([0.02, 0.04, 0.1]))}


kld = Numeric(
    """Particles by the bound for {k} occupied cells, epsilon = {eps}, delta = .01 (z = 2.326)
    First the small fraction: 2 / (9 (k - 1)).
    Then 1 - fraction + root of fraction times z, cubed.
    Times (k - 1) / (2 {eps}), rounded up; k - 1 is {k} - 1.""",
    lambda k, eps: int(pf.kld_bound(k, eps, 0.01)),
    tol=1,
    world={"k": 10, "eps": 0.05},
    draw=_cells,
)
kld.wrong("""k: uses k where k - 1 is meant
    How many shares are free, if k shares sum to one?
    Degrees of freedom: one less.
    {k} - 1 in all three places.""")(lambda k, eps: int(pf.kld_bound(k + 1, eps, 0.01)))
kld.wrong("""half: forgets the 2 in 2 epsilon
    n times twice the divergence is about chi-square.
    Solve that for n.
    Divide by 2 {eps}.""")(lambda k, eps: 2 * int(pf.kld_bound(k, eps, 0.01)))
kld.wrong("""mean: is (k - 1) / (2 epsilon), which is enough on average only
    How often would that number be enough?
    The bound asks for 99 %: the quantile, not the mean.
    Multiply by the cubed bracket.""")(lambda k, eps: (k - 1) / (2 * eps))

CODE = Question("Code")


def _cloud(seed, D=2, M=400):
    rng = np.random.default_rng(seed)
    return rng.normal(0, 1, (D, D)) @ rng.standard_normal((D, M)) + rng.uniform(-5, 5, (D, 1))


def _kept(f):
    for seed, h in ((0, 0.2), (1, 0.5), (2, 0.8)):
        x = _cloud(seed, M=20_000)
        y = f(x.copy(), h, np.random.default_rng(seed))
        if y.shape != x.shape:
            return f"shape {y.shape}, not {x.shape}"
        sd = np.sqrt(np.diag(np.cov(x)))
        if (np.abs(y.mean(axis=1) - x.mean(axis=1)) > 0.05 * sd).any():
            return f"the mean moved for h = {h}"
        ratio = np.diag(np.cov(y)) / np.diag(np.cov(x))
        if (np.abs(ratio - 1) > 0.06).any():
            return f"variances became {ratio.round(2).tolist()} times as large for h = {h}"
        if abs(np.corrcoef(y)[0, 1] - np.corrcoef(x)[0, 1]) > 0.04:
            return f"the correlation changed for h = {h}"
    return True


def _apart(f):
    x = np.repeat(_cloud(3, M=40), 10, axis=1)
    y = f(x.copy(), 0.3, np.random.default_rng(0))
    return bool(np.unique(y[0].round(9)).size == 400)


def _as_wide(f):
    x = _cloud(4, M=20_000)
    y = f(x.copy(), 0.3, np.random.default_rng(0))
    left = (
        y - y.mean(axis=1, keepdims=True) - np.sqrt(1 - 0.09) * (x - x.mean(axis=1, keepdims=True))
    )
    return bool(np.allclose(np.cov(left), 0.09 * np.cov(x), atol=0.05 * 0.09 * np.cov(x).max()))


@code(
    """Regularise without widening
    Noise of covariance h^2 Sigma, where Sigma is the covariance of the cloud.
    Shrink x about its mean by the root of 1 - h^2 before you add it.
    mean + a (x - mean) + h L n with L = np.linalg.cholesky(np.cov(x)), n standard normal.""",
    points=2,
    fingerprint=lambda f: f(_cloud(7), 0.4, np.random.default_rng(3)),
    atol=1e-6,
)
def regularised(x, h, rng):
    mean, L = x.mean(axis=1, keepdims=True), np.linalg.cholesky(np.cov(x))
    return mean + np.sqrt(1 - h**2) * (x - mean) + h * L @ rng.standard_normal(x.shape)


regularised.holds("mean, variances and correlation stay", _kept)
regularised.holds("copies come apart", _apart)
regularised.holds("the noise has covariance h^2 Sigma", _as_wide)


@regularised.wrong("""adds noise without shrinking first
    How large is the variance of a sum of independent parts?
    (1 + h^2) times what it was, at every resampling.
    Multiply x - mean by the root of 1 - h^2.""")
def widened(x, h, rng):
    return x + h * np.linalg.cholesky(np.cov(x)) @ rng.standard_normal(x.shape)


@regularised.wrong("""shrinks by 1 - h
    (1 - h)^2 + h^2 is not 1.
    a^2 + h^2 = 1.
    np.sqrt(1 - h**2)""")
def too_small(x, h, rng):
    mean, L = x.mean(axis=1, keepdims=True), np.linalg.cholesky(np.cov(x))
    return mean + (1 - h) * (x - mean) + h * L @ rng.standard_normal(x.shape)


@regularised.wrong("""shrinks towards zero, not towards the mean
    Where does a cloud around (5, 5) go?
    Distances from the mean shrink, places do not.
    mean + a * (x - mean)""")
def to_zero(x, h, rng):
    L = np.linalg.cholesky(np.cov(x))
    return np.sqrt(1 - h**2) * x + h * L @ rng.standard_normal(x.shape)


@regularised.wrong("""gives each component noise of its own, whatever the cloud's correlation
    Is a cloud along a diagonal still along it?
    The noise must have the shape of the cloud.
    np.linalg.cholesky(np.cov(x)) @ n""")
def round_noise(x, h, rng):
    mean, sd = x.mean(axis=1, keepdims=True), x.std(axis=1, keepdims=True, ddof=1)
    return mean + np.sqrt(1 - h**2) * (x - mean) + h * sd * rng.standard_normal(x.shape)


regularised.refuses("one draw for all particles")(
    lambda x, h, rng: (
        x.mean(axis=1, keepdims=True)
        + np.sqrt(1 - h**2) * (x - x.mean(axis=1, keepdims=True))
        + h * np.linalg.cholesky(np.cov(x)) @ rng.standard_normal((x.shape[0], 1))
    )
)
regularised.refuses("a fresh Gaussian cloud: heaps are forgotten")(
    lambda x, h, rng: (
        x.mean(axis=1, keepdims=True) + np.linalg.cholesky(np.cov(x)) @ rng.standard_normal(x.shape)
    )
)
regularised.refuses("nothing at all")(lambda x, h, rng: x)


def _bound(k):
    return 4 * k + 3


def _stops(f):
    for seed in range(40):
        rng = np.random.default_rng(seed)
        cells = rng.integers(0, 3 + seed, 400)
        n, right = f(cells.copy(), _bound), enough(cells, _bound)
        if n != right:
            return f"{n}, where {right} draws are enough"
    return True


@code(
    """When are there enough particles?
    Count the different cells among the first n draws, for n = 1, 2, ...
    Stop at the first n that is at least bound(k) for the k cells met so far.
    met = set(); for n, cell in enumerate(cells, start=1): met.add(cell); ...""",
    fingerprint=lambda f: np.array(
        [f(np.random.default_rng(s).integers(0, 9 + s, 400), _bound) for s in range(8)]
    ),
)
def enough(cells, bound):
    met = set()
    for n, cell in enumerate(cells, start=1):
        met.add(int(cell))
        if n >= bound(len(met)):
            return n
    return len(cells)


enough.holds("the first n that is at least bound(k)", _stops)
enough.holds(
    "one cell for all: bound(1)", lambda f: f(np.zeros(50, dtype=int), lambda k: 12 * k) == 12
)
enough.holds(
    "all draws, if they are never enough", lambda f: f(np.arange(30), lambda k: 5 * k) == 30
)


@enough.wrong("""counts the cells of all draws, also of those to come
    What does a sampler know at its tenth draw?
    Cells that were not met yet do not count.
    Count among the first n.""")
def of_all(cells, bound):
    return min(int(bound(np.unique(cells).size)), len(cells))


@enough.wrong("""stops one draw too late
    Must n be larger than the bound, or at least as large?
    n >= bound(k) is enough.
    >=, not >""")
def late(cells, bound):
    return min(enough(cells, lambda k: bound(k) + 1), len(cells))


@enough.wrong("""counts every draw as a new cell
    Two draws in one cell: how many cells?
    Only different cells count.
    A set forgets repetitions.""")
def every(cells, bound):
    n = next((n for n in range(1, len(cells) + 1) if n >= bound(n)), len(cells))
    return n


enough.refuses("the number of cells")(lambda cells, bound: int(np.unique(cells).size))

EXPERIMENTS = Question("Experiments")


def _sizes(rng):
    return [(int(rng.integers(20, 40)), int(t)) for t in rng.integers((2, 8, 25), (6, 20, 40))]


@experiment(
    """Distinct ancestors after T resamplings
    Start with M different particles: each carries its own number.
    Resample with equal weights: M independent draws with replacement, of the numbers that are left.
    a = a[rng.integers(M, size=M)], T times; then np.unique(a).size, for each run.""",
    points=2,
    after=gauge,
    runs=300,
    pool=2_000,
    settings=_sizes,
    together=True,
    claim="copying alone loses ancestors, while the effective sample size stays M",
    test="three settings: distinct ancestors on average within 5 standard errors of a right "
    "experiment's, and as much scatter",
    margin="equal means within 5 standard errors in four comparisons: 2e-6",
)
def distinct_x(M, T, rng, runs):
    a = np.tile(np.arange(M), (runs, 1))
    for _ in range(T):
        a = np.take_along_axis(a, rng.integers(M, size=(runs, M)), axis=1)
    return 1 + np.count_nonzero(np.diff(np.sort(a, axis=1), axis=1), axis=1)


distinct_x.holds("distinct ancestors as in a right experiment", same_mean(5.0))
distinct_x.holds("they scatter as luck does", same_scatter(2.5))


@distinct_x.wrong("""resamples once, whatever T is
    How often do copies get copied?
    T times, each from what the time before left.
    Put it into a loop.""")
def once(M, T, rng, runs):
    return distinct_x(M, 1, rng, runs)


@distinct_x.wrong("""counts the ancestors that are lost
    The question asks who is left.
    M minus the lost ones.
    np.unique(a).size""")
def lost(M, T, rng, runs):
    return M - distinct_x(M, T, rng, runs)


@distinct_x.wrong("""stops one resampling early or goes one further
    How often does your loop run?
    range(T) runs T times.
    Resample T times, no more.""")
def further(M, T, rng, runs):
    return distinct_x(M, max(T - 1, 1), rng, runs)


distinct_x.refuses("M, the effective sample size")(lambda M, T, rng, runs: np.full(runs, M))
distinct_x.refuses("the law 2 M / T")(lambda M, T, rng, runs: np.full(runs, 2 * M / T))
distinct_x.refuses("random in range")(lambda M, T, rng, runs: rng.integers(1, M + 1, runs))
distinct_x.refuses("twice as many particles")(
    lambda M, T, rng, runs: distinct_x(2 * M, T, rng, runs)
)
distinct_x.refuses("one history for all runs")(
    lambda M, T, rng, runs: np.full(runs, distinct_x(M, T, rng, 1)[0])
)
distinct_x.refuses("draws without replacement: nobody is lost")(
    lambda M, T, rng, runs: distinct_x(M, 0, rng, runs)
)


def _targets(rng):
    return [
        (round(rng.uniform(0.3, 0.6), 2), round(q, 3), round(rng.uniform(0.5, 0.9), 2))
        for q in rng.uniform((0.01, 0.15, 1.5), (0.04, 0.4, 3.0))
    ]


@experiment(
    """The error of a filter that believes in standing still
    The truth is v t; a reading is the truth plus r times a standard normal number.
    Before each reading the variance grows by q; the gain is P / (P + r^2).
    40 times: P += q; K = P / (P + r**2); x += K * (z - x); P *= 1 - K. Start at x = 0, P = 1.""",
    points=2,
    after=lie,
    runs=300,
    pool=2_000,
    settings=_targets,
    together=True,
    claim="process noise stands in for what the model lacks, and there is a best amount of it",
    test="three settings of v, q and r: the squared error after 40 steps within 5 standard errors "
    "of a right experiment's, and as much scatter",
    margin="equal means within 5 standard errors in four comparisons: 2e-6",
)
def lie_x(v, q, r, rng, runs):
    x, P = np.zeros(runs), 1.0
    for t in range(1, 41):
        P += q
        K = P / (P + r**2)
        x += K * (v * t + r * rng.standard_normal(runs) - x)
        P *= 1 - K
    return (x - v * 40) ** 2


lie_x.holds("squared errors as in a right experiment", same_mean(5.0))
lie_x.holds("they scatter as in one", same_scatter(2.5))


@lie_x.wrong("""takes q for a standard deviation
    Which of the two adds up from step to step?
    q is a variance.
    P += q""")
def as_sd(v, q, r, rng, runs):
    return lie_x(v, q**2, r, rng, runs)


@lie_x.wrong("""returns the error, not its square
    The question asks for a squared error.
    Its mean is what a tuner minimises.
    (x - 40 v) ** 2""")
def plain_error(v, q, r, rng, runs):
    return np.sqrt(lie_x(v, q, r, rng, runs))


@lie_x.wrong("""knows the speed and predicts with it
    What does this filter believe about the target?
    That it stands still.
    x does not move before the reading; only P grows.""")
def knows_v(v, q, r, rng, runs):
    return lie_x(0.0, q, r, rng, runs)


@lie_x.wrong("""never lets the variance grow
    What does q do in your filter?
    It keeps the gain up.
    P += q before each reading.""")
def no_q(v, q, r, rng, runs):
    return lie_x(v, 0.0, r, rng, runs)


lie_x.refuses("the squared error of the last reading")(
    lambda v, q, r, rng, runs: (r * rng.standard_normal(runs)) ** 2
)
lie_x.refuses("a constant")(lambda v, q, r, rng, runs: np.full(runs, r**2))
lie_x.refuses("random in range")(lambda v, q, r, rng, runs: rng.random(runs))
lie_x.refuses("one target for all runs")(
    lambda v, q, r, rng, runs: np.full(runs, lie_x(v, q, r, rng, 1)[0])
)
lie_x.refuses("sensor noise taken for a variance", named="")(
    lambda v, q, r, rng, runs: lie_x(v, q, np.sqrt(r), rng, runs)
)

JUDGE = Question("Judgement")

count = Choice("""A cloud was just resampled. Which number warns that it has died out?
    a  the effective sample size
       = It is M after every resampling, whatever was copied.
    b  the evidence
       = It says how well the cloud foresaw a reading, and one particle can foresee well.
    c* the number of distinct particles
       = Yes: copies of one are one, and only counting sees it.
    d  the spread of the weights
       = All weights are equal now.""")

scans = Choice("""A robot stands still and gets the same scan 50 times a second. What should
          its filter do?
    a  use every scan: more data, more certainty
       = The scans share their errors, so the certainty is invented.
    b* use one, and wait until the robot has moved
       = Yes: what errs together is one measurement.
    c  use every scan and add roughening
       = That hides the collapse and still counts one error fifty times.
    d  use every scan with more particles
       = A better picture of a wrong posterior.""")

why = Text(
    """Why can a filter be sure and wrong at once, with an effective sample size of M?
    says that copies of one particle have equal weights
    says that the truth had no particle near it, or lost it
    names a gauge or a remedy that does see or mend it""",
    model="After resampling all weights are equal, so the ESS is M, even if all particles are "
    "copies of one. If no particle was near the truth, all copies are wrong together and their "
    "spread is nothing. Distinct particles show it; noise, moves or more particles mend it.",
)

LAB = Lab.of(__name__, "Diversity")
__getattr__ = LAB.verb
