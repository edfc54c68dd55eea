"""What a rig and the options of the command change: odometry, names, poses, mountings, recovery."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds
from pfkit.__main__ import main
from pfkit.judging.localise import localise, score, settings_for, thinned

MOTION = pf.VelocityMotion((0.005, 0.001, 0.001, 0.005))
DATA = Path(__file__).parents[2] / "data"


def drive(sensor=None, seed=3, start=worlds.ARENA_START, u=None, **options):
    sensor = sensor or pf.RangeBearing(worlds.arena(), 0.1, 0.02)
    u = worlds.arena_route() if u is None else u
    return pf.simulate_log(start, u, MOTION, sensor, np.random.default_rng(seed), **options)


def rmse(log, start="known", M=400, **options):
    settings = settings_for(log)
    track = localise(log, np.random.default_rng(0), start, M, 3, settings, **options)
    return score(log, track.estimate, settings.limit).rmse.max()


def as_increments(log):
    """The same odometry as poses that were added up."""
    o = pf.dead_reckoning(log, start=np.zeros(3))
    u = pf.increments(np.column_stack((np.zeros(3), o)))[:, 1:]
    return replace(log, u=u, rig=replace(log.rig, odometry="increments"))


def as_turns(log):
    o = np.column_stack((np.zeros(3), pf.dead_reckoning(log, start=np.zeros(3))))
    u = pf.odometry_control(o[:, :-1], o[:, 1:])
    return replace(log, u=u, rig=replace(log.rig, odometry="turns"))


@pytest.mark.parametrize("other", [as_increments, as_turns])
def test_odometry_in_any_form_is_the_same_drive(other):
    log = drive()
    told = other(log)
    np.testing.assert_allclose(pf.dead_reckoning(told)[:2], pf.dead_reckoning(log)[:2], atol=1e-9)
    assert rmse(told) < 0.1 and rmse(log) < 0.1


@pytest.mark.parametrize("kind", [pf.Range, pf.Bearing])
def test_ranges_or_bearings_alone(kind):
    sensor = kind(worlds.arena(), 0.1 if kind is pf.Range else 0.02)
    assert rmse(drive(sensor)) < 0.25


def test_landmarks_without_names_are_stated_not_guessed():
    log = drive(pf.MaximumLikelihood(pf.RangeBearing(worlds.arena(), 0.1, 0.02)))
    assert not log.rig.named and log.z[0].shape[0] == 2
    assert rmse(log) < 0.15
    with pytest.raises(pf.DataError, match="does not say what its numbers mean"):
        settings_for(replace(log, rig=None))
    with pytest.raises(pf.DataError, match="has 3 rows"):
        replace(log, rig=pf.Rig("range-bearing"))


def test_a_mounting_that_is_stated_is_used():
    log = drive(pf.Mounted(pf.RangeBearing(worlds.arena(), 0.1, 0.02), (0.4, 0.2, 0.3)))
    assert rmse(log) < 0.12
    assert rmse(replace(log, rig=replace(log.rig, mount=(0, 0, 0)))) > 0.3


def test_recovery_finds_a_robot_that_was_carried_off():
    log = drive(kidnap={60: [8.0, 6.0, 2.0]})
    ends = []
    for recover in (False, True):
        track = localise(log, np.random.default_rng(0), "known", 500, 4, recover=recover)
        ends.append(np.hypot(*(track.estimate[:2, -1] - log.truth[:2, -1, None])))
    assert (ends[1] < 0.5).all()
    assert (ends[0] > 3).all()


def test_a_symmetric_world_is_answered_with_hypotheses_and_masses():
    world = worlds.square()
    sensor = pf.MaximumLikelihood(pf.RangeBearing(world, 0.2, 0.05))
    driver = pf.PurePursuit(worlds.SQUARE_ROUTE, v=1.0, dt=0.5)
    log = drive(sensor, start=worlds.SQUARE_START, u=driver, steps=25)
    settings = settings_for(log)
    rng = np.random.default_rng(0)
    track = localise(log, rng, "global", 20000, settings=settings, plain=True)
    t, mass, mean = track.hypotheses
    assert t.size and mean.shape == (3, t.size)
    last = t == t[-1]
    assert last.sum() > 1 and mass[last].sum() <= 1 + 1e-9
    assert localise(log, np.random.default_rng(0), "known", 500).hypotheses.t.size == 0


def test_a_robot_that_stands_does_not_look_again_and_lost_beams_do_not_count():
    laser = pf.BeamModel(worlds.office(), np.linspace(-2, 2, 91), 3.0, 0.03)
    u = np.concatenate((np.tile([[0.0], [0.0], [0.2]], 20), worlds.arena_route()[:, :4]), axis=1)
    log = drive(laser, start=worlds.OFFICE_START, u=u)
    looked = thinned(log, pf.Drift())
    counts = [zk.shape[1] for zk in looked.z]
    assert counts[0] > 0 and sum(counts[1:20]) == 0 and counts[20] > 0
    assert max(counts) <= 30 and all((zk[0] < 3.0).all() for zk in looked.z)


@pytest.fixture
def saved(tmp_path):
    pf.save_log(drive(), tmp_path / "log")
    return tmp_path / "log"


def run(saved, capsys, *options):
    code = main(["localise", str(saved), "--particles", "300", "--out", str(saved / "o"), *options])
    return code, capsys.readouterr()


def test_a_saved_log_comes_back_and_is_localised(saved, capsys):
    log = pf.load_log(saved)
    assert log.rig == pf.Rig("range-bearing")
    code, said = run(saved, capsys)
    assert code == 0 and float(said.out.split("filter ")[1].split()[0]) < 0.15


@pytest.mark.parametrize(
    "options",
    [
        ("--pose", "3,2,0"),
        ("--sigma", "0.2,0.03"),
        ("--drift", "0.1,0.1"),
        ("--bounds", "0,10,0,8", "--start", "global"),
        ("--mount", "0,0,0"),
        ("--recover",),
        ("--unnamed",),
    ],
)
def test_options_are_taken(saved, capsys, options):
    code, said = run(saved, capsys, *options)
    assert code == 0 and "error below" in said.out


@pytest.mark.parametrize(
    "options, reason",
    [
        (("--pose", "3,2"), "--pose takes 3 numbers"),
        (("--pose", "3,2,x"), "--pose takes 3 numbers"),
        (("--pose", "3,2,0", "--start", "global"), "give one of them"),
        (("--sigma", "-1"), "> 0"),
        (("--drift", "0.1"), "--drift takes 2 numbers"),
        (("--bounds", "1,0,0,8"), "bounds"),
        (("--mount", "0,0,0,upside"), "--mount takes 3 numbers"),
        (("--sensor", "laser"), "the log says it is a range-bearing"),
    ],
)
def test_options_that_are_wrong_are_one_line(saved, capsys, options, reason):
    code, said = run(saved, capsys, *options)
    assert code == 2 and reason in said.err and len(said.err.splitlines()) == 1


def test_a_pose_needs_no_truth(saved, capsys):
    (saved / "start.txt").unlink()
    assert run(saved, capsys)[0] == 2
    code, _ = run(saved, capsys, "--pose", "3,2,0")
    assert code == 0
