"""Chapter 11: right answers pass, wrong ones earn their own hint, experiments rarely fail."""

import time
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import Choice, Numeric, ch11, replay
from pfkit.labs.replay import upper_bound

LAB = ch11.LAB
ITEMS = list(LAB.items.values())
MISTAKES = [(i, m) for i in ITEMS for m in i.misconceptions]


@pytest.fixture(autouse=True)
def fresh():
    LAB.forget()
    yield
    LAB.forget()


def answered(item, answer):
    if item.after:
        LAB.predict(item.after, (LAB.items[item.after].key, 60))
    return LAB.check(item.id, answer)


@pytest.mark.parametrize("item", ITEMS, ids=lambda i: i.id)
def test_reference_passes_in_time(item):
    start = time.process_time()
    verdict = answered(item, item.solution())
    assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)
    assert time.process_time() - start < 2.0


@pytest.mark.parametrize(("item", "mistake"), MISTAKES, ids=lambda x: getattr(x, "name", ""))
def test_wrong_answer_earns_its_own_hint(item, mistake):
    verdict = answered(item, mistake.example)
    assert verdict.status in ("partial", "wrong"), f"{mistake.name} is not caught:\n{verdict}"
    assert verdict.misconception == mistake.name, str(verdict)
    assert mistake.hints[0] in verdict.hint


@pytest.mark.parametrize("item", [i for i in ITEMS if isinstance(i, Choice)], ids=lambda i: i.id)
def test_each_distractor_has_its_own_words(item):
    hints = {k: LAB.check(item.id, k).hint for k in item.options}
    assert set(item.feedback) == set(item.options)
    assert len(set(hints.values())) == len(hints)


def test_keys_follow_from_their_formulas():
    keys = {i.id: i.key for i in ITEMS if isinstance(i, Numeric)}
    assert np.allclose(keys["hand"], (6 / 27, 3 * (1 - (2 / 3) ** 3)), atol=6e-4)
    assert np.isclose(keys["founders"], np.exp(-5000 * 0.0002), atol=5e-4)
    W = np.array([0.75, 0.25])
    assert np.isclose(keys["nats"], np.sum(W * np.log(4 * W)), atol=5e-4)


def test_luck_fails_a_right_answer_less_than_once_in_ten_thousand():
    """The index is uniform over four by symmetry, so the decision can be replayed exactly."""
    rng, n = np.random.default_rng(1), 30_000
    counts = rng.multinomial(200, [0.25] * 4, n)
    fails = int((np.abs(counts / 200 - 0.25).max(axis=1) >= 0.135).sum())
    assert upper_bound(fails, n) < 4e-4


def test_alive_fails_a_right_answer_rarely():
    item = LAB.items["alive_x"]
    rate = replay(item, item.reference, decisions=3000, pool=200)
    assert rate.fails == 0, rate


def test_published_solutions_pass():
    """With the chapter's own names in scope, as in the notebook."""
    world = pf.worlds.square()
    scope = {
        "np": np,
        "pf": pf,
        "world": world,
        "start": pf.worlds.SQUARE_START,
        "g": pf.symmetries(world),
        "sensor": pf.MaximumLikelihood(pf.RangeBearing(world, 0.3, 0.1)),
        "motion": pf.VelocityMotion(alpha=(0.02, 0.002, 0.002, 0.02, 0.002, 0.002)),
        "forward": np.tile([[1.0], [0.0], [2.0]], 6),
    }
    path = Path(__file__).parents[1] / "solutions" / "ch11.py"
    exec(path.read_text(encoding="utf-8"), scope)
    for item in ITEMS:
        verdict = answered(item, scope[item.id])
        assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)
