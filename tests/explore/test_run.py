"""Going back, two worlds, a hundred seeds: a run is what was done to it, and nothing else."""

from __future__ import annotations

import json

import numpy as np
import pytest

from pfkit.errors import ParameterError
from pfkit.explore import SCENES, scene
from pfkit.explore.host import Host
from pfkit.explore.pen import records
from pfkit.explore.run import Run
from pfkit.explore.seeds import RUNS, Seeds

PANELS = [(name, panel) for name in SCENES for panel in type(scene(name)).panels]


def opened(name, panel=None, seed=3):
    host = Host()
    host.open("k", name, panel, seed)

    def do(*operations):
        drawing, told = host.do("k", json.dumps(operations))
        return drawing, json.loads(told)

    return host.runs["k"], do


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_the_way_back_leads_to_the_very_frame_and_on_again(name, panel):
    _, do = opened(name, panel)
    then, told = do(["step", 41])
    later, _ = do(["step", 30])
    back, again = do(["back", 41])
    assert np.array_equal(back, then, equal_nan=True) and again["readouts"] == told["readouts"]
    assert again["kept"] == [0, 71] and again["told"] == []
    forth, _ = do(["back", 71])
    assert np.array_equal(forth, later, equal_nan=True)
    do(["back", 41])
    on, _ = do(["step", 30])
    assert np.array_equal(on, later, equal_nan=True)


def test_what_the_reader_did_is_done_again_on_the_way_back():
    run, do = opened("drive", "kidnap", 2)
    do(["step", 47], ["set", "kidnap", True], ["step", 5], ["hold", "robot", 1.0, 1.0, "press"])
    do(["hold", "robot", 5.0, 5.0, "drag"], ["hold", "robot", 5.0, 5.0, "release"], ["step", 3])
    there, _ = do(["phase", 40], ["set", "sigma_r", 0.8], ["step", 100])
    end = run.ticks
    do(["back", 10])
    assert not run.worlds[0].kidnapped
    assert np.array_equal(do(["back", end])[0], there, equal_nan=True)


def test_what_is_done_in_the_middle_of_a_tick_counts_after_it():
    _, do = opened("drive", "localise")
    _, told = do(["step", 11], ["phase", 5])
    assert told["begun"] and told["ticks"] == 11 and told["phase"]["name"] == "predict"
    _, told = do(["set", "sigma_r", 0.9])
    assert not told["begun"] and told["ticks"] == 12
    there, _ = do(["step", 20])
    _, again = opened("drive", "localise")
    assert np.array_equal(again(["step", 12], ["set", "sigma_r", 0.9], ["step", 20])[0], there)


def test_after_a_way_back_something_else_can_happen():
    run, do = opened("drive", "kidnap", 2)
    do(["step", 60], ["set", "kidnap", True], ["step", 60], ["back", 50])
    _, told = do(["step", 40])
    assert told["kept"] == [0, 90] and not run.worlds[0].kidnapped
    do(["back", 0])
    assert run.ticks == 0
    do(["back", 90])
    assert run.ticks == 90 and not run.worlds[0].kidnapped


def test_the_last_minute_stays_and_no_more():
    run, do = opened("proposal")
    rate = run.worlds[0].rate
    do(["step", int(100 * rate)])
    first, last = run.kept
    assert last == 100 * rate and 60 * rate <= last - first <= 61 * rate
    do(["back", 0])
    assert run.ticks == first
    assert len(run.moments) < 200


def test_a_new_seed_has_no_past():
    run, do = opened("comb")
    do(["step", 30], ["reset", 9])
    assert run.kept == (0, 0)
    do(["step", 20], ["set", "n", 9])  # a control that starts the run again
    assert run.kept == (0, 0)


@pytest.mark.parametrize(("name", "panel"), [p for p in PANELS if scene(*p).panel.controls])
def test_two_worlds_are_two_runs_of_one_seed(name, panel):
    control = scene(name, panel).panel.controls[1]
    spec = scene(name, panel).by_name[control]
    if spec.kind == "button":
        control = scene(name, panel).panel.controls[2]
        spec = scene(name, panel).by_name[control]
    value = {"choice": (spec.choices or (("",),))[-1][0], "toggle": False}.get(spec.kind, spec.hi)
    run, do = opened(name, panel)
    do(["step", 7], ["compare", control, value], ["step", 13])
    do(["phase", 40], ["step", 2])
    left, right = (scene(name, panel, 3) for _ in range(2))
    right.set(control, value)
    right.reset(3)
    for alone, world in zip((left, right), run.worlds, strict=True):
        while alone.ticks < run.ticks:
            alone.step()
        assert np.array_equal(alone.frame()[0], world.frame()[0], equal_nan=True)
    drawing, told = do()
    parts = [d.tolist() for op, _, d in records(drawing) if op == "part"]
    assert parts == [[0, 2], [1, 2]] and len(told["readouts"]) == 2
    assert len(told["phase"]["sentences"]) == 2
    back, _ = do(["step", 20], ["back", run.ticks])
    assert np.array_equal(back, drawing, equal_nan=True) or run.ticks > 20
    do(["compare", None, None])
    assert len(run.worlds) == 1 and run.ticks == 0


def test_each_world_has_its_own_value_of_the_control_that_differs_and_shares_all_others():
    run, do = opened("drive", "localise")
    do(["compare", "M", 50], ["step", 5], ["set", "sigma_r", 0.9])
    assert [w.values["M"] for w in run.worlds] == [500, 50]
    assert [w.values["sigma_r"] for w in run.worlds] == [0.9, 0.9]
    do(["step", 5], ["other", 5000])  # starts again, both of them
    assert [w.bel.M for w in run.worlds] == [500, 5000] and run.kept == (0, 0)
    assert [w.ticks for w in run.worlds] == [0, 0]
    do(["step", 9], ["set", "M", 100])
    assert [w.bel.M for w in run.worlds] == [100, 5000] and [w.ticks for w in run.worlds] == [0, 0]
    _, told = do(["set", "kidnap", True])
    assert told["values"]["M"] == 100 and told["other"]["M"] == 5000
    assert all(w.kidnapped for w in run.worlds)
    with pytest.raises(ParameterError, match="one world only"):
        do(["compare", None, None], ["other", 3])


def test_a_handle_moves_both_worlds_but_not_what_they_differ_in():
    run, do = opened("drive", "localise")
    do(["compare", "threshold", 1.0], ["step", 3], ["hold", "threshold", 159.0, 0.3, "press"])
    do(["hold", "threshold", 159.0, 0.2, "drag"], ["hold", "landmark 2", 5.0, 5.0, "drag"])
    assert [w.values["threshold"] for w in run.worlds] == [0.2, 1.0]
    assert all(w.landmarks[:, 1] == pytest.approx([5, 5]) for w in run.worlds)
    with pytest.raises(ParameterError, match="no control"):
        do(["compare", "moon", 1.0])
    assert len(run.worlds) == 2 and run.differs == "threshold"


# ---- a hundred seeds ---------------------------------------------------------------------------


def test_a_hundred_seeds_are_a_hundred_runs():
    s = scene("comb", seed=5)
    s.set("scheme", "systematic")
    seeds = Seeds([s])
    while seeds.done < RUNS:
        seeds.work(70)
    score = s.panel.score
    for seed in (1, 2, 50, 100):
        alone = scene("comb", seed=seed)
        alone.set("scheme", "systematic")
        for _ in range(score.ticks):
            alone.step()
        assert seeds.results[0][seed - 1] == alone.readouts()[score.readout]
    seeds.work(100)
    assert seeds.done == len(seeds.results[0]) == RUNS
    failed = sum(v > score.limit for v in seeds.results[0])
    assert f"{failed} of 100 runs" in seeds.sentence()


def test_two_worlds_are_counted_apart_and_kidnapped_alike():
    one = scene("drive", "kidnap", 1)
    one.set("M", 60)
    two = one.copy()
    two.set("fresh", 10)
    seeds = Seeds([one, two])
    ticks = one.panel.score.ticks
    seeds.work(4 * ticks)
    without, with_fresh = seeds.failed()
    assert seeds.done == 4 and without > with_fresh
    bars = [d for op, _, d in records(seeds.draw()) if op == "bars"]
    counted = sum(float(d[1:].reshape(4, -1)[3].sum()) for d in bars)
    assert counted == 8
    assert one.ticks == 0  # the picture's own world is left alone


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_a_score_is_a_readout_with_a_unit(name, panel):
    s = scene(name, panel)
    if s.panel.score is None:
        with pytest.raises(ParameterError, match="no score"):
            Seeds([s])
        return
    assert s.panel.score.readout in s.readouts() and s.panel.score.readout in s.gauges


def test_a_copy_goes_its_own_way():
    s = scene("office", seed=1)
    for _ in range(20):
        s.step()
    other = s.copy()
    before = s.frame()[0]
    for _ in range(20):
        other.step()
    assert np.array_equal(s.frame()[0], before, equal_nan=True)
    assert other.world is s.world
    run = Run(s)
    run.do(["step", 20])
    assert np.array_equal(run.frame(), other.frame()[0], equal_nan=True)
