"""The Bayes filter in a corridor. Two lines, by hand, in code and under test."""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment
from pfkit.labs.response import same_mean

PREDICT = Question("Predictions")

CELLS = 10

DOORS = np.isin(np.arange(CELLS), (1, 2, 6))

KERNEL = pf.shift_kernel(1, undershoot=0.1, overshoot=0.1)

twice = Prediction("""Robots that count each look twice and say 90 %
    a  in 90 % of the cases
    b  more often, they have looked twice
    c* clearly less often
    d  never""")

zero = Prediction("""Robots that once give probability zero to their own cell
    a  hardly any
    b  about 5 in a hundred
    c  about a quarter
    d* about three quarters""")

HAND = Question("By hand")


def _moved(a, b, c, d, total, go):
    bel = np.array([a, b, c, d]) / total
    return tuple((go * np.roll(bel, 1) + (1 - go) * bel).round(4))


def _another_belief(rng):
    a, b, c, d = (int(x) for x in rng.permutation([1, 2, 4, 6]) + rng.integers(2))
    go = float(rng.choice([0.7, 0.75, 0.8, 0.85, 0.9]))
    return {"a": a, "b": b, "c": c, "d": d, "total": a + b + c + d, "go": go}


moved = Numeric(
    """Predicted belief of the four cells after ({a}, {b}, {c}, {d}) / {total}, with a probability
         of {go} to move
    Each cell takes {go} from its left neighbour and keeps the rest of its own.
    The left neighbour of cell 1 is cell 4, with {d} / {total}.
    Cell 1: {go} * {d} / {total} + (1 - {go}) * {a} / {total}; go on like that.""",
    _moved,
    tol=0.002,
    names=("cell 1", "cell 2", "cell 3", "cell 4"),
    world={"a": 8, "b": 8, "c": 1, "d": 1, "total": 18, "go": 0.9},
    draw=_another_belief,
)
moved.wrong("""backwards: moves the belief to the left
    Which way does the robot drive?
    What was in cell 1 is mostly in cell 2 afterwards.
    New cell 2 = {go} * old cell 1 + (1 - {go}) * old cell 2.""")(
    lambda a, b, c, d, total, go: _moved(d, c, b, a, total, go)[::-1]
)
moved.wrong("""no-noise: moves every robot by exactly one cell
    Now and then it stays.
    Keep 1 - {go} of each cell where it was.
    New cell 1 = {go} * {d} / {total} + (1 - {go}) * {a} / {total}.""")(
    lambda a, b, c, d, total, go: _moved(a, b, c, d, total, 1)
)
moved.wrong("""swapped: takes the chance to stay for the chance to move
    Which is more probable, that it moves or that it stays?
    It moves with probability {go}.
    New cell 1 = {go} * {d} / {total} + (1 - {go}) * {a} / {total}.""")(
    lambda a, b, c, d, total, go: _moved(a, b, c, d, total, 1 - go)
)
moved.wrong("""one-cell-off: has the right numbers one cell too far to the left
    Which cell gets most from cell 1?
    Most of what was in cell 1 is in cell 2 afterwards.
    New cell 2 = {go} * {a} / {total} + (1 - {go}) * {b} / {total}.""")(
    lambda a, b, c, d, total, go: tuple(np.roll(_moved(a, b, c, d, total, go), -1))
)
moved.wrong("""no-ring: lets the robots that leave cell 4 drop out
    Do your four numbers sum to one?
    The cells form a ring: cell 1 lies behind cell 4.
    Add {go} * {d} / {total} to cell 1.""")(
    lambda a, b, c, d, total, go: (
        (1 - go) * a / total,
        *_moved(a, b, c, d, total, go)[1:],
    )
)

looked = Numeric(
    """Belief in the third cell, and the sum of the products
    Multiply the predicted belief by .2, .2, .9, .9.
    The products are .0189, .0889, .3650, .0500.
    They sum to .523; the third is .365 / .523.""",
    (0.698, 0.523),
    tol=0.004,
    names=("belief in cell 3", "sum"),
)
looked.wrong("""door: uses the probabilities of the report 'door'
    What did the detector say?
    It said 'no door': one minus each of the others.
    .2 at the doors, .9 at the walls.""")((0.0850, 0.4772))
looked.wrong("""not-divided: gives the product before it is divided by the sum
    Do your four products sum to one?
    Divide the third product by their sum.
    .365 / .523.""")((0.365, 0.523))
looked.wrong("""before-the-move: starts from the belief before the move
    Which belief does the second look meet?
    The robot has moved since: take your four predicted numbers.
    .2 * .0944, .2 * .4444, .9 * .4056, .9 * .0556.""")((0.18, 0.278))
looked.wrong("""sum-of-beliefs: gives the sum of the beliefs, which is always one
    Which numbers are to be summed, and when?
    Sum the four products, before you divide.
    .0189 + .0889 + .3650 + .0500.""")((0.698, 1.0))

IDEA = Question("Assumptions")

markov = Choice("""A wet patch that nobody has located
    a  none, slip is just noise
       = Slip at the same place each time is no fresh noise: the past tells where it comes.
    b* that a move depends only on the start cell and the control
       = Yes: earlier slips in that place say something about the next one.
    c  that a report depends only on the present cell
       = The detector is not affected by the floor.
    d  that the corridor has ten cells
       = The cells are not the trouble, their hidden wetness is.""")

evidence = Choice("""Log evidence -12 against -15
    a  nothing, evidence is only a normaliser
       = It normalises one filter, and compares two.
    b  map B, it has the larger number without its sign
       = A log of -15 is the smaller probability.
    c  map A is 1.25 times as probable as map B
       = Logarithms are subtracted, not divided.
    d* map A is about 20 times as probable as map B
       = Yes: exp(-12) / exp(-15) = exp(3), about 20.""")

CODE = Question("Code")


def _belief(seed):
    rng = np.random.default_rng(seed)
    bel = rng.random(6)
    return bel / bel.sum(), rng.random(6)


def _same(found, expected):
    return np.allclose(found, expected, rtol=2e-6, atol=1e-12)


def _bayes(part):
    return lambda f: all(
        _same(f(*_belief(s))[part], correct(*_belief(s))[part]) for s in (*range(4), 11)
    )


def _untouched(f):
    bel, like = _belief(9)
    kept = bel.copy(), like.copy()
    f(bel, like)
    return np.array_equal(kept[0], bel) and np.array_equal(kept[1], like)


def _ruled_out(f):
    """The belief where the report has ruled out two cells, and another one was ruled out before."""
    bel, like = _belief(10)
    return np.asarray(f(bel * (np.arange(6) != 3), like * (np.arange(6) > 1))[0], dtype=float)


@code(
    """Correct
    Multiply cell by cell, then divide by the sum.
    The sum is the second thing to return.
    joint = bel * likelihood; return joint / joint.sum(), joint.sum()""",
    fingerprint=lambda f: np.concatenate(
        [np.append(*map(np.ravel, f(*_belief(s)))) for s in (1, 2)]
    ),
)
def correct(bel, likelihood):
    joint = bel * likelihood
    return joint / joint.sum(), joint.sum()


correct.holds("the new belief is likelihood times belief, divided by the sum", _bayes(0))
correct.holds("the evidence is that sum", _bayes(1))
correct.holds(
    "a cell that was ruled out keeps exactly zero",
    lambda f: (_ruled_out(f)[[0, 1, 3]] == 0).all(),
)
correct.holds("the arguments are left as they were", _untouched)
correct.wrong("""in-place: changes the array it was given
    What does the caller's belief look like afterwards?
    bel *= likelihood writes into the argument, and so does likelihood *= bel.
    Make a new array: joint = bel * likelihood""")(
    lambda bel, like: (np.divide(np.multiply(bel, like, out=bel), bel.sum(), out=bel), 1.0),
    when=lambda f: not _untouched(f),
)
correct.wrong("""likelihood-only: normalises the likelihood and forgets the belief
    What did the robot know before the look?
    Multiply by the old belief first.
    joint = bel * likelihood""")(lambda bel, like: (like / like.sum(), like.sum()))


@correct.wrong("""averages belief and likelihood instead of multiplying them
    A cell that the report rules out: what should its belief be?
    A likelihood of zero must give zero. Averages do not.
    joint = bel * likelihood""")
def average(bel, like):
    return ((bel + like) / (bel + like).sum(), (bel + like).sum())


correct.wrong("""eta: returns the normaliser eta, one over the evidence
    Can a probability exceed one?
    The evidence is the sum itself.
    return joint / joint.sum(), joint.sum()""")(
    lambda bel, like: (correct(bel, like)[0], 1 / correct(bel, like)[1])
)
correct.wrong("""not-divided: returns the products before they are divided by their sum
    What do your beliefs sum to?
    Divide by the sum of the products.
    return joint / joint.sum(), joint.sum()""")(lambda bel, like: (bel * like, np.sum(bel * like)))
correct.wrong("""sum-after: returns the sum after dividing, which is always one
    Can the evidence be one for every report?
    Take the sum of the products before you divide by it.
    return joint / joint.sum(), joint.sum()""")(lambda bel, like: (correct(bel, like)[0], 1.0))
correct.wrong(
    """adds-a-little: adds a small number everywhere, so that nothing stays at zero
    A cell that was ruled out: what is its belief afterwards?
    The small number belongs into the detector's model, not into this line.
    Leave it out: joint = bel * likelihood"""
)(
    lambda bel, like: correct(bel + 1e-6, like + 1e-6),
    when=lambda f: (
        (_ruled_out(f)[[0, 1, 3]] > 0).all()
        and _ruled_out(f).max() < 1
        and np.allclose(_ruled_out(f), _ruled_out(correct), atol=0.01)
    ),
)
correct.refuses("divides by the largest product")(
    lambda bel, like: (bel * like / np.max(bel * like), np.sum(bel * like))
)
correct.refuses("rounds its beliefs")(
    lambda bel, like: (correct(bel, like)[0].round(5), correct(bel, like)[1])
)
correct.refuses("the mean of the products for their sum")(
    lambda bel, like: (correct(bel, like)[0], np.mean(bel * like))
)
correct.refuses("evidence and belief the wrong way round")(
    lambda bel, like: correct(bel, like)[::-1]
)
correct.refuses("normalises the likelihood first, so that the evidence is another")(
    lambda bel, like: correct(bel, like / like.sum())
)
correct.refuses("squares the likelihood")(lambda bel, like: correct(bel, like**2))
correct.refuses("hides an impossible report", named="adds-a-little")(
    lambda bel, like: correct(np.maximum(bel, 1e-9), np.maximum(like, 1e-9))
)

MOVES = {0: 0.1, 1: 0.7, 2: 0.2}
FORK = {0: 0.45, 1: 0.15, 3: 0.4}
BACK = {-1: 0.6, 0: 0.3, -2: 0.1}


def _follows(*several):
    return lambda f: all(
        _same(f(_belief(3)[0], m), predict_line(_belief(3)[0], m)) for m in several
    )


@code(
    """Predict
    np.roll(bel, 1) moves all cells one on.
    Weigh each rolled belief with its probability and add them up.
    return sum(p * np.roll(bel, cells) for cells, p in moves.items())""",
    fingerprint=lambda f: np.concatenate([f(_belief(5)[0], m) for m in (MOVES, FORK)]),
)
def predict_line(bel, moves):
    return sum(p * np.roll(bel, cells) for cells, p in moves.items())


predict_line.holds(
    "a sure move of one cell moves the belief one cell on",
    lambda f: _same(f(np.eye(5)[1], {1: 1.0}), np.eye(5)[2]),
)
predict_line.holds(
    "the last cell's neighbour is the first",
    lambda f: _same(f(np.eye(5)[4], {1: 1.0}), np.eye(5)[0]),
)
predict_line.holds(
    "every cell is the sum over where the robot may have come from", _follows(MOVES, FORK)
)
predict_line.holds("a negative move is one back", _follows(BACK))
predict_line.holds(
    "the belief still sums to one", lambda f: _same(np.sum(f(_belief(4)[0], FORK)), 1)
)
predict_line.wrong("""backwards: moves the belief the wrong way
    Put all belief into cell 1 and move by one. Where is it?
    np.roll with a positive number moves to the right.
    np.roll(bel, cells)""")(lambda bel, moves: sum(p * np.roll(bel, -c) for c, p in moves.items()))
predict_line.wrong("""best-move: takes the most probable move as certain
    Does your belief spread?
    Less probable moves count too, with their probability.
    Sum over all moves.""")(lambda bel, moves: np.roll(bel, max(moves, key=moves.get)))
predict_line.wrong("""mean-move: gives all moves the same probability
    Where do the probabilities in the dictionary enter?
    Multiply each rolled belief by its own.
    p * np.roll(bel, cells)""")(lambda bel, moves: sum(np.roll(bel, c) for c in moves) / len(moves))
predict_line.wrong("""expected-move: moves everything by the expected number of cells
    Does your belief spread?
    The robot makes one of the moves, not their average.
    Roll by each number of cells, and add up with the probabilities.""")(
    lambda bel, moves: np.roll(bel, round(sum(c * p for c, p in moves.items())))
)


@predict_line.wrong("""lets belief drop off the end of the corridor
    What does the belief sum to after a few moves?
    The corridor is a ring: behind the last cell comes the first.
    np.roll(bel, cells), or bel[(i - cells) % len(bel)]""")
def no_ring(bel, moves):
    new = np.zeros(len(bel))
    for i in range(len(bel)):
        new[i] = sum(p * bel[i - c] for c, p in moves.items() if 0 <= i - c < len(bel))
    return new


predict_line.refuses("its own moves instead of those it is given")(
    lambda bel, moves: predict_line(bel, {0: 0.1, 1: 0.8, 2: 0.1})
)
predict_line.refuses("forgets the robots that stay")(
    lambda bel, moves: sum(p * np.roll(bel, c) for c, p in moves.items() if c)
)
predict_line.refuses("takes moves back for moves on")(
    lambda bel, moves: sum(p * np.roll(bel, abs(c)) for c, p in moves.items())
)
predict_line.refuses("squares the probabilities and divides by the sum")(
    lambda bel, moves: (
        sum(p * p * np.roll(bel, c) for c, p in moves.items()) / sum(p * p for p in moves.values())
    )
)
predict_line.refuses("rounds to three decimals")(
    lambda bel, moves: predict_line(bel, moves).round(3)
)

BREAK = Question("Experiments")


def drive(rng, B=1, T=8, looks=1, real=(0.8, 0.1), assumed=(0.8, 0.1)):
    """The chapter's robots: beliefs before and after each look, cells, reports, evidence."""
    x, bel, seen = rng.integers(CELLS, size=B), np.full((B, CELLS), 1 / CELLS), []
    for _ in range(T):
        x = (x + rng.choice(3, B, p=[0.1, 0.8, 0.1])) % CELLS
        z = rng.random(B) < np.where(DOORS[x], *real)
        before = pf.predict_1d(bel, KERNEL, ring=True)
        p_door = np.where(DOORS, *assumed)
        like = np.where(z[:, None], p_door, 1 - p_door) ** looks
        bel, p_z = pf.update_1d(before, like)
        seen.append((before, bel, x, z, p_z))
    return [np.array(part) for part in zip(*seen, strict=True)]


RING = sum(p * np.roll(np.eye(CELLS), s, axis=1) for s, p in {0: 0.1, 1: 0.8, 2: 0.1}.items())
ROBOTS = 300


def _detector(copies):
    """``run(power, rng)`` of a detector that sends each frame ``copies`` times.

    It gives what the chapter's ``drive`` gives after 15 steps, ``after[-1], cells[-1]``.
    """
    p_door = np.where(DOORS, 0.8, 0.1)

    def run(power, rng):
        like = np.stack([1 - p_door, p_door]) ** (copies * power)
        x, bel = rng.integers(CELLS, size=ROBOTS), np.full((ROBOTS, CELLS), 1 / CELLS)
        for _ in range(15):
            x = (x + rng.choice(3, ROBOTS, p=[0.1, 0.8, 0.1])) % CELLS
            bel = bel @ RING * like[(rng.random(ROBOTS) < p_door[x]).astype(int)]
            bel /= bel.sum(axis=1, keepdims=True)
        return bel, x

    return run


def _powers(f, rng, runs):
    """Of each run and each of five detectors in a new order: the power found, the honest one."""
    found = np.empty((runs, 5, 2))
    for row in found:
        for pair, copies in zip(row, rng.permutation(5) + 1, strict=True):
            pair[:] = f(_detector(copies), np.random.default_rng(rng.integers(2**63))), 1 / copies
    return found


def _near(found, factor):
    """Which numbers found lie within a factor of the right ones?"""
    ratio = found[..., 0] / found[..., 1]
    return (ratio < factor) & (ratio > 1 / factor)


@experiment(
    """The power at which a filter is honest
    Try many powers. For each, compare what the robots claim with what is true.
    Claim: beliefs.max(axis=1). True: beliefs.argmax(axis=1) == cells. Where do the means meet?
    Return the power with the smallest difference of the two means.""",
    points=2,
    after=twice,
    runs=2,
    pool=40,
    measure=_powers,
    claim="a filter that raises each likelihood to one over the number of copies is honest",
    test="in 9 of 10 trials with hidden detectors a power within a factor of 1.5 of the honest one",
    margin="the power of a right search scatters by a factor of 1.1",
)
def twice_x(run, rng):
    powers, gaps = np.geomspace(0.1, 1.5, 20), []
    for power in powers:
        beliefs, cells = run(power, rng)
        claim, right = beliefs.max(axis=1), beliefs.argmax(axis=1) == cells
        gaps.append(abs(claim.mean() - right.mean()))
    return powers[np.argmin(gaps)]


@twice_x.holds("9 of 10 powers within a factor of 1.5 of the honest ones")
def _honest(found):
    off = np.argwhere(~_near(found, 1.5))
    if len(off) <= 0.1 * found[..., 0].size:
        return True
    power, right = found[tuple(off[0])]
    return (
        f"{len(off)} of {found[..., 0].size} were not: for a detector that sends each frame "
        f"{1 / right:.0f} x you gave {power:.3g}, honest is {right:.3g}"
    )


twice_x.wrong("""same: is the same power or nearly, whatever detector is handed over
    Does your answer change when frames come five times instead of once?
    Call run(power, rng) for several powers, and choose by what it returns.
    Return the power with the smallest difference between claim and truth.""")(
    lambda run, rng: 0.5, when=lambda x: x[..., 0].max() <= 1.5 * x[..., 0].min()
)
twice_x.wrong("""copies: is how often a look counts, not the power that makes up for it
    A frame that comes three times: more than 1, or less?
    The likelihood should count once in all.
    Return one over that number.""")(
    lambda run, rng: 1 / twice_x(run, rng),
    when=lambda x: _near(np.stack([1 / x[..., 0], x[..., 1]], axis=-1), 1.5).mean() >= 0.9,
)


def _claimed_in_full(x):
    """Is each number the mean claim of robots that count that detector's frames in full?"""
    claims = {
        c: _detector(c)(1, np.random.default_rng(c))[0].max(axis=1).mean() for c in range(1, 6)
    }
    wanted = np.vectorize(claims.get)((1 / x[..., 1]).round().astype(int))
    return np.abs(x[..., 0] - wanted).max() < 0.07


twice_x.wrong(
    """claims: is the mean claim of robots that count each look in full
    What does the filter do with the number that you return?
    Which power made claim and truth equal?
    Run several powers, and return one of them.""",
    when=_claimed_in_full,
)(lambda run, rng: run(1, rng)[0].max(axis=1).mean())
twice_x.refuses("a constant at the right value for two copies", named="same")(lambda run, rng: 0.5)
twice_x.refuses("counts in full", named="same")(lambda run, rng: 1)
twice_x.refuses("random in range")(lambda run, rng: rng.uniform(0.1, 1))
twice_x.refuses("one of the right powers by lot")(lambda run, rng: 1 / rng.integers(1, 6))


def _best(score):
    """Returns the power with the largest score of (beliefs, cells)."""

    def search(run, rng):
        powers = np.geomspace(0.1, 1.5, 10)
        return powers[np.argmax([score(*run(power, rng)) for power in powers])]

    return search


twice_x.refuses("the largest claim", named="same")(_best(lambda bel, x: bel.max(axis=1).mean()))
twice_x.refuses("the smallest claim", named="same")(_best(lambda bel, x: -bel.max(axis=1).mean()))
twice_x.refuses("scales by right over claimed")(
    lambda run, rng: (lambda bel, x: np.mean(bel.argmax(axis=1) == x) / bel.max(axis=1).mean())(
        *run(1, rng)
    )
)
twice_x.refuses("claims just two in three, honest or not")(
    _best(lambda bel, x: -abs(bel.max(axis=1).mean() - 2 / 3))
)


def _knobs(rng):
    """Steps, real and assumed rate of false alarms: often, seldom, never ruled out."""
    return [
        (int(rng.integers(10, 14)), float(rng.uniform(0.08, 0.11)), 1e-12),
        (int(rng.integers(8, 13)), float(rng.uniform(0.03, 0.06)), 1e-10),
        (int(rng.integers(8, 13)), float(rng.uniform(0.05, 0.1)), 0.02),
    ]


ALONE = 100  # robots of one run


def _lost(steps, real, assumed, rng, robots=ALONE):
    """After which look (steps, robots) had a robot's own cell almost no belief?"""
    rates = {"real": (0.8, real), "assumed": (0.8, assumed)}
    _, after, cells, _, _ = drive(rng, robots, steps, **rates)
    return np.take_along_axis(after, cells[..., None], axis=2)[..., 0] < 1e-6


@experiment(
    """Robots that rule out their own cell
    100 robots: drive with B=100, T=steps, real=(0.8, real), assumed=(0.8, assumed).
    after[k, b, cells[k, b]] is robot b's belief in its true cell after look k.
    Mean over robots of (own.min(axis=0) < 1e-6), where own has a row for each look.""",
    points=2,
    after=zero,
    runs=18,
    pool=288,
    settings=_knobs,
    claim="false alarms that the filter holds impossible rule out the true cell",
    test="the share is that of a right experiment with the same numbers",
    margin="within six standard errors of the difference, at each of three settings",
)
def zero_x(steps, real, assumed, rng):
    _, after, cells, _, _ = drive(rng, B=100, T=steps, real=(0.8, real), assumed=(0.8, assumed))
    own = np.take_along_axis(after, cells[..., None], axis=2)[..., 0]
    return np.mean(own.min(axis=0) < 1e-6)


@zero_x.holds("each run gives a share of 100 robots")
def _of_hundred(x):
    count = x[..., 0] * ALONE
    whole = (np.abs(count - count.round()) < 1e-6) & (count >= 0) & (count <= ALONE)
    if not whole.all():
        return f"{count[~whole][0] / ALONE:.4g} is no whole number of hundredths"
    return (count.round() % 2).any() and (count.round() % 5).any()


zero_x.holds("the share follows steps and rates", same_mean(6))
zero_x.holds(
    "it scatters from run to run, as robots do",
    lambda x: 0.25 < x[..., 0].var(axis=0).sum() / x[..., 1].var(axis=0).sum() < 4,
)
zero_x.wrong("""none-lost: loses no robot, whatever rate of false alarms the filter assumes
    What does the filter assume about walls, and what do walls do?
    The filter's rate is `assumed`, the world's is `real`.
    real=(0.8, real), assumed=(0.8, assumed)""")(
    lambda steps, real, assumed, rng: zero_x(steps, real, real, rng),
    when=lambda x: (x[..., 0] == 0).all(),
)


def _share_of_time(x):
    """Finer than a share of robots can be, well below it, and zero where no robot is lost."""
    mine, right = x.mean(axis=0).T
    fine = np.abs(x[..., 0] * ALONE - (x[..., 0] * ALONE).round()).max() > 1e-6
    return fine and (mine[:2] < 0.5 * right[:2]).all() and (mine[:2] > 0).all() and mine[2] == 0


zero_x.wrong("""time: is a share of time, not of robots
    One robot, one answer: did it ever happen?
    Take the smallest belief of each robot first, then the share of robots.
    own.min(axis=0) < 1e-6""")(lambda *knobs: _lost(*knobs).mean(), when=_share_of_time)
zero_x.wrong("""one-look: looks after one of the steps only
    The question is whether it ever happened.
    Look at the true cell after every step, not only after the last or the first.
    own.min(axis=0) < 1e-6""")(lambda *knobs: _lost(*knobs)[-1].mean())
zero_x.wrong("""any-cell: asks whether any cell had almost no belief, not the robot's own
    Which cell matters to a robot?
    Take the belief in the cell where it stands: cells[k, b].
    after[k, b, cells[k, b]]""")(
    lambda steps, real, assumed, rng: np.mean(
        drive(rng, ALONE, steps, real=(0.8, real), assumed=(0.8, assumed))[1].min(axis=(0, 2))
        < 1e-6
    )
)
zero_x.wrong("""before-the-look: takes the beliefs before each look, which a move has refilled
    When does a false alarm rule a cell out?
    `drive` returns beliefs before and after each look.
    _, after, cells, _, _ = drive(...)""")(
    lambda steps, real, assumed, rng: np.mean(
        np.min(
            [
                bel[np.arange(ALONE), x]
                for bel, x in zip(
                    *drive(rng, ALONE, steps, real=(0.8, real), assumed=(0.8, assumed))[0:3:2],
                    strict=True,
                )
            ],
            axis=0,
        )
        < 1e-6
    )
)
zero_x.wrong("""one-robot: is the answer of one robot, yes or no
    How finely can one robot measure a share?
    Run 100 robots at once: B=100.
    Return the share of them.""")(
    lambda *knobs: float(_lost(*knobs, robots=1).any()),
    when=lambda x: np.isin(x[..., 0], (0, 1)).all() and np.ptp(x[..., 0]) == 1,
)
zero_x.refuses("a constant at the value of the text")(lambda *knobs: 0.76)
zero_x.refuses("a coin with the bias of the text")(
    lambda steps, real, assumed, rng: rng.binomial(ALONE, 0.76) / ALONE
)
zero_x.refuses("the formula of the text, not an experiment")(
    lambda steps, real, assumed, rng: 1 - (1 - real) ** (0.7 * steps)
)
zero_x.refuses("the formula, scattered")(
    lambda steps, real, assumed, rng: rng.binomial(ALONE, 1 - (1 - real) ** (0.7 * steps)) / ALONE
)
zero_x.refuses("random in range")(lambda steps, real, assumed, rng: rng.integers(101) / 100)
zero_x.refuses("half the robots")(lambda *knobs: _lost(*knobs, robots=50).any(axis=0).mean())
zero_x.refuses("1,000 robots")(lambda *knobs: _lost(*knobs, robots=1000).any(axis=0).mean())
zero_x.refuses("always 40 steps")(lambda steps, real, assumed, rng: zero_x(40, real, assumed, rng))
zero_x.refuses("always the rate 0.05")(
    lambda steps, real, assumed, rng: zero_x(steps, 0.05, assumed, rng)
)
zero_x.refuses("zero", named="none-lost")(lambda *knobs: 0)
zero_x.refuses("the two rates exchanged", named="none-lost")(
    lambda steps, real, assumed, rng: zero_x(steps, assumed, real, rng)
)

why = Text(
    """Why is exactly zero different from very small?
    says that a product never leaves zero, whatever the later reports
    says that a very small belief recovers after enough reports
    puts the small number into the sensor (or motion) model, not onto the result""",
    model="A zero stays zero under every later multiplication, while a small number grows back "
    "when reports agree with it. "
    "The small number belongs into the sensor model, as the chance that a report is false, "
    "because then it means something.",
)


LAB = Lab.of(__name__, "The Bayes filter in a corridor")
__getattr__ = LAB.verb
