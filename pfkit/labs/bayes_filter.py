"""The Bayes filter in a corridor. Two lines, by hand, in code and under test."""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment

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

moved = Numeric(
    """Predicted belief of the four cells
    Each cell takes .9 from its left neighbour and keeps .1 of its own.
    The left neighbour of cell 1 is cell 4, with .0556.
    Cell 1: .9 * .0556 + .1 * .4444 = .0944; go on like that.""",
    (0.0944, 0.4444, 0.4056, 0.0556),
    tol=0.002,
    names=("cell 1", "cell 2", "cell 3", "cell 4"),
)
moved.wrong("""backwards: moves the belief to the left
    Which way does the robot drive?
    What was in cell 1 is mostly in cell 2 afterwards.
    New cell 2 = .9 * old cell 1 + .1 * old cell 2.""")((0.4444, 0.0944, 0.0556, 0.4056))
moved.wrong("""no-noise: moves every robot by exactly one cell
    One time in ten it stays.
    Keep .1 of each cell where it was.
    New cell 1 = .9 * .0556 + .1 * .4444.""")((0.0556, 0.4444, 0.4444, 0.0556))

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


def _bayes(part):
    def holds(f):
        return all(np.allclose(f(*_belief(s))[part], correct(*_belief(s))[part]) for s in range(4))

    return holds


def _untouched(f):
    bel, like = _belief(9)
    kept = bel.copy(), like.copy()
    f(bel, like)
    return np.array_equal(kept[0], bel) and np.array_equal(kept[1], like)


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
    joint = np.asarray(bel) * likelihood
    return joint / joint.sum(), joint.sum()


correct.holds("the new belief is likelihood times belief, divided by the sum", _bayes(0))
correct.holds("the evidence is that sum", _bayes(1))
correct.holds("the arguments are left as they were", _untouched)
correct.wrong("""in-place: changes the array it was given
    What does the caller's belief look like afterwards?
    bel *= likelihood writes into the argument.
    Make a new array: joint = bel * likelihood""")(
    lambda bel, like: (np.divide(np.multiply(bel, like, out=bel), bel.sum(), out=bel), 1.0),
    when=lambda f: not _untouched(f),
)
correct.wrong("""likelihood-only: normalises the likelihood and forgets the belief
    What did the robot know before the look?
    Multiply by the old belief first.
    joint = bel * likelihood""")(lambda bel, like: (like / like.sum(), like.sum()))
correct.wrong("""average: averages belief and likelihood instead of multiplying them
    A cell that the report rules out: what should its belief be?
    A likelihood of zero must give zero. Averages do not.
    joint = bel * likelihood""")(
    lambda bel, like: ((bel + like) / (bel + like).sum(), (bel + like).sum())
)
correct.wrong("""eta: returns the normaliser eta, one over the evidence
    Can a probability exceed one?
    The evidence is the sum itself.
    return joint / joint.sum(), joint.sum()""")(
    lambda bel, like: (correct(bel, like)[0], 1 / correct(bel, like)[1])
)

MOVES = {0: 0.1, 1: 0.7, 2: 0.2}


def _sum_rule(f):
    bel = _belief(3)[0]
    found = np.asarray(f(bel, MOVES))
    return np.allclose(found, predict_line(bel, MOVES))


@code(
    """Predict
    np.roll(bel, 1) moves all cells one on.
    Weigh each rolled belief with its probability and add them up.
    return sum(p * np.roll(bel, cells) for cells, p in moves.items())""",
    fingerprint=lambda f: f(_belief(5)[0], MOVES),
)
def predict_line(bel, moves):
    return sum(p * np.roll(bel, cells) for cells, p in moves.items())


predict_line.holds(
    "a sure move of one cell moves the belief one cell on",
    lambda f: np.allclose(f(np.eye(5)[1], {1: 1.0}), np.eye(5)[2]),
)
predict_line.holds(
    "the last cell's neighbour is the first",
    lambda f: np.allclose(f(np.eye(5)[4], {1: 1.0}), np.eye(5)[0]),
)
predict_line.holds("every cell is the sum over where the robot may have come from", _sum_rule)
predict_line.holds(
    "the belief still sums to one", lambda f: np.isclose(np.sum(f(_belief(4)[0], MOVES)), 1)
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

BREAK = Question("Experiments")


def _drive(rng, B, T, looks=1, real=(0.8, 0.1), assumed=(0.8, 0.1)):
    """B robots: last beliefs (B, CELLS) and cells (B,), and the true cell's belief (T, B)."""
    x, bel, true = rng.integers(CELLS, size=B), np.full((B, CELLS), 1 / CELLS), []
    for _ in range(T):
        x = (x + rng.choice(3, B, p=[0.1, 0.8, 0.1])) % CELLS
        z = rng.random(B) < np.where(DOORS[x], *real)
        p_door = np.where(DOORS, *assumed)
        like = np.where(z[:, None], p_door, 1 - p_door) ** looks
        bel, _ = pf.update_1d(pf.predict_1d(bel, KERNEL, ring=True), like)
        true.append(bel[np.arange(B), x])
    return bel, x, np.array(true)


@experiment(
    """Overconfidence of robots that count twice
    Square the likelihood before you correct.
    claim = bel.max(axis=1); right = bel.argmax(axis=1) == x.
    Call drive with B=200, T=25, looks=2 and return claim.mean() - right.mean().""",
    points=2,
    after=twice,
    runs=40,
    pool=240,
    claim="counting each look twice makes robots claim more than they know",
    test="mean of 40 runs (claim minus share right) between 0.05 and 0.3",
    margin="the mean of 40 has a standard error of about 0.005",
)
def twice_x(rng, looks=2):
    bel, x, _ = _drive(rng, 200, 25, looks)
    return bel.max(axis=1).mean() - np.mean(bel.argmax(axis=1) == x)


twice_x.holds("mean overconfidence between 0.05 and 0.3", lambda x: 0.05 < x.mean() < 0.3)
twice_x.holds("every value lies between -1 and 1", lambda x: (np.abs(x) <= 1).all())
twice_x.wrong("""once: counts each look once: such robots are honest
    Is the likelihood squared?
    Raise it to the power 2.
    drive(rng, B=200, T=25, looks=2)""")(
    lambda rng: twice_x(rng, 1), when=lambda x: abs(x.mean()) < 0.04
)
twice_x.wrong("""sign: subtracts the claim from the share that is right
    What sign has too much confidence?
    Claim minus share right.
    return claim.mean() - right.mean()""")(
    lambda rng: -twice_x(rng), when=lambda x: x.mean() < -0.05
)


def _ruled_out(rng, assumed=1e-12):
    """After which of one robot's 40 looks did its own cell have almost no belief?"""
    return _drive(rng, 1, 40, real=(0.8, 0.05), assumed=(0.8, assumed))[2][:, 0] < 1e-6


@experiment(
    """Robots that rule out their own cell
    One robot: drive with B=1, T=40, real=(0.8, 0.05), assumed=(0.8, 1e-12).
    after[k, 0, cells[k, 0]] is the belief in the true cell after look k.
    Return 1 if the smallest of them is below 1e-6.""",
    points=2,
    after=zero,
    runs=150,
    pool=600,
    claim="about three in four robots once give their own cell almost no belief",
    test="share in 150 runs between 0.56 and 0.92",
    margin="the share of 150 has a standard error of about 0.035",
)
def zero_x(rng, assumed=1e-12):
    return float(_ruled_out(rng, assumed).any())


zero_x.holds("only zeros and ones", lambda x: np.isin(x, (0, 1)).all())
zero_x.holds("share between 0.56 and 0.92", lambda x: 0.56 < x.mean() < 0.92)
zero_x.wrong("""honest: lets the filter assume the true false-alarm rate, so no robot is lost
    What does the filter assume about walls?
    The filter's false-alarm rate is 1e-12, the real one 0.05.
    assumed=(0.8, 1e-12)""")(lambda rng: zero_x(rng, 0.05), when=lambda x: (x == 0).all())
zero_x.wrong("""last-look: looks only at the last of the 40 steps
    The question is whether it ever happened.
    Look at the true cell after every step, not only the last.
    after[np.arange(40), 0, cells[:, 0]].min()""")(
    lambda rng: float(_ruled_out(rng)[-1]),
    when=lambda x: np.isin(x, (0, 1)).all() and 0 < x.mean() < 0.5,
)
zero_x.wrong("""share: returns a share of time, not whether it ever happened
    One robot, one answer: yes or no.
    Return 1 or 0.
    float((belief_in_true_cell < 1e-6).any())""")(
    lambda rng: _ruled_out(rng).mean(), when=lambda x: not np.isin(x, (0, 1)).all()
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
