"""A real robot: its solutions, its experiments' margins, and the excerpt that it carries.

What holds for all items (references, mistakes, completeness) is in test_items.py.
"""

import json
import re
import sys
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import Experiment, Prediction, ch14
from pfkit.labs.replay import replay

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_excerpts  # noqa: E402

ITEMS = ch14.LAB.items
NAMES = {"bias": "fit_bias", "biased_x": "biased_run", "lost_x": "found", "third": "third_answer"}


@pytest.fixture(autouse=True)
def fresh():
    ch14.LAB.forget()
    yield
    ch14.LAB.forget()


def solutions():
    """Answers by item, from the public solutions."""
    text = (ROOT / "tests" / "solutions" / "ch14.py").read_text(encoding="utf-8")
    space = {"np": np, "pf": pf, "lab": ch14}
    exec(text, space)
    found = re.findall(r"^# %% (\w+)$", text, re.M)
    return {item: space[NAMES.get(item, item)] for item in found}


def test_every_item_has_a_solution_and_each_passes():
    answers = solutions()
    assert answers.keys() == ITEMS.keys()
    for item in sorted(answers, key=lambda i: not isinstance(ITEMS[i], Prediction)):
        give = ch14.predict if isinstance(ITEMS[item], Prediction) else ch14.check
        verdict = ch14.answer(item, answers[item]) if item == "report" else None
        verdict = verdict or give(item, answers[item])
        assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)


def test_lever_and_held_are_what_they_say():
    assert ch14.lever.key == pytest.approx(40 * np.sin(np.radians(3)), abs=0.005)
    assert ch14.held.key == pytest.approx(0.1 * 0.2 + 0.6 * 0.1 + 0.2 * 0.3)


@pytest.mark.slow
def test_right_experiments_hardly_ever_fail():
    """3,000 decisions replayed on a pool of runs; the wrong ones fail nearly always."""
    pools = {"biased_x": 36, "lost_x": 75}
    for item in ITEMS.values():
        if isinstance(item, Experiment):
            rate = replay(item, item.reference, decisions=3_000, pool=pools[item.id])
            assert rate.fails == 0, item.id
    plain = ch14.lost_x.misconceptions[0].example
    assert replay(ch14.lost_x, plain, decisions=500, pool=45).fails > 450


def test_the_stretch_is_made_from_the_twin():
    kept = json.loads(make_excerpts.STRETCH.read_text())
    made = make_excerpts.pack_stretch(pf.load_mrclam(ROOT / "data" / "mrclam_twin"))
    for name in ("t", "u", "truth", "landmarks"):
        np.testing.assert_allclose(kept[name], made[name], atol=2e-4)
    assert [len(zk[0]) for zk in kept["z"]] == [len(zk[0]) for zk in made["z"]]
    assert len(ch14.stretch()) == len(kept["t"]) and len(ch14.minute()) > 200
