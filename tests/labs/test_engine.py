"""The engine survives every answer, says one thing at a time, and loses nothing."""

import json
import os
import random
import shutil
import signal
import sys
import time
import types
import warnings
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from pfkit.labs import (
    Choice,
    Code,
    Experiment,
    Lab,
    LabError,
    Numeric,
    Prediction,
    Question,
    Text,
    catalogue,
    controls,
    progress,
    replay,
    resampling,
)
from pfkit.labs.items import Judgement, is_unanswered
from pfkit.labs.items.base import written_lines
from pfkit.labs.verdict import Line

ASKED = """
    first
    second
    third"""


def normalise(w):
    return w / w.sum()


def by_max(w):
    return w / w.max()


def make_lab() -> Lab:
    n = Numeric("ESS" + ASKED, 2.667, tol=0.005, id="n")
    n.wrong("""inverse: forgets to invert
        i1
        i2
        i3""")(0.375)
    c = Code(
        "normalise" + ASKED, id="c", points=2.0, fingerprint=lambda f: f(np.array([1.0, 2.0, 5.0]))
    ).of(normalise)
    c.holds("sums to one", lambda f: abs(f(np.ones(4)).sum() - 1) < 1e-9)
    c.holds("keeps the shape", lambda f: f(np.ones(4)).shape == (4,))
    c.wrong("""divides by the largest
        m1
        m2
        m3""")(by_max)
    m = Choice(
        """particle
        a  a measurement
           = Measurements score particles.
        b* a hypothesis
           = Yes.""",
        id="m",
    )
    p = Prediction(
        """sign
        a* zero
        b  one""",
        id="p",
    )
    x = Experiment(
        "mean" + ASKED, id="x", after=p, runs=100, claim="mean is zero", test="|mean| < 5 SE",
        margin="5 SE",
    ).of(lambda rng: rng.normal())  # fmt: skip
    x.holds("near 0", lambda found: abs(found.mean()) < 5 / np.sqrt(len(found)))
    x.wrong("""biased: is biased
        b1
        b2
        b3""")(lambda rng: rng.normal() + 2, when=lambda found: found.mean() > 1)
    r = Text(
        """why
        names copies""",
        model="Because all are copies.",
        id="r",
    )
    return Lab("demo", "Demo", [Question("One", "1", [n, c, m, p, x, r])])


@pytest.fixture
def lab():
    return make_lab()


def endless(w):
    return endless(w)


def loud(w):
    print("x" * 1_000_000)
    return w / w.sum()


def leaves(w):
    sys.exit(3)


def interrupts(w):
    raise KeyboardInterrupt


class Nasty:
    def __eq__(self, other):
        raise RuntimeError("no comparing")

    __hash__ = None

    def __repr__(self):
        raise RuntimeError("no printing")

    def __array__(self, *_, **__):
        raise RuntimeError("no array")

    def __getattr__(self, name):
        raise RuntimeError("no attributes")


class BadMessage(Exception):
    def __str__(self):
        raise RuntimeError("no words")


def unprintable_error(w):
    raise BadMessage


ODD = [
    None, ..., 0, "", "text", b"bytes", float("nan"), float("inf"), 1j, [], {}, (), object(), int,
    (x for x in range(3)), np.array([1, "a", None], dtype=object), np.zeros((0, 3)), np.ma.masked,
    lambda: 1, lambda w: "text", lambda w: None, lambda w: (i for i in w), lambda w: w * np.nan,
    lambda w: np.array([object()] * 4), lambda w: 1 / 0, endless, loud, leaves, interrupts,
    unprintable_error, Nasty(), lambda w: Nasty(), "a" * 1_000_000, [[1], [2, 3]], 10**400,
    ("a", "b", 3),
    ("a", "often"), ("a", 400), ["a", 50], True,
]  # fmt: skip


@pytest.mark.parametrize("item", ["n", "c", "m", "p", "x", "r", "nowhere", 3, None])
def test_check_never_raises(lab, item, capsys):
    for odd in ODD:
        verdict = lab.check(item, odd)
        assert isinstance(str(verdict), str) and isinstance(verdict._repr_html_(), str)
        assert len(str(verdict)) < 3_000
        lab.use(item, odd)
    assert len(capsys.readouterr().out) < 20_000
    json.dumps(lab.report())


@pytest.mark.parametrize("idle", [0.0, 0.01])
def test_a_loop_without_end_is_stopped(lab, monkeypatch, idle):
    if not hasattr(__import__("signal"), "setitimer"):
        pytest.skip("this platform has no alarm clock")
    monkeypatch.setattr("pfkit.labs.lab.guarded.__defaults__", (0.2,))

    def hangs(w):
        while True:
            try:
                time.sleep(idle)
            except Exception:
                pass

    verdict = lab.check("c", hangs)
    assert verdict.status == "wrong" and "stopped, it took longer than 10 s" in str(verdict)


def test_message_first_then_properties_then_one_hint(lab):
    text = str(lab.check("c", by_max)).splitlines()
    assert text[0] == "c: partial 1/2"
    assert text[1].strip() == "[no] sums to one" and text[2].strip() == "[ok] keeps the shape"
    assert text[3] == "Your answer divides by the largest. Hint 1 of 3: m1" and len(text) == 4


def test_the_ladder_has_three_rungs_per_misconception(lab):
    rungs = [lab.check("c", by_max).hint[-2:] for _ in range(5)]
    assert rungs == ["m1", "m2", "m3", "m3", "m3"]
    hint = lab.check("c", lambda w: w).hint
    assert hint.startswith("I do not recognise this mistake. For w = ")
    assert hint.endswith(" Hint 1 of 3: first")


def test_right_answers_pass_and_score(lab):
    lab.predict("p", ("a", 80))
    right = {i: item.solution() for i, item in lab.items.items()}
    right["r"] = "The weights are equal, yet every particle is a copy of one."
    statuses = [lab.check(i, a).status for i, a in right.items()]
    assert statuses == ["passed"] * 3 + ["predicted", "passed", "recorded"]
    assert "5 of 7" not in repr(lab.summary()) and "6 of 7" in repr(lab.summary())
    assert "1 waiting for marking by hand" in repr(lab.summary())


def test_a_function_that_writes_into_its_argument_is_told(lab):
    def in_place(w):
        w /= w.sum()
        return w

    verdict = lab.check("c", in_place)
    assert verdict.status == "partial" and "x = x + 1, not x += 1" in verdict.hint
    assert "[no] leaves its arguments as they were" in str(verdict)


def test_lists_and_tuples_of_numbers_are_arrays(lab):
    assert lab.check("c", lambda w: [x / w.sum() for x in w]).status == "passed"
    assert lab.check("c", lambda w: tuple(w / w.sum())).status == "passed"


FORMS = [
    (np.array([[2.667]]), "passed", ""),
    ([2.667], "passed", ""),
    (Fraction(8, 3), "passed", ""),
    ("2.667", "passed", ""),
    ("many", "wrong", "Write plain numbers."),
    ((2.667, 1), "wrong", "Separate several"),
    (2.7, "wrong", "rounded too far"),
    (np.nan, "wrong", "Hint 1 of 3: first"),
]


@pytest.mark.parametrize(("given", "status", "told"), FORMS, ids=str)
def test_a_right_number_in_another_form(lab, given, status, told):
    verdict = lab.check("n", given)
    assert verdict.status == status and told in verdict.hint


def test_shares_and_order_are_told_apart_from_wrong_numbers():
    item = Numeric("shares" + ASKED, (0.75, 0.316), tol=0.002, id="s")
    lab = Lab("l", "L", [Question("One", "1", [item])])
    assert "per cent" in lab.check("s", (75, 31.6)).hint
    assert "another order" in lab.check("s", (0.316, 0.75)).hint
    hint = lab.check("s", (0.1, 0.2)).hint
    assert hint == "I do not recognise this mistake. Hint 1 of 3: first", "no hint was spent"


def test_letters_may_come_with_their_text(lab):
    for given in ("b", " B ", "(b)", "b)", "b) a hypothesis"):
        assert lab.check("m", given).status == "passed"
    assert "quotation marks" in lab.check("m", "a hypothesis").hint


def test_a_share_is_not_locked_as_a_per_cent(lab):
    assert "not .7" in str(lab.predict("p", ("a", 0.8))) and not lab.predictions
    assert lab.predict("p", ("a", "80 %")).status == "predicted"
    assert lab.predictions["p"]["sure"] == 80


@pytest.mark.parametrize("given", ["a", ("a",), ("a", None), ("a", ...), ["a", None]])
def test_a_prediction_without_a_confidence_is_not_locked(lab, given):
    told = lab.predict("p", given)
    assert told.status == "wrong" and "70" in str(told) and not lab.predictions
    assert lab.check("x", lambda rng: rng.normal()).status == "locked"


def test_a_bare_letter_of_an_old_file_still_loads_and_is_graded(lab, tmp_path):
    old = {"choice": "b", "sure": None, "version": lab.items["p"].version}
    file = tmp_path / "old.json"
    file.write_text(json.dumps({"schema": 1, "lab": "demo", "predictions": {"p": old}}))
    lab.load(file)
    assert lab.predictions["p"] == old and "locked" in str(lab.predict("p", "b"))
    graded = make_lab()
    graded.asks_how_sure = False
    assert graded.predict("p", "a").status == "predicted"


def test_a_passed_experiment_tells_how_it_was_tested(lab):
    lab.predict("p", ("a", 50))
    told = lab.check("x", lambda rng: rng.normal()).hint
    assert "100 runs, seed 2024: |mean| < 5 SE" in told and "below 0.0001 (5 SE)" in told


def test_the_world_is_as_before(lab, tmp_path):
    def meddles(w):
        os.chdir(tmp_path)
        np.random.seed(0)  # noqa: NPY002
        random.seed(0)
        warnings.simplefilter("error")
        np.seterr(all="raise")
        sys.stdout = None
        sys.setrecursionlimit(5_000)
        return w / w.sum()

    def world():
        state = np.random.get_state()[1].tobytes()  # noqa: NPY002
        return (os.getcwd(), state, random.getstate(), warnings.filters[:], np.geterr(),
                sys.stdout, sys.getrecursionlimit())  # fmt: skip

    before = world()
    assert lab.check("c", meddles).status == "passed"
    assert world() == before


def test_a_person_can_interrupt(lab):
    if sys.platform == "win32":
        pytest.skip("signals differ")
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            lab.check("c", lambda w: (os.kill(os.getpid(), signal.SIGINT), time.sleep(5)))
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)


def test_an_answer_that_cannot_be_judged_costs_no_hint(lab):
    assert "Mend this first" in lab.check("c", interrupts).hint
    hint = lab.check("c", lambda w: w).hint
    assert hint.startswith("I do not recognise this mistake. For w = ")
    assert hint.endswith(" Hint 1 of 3: first")


STUBS = [
    "def f(w, rng):\n    ...",
    "def f(w):\n    'Doc.'\n    ...",
    "def f():\n    return ...",
    "def f(a, b=2):\n    pass",
    "f = ...",
]


@pytest.mark.parametrize("stub", STUBS)
def test_stubs_count_as_unanswered(lab, stub):
    space = {}
    exec(stub, space)
    assert is_unanswered(space["f"])
    assert lab.check("c", space["f"]).status == "unanswered"
    assert lab.use("c", space["f"]) is normalise


def test_a_function_that_does_something_is_answered():
    assert not is_unanswered(lambda: 1) and not is_unanswered(lambda w: w)


def test_predictions_are_locked_and_come_first(lab):
    coin = lab.items["x"].solution()
    assert lab.check("x", coin).status == "locked"
    assert lab.predict("p", ("b", 70)).status == "predicted"
    assert "it stays (b)" in str(lab.predict("p", "a"))
    assert lab.predictions["p"]["choice"] == "b"
    assert lab.guesses() == []  # not told before the experiment
    assert lab.check("x", coin).status == "passed"
    assert lab.guesses() == [("p", 70.0, False)]
    assert "0 of 1 right" in repr(lab.summary()) and "<svg" in lab.summary()._repr_html_()


def test_strict_switch(lab, monkeypatch):
    monkeypatch.setenv("PFKIT_LABS_STRICT", "1")
    assert lab.check("n", 2.667).status == "passed"
    for item, answer in [("n", 1.0), ("n", ...), ("nowhere", 1), ("x", lambda rng: 0.0)]:
        with pytest.raises(LabError):
            lab.check(item, answer)


def test_status_is_announced_and_text_is_escaped(lab):
    html = lab.check("m", "<script>alert(1)</script>")._repr_html_()
    assert 'role="status"' in html and "<script>" not in html and "style=" not in html


def test_progress_round_trip(lab, tmp_path):
    file = tmp_path / "a.json"
    assert "nothing" in lab.save(file) and not file.exists()
    lab.predict("p", ("b", 70)), lab.check("n", 2.667), lab.check("c", normalise)
    assert lab.save(file).startswith("Saved 3")
    data = json.loads(file.read_text())
    assert data["schema"] == 1 and data["lab"] == "demo"
    assert data["answers"]["n"] == {"source": "2.667", "version": lab.items["n"].version}
    assert "def normalise" in data["answers"]["c"]["source"]
    other = make_lab()
    assert other.load(file).startswith("Loaded 3")
    assert other.predictions == lab.predictions and other.answers == lab.answers
    assert "it stays (b)" in str(other.predict("p", "a"))


def test_a_file_of_a_former_name_is_read(tmp_path, monkeypatch):
    """One that was saved when the lab was called ch07; what is saved now has the new name."""
    monkeypatch.chdir(tmp_path)
    kept = Path(__file__).with_name("former") / "ch07_answers.json"
    shutil.copy(kept, tmp_path)
    resampling.LAB.forget()
    assert resampling.load() == "Loaded 4 answers from ch07_answers.json."
    assert resampling.LAB.predictions["clock"]["choice"] == "c"
    assert resampling.save() == "Saved 4 answers to resampling_answers.json."
    old, new = (json.loads(p.read_text()) for p in (kept, tmp_path / "resampling_answers.json"))
    assert new == old | {"lab": "resampling"}
    assert new["answers"]["clock"]["version"] == resampling.LAB.items["clock"].version
    resampling.LAB.forget()
    assert resampling.load() == "Loaded 4 answers from resampling_answers.json.", "the newer one"
    resampling.LAB.forget()


def test_former_names_are_those_of_labs():
    assert set(progress.FORMER_NAMES) < set(catalogue.names())


DAMAGED = [
    b"",
    b"{",
    b"[]",
    b"null",
    b"\xff\xfe\x00",
    b'{"schema": 2, "lab": "demo"}',
    b'{"schema": 1, "lab": "other"}',
    b'{"schema": 1, "lab": "demo", "answers": [1]}',
    b"[" * 100_000,
]


@pytest.mark.parametrize("bad", DAMAGED)
def test_damaged_files_are_set_aside_and_said(lab, tmp_path, bad):
    file = tmp_path / "a.json"
    for n in (1, 2):
        file.write_bytes(bad)
        told = lab.load(file)
        aside = tmp_path / f"a.json.damaged-{n}"
        assert aside.name in told and aside.read_bytes() == bad and not file.exists()
    lab.check("n", 2.667)
    file.write_bytes(bad)
    assert "damaged-3" in lab.save(file)
    assert json.loads(file.read_text())["answers"]["n"]["source"] == "2.667"
    assert make_lab().load(tmp_path / "none.json") == "There is no none.json yet."


def test_item_versions_follow_the_question():
    one, two = make_lab(), make_lab()
    assert [i.version for i in one.items.values()] == [i.version for i in two.items.values()]


def test_declarations_are_checked():
    item = make_lab().items["n"]
    with pytest.raises(ValueError, match="two items"):
        Lab("l", "L", [Question("One", "1", [item, item])])
    with pytest.raises(ValueError, match="'x' comes after a prediction that stands below it"):
        Lab("l", "L", [Question("One", "1", [make_lab().items["x"]])])
    with pytest.raises(ValueError, match="'measurement' is no new option"):
        Choice("""particle
            measurement""")
    with pytest.raises(ValueError, match="mark the right option with a star"):
        Prediction("""sign
            a  zero
            b  one""")


def module(name, **bound):
    """A module of questions, as `Lab.of` finds it."""
    found = types.ModuleType(name)
    vars(found).update(bound)
    return found


def test_a_lab_is_collected_in_the_order_of_its_modules():
    asked = {name: Numeric(name + ASKED, 1, tol=0.1) for name in ("mass", "speed", "late")}
    early = module("early", FIRST=Question("One"), mass=asked["mass"])
    more = module("more", mass=asked["mass"], speed=asked["speed"])  # imports what it builds on
    late = module("late", SECOND=Question("Two"), late=asked["late"], FIRST=early.FIRST)
    lab = Lab.of("pfkit.labs.demo", "Demo", early, more, late)
    assert lab.name == "demo" and list(lab.items) == ["mass", "speed", "late"]
    assert [(q.id, [i.id for i in q.items]) for q in lab.questions] == [
        ("first", ["mass", "speed"]),
        ("second", ["late"]),
    ]
    with pytest.raises(ValueError, match="'mass' stands above the first question"):
        Lab.of("pfkit.labs.demo", "Demo", module("bare", mass=asked["mass"]))


def test_a_wrong_answer_is_called_by_its_text_or_by_its_function(lab):
    code, number = lab.items["c"].misconceptions[0], lab.items["n"].misconceptions[0]
    assert (code.name, code.words) == ("by-max", "divides by the largest")
    assert (number.name, number.words, number.example) == ("inverse", "forgets to invert", 0.375)
    assert code.hints == ("m1", "m2", "m3") and lab.items["c"](np.ones(2)).tolist() == [0.5, 0.5]


def test_a_long_line_is_continued_by_an_indented_one():
    assert written_lines("""title
        one line
            goes on
           = and here on a line of its own
        two""") == ("title", "one line goes on\n= and here on a line of its own", "two")


def test_replay_bounds_the_false_fail_rate(lab):
    item = lab.items["x"]
    rate = replay(item, item.reference)
    assert rate.fails == 0 and rate.bound == pytest.approx(1 - 0.05 ** (1 / 3000), rel=1e-6)
    wrong = replay(item, item.misconceptions[0].example, decisions=200, pool=1_000)
    assert wrong.share == 1 and wrong.misconceptions == {"biased": 200}


def test_controls_drive_the_lab(lab, monkeypatch):
    widgets = pytest.importorskip("ipywidgets")
    assert controls.offer(lab, lab.items["m"]) is False  # no front end here
    box = controls.build(lab, lab.items["m"], widgets)
    radio, button, told = box.children
    button.click()
    assert "no answer yet" in told.value
    radio.value = "b"
    button.click()
    assert "passed" in told.value and lab.verdicts["m"].status == "passed"
    radio, sure, button, told = controls.build(lab, lab.items["p"], widgets).children
    radio.value = "a"
    for typed, says in [("", "how sure you are"), ("250", "from 0 to 100"), ("very", "0 to 100"),
                        ("0.7", "not .7"), ("-1", "from 0 to 100")]:  # fmt: skip
        sure.value = typed
        button.click()
        assert says in told.value and "To hand it in" not in told.value and not lab.predictions
    sure.value = "85 %"
    button.click()
    assert lab.predictions["p"]["choice"] == "a" and lab.predictions["p"]["sure"] == 85
    assert "write p = (&#x27;a&#x27;, 85) in the cell above" in told.value


def test_controls_are_offered_only_where_a_person_runs_the_cell(lab, monkeypatch):
    pytest.importorskip("ipywidgets")
    monkeypatch.delenv("PFKIT_WIDGETS", raising=False)
    request = {"metadata": {}}
    kernel = types.SimpleNamespace(get_parent=lambda channel: request)
    shell = types.SimpleNamespace(kernel=kernel)
    shown = []
    monkeypatch.setattr("IPython.get_ipython", lambda: shell)
    monkeypatch.setattr("IPython.display.display", lambda data, raw: shown.append(data))
    lab.check("m", ...)  # nbclient, nbval, the grader
    assert not shown
    request["metadata"]["cellId"] = "c0"  # JupyterLab, Notebook 7, VS Code
    lab.check("m", ...)
    lab.predict("p", ...)
    assert len(shown) == 2
    assert all("m = ... in the cell" in s["text/plain"] for s in shown[:1])
    lab.check("n", ...)  # a number needs no control
    lab.check("m", "b")  # answered
    monkeypatch.setenv("PFKIT_WIDGETS", "off")
    lab.check("m", ...)
    assert len(shown) == 2


def test_an_experiment_earns_all_or_nothing(lab):
    """One of two properties holds of many a constant."""
    item = lab.items["x"]
    judged = Judgement((Line("one", True), Line("two", False)))
    assert judged.fraction == 0.5
    assert item.earned(judged) == 0 and lab.items["c"].earned(judged) == 0.5
