"""A notebook's cells in the page: what runs, in which order, and what is told."""

from __future__ import annotations

import json
import sys

import numpy as np
import pytest

import pfkit
from pfkit.explore import wasm
from pfkit.explore.cells import Cells, bound_and_used


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
    for name in set(sys.modules) - set(kept):
        del sys.modules[name]  # the stand-ins for matplotlib


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
    assert report["error"] == "ZeroDivisionError: division by zero (line 2)"
    assert "line 1" in run(cells, table("def f(:"), 0)["error"]
    assert "SystemExit" in run(cells, table("raise SystemExit"), 0)["error"]


def test_the_check_of_a_broken_answer_tells_the_answers_error(cells):
    text = json.loads(table("p = 1 / 0", "print(p)"))
    text[0].update(kind="answer", item="q1")
    text[1].update(kind="check", item="q1")
    assert "ZeroDivisionError" in run(cells, json.dumps(text), 1)["error"]


def test_another_answer_that_fails_counts_as_unanswered(cells):
    text = json.loads(table("p = 1 / 0", "p = p if p is not ... else 'reference'", "p"))
    text[0].update(kind="answer", item="q1")
    report = run(cells, json.dumps(text), 2)
    assert report["text"] == "'reference'" and not report["error"]


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
