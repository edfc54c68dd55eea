"""Global localisation: its keys, its solutions, its experiments' margins.

What holds for all items (references, mistakes, completeness) is in test_items.py.
"""

from math import comb
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import Numeric, ch11, replay

LAB = ch11.LAB
ITEMS = list(LAB.items.values())


@pytest.fixture(autouse=True)
def fresh():
    LAB.forget()
    yield
    LAB.forget()


def test_keys_follow_from_their_formulas():
    keys = {i.id: i.key for i in ITEMS if isinstance(i, Numeric)}
    assert np.allclose(keys["hand"], (6 / 27, 3 * (1 - (2 / 3) ** 3)), atol=6e-4)
    assert np.isclose(keys["founders"], np.exp(-5000 * 0.0002), atol=5e-4)
    W = np.array([0.75, 0.25])
    assert np.isclose(keys["nats"], np.sum(W * np.log(4 * W)), atol=5e-4)


def test_luck_fails_a_right_answer_less_than_once_in_ten_thousand():
    """The index is uniform over four by symmetry, so each share is binomial."""
    far = [k for k in range(201) if abs(k / 200 - 0.25) >= 0.135]
    tail = sum(comb(200, k) * 0.25**k * 0.75 ** (200 - k) for k in far)
    assert 4 * tail < 8e-5


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
        predicted = item.after and LAB.predict(item.after, (LAB.items[item.after].key, 60))
        assert not item.after or predicted.status == "predicted"
        verdict = LAB.check(item.id, scope[item.id])
        assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)
