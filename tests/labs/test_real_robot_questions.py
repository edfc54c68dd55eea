"""A real robot: keys follow from formulas, and the excerpt is what its maker makes."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import real_robot

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
import make_excerpts  # noqa: E402


def test_lever_and_held_are_what_they_say():
    assert real_robot.lever.key == pytest.approx(40 * np.sin(np.radians(3)), abs=0.005)
    assert real_robot.held.key == pytest.approx(0.1 * 0.2 + 0.6 * 0.1 + 0.2 * 0.3)


def test_the_stretch_is_made_from_the_twin():
    kept = json.loads(make_excerpts.STRETCH.read_text())
    made = make_excerpts.pack_stretch(pf.load_mrclam(ROOT / "data" / "mrclam_twin"))
    for name in ("t", "u", "truth", "landmarks"):
        np.testing.assert_allclose(kept[name], made[name], atol=2e-4)
    assert [len(zk[0]) for zk in kept["z"]] == [len(zk[0]) for zk in made["z"]]
    assert len(real_robot.stretch()) == len(kept["t"]) and len(real_robot.minute()) > 200
