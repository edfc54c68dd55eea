"""Q5: who survives a resampling."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs import Numeric, Question, code, experiment
from pfkit.labs.statistics import shaped, z_of_share

Q5 = Question("Survival")


def survival(w, M):
    """Probability to survive one resampling: multinomial, systematic."""
    return 1 - (1 - w) ** M, min(1.0, M * w)


CASES = tuple((s, w) for s in (pf.multinomial, pf.systematic) for w in (0.012, 0.005))
CHANCES = tuple(survival(w, 100)[k] for k in (0, 1) for w in (0.012, 0.005))

q5a = Numeric(
    """Survival of w = .012 and w = .005 among M = 100: multinomial, systematic
    Multinomial: what is the probability that all 100 draws miss?
    Systematic: compare the stretch w with the gap 1/M of the comb.
    1 - (1 - w)^M, and min(1, M w).""",
    CHANCES,
    tol=0.003,
    names=(
        "multinomial, w = .012",
        "multinomial, w = .005",
        "systematic, w = .012",
        "systematic, w = .005",
    ),
)
q5a.wrong("""sign-error: has the sign of epsilon wrong, as one printed solution has: with w =
         1/M + eps the miss is 1 - 1/M - eps
    Should a heavier particle survive more often or less often?
    1 - w = 1 - 1/M - eps.
    1 - (1 - .012)^100.""")((1 - 0.992**100, CHANCES[1], 1.0, 0.5))
q5a.wrong("""complement: is the probability to die
    Which of the two weights should survive more often?
    (1 - w)^M is the probability of M misses.
    Take one minus it.""")(tuple(1 - p for p in CHANCES))
q5a.wrong("""expected-copies: is the expected number of copies M w (cut at 1) for both schemes
    Two copies of one particle are one survivor.
    Multinomial can miss even a heavy particle.
    Multinomial: 1 - (1 - w)^M.""")((1.0, 0.5, 1.0, 0.5))
q5a.wrong("""above-one: gives a probability above 1
    A probability is at most 1.
    A stretch of .012 is longer than the gap of .010: it is always hit.
    Systematic: min(1, M w).""")((CHANCES[0], CHANCES[1], 1.2, 0.5))
q5a.wrong("""both-multinomial: uses the multinomial formula for the comb
    Can a comb with gaps of .010 miss a stretch of .012?
    A stretch shorter than the gap is hit with probability w / gap.
    Systematic: min(1, M w).""")((CHANCES[0], CHANCES[1], CHANCES[0], CHANCES[1]))

q5b = code(
    """Survival as a function
    Return two numbers: multinomial, systematic.
    One is a power, the other a minimum.
    1 - (1 - w)**M, min(1, M * w).""",
    fingerprint=lambda f: [x for w in (0.015, 0.003, 0.2) for x in f(w, 100)],
)(survival)
q5b.holds("all the weight survives for certain", lambda f: _is(f(1.0, 50), 1, 1))
q5b.holds("no weight, no survival", lambda f: _is(f(0.0, 50), 0, 0))
q5b.holds("w = .015, M = 100", lambda f: _is(f(0.015, 100), 1 - 0.985**100, 1.0))
q5b.holds("w = .003, M = 100", lambda f: _is(f(0.003, 100), 1 - 0.997**100, 0.3))
q5b.wrong("""sign-error: has the sign of epsilon wrong: 1 - (1 - 1/M + eps)^M, as one printed
         solution has
    Raise w. Should the particle survive more often or less often?
    With w = 1/M + eps, the chance to be missed in one draw is 1 - w = 1 - 1/M - eps.
    Multinomial survival is 1 - (1 - w)^M.""")(
    lambda w, M: (1 - (1 - 1 / M + (w - 1 / M)) ** M, min(1.0, M * w))
)
q5b.wrong("""complement: gives the probability to die
    A particle that holds all the weight: what does your function say?
    (1 - w)^M is the probability that M draws all miss.
    Take one minus it.""")(lambda w, M: ((1 - w) ** M, max(0.0, 1 - M * w)))
q5b.wrong("""expected-copies: gives the expected number of copies, which is not a probability
    Try w = .5 and M = 100.
    M w counts copies; two copies of one particle are one survivor.
    Systematic: min(1, M w). Multinomial: 1 - (1 - w)^M.""")(lambda w, M: (M * w, M * w))
q5b.wrong("""above-one: gives a probability above 1 for the comb
    What does your second number say for w = .3 and M = 50?
    A stretch longer than the gap of the comb is hit for certain.
    Systematic survival is min(1, M w).""")(lambda w, M: (1 - (1 - w) ** M, M * w))
q5b.wrong("""order: returns systematic first
    Which of your two numbers reaches 1 at w = 1/M?
    The order asked for is: multinomial, systematic.
    return 1 - (1 - w)**M, min(1, M * w).""")(lambda w, M: (min(1.0, M * w), 1 - (1 - w) ** M))
q5b.wrong("""both-alike: uses the multinomial formula for both schemes
    A comb with gaps of 1/M cannot miss a stretch longer than 1/M.
    A stretch shorter than 1/M is hit with a probability equal to its share of the gap.
    Systematic survival is min(1, M w).""")(lambda w, M: (1 - (1 - w) ** M, 1 - (1 - w) ** M))


@experiment(
    """Survival, measured
    One True or False per run: is index 0 among the ancestors?
    Give particle 0 the weight w and the other 99 the rest in equal parts.
    np.array([0 in scheme(weights, rng) for _ in range(runs)]).""",
    id="q5c",
    points=2,
    claim="the measured shares agree with the closed forms",
    test="|z| < 4.5 for each share that is neither 0 nor 1; the certain one is exactly 1",
    runs=2000,
    pool=20_000,
    margin="4.5 standard errors, three shares: 2e-5 by the normal law",
    measure=lambda f, rng, runs: np.stack(
        [shaped(f(scheme, w, rng, runs), runs) for scheme, w in CASES], axis=1
    ),
)
def survived(scheme, w, rng, runs):
    """Does particle 0, of weight w among 100, survive? The others share the rest."""
    weights = np.full(100, (1 - w) / 99)
    weights[0] = w
    return np.array([0 in scheme(weights, rng) for _ in range(runs)])


survived.holds("True or False", lambda x: np.isin(x, (0, 1)).all())
survived.holds(
    "multinomial as computed",
    lambda x: (
        max(abs(z_of_share(x[:, k], CHANCES[k])) for k in (0, 1)) < 4.5
        or f"shares {x.mean(0)[:2].round(3)}"
    ),
)
survived.holds(
    "systematic as computed",
    lambda x: (
        (x[:, 2].all() and abs(z_of_share(x[:, 3], 0.5)) < 4.5)
        or f"shares {x.mean(0)[2:].round(3)}"
    ),
)


@survived.wrong(
    """counts copies, where survival is yes or no
    Some of your results are 2.
    A particle with two copies has survived once.
    0 in scheme(weights, rng) is True or False.""",
    when=lambda x: x.max() > 1,
)
def copies(scheme, w, rng, runs):
    return np.array([np.sum(scheme(_one_heavy(w), rng) == 0) for _ in range(runs)])


survived.wrong(
    """weights-not-normalised: leaves the others at 1/100, so the weights do not sum to one
    What do your weights sum to?
    If particle 0 has w, the others share 1 - w.
    weights = np.full(100, (1 - w) / 99); weights[0] = w.""",
    when=lambda x: x[:, 0].mean() < 0.6 and 0.1 < x[:, 3].mean() < 0.4,
)(lambda scheme, w, rng, runs: np.array([0 in scheme(_others_kept(w), rng) for _ in range(runs)]))


def _is(pair, a, b):
    found = [float(pair[0]), float(pair[1])]
    return bool(np.allclose(found, [a, b])) or f"it gives {found[0]:.4g}, {found[1]:.4g}"


def _one_heavy(w):
    weights = np.full(100, (1 - w) / 99)
    weights[0] = w
    return weights


def _others_kept(w):
    weights = np.full(100, 0.02)
    weights[0] = w
    return weights / weights.sum()
