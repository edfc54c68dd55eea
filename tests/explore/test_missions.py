"""Every guided mission can be done by its reader, and none is ticked off before it is.

Each line is a reader: controls to move, then (mission, ticks) to wait for. Fixed seeds.
"""

from __future__ import annotations

import pytest

from pfkit.explore import SCENES, scene

KIDNAP = (300, ("kidnap", True))
READERS = [
    ("drive", "localise", 1, 0, ()),
    ("drive", "localise", 4, 1, (("M", 50),)),
    ("drive", "localise", 1, 2, (("fresh", 5), *KIDNAP)),
    ("drive", "sensing", 1, 0, (("remove", True),)),
    ("drive", "sensing", 1, 1, (("sense", "bearing"), "corner")),
    ("drive", "sensing", 1, 2, (("sigma_r", 0.8), ("add", True), ("add", True))),
    ("drive", "assembly", 1, 0, (300, ("do_resample", False))),
    ("drive", "assembly", 1, 1, (300, ("do_predict", False))),
    ("drive", "assembly", 1, 2, (("prior", "known"), ("do_weigh", False))),
    ("drive", "outliers", 1, 0, (("outliers", 60),)),
    ("drive", "outliers", 1, 1, (("outliers", 30), ("defence", "mixture"))),
    ("drive", "outliers", 1, 2, (("defence", "gate"), ("prior", "lost"))),
    ("drive", "symmetry", 1, 0, ()),
    ("drive", "symmetry", 1, 1, (("M", 5000),)),
    ("drive", "symmetry", 1, 2, (60, ("fifth", True))),
    ("drive", "kidnap", 1, 0, KIDNAP),
    ("drive", "kidnap", 1, 1, (("fresh", 2), *KIDNAP)),
    ("drive", "kidnap", 1, 2, (("fresh", 20),)),
    ("comb", "comb", 1, 0, (("pace", 60),)),
    ("comb", "comb", 1, 1, (("weights", "equal"),)),
    ("comb", "comb", 1, 2, ()),
    ("proposal", "proposal", 1, 0, (("mu", -2), ("sigma", 0.6))),
    ("proposal", "proposal", 1, 1, (("target", "one"), ("mu", 0), ("sigma", 1.1))),
    ("proposal", "proposal", 1, 2, (("target", "one"), ("sigma", 0.6), ("tails", "student"))),
    ("corridor", "corridor", 1, 0, (("auto", False), ("look", True))),
    ("corridor", "corridor", 1, 1, (("hit", 0.5), ("false", 0.5))),
    ("corridor", "corridor", 1, 2, (60, ("auto", False), *(("move", True),) * 15)),
    ("banana", "banana", 1, 0, (("a1", 0), ("a3", 0), ("a5", 0))),
    ("banana", "banana", 1, 1, ("match",)),
    ("banana", "banana", 1, 2, ("match",)),
    ("exact", "exact", 2, 0, (("M", 10000),)),
    ("exact", "exact", 3, 1, (("prior", "known"), ("M", 50))),
    ("exact", "exact", 1, 2, (("trust", 3),)),
    ("office", "office", 2, 0, ()),
    ("office", "office", 3, 1, (("K", 2),)),
    ("office", "office", 2, 2, (("fresh", 5), *KIDNAP)),
    ("mower", "mower", 1, 0, (200, ("bias", False), ("sigma_r", 1.5))),
    ("mower", "mower", 1, 1, (("keep", 20),)),
    ("mower", "mower", 1, 2, (("start", "anywhere"),)),
]
PATIENCE = 1200  # ticks: twenty seconds of most scenes


def corner(s):
    """Drag the two landmarks until the robot sees them at a right angle, from one metre."""
    s.set("autopilot", False)
    x, y, _ = s.truth
    for landmark, place in ((0, (x + 1, y)), (1, (x, y + 1))):
        s.set("point", (*s.landmarks[:, landmark], 0))
        s.set("point", (*place, 1))
        s.set("point", (*place, 2))


def match(s):
    """Turn the noises to those of the hidden robot, as finely as the sliders allow, and name it."""
    for name, value in zip(("a1", "a3", "a4", "a5"), s.hidden_sd, strict=True):
        step = s.by_name[name].step
        s.set(name, float(round(value / step) * step))
    s.set("guess", s.hidden)


def test_there_is_a_reader_for_every_mission():
    wanted = {
        (name, panel, k)
        for name in SCENES
        for panel, about in type(scene(name)).panels.items()
        for k in range(len(about.missions))
    }
    assert {(name, panel, k) for name, panel, _, k, _ in READERS} == wanted


@pytest.mark.parametrize(("name", "panel", "seed", "k", "moves"), READERS)
def test_a_mission_can_be_done(name, panel, seed, k, moves):
    s = scene(name, panel, seed)
    assert not any(s.achieved)
    for move in moves:
        if isinstance(move, int):
            for _ in range(move):
                s.step()
        elif isinstance(move, str):
            globals()[move](s)
        else:
            s.set(*move)
    for _ in range(PATIENCE):
        if s.achieved[k]:
            break
        s.step()
    assert s.achieved[k]


@pytest.mark.parametrize("seed", range(1, 9))
def test_being_carried_off_is_not_yet_being_found(seed):
    s = scene("drive", "kidnap", seed)
    s.set("fresh", 2)
    for _ in range(300):
        s.step()
    s.set("kidnap", True)
    assert s.error > 1 and not s.achieved[1]
