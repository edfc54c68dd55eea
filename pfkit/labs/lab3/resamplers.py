"""Q4: random numbers, and the resamplers."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Numeric, Question, code
from pfkit.labs.response import calls
from pfkit.labs.statistics import rng_of

Q4 = Question("Random numbers, and the resamplers")

W = np.array([0.40, 0.25, 0.15, 0.12, 0.08])
W3 = np.array([0.32, 0.32, 0.36])
W8 = np.array([0.02, 0.31, 0.09, 0.14, 0.05, 0.11, 0.21, 0.07])

LARGEST_U = 1 - 2**-53  # that rng.random() can return


class Counting:
    """A random generator that counts the random numbers it hands out."""

    def __init__(self, seed: int) -> None:
        self._rng, self.count = rng_of(seed), 0

    def __getattr__(self, name):
        method = getattr(self._rng, name)

        def counted(*args, **kwargs):
            out = method(*args, **kwargs)
            self.count += np.size(out)
            return out

        return counted


class Same:
    """A random generator whose uniform numbers are all alike."""

    def __init__(self, u: float) -> None:
        self._rng, self._u = rng_of(0), u

    def random(self, size=None):
        return self._u if size is None else np.full(size, self._u)

    def uniform(self, low=0.0, high=1.0, size=None):
        return low + (high - low) * self.random(size)

    def __getattr__(self, name):
        return getattr(self._rng, name)


def _ancestors(scheme, w, rng):
    found = np.asarray(scheme(w.copy(), rng))
    if found.dtype.kind not in "iu" or found.shape != w.shape:
        raise ValueError(f"expected {len(w)} whole numbers, got {found!r:.60}")
    if found.min() < 0 or found.max() >= len(w):
        raise ValueError(f"expected numbers from 0 to {len(w) - 1}, got {found!r:.60}")
    return found


def _counts(scheme, w, runs, seed=0):
    rng = rng_of(seed)
    found = [_ancestors(scheme, w, rng) for _ in range(runs)]
    return np.stack([np.bincount(a, minlength=len(w)) for a in found])


def _unbiased(scheme, w, runs=2500):
    """Every mean number of copies within 5 standard errors of M w."""
    c = _counts(scheme, w, runs)
    bound = 5 * np.maximum(c.std(axis=0), 0.05) / np.sqrt(runs)
    off = np.abs(c.mean(0) - len(w) * w) > bound
    return not off.any() or f"particle {off.argmax()}: {c.mean(0)[off][0]:.2f} copies on average"


def _floor_or_ceil(scheme, w):
    c, expected = _counts(scheme, w, 200), len(w) * w
    return ((c >= np.floor(expected - 1e-9)) & (c <= np.ceil(expected + 1e-9))).all()


def _uses(scheme, w):
    rng = Counting(3)
    scheme(w.copy(), rng)
    return rng.count == 1 or f"it used {rng.count} of rng"


def _any_size(scheme):
    rng = rng_of(5)
    for M in range(1, 121):
        _ancestors(scheme, rng.dirichlet(np.ones(M)), rng)
    return True


def _one_too_many(scheme, M):
    return len(scheme(np.full(M, 1 / M), rng_of(8))) == M + 1


def _guarded(scheme):
    """Is there an ancestor for the last tooth, where rounding leaves the weights' sum below it?"""
    try:
        return bool(_ancestors(scheme, np.full(10, 0.1), Same(LARGEST_U)).max() == 9)
    except (IndexError, ValueError):
        return False


def _from_rng(scheme):
    """Chance comes from rng, and afresh at each call."""
    one, two = rng_of(4), rng_of(4)
    first, again = ([tuple(scheme(W8.copy(), rng)) for _ in range(20)] for rng in (one, two))
    return first == again and len(set(first)) > 1


def _fingerprint(scheme):
    """Mean and variance of the copies, and how far two particles vary together."""
    c = np.concatenate([_counts(scheme, w, 1500, seed=7) for w in (W, W8)], axis=1)
    return [*c.mean(0), *(2 * c.var(0)), 2 * np.cov(c[:, 0], c[:, 1])[0, 1]]


def _numbers_used(w):
    """The question's numbers: weights, particles, certain copies of residual resampling."""
    copies = np.floor(len(w) * np.array(w) + 1e-9).astype(int)
    return {"w": w, "M": len(w), "copies": " + ".join(map(str, copies)), "sure": int(copies.sum())}


def _other_weights(rng):
    """Weights in hundredths, where residual resampling is certain of some copies, not of half."""
    while True:
        M = int(rng.integers(5, 9))
        w = -np.sort(-rng.multinomial(100 - 2 * M, rng.dirichlet(np.ones(M))) - 2) / 100
        found = _numbers_used(tuple(w.tolist()))
        if found["sure"] >= 2 and M - found["sure"] >= 2 and M != 2 * found["sure"]:
            return found


q4a = Numeric(
    """Random numbers used for w = {w}: multinomial, stratified, systematic, residual
    How many decisions of each scheme are left to chance?
    Residual copies floor(M w) particles for certain; count what is left.
    Residual: {M} - ({copies}).""",
    lambda M, sure, **_: (M, M, 1, M - sure),
    tol=0.01,
    names=("multinomial", "stratified", "systematic", "residual"),
    world=_numbers_used((0.40, 0.25, 0.15, 0.12, 0.08)),
    draw=_other_weights,
)
q4a.wrong("""stratified-is-systematic: takes stratified for systematic
    In stratified resampling, is the offset the same in each stratum?
    Each of the M strata draws its own point.
    Stratified uses M numbers.""")(lambda M, sure, **_: (M, 1, 1, M - sure))
q4a.wrong("""stratified-and-systematic: takes stratified for systematic and the other way round
    Which of the two moves all its points together?
    Stratified: each of the M strata draws its own point.
    Systematic: one number moves the whole comb.""")(lambda M, sure, **_: (M, 1, M, M - sure))
q4a.wrong("""residual-all: lets residual draw all particles
    Which copies does residual make without chance?
    The certain copies are {copies}.
    Residual draws only the rest.""")(lambda M, sure, **_: (M, M, 1, M))
q4a.wrong("""residual-certain: gives the number of certain copies for residual
    You counted what is *not* drawn.
    {M} particles in all, {sure} of them certain.
    Residual draws M minus the certain copies.""")(lambda M, sure, **_: (M, M, 1, sure))
q4a.wrong("""calls: counts calls, not numbers
    rng.random(M) is one call. How many numbers does it hand out?
    Each of M independent draws is a number of its own.
    Multinomial uses M numbers.""")(lambda **_: (1, 1, 1, 1))


@code(
    """Systematic resampling
    Lay the weights end to end: np.cumsum(w). Then hold a comb against them.
    The comb has M teeth, 1/M apart; only its offset is random.
    np.searchsorted(np.cumsum(w), (np.arange(M) + rng.random()) / M).""",
    id="q4b",
    points=4,
    fingerprint=_fingerprint,
    atol=0.2,
)
def systematic(w, rng):
    """Ancestor indices, M whole numbers; w (M,) sums to one."""
    M = len(w)
    teeth = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), teeth), M - 1)


systematic.holds("M whole numbers between 0 and M - 1, for M from 1 to 120", _any_size)
systematic.holds("one random number per call", lambda f: _uses(f, W))
systematic.holds(
    "each particle gets floor(M w) or ceil(M w) copies",
    lambda f: _floor_or_ceil(f, W) and _floor_or_ceil(f, W8),
)
systematic.holds("M w copies on average", lambda f: _unbiased(f, W8))
systematic.holds(
    "no index beyond M - 1 where rounding leaves the sum of ten weights .1 below 1",
    _guarded,
)
systematic.holds(
    "it is your own: no call of pf.systematic",
    lambda f: not calls(lambda: f(W.copy(), rng_of(1)), pf.systematic),
)
systematic.wrong("""multinomial: is multinomial resampling: every draw is independent
    How many random numbers does one call use? A comb needs one.
    A comb moves as a whole: one offset, then equal steps.
    Points are (k + U)/M for k = 0 .. M-1, with a single U = rng.random().""")(
    lambda w, rng: np.searchsorted(np.cumsum(w), np.sort(rng.random(len(w))))
)


@systematic.wrong("""is stratified resampling: it draws a fresh offset for every tooth
    Are the distances between your points all equal?
    Stratified takes M random numbers, systematic takes one.
    Call rng.random() once, without a size, and add it to every k.""")
def stratified(w, rng):
    M = len(w)
    return np.searchsorted(np.cumsum(w), (np.arange(M) + rng.random(M)) / M)


@systematic.wrong("""is one place off in the cumulative sum: it picks the neighbour of the right
         particle
    Give all weight to particle 0. Which particle do you copy?
    Particle i owns the stretch that ends at w_0 + ... + w_i, its own weight included.
    Compare the points with np.cumsum(w) itself: the first i with cumsum >= u.""")
def off_by_one(w, rng):
    M = len(w)
    edges = np.concatenate([[0.0], np.cumsum(w)[:-1]])  # the left edges, not the right ones
    return np.minimum(np.searchsorted(edges, (np.arange(M) + rng.random()) / M), M - 1)


@systematic.wrong("""spaces the teeth by 1/(M-1) instead of 1/M
    Where does your last tooth lie? It must stay below 1.
    M teeth share the interval from 0 to 1, so each owns a stretch of 1/M.
    Points are (k + U)/M: divide by M.""")
def stretched_comb(w, rng):
    M = len(w)
    u = rng.random() / M + np.arange(M) / (M - 1)
    return np.minimum(np.searchsorted(np.cumsum(w), u), M - 1)


@systematic.wrong("""draws the offset from the whole interval, so the teeth run past 1
    Where do your last teeth lie if the offset is .9?
    The offset moves the comb within the first gap only.
    The offset is U/M, between 0 and 1/M.""")
def long_offset(w, rng):
    M = len(w)
    u = rng.random() + np.arange(M) / M
    return np.minimum(np.searchsorted(np.cumsum(w), u), M - 1)


@systematic.wrong("""uses no random number at all
    Call it twice. Should the result always be the same?
    A particle with a small weight must survive sometimes, or the scheme is biased.
    Replace the fixed offset by one U = rng.random().""")
def no_chance(w, rng):
    M = len(w)
    return np.searchsorted(np.cumsum(w), (np.arange(M) + 0.5) / M)


def _ignores_rng(scheme):
    """Is it random, although it leaves the given generator where it was?"""
    rng, w = np.random.default_rng(1), np.full(7, 1 / 7) + np.linspace(-0.1, 0.1, 7)
    before = str(rng.bit_generator.state)
    found = {tuple(scheme(w, rng)) for _ in range(30)}
    return len(found) > 1 and str(rng.bit_generator.state) == before


@systematic.wrong(
    """draws from another generator than the one it is given
    Call it twice with np.random.default_rng(1). Should the results agree?
    Nobody can repeat a run whose chance comes from elsewhere.
    Draw with rng.random(), not with np.random.""",
    when=_ignores_rng,
)
def own_generator(w, rng):
    M = len(w)
    own = np.random.default_rng()
    return np.minimum(np.searchsorted(np.cumsum(w), (np.arange(M) + own.random()) / M), M - 1)


def _teeth(w, u, M):
    return np.minimum(np.searchsorted(np.cumsum(w), (np.arange(M) + u) / M), M - 1)


def _gives_counts(scheme):
    """Do its numbers sum to M, on average M w each, as copies do?"""
    rng = rng_of(6)
    found = np.stack([scheme(W8.copy(), rng) for _ in range(300)])
    return bool((found.sum(axis=1) == 8).all() and np.abs(found.mean(0) - 8 * W8).max() < 0.2)


@systematic.wrong(
    """tells how many copies each particle gets, not which particle each copy is of
    What do your numbers sum to? Indices sum to anything.
    The next step is state[:, ancestors].
    Return what np.searchsorted returns, one index for each tooth.""",
    when=_gives_counts,
)
def number_of_copies(w, rng):
    return np.bincount(_teeth(w, rng.random(), len(w)), minlength=len(w))


@systematic.wrong(
    """makes the teeth with np.arange(0, 1, 1/M), which has one too many for some M
    How long is np.arange(0, 1, 1/49)?
    Rounding decides whether the end still belongs to it.
    Count in whole numbers, then divide: (np.arange(M) + U) / M.""",
    when=lambda f: _one_too_many(f, 49) and _one_too_many(f, 98) and _unbiased(f, W8) is True,
)
def arange_of_shares(w, rng):
    M = len(w)
    teeth = np.arange(0, 1, 1 / M) + rng.random() / M
    return np.minimum(np.searchsorted(np.cumsum(w), teeth), M - 1)


@systematic.wrong(
    """returns M where rounding leaves the last cumulative weight below the last tooth
    Ten times .1 is 1, but np.cumsum says 0.9999999999999999.
    In one call of many millions a tooth lies beyond that.
    np.minimum(index, M - 1).""",
    when=lambda f: not _guarded(f) and _unbiased(f, W8) is True and _uses(f, W) is True,
)
def unguarded(w, rng):
    return np.searchsorted(np.cumsum(w), (np.arange(len(w)) + rng.random()) / len(w))


@systematic.refuses("an offset that is not uniform")
def squared_offset(w, rng):
    return _teeth(w, rng.random() ** 2, len(w))


@systematic.refuses("an offset that stays below .9")
def short_offset(w, rng):
    return _teeth(w, 0.9 * rng.random(), len(w))


@systematic.refuses("sorts the weights first, so the indices are those of another order")
def sorted_weights(w, rng):
    return _teeth(np.sort(w), rng.random(), len(w))


@systematic.refuses("counts from 1")
def from_one(w, rng):
    return _teeth(w, rng.random(), len(w)) + 1


@systematic.refuses("global chance", named="own-generator")
def global_chance(w, rng):
    return _teeth(w, np.random.random(), len(w))  # noqa: NPY002


systematic.refuses("calls the library")(lambda w, rng: pf.systematic(w, rng))
systematic.refuses("copies each particle once")(lambda w, rng: np.arange(len(w)))


@code(
    """Residual resampling
    First the certain copies: floor(M w).
    Then draw the missing ones, in proportion to what each still has to get.
    rest = M w - floor(M w); if left > 0: rng.choice(M, left, p=rest / rest.sum()).""",
    id="q4c",
    points=3,
    fingerprint=_fingerprint,
    atol=0.2,
)
def residual(w, rng):
    """Ancestor indices, M whole numbers, in any order."""
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    certain = np.repeat(np.arange(M), copies)
    left = M - len(certain)
    if left == 0:
        return certain
    rest = np.maximum(M * w - copies, 0)
    return np.concatenate([certain, rng.choice(M, left, p=rest / rest.sum())])


residual.holds("M whole numbers between 0 and M - 1, for M from 1 to 120", _any_size)
residual.holds(
    "at least floor(M w) copies of each", lambda f: (_counts(f, W8, 100) >= np.floor(8 * W8)).all()
)
residual.holds("M w copies on average", lambda f: _unbiased(f, W) is True and _unbiased(f, W8))


@residual.holds("the rest is drawn one by one: w = (.32, .32, .36) pays particle 0 twice in 23 %")
def _one_by_one(f, runs=800):
    share = (_counts(f, W3, runs)[:, 0] == 2).mean()
    return abs(share - 0.48**2) < 5 * np.sqrt(0.23 * 0.77 / runs) or f"in {100 * share:.0f} %"


def _once_each(f, M):
    return bool((_counts(f, np.full(M, 1 / M), 5) == 1).all())


residual.holds("equal weights: one copy of each, nothing left to draw", lambda f: _once_each(f, 4))
residual.holds(
    "so also for M = 49, where 49 * (1/49) is a hair below 1", lambda f: _once_each(f, 49)
)
residual.holds("its chance comes from rng, afresh at each call", _from_rng)
residual.holds(
    "it is your own: no call of pf.residual",
    lambda f: not calls(lambda: f(W.copy(), rng_of(1)), pf.systematic),
)


@residual.wrong("""draws the rest with equal chances for all
    In w = (.40, .25, .15, .12, .08) particle 0 has all it is owed. Can it get one more?
    Some particles are owed more of the rest than others.
    Draw with p = rest / rest.sum(), rest = M w - floor(M w).""")
def rest_uniform(w, rng):
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    return np.concatenate([np.repeat(np.arange(M), copies), rng.integers(0, M, M - copies.sum())])


@residual.wrong("""never gives a particle two of the copies that are left: it is a comb, or draws
         without replacement
    Two copies are left to chance. Can one particle get both? In yours it cannot.
    Residual resampling draws what is missing independently, with replacement.
    Draw the rest with rng.choice(M, left, p=rest / rest.sum()).""")
def no_repeat(w, rng):
    M = len(w)
    points = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), points), M - 1)


@residual.wrong("""subtracts the copies from w, where M w is meant (a slip printed in a popular
         library)
    For w = (.40, .25, .15, .12, .08) and M = 5: which particles can get the last draws?
    Copies are counted in particles, weights in shares. Bring both to one unit.
    The rest is M w - floor(M w).""")
def fraction_of_w(w, rng):
    M = len(w)
    copies = np.floor(M * w).astype(int)
    rest = np.clip(w - copies, 0, None)  # as printed in a popular library
    rest = np.cumsum(rest)
    rest = rest / rest[-1] if rest[-1] > 0 else np.ones(M)
    drawn = np.searchsorted(rest, rng.random(M - copies.sum()))
    return np.concatenate([np.repeat(np.arange(M), copies), np.minimum(drawn, M - 1)])


@residual.wrong("""draws the rest from w itself, so heavy particles are paid twice
    Particle 0 expects 2.0 copies and has 2 already. Should it take part in the rest?
    What a particle still has to get is its expected number minus what it has.
    Draw the rest with weights M w - floor(M w), normalised.""")
def rest_from_w(w, rng):
    M = len(w)
    copies = np.floor(M * w).astype(int)
    drawn = rng.choice(M, M - copies.sum(), p=w / w.sum())
    return np.concatenate([np.repeat(np.arange(M), copies), drawn])


@residual.wrong("""gives what is left to the heaviest particle
    Can a particle with M w < 1 ever survive in your scheme?
    Unbiased means E[copies] = M w, for small weights too.
    Draw the rest at random with weights M w - floor(M w), normalised.""")
def rest_to_heaviest(w, rng):
    M = len(w)
    copies = np.floor(M * w).astype(int)
    copies[np.argmax(w)] += M - copies.sum()
    return np.repeat(np.arange(M), copies)


@residual.wrong(
    """loses a certain copy where rounding leaves M w a hair below a whole number
    What is np.floor(49 * (1 / 49))?
    A product that should be 1 may arrive as 0.9999999999999999.
    np.floor(M * w + 1e-12).""",
    when=lambda f: _once_each(f, 4) and not _once_each(f, 49) and _unbiased(f, W) is True,
)
def no_margin(w, rng):
    M = len(w)
    copies = np.floor(M * w).astype(int)
    rest, left = M * w - copies, M - copies.sum()
    drawn = rng.choice(M, left, p=rest / rest.sum()) if left else np.zeros(0, dtype=int)
    return np.concatenate([np.repeat(np.arange(M), copies), drawn])


residual.wrong(
    """own-generator: draws from another generator than the one it is given
    Call it twice with np.random.default_rng(1). Should the results agree?
    Nobody can repeat a run whose chance comes from elsewhere.
    Draw with rng.choice, not with np.random.""",
    when=_ignores_rng,
)(lambda w, rng: residual(w, np.random.default_rng()))
residual.wrong(
    """counts: tells how many copies each particle gets, not which particle each copy is of
    What do your numbers sum to? Indices sum to anything.
    The next step is state[:, ancestors].
    np.repeat(np.arange(M), copies) turns counts into indices.""",
    when=_gives_counts,
)(lambda w, rng: np.bincount(residual(w, rng), minlength=len(w)))


def _shares_out(w, draw):
    """Residual resampling with another rule for the rest: ``draw(M w - copies, left)``."""
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    rest, left = np.maximum(M * w - copies, 0), M - copies.sum()
    drawn = draw(rest, left) if left else np.zeros(0, dtype=int)
    return np.concatenate([np.repeat(np.arange(M), copies), drawn])


def _strata(rest, points):
    return np.minimum(np.searchsorted(np.cumsum(rest / rest.sum()), points), len(rest) - 1)


@residual.refuses("draws the rest by strata")
def rest_by_strata(w, rng):
    return _shares_out(w, lambda rest, n: _strata(rest, (np.arange(n) + rng.random(n)) / n))


@residual.refuses("draws the rest with one number for all")
def rest_with_one_number(w, rng):
    return _shares_out(w, lambda rest, n: np.full(n, _strata(rest, [rng.random()])[0]))


@residual.refuses("copies the rest in the order of what is missing, without chance")
def rest_by_rank(w, rng):
    return _shares_out(w, lambda rest, n: np.argsort(-rest)[:n])


@residual.refuses("draws the rest with the squares of what is missing")
def rest_squared(w, rng):
    return _shares_out(w, lambda rest, n: rng.choice(len(w), n, p=rest**2 / (rest**2).sum()))


@residual.refuses("global chance", named="own-generator")
def rest_of_global_chance(w, rng):
    draw = np.random.choice
    return _shares_out(w, lambda rest, n: draw(len(w), n, p=rest / rest.sum()))


@residual.refuses("is multinomial throughout")
def all_by_chance(w, rng):
    return rng.choice(len(w), len(w), p=w)


residual.refuses("calls the library")(lambda w, rng: pf.residual(w, rng))


@code(
    """From ancestors to the new set
    The ancestors are column numbers of the state.
    What does a copy weigh?
    return state[:, ancestors], np.full(n, 1 / n).""",
    id="q4d",
    fingerprint=lambda f: np.concatenate(
        [
            np.ravel(x)
            for a in ([0, 0, 1, 4, 3], [0, 0, 3])
            for x in f(rng_of(1).normal(size=(2, 5)), W, np.array(a))
        ]
    ),
)
def select(state, w, ancestors):
    """New state (2, n) and new weights (n,) after resampling."""
    n = len(ancestors)
    return state[:, ancestors], np.full(n, 1 / n)


select.holds(
    "states are copied by column",
    lambda f: np.array_equal(
        f(np.arange(6.0).reshape(2, 3), np.ones(3) / 3, np.array([2, 2, 0]))[0],
        [[2, 2, 0], [5, 5, 3]],
    ),
)
select.holds(
    "weights are equal",
    lambda f: np.ptp(f(np.zeros((2, 5)), W, np.array([0, 0, 1, 2, 3]))[1]) < 1e-12,
)
select.holds(
    "weights sum to one, also for 3 ancestors of 5 particles",
    lambda f: all(
        np.isclose(np.sum(f(np.zeros((2, 5)), W, np.array(a))[1]), 1)
        for a in ([0, 0, 1, 2, 3], [0, 0, 3])
    ),
)
select.wrong("""old-number: divides by the number of old particles, not of new ones
    Draw 3 ancestors of 5 particles. Do your 3 weights sum to 1?
    n is the number of ancestors.
    np.full(len(ancestors), 1 / len(ancestors)).""")(
    lambda state, w, ancestors: (state[:, ancestors], np.full(len(ancestors), 1 / len(w)))
)
select.wrong("""weights-kept: keeps the old weights after resampling
    Resampling turned weight into copies. What would the old weights count again?
    Each copy now stands for the same share of the belief.
    After resampling n particles, every weight is 1/n.""")(
    lambda state, w, ancestors: (state[:, ancestors], w)
)


@select.wrong("""lets each copy carry the weight of its ancestor
    A particle of weight .4 became two of five copies. Which share do they have together?
    Number of copies times weight of a copy must give the old weight, on average.
    After resampling n particles, every weight is 1/n.""")
def weights_carried(state, w, ancestors):
    kept = w[ancestors]
    return state[:, ancestors], kept / kept.sum()


select.wrong("""weights-one: sets all weights to 1
    Weights of a belief sum to one. Yours sum to the number of particles.
    Equal is right; now normalise.
    After resampling n particles, every weight is 1/n.""")(
    lambda state, w, ancestors: (state[:, ancestors], np.ones(len(ancestors)))
)
select.wrong("""states-kept: resets the weights but does not copy the states
    Compare the states before and after. Who survived?
    The ancestors are column numbers of the state array.
    Index the columns: state[:, ancestors].""")(
    lambda state, w, ancestors: (state, np.full(len(ancestors), 1 / len(ancestors)))
)
select.refuses("copies rows, not columns")(
    lambda state, w, ancestors: (state[ancestors], np.full(len(ancestors), 1 / len(ancestors)))
)
select.refuses("copies each survivor once")(
    lambda state, w, ancestors: (
        state[:, np.unique(ancestors)],
        np.full(len(set(ancestors)), 1 / len(set(ancestors))),
    )
)
select.refuses("returns weights first")(
    lambda state, w, ancestors: (np.full(len(ancestors), 1 / len(ancestors)), state[:, ancestors])
)
select.refuses("returns log-weights")(
    lambda state, w, ancestors: (state[:, ancestors], np.full(len(ancestors), -np.log(len(w))))
)
select.refuses("copies x, but leaves y where it was")(
    lambda state, w, ancestors: (
        np.stack([state[0, ancestors], state[1, : len(ancestors)]]),
        np.full(len(ancestors), 1 / len(ancestors)),
    )
)
