"""Q4: random numbers, and the resamplers."""

from __future__ import annotations

import numpy as np

from pfkit.labs import Numeric, Question, code
from pfkit.labs.statistics import rng_of

Q4 = Question("Random numbers, and the resamplers")

W = np.array([0.40, 0.25, 0.15, 0.12, 0.08])
W3 = np.array([0.32, 0.32, 0.36])
W8 = np.array([0.02, 0.31, 0.09, 0.14, 0.05, 0.11, 0.21, 0.07])


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


def _counts(scheme, w, runs, seed=0):
    rng = rng_of(seed)
    found = [np.asarray(scheme(w.copy(), rng)) for _ in range(runs)]
    for ancestors in found:
        if ancestors.dtype.kind not in "iu" or ancestors.shape != w.shape:
            raise ValueError(f"expected {len(w)} whole numbers, got {ancestors!r:.60}")
    return np.stack([np.bincount(a, minlength=len(w)) for a in found])


def _unbiased(scheme, w, runs=1500):
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


def _fingerprint(scheme):
    """Mean and variance of the copies, and how far two particles vary together."""
    c = np.concatenate([_counts(scheme, w, 600, seed=7) for w in (W, W8)], axis=1)
    return [*c.mean(0), *(2 * c.var(0)), 2 * np.cov(c[:, 0], c[:, 1])[0, 1]]


q4a = Numeric(
    """Random numbers used for w = (.40, .25, .15, .12, .08): multinomial,
         stratified, systematic, residual
    How many decisions of each scheme are left to chance?
    Residual copies floor(M w) particles for certain; count what is left.
    Residual: 5 - (2 + 1 + 0 + 0 + 0).""",
    (5.0, 5.0, 1.0, 2.0),
    tol=0.01,
    names=("multinomial", "stratified", "systematic", "residual"),
)
q4a.wrong("""stratified-is-systematic: takes stratified for systematic
    In stratified resampling, is the offset the same in each stratum?
    Each of the M strata draws its own point.
    Stratified uses M numbers.""")((5, 1, 1, 2))
q4a.wrong("""stratified-and-systematic: takes stratified for systematic and the other way round
    Which of the two moves all its points together?
    Stratified: each of the M strata draws its own point.
    Systematic: one number moves the whole comb.""")((5, 1, 5, 2))
q4a.wrong("""residual-all: lets residual draw all particles
    Which copies does residual make without chance?
    floor(M w) = (2, 1, 0, 0, 0) are certain.
    Residual draws only the rest.""")((5, 5, 1, 5))
q4a.wrong("""residual-certain: gives the number of certain copies for residual
    You counted what is *not* drawn.
    5 particles in all, 3 of them certain.
    Residual draws M minus the certain copies.""")((5, 5, 1, 3))


@code(
    """Systematic resampling
    Lay the weights end to end: np.cumsum(w). Then hold a comb against them.
    The comb has M teeth, 1/M apart; only its offset is random.
    np.searchsorted(np.cumsum(w), (np.arange(M) + rng.random()) / M).""",
    id="q4b",
    points=4,
    fingerprint=_fingerprint,
    atol=0.3,
)
def systematic(w, rng):
    """A comb with one random offset."""
    M = len(w)
    points = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), points, side="right"), M - 1)


systematic.holds(
    "M whole numbers between 0 and M - 1", lambda f: (_counts(f, W, 20).sum(axis=1) == 5).all()
)
systematic.holds("one random number per call", lambda f: _uses(f, W))
systematic.holds(
    "each particle gets floor(M w) or ceil(M w) copies",
    lambda f: _floor_or_ceil(f, W) and _floor_or_ceil(f, W8),
)
systematic.holds("M w copies on average", lambda f: _unbiased(f, W8))
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


@code(
    """Residual resampling
    First the certain copies: floor(M w).
    Then draw the missing ones, in proportion to what each still has to get.
    rest = M w - floor(M w); if left > 0: rng.choice(M, left, p=rest / rest.sum()).""",
    id="q4c",
    points=3,
    fingerprint=_fingerprint,
    atol=0.3,
)
def residual(w, rng):
    """floor(M w) copies for certain, the rest by chance in proportion to what is missing."""
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    rest = np.clip(M * w - copies, 0, None)
    left = M - copies.sum()
    drawn = rng.choice(M, left, p=rest / rest.sum()) if left else np.zeros(0, dtype=int)
    return np.concatenate([np.repeat(np.arange(M), copies), drawn])


residual.holds(
    "M whole numbers between 0 and M - 1", lambda f: (_counts(f, W, 20).sum(axis=1) == 5).all()
)
residual.holds(
    "at least floor(M w) copies of each", lambda f: (_counts(f, W8, 100) >= np.floor(8 * W8)).all()
)
residual.holds("M w copies on average", lambda f: _unbiased(f, W))
residual.holds(
    "the rest is drawn one by one: sometimes a particle gets two of it",
    lambda f: (_counts(f, W3, 100) >= np.floor(3 * W3) + 2).any(),
)
residual.holds(
    "equal weights: one copy of each, nothing left to draw",
    lambda f: (_counts(f, np.full(4, 0.25), 5) == 1).all(),
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
    """The new set: copied columns, equal weights."""
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
