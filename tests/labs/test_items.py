"""Every item of every lab: the reference passes, each wrong answer earns its own hint."""

import time

import pytest

from pfkit.labs import Choice, Code, Experiment, Numeric, Prediction, Text
from pfkit.labs.catalogue import all_labs

LABS = all_labs()
ITEMS = [(lab, i) for lab in LABS for i in LABS[lab].items.values()]
MISTAKES = [(lab, i, m) for lab, i in ITEMS for m in i.misconceptions]
REFUSED = [(lab, i, r) for lab, i in ITEMS for r in i.refused]


def name(value):
    return (
        getattr(value, "id", None)
        or getattr(value, "name", None)
        or getattr(value, "says", None)
        or str(value)
    )


@pytest.fixture
def fresh():
    for lab in LABS.values():
        lab.forget()
    yield
    for lab in LABS.values():
        lab.forget()


def answered(lab, item, answer):
    if item.after:
        lab.predict(item.after.id, (item.after.key, 60))
    return lab.check(item.id, answer)


@pytest.mark.parametrize(("lab", "item"), ITEMS, ids=name)
def test_reference_passes_in_time(lab, item, fresh):
    start = time.process_time()
    verdict = answered(LABS[lab], item, item.solution())
    seconds = time.process_time() - start
    assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)
    assert seconds < 2.0, f"a right answer must be checked in 2 s, took {seconds:.2f} s"


@pytest.mark.parametrize(("lab", "item", "mistake"), MISTAKES, ids=name)
def test_wrong_example_earns_its_own_hint_and_no_other(lab, item, mistake, fresh):
    verdict = answered(LABS[lab], item, mistake.example)
    assert verdict.status in ("partial", "wrong"), f"{mistake.name} is not caught:\n{verdict}"
    assert verdict.misconception == mistake.name, str(verdict)
    assert mistake.words in verdict.hint and mistake.hints[0] in verdict.hint
    texts = [h for _, _, m in MISTAKES for h in m.hints if m is not mistake]
    assert not [t for t in texts if t in verdict.hint and t not in mistake.hints]


@pytest.mark.parametrize(("lab", "item", "refused"), REFUSED, ids=name)
def test_what_is_refused_does_not_pass(lab, item, refused, fresh):
    verdict = answered(LABS[lab], item, refused.example)
    assert verdict.status in ("partial", "wrong"), f"{refused.says} is not caught:\n{verdict}"
    assert verdict.misconception == refused.named, str(verdict)


@pytest.mark.parametrize(("lab", "item"), ITEMS, ids=name)
def test_items_are_complete(lab, item):
    assert item.title and item.points > 0
    if isinstance(item, Choice):
        assert item.key in item.options and set(item.feedback) == set(item.options)
        assert all(text.count(". ") <= 1 for text in item.feedback.values())
    elif isinstance(item, Prediction):
        assert item.key in item.options
        assert any(i.after is item for i in LABS[lab].items.values())
    elif isinstance(item, Text):
        assert item.rubric and item.model
    else:
        assert len(item.hints) == 3 and all(item.hints)
        assert item.misconceptions, "name at least one usual mistake"
    for mistake in item.misconceptions:
        assert len(set(mistake.hints)) == 3 and all(mistake.hints) and mistake.words
    names = [m.name for m in item.misconceptions]
    assert len(set(names)) == len(names)
    if isinstance(item, Experiment):
        assert item.claim and item.test and item.margin and 0 < item.false_fail <= 1e-3


@pytest.mark.parametrize(("lab", "item"), ITEMS, ids=name)
def test_distractors_are_answered_each_in_its_own_words(lab, item, fresh):
    if isinstance(item, Choice):
        hints = {k: LABS[lab].check(item.id, k).hint for k in item.options}
        assert len(set(hints.values())) == len(hints)
        assert [k for k in hints if LABS[lab].check(item.id, k).status == "passed"] == [item.key]


@pytest.mark.parametrize("lab", [n for n in LABS if n.startswith("lab")])
def test_a_lab_names_five_mistakes_or_more_of_each_function(lab):
    few = {i.id: len(i.misconceptions) for i in LABS[lab].items.values() if isinstance(i, Code)}
    assert few and not {item: n for item, n in few.items() if n < 5}


def test_numeric_misconceptions_lie_outside_the_tolerance():
    for _, item in ITEMS:
        if isinstance(item, Numeric):
            for mistake in item.misconceptions:
                assert item.judge(mistake.example).fraction < 1
