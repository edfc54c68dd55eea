"""CARMEN logs, written here by the rules of the format and read back."""

from dataclasses import replace

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds
from pfkit.judging.localise import localise, score, settings_for

T0 = 1_000_000_000.0


@pytest.fixture(scope="module")
def drive():
    """A drive through the office: the truth, an odometer that drifts, and 61 beams a scan."""
    rng = np.random.default_rng(5)
    angles = np.linspace(-np.pi / 2, np.pi / 2, 61)
    laser = pf.BeamModel(worlds.office(), angles, 8.0, 0.03, 1.0, 0.9, 0.03, 0.03, 0.04)
    driver = pf.PurePursuit(worlds.OFFICE_ROUTE, v=0.5, dt=0.2)
    return pf.simulate_log(
        worlds.OFFICE_START,
        driver,
        pf.VelocityMotion((0.005, 0.001, 0.001, 0.005)),
        laser,
        rng,
        steps=150,
    )


def lines(log, kind="ROBOTLASER1", seat=(0.0, 0.0, 0.0), corrected=False, truth=False):
    """The log as CARMEN writes it."""
    odometer = pf.dead_reckoning(log, start=np.zeros(3))
    for k, (t, _, z, x) in enumerate(log):
        o, tail = odometer[:, k], f"{T0 + t:.6f} host {T0 + t + 0.01:.6f}"
        yield f"ODOM {o[0]:.6f} {o[1]:.6f} {o[2]:.6f} 0.5 0.0 0.0 {tail}"
        if truth:
            yield f"TRUEPOS {x[0]:.6f} {x[1]:.6f} {x[2]:.6f} {o[0]} {o[1]} {o[2]} {tail}"
        first = x if corrected else pf.compose(o, seat)
        poses = " ".join(f"{v:.6f}" for v in (*first, *o))
        ranges = " ".join(f"{v:.4f}" for v in z[0])
        n = z.shape[1]
        if kind == "FLASER":
            yield f"FLASER {n} {ranges} {poses} {tail}"
        else:
            start, step = z[1, 0], z[1, 1] - z[1, 0]
            yield (
                f"ROBOTLASER1 0 {start:.8f} {step * (n - 1):.8f} {step:.8f} 8.0 0.01 0 {n} "
                f"{ranges} 0 {poses} 0.5 0.0 0.2 0.2 0.1 {tail}"
            )


def write(folder, log, **options):
    text = "# CARMEN Logfile\nSYNC a\n" + "\n".join(lines(log, **options)) + "\n"
    (folder / "drive.log").write_text(text)
    log.world.save(folder / "map.yaml")


@pytest.mark.parametrize("kind", ["FLASER", "ROBOTLASER1"])
def test_what_is_written_is_read(tmp_path, drive, kind):
    write(tmp_path, drive, kind=kind, truth=True)
    log = pf.load_log(tmp_path)
    assert log.rig == pf.Rig("laser", "increments", r_max=8.0)
    np.testing.assert_allclose(log.t, drive.t - drive.t[0], atol=1e-5)
    np.testing.assert_allclose(log.truth[:2], drive.truth[:2], atol=1e-5)
    for got, sent in zip(log.z, drive.z, strict=True):
        np.testing.assert_allclose(got, sent, atol=1e-4)
    moved = pf.dead_reckoning(log, start=np.zeros(3))
    expected = pf.dead_reckoning(drive, start=np.zeros(3))
    expected = pf.between(expected[:, :1], expected)
    np.testing.assert_allclose(moved[:2], expected[:2], atol=1e-4)


def test_the_laser_in_the_office_is_localised_to_five_centimetres(tmp_path, drive):
    write(tmp_path, drive, truth=True)
    log = pf.load_log(tmp_path)
    settings = settings_for(log)
    track = localise(log, np.random.default_rng(0), batch=3, settings=settings)
    assert (score(log, track.estimate, settings.limit).rmse < 0.05).all()
    assert score(log, pf.dead_reckoning(log), settings.limit).rmse > 0.15


def test_a_pose_that_differs_by_the_same_motion_is_the_mounting(tmp_path, drive):
    write(tmp_path, drive, seat=(0.22, 0.0, 0.08), truth=True)
    log = pf.load_log(tmp_path)
    np.testing.assert_allclose(log.rig.mount, (0.22, 0, 0.08), atol=1e-4)
    assert "turned by 4.6 degrees" in log.notes[0]


def test_corrected_poses_are_the_truth(tmp_path, drive):
    write(tmp_path, drive, corrected=True, kind="FLASER")
    log = pf.load_log(tmp_path)
    np.testing.assert_allclose(log.truth[:2], drive.truth[:2], atol=1e-5)
    assert "corrected poses" in log.notes[0]


def test_without_truth_it_is_read_if_none_is_needed(tmp_path, drive):
    write(tmp_path, drive)
    with pytest.raises(pf.DataError, match=r"drive\.log: no truth in it .*--start global"):
        pf.load_log(tmp_path)
    assert pf.load_log(tmp_path, need_truth=False).truth is None


def test_the_map_may_lie_elsewhere_and_must_be_one(tmp_path, drive):
    write(tmp_path, drive, truth=True)
    (tmp_path / "maps").mkdir()
    for name in ("map.yaml", "map.pgm"):
        (tmp_path / name).rename(tmp_path / "maps" / name)
    with pytest.raises(pf.DataError, match=r"needs one map .* found none; name it with --map"):
        pf.load_log(tmp_path)
    assert pf.load_log(tmp_path, map=tmp_path / "maps" / "map.yaml").world.p.shape == (80, 120)


BAD = {
    "cut": (lambda text: text[:-120], r"line \d+: ROBOTLASER1 is cut short"),
    "a word": (lambda text: text.replace("ODOM 0", "ODOM near", 1), r"line \d+: ODOM is cut"),
    "infinite": (lambda text: text.replace("ODOM 0", "ODOM inf", 1), r"line \d+: ODOM is cut"),
    "no scans": (
        lambda text: "\n".join(x for x in text.splitlines() if "LASER" not in x),
        "no scan in it",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_what_is_wrong_is_named(tmp_path, drive, case):
    write(tmp_path, replace(drive, truth=drive.truth), truth=True)
    change, reason = BAD[case]
    path = tmp_path / "drive.log"
    path.write_text(change(path.read_text()))
    with pytest.raises(pf.DataError, match=rf"drive\.log.*{reason}"):
        pf.load_log(tmp_path)


def test_a_clock_that_jumped_back(tmp_path, drive):
    write(tmp_path, drive, truth=True)
    rows = (tmp_path / "drive.log").read_text().splitlines()
    half = len(rows) // 2
    late = [row.replace(f"{T0:.0f}"[:7], "0999999") for row in rows[half:]]
    (tmp_path / "drive.log").write_text("\n".join([*rows[:half], *late]))
    with pytest.raises(pf.DataError, match="clock of ODOM jumps back by"):
        pf.load_log(tmp_path)
