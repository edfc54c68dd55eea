"""Sensing: keys follow from formulas, experiments rarely fail, published solutions pass."""

import json
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import Experiment, ch04, replay
from pfkit.labs.ch04.score import readings

ROOT = Path(__file__).parents[2]
LAB = ch04.LAB
ITEMS = list(LAB.items.values())


@pytest.fixture(autouse=True)
def fresh():
    LAB.forget()
    yield
    LAB.forget()


def answered(item, answer):
    if item.after:
        LAB.predict(item.after, (LAB.items[item.after].key, 60))
    return LAB.check(item.id, answer)


@pytest.mark.parametrize(
    "item", [i for i in ITEMS if isinstance(i, Experiment)], ids=lambda i: i.id
)
def test_a_right_experiment_rarely_fails(item):
    rate = replay(item, item.reference, decisions=3000, pool=300)
    assert rate.fails == 0, rate


def test_the_reference_score_is_the_range_bearing_sensor():
    z, m, pose, sigma_r, sigma_phi = readings(9)
    world = pf.LandmarkMap(m)
    sensor = pf.RangeBearing(world, sigma_r, sigma_phi)
    ours = LAB.items["score"].reference(z, m, pose, sigma_r, sigma_phi)
    assert np.allclose(ours, sensor.log_likelihood(np.vstack((z, world.ids)), pose))


def test_published_solutions_pass():
    """With the chapter's own names in scope, as in the notebook."""
    world = pf.worlds.arena()
    scope = {
        "np": np,
        "pf": pf,
        "world": world,
        "pose": np.array([6.0, 3.0, np.pi / 2]),
        "sensor": pf.RangeBearing(world, sigma_r=0.3, sigma_phi=0.1),
    }
    (path,) = (ROOT / "notebooks").glob("[0-9][0-9]_landmarks.ipynb")
    book = json.loads(path.read_text(encoding="utf-8"))
    sources = ["".join(c["source"]) for c in book["cells"]]
    exec(next(s for s in sources if s.startswith("def look(")), scope)
    exec((ROOT / "tests" / "solutions" / "ch04.py").read_text(encoding="utf-8"), scope)
    for item in ITEMS:
        verdict = answered(item, scope[item.id])
        assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)
