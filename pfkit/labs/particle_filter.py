"""The particle filter, assembled. Questions on one turn of the filter."""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment

PREDICT = Question("Predictions")


def _case(seed, M=7, scale=1.0):
    rng = np.random.default_rng(seed)
    return pf.normalise(rng.normal(size=M))[0], scale * rng.normal(size=M) - 2.0


def _direct(log_w, ll):
    w = np.exp(log_w) * np.exp(ll)
    return np.log(w / w.sum()), np.log(w.sum())


def _matches(part):
    def holds(f):
        for seed in range(5):
            case = _case(seed)
            if not np.allclose(f(*case)[part], _direct(*case)[part], rtol=0, atol=1e-9):
                return False
        return True

    return holds


def _survives(f):
    log_w, ll = _case(1)
    found, log_sum = f(log_w, ll - 1e5)
    return np.allclose(found, _direct(log_w, ll)[0]) and np.isclose(
        log_sum, _direct(log_w, ll)[1] - 1e5
    )


def _leaves(f):
    log_w, ll = _case(2)
    before = log_w.copy(), ll.copy()
    f(log_w, ll)
    return np.array_equal(before[0], log_w) and np.array_equal(before[1], ll)


def _print_update(f):
    log_w, ll = f(*_case(3))
    return np.concatenate((np.ravel(log_w), np.ravel(ll)))


W = np.array([0.05, 0.25, 0.4, 0.1, 0.2])
STATE = np.array([[1.0, 2, 3, 4, 5], [10, 20, 30, 40, 50], [0.1, 0.2, 0.3, 0.4, 0.5]])


def _copies(f, runs=60):
    found = np.zeros((runs, W.size))
    for k in range(runs):
        state, _ = f(STATE.copy(), np.log(W), np.random.default_rng(k))
        found[k] = [np.sum(np.asarray(state)[0] == x) for x in STATE[0]]
    return found


def _in_columns(f):
    state = np.asarray(f(STATE.copy(), np.log(W), np.random.default_rng(3))[0])
    return state.shape == STATE.shape and all(
        any(np.array_equal(c, s) for s in STATE.T) for c in state.T
    )


def _equal_weights(f):
    log_w = np.asarray(f(STATE.copy(), np.log(W), np.random.default_rng(4))[1])
    return log_w.shape == W.shape and np.allclose(log_w, -np.log(5))


def _comb(f):
    copies = _copies(f)
    return (np.abs(copies - 5 * W) < 1).all()


def _no_overrun(f):
    M = 100
    log_w = np.full(M, np.log(0.9997 / M))  # normalised to four digits only
    for seed in range(200):
        f(np.tile(np.arange(float(M)), (3, 1)), log_w, np.random.default_rng(seed))
    return True


def _unbiased(f):
    copies = _copies(f, 200)
    error = copies.std(axis=0, ddof=1) / np.sqrt(200)
    return (np.abs(copies.mean(axis=0) - 5 * W) < 5 * error + 0.02).all()


no_copy = Prediction("""How many of 1,000 particles still matter, never resampled, after fifty
         measurements?
    a  nearly all of the 1,000 still matter
    b  about half
    c  a few dozen
    d* five or fewer""")

frozen = Prediction("""A robot stands still, no motion noise, resampling at every step: what
         happens?
    a  the cloud closes in on the robot, and the error keeps falling with every measurement
    b* the cloud becomes a single point within a few steps, and the error stays as it is
    c  the cloud keeps the spread of a single measurement
    d  the effective sample size falls to one""")

HAND = Question("By hand")

hand = Numeric(
    """Weight of the particle that was at 3 m
    Move first: after the metre the particle is at 4 m. What does it expect to read?
    It expects 6.0 m, so its error is 4.6 - 6.0 = -1.4 m.
    exp(-1.4^2 / 2) = 0.375; divide by the sum of all five, 3.892.""",
    0.096,
    tol=0.002,
)
hand.wrong("""not-normalised: is a likelihood that was not divided by the sum
    Weights of a set sum to one.
    Add the five likelihoods.
    The five sum to 3.892; divide by it.""")(0.375)
hand.wrong("""no-half: uses exp(-e^2) instead of exp(-e^2 / 2)
    Look at the exponent of the Gaussian.
    A Gaussian of standard deviation 1 falls to 0.607 at e = 1.
    The exponent is -e^2 / 2, so the likelihood of e = -1.4 is 0.375.""")(0.0435)
hand.wrong("""not-moved: weighs the particles where they were before the robot moved
    What comes first, moving or weighing?
    The reading was taken after the second metre.
    The particles stand at 4, 5, 5, 6, 6 m when the wall reads 4.6 m.""")(0.0212)

ess = Numeric(
    """Effective sample size of the five
    Square the five weights.
    The squares sum to 0.214.
    The effective sample size is one over that sum.""",
    4.67,
    tol=0.03,
)
ess.wrong("""no-inverse: is the sum of squares itself
    How many particles is that? At least one always matters.
    Turn the fraction over.
    1 / 0.214.""")(0.214)
ess.wrong("""inverse-max: is one over the largest weight
    That looks at one particle only.
    Use all five weights, squared.
    1 / (0.0964^2 + 2 * 0.2372^2 + 2 * 0.2146^2).""")(4.22)

IDEA = Question("The derivation")

proposal = Choice("""When is the new weight just the likelihood times the old weight?
    a  always, whatever the particles were drawn from
       = Draw from elsewhere and the weight also carries motion density over proposal.
    b* when the particles were drawn from the motion model
       = Yes: motion density and proposal are then the same, and cancel.
    c  when the likelihood is Gaussian
       = The derivation never used the shape of the likelihood.
    d  when all particles have the same old weight
       = Equal old weights cancel too, but the proposal has to be the motion model first.""")

norm = Choice("""You drop the factor 1 / (sigma sqrt(2 pi)) from every likelihood. What
         changes?
    a  nothing at all
       = The weights forget a common factor, but the evidence is the very sum it multiplies.
    b  the weights, but not the evidence
       = The other way round: a common factor cancels when the weights are normalised.
    c* the evidence, but not the weights
       = Yes: it cancels in the weights, and scales the evidence.
    d  both
       = In the weights a common factor cancels against the sum.""")

CODE = Question("Code")


@code(
    """Weigh in logarithms
    A product of weights is a sum of log-weights.
    Find the largest, subtract it, then exponentiate and sum.
    total = log_w + log_likelihood; log_sum = max + log(sum(exp(total - max))).""",
    fingerprint=_print_update,
)
def update(log_w, log_likelihood):
    return pf.normalise(log_w + log_likelihood)


update.holds("the weights are the old weights times the likelihood, normalised", _matches(0))
update.holds("the evidence is the sum that was divided out", _matches(1))
update.holds("likelihoods of exp(-100000) survive", _survives)
update.holds("the arguments are left as they were", _leaves)
update.wrong("""forgets-old: forgets the old weights
    Without a resampling in between, what did the particle earn before?
    The old log-weight belongs in the sum.
    Start from log_w + log_likelihood.""")(lambda log_w, ll: pf.normalise(np.array(ll)))


@update.wrong("""subtracts the largest log-weight but never divides by the sum
    Do your weights sum to one?
    Subtracting the maximum makes the largest weight one, not the sum.
    Subtract max + log(sum(exp(total - max))).""")
def _max_only(log_w, ll):
    total = log_w + ll
    return total - total.max(), total.max()


update.wrong("""mean-evidence: averages over the particles a second time
    The old weights already contain 1/M.
    The evidence is a weighted sum, not a mean.
    Do not subtract log M.""")(
    lambda log_w, ll: (update(log_w, ll)[0], update(log_w, ll)[1] - np.log(len(ll)))
)
update.wrong("""underflow: goes through ordinary weights, which underflow
    What is exp(-1000) in a computer?
    Take the exponential only after you have subtracted the largest.
    np.exp(total - total.max()) is between 0 and 1, with at least one 1.""")(
    _direct, when=lambda f: _matches(0)(f) and not _survives(f)
)


@code(
    """Resample with a comb
    Lay the weights end to end; where do M evenly spaced teeth fall?
    Teeth (k + U) / M for k = 0 .. M-1 with one U; edges are the summed weights.
    np.searchsorted(edges[:-1], teeth): what lies beyond all other edges is the last.""",
    points=2,
)
def sir(state, log_w, rng):
    M = log_w.size
    ancestors = pf.systematic(np.exp(log_w), rng)
    return state[:, ancestors], np.full(M, -np.log(M))


sir.holds("every new particle is an old one, position and heading together", _in_columns)
sir.holds("all new log-weights are -log M", _equal_weights)
sir.holds("each particle gets the floor or the ceiling of M w copies", _comb)
sir.holds("on average M w copies, within 5 standard errors over 200 draws", _unbiased)
sir.holds("the last tooth never runs off the end", _no_overrun)
sir.wrong("""keeps-weights: returns the old weights with the copies
    A heavy particle now has several copies. Should each weigh as much as before?
    The copies carry the weight; each counts the same.
    Return np.full(M, -np.log(M)).""")(
    lambda s, lw, rng: (sir(s, lw, rng)[0], lw),
    when=lambda f: not _equal_weights(f) and _in_columns(f),
)


@sir.wrong(
    """gives headings to other positions than they came with
    Is each of your new columns one of the old ones?
    Draw the ancestors once, then copy whole columns.
    state[:, ancestors] copies all three components together.""",
    when=lambda f: not _in_columns(f) and _equal_weights(f),
)
def torn_apart(state, log_w, rng):
    rows = [row[pf.systematic(np.exp(log_w), rng)] for row in state]
    return np.stack([rows[0], rows[1], rng.permutation(rows[2])]), np.full(5, -np.log(5))


@sir.wrong(
    """lets the last tooth run off the end of the summed weights
    Does your sum of weights end at exactly one?
    Rounding leaves the last edge a little below the last tooth.
    Leave the last edge out of the search: np.searchsorted(edges[:-1], teeth).""",
    when=lambda f: _comb(f) and _unbiased(f),
)
def _overrun(state, log_w, rng):
    M = log_w.size
    ancestors = np.searchsorted(np.cumsum(np.exp(log_w)), (np.arange(M) + rng.random()) / M)
    return state[:, ancestors], np.full(M, -np.log(M))


sir.wrong("""multinomial: throws M independent points instead of one comb
    How many random numbers does your function draw?
    The comb needs a single one.
    teeth = (np.arange(M) + rng.random()) / M.""")(
    lambda s, lw, rng: (s[:, rng.choice(5, 5, p=np.exp(lw))], np.full(5, -np.log(5))),
    when=lambda f: _unbiased(f) and not _comb(f),
)


@sir.wrong(
    """spaces the teeth by 1 / (M - 1)
    Five teeth: how far apart must they be to cover a length of one evenly?
    M teeth make M stretches, not M - 1.
    Space them by 1 / M.""",
    when=lambda f: not _unbiased(f) and _in_columns(f),
)
def _short_comb(state, log_w, rng):
    M = log_w.size
    teeth = rng.random() / M + np.arange(M) / (M - 1)
    ancestors = np.searchsorted(np.cumsum(np.exp(log_w))[:-1], teeth)
    return state[:, ancestors], np.full(M, -np.log(M))


ABLATION = Question("What breaks")


@experiment(
    """ESS without resampling
    Simulate, run with threshold=0, and take the last entry of history.ess.
    pf.run(log, bel, motion, sensor, rng, threshold=0) returns a history.
    return pf.run(log, bel, motion, sensor, rng, threshold=0).ess[-1]""",
    points=2,
    after=no_copy,
    runs=12,
    pool=120,
    claim="without resampling a handful of 1,000 particles carries everything",
    test="median of 12 runs at most 5 and none above 60",
    margin="of 600 runs none above 1.2",
)
def no_copy_x(rng, threshold=0.0, M=1000):
    world = pf.worlds.arena()
    motion = pf.VelocityMotion(alpha=(0.02, 0.002, 0.002, 0.02, 0.002, 0.002))
    sensor = pf.RangeBearing(world, 0.3, 0.1)
    route = pf.worlds.arena_route()[:, :50]
    log = pf.simulate_log(pf.worlds.ARENA_START, route, motion, sensor, rng)
    bel = pf.uniform_prior(M, world, rng)
    return pf.run(log, bel, motion, sensor, rng, threshold=threshold).ess[-1]


no_copy_x.holds("an effective sample size: at least 1", lambda x: (x >= 1 - 1e-9).all())
no_copy_x.holds("median of the runs at most 5", lambda x: np.median(x) <= 5)
no_copy_x.holds("no run above 60", lambda x: x.max() <= 60)
no_copy_x.wrong("""resamples: still resamples: far too many particles matter
    What does threshold=0 do, and what is the default?
    The default resamples below M / 2.
    Pass threshold=0 to pf.run.""")(
    lambda rng: no_copy_x(rng, 0.5), when=lambda x: np.median(x) > 60
)
no_copy_x.wrong("""share: returns a share, not a number of particles
    Can less than one particle matter?
    Do not divide by M.
    history.ess already counts particles.""")(
    lambda rng: no_copy_x(rng) / 1000, when=lambda x: (x < 1).all()
)


@experiment(
    """Distinct particles of a robot that stands still
    Weigh and copy at every step; do not move.
    np.unique(bel.state[0]).size counts different particles.
    Return np.unique(bel.state[0]).size after the last resampling.""",
    points=2,
    after=frozen,
    runs=20,
    pool=400,
    claim="without diffusion the cloud collapses onto one or two particles",
    test="median of 20 runs at most 2 and none above 5",
    margin="of 400 runs none above 2, the median 1",
)
def frozen_x(rng, jitter=0.0):
    world, pose = pf.worlds.arena(), np.array([5.0, 4.0, 0.0])
    sensor, bel = pf.RangeBearing(world, 2.0, 0.5), pf.uniform_prior(100, world, rng)
    for _ in range(60):
        bel = pf.roughen(bel, rng, jitter)
        bel, _ = pf.update(bel, sensor.sample(pose, rng), sensor)
        bel = pf.resample(bel, pf.systematic, rng)
    return np.unique(bel.state[0]).size


frozen_x.holds("a whole number, at least 1", lambda x: (x >= 1).all() and (x % 1 == 0).all())
frozen_x.holds("median of the runs at most 2", lambda x: np.median(x) <= 2)
frozen_x.holds("no run above 5", lambda x: x.max() <= 5)
frozen_x.wrong("""ess: returns the effective sample size, which is blind here
    Is 100 the number of different particles?
    After resampling all weights are equal, so the ESS is M.
    Count different positions instead.""")(
    lambda rng: 100.0, when=lambda x: (np.abs(x - 100) < 1e-6).all()
)
frozen_x.wrong("""jitter: still moves the particles with noise, so they stay different
    Which line makes copies different again?
    A robot that stands still has no motion noise in this experiment.
    Leave out predict altogether.""")(
    lambda rng: frozen_x(rng, jitter=0.2), when=lambda x: np.median(x) > 5 and x.std() > 0
)

blind = Text(
    """Why is the effective sample size blind?
    says that it looks at weights only, not at places
    says that copies of one particle have equal weights, hence ESS = M
    names distinct particles, spread, evidence or error as what would have told""",
    model="The ESS looks only at how equal the weights are, and copies of one guess weigh the "
    "same. So it is M even when every particle stands in the same wrong place. "
    "The number of distinct particles, or a falling evidence, would have told us.",
)


LAB = Lab.of(__name__, "The particle filter, assembled")
__getattr__ = LAB.verb
