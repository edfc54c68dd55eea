"""Lab 3, part 2: the particle filter on a target in an image. Questions Q1 to Q8."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Choice,
    Code,
    Experiment,
    Misconception,
    Numeric,
    Prediction,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import z_of_share
from pfkit.labs.target import TURN, anywhere, around, target_log, track

MUTANT = MUTANTS["lab3"]
FILM, LINE = target_log("fixed", "low"), target_log("line", "high")
HOME = FILM.start[:2]
WRONG = np.deg2rad(20.0)  # error of the assumed heading in Q1


def rng_of(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


# -- Q1: fixed heading, or heading in the state? ---------------------------------------------


def follow(D, rng, runs):
    """Errors (300, runs) on the line, from a start whose heading is wrong by 20 degrees."""
    start = LINE.start + np.array([0.0, 0.0, WRONG])
    motion = pf.HeadingTarget(0.1, heading=start[2]) if D == 2 else pf.LineTarget(0.1, 0.02)
    bel = around(start[:D], (runs, 200), rng)
    return track(LINE[:300], bel, motion, pf.Position(20.0), rng).error


def _follow(f, rng, runs):
    flat, full = np.asarray(f(2, rng, runs)), np.asarray(f(3, rng, runs))
    if flat.shape != (300, runs) or full.shape != (300, runs):
        raise ValueError(f"expected errors of shape (300, {runs}), got {flat.shape}, {full.shape}")
    return np.stack([e[k : k + 100].mean(axis=0) for e in (flat, full) for k in (0, 200)], axis=1)


Q1 = Question(
    "q1",
    "Fixed heading, or heading in the state?",
    (
        Choice(
            id="q1a",
            title="What a third state component buys",
            key="b",
            options={
                "a": "Nothing: the heading is known, so both models are the same",
                "b": "It can learn the heading; the price is one dimension more to cover",
                "c": "It is faster, because the heading need not be passed on",
                "d": "It removes the need for process noise",
            },
            feedback={
                "a": "They are, as long as the known heading is right.",
                "b": "Yes: ability to learn against particles needed.",
                "c": "It costs more: a sine and a cosine per particle, and more particles.",
                "d": "Without noise on the heading, no particle would ever try a new one.",
            },
        ),
        Experiment(
            id="q1b",
            title="A heading that is wrong by 20 degrees",
            points=2,
            claim="with the heading fixed the error grows; with the heading in the state it "
            "recovers",
            test="mean error in frames 200-300: 2-D more than twice that of frames 0-100; "
            "3-D below 10 px and below a quarter of 2-D",
            runs=8,
            margin="ratio 4.66, sd .03, against 2; 4.1 px, sd .2, against 10: over 25 standard errors",
            measure=_follow,
            reference=follow,
            hints=(
                "Return the errors of lab.track, one row per frame.",
                "For D = 2 use HeadingTarget with the wrong heading, for D = 3 LineTarget.",
                "Start both at lab.line.start + (0, 0, 20 degrees), cut to D components.",
            ),
            properties=(
                Property(
                    "fixed heading: the error more than doubles",
                    lambda x: (
                        x[:, 1].mean() > 2 * x[:, 0].mean()
                        or f"{x[:, 0].mean():.1f}, then {x[:, 1].mean():.1f} px"
                    ),
                ),
                Property(
                    "heading in the state: below 10 px, and below a quarter of the other",
                    lambda x: (
                        x[:, 3].mean() < min(10, x[:, 1].mean() / 4) or f"{x[:, 3].mean():.1f} px"
                    ),
                ),
            ),
            misconceptions=(
                Misconception(
                    "right-heading",
                    "starts with the right heading, so there is nothing to recover from",
                    (
                        "Your 2-D error does not grow. Which heading does the model assume?",
                        "The question makes the assumed heading wrong by 20 degrees.",
                        "heading = lab.line.start[2] + np.deg2rad(20).",
                    ),
                    lambda D, rng, runs: _right_heading(D, rng, runs),
                    lambda x: x[:, 1].mean() < 12,
                ),
                Misconception(
                    "no-heading-noise",
                    "gives the heading no noise, so no particle can try another",
                    (
                        "Your 3-D filter starts with headings within .01 rad. How could it turn?",
                        "What a model can learn, its noise must be able to explore.",
                        "pf.LineTarget(0.1, 0.02): the second number is the sd of the heading.",
                    ),
                    lambda D, rng, runs: _no_heading_noise(D, rng, runs),
                    lambda x: x[:, 1].mean() > 30 and x[:, 3].mean() > 25,
                ),
            ),
        ),
    ),
)


def _right_heading(D, rng, runs):
    motion = pf.HeadingTarget(0.1, heading=LINE.start[2]) if D == 2 else pf.LineTarget(0.1, 0.02)
    bel = around(LINE.start[:D], (runs, 200), rng)
    return track(LINE[:300], bel, motion, pf.Position(20.0), rng).error


def _no_heading_noise(D, rng, runs):
    start = LINE.start + np.array([0.0, 0.0, WRONG])
    motion = pf.HeadingTarget(0.1, heading=start[2]) if D == 2 else pf.LineTarget(0.1, 0.0)
    bel = around(start[:D], (runs, 200), rng)
    return track(LINE[:300], bel, motion, pf.Position(20.0), rng).error


# -- Q2: which circles? ----------------------------------------------------------------------


def circle_mean(state, dt):
    """Mean motion of (x, y, theta, v, omega): speed and rate are part of the state."""
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)]
    return np.stack([*ahead, pf.wrap(theta + omega * dt), v, omega])


def _states(seed, *shape):
    rng = rng_of(seed)
    scale = np.array([50, 50, 3, 2, 0.5]).reshape(5, *(1,) * len(shape))
    return scale * rng.uniform(-1, 1, (5, *shape))


Q2 = Question(
    "q2",
    "Which circles does the model cover?",
    (
        Numeric(
            id="q2a",
            title="Radius for v0 = 2 px/frame and omega0 = 2 pi/688 rad/frame",
            key=2.0 / TURN,
            tol=0.5,
            unit="px",
            hints=(
                "How long is the way of one turn?",
                "One turn takes 688 frames at 2 px each.",
                "radius = v0 / omega0.",
            ),
            misconceptions=(
                Misconception(
                    "inverted",
                    "is omega0 / v0",
                    (
                        "Check the unit: rad/px is not a length.",
                        "A faster target on the same turn rate draws a larger circle.",
                        "radius = v0 / omega0.",
                    ),
                    TURN / 2.0,
                    lambda x: abs(x - TURN / 2.0) < 1e-3,
                ),
                Misconception(
                    "diameter",
                    "is the diameter",
                    ("Twice too large.", "The radius is asked for.", "radius = v0 / omega0."),
                    4.0 / TURN,
                ),
                Misconception(
                    "circumference",
                    "is the length of the circle",
                    (
                        "You found the way of one turn.",
                        "Divide by 2 pi.",
                        "radius = v0 / omega0.",
                    ),
                    1376.0,
                ),
                Misconception(
                    "degrees",
                    "takes omega0 in degrees",
                    (
                        "omega0 is in radians per frame.",
                        "An arc is radius times angle only for radians.",
                        "2 / (2 pi / 688).",
                    ),
                    2.0 / np.rad2deg(TURN),
                ),
            ),
        ),
        Choice(
            id="q2b",
            title="What the circle model leaves free",
            key="c",
            options={
                "a": "Radius, centre and phase",
                "b": "Only the phase",
                "c": "Centre and phase; speed, rate and so the radius and the sense are given",
                "d": "Speed and rate; centre and phase are given",
            },
            feedback={
                "a": "The radius is v0/omega0, and both are given.",
                "b": "Any (x, y, theta) is allowed, so the centre is free too.",
                "c": "Yes: one size and one sense of circle, anywhere.",
                "d": "It is the other way round.",
            },
        ),
        Code(
            id="q2c",
            title="Speed and rate in the state",
            points=2,
            reference=circle_mean,
            hints=(
                "Unpack five components: x, y, theta, v, omega = state.",
                "Speed and rate stay as they are; the rest is the circle model.",
                "np.stack([x + v dt cos, y + v dt sin, wrap(theta + omega dt), v, omega]).",
            ),
            properties=(
                Property(
                    "one state by hand: (0, 0, 0, 2, .1), dt = 3 gives (6, 0, .3, 2, .1)",
                    lambda f: np.allclose(
                        f(np.array([0.0, 0, 0, 2, 0.1]), 3.0), [6, 0, 0.3, 2, 0.1]
                    ),
                ),
                Property(
                    "a cloud (5, 7) moves like its columns",
                    lambda f: np.allclose(
                        f(_states(1, 7), 0.5)[:, 3], circle_mean(_states(1, 7)[:, 3], 0.5)
                    ),
                ),
                Property(
                    "a batch (5, 3, 7) keeps its shape",
                    lambda f: np.shape(f(_states(2, 3, 7), 0.5)) == (5, 3, 7),
                ),
                Property(
                    "headings stay in (-pi, pi]",
                    lambda f: np.abs(f(_states(3, 50), 3.0)[2]).max() <= np.pi,
                ),
            ),
            fingerprint=lambda f: f(_states(4, 20), 1.7),
            misconceptions=MUTANT["q2c"],
        ),
    ),
)

# -- Q3: the constant in the likelihood ------------------------------------------------------


def log_likelihood(z, state, sigma):
    """log N(z; (x, y), sigma^2 I) at every state: two dimensions, full constant."""
    d2 = (z[0] - state[0]) ** 2 + (z[1] - state[1]) ** 2
    return -d2 / (2 * sigma**2) - np.log(2 * np.pi * sigma**2)


def _fix(seed):
    rng = rng_of(seed)
    return rng.normal(0, 2, 2), rng.normal(0, 2, (2, 12)), 1.7


def _integral(f, sigma):
    axis = np.arange(-40.0, 40.0, 0.5)
    grid = np.stack(np.meshgrid(axis, axis)).reshape(2, -1)
    return float(np.exp(f(np.zeros(2), grid, sigma)).sum() * 0.25)


Q3 = Question(
    "q3",
    "The constant in the likelihood",
    (
        Choice(
            id="q3a",
            title="Leave the constant out: what happens to the normalised weights?",
            key="a",
            options={
                "a": "Nothing",
                "b": "They become larger",
                "c": "They no longer sum to one",
                "d": "Particles far away gain weight",
            },
            feedback={
                "a": "Yes: every particle has the same factor, and normalising divides it out.",
                "b": "All likelihoods do, by the same factor; then the weights are normalised.",
                "c": "They are divided by their sum, whatever it is.",
                "d": "A common factor changes no ratio between particles.",
            },
        ),
        Choice(
            id="q3b",
            title="Where does it matter, then?",
            key="d",
            options={
                "a": "Nowhere in a particle filter",
                "b": "In the mean of the particles",
                "c": "In the effective sample size",
                "d": "In a gate on the likelihood, in a mixture with outliers, in the evidence",
            },
            feedback={
                "a": "It cancels in the weights; some steps use likelihoods that are not normalised.",
                "b": "The mean uses normalised weights.",
                "c": "The ESS uses normalised weights.",
                "d": "Yes: there likelihoods are compared with a number, or with each other.",
            },
        ),
        Code(
            id="q3c",
            title="Log-likelihood of a position, with its constant",
            points=3,
            reference=log_likelihood,
            hints=(
                "Write down the density of a Gaussian in two dimensions, then take its logarithm.",
                "The logarithm of exp(a) is a: no exp is needed.",
                "-(dx^2 + dy^2)/(2 sigma^2) - log(2 pi sigma^2).",
            ),
            properties=(
                Property(
                    "one number per particle",
                    lambda f: np.shape(f(*_fix(0))) == (12,),
                ),
                Property(
                    "a distance of one sigma costs 1/2",
                    lambda f: np.isclose(
                        f(np.zeros(2), np.zeros((2, 1)), 3.0)[0]
                        - f(np.array([3.0, 0]), np.zeros((2, 1)), 3.0)[0],
                        0.5,
                    ),
                ),
                Property(
                    "x and y errors add up: (3, 4) px costs as much as (5, 0)",
                    lambda f: np.isclose(
                        f(np.array([3.0, 4]), np.zeros((2, 1)), 2.0)[0],
                        f(np.array([5.0, 0]), np.zeros((2, 1)), 2.0)[0],
                    ),
                ),
                Property(
                    "the density integrates to one",
                    lambda f: (
                        abs(_integral(f, 3.0) - 1) < 1e-3 or f"it gives {_integral(f, 3.0):.3g}"
                    ),
                ),
                Property(
                    "finite and ordered at 5,000 and 10,000 sigma",
                    lambda f: bool(
                        -np.inf
                        < f(np.array([1e4, 0.0]), np.zeros((2, 1)), 1.0)[0]
                        < f(np.array([5e3, 0.0]), np.zeros((2, 1)), 1.0)[0]
                    ),
                ),
            ),
            fingerprint=lambda f: [*f(*_fix(1)), *f(np.array([60.0, 0]), np.zeros((2, 1)), 1.0)],
            misconceptions=MUTANT["q3c"],
        ),
    ),
)

# -- Q4: random numbers, and the resamplers --------------------------------------------------


def systematic(w, rng):
    """A comb with one random offset."""
    M = len(w)
    points = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), points, side="right"), M - 1)


def residual(w, rng):
    """floor(M w) copies for certain, the rest by chance in proportion to what is missing."""
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    rest = np.clip(M * w - copies, 0, None)
    left = M - copies.sum()
    drawn = rng.choice(M, left, p=rest / rest.sum()) if left else np.zeros(0, dtype=int)
    return np.concatenate([np.repeat(np.arange(M), copies), drawn])


def select(state, w, ancestors):
    """The new set: copied columns, equal weights."""
    n = len(ancestors)
    return state[:, ancestors], np.full(n, 1 / n)


W = np.array([0.40, 0.25, 0.15, 0.12, 0.08])
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
    return bool(((c >= np.floor(expected - 1e-9)) & (c <= np.ceil(expected + 1e-9))).all())


def _uses(scheme, w):
    rng = Counting(3)
    scheme(w.copy(), rng)
    return rng.count == 1 or f"it used {rng.count}"


def _fingerprint(scheme):
    """Mean and variance of the copies, and how far two particles vary together."""
    c = np.concatenate([_counts(scheme, w, 600, seed=7) for w in (W, W8)], axis=1)
    return [*c.mean(0), *(2 * c.var(0)), 2 * np.cov(c[:, 0], c[:, 1])[0, 1]]


_INDICES = Property(
    "M whole numbers between 0 and M - 1",
    lambda f: bool((_counts(f, W, 20).sum(axis=1) == 5).all()),
)

Q4 = Question(
    "q4",
    "Random numbers, and the resamplers",
    (
        Numeric(
            id="q4a",
            title="Random numbers used for w = (.40, .25, .15, .12, .08): multinomial, "
            "stratified, systematic, residual",
            key=(5.0, 5.0, 1.0, 2.0),
            tol=0.01,
            names=("multinomial", "stratified", "systematic", "residual"),
            hints=(
                "How many decisions of each scheme are left to chance?",
                "Residual copies floor(M w) particles for certain; count what is left.",
                "Residual: 5 - (2 + 1 + 0 + 0 + 0).",
            ),
            misconceptions=(
                Misconception(
                    "stratified-is-systematic",
                    "takes stratified for systematic",
                    (
                        "In stratified resampling, is the offset the same in each stratum?",
                        "Each of the M strata draws its own point.",
                        "Stratified uses M numbers.",
                    ),
                    (5, 1, 1, 2),
                ),
                Misconception(
                    "residual-all",
                    "lets residual draw all particles",
                    (
                        "Which copies does residual make without chance?",
                        "floor(M w) = (2, 1, 0, 0, 0) are certain.",
                        "Residual draws only the rest.",
                    ),
                    (5, 5, 1, 5),
                ),
                Misconception(
                    "residual-certain",
                    "gives the number of certain copies for residual",
                    (
                        "You counted what is *not* drawn.",
                        "5 particles in all, 3 of them certain.",
                        "Residual draws M minus the certain copies.",
                    ),
                    (5, 5, 1, 3),
                ),
            ),
        ),
        Code(
            id="q4b",
            title="Systematic resampling",
            points=4,
            reference=systematic,
            hints=(
                "Lay the weights end to end: np.cumsum(w). Then hold a comb against them.",
                "The comb has M teeth, 1/M apart; only its offset is random.",
                "np.searchsorted(np.cumsum(w), (np.arange(M) + rng.random()) / M).",
            ),
            properties=(
                _INDICES,
                Property("one random number per call", lambda f: _uses(f, W)),
                Property(
                    "each particle gets floor(M w) or ceil(M w) copies",
                    lambda f: _floor_or_ceil(f, W) and _floor_or_ceil(f, W8),
                ),
                Property("M w copies on average", lambda f: _unbiased(f, W8)),
            ),
            fingerprint=_fingerprint,
            atol=0.3,
            misconceptions=MUTANT["q4b"],
        ),
        Code(
            id="q4c",
            title="Residual resampling",
            points=3,
            reference=residual,
            hints=(
                "First the certain copies: floor(M w).",
                "Then draw the missing ones, in proportion to what each still has to get.",
                "rest = M w - floor(M w); rng.choice(M, left, p=rest / rest.sum()).",
            ),
            properties=(
                _INDICES,
                Property(
                    "at least floor(M w) copies of each",
                    lambda f: bool((_counts(f, W8, 100) >= np.floor(8 * W8)).all()),
                ),
                Property("M w copies on average", lambda f: _unbiased(f, W)),
            ),
            fingerprint=_fingerprint,
            atol=0.3,
            misconceptions=MUTANT["q4c"],
        ),
        Code(
            id="q4d",
            title="From ancestors to the new set",
            reference=select,
            hints=(
                "The ancestors are column numbers of the state.",
                "What does a copy weigh?",
                "return state[:, ancestors], np.full(n, 1 / n).",
            ),
            properties=(
                Property(
                    "states are copied by column",
                    lambda f: np.array_equal(
                        f(np.arange(6.0).reshape(2, 3), np.ones(3) / 3, np.array([2, 2, 0]))[0],
                        [[2, 2, 0], [5, 5, 3]],
                    ),
                ),
                Property(
                    "weights are equal",
                    lambda f: np.ptp(f(np.zeros((2, 5)), W, np.array([0, 0, 1, 2, 3]))[1]) < 1e-12,
                ),
                Property(
                    "weights sum to one",
                    lambda f: np.isclose(
                        np.sum(f(np.zeros((2, 5)), W, np.array([0, 0, 1, 2, 3]))[1]), 1
                    ),
                ),
            ),
            fingerprint=lambda f: np.concatenate(
                [
                    np.ravel(x)
                    for x in f(rng_of(1).normal(size=(2, 5)), W, np.array([0, 0, 1, 4, 3]))
                ]
            ),
            misconceptions=MUTANT["q4d"],
        ),
    ),
)

# -- Q5: survival ----------------------------------------------------------------------------


def survival(w, M):
    """Probability to survive one resampling: multinomial, systematic."""
    return 1 - (1 - w) ** M, min(1.0, M * w)


def survived(scheme, w, rng, runs):
    """Does particle 0, of weight w among 100, survive? The others share the rest."""
    weights = np.full(100, (1 - w) / 99)
    weights[0] = w
    return np.array([0 in scheme(weights, rng) for _ in range(runs)])


CASES = tuple((s, w) for s in (pf.multinomial, pf.systematic) for w in (0.012, 0.005))
CHANCES = tuple(survival(w, 100)[k] for k in (0, 1) for w in (0.012, 0.005))


def _survived(f, rng, runs):
    return np.stack([f(scheme, w, rng, runs) for scheme, w in CASES], axis=1)


Q5 = Question(
    "q5",
    "Survival",
    (
        Numeric(
            id="q5a",
            title="Survival of w = .012 and w = .005 among M = 100: multinomial, systematic",
            key=CHANCES,
            tol=0.003,
            names=(
                "multinomial, w = .012",
                "multinomial, w = .005",
                "systematic, w = .012",
                "systematic, w = .005",
            ),
            hints=(
                "Multinomial: what is the probability that all 100 draws miss?",
                "Systematic: compare the stretch w with the gap 1/M of the comb.",
                "1 - (1 - w)^M, and min(1, M w).",
            ),
            misconceptions=(
                Misconception(
                    "sign-error",
                    "has the sign of epsilon wrong, as one printed solution has: "
                    "with w = 1/M + eps the miss is 1 - 1/M - eps",
                    (
                        "Should a heavier particle survive more often or less often?",
                        "1 - w = 1 - 1/M - eps.",
                        "1 - (1 - .012)^100.",
                    ),
                    (1 - 0.992**100, CHANCES[1], 1.0, 0.5),
                ),
                Misconception(
                    "complement",
                    "is the probability to die",
                    (
                        "Which of the two weights should survive more often?",
                        "(1 - w)^M is the probability of M misses.",
                        "Take one minus it.",
                    ),
                    tuple(1 - p for p in CHANCES),
                ),
                Misconception(
                    "expected-copies",
                    "is the expected number of copies M w (cut at 1) for both schemes",
                    (
                        "Two copies of one particle are one survivor.",
                        "Multinomial can miss even a heavy particle.",
                        "Multinomial: 1 - (1 - w)^M.",
                    ),
                    (1.0, 0.5, 1.0, 0.5),
                ),
                Misconception(
                    "both-multinomial",
                    "uses the multinomial formula for the comb",
                    (
                        "Can a comb with gaps of .010 miss a stretch of .012?",
                        "A stretch shorter than the gap is hit with probability w / gap.",
                        "Systematic: min(1, M w).",
                    ),
                    (CHANCES[0], CHANCES[1], CHANCES[0], CHANCES[1]),
                ),
            ),
        ),
        Code(
            id="q5b",
            title="Survival as a function",
            reference=survival,
            hints=(
                "Return two numbers: multinomial, systematic.",
                "One is a power, the other a minimum.",
                "1 - (1 - w)**M, min(1, M * w).",
            ),
            properties=(
                Property("all the weight survives for certain", lambda f: _is(f(1.0, 50), 1, 1)),
                Property("no weight, no survival", lambda f: _is(f(0.0, 50), 0, 0)),
                Property("w = .015, M = 100", lambda f: _is(f(0.015, 100), 1 - 0.985**100, 1.0)),
                Property("w = .003, M = 100", lambda f: _is(f(0.003, 100), 1 - 0.997**100, 0.3)),
            ),
            fingerprint=lambda f: [x for w in (0.015, 0.003, 0.2) for x in f(w, 100)],
            misconceptions=MUTANT["q5b"],
        ),
        Experiment(
            id="q5c",
            title="Survival, measured",
            points=2,
            claim="the measured shares agree with the closed forms",
            test="|z| < 4.5 for each share that is neither 0 nor 1; the certain one is exactly 1",
            runs=2000,
            margin="4.5 standard errors, three shares: 2e-5 by the normal law",
            measure=_survived,
            reference=survived,
            hints=(
                "One True or False per run: is index 0 among the ancestors?",
                "Give particle 0 the weight w and the other 99 the rest in equal parts.",
                "np.array([0 in scheme(weights, rng) for _ in range(runs)]).",
            ),
            properties=(
                Property("True or False", lambda x: bool(np.isin(x, (0, 1)).all())),
                Property(
                    "multinomial as computed",
                    lambda x: (
                        max(abs(z_of_share(x[:, k], CHANCES[k])) for k in (0, 1)) < 4.5
                        or f"shares {x.mean(0)[:2].round(3)}"
                    ),
                ),
                Property(
                    "systematic as computed",
                    lambda x: (
                        (x[:, 2].all() and abs(z_of_share(x[:, 3], 0.5)) < 4.5)
                        or f"shares {x.mean(0)[2:].round(3)}"
                    ),
                ),
            ),
            misconceptions=(
                Misconception(
                    "copies",
                    "counts copies, where survival is yes or no",
                    (
                        "Some of your results are 2.",
                        "A particle with two copies has survived once.",
                        "0 in scheme(weights, rng) is True or False.",
                    ),
                    lambda scheme, w, rng, runs: np.array(
                        [np.sum(scheme(_one_heavy(w), rng) == 0) for _ in range(runs)]
                    ),
                    lambda x: x.max() > 1,
                ),
                Misconception(
                    "weights-not-normalised",
                    "leaves the others at 1/100, so the weights do not sum to one",
                    (
                        "What do your weights sum to?",
                        "If particle 0 has w, the others share 1 - w.",
                        "weights = np.full(100, (1 - w) / 99); weights[0] = w.",
                    ),
                    lambda scheme, w, rng, runs: np.array(
                        [0 in scheme(_others_kept(w), rng) for _ in range(runs)]
                    ),
                    lambda x: x[:, 0].mean() < 0.6 and 0.1 < x[:, 3].mean() < 0.4,
                ),
            ),
        ),
    ),
)


def _is(pair, a, b):
    return bool(np.allclose([float(pair[0]), float(pair[1])], [a, b]))


def _one_heavy(w):
    weights = np.full(100, (1 - w) / 99)
    weights[0] = w
    return weights


def _others_kept(w):
    weights = np.full(100, 0.02)
    weights[0] = w
    return weights / weights.sum()


# -- Q6: which noise is which? ---------------------------------------------------------------


def diffuse(state, sigma, rng):
    """One step of a target that stands still: fresh noise for every particle and axis."""
    return state + sigma * rng.standard_normal(state.shape)


def _sample(f, M=4000, sigma=3.0):
    return np.asarray(f(np.zeros((2, M)), sigma, rng_of(11)), dtype=float)


Q6 = Question(
    "q6",
    "Which noise is which?",
    (
        Choice(
            id="q6a",
            title="pf.FixedTarget(sigma=2), pf.Position(sigma=3)",
            key="c",
            options={
                "a": "Process variance 2 px^2, measurement variance 3 px^2",
                "b": "Measurement sd 2 px, process sd 3 px",
                "c": "Process sd 2 px per step, so variance 4 px^2; measurement variance 9 px^2",
                "d": "Process variance 2 px^2, measurement sd 3 px",
            },
            feedback={
                "a": "In pfkit every sigma is a standard deviation; square it for the variance.",
                "b": "Motion models hold the process noise, sensors the measurement noise.",
                "c": "Yes. In the literature Q and R change places: say which noise, and sd or "
                "variance.",
                "d": "Both are standard deviations.",
            },
        ),
        Code(
            id="q6b",
            title="Process noise",
            points=2,
            reference=diffuse,
            hints=(
                "Every particle gets its own noise, in x and in y.",
                "A standard normal times s has standard deviation s.",
                "state + sigma * rng.standard_normal(state.shape).",
            ),
            properties=(
                Property("the shape stays (2, M)", lambda f: _sample(f).shape == (2, 4000)),
                Property(
                    "sd 3 in x and in y, within 5 standard errors",
                    lambda f: (
                        np.abs(_sample(f).std(axis=1) - 3).max() < 5 * 3 / np.sqrt(8000)
                        or f"sd {_sample(f).std(axis=1).round(2)}"
                    ),
                ),
                Property(
                    "mean 0, within 5 standard errors",
                    lambda f: np.abs(_sample(f).mean(axis=1)).max() < 15 / np.sqrt(4000),
                ),
                Property(
                    "x and y are independent",
                    lambda f: abs(np.mean(_sample(f)[0] * _sample(f)[1])) < 5 * 9 / np.sqrt(4000),
                ),
            ),
            fingerprint=lambda f: [
                *_sample(f).std(axis=1),
                *np.clip(_sample(f).mean(axis=1), -3, 3),
                np.mean(_sample(f)[0] * _sample(f)[1]) if _sample(f).std() > 0.1 else 0.0,
            ],
            atol=0.6,
            misconceptions=MUTANT["q6b"],
        ),
    ),
)

# -- Q7: no process noise --------------------------------------------------------------------


def collapse(sigma, rng, runs):
    """Distinct particles and ESS after 400 frames, for process noise ``sigma``: (2, runs)."""
    bel = around(HOME, (runs, 100), rng, sigma=20.0)
    found = track(FILM[:400], bel, pf.FixedTarget(sigma), pf.Position(3.0), rng)
    x = found.bel.state[0]
    return np.array([[len(np.unique(row)) for row in x], found.ess[-1]])


def _collapse(f, rng, runs):
    pairs = [np.asarray(f(sigma, rng, runs), dtype=float) for sigma in (0.0, 1.0)]
    if any(p.shape != (2, runs) for p in pairs):
        raise ValueError(f"expected two arrays of shape (2, {runs}), got {pairs[0].shape}")
    return np.stack(pairs).transpose(2, 0, 1)


Q7 = Question(
    "q7",
    "No process noise, fixed target",
    (
        Prediction(
            id="q7a",
            title="Resampling each of 400 frames, no process noise: distinct particles and ESS",
            key="b",
            options={
                "a": "Both stay high: the model is exact",
                "b": "Distinct particles fall to one or two; the ESS ends at 100 of 100",
                "c": "Both fall to one",
                "d": "Distinct particles stay many; the ESS falls",
            },
        ),
        Experiment(
            id="q7b",
            after="q7a",
            title="Distinct particles and ESS at the end",
            points=2,
            claim="without process noise at most 5 of 100 distinct particles are left, while the "
            "ESS is 100; with noise of 1 px more than 60 are distinct",
            test="largest count over runs <= 5; mean ESS > 97; smallest count with noise > 60",
            runs=5,
            margin="1 or 2 distinct against 5; ESS 100; 81 distinct, sd 1.8, against 60: 11 standard errors",
            measure=_collapse,
            reference=collapse,
            hints=(
                "Two rows: how many different particles, and the last ESS.",
                "np.unique of one row of x counts different particles.",
                "[[len(np.unique(row)) for row in run.bel.state[0]], run.ess[-1]].",
            ),
            properties=(
                Property(
                    "no noise: at most 5 of 100 particles are distinct",
                    lambda x: x[:, 0, 0].max() <= 5 or f"{x[:, 0, 0].max():.0f} are",
                ),
                Property(
                    "and the ESS says 100",
                    lambda x: x[:, 0, 1].mean() > 97 or f"it says {x[:, 0, 1].mean():.0f}",
                ),
                Property(
                    "noise of 1 px: more than 60 are distinct",
                    lambda x: x[:, 1, 0].min() > 60 or f"{x[:, 1, 0].min():.0f} are",
                ),
            ),
            misconceptions=(
                Misconception(
                    "never-resampled",
                    "does not resample, so nothing can be lost",
                    (
                        "All your particles are distinct, yet the ESS is tiny.",
                        "The question resamples at every frame.",
                        "Leave the scheme of lab.track at its default.",
                    ),
                    lambda sigma, rng, runs: _not_resampled(sigma, rng, runs),
                    lambda x: x[:, 0, 0].min() > 60 and x[:, 0, 1].mean() < 50,
                ),
                Misconception(
                    "noise-fixed",
                    "does not use its argument: both cases have noise",
                    (
                        "Your two cases look alike.",
                        "Where does sigma enter the motion model?",
                        "pf.FixedTarget(sigma).",
                    ),
                    lambda sigma, rng, runs: collapse(1.0, rng, runs),
                    lambda x: x[:, 0, 0].min() > 60 and x[:, 0, 1].mean() > 50,
                ),
            ),
        ),
        Choice(
            id="q7c",
            title="Why is the ESS blind to this?",
            key="a",
            options={
                "a": "It looks at weights only, and copies of one particle weigh the same",
                "b": "It is computed before the update",
                "c": "It needs more particles to be precise",
                "d": "The log-weights underflow",
            },
            feedback={
                "a": "Yes: equal weights give ESS = M, even if there is one particle M times.",
                "b": "It is computed after the update; the weights are still all equal.",
                "c": "It is computed exactly; it answers another question.",
                "d": "Log-weights do not underflow here; they are simply all equal.",
            },
        ),
    ),
)


def _not_resampled(sigma, rng, runs):
    bel = around(HOME, (runs, 100), rng, sigma=20.0)
    found = track(FILM[:400], bel, pf.FixedTarget(sigma), pf.Position(3.0), rng, None)
    return np.array([[len(np.unique(row)) for row in found.bel.state[0]], found.ess[-1]])


# -- Q8: no resampling -----------------------------------------------------------------------


def three_filters(rng, runs):
    """Mean errors of frames 100 to 200: plain and weighted without resampling; resampled."""
    motion, sensor = pf.FixedTarget(1.4), pf.Position(3.0)
    rows = []
    for scheme, weighted in ((None, False), (None, True), (pf.systematic, True)):
        bel = anywhere((runs, 300), rng)
        found = track(FILM[:200], bel, motion, sensor, rng, scheme, weighted=weighted)
        rows.append(found.error[100:].mean(axis=0))
    return np.array(rows)


def _three(f, rng, runs):
    found = np.asarray(f(rng, runs), dtype=float)
    if found.shape != (3, runs):
        raise ValueError(f"expected shape (3, {runs}), got {found.shape}")
    return found.T


Q8 = Question(
    "q8",
    "No resampling",
    (
        Prediction(
            id="q8a",
            title="Order of the errors: plain mean (A) and weighted mean (B) without resampling, "
            "resampled (C)",
            key="a",
            options={
                "a": "A far worse than B, B far worse than C",
                "b": "A about as bad as B, both far worse than C",
                "c": "B about as good as C: weights do the same work as copies",
                "d": "A, B and C alike",
            },
        ),
        Experiment(
            id="q8b",
            after="q8a",
            title="Three filters",
            points=2,
            claim="plain mean above 150 px, weighted between 5 and 60 px, resampled below 1 px",
            test="means over runs within these bands",
            runs=10,
            margin="201 (sd 2.7), 19.8 (2.3), .573 (.006) px: at least 6 standard errors",
            measure=_three,
            reference=three_filters,
            hints=(
                "Three rows, one number per run in each.",
                "scheme=None never resamples; weighted=False takes the plain mean.",
                "lab.track(...).error[100:].mean(axis=0) for each of the three.",
            ),
            properties=(
                Property(
                    "plain mean without resampling: above 150 px",
                    lambda x: x[:, 0].mean() > 150 or f"{x[:, 0].mean():.1f} px",
                ),
                Property(
                    "weighted mean without resampling: between 5 and 60 px",
                    lambda x: 5 < x[:, 1].mean() < 60 or f"{x[:, 1].mean():.1f} px",
                ),
                Property(
                    "resampled: below 1 px",
                    lambda x: x[:, 2].mean() < 1 or f"{x[:, 2].mean():.2f} px",
                ),
            ),
            misconceptions=(
                Misconception(
                    "always-resampled",
                    "resamples in all three cases",
                    (
                        "Your first two errors are as small as the third.",
                        "scheme=None switches resampling off.",
                        "Pass scheme=None for the first two.",
                    ),
                    lambda rng, runs: np.tile(three_filters(rng, runs)[2], (3, 1)),
                    lambda x: x[:, 0].mean() < 2 and x[:, 1].mean() < 2,
                ),
                Misconception(
                    "weights-ignored",
                    "ignores the weights in the second case, too",
                    (
                        "Your first two errors are alike.",
                        "Without resampling, all that was measured sits in the weights.",
                        "weighted=False belongs to the first case only.",
                    ),
                    lambda rng, runs: three_filters(rng, runs)[[0, 0, 2]],
                    lambda x: x[:, 1].mean() > 100,
                ),
            ),
        ),
    ),
)

QUESTIONS = (Q1, Q2, Q3, Q4, Q5, Q6, Q7, Q8)
