"""A notebook's cells in the page: what runs, in which order, and what is told."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest

import pfkit
from pfkit.explore import wasm
from pfkit.labs.cells import Cells
from pfkit.labs.names import bound_and_used
from pfkit.labs.stand_in import STAND_INS


@pytest.fixture
def cells(monkeypatch):
    """Cells without matplotlib, as in the page, whatever other tests have imported."""
    kept = dict(sys.modules)
    edge = ("matplotlib", "IPython", "ipywidgets", "pfkit.plotting", "pfkit.widgets")
    for name in [n for n in kept if n in edge or n.split(".")[0] in edge]:
        monkeypatch.delitem(sys.modules, name)
    for name in ("plotting", "widgets"):
        monkeypatch.delattr(pfkit, name, raising=False)
    yield Cells()
    for name in set(STAND_INS) - set(kept):
        sys.modules.pop(name, None)


def table(*sources, **answers):
    out = [
        {"index": i, "kind": "code", "item": f"c{i}", "source": s} for i, s in enumerate(sources)
    ]
    for position, item in answers.items():
        out[int(position[1:])].update(kind="answer", item=item)
    return json.dumps(out)


def run(cells, text, index):
    return json.loads(cells.run(text, index))


def test_names_that_a_cell_binds_and_needs():
    bound, used = bound_and_used(
        "import numpy as np\ndef f(x):\n    return np.sum(x) + k\ny = f(a)"
    )
    assert {"np", "f", "y"} <= bound and {"k", "a", "f", "np"} <= used and "print" not in used


def test_what_is_local_to_a_function_is_needed_from_nowhere():
    source = "def f(rng):\n    log = g(rng)\n    return [t + k for t in log]"
    assert bound_and_used(source) == ({"f"}, {"g", "k"})
    assert bound_and_used("def f(a):\n    a += 1\nb += 1") == ({"f", "b"}, {"b"})
    assert bound_and_used("class A(B):\n    n = 3\n    def m(self): return C")[1] == {"B", "C"}


def test_figures_can_be_unpacked_as_the_library_gives_them(cells):
    text = table(
        "from pfkit import plotting", "fig, (a, b, c) = plotting.panels(3, height=2)", "a is b"
    )
    assert not run(cells, text, 2)["error"]


def test_only_what_is_needed_runs(cells):
    text = table("a = 2", "raise SystemExit", "b = a + 1", "print(b)\nb * 10")
    report = run(cells, text, 3)
    assert report["before"] == [0, 2] and report["text"] == "3\n30" and not report["error"]
    assert run(cells, text, 3)["before"] == []


def test_a_changed_answer_runs_again_with_what_follows(cells):
    assert run(cells, table("a = 2", "b = a + 1", "b"), 2)["text"] == "3"
    report = run(cells, table("a = 5", "b = a + 1", "b"), 2)
    assert report["text"] == "6" and report["before"] == [0, 1]


def test_an_error_names_its_line(cells):
    report = run(cells, table("x = 1\ny = x / 0"), 0)
    assert report["error"] == "ZeroDivisionError: division by zero (line 2 of the cell)"
    assert "line 1" in run(cells, table("def f(:"), 0)["error"]
    assert "SystemExit" in run(cells, table("raise SystemExit"), 0)["error"]


RIGHT = "def circular_mean(theta, w):\n    return np.arctan2(w @ np.sin(theta), w @ np.cos(theta))"
STUB = 'def circular_mean(theta, w):\n    """Mean direction."""\n    ...'
# What a reader may make of an answer that has passed, and what Check then says. None passes.
BROKEN = {
    "colon deleted": (RIGHT.replace("):", ")"), "line 1: expected ':'"),
    "retrun": (RIGHT.replace("return", "retrun"), "SyntaxError in line 2"),
    "bracket left open": (RIGHT[:-1], "was never closed"),
    "indentation broken": (RIGHT.replace("    return", "return"), "IndentationError in line 2"),
    "cut in a word": (RIGHT[: RIGHT.index("sin")] + "))", "SyntaxError"),
    "empty": ("", "binds no circular_mean"),
    "only a comment left": ("# def circular_mean(theta, w):", "binds no circular_mean"),
    "renamed": (RIGHT.replace("circular_mean", "circular_meen"), "binds no circular_mean"),
    "deleted at the end": (RIGHT + "\ndel circular_mean", "binds no circular_mean"),
    "pass": ("def circular_mean(theta, w):\n    pass", "unanswered"),
    "dots": (STUB, "unanswered"),
    "None": ("circular_mean = None", "unanswered"),
    "a number": ("circular_mean = 3", "a function"),
    "raises before": ("nothing_here\n" + RIGHT, "NameError"),
    "raises after": (RIGHT + "\n1 / 0", "ZeroDivisionError: division by zero (line 3"),
    "null character": (RIGHT + "\0", "null"),
    "brackets without end": ("(" * 5000, "SyntaxError"),
    "helper deleted": (
        "def circular_mean(theta, w):\n    return helper(theta, w)", "name 'helper' is not defined"
    ),
}  # fmt: skip


def small_lab(answer, other="p1a = ..."):
    """Imports, another question, a question with its check, a use and a print."""
    sources = [
        ("code", "c0", "import numpy as np\nfrom pfkit.labs import lab3 as lab"),
        ("answer", "p1a", other),
        ("answer", "p5b", answer),
        ("check", "p5b", 'lab.check("p5b", circular_mean)'),
        ("code", "c4", 'circular_mean = lab.use("p5b", circular_mean)'),
        ("code", "c5", "print(circular_mean(np.array([3.1, -3.1]), np.array([0.5, 0.5])))"),
    ]
    stubs = {"p1a": "p1a = ...", "p5b": STUB}
    cells = [
        {"index": i, "kind": kind, "item": item, "source": source}
        for i, (kind, item, source) in enumerate(sources)
    ]
    for cell in cells:
        if cell["kind"] == "answer":
            cell["stub"] = stubs[cell["item"]]
    return json.dumps(cells)


@pytest.fixture
def passed(cells):
    """Cells whose answer has passed, with a helper."""
    helped = RIGHT.replace("circular_mean", "helper") + "\ncircular_mean = helper"
    report = run(cells, small_lab(helped), 3)
    assert (report["status"], report["headline"]) == ("passed", "p5b: passed 3/3"), report
    yield cells
    sys.modules["pfkit.labs.lab3"].LAB.forget()


@pytest.mark.parametrize("how", BROKEN)
def test_a_broken_answer_does_not_pass_because_it_passed_before(passed, how):
    source, told = BROKEN[how]
    report = run(passed, small_lab(source), 3)
    assert report["status"] in ("", "unanswered", "wrong"), report
    assert told in report["error"] + report["text"], report
    assert run(passed, small_lab(RIGHT), 3)["status"] == "passed"


@pytest.mark.parametrize("how", BROKEN)
def test_what_follows_a_broken_answer_uses_the_reference(passed, how):
    assert run(passed, small_lab(RIGHT), 5)["text"].startswith("p5b") is False
    report = run(passed, small_lab(BROKEN[how][0]), 5)
    assert not report["error"] and abs(abs(float(report["text"])) - np.pi) < 1e-9, report


def test_another_cell_does_not_answer_for_an_empty_one(passed):
    assert run(passed, small_lab(RIGHT), 3)["status"] == "passed"
    elsewhere = "p1a = 'c'\n" + RIGHT
    assert "binds no circular_mean" in run(passed, small_lab("", elsewhere), 3)["error"]
    spoilt = "p1a = 'c'\ncircular_mean = None"
    assert run(passed, small_lab(RIGHT, spoilt), 3)["status"] == "passed"  # the cell is right


def test_the_caret_stands_below_the_column(cells):
    error = run(cells, table("x = 1\ndef f(x)\n    return x"), 0)["error"]
    assert error == "SyntaxError in line 2: expected ':'\n  def f(x)\n          ^"
    long = run(cells, table("x = [" + "1, " * 200 + "2 3]"), 0)["error"].splitlines()
    assert max(map(len, long[1:])) < 80 and long[2].strip() == "^"


@pytest.mark.parametrize(
    ("source", "told", "line"),
    [
        ("x = 1\nawait x", "'await' outside function", "await x"),
        ("x = 1\nreturn x", "'return' outside function", "return x"),
        ("x = 1\nbreak", "'break' outside loop", "break"),
        ("x = 1\n%timeit x", "are commands of Jupyter", "%timeit x"),
        ("x = 1\n!ls", "are commands of Jupyter", "!ls"),
    ],
)
def test_what_only_the_compiler_refuses_has_its_line_as_well(cells, source, told, line):
    error = run(cells, table(source), 0)["error"]
    assert "SyntaxError in line 2" in error and told in error
    assert error.splitlines()[1] == f"  {line}" and error.splitlines()[2].strip() == "^"


def test_no_name_outlives_its_code(cells):
    assert run(cells, table("a = 2\nb = 3", "print(a)"), 1)["text"] == "2\n"
    assert "'b' is not defined" in run(cells, table("a = 2", "print(a + b)"), 1)["error"]
    assert run(cells, table("a = 2", "print(a)"), 1)["text"] == "2\n"


def test_an_import_in_an_answer_may_go_again(cells):
    text = json.loads(table("import math", "import math\ny = math.pi", "round(y)"))
    assert run(cells, json.dumps(text), 2)["text"] == "3"
    text[1]["source"] = "y = math.tau"
    assert run(cells, json.dumps(text), 2)["text"] == "6"


def answer_says(cells, source):
    text = json.loads(table(source))
    text[0].update(kind="answer", stub="x = ...")
    report = run(cells, json.dumps(text), 0)
    return " ".join([report["text"], report["error"], report["note"]])


def test_sentences_instead_of_stack_traces(cells):
    assert "nobody to ask" in answer_says(cells, "x = input('How many? ')")
    assert "nobody to ask" in answer_says(cells, "import sys\nx = sys.stdin.read()")
    assert "pandas is not in this page" in answer_says(cells, "import pandas as pd")
    assert "multiprocessing is not" in answer_says(
        cells, "raise ModuleNotFoundError(name='_multiprocessing')"
    )
    assert "asked Python to end" in answer_says(cells, "exit()")
    assert "asked Python to end" in answer_says(cells, "raise SystemExit")
    assert "scipy is not in this page" in answer_says(cells, "from scipy.stats import norm")
    assert "without end" in answer_says(cells, "def f(): return f()\nx = f()")
    assert "more memory than there is" in answer_says(cells, "x = np = bytearray(1 << 62)")
    assert sys.stdin is not None and answer_says(cells, "x = 3").strip() == ""


def test_a_figure_in_an_answer_says_where_it_is_drawn(cells):
    for source in (
        "import matplotlib.pyplot as plt\nplt.plot([1, 2])",
        "import matplotlib.pyplot as plt\nfig, ax = plt.subplots()\nax",
        "from matplotlib.ticker import MaxNLocator",
        "import matplotlib.pyplot as plt\nn, bins, bars = plt.hist([1, 2])",
    ):
        assert "run the cell in Jupyter to see them" in answer_says(cells, source), source
    quiet = table("import matplotlib.pyplot as plt\nplt.plot([1])", "plt")
    assert not run(cells, quiet, 0)["note"]  # the course's own cells have their figures above


@pytest.mark.parametrize(
    "value",
    ["object()", "lambda: 0", "{1: {2}}", "iter([])", "b'\\xff'", "'\\ud800'", "float('nan')",
     "type('Odd', (), {'status': 7, 'headline': print})()", "np", "...", "NotImplemented",
     "type('Mute', (), {'__repr__': lambda self: 7})()", "range(10**9)", "1j", "Exception('x')",
     "type('Loud', (), {'__getattr__': lambda self, n: 1 / 0})()"],
)  # fmt: skip
def test_values_of_any_kind_are_told(cells, value):
    report = run(cells, table("import numpy as np", f"print(np.pi)\n{value}"), 1)
    assert report["text"].startswith("3.14") and report["status"] == ""


def test_another_answer_that_fails_counts_as_unanswered(cells):
    text = json.loads(table("p = 1 / 0", "p = p if p is not ... else 'reference'", "p"))
    text[0].update(kind="answer", item="q1", stub="p = ...")
    report = run(cells, json.dumps(text), 2)
    assert report["text"] == "'reference'" and not report["error"]


def test_a_flood_of_output_is_not_kept(cells):
    report = run(cells, table("for k in range(200_000): print('x' * 50)\n'the end'"), 0)
    assert len(report["text"]) < 21_000 and "more characters" in report["text"]


def test_output_is_cut(cells):
    report = run(cells, table("print('x' * 100_000)"), 0)
    assert len(report["text"]) < 21_000 and "more characters" in report["text"]


def test_figures_do_nothing_and_their_numbers_come_out(cells):
    source = (
        "import matplotlib.pyplot as plt\n"
        "fig, (a, b) = plt.subplots(1, 2)\na.plot([1]); b.set(title='x')\n"
        "with plt.rc_context(): pass\nplt.show()\n7"
    )
    hidden = {k: sys.modules.pop(k) for k in list(sys.modules) if k.startswith("matplotlib")}
    try:
        report = run(Cells(), table(source), 0)
    finally:
        sys.modules.update(hidden)
    assert report["text"] == "7" and not report["error"]


def test_a_lab_is_checked_with_its_hint_and_keeps_a_prediction(cells):
    text = json.loads(
        table(
            "import numpy as np\nfrom pfkit.labs import lab3 as lab",
            "def circular_mean(theta, w):\n    return np.sum(theta * w) / np.sum(w)",
            'lab.check("p5b", circular_mean)',
            'p4a = ("a", 70)',
            'lab.predict("p4a", p4a)',
        )
    )
    for k, kind in enumerate(("code", "answer", "check", "answer", "check")):
        text[k].update(kind=kind, item=("", "p5b", "p5b", "p4a", "p4a")[k])
    report = run(cells, json.dumps(text), 2)
    assert report["status"] == "wrong" and "Hint 1 of 3" in report["text"]
    assert run(cells, json.dumps(text), 4)["status"] == "predicted"
    kept = json.loads(cells.progress("lab3"))
    assert kept["predictions"]["p4a"]["choice"] == "a" and kept["schema"] == 1
    lab = sys.modules["pfkit.labs.lab3"].LAB
    lab.forget()
    cells.restore("lab3", json.dumps(kept))
    assert lab.predictions["p4a"]["choice"] == "a"
    lab.forget()


def test_int64_indices_are_left_alone_where_numpy_takes_them():
    before = np.bincount, np.repeat, np.take
    wasm.accept_int64()
    assert (np.bincount, np.repeat, np.take) == before  # this machine has 64 bits
    assert wasm._narrow(np.array([1, 2], np.int64)).dtype == np.intp
    assert wasm._narrow([1.5]).dtype == float


# -- what the page asks besides ----------------------------------------------------------------


def test_a_students_own_questions_are_those_that_differ(cells):
    from pfkit.labs.lab3 import LAB

    try:
        asked = json.loads(cells.student("lab3", "jo17", "spring"))
        assert asked["p1b"] == LAB.items["p1b"].asked() != LAB.items["p1b"].origin.asked()
        assert "p1a" not in asked, "options keep their order and their letters"
        assert json.loads(cells.student("lab3", "", "")) == {}
    finally:
        LAB.forget()


def test_worked_answers_and_reviews_are_the_labs(cells):
    from pfkit.labs import spaced_review
    from pfkit.labs.lab3 import LAB

    assert cells.solution("lab3", "p5b") == LAB.items["p5b"].worked()
    mine = spaced_review.problem(LAB, "p1b", 2)
    assert cells.review("lab3", "p1b", 2) == mine.asked()
    typed = ", ".join(map(str, mine.key))
    assert json.loads(cells.reviewed("lab3", "p1b", 2, typed)) == [True, "right"]
    assert json.loads(cells.reviewed("lab3", "p1b", 2, "what?"))[0] is False
