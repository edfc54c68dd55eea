"""Right experiments of the chapters hardly ever fail; wrong ones are named.

Each decision is replayed 3,000 times on draws from a pool of independent runs. The pools are
small where a run is slow, so the margin stated in the item carries the claim beyond 1e-3.
"""

import importlib

import pytest

from pfkit.labs import Experiment, replay

POOL = {
    "no_copy_x": 120,
    "lock_x": 120,
    "ushape_x": 60,
    "zero_x": 600,
    "frozen_x": 400,
    "twice_x": 240,
}
CHAPTERS = ("ch01", "ch05", "ch06", "ch07", "ch10")
ITEMS = [
    item
    for name in CHAPTERS
    for item in importlib.import_module(f"pfkit.labs.{name}").LAB.items.values()
    if isinstance(item, Experiment)
]


@pytest.mark.parametrize("item", ITEMS, ids=lambda item: item.id)
def test_a_right_experiment_rarely_fails(item):
    rate = replay(item, item.reference, decisions=3000, pool=POOL.get(item.id, 1500))
    assert rate.fails == 0, rate
    assert rate.bound <= 1e-3
    assert item.margin


@pytest.mark.parametrize("item", ITEMS, ids=lambda item: item.id)
def test_each_wrong_experiment_is_named(item):
    for mistake in item.misconceptions:
        rate = replay(item, mistake.example, decisions=200, pool=3 * item.runs, seed=7)
        named = rate.misconceptions.get(mistake.name, 0)
        assert named >= 0.95 * rate.decisions, (mistake.name, rate)
