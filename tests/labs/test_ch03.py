"""Motion: keys follow from formulas, experiments rarely fail, published solutions pass."""

import json
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import Experiment, ch03, replay
from pfkit.labs.ch03 import arcs, experiments

ROOT = Path(__file__).parents[2]
LAB = ch03.LAB
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


def test_references_are_the_motion_model_of_the_package():
    rng, u, alpha = np.random.default_rng(1), np.array([1.0, 0.4, 0.5]), (0.1, 0.02, 0.03, 0.2)
    pose = rng.normal(size=(3, 50))
    motion = pf.VelocityMotion(alpha)
    assert np.allclose(LAB.items["arc"].reference(pose, *u), motion.mean(pose, u))
    ours = LAB.items["sample"].reference(pose, u, alpha, np.random.default_rng(2))
    assert np.allclose(ours, motion.sample(pose, u, np.random.default_rng(2)))


def test_keys_follow_from_the_package():
    quarter = pf.VelocityMotion().mean(np.zeros(3), np.array([0.5, -np.pi / 2, 1.0]))
    assert np.allclose(quarter[:2], LAB.items["hand"].key, atol=1e-3)
    v, omega = pf.DifferentialDrive(0.1, 0.5).body_speed(8, 12)
    assert np.allclose((v, omega, v / omega), LAB.items["wheels"].key)


def test_a_careful_threshold_is_as_good_as_sinc():
    """Two cases are no mistake if the border lies where both are exact enough."""

    def arc(pose, v, omega, dt):
        slow = np.abs(omega) < 1e-6
        curved = arcs.naive(pose, v, np.where(slow, 1.0, omega), dt)
        found = np.where(slow, arcs.along(0.5, arcs.full)(pose, v, omega, dt), curved)
        found[2] = pf.wrap(pose[2] + omega * dt)
        return found

    assert answered(LAB.items["arc"], arc).status == "passed"


def test_published_solutions_pass():
    """With the chapter's own names in scope, as in the notebook."""
    scope = {
        "np": np,
        "pf": pf,
        "motion": pf.VelocityMotion(experiments.ALPHA),
        "u": np.array(experiments.U),
    }
    (path,) = (ROOT / "notebooks").glob("[0-9][0-9]_motion.ipynb")
    book = json.loads(path.read_text(encoding="utf-8"))
    sources = ["".join(c["source"]) for c in book["cells"]]
    exec(next(s for s in sources if s.startswith("def together(")), scope)
    exec((ROOT / "tests" / "solutions" / "ch03.py").read_text(encoding="utf-8"), scope)
    for item in ITEMS:
        verdict = answered(item, scope[item.id])
        assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)
