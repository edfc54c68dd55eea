"""The mower runs on the real log, and its missions can be done."""

import json
import sys
from pathlib import Path

import numpy as np

import pfkit as pf
from pfkit.explore import scene
from pfkit.explore.mower import recorded

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_excerpts  # noqa: E402


def test_the_packed_log_is_made_from_the_data():
    kept = json.loads(make_excerpts.MOWER.read_text())
    made = make_excerpts.pack_mower(pf.load_plaza(ROOT / "data" / "plaza2"))
    assert kept.keys() == made.keys() and kept["source"] == made["source"]
    for name in kept.keys() - {"source"}:
        atol = 0.011 if name in ("start", "beacons [m]", "bias [m]") else 1  # the last digit
        np.testing.assert_allclose(kept[name], made[name], atol=atol)


def test_it_is_the_same_drive():
    log = pf.load_plaza(ROOT / "data" / "plaza2")
    steps = np.flatnonzero([zk.shape[1] for zk in log.z])
    blind = pf.dead_reckoning(log, pf.VelocityMotion())[:, steps]
    packed = recorded()
    np.testing.assert_allclose(packed["log"].truth[:2], log.truth[:2, steps], atol=0.01)
    assert np.hypot(*(packed["blind"] - blind)[:2]).max() < 0.5


def play(steps, **values):
    mower = scene("mower", seed=3)
    for name, value in values.items():
        mower.set(name, value)
    for _ in range(steps):
        mower.step()
    return mower


def test_forgetting_the_biases_is_wrong_and_sure():
    assert play(400, bias=False, sigma_r=1.6).achieved[0]
    assert not play(400).achieved[0]


def test_one_range_in_twenty_is_enough_for_a_while():
    assert play(400, keep=20).achieved[1]


def test_it_is_found_from_anywhere():
    assert play(400, start="anywhere", M="4000").achieved[2]
