"""Lab questions that are checked at once and name the mistake.

A student writes ``from pfkit.labs import lab3 as lab`` and answers. This page is for the person
who writes questions. A question is a few declarations; nothing in it knows about notebooks.

**A module of questions** (``pfkit/labs/resampling.py``) binds questions and items, in the order in
which they are asked, and publishes the verbs of its `Lab`::

    from pfkit.labs import Choice, Lab, Numeric, Question, code

    HAND = Question("By hand")

    ess = Numeric(...)

    LAB = Lab.of(__name__, "Resampling variance")
    __getattr__ = LAB.verb

A long one is a folder, and ``Lab.of(__name__, title, *modules)`` collects the questions of its
modules. There is no list to add it to: `catalogue` finds each module that publishes a `LAB`.

**Every item** starts with a text. Its first line is the title; below it stand three hints, from a
nudge to nearly the answer, shown one per check when no misconception is recognised. An indented
line continues the one above. The name that an item is bound to is its id: the metadata
``answer: "<id>"`` of its answer cell, which holds a stub with ``...``.

**A wrong answer** stands under its hint. `item.wrong` takes what the answer does, to follow "Your
answer", and three hints; the wrong answer follows, as a call or a decorated function. A name in
front, ``sum-of-squares:``, names the misconception, else the wrong function's name is taken.
`tests/labs/` runs them all: each must earn its own hint and no other. `item.refuses` is for answers
that must not pass although no hint is theirs.

N, numbers. A wrong value names its cause when it lies within ``tol`` of an example::

    ess = Numeric('''Effective sample size of (.5, .25, .25)
        Square the weights first.
        Then sum.
        ESS = 1 / sum of w squared.''', 2.667, tol=0.005)

    ess.wrong('''sum-of-squares: is the sum of squares itself
        ESS counts particles: it is at least 1.
        Invert.
        1 / .375''')(0.375)

C, code. The reference is decorated with the item. Properties take the student's function and return
True, or False, or a string that says what was found. ``fingerprint`` turns a function into numbers:
a student whose fingerprint equals that of a wrong answer "behaves like" it, so most need no
predicate; where that does not do, give one, ``wrong(..., when=lambda f: ...)``::

    @code('''Normalise weights
        What must they sum to?
        Divide by something.
        w / w.sum()''', fingerprint=lambda f: f(np.array([1.0, 2.0, 5.0])))
    def normalise(w):
        return w / w.sum()

    normalise.holds("they sum to one", lambda f: abs(f(np.ones(4)).sum() - 1) < 1e-9)

    @normalise.wrong('''divides by the largest weight
        ...three hints...''')
    def by_max(w):
        return w / w.max()

M, choice: options instead of hints, the right one with a star, each with one sentence of feedback.
P, prediction: options without feedback. Locked when given, ``"a"`` or ``("a", 70)``; it earns its
points by being made::

    what = Choice('''What is a particle?
        a  A measurement
           = Measurements score particles.
        b* A hypothesis with a weight
           = Yes: one guess at the state.''')

    sign = Prediction('''What happens to the ESS?
        a* it falls
        b  it stays''')

X, experiment. The student's function runs the experiment, ``f(rng)`` once per run unless
``measure(f, rng, runs)`` says otherwise; properties decide on the array of outcomes, whose first
axis is the runs. Declare claim, test, runs, false-fail probability (at most 1e-3, by default 1e-4)
and margin; `pfkit.labs.replay` verifies them on a ``pool`` of runs. ``after`` is the prediction
that must be locked first::

    @experiment('''Bias of the resampling wheel
        ...three hints...''', after=sign, runs=200, claim="the wheel is unbiased",
        test="|mean| < 4 standard errors", margin="4 SE, normal: 6e-5")
    def bias_x(rng):
        return ...

    bias_x.holds("mean within 4 SE of 0", lambda x: abs(z_of_mean(x, 0)) < 4)

R, text. At most three sentences, kept for marking by hand; the lines are the rubric::

    why = Text('''Why is the ESS blind?
        names the loss of ancestors''',
        model="Equal weights give ESS = M even if all particles are copies of one.")

In the notebook an item is three cells: the question (markdown), the answer cell, the check cell
``lab.check("normalise", normalise)``; code adds ``normalise = lab.use("normalise", normalise)``
where later cells need it. Options are not typed again: write ``<!--options of sign-->`` where they
belong, and ``python tools/run.py options --fill`` writes the list.
A check prints, message first::

    normalise: partial 1/2
      [ok] they sum to one
      [no] it does not change its input
    Your answer divides by the largest weight. Hint 1 of 3: ...

Modules: `items` (declarations), `lab` (verbs), `guard` (survives student code), `verdict`,
`progress` (JSON), `summary`, `calibration` (SVG), `controls` (ipywidgets), `replay` (false-fail
rates), `spaced_review` (problems that come back),
`catalogue` (which labs there are). All are NumPy and standard library only.
"""

from pfkit.labs.items import (
    Choice,
    Code,
    Experiment,
    Item,
    Misconception,
    Numeric,
    Prediction,
    Property,
    Text,
    code,
    experiment,
)
from pfkit.labs.lab import Lab, LabError, Question
from pfkit.labs.replay import replay
from pfkit.labs.spaced_review import review

__all__ = [
    "Choice",
    "Code",
    "Experiment",
    "Item",
    "Lab",
    "LabError",
    "Misconception",
    "Numeric",
    "Prediction",
    "Property",
    "Question",
    "Text",
    "code",
    "experiment",
    "replay",
    "review",
]
