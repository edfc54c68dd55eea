"""The particle filter, assembled. Questions on one turn of the filter."""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, copying, experiment
from pfkit.labs.response import Watched, same_mean, same_scatter

PREDICT = Question("Predictions")

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


def _wall(z):
    """Five particles at 4, 5, 5, 6, 6 m before a wall at 10 m that reads z."""
    errors = np.array([6.0, 5.0, 5.0, 4.0, 4.0]) - z
    likelihood = np.exp(-0.5 * errors**2)
    return {"z": z, "e": round(z - 6, 1), "top": likelihood[0], "total": likelihood.sum()}


hand = Numeric(
    """Weight of the particle that was at 3 m, when the wall reads {z} m
    Move first: after the metre the particle is at 4 m. What does it expect to read?
    It expects 6.0 m, so its error is {z} - 6.0 = {e} m.
    exp(-({e})^2 / 2) = {top:.3f}; divide by the sum of all five, {total:.3f}.""",
    lambda top, total, **_: round(top / total, 3),
    tol=0.002,
    world=_wall(4.6),
    draw=lambda rng: _wall(int(rng.integers(40, 57)) / 10),
)


def _weight(z, at, power=0.5):
    likelihood = np.exp(-power * (z - (10 - np.array(at))) ** 2)
    return likelihood[0] / likelihood.sum()


hand.wrong("""not-normalised: is a likelihood that was not divided by the sum
    Weights of a set sum to one.
    Add the five likelihoods.
    The five sum to {total:.3f}; divide by it.""")(lambda top, **_: top)
hand.wrong("""no-half: uses exp(-e^2) instead of exp(-e^2 / 2)
    Look at the exponent of the Gaussian.
    A Gaussian of standard deviation 1 falls to 0.607 at e = 1.
    The exponent is -e^2 / 2, so the likelihood of e = {e} is {top:.3f}.""")(
    lambda z, **_: _weight(z, [4, 5, 5, 6, 6], 1.0)
)
hand.wrong("""not-moved: weighs the particles where they were before the robot moved
    What comes first, moving or weighing?
    The reading was taken after the second metre.
    The particles stand at 4, 5, 5, 6, 6 m when the wall reads {z} m.""")(
    lambda z, **_: _weight(z, [3, 4, 4, 5, 5])
)
hand.wrong("""neighbour: is the weight of a particle that was at 4 m
    Which of the five does the question ask for?
    Only one of them stood at 3 m.
    It stands at 4 m now, and expects 6.0 m.""")(lambda z, **_: _weight(z, [5, 4, 5, 6, 6]))

ess = Numeric(
    """Effective sample size of the five, when the wall reads 4.6 m
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
ess.wrong("""not-normalised: squares likelihoods that were not divided by their sum
    What do the five numbers that you squared sum to?
    Divide them by their sum first.
    The weights are 0.096, 0.237, 0.237, 0.215, 0.215.""")(0.309)

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


def _case(seed, M=7, scale=1.0):
    rng = np.random.default_rng(seed)
    return pf.normalise(rng.normal(size=M))[0], scale * rng.normal(size=M) - 2.0


def _direct(log_w, ll):
    w = np.exp(log_w) * np.exp(ll)
    return np.log(w / w.sum()), np.log(w.sum())


def _matches(part):
    def holds(f):
        for seed in range(8):
            case = _case(seed, M=(1, 2, 7, 30)[seed % 4])
            found = np.asarray(f(*case)[part], dtype=float)
            wanted = _direct(*case)[part]
            if np.shape(found) != np.shape(wanted):
                return f"shape {np.shape(found)}, expected {np.shape(wanted)}"
            if not np.allclose(found, wanted, rtol=0, atol=1e-9):
                return False
        return True

    return holds


def _survives(f):
    log_w, ll = _case(1)
    found, log_sum = f(log_w, ll - 1e5)
    return bool(
        np.allclose(found, _direct(log_w, ll)[0])
        and np.isclose(log_sum, _direct(log_w, ll)[1] - 1e5)
    )


def _excludes(f):
    log_w, ll = _case(4)
    log_w[2] = ll[5] = -np.inf
    with np.errstate(divide="ignore"):
        wanted = np.exp(_direct(log_w, ll)[0])
    return bool(np.allclose(np.exp(np.asarray(f(log_w, ll)[0], dtype=float)), wanted))


def _leaves(f):
    log_w, ll = _case(2)
    before = log_w.copy(), ll.copy()
    f(log_w, ll)
    return np.array_equal(before[0], log_w) and np.array_equal(before[1], ll)


def _print_update(f):
    log_w, ll = f(*_case(3))
    return np.concatenate((np.ravel(log_w), np.ravel(ll)))


@code(
    """Weigh in logarithms
    A product of weights is a sum of log-weights.
    Find the largest, subtract it, then exponentiate and sum.
    total = log_w + log_likelihood; log_sum = max + log(sum(exp(total - max))).""",
    fingerprint=_print_update,
)
def update(log_w, log_likelihood):
    total = log_w + log_likelihood
    largest = total.max()
    log_sum = largest + np.log(np.sum(np.exp(total - largest)))
    return total - log_sum, log_sum


update.holds("the weights are the old weights times the likelihood, normalised", _matches(0))
update.holds("the evidence is the sum that was divided out", _matches(1))
update.holds("likelihoods of exp(-100000) survive", _survives)
update.holds("a weight or a likelihood of zero makes a weight of zero", _excludes)
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
    _direct,
    when=lambda f: bool(_matches(0)(f) is True and _matches(1)(f) is True and _only_small(f)),
)


def _only_small(f):
    """Right for likelihoods of exp(-100), not finite for exp(-100000)."""
    log_w, ll = _case(1)
    with np.errstate(all="ignore"):
        lost = not np.isfinite(np.asarray(f(log_w, ll - 1e5)[1], dtype=float))
    found, log_sum = f(log_w, ll - 100)
    fine = np.allclose(found, _direct(log_w, ll)[0]) and np.isclose(
        log_sum, _direct(log_w, ll)[1] - 100
    )
    return lost and fine


@update.wrong("""never adds the largest log-weight back to the logarithm of the sum
    What is the sum of exp(total), when you have the sum of exp(total - max)?
    You divided every term by exp(max).
    log_sum = max + log(sum(exp(total - max)))""")
def forgets_largest(log_w, ll):
    total = log_w + ll
    log_sum = np.log(np.sum(np.exp(total - total.max())))
    return total - total.max() - log_sum, log_sum


update.wrong("""evidence-itself: returns the evidence, where its logarithm is asked for
    What becomes of exp(-100000)?
    A logarithm is a sum, the evidence a product of small numbers.
    Return log_sum, without the exponential.""")(
    lambda log_w, ll: (update(log_w, ll)[0], np.exp(update(log_w, ll)[1]))
)
update.wrong("""weights-themselves: returns weights, where log-weights are asked for
    Can a log-weight of a normalised set be positive?
    Leave the weights in logarithms; the next update adds to them.
    Return total - log_sum.""")(
    lambda log_w, ll: (np.exp(update(log_w, ll)[0]), update(log_w, ll)[1])
)
update.wrong("""swapped: returns the evidence first and the log-weights second
    Which of the two has the shape (M,)?
    First the new log-weights, then the logarithm of the evidence.
    return total - log_sum, log_sum""")(lambda log_w, ll: update(log_w, ll)[::-1])
update.refuses("a weight too much: log_w added twice")(lambda log_w, ll: update(log_w, log_w + ll))
update.refuses("logarithms to the base of two")(
    lambda log_w, ll: tuple(x / np.log(2) for x in update(log_w, ll))
)
update.refuses("a floor under the weights")(lambda log_w, ll: update(log_w, np.maximum(ll, -700.0)))
update.refuses("1e-300 added to save the logarithm")(
    lambda log_w, ll: (
        np.log(np.exp(log_w + ll) + 1e-300) - np.log(np.sum(np.exp(log_w + ll)) + 1e-300),
        np.log(np.sum(np.exp(log_w + ll)) + 1e-300),
    )
)


STATE = np.array([[1.0, 2, 3, 4, 5], [10, 20, 30, 40, 50], [0.1, 0.2, 0.3, 0.4, 0.5]])


def _set_of(w):
    k = np.arange(float(w.size))
    with np.errstate(divide="ignore"):
        return np.stack((k, 10 * k, 0.001 * k)), np.log(w)


def _ancestors(f):
    """The function as a resampler: weights and rng to indices."""
    return lambda w, rng: np.asarray(f(*_set_of(w), rng)[0])[0].astype(int)


def _kind(shows):
    return lambda f: shows(_ancestors(f))


def _in_columns(f):
    for M in (5, 12):
        state, log_w = _set_of(copying.of_size(M))
        found = np.asarray(f(state, log_w, np.random.default_rng(3))[0])
        if found.shape != state.shape:
            return f"shape {found.shape} of {state.shape}"
        if not all(any(np.array_equal(c, s) for s in state.T) for c in found.T):
            return False
    return True


def _equal_weights(f):
    for M in (5, 12):
        log_w = np.asarray(f(*_set_of(copying.of_size(M)), np.random.default_rng(4))[1])
        if log_w.shape != (M,) or not np.allclose(log_w, -np.log(M)):
            return False
    return True


def _same_weights(f):
    state, log_w = _set_of(copying.of_size(12))
    return np.array_equal(f(state, log_w.copy(), np.random.default_rng(4))[1], log_w)


def _torn(f):
    """Each row holds old values, but they do not belong together."""
    state, log_w = _set_of(copying.of_size(12))
    found = np.asarray(f(state, log_w, np.random.default_rng(3))[0])
    return (
        found.shape == state.shape
        and all(np.isin(new, old).all() for new, old in zip(found, state, strict=True))
        and _in_columns(f) is False
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
    edges = np.cumsum(np.exp(log_w))
    teeth = (np.arange(M) + rng.random()) / M
    ancestors = np.searchsorted(edges[:-1], teeth)
    return state[:, ancestors], np.full(M, -np.log(M))


sir.holds("every new particle is an old one, position and heading together", _in_columns)
sir.holds("all new log-weights are -log M", _equal_weights)
sir.holds(f"M particles, for each M to {copying.LARGEST}", _kind(copying.all_sizes))
sir.holds(
    "each particle gets the floor or the ceiling of M w copies", _kind(copying.floor_or_ceiling)
)
sir.holds("on average M w copies, within 5 standard errors over 800 draws", _kind(copying.fair))
sir.holds("the last tooth never runs off the end", _kind(copying.rough))
sir.holds("all luck comes from rng: the same rng, the same copies", _kind(copying.luck_from_rng))


def _sir_by(draw):
    """The function whose ancestors come from ``draw``."""

    def by_another(state, log_w, rng):
        M = log_w.size
        return state[:, draw(np.exp(log_w), rng)], np.full(M, -np.log(M))

    return by_another


sir.wrong(
    """global-luck: draws from a generator of its own, not from rng
    Call it twice with np.random.default_rng(1): should the copies differ?
    np.random.random() does not know your rng.
    U = rng.random()""",
    when=_kind(lambda draw: not copying.luck_from_rng(draw)),
)(_sir_by(lambda w, rng: copying.of_comb(w, np.random.default_rng())))
sir.wrong("""keeps-weights: returns the old weights with the copies
    A heavy particle now has several copies. Should each weigh as much as before?
    The copies carry the weight; each counts the same.
    Return np.full(M, -np.log(M)).""")(
    lambda s, lw, rng: (sir(s, lw, rng)[0], lw), when=_same_weights
)


@sir.wrong(
    """gives headings to other positions than they came with
    Is each of your new columns one of the old ones?
    Draw the ancestors once, then copy whole columns.
    state[:, ancestors] copies all three components together.""",
    when=_torn,
)
def torn_apart(state, log_w, rng):
    rows = [sir(state, log_w, rng)[0][k] for k in range(3)]
    return np.stack([rows[0], rows[1], rng.permutation(rows[2])]), sir(state, log_w, rng)[1]


sir.wrong(
    """off-by-one: copies the neighbour of the particle under the tooth
    Which particle does the first tooth touch?
    The summed weights are right edges: the first is w of particle 0.
    No leading zero in the edges, and no + 1 or - 1.""",
    when=_kind(copying.is_off_by_one),
)(_sir_by(copying.off_by_one))
sir.wrong(
    """one-too-many: has a tooth too many for some sizes, such as M = 49
    How long is np.arange(0, 1, 1 / 49)?
    Steps of 1 / M add up with rounding errors, and the end may slip in.
    np.arange(M) / M has M entries for certain.""",
    when=_kind(copying.has_one_too_many),
)(_sir_by(copying.one_too_many))
sir.wrong(
    """no-luck: makes the same copies whatever rng says
    Where is the random number?
    The comb starts at a random place within one spacing.
    teeth = (np.arange(M) + rng.random()) / M""",
    when=_kind(copying.never_varies),
)(_sir_by(copying.in_the_middle))
sir.wrong("""overrun: lets the last tooth run off the end of the summed weights
    Does your sum of weights end at exactly one?
    Rounding leaves the last edge a little below the last tooth.
    Leave the last edge out of the search: np.searchsorted(edges[:-1], teeth).""",
    when=_kind(copying.runs_off),
)(_sir_by(copying.trusting))  # fmt: skip
sir.wrong("""stratified: throws one point into each stratum instead of one comb
    How many random numbers does your function draw?
    The comb needs a single one; all teeth share it.
    teeth = (np.arange(M) + rng.random()) / M, without an argument for random.""",
    when=_kind(copying.is_stratified),
)(_sir_by(lambda w, rng: pf.stratified(w, rng)))  # fmt: skip
sir.wrong(
    """multinomial: throws M independent points instead of one comb
    How many random numbers does your function draw?
    The comb needs a single one.
    teeth = (np.arange(M) + rng.random()) / M.""",
    when=_kind(copying.is_multinomial),
)(_sir_by(lambda w, rng: rng.choice(w.size, w.size, p=w / w.sum())))
sir.wrong("""short-comb: spaces the teeth by 1 / (M - 1)
    Five teeth: how far apart must they be to cover a length of one evenly?
    M teeth make M stretches, not M - 1.
    Space them by 1 / M.""",
    when=lambda f: copying.draws_as(
        _ancestors(f), copying.too_wide, copying.too_wide_throughout
    ),
)(_sir_by(lambda w, rng: copying.too_wide(w, rng) if w.size > 1 else [0]))  # fmt: skip
sir.refuses("an index too high, not clipped", named="off-by-one")(
    lambda s, lw, rng: (
        np.append(s, s[:, -1:], axis=1)[:, copying.of_comb(np.exp(lw), rng) + 1],
        np.full(lw.size, -np.log(lw.size)),
    )
)
sir.refuses("NumPy's global generator", named="global-luck")(
    _sir_by(lambda w, rng: np.random.choice(w.size, w.size, p=w / w.sum()))  # noqa: NPY002
)
sir.refuses("an offset that is not uniform")(
    _sir_by(
        lambda w, rng: np.searchsorted(
            copying.edges(w), (np.arange(w.size) + rng.beta(2, 2)) / w.size
        )
    )
)
sir.refuses("the resampling wheel")(_sir_by(lambda w, rng: pf.resampling_wheel(w, rng)))
sir.refuses("the residual scheme")(_sir_by(lambda w, rng: pf.residual(w, rng)))
sir.refuses("the set as it was, with equal weights")(
    lambda s, lw, rng: (s, np.full(lw.size, -np.log(lw.size)))
)
sir.refuses("weights instead of log-weights")(
    lambda s, lw, rng: (sir(s, lw, rng)[0], np.full(lw.size, 1 / lw.size))
)
sir.refuses("a cloud in motion")(
    lambda s, lw, rng: (
        sir(s, lw, rng)[0] + 1e-3 * rng.standard_normal(s.shape),
        np.full(lw.size, -np.log(lw.size)),
    )
)

ABLATION = Question("What breaks")


def _left(M, steps, rng, threshold=0.0, uniform=False):
    """ESS at each of the steps."""
    world, start = pf.worlds.arena(), pf.worlds.ARENA_START
    motion = pf.VelocityMotion(alpha=(0.02, 0.002, 0.002, 0.02, 0.002, 0.002))
    sensor = pf.RangeBearing(world, 0.3, 0.1)
    log = pf.simulate_log(start, pf.worlds.arena_route()[:, :steps], motion, sensor, rng)
    bel = pf.gaussian_prior(M, start, [0.5, 0.5, 0.1], rng)
    if uniform:
        bel = pf.uniform_prior(M, world, rng)
    return pf.run(log, bel, motion, sensor, rng, threshold=threshold).ess


@experiment(
    """ESS without resampling
    Simulate so many steps, run with threshold=0, and take the last entry of history.ess.
    pf.run(log, bel, motion, sensor, rng, threshold=0) returns a history.
    return pf.run(log, bel, motion, sensor, rng, threshold=0).ess[-1]""",
    points=2,
    after=no_copy,
    runs=45,
    pool=540,
    settings=lambda rng: [
        (int(rng.integers(200, 800)), int(rng.integers(low, high)))
        for low, high in ((1, 3), (7, 11), (9, 15))
    ],
    claim="without resampling the effective sample size falls with every step, soon to a handful",
    test="mean of log ESS within 4.5 standard errors of a right experiment's, for three sizes and "
    "numbers of steps",
    margin="two equal means within 4.5 standard errors in four comparisons: 8e-5",
)
def no_copy_x(M, steps, rng):
    world, start = pf.worlds.arena(), pf.worlds.ARENA_START
    motion = pf.VelocityMotion(alpha=(0.02, 0.002, 0.002, 0.02, 0.002, 0.002))
    sensor = pf.RangeBearing(world, sigma_r=0.3, sigma_phi=0.1)
    log = pf.simulate_log(start, pf.worlds.arena_route()[:, :steps], motion, sensor, rng)
    bel = pf.gaussian_prior(M, start, [0.5, 0.5, 0.1], rng)
    return pf.run(log, bel, motion, sensor, rng, threshold=0).ess[-1]


def _log(x):
    return np.log(np.maximum(x, 1e-12))


no_copy_x.holds(
    "an effective sample size: at least 1", lambda x: bool((x[..., 0] >= 1 - 1e-9).all())
)
no_copy_x.holds("it falls with size and steps as in a right run", lambda x: same_mean()(_log(x)))
no_copy_x.holds("it differs from run to run as there", lambda x: same_scatter(4)(_log(x)))
no_copy_x.wrong("""resamples: still resamples, so that many particles matter
    What does threshold=0 do, and what is the default?
    The default resamples below M / 2.
    Pass threshold=0 to pf.run.""")(lambda M, steps, rng: _left(M, steps, rng, 0.5)[-1])
no_copy_x.wrong("""share: returns a share, not a number of particles
    Can less than one particle matter?
    Do not divide by M.
    history.ess already counts particles.""")(lambda M, steps, rng: _left(M, steps, rng)[-1] / M)
no_copy_x.wrong("""first: takes the effective sample size after the first measurement
    Which entry of history.ess is the last?
    Python counts from 0, and from the end with -1.
    history.ess[-1]""")(lambda M, steps, rng: _left(M, steps, rng)[0])
no_copy_x.wrong("""average: averages over the steps
    The question asks for what is left at the end.
    Early steps have many particles that matter; they lift the mean.
    history.ess[-1]""")(lambda M, steps, rng: _left(M, steps, rng).mean())
no_copy_x.wrong("""distinct: counts different particles, and without copying all M are
    Do all of them matter?
    Weights, not places, are what differs here.
    history.ess[-1]""")(lambda M, steps, rng: M)
no_copy_x.refuses("a constant at the right value of late steps")(lambda M, steps, rng: 1.0)
no_copy_x.refuses("a cloud all over the hall")(
    lambda M, steps, rng: _left(M, steps, rng, uniform=True)[-1]
)
no_copy_x.refuses("the smallest of the run")(lambda M, steps, rng: _left(M, steps, rng).min())
no_copy_x.refuses("a formula that falls")(lambda M, steps, rng: M / (10 * steps))
no_copy_x.refuses("random in range")(lambda M, steps, rng: rng.uniform(1, M / 4))
no_copy_x.refuses("half of the particles")(lambda M, steps, rng: _left(M // 2, steps, rng)[-1])
no_copy_x.refuses("another size than asked for")(lambda M, steps, rng: _left(1000, steps, rng)[-1])
no_copy_x.refuses("two steps too many")(lambda M, steps, rng: _left(M, steps + 2, rng)[-1])
no_copy_x.refuses("right mean, no scatter")(
    lambda M, steps, rng: np.exp(
        np.mean([np.log(_left(M, steps, np.random.default_rng(k))[-1]) for k in range(8)])
    )
)

MOST, LEAST = 40, 5  # steps, and different particles, at which a still robot's experiment ends


class _Weighing(Watched):
    """A sensor that notes how many particles it weighs, and how few different ones."""

    def __init__(self, sensor):
        super().__init__(sensor)
        self.sizes, self.fewest = set(), np.inf

    def log_likelihood(self, z, pose):
        x = np.asarray(pose)[0]
        self.sizes.add(x.size)
        self.fewest = min(self.fewest, np.unique(x).size)
        return self.__getattr__("log_likelihood")(z, pose)


def _stills(f, rng, runs):
    """Answer, reference, weighings, readings, whether of M particles, fewest different ones."""
    found = np.zeros((runs, 2, 6))
    world = pf.worlds.arena()
    for i, child in enumerate(rng.spawn(runs)):
        for k, noise in enumerate(((2.0, 0.5), (4.0, 0.8))):
            M, seed = int(child.integers(60, 200)), child.integers(2**32)
            sensor = pf.RangeBearing(world, *noise)
            heard = _Weighing(sensor)
            theirs = np.asarray(f(heard, M, np.random.default_rng(seed)), dtype=float).item()
            ours = frozen_x(sensor, M, np.random.default_rng(seed))
            asked = heard.calls.get("log_likelihood", 0), heard.calls.get("sample", 0)
            found[i, k] = theirs, ours, *asked, heard.sizes == {M}, min(heard.fewest, M)
    return found


@experiment(
    """Steps until the cloud of a still robot has fewer than five different particles
    Weigh and copy at every step; do not move.
    np.unique(bel.state[0]).size counts different particles.
    Count the steps in a loop, and leave it when fewer than five are different, or after 40.""",
    points=2,
    after=frozen,
    runs=40,
    pool=300,
    measure=_stills,
    claim="without diffusion the cloud collapses within a few steps, sooner with a sharper sensor",
    test="two sensors, 60 to 199 particles: as many steps as weighings, and the mean within 4.5 "
    "standard errors of a right experiment's",
    margin="two equal means within 4.5 standard errors in three comparisons: 2e-5",
)
def frozen_x(sensor, M, rng):
    pose = np.array([5.0, 4.0, 0.0])
    bel, steps = pf.uniform_prior(M, pf.worlds.arena(), rng), 0
    while np.unique(bel.state[0]).size >= 5 and steps < 40:
        bel, _ = pf.update(bel, sensor.sample(pose, rng), sensor)
        bel = pf.resample(bel, pf.systematic, rng)
        steps += 1
    return steps


def _still(sensor, M, rng, jitter=0.0, copy=True, by_ess=False, again=True):
    """The same with one thing changed."""
    pose, z = np.array([5.0, 4.0, 0.0]), None
    bel, steps, left = pf.uniform_prior(M, pf.worlds.arena(), rng), 0, M
    while left >= LEAST and steps < MOST:
        z = sensor.sample(pose, rng) if z is None or again else z
        bel = pf.roughen(bel, rng, jitter) if jitter else bel
        bel, _ = pf.update(bel, z, sensor)
        weighed = bel
        bel = pf.resample(bel, pf.systematic, rng) if copy else bel
        left = weighed.ess if by_ess else np.unique(bel.state[0]).size
        steps += 1
    return steps


def _to_one(sensor, M, rng):
    bel, steps = pf.uniform_prior(M, pf.worlds.arena(), rng), 0
    while np.unique(bel.state[0]).size > 1 and steps < MOST:
        bel, _ = pf.update(bel, sensor.sample(np.array([5.0, 4.0, 0.0]), rng), sensor)
        bel = pf.resample(bel, pf.systematic, rng)
        steps += 1
    return steps


frozen_x.holds(
    "a whole number of steps, at least 1",
    lambda x: bool((x[..., 0] >= 1).all() and (x[..., 0] % 1 == 0).all()),
)
frozen_x.holds(
    "one weighing with your sensor for each step",
    lambda x: bool((x[..., 0] == x[..., 2]).all()),
)
frozen_x.holds("and one new measurement", lambda x: bool((x[..., 0] == x[..., 3]).all()))
frozen_x.holds("with M particles", lambda x: bool((x[..., 4] == 1).all()))
frozen_x.holds(
    "it ends as soon as fewer than five are different",
    lambda x: bool((x[..., 5] >= LEAST).all()),
)
frozen_x.holds("the mean is that of a right experiment", lambda x: same_mean()(x[..., :2]))
frozen_x.holds("the runs differ as there", lambda x: same_scatter(5)(x[..., :2]))
frozen_x.wrong("""no-run: never weighs with the sensor that it was given
    What collapses, if nothing is weighed?
    The check hands over two sensors, and the sharper one is quicker.
    bel, _ = pf.update(bel, sensor.sample(pose, rng), sensor)""")(
    lambda sensor, M, rng: 6, when=lambda x: bool((x[..., 2] == 0).all())
)
frozen_x.wrong("""never: does not see it happen in 40 steps, for any sensor
    What makes particles equal, and what makes them different again?
    Copying makes them equal; noise of any kind makes copies different. And the ESS after copying
         is always M.
    Resample at every step, add no noise, count np.unique(bel.state[0]).""")(
    lambda sensor, M, rng: _still(sensor, M, rng, copy=False),
    when=lambda x: bool((x[..., 0] == MOST).all() and (x[..., 2] == MOST).all()),
)
frozen_x.wrong("""one-reading: uses the same measurement again and again
    Does the robot measure once, or at every step?
    One reading, weighed forty times, claims what it cannot know.
    Call sensor.sample(pose, rng) inside the loop.""")(
    lambda sensor, M, rng: _still(sensor, M, rng, again=False),
    when=lambda x: bool((x[..., 3] == 1).all() and (x[..., 2] == x[..., 0]).all()
                        and x[..., 0].max() > 1),
)  # fmt: skip
frozen_x.wrong("""late: goes on weighing although fewer than five different particles are left
    How many were different when it last weighed?
    The effective sample size is blind here: it looks at weights. Count places.
    while np.unique(bel.state[0]).size >= 5""",
    when=lambda x: bool((x[..., 5] < LEAST).any() and (x[..., 0] == x[..., 2]).all()),
)(_to_one)  # fmt: skip
frozen_x.wrong("""off-by-one: is off by one from the number of weighings that it made
    How often had it weighed when it returned?
    Count inside the loop, once per step.
    Start the count at 0.""")(
    lambda sensor, M, rng: frozen_x(sensor, M, rng) + 1,
    when=lambda x: bool((np.abs(x[..., 0] - x[..., 2]) == 1).all() and np.ptp(x[..., 2]) > 1),
)
frozen_x.refuses("distinct particles, without a run", named="no-run")(lambda sensor, M, rng: 1)
frozen_x.refuses("random in range", named="no-run")(lambda sensor, M, rng: int(rng.integers(2, 12)))
frozen_x.refuses("a sensor of its own", named="no-run")(
    lambda sensor, M, rng: frozen_x(pf.RangeBearing(pf.worlds.arena(), 2.0, 0.5), M, rng)
)
frozen_x.refuses("watches the effective sample size before copying", named="late")(
    lambda sensor, M, rng: _still(sensor, M, rng, by_ess=True)
)
frozen_x.refuses("half of the particles")(lambda sensor, M, rng: frozen_x(sensor, M // 2, rng))
frozen_x.refuses("moves the copies apart with noise")(
    lambda sensor, M, rng: _still(sensor, M, rng, jitter=0.2)
)


@frozen_x.refuses("as many weighings as a guess says")
def _guessed(sensor, M, rng):
    bel, guess = pf.uniform_prior(M, pf.worlds.arena(), rng), int(rng.integers(2, 12))
    for _ in range(guess):
        pf.update(bel, sensor.sample(np.array([5.0, 4.0, 0.0]), rng), sensor)
    return guess


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
