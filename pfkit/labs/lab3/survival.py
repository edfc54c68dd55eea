"""Q5: who survives a resampling."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.errors import ParameterError
from pfkit.labs import Numeric, Question, code, experiment
from pfkit.labs.response import same_mean

Q5 = Question("Survival")


def _pair(M, above, below):
    """A weight above 1/M and one below it, and what the hints tell of them."""
    return {"M": M, "above": round(above / M, 5), "below": round(below / M, 5), "gap": 1 / M}


def _multinomial(w, M):
    return 1 - (1 - w) ** M


q5a = Numeric(
    """Survival of w = {above} and w = {below} among M = {M}: multinomial, systematic
    Multinomial: what is the probability that all {M} draws miss?
    Systematic: compare the stretch w with the gap 1/M of the comb.
    1 - (1 - w)^M, and min(1, M w).""",
    lambda M, above, below, gap: (
        _multinomial(above, M), _multinomial(below, M), 1.0, M * below,
    ),
    tol=0.003,
    names=(
        "multinomial, w = {above}",
        "multinomial, w = {below}",
        "systematic, w = {above}",
        "systematic, w = {below}",
    ),
    world=_pair(100, 1.2, 0.5),
    draw=lambda rng: _pair(
        int(rng.choice([40, 50, 80, 125, 160, 200, 250])),
        float(rng.choice([1.1, 1.2, 1.3, 1.4])),
        float(rng.choice([0.3, 0.4, 0.5, 0.6])),
    ),
)  # fmt: skip


@q5a.wrong("""has the sign of epsilon wrong, as one printed solution has: with w = 1/M + eps the
         miss is 1 - 1/M - eps
    Should a heavier particle survive more often or less often?
    1 - w = 1 - 1/M - eps.
    1 - (1 - {above})^{M}.""")
def sign_error(M, above, below, gap):
    return _multinomial(2 * gap - above, M), _multinomial(below, M), 1.0, M * below


@q5a.wrong("""has the sign of epsilon wrong for both weights, as one printed solution has
    Should a heavier particle survive more often or less often?
    With w = 1/M + eps, one draw misses with the probability 1 - w = 1 - 1/M - eps.
    1 - (1 - {above})^{M} and 1 - (1 - {below})^{M}.""")
def sign_error_twice(M, above, below, gap):
    return _multinomial(2 * gap - above, M), _multinomial(2 * gap - below, M), 1.0, M * below


@q5a.wrong("""is the probability to die
    Which of the two weights should survive more often?
    (1 - w)^M is the probability of M misses.
    Take one minus it.""")
def complement(M, above, below, gap):
    return (1 - above) ** M, (1 - below) ** M, 0.0, 1 - M * below


@q5a.wrong("""is the expected number of copies M w (cut at 1) for both schemes
    Two copies of one particle are one survivor.
    Multinomial can miss even a heavy particle.
    Multinomial: 1 - (1 - w)^M.""")
def expected_copies(M, above, below, gap):
    return 1.0, M * below, 1.0, M * below


@q5a.wrong("""gives a probability above 1
    A probability is at most 1.
    A stretch of {above} is longer than the gap of {gap}: it is always hit.
    Systematic: min(1, M w).""")
def above_one(M, above, below, gap):
    return _multinomial(above, M), _multinomial(below, M), M * above, M * below


@q5a.wrong("""uses the multinomial formula for the comb
    Can a comb with gaps of {gap} miss a stretch of {above}?
    A stretch shorter than the gap is hit with probability w / gap.
    Systematic: min(1, M w).""")
def both_multinomial(M, above, below, gap):
    return (_multinomial(above, M), _multinomial(below, M)) * 2


@q5a.wrong("""is the chance to be hit by one draw, not by {M}
    How often does multinomial resampling draw?
    A particle dies if all {M} draws miss it.
    1 - (1 - w)^M.""")
def one_draw(M, above, below, gap):
    return above, below, above, below


@code(
    """Survival as a function
    Return two numbers: multinomial, systematic.
    One is a power, the other a minimum.
    1 - (1 - w)**M, min(1, M * w).""",
    id="q5b",
    fingerprint=lambda f: [f(w, M) for w, M in ((0.015, 100), (0.003, 100), (0.2, 100), (0.1, 7))],
)
def survival(w, M):
    """Probability to survive: (multinomial, systematic)."""
    return 1 - (1 - w) ** M, min(1, M * w)


def _is(pair, a, b):
    found = [float(pair[0]), float(pair[1])]
    return bool(np.allclose(found, [a, b], atol=1e-7)) or f"it gives {found[0]:.4g}, {found[1]:.4g}"


survival.holds("all the weight survives for certain", lambda f: _is(f(1.0, 50), 1, 1))
survival.holds("no weight, no survival", lambda f: _is(f(0.0, 50), 0, 0))
survival.holds("w = .015, M = 100", lambda f: _is(f(0.015, 100), 1 - 0.985**100, 1.0))
survival.holds("w = .003, M = 100", lambda f: _is(f(0.003, 100), 1 - 0.997**100, 0.3))
survival.holds("w = .02, M = 20: it depends on M", lambda f: _is(f(0.02, 20), 1 - 0.98**20, 0.4))
survival.holds("w = 1/3, M = 3: the stretch is the gap", lambda f: _is(f(1 / 3, 3), 19 / 27, 1.0))

survival.wrong("""sign-error: has the sign of epsilon wrong: 1 - (1 - 1/M + eps)^M, as one printed
         solution has
    Raise w. Should the particle survive more often or less often?
    With w = 1/M + eps, the chance to be missed in one draw is 1 - w = 1 - 1/M - eps.
    Multinomial survival is 1 - (1 - w)^M.""")(
    lambda w, M: (1 - (1 - 1 / M + (w - 1 / M)) ** M, min(1.0, M * w))
)
survival.wrong("""complement: gives the probability to die
    A particle that holds all the weight: what does your function say?
    (1 - w)^M is the probability that M draws all miss.
    Take one minus it.""")(lambda w, M: ((1 - w) ** M, max(0.0, 1 - M * w)))
survival.wrong("""expected-copies: gives the expected number of copies, which is not a probability
    Try w = .5 and M = 100.
    M w counts copies; two copies of one particle are one survivor.
    Systematic: min(1, M w). Multinomial: 1 - (1 - w)^M.""")(lambda w, M: (M * w, M * w))
survival.wrong("""above-one: gives a probability above 1 for the comb
    What does your second number say for w = .3 and M = 50?
    A stretch longer than the gap of the comb is hit for certain.
    Systematic survival is min(1, M w).""")(lambda w, M: (1 - (1 - w) ** M, M * w))
survival.wrong("""order: returns systematic first
    Which of your two numbers reaches 1 at w = 1/M?
    The order asked for is: multinomial, systematic.
    return 1 - (1 - w)**M, min(1, M * w).""")(lambda w, M: (min(1.0, M * w), 1 - (1 - w) ** M))
survival.wrong("""both-alike: uses the multinomial formula for both schemes
    A comb with gaps of 1/M cannot miss a stretch longer than 1/M.
    A stretch shorter than 1/M is hit with a probability equal to its share of the gap.
    Systematic survival is min(1, M w).""")(lambda w, M: (1 - (1 - w) ** M, 1 - (1 - w) ** M))
survival.wrong("""always-100: has M = 100, whatever it is asked
    Does your function use M?
    The text's 100 was an example.
    1 - (1 - w)**M, min(1, M * w).""")(lambda w, M: (1 - (1 - w) ** 100, min(1, 100 * w)))
survival.refuses("the law of rare events: nearly right for small w")(
    lambda w, M: (1 - np.exp(-M * w), min(1, M * w))
)
survival.refuses("a step at 1/M for the comb")(lambda w, M: (1 - (1 - w) ** M, float(M * w >= 1)))
survival.refuses("the comb with M - 1 gaps")(lambda w, M: (1 - (1 - w) ** M, min(1, (M - 1) * w)))
survival.refuses("one draw less")(lambda w, M: (1 - (1 - w) ** (M - 1), min(1, M * w)))
survival.refuses("adds the chances of the draws, cut at 1", named="")(
    lambda w, M: (min(1, M * w), min(1, M * w))
)
survival.refuses("rounded to two digits")(
    lambda w, M: (round(1 - (1 - w) ** M, 2), round(min(1, M * w), 2))
)


class Scheme:
    """A resampling scheme as an instrument: it looks at the weights that it is given.

    Its ancestors come in any order, as those of a scheme may.
    """

    def __init__(self, draw, name: str) -> None:
        self._draw, self.__name__ = draw, name

    def __call__(self, w, rng, *more):
        total = float(np.sum(w))
        if abs(total - 1) > 1e-9:
            raise ParameterError(f"the weights sum to {total:.6g}; give the others 1 - w together")
        return rng.permutation(self._draw(np.asarray(w, dtype=float), rng))


MULTINOMIAL, SYSTEMATIC = Scheme(pf.multinomial, "multinomial"), Scheme(pf.systematic, "systematic")
HOLDING = Scheme(
    lambda w, rng: np.arange(len(w)) if rng.random() < 0.4 else pf.systematic(w, rng),
    "one that copies each particle once in 40 % of its calls",
)


def _schemes(rng):
    """Two schemes of the book and one that no formula of the book knows; weights and sizes."""
    M = rng.choice([20, 30, 40, 50, 60], 5, replace=False)
    share = rng.uniform([0.5, 1.1, 0.3, 1.1, 0.2], [0.8, 1.5, 0.6, 1.5, 0.4])
    schemes = (MULTINOMIAL, MULTINOMIAL, SYSTEMATIC, SYSTEMATIC, HOLDING)
    return [(s, float(c / m), int(m)) for s, c, m in zip(schemes, share, M, strict=True)]


@experiment(
    """Survival, measured
    The answer is True or False: is index 0 among the ancestors?
    Give particle 0 the weight w and the other M - 1 the rest in equal parts.
    weights = np.full(M, (1 - w) / (M - 1)); weights[0] = w; 0 in scheme(weights, rng).""",
    id="q5c",
    points=2,
    claim="the share of survivors follows scheme, weight and number of particles",
    test="share within 4.5 standard errors of a right experiment's at each of five settings",
    runs=1000,
    pool=12_000,
    settings=_schemes,
    false_fail=1e-3,
    margin="4.5 standard errors, five settings and their sum: 3e-5 by the normal law",
)
def survived(scheme, w, M, rng):
    """Is particle 0, of weight w among M, still there after one resampling?"""
    weights = np.full(M, (1 - w) / (M - 1))
    weights[0] = w
    return 0 in scheme(weights, rng)


@survived.holds("True or False, and the share follows scheme, w and M")
def _shares(x):
    odd = x[..., 0][~np.isin(x[..., 0], (0, 1))]
    if odd.size:
        return f"one run gives {odd[0]:.3g}"
    return same_mean()(x)


@survived.wrong("""counts copies, where survival is yes or no
    Some of your results are 2.
    A particle with two copies has survived once.
    0 in scheme(weights, rng) is True or False.""")
def copies(scheme, w, M, rng):
    weights = np.full(M, (1 - w) / (M - 1))
    weights[0] = w
    return np.sum(scheme(weights, rng) == 0)


@survived.wrong("""asks whether it died
    Raise w. Should your share rise or fall?
    Survived means: at least one copy.
    0 in scheme(weights, rng), without a not.""")
def died(scheme, w, M, rng):
    return not survived(scheme, w, M, rng)


@survived.wrong("""looks at the first ancestor only
    Resampling may put index 0 at any place of the result.
    A particle has survived if its index occurs anywhere among the ancestors.
    0 in scheme(weights, rng).""")
def first_only(scheme, w, M, rng):
    weights = np.full(M, (1 - w) / (M - 1))
    weights[0] = w
    return scheme(weights, rng)[0] == 0


@survived.wrong("""follows a particle of ordinary weight: all weigh the same, or it asks for
         another than the one with w
    Where does w enter your weights, and whose survival do you look at?
    Particle 0 weighs w, the other M - 1 share 1 - w.
    weights = np.full(M, (1 - w) / (M - 1)); weights[0] = w.""")
def ordinary_weight(scheme, w, M, rng):
    return 0 in scheme(np.full(M, 1 / M), rng)


@survived.wrong("""has 100 particles, whatever it is asked
    How long are your weights?
    The check chooses the number of particles.
    np.full(M, (1 - w) / (M - 1)).""")
def always_100(scheme, w, M, rng):
    return survived(scheme, w, 100, rng)


def _computed(scheme, w, M):
    return 1 - (1 - w) ** M if "multi" in scheme.__name__ else min(1, M * w)


survived.refuses("a coin with the computed chance, for any other scheme the comb's")(
    lambda scheme, w, M, rng: rng.random() < _computed(scheme, w, M)
)
survived.refuses("the computed chance itself")(lambda scheme, w, M, rng: _computed(scheme, w, M))
survived.refuses("always True")(lambda scheme, w, M, rng: True)
survived.refuses("a fair coin")(lambda scheme, w, M, rng: rng.random() < 0.5)


@survived.refuses("half as many particles")
def half_as_many(scheme, w, M, rng):
    return survived(scheme, w, M // 2, rng)


@survived.refuses("a scheme of its own choice")
def own_scheme(scheme, w, M, rng):
    return survived(SYSTEMATIC, w, M, rng)


@survived.refuses("leaves the others at 1/M, so the weights do not sum to one")
def others_kept(scheme, w, M, rng):
    weights = np.full(M, 1 / M)
    weights[0] = w
    return 0 in scheme(weights, rng)
