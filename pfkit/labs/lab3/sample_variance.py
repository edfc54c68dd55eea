"""P7: the luck of resampling."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, experiment
from pfkit.labs.lab3 import given as lab
from pfkit.labs.response import same_mean
from pfkit.labs.statistics import shaped
from pfkit.labs.target import target_log

P7 = Question("Sample variance")

M = 6


class Recorded:
    """A scheme that remembers the copies it made, and whether it was called as it should be."""

    def __init__(self, scheme, w, rng):
        self._scheme, self._w, self._rng = scheme, w, rng
        self.__name__, self.counts, self.as_given = scheme.__name__, [], True

    def __call__(self, w, rng, *more):
        same = np.shape(w)[-1:] == self._w.shape and np.allclose(w, self._w)
        self.as_given &= bool(same) and rng is self._rng
        found = self._scheme(w, rng, *more)
        rows = np.reshape(found, (-1, M))  # one set of ancestors, or a batch of them
        self.counts += [np.bincount(row, minlength=M) for row in rows]
        return found


def _copies(f, rng, runs):
    """Per scheme and run: what was returned, what the scheme made (-1: no call), how called."""
    found = []
    for scheme in rng.permutation(list(pf.SCHEMES.values()))[:3]:
        w = rng.dirichlet(np.ones(M))
        recorded = Recorded(scheme, w, rng)
        theirs = shaped(f(recorded, w.copy(), rng, runs), runs, M)
        made = np.full((runs, M), -1.0)
        kept = recorded.counts[:runs]
        made[: len(kept)] = np.reshape(kept, (-1, M))
        flags = [len(recorded.counts), recorded.as_given, 0, 0, 0, 0]
        found.append(np.stack([theirs, made, np.tile(flags, (runs, 1))], axis=-1))
    return np.stack(found, axis=1)


def _returned(x):
    return x[..., 0]


def _made(x):
    return x[..., 1]


def _calls(x):
    """How often each scheme was called."""
    return x[0, :, 0, 2]


@experiment(
    """Variance of the number of copies
    Count how often each index occurs in the result of scheme(w, rng).
    np.bincount counts; minlength keeps particles that got no copy.
    np.bincount(scheme(w, rng), minlength=len(w)), once per run, stacked.""",
    id="p7a",
    points=2,
    claim="each row counts the copies of one call of the scheme",
    test="every row is the count of one call, for three schemes and weights that the check chooses "
    "and watches",
    runs=60,
    pool=600,
    margin="no chance: what the scheme drew is compared with what was counted",
    measure=_copies,
)
def copies(scheme, w, rng, runs):
    """How many copies each particle got: whole numbers, shape (runs, M)."""
    return np.array([np.bincount(scheme(w, rng), minlength=len(w)) for _ in range(runs)])


copies.holds(
    "calls the scheme once per run",
    lambda x: (
        bool((_calls(x) == _calls(x).max()).all() and (_made(x) >= 0).all())
        or f"it is called {_calls(x).min():.0f} times"
    ),
)
copies.holds(
    "with the weights and the random numbers that it got", lambda x: (x[:, :, 1, 2] == 1).all()
)
copies.holds(
    "each row counts the copies of one call", lambda x: bool((_returned(x) == _made(x)).all())
)


def _each_call(x):
    """Is the scheme called for each run, with what it should get?"""
    return bool((_made(x) >= 0).all() and x[:, :, 1, 2].all())


copies.wrong("""shares: gives shares of the set, not numbers of copies
    Your row sums are 1. How many particles are there?
    Copies are whole numbers that sum to M.
    Do not divide by M.""")(
    lambda scheme, w, rng, runs: copies(scheme, w, rng, runs) / len(w),
    when=lambda x: _each_call(x) and np.allclose(_returned(x), _made(x) / M),
)
copies.wrong("""yes-or-no: tells only whether a particle survived
    Can a particle have two copies in your table?
    Survival is 0 or 1; copies are 0, 1, 2, ...
    Count with np.bincount(scheme(w, rng), minlength=len(w)).""")(
    lambda scheme, w, rng, runs: copies(scheme, w, rng, runs) > 0,
    when=lambda x: _each_call(x) and np.array_equal(_returned(x), _made(x) > 0),
)
copies.wrong("""one-call: calls the scheme once and repeats the result
    All your rows are equal.
    Each run needs a call of its own.
    Put scheme(w, rng) inside the loop over runs.""")(
    lambda scheme, w, rng, runs: np.tile(copies(scheme, w, rng, 1), (runs, 1)),
    when=lambda x: (_calls(x) == 1).all() and np.array_equal(_returned(x), _made(x[[0] * len(x)])),
)
copies.wrong("""no-call: never calls the scheme that it gets
    Where does your function use its first argument?
    The check hands over schemes of its own, and watches them.
    np.bincount(scheme(w, rng), minlength=len(w)).""")(
    lambda scheme, w, rng, runs: copies(pf.systematic, w, rng, runs),
    when=lambda x: (_calls(x) == 0).all(),
)
copies.wrong("""weights-ignored: hands other weights or other random numbers to the scheme
    Which weights and which generator does your call of the scheme get?
    The check chooses both, so that your table can be repeated.
    scheme(w, rng), with the w and the rng of the arguments.""")(
    lambda scheme, w, rng, runs: copies(scheme, np.full(len(w), 1 / len(w)), rng, runs),
    when=lambda x: (_made(x) >= 0).all() and not x[:, :, 1, 2].all(),
)


@copies.wrong(
    """gives ancestors, not numbers of copies
    What does index 3 in your row mean: particle 3, or 3 copies?
    scheme(w, rng) tells for each new particle which old one it copies.
    Count: np.bincount(scheme(w, rng), minlength=len(w)).""",
    when=lambda x: (
        _each_call(x)
        and all(
            np.array_equal(np.bincount(row.astype(int), minlength=M), made)
            for row, made in zip(_returned(x).reshape(-1, M), _made(x).reshape(-1, M), strict=True)
        )
    ),
)
def ancestors(scheme, w, rng, runs):
    return np.array([scheme(w, rng) for _ in range(runs)])


copies.refuses("what is expected, without a draw", named="no-call")(
    lambda scheme, w, rng, runs: np.tile(len(w) * w, (runs, 1))
)
copies.refuses("numpy's own draw", named="no-call")(
    lambda scheme, w, rng, runs: rng.multinomial(len(w), w, size=runs)
)
copies.refuses("zeros", named="no-call")(lambda scheme, w, rng, runs: np.zeros((runs, len(w))))
copies.refuses("a generator of its own", named="weights-ignored")(
    lambda scheme, w, rng, runs: copies(scheme, w, np.random.default_rng(1), runs)
)
copies.refuses("half of the runs, each twice")(
    lambda scheme, w, rng, runs: np.repeat(copies(scheme, w, rng, runs // 2), 2, axis=0)
)
copies.refuses("the copies in falling order")(
    lambda scheme, w, rng, runs: -np.sort(-copies(scheme, w, rng, runs), axis=1)
)
copies.refuses("the sum over the runs so far")(
    lambda scheme, w, rng, runs: np.cumsum(copies(scheme, w, rng, runs), axis=0)
)
copies.refuses("the deviation from what is expected")(
    lambda scheme, w, rng, runs: copies(scheme, w, rng, runs) - len(w) * w
)


ALWAYS, SELDOM = 1.0, 0.5  # thresholds


def _often_or_seldom(rng):
    """Resampling always and when needed: few particles for long, and more for a short time.

    Two films move, so that their frames count; two settings have noise, so that it does.
    """
    few, more = int(rng.integers(12, 19)), int(rng.integers(45, 66))
    long, short, middle = (int(rng.integers(*ends)) for ends in ((28, 37), (3, 6), (15, 20)))
    seeds = rng.integers(2**31, size=2)
    round_, still = (
        target_log(path, seed=int(k)) for path, k in zip(("circle", "fixed"), seeds, strict=True)
    )
    noisy = float(rng.uniform(60, 100))
    return [
        (round_[:long], ALWAYS, 0.0, few), (round_[:long], SELDOM, 0.0, few),
        (still[:short], ALWAYS, 0.0, more), (still[:short], SELDOM, 0.0, more),
        (round_[:middle], SELDOM, 0.0, more),  # weights far from equal at the end
        (still[:long], SELDOM, noisy, few),
    ]  # fmt: skip


@experiment(
    """Resample always, or only when the ESS is low?
    One number per run: the mean of x at the end, minus the true x.
    pf.step has the arguments scheme and threshold.
    In the loop: bel, _ = pf.step(bel, u, z, motion, sensor, rng, pf.multinomial, threshold).""",
    id="p7b",
    points=2,
    claim="the error scatters with film, threshold, process noise and particles as that of a right "
    "experiment",
    test="mean of the error and of its square within 5 standard errors of a right one at each of "
    "six settings",
    runs=400,
    pool=12_000,
    settings=_often_or_seldom,
    together=True,
    false_fail=1e-3,
    margin="5 standard errors in 14 comparisons: 8e-6 for normal means",
)
def final_error(film, threshold, sigma, M, rng, runs):
    """Error in x of the last estimate, px: shape (runs,)."""
    bel = lab.around(film.start[:2], (runs, M), rng, sigma=80.0)
    motion, sensor = pf.FixedTarget(sigma), pf.Position(300.0)
    for _, u, z, _ in film:
        bel, _ = pf.step(bel, u, z, motion, sensor, rng, pf.multinomial, threshold)
    return pf.mean_pose(bel)[0] - film.truth[0, -1]


def _same_squares(standard_errors=5.0):
    """The squared errors are as large on average: the scatter about the truth is the same."""
    return lambda x: same_mean(standard_errors)(x**2)


def _sizes(x):
    """Root mean square of the answer (settings,), and of the reference."""
    return np.moveaxis(np.sqrt((x**2).mean(axis=0)), -1, 0)


def _within(ratio, a, b):
    return bool((np.abs(np.log(a / b)) < np.log(ratio)).all())


def _resamples_as(x, threshold):
    """At all settings the error is as large as that of a right one with this threshold."""
    found, right = _sizes(x[:, :4])
    same = right[[0, 0, 2, 2]] if threshold == ALWAYS else right[[1, 1, 3, 3]]
    return bool((x[..., 0] < 0).any() and (x[..., 0] > 0).any() and _within(1.2, found, same))


final_error.holds("the errors average out as those of a right experiment", same_mean(5.0))
final_error.holds(
    "they scatter as much, for each film, threshold, noise and number of particles", _same_squares()
)
final_error.wrong("""never-always: gives for both thresholds what resampling below ESS = M/2 gives:
         it ignores the threshold, or the scheme is not multinomial
    Your two variances agree. Where do threshold and scheme enter?
    pf.step resamples if ESS < threshold * M, by the scheme you pass.
    End the call with pf.multinomial, threshold.""")(
    lambda film, threshold, sigma, M, rng, runs: final_error(film, SELDOM, sigma, M, rng, runs),
    when=lambda x: _resamples_as(x, SELDOM),
)
final_error.wrong("""always: resamples at every frame, whatever the threshold
    Your two variances agree, and are large. Where does the threshold enter?
    pf.step resamples if ESS < threshold * M.
    End the call with pf.multinomial, threshold.""")(
    lambda film, threshold, sigma, M, rng, runs: final_error(film, ALWAYS, sigma, M, rng, runs),
    when=lambda x: _resamples_as(x, ALWAYS),
)
final_error.wrong("""absolute-error: returns distances, which are never negative
    Can your errors be negative?
    The variance of an estimate needs the signed error.
    Return the mean of x minus the true x, without abs or hypot.""")(
    lambda film, threshold, sigma, M, rng, runs: np.abs(
        final_error(film, threshold, sigma, M, rng, runs)
    ),
    when=lambda x: bool((x[..., 0] >= 0).all()) and _same_squares(4.0)(x) is True,
)
final_error.wrong("""estimate: returns the mean of x itself, not its error
    Around which number do your results scatter?
    An error is an estimate minus the truth.
    pf.mean_pose(bel)[0] - film.truth[0, -1].""")(
    lambda film, threshold, sigma, M, rng, runs: (
        final_error(film, threshold, sigma, M, rng, runs) + film.truth[0, -1]
    )
)
final_error.wrong("""other-axis: returns the mean of x minus the true y
    Around which number do your results scatter?
    The truth is (x, y, heading).
    pf.mean_pose(bel)[0] - film.truth[0, -1].""")(
    lambda film, threshold, sigma, M, rng, runs: (
        final_error(film, threshold, sigma, M, rng, runs) - np.diff(film.truth[:2, -1])
    )
)
final_error.wrong("""squared: returns squared errors
    In which unit are your errors?
    The check takes the variance itself.
    Return the mean of x minus the true x.""")(
    lambda film, threshold, sigma, M, rng, runs: (
        final_error(film, threshold, sigma, M, rng, runs) ** 2
    ),
    when=lambda x: (
        bool((x[..., 0] >= 0).all())
        and same_mean(4.0)(np.stack([x[..., 0], x[..., 1] ** 2], axis=-1)) is True
    ),
)


final_error.refuses("normal numbers with the right sd for 100 particles and 50 frames")(
    lambda film, threshold, sigma, M, rng, runs: rng.normal(
        0, 24.5 if threshold == 1 else 5.7, runs
    )
)
final_error.refuses("zeros")(lambda film, threshold, sigma, M, rng, runs: np.zeros(runs))
final_error.refuses("random in range")(
    lambda film, threshold, sigma, M, rng, runs: rng.uniform(-60, 60, runs)
)
final_error.refuses("half as many particles")(
    lambda film, threshold, sigma, M, rng, runs: final_error(
        film, threshold, sigma, M // 2, rng, runs
    )
)
final_error.refuses("one run, repeated")(
    lambda film, threshold, sigma, M, rng, runs: np.repeat(
        final_error(film, threshold, sigma, M, rng, 1), runs
    )
)
final_error.refuses("100 particles, whatever is asked")(
    lambda film, threshold, sigma, M, rng, runs: final_error(film, threshold, sigma, 100, rng, runs)
)
final_error.wrong("""noise-ignored: gives the motion model a process noise of its own
    Does your function use sigma?
    The check chooses how much the model expects the target to move.
    pf.FixedTarget(sigma).""")(
    lambda film, threshold, sigma, M, rng, runs: final_error(film, threshold, 1.0, M, rng, runs)
)
final_error.wrong("""film-ignored: takes the frames of the lab's film, whatever it is asked
    Which of your arguments does not occur in your function?
    The check chooses the film, and how many frames it has.
    for t, u, z, _ in film.""")(
    lambda film, threshold, sigma, M, rng, runs: final_error(
        lab.film[:50], threshold, sigma, M, rng, runs
    )
)
final_error.refuses("as many frames of the lab's film as it is asked for", named="film-ignored")(
    lambda film, threshold, sigma, M, rng, runs: final_error(
        lab.film[: len(film)], threshold, sigma, M, rng, runs
    )
)
final_error.refuses("the first frame, as often as there are frames")(
    lambda film, threshold, sigma, M, rng, runs: final_error(
        replace(film, z=[film.z[0]] * len(film)), threshold, sigma, M, rng, runs
    )
)


def _filtered(film, threshold, sigma, M, rng, runs, start=80.0, sensor=300.0):
    bel = lab.around(film.start[:2], (runs, M), rng, sigma=start)
    for _, u, z, _ in film:
        models = pf.FixedTarget(sigma), pf.Position(sensor)
        bel, _ = pf.step(bel, u, z, *models, rng, pf.multinomial, threshold)
    return bel


final_error.refuses("the mean of the particles without their weights")(
    lambda film, threshold, sigma, M, rng, runs: (
        _filtered(film, threshold, sigma, M, rng, runs).state[0].mean(axis=-1) - film.truth[0, -1]
    )
)
final_error.refuses("one particle of the cloud for its mean")(
    lambda film, threshold, sigma, M, rng, runs: (
        _filtered(film, threshold, sigma, M, rng, runs).state[0, :, 0] - film.truth[0, -1]
    )
)
final_error.refuses("a start within 20 px")(
    lambda film, threshold, sigma, M, rng, runs: (
        pf.mean_pose(_filtered(film, threshold, sigma, M, rng, runs, start=20.0))[0]
        - film.truth[0, -1]
    )
)
final_error.refuses("a sensor that says much, sd 30 px")(
    lambda film, threshold, sigma, M, rng, runs: (
        pf.mean_pose(_filtered(film, threshold, sigma, M, rng, runs, sensor=30.0))[0]
        - film.truth[0, -1]
    )
)


p7c = Choice("""Which schemes never make an estimate more variable than multinomial?
    a  Systematic, because its numbers of copies vary least
       = Its teeth are linked; with alternating weights it was 333 times worse.
    b  All schemes that are unbiased
       = Unbiased says nothing about variance, and multinomial is unbiased too.
    c* Stratified and residual
       = Yes, this is proved for both; systematic is often better still, not always.
    d  None: it depends on the particles
       = It does for systematic; for stratified and residual there is a proof.""")
