r"""Lab questions that are checked at once and name the mistake.

A student writes ``from pfkit.labs import lab3 as lab`` and answers. This page is for the person
who writes questions. A question is a few declarations; nothing in it knows about notebooks.

**A module of questions** (``pfkit/labs/ch07.py``) builds one `Lab` and publishes its verbs::

    from pfkit.labs import Choice, Code, Lab, Misconception, Numeric, Property, Question

    LAB = Lab("ch07", "Resampling variance", [Question("1", "Survival", (item, ...))])
    check, use, predict, answer, summary, save, load = LAB.verbs()

**Every item** has ``id`` (the metadata ``answer: "<id>"`` of its answer cell, which holds a stub
with ``...``, and a Python name in the notebook), ``title``, ``points`` and ``hints``: three, from
a nudge to nearly the answer, shown one per check when no misconception is recognised.
A `Misconception` is a wrong idea with its own three hints, and an ``example``, a wrong answer that
must earn these hints and no others; `tests/labs/` runs them all.

N, numbers. A wrong value names its cause when it lies within ``tol`` of an example::

    Numeric(id="n1", title="Effective sample size of (.5, .25, .25)", key=2.667, tol=0.005,
            hints=("Square the weights first.", "Then sum.", "ESS = 1 / sum of w squared."),
            misconceptions=(Misconception("no-inverse", "is the sum of squares itself",
                ("ESS counts particles: it is at least 1.", "Invert.", "1/.375"), 0.375),))

C, code. Properties take the student's function and return True, or False, or a string that says
what was found. ``fingerprint`` turns a function into numbers: a student whose fingerprint equals
that of a misconception's example "behaves like" it, so most mutants need no predicate::

    Code(id="c1", title="Normalise weights", reference=lambda w: w / w.sum(),
         properties=(Property("they sum to one", lambda f: abs(f(np.ones(4)).sum() - 1) < 1e-9),),
         fingerprint=lambda f: f(np.array([1.0, 2.0, 5.0])),
         hints=(...), misconceptions=(Misconception("by-max", "divides by the largest weight",
                                                    (...), lambda w: w / w.max()),))

M, choice. One sentence of feedback for each option, the right one included::

    Choice(id="m1", title="What is a particle?", key="b",
           options={"a": "A measurement", "b": "A hypothesis with a weight"},
           feedback={"a": "Measurements score particles.", "b": "Yes: one guess at the state."})

P, prediction. Locked when given, ``"a"`` or ``("a", 70)``; it earns its points by being made::

    Prediction(id="p1", title="What happens to the ESS?", key="a", options={...})

X, experiment. The student's function runs the experiment; ``measure(f, rng, runs)`` calls it and
returns an array whose first axis is the runs; properties decide on that array. Declare claim,
test, runs, false-fail probability (at most 1e-3, better 1e-4) and margin; `pfkit.labs.replay`
verifies them. ``after`` names the prediction that must be locked first::

    Experiment(id="x1", title="Bias of the roulette wheel", after="p1", runs=200,
               claim="the wheel is unbiased", test="|mean| < 4 standard errors",
               measure=lambda f, rng, runs: [f(rng) for _ in range(runs)],
               properties=(Property("mean within 4 SE of 0", lambda x: z_score(x) < 4),),
               reference=reference, false_fail=1e-4, margin="4 SE, normal: 6e-5")

R, text. At most three sentences, kept for marking by hand; give a rubric and a model answer::

    Text(id="r1", title="Why is the ESS blind?", rubric=("names the loss of ancestors",),
         model="Equal weights give ESS = M even if all particles are copies of one.")

In the notebook an item is three cells: the question (markdown), the answer cell, the check cell
``lab.check("c1", c1)``; code adds ``c1 = lab.use("c1", c1)`` where later cells need it.
A check prints, message first::

    c1: partial 1/2
      [ok] they sum to one
      [no] it does not change its input
    Your answer divides by the largest weight. Hint 1 of 3: ...

Modules: `items` (declarations), `lab` (verbs), `guard` (survives student code), `verdict`,
`progress` (JSON), `summary`, `calibration` (SVG), `controls` (ipywidgets), `replay` (false-fail
rates), `mutants` (classic wrong implementations). All are NumPy and standard library only.
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
)
from pfkit.labs.lab import Lab, LabError, Question
from pfkit.labs.replay import replay

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
    "replay",
]
