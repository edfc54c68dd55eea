"""Items of chapter 14: references pass, wrong answers earn their own hints."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import Choice, Experiment, Numeric, Prediction, ch14
from pfkit.labs.replay import replay

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_excerpts  # noqa: E402

ITEMS = list(ch14.LAB.items.values())
MISTAKES = [(item, m) for item in ITEMS for m in item.misconceptions]


@pytest.fixture(autouse=True)
def fresh():
    ch14.LAB.forget()
    yield
    ch14.LAB.forget()


def answered(item, answer):
    if item.after:
        ch14.predict(item.after, (ch14.LAB.items[item.after].key, 60))
    return ch14.check(item.id, answer)


@pytest.mark.parametrize("item", ITEMS, ids=lambda i: i.id)
def test_reference_passes(item):
    verdict = answered(item, item.solution())
    assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)


@pytest.mark.parametrize(
    ("item", "mistake"), MISTAKES, ids=lambda v: getattr(v, "name", None) or v.id
)
def test_wrong_example_earns_its_own_hint(item, mistake):
    verdict = answered(item, mistake.example)
    assert verdict.status in ("partial", "wrong"), str(verdict)
    assert verdict.misconception == mistake.name, str(verdict)


@pytest.mark.parametrize("item", ITEMS, ids=lambda i: i.id)
def test_items_are_complete(item):
    assert item.title and item.points > 0
    if isinstance(item, Choice | Prediction):
        assert item.key in item.options
    if isinstance(item, Choice):
        hints = {key: ch14.check(item.id, key).status for key in item.options}
        assert [key for key, status in hints.items() if status == "passed"] == [item.key]
    if isinstance(item, Numeric):
        assert all(item.judge(m.example).fraction < 1 for m in item.misconceptions)


def test_lever_and_held_are_what_they_say():
    assert ch14.lever.key == pytest.approx(40 * np.sin(np.radians(3)), abs=0.005)
    assert ch14.held.key == pytest.approx(0.1 * 0.2 + 0.6 * 0.1 + 0.2 * 0.3)


@pytest.mark.slow
def test_right_experiments_hardly_ever_fail():
    """3,000 decisions replayed on a pool of runs; the wrong ones fail nearly always."""
    pools = {"biased_x": 36, "lost_x": 75}
    for item in ITEMS:
        if isinstance(item, Experiment):
            rate = replay(item, item.reference, decisions=3_000, pool=pools[item.id])
            assert rate.fails == 0, item.id
    plain = ch14.lost_x.misconceptions[0].example
    assert replay(ch14.lost_x, plain, decisions=500, pool=45).fails > 450


def test_experiments_declare_what_they_test():
    for item in ITEMS:
        if isinstance(item, Experiment):
            assert item.claim and item.test and item.margin and item.false_fail <= 1e-3


def test_the_stretch_is_made_from_the_twin():
    kept = json.loads(make_excerpts.STRETCH.read_text())
    made = make_excerpts.pack_stretch(pf.load_mrclam(ROOT / "data" / "mrclam_twin"))
    for name in ("t", "u", "truth", "landmarks"):
        np.testing.assert_allclose(kept[name], made[name], atol=2e-4)
    assert [len(zk[0]) for zk in kept["z"]] == [len(zk[0]) for zk in made["z"]]
    assert len(ch14.stretch()) == len(kept["t"]) and len(ch14.minute()) > 200
