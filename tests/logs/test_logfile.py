"""A log that is saved comes back as it was; a damaged folder is named."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds

MOTION = pf.VelocityMotion()
SENSOR = pf.RangeBearing(worlds.arena(), 0.2, 0.1)


def make_log(**more):
    return pf.simulate_log(
        worlds.ARENA_START,
        worlds.arena_route()[:, :20],
        MOTION,
        SENSOR,
        np.random.default_rng(2),
        sight=pf.FieldOfView(worlds.arena(), r_max=5.0),
        source="a test",
        **more,
    )


def assert_equal(a, b):
    np.testing.assert_array_equal(a.t, b.t)
    np.testing.assert_array_equal(a.u, b.u)
    np.testing.assert_array_equal(a.truth, b.truth)
    np.testing.assert_array_equal(a.start, b.start)
    for one, other in zip(a.z, b.z, strict=True):
        np.testing.assert_array_equal(one, other)
    assert a.source == b.source


def test_a_log_comes_back_bit_for_bit(tmp_path):
    log = make_log(every=3, outliers=pf.Outliers(0.4, (0.0, -3.0), (5.0, 3.0)))
    pf.save_log(log, tmp_path / "new" / "folder")
    back = pf.read_log(tmp_path / "new" / "folder")
    assert_equal(log, back)
    for one, other in zip(log.outlier, back.outlier, strict=True):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(back.world.positions, log.world.positions)
    assert back.world.bounds == log.world.bounds


def test_few_digits_make_small_files(tmp_path):
    log = make_log()
    pf.save_log(log, tmp_path, digits=5)
    back = pf.read_log(tmp_path)
    np.testing.assert_allclose(back.truth, log.truth, rtol=1e-4)
    assert (tmp_path / "steps.txt").stat().st_size < 20 * 50


def test_a_log_without_truth_measurements_or_map(tmp_path):
    bare = pf.Log(np.arange(3.0), np.ones((2, 3)), [np.empty((2, 0))] * 3)
    pf.save_log(bare, tmp_path)
    back = pf.read_log(tmp_path)
    assert back.truth is None and back.start is None and back.world is None
    assert back.outlier is None
    assert [zk.shape for zk in back.z] == [(2, 0)] * 3


def test_a_grid_is_saved_as_a_ros_map(tmp_path):
    log = pf.Log(np.ones(1), np.ones((3, 1)), [np.ones((2, 4))], world=worlds.office())
    pf.save_log(log, tmp_path)
    np.testing.assert_array_equal(pf.read_log(tmp_path).world.occupied, log.world.occupied)


def test_a_batch_is_refused(tmp_path):
    log = pf.simulate_log(
        worlds.ARENA_START,
        pf.PurePursuit([[0, 5], [0, 5]], 1.0, 0.1),
        MOTION,
        SENSOR,
        np.random.default_rng(),
        batch=2,
        steps=3,
    )
    with pytest.raises(pf.ShapeError, match="single"):
        pf.save_log(log, tmp_path)


@pytest.mark.parametrize("name", ["steps.txt", "bounds.txt"])
def test_a_missing_file_is_named(tmp_path, name):
    pf.save_log(make_log(), tmp_path)
    (tmp_path / name).unlink()
    with pytest.raises(FileNotFoundError, match=name):
        pf.read_log(tmp_path)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("steps.txt", "", "line 1"),
        ("steps.txt", "1 2 3\n", "line 1"),
        ("steps.txt", "# time u1\n0 1\n1 nan\n", "line 3"),
        ("measurements.txt", "# step z1\n0.5 1\n", "whole numbers"),
        ("measurements.txt", "# step z1\n99 1\n", "whole numbers"),
        ("measurements.txt", "# step z1\n3 1\n2 1\n", "sort"),
        ("landmarks.txt", "# id x y\n1 2\n", "line 2"),
    ],
)
def test_a_damaged_folder_is_named(tmp_path, name, text, message):
    pf.save_log(make_log(), tmp_path)
    (tmp_path / name).write_text(text)
    with pytest.raises(pf.DataError, match=message):
        pf.read_log(tmp_path)


@pytest.mark.parametrize("name", ["save_log", "read_log", "load_log"])
def test_each_can_be_the_first_that_is_used(name):
    code = f"import pfkit; pfkit.{name}"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=Path(__file__).parents[2])
