"""Loaders: what a log folder must hold, and what is said when it does not."""

import gzip
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.logs.datasets import LAYOUTS, find_folder, load_log, load_mrclam, load_plaza
from pfkit.logs.datasets.text import in_order, read_table
from pfkit.logs.datasets.timeline import held_controls, interpolate_poses

DATA = Path(__file__).parents[2] / "data"
SMALL = {
    "Robot1_Odometry.dat": "# time v omega\n10.0 0.1 0.0\n10.5 0.2 0.1\n11.0 0.0 0.0\n",
    "Robot1_Measurement.dat": "10.25 63 2.0 0.5\n10.5 5 1.0 0.1\n10.5 25 3.0 -0.5\n",
    "Robot1_Groundtruth.dat": "10.0 0 0 3.1\n10.5 0.05 0 -3.1\n11.0 0.15 0 -3.0\n",
    "Landmark_Groundtruth.dat": "10 1.0 2.0 0.01 0.01\n19 -1.0 2.0 0.01 0.01\n",
    "Barcodes.dat": "1 5\n10 63\n19 25\n",
}
FILES = list(SMALL)


@pytest.fixture
def folder(tmp_path):
    for name, text in SMALL.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def test_streams_become_one_timeline(folder):
    log = load_mrclam(folder)
    np.testing.assert_allclose(log.t, [0.0, 0.25, 0.5, 1.0])
    np.testing.assert_allclose(
        log.u, [[0, 0.1, 0.1, 0.2], [0, 0, 0, 0.1], [0, 0.25, 0.25, 0.5]], atol=1e-12
    )
    assert log.scored.tolist() == [True, False, True, True]


def test_bar_codes_become_subjects_and_robots_are_dropped(folder):
    log = load_mrclam(folder)
    assert [zk.shape for zk in log.z] == [(3, 0), (3, 1), (3, 1), (3, 0)]
    np.testing.assert_allclose(log.z[1][:, 0], [2.0, 0.5, 10])
    np.testing.assert_allclose(log.z[2][:, 0], [3.0, -0.5, 19])


def test_truth_is_interpolated_on_the_circle(folder):
    log = load_mrclam(folder)
    assert abs(abs(log.truth[2, 1]) - np.pi) < 0.03
    np.testing.assert_allclose(log.start, [0, 0, 3.1])


def test_truth_is_unknown_in_a_gap():
    t = np.array([0.0, 0.4, 1.5, 2.7, 3.0])
    poses = interpolate_poses(t, np.array([0.0, 3.0]), np.array([[0, 3], [0, 0], [0, 0.0]]))
    assert np.isnan(poses[0]).tolist() == [False, False, True, False, False]


def test_a_command_holds_until_the_next():
    u = held_controls(
        np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 2.0]), np.array([1.0, 5.0]), np.zeros(2)
    )
    np.testing.assert_allclose(u, [[0, 1, 1, 5], [0, 0, 0, 0], [0, 1, 1, 1]])


def test_both_layouts_give_the_same_log(folder, tmp_path_factory):
    other = tmp_path_factory.mktemp("prefixed")
    for name in FILES:
        shutil.copy(folder / name, other / ("ds0_" + name.removeprefix("Robot1_")))
    a, b = load_mrclam(folder), load_mrclam(other)
    np.testing.assert_array_equal(a.t, b.t)
    np.testing.assert_array_equal(a.u, b.u)
    np.testing.assert_array_equal(a.truth, b.truth)
    assert all(np.array_equal(x, y) for x, y in zip(a.z, b.z, strict=True))


@pytest.mark.parametrize(
    "change",
    [
        lambda raw: raw.replace(b"\n", b"\r\n"),
        lambda raw: raw.replace(b"\n", b"\r"),
        lambda raw: b"\xef\xbb\xbf" + raw,
        lambda raw: b"# more\n\n" + raw.replace(b" ", b" \t "),
        lambda raw: raw.rstrip(b"\n"),
        lambda raw: raw.replace(b"\n", b"  # said later\n"),
        gzip.compress,
    ],
    ids=[
        "CRLF",
        "CR",
        "BOM",
        "comments and tabs",
        "no last newline",
        "late comments",
        "gzip inside",
    ],
)
@pytest.mark.parametrize("name", FILES)
def test_harmless_differences_change_nothing(folder, name, change):
    expected = load_mrclam(folder)
    path = folder / name
    path.write_bytes(change(path.read_bytes()))
    log = load_mrclam(folder)
    np.testing.assert_array_equal(log.u, expected.u)
    np.testing.assert_array_equal(log.truth, expected.truth)
    assert all(np.array_equal(x, y) for x, y in zip(log.z, expected.z, strict=True))


@pytest.mark.parametrize("name", FILES)
def test_gzipped_files_are_found_by_their_name(folder, name):
    expected = load_mrclam(folder)
    path = folder / name
    (folder / (name + ".gz")).write_bytes(gzip.compress(path.read_bytes()))
    path.unlink()
    np.testing.assert_array_equal(load_log(folder).u, expected.u)


DEFECTS = {
    "missing": (None, "no such file"),
    "empty": (lambda lines: [], "no rows"),
    "only comments": (lambda lines: ["# a", ""], "no rows"),
    "short row": (lambda lines: [*lines[:-1], lines[-1].split()[0]], "expected"),
    "long row": (lambda lines: [*lines[:-1], lines[-1] + " 1"], "expected"),
    "text": (lambda lines: [*lines[:-1], lines[-1].rsplit(" ", 1)[0] + " abc"], "'abc'"),
    "digits with underscores": (
        lambda lines: [*lines[:-1], lines[-1].rsplit(" ", 1)[0] + " 1_0"],
        "'1_0'",
    ),
    "NaN": (lambda lines: [*lines[:-1], lines[-1].rsplit(" ", 1)[0] + " nan"], "finite"),
    "infinite": (lambda lines: [*lines[:-1], lines[-1].rsplit(" ", 1)[0] + " inf"], "finite"),
}


@pytest.mark.parametrize("defect", DEFECTS)
@pytest.mark.parametrize("name", FILES)
def test_a_defect_is_one_line_with_file_line_and_reason(folder, name, defect):
    change, reason = DEFECTS[defect]
    path = folder / name
    lines = path.read_text().splitlines()
    if change is None:
        path.unlink()
    else:
        path.write_text("\n".join(change(lines)) + "\n")
    with pytest.raises(pf.DataError) as caught:
        load_mrclam(folder)
    message = str(caught.value)
    assert "\n" not in message and reason in message
    assert name.split("_", 1)[-1] in message
    if defect not in ("missing", "empty", "only comments"):
        assert f"line {len(lines)}:" in message


@pytest.mark.parametrize("name", ["Robot1_Odometry.dat", "Robot1_Groundtruth.dat"])
def test_time_must_not_run_backwards(folder, name):
    lines = (folder / name).read_text().splitlines()
    moved = [*lines[:-2], lines[-1], lines[-2].replace("10.5", "10.4")]
    (folder / name).write_text("\n".join(moved))
    with pytest.raises(pf.DataError, match=rf"line {len(lines)}: time runs backwards"):
        load_mrclam(folder)


def test_measurements_out_of_order_are_sorted_and_counted(folder):
    expected = load_mrclam(folder)
    path = folder / "Robot1_Measurement.dat"
    first, *rest = path.read_text().splitlines()
    path.write_text("\n".join([*rest, first]))
    log = load_mrclam(folder)
    assert all(np.array_equal(x, y) for x, y in zip(log.z, expected.z, strict=True))
    assert log.notes == (
        "Robot1_Measurement.dat: 1 rows were out of order and were sorted by time",
    )


def test_rows_of_one_instant_keep_their_order():
    table = np.array([[3.0, 1.0, 3.0, 1.0, 2.0], [0.0, 1.0, 2.0, 3.0, 4.0]])
    ordered, notes = in_order(Path("seen.dat"), table)
    assert ordered[1].tolist() == [1, 3, 4, 0, 2] and "3 rows" in notes[0]
    assert in_order(Path("seen.dat"), ordered)[1] == []


def set_back(path, by):
    """The second half of a file, `by` seconds earlier."""
    rows = np.loadtxt(path)
    rows[len(rows) // 2 :, 0] -= by
    np.savetxt(path, rows, "%.4f")
    return len(rows) // 2 + 1


@pytest.mark.parametrize("name", ["Odometry", "Measurement", "Groundtruth"])
def test_a_clock_that_jumped_back_is_named_as_that(tmp_path, name):
    shutil.copytree(DATA / "mrclam_twin", tmp_path / "p")
    (tmp_path / "p" / "Robot1_Outlier.dat").unlink()
    line = set_back(tmp_path / "p" / f"Robot1_{name}.dat", 10)
    with pytest.raises(pf.DataError, match=rf"line {line}: the clock jumps back by \S+ s.*cut"):
        load_mrclam(tmp_path / "p")


def test_one_landmark_after_the_other_is_no_jump_of_the_clock(tmp_path):
    shutil.copytree(DATA / "mrclam_twin", tmp_path / "p")
    (tmp_path / "p" / "Robot1_Outlier.dat").unlink()
    path = tmp_path / "p" / "Robot1_Measurement.dat"
    rows = np.loadtxt(path)
    np.savetxt(path, rows[np.argsort(rows[:, 1], kind="stable")], "%.4f")
    log, expected = load_mrclam(tmp_path / "p"), load_mrclam(DATA / "mrclam_twin")
    assert "sorted by time" in log.notes[0]
    assert all(
        np.array_equal(np.sort(x), np.sort(y)) for x, y in zip(log.z, expected.z, strict=True)
    )


@pytest.mark.parametrize("offset", [3600.0, -3600.0])
def test_a_clock_an_hour_off_is_named_as_that(folder, offset):
    path = folder / "Robot1_Measurement.dat"
    rows = np.loadtxt(path)
    rows[:, 0] += offset
    np.savetxt(path, rows, "%.3f")
    with pytest.raises(pf.DataError, match=rf"clocks do not agree.*[+]?{offset + 0.25:g} s apart"):
        load_mrclam(folder)


def test_an_unknown_bar_code_is_named_or_dropped(folder):
    path = folder / "Robot1_Measurement.dat"
    path.write_text("# seen\n10.25 63 2.0 0.5\n10.5 99 1.0 0.1\n")
    with pytest.raises(pf.DataError, match=r"Measurement.dat, line 3: bar code 99"):
        load_mrclam(folder)
    log = load_mrclam(folder, drop_unknown=True)
    assert sum(zk.shape[1] for zk in log.z) == 1


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("Barcodes.dat", "1 5\n10 5\n19 25\n", "line 2: bar code 5 is listed twice"),
        ("Barcodes.dat", "1 5\n10 6.5\n19 25\n", "line 2: bar code must be whole"),
        ("Barcodes.dat", "1 5\n10.5 63\n19 25\n", "line 2: subject must be whole"),
        ("Landmark_Groundtruth.dat", "#\n10 1 2 0 0\n10 1 2 0 0\n", "line 3: subject 10 is listed"),
        ("Landmark_Groundtruth.dat", "10 1e20 2 0 0\n", "line 1: x is 1e20, which is absurd"),
        ("Robot1_Odometry.dat", "1.7e18 0 0\n", "line 1: time is 1.7e18, which is absurd"),
        ("Robot1_Measurement.dat", "10.25 63 -2.0 0.5\n", "line 1: range must be >= 0, got -2"),
    ],
)
def test_tables_must_make_sense(folder, name, text, reason):
    (folder / name).write_text(text)
    with pytest.raises(pf.DataError, match=rf"{name}, {reason}"):
        load_mrclam(folder)


def test_a_log_without_truth_is_read_if_none_is_needed(folder):
    expected = load_mrclam(folder)
    (folder / "Robot1_Groundtruth.dat").unlink()
    with pytest.raises(pf.DataError, match=r"Groundtruth.dat: no such file.*--start global"):
        load_log(folder)
    log = load_log(folder, need_truth=False)
    assert log.truth is None and log.start is None
    np.testing.assert_array_equal(log.u, expected.u)
    assert [zk.shape for zk in log.z] == [zk.shape for zk in expected.z]


def test_plaza_without_truth_is_the_same_drive(tmp_path):
    shutil.copytree(DATA / "plaza2", tmp_path / "p")
    (tmp_path / "p" / "truth.txt").unlink()
    with pytest.raises(pf.DataError, match="global"):
        load_plaza(tmp_path / "p")
    log, known = load_plaza(tmp_path / "p", need_truth=False), load_plaza(DATA / "plaza2")
    assert log.truth is None
    way, expected = ((one.u[:2] * one.u[2]).sum(axis=1) for one in (log, known))
    np.testing.assert_allclose(way, expected, rtol=1e-3)


def test_a_file_that_is_no_text(folder):
    (folder / "Barcodes.dat").write_bytes(b"1 5\n10 63\n\xff\xfe\x00")
    with pytest.raises(pf.DataError, match=r"Barcodes.dat, line 3: not a text file"):
        load_mrclam(folder)


def test_a_cut_gzip_file(folder):
    path = folder / "Barcodes.dat"
    path.write_bytes(gzip.compress(path.read_bytes())[:-6])
    with pytest.raises(pf.DataError, match="cannot be read"):
        load_mrclam(folder)


def test_several_robots_need_a_choice(folder):
    for name in FILES[:3]:
        shutil.copy(folder / name, folder / name.replace("Robot1", "Robot2"))
    with pytest.raises(pf.DataError, match="robot=N"):
        load_mrclam(folder)
    assert len(load_mrclam(folder, robot=2)) == 4
    with pytest.raises(pf.DataError, match="Robot7_Odometry"):
        load_mrclam(folder, robot=7)


@pytest.mark.parametrize("variable", ["parent", "itself"])
def test_folders_are_found_by_the_environment(folder, monkeypatch, variable):
    place = folder.parent if variable == "parent" else folder
    monkeypatch.setenv("PFKIT_DATA", str(place))
    assert len(load_mrclam(folder.name if variable == "parent" else None)) == 4


def test_a_missing_folder_says_where_to_get_one(monkeypatch):
    monkeypatch.delenv("PFKIT_DATA", raising=False)
    with pytest.raises(pf.DataError, match=r"asrl\.utias"):
        find_folder("no_such_log")


def test_a_folder_of_no_known_layout_is_answered_with_what_there_is_and_what_is_missing(tmp_path):
    (tmp_path / "wheels.csv").write_text("t,v\n0,1\n")
    with pytest.raises(pf.DataError, match=r"There is wheels\.csv\.") as caught:
        load_log(tmp_path)
    for layout in LAYOUTS.values():
        assert layout.needs in str(caught.value)


@pytest.mark.parametrize("T", [1, 2, 1000])
def test_reading_inverts_writing(tmp_path, T):
    table = np.random.default_rng(3).normal(size=(3, T)).round(6)
    np.savetxt(tmp_path / "t.dat", table.T, "%.6f")
    np.testing.assert_array_equal(read_table(tmp_path / "t.dat", ("a", "b", "c")), table)


def test_plaza_starts_where_the_truth_starts_and_looks_ahead():
    log = load_plaza(DATA / "plaza2")
    assert log.t[0] == 0 and sum(zk.shape[1] for zk in log.z) == 1816
    way = np.diff(log.truth[:2], axis=1)
    ahead = (way * [np.cos(log.truth[2, 1:]), np.sin(log.truth[2, 1:])]).sum(axis=0)
    assert (ahead > 0).mean() > 0.95
    driven = (log.u[0] * log.u[2]).sum()
    assert driven == pytest.approx(1354, abs=10)


@pytest.mark.parametrize(
    ("name", "row", "reason"),
    [
        ("ranges.txt", "3700 2 77 10.0", "line 1818: beacon 77"),
        ("ranges.txt", "3700 2 1 -10.0", "line 1818: range must be >= 0"),
        ("beacons.txt", "1.5 0 0", "line 6: beacon must be whole"),
        ("beacons.txt", "1 0 0", "line 6: beacon 1 is listed twice"),
    ],
)
def test_plaza_names_a_row_that_makes_no_sense(tmp_path, name, row, reason):
    shutil.copytree(DATA / "plaza2", tmp_path / "p")
    with (tmp_path / "p" / name).open("a") as file:
        file.write(row + "\n")
    with pytest.raises(pf.DataError, match=rf"{name}, {reason}"):
        load_plaza(tmp_path / "p")


def test_plaza_needs_time_to_pass(tmp_path):
    shutil.copytree(DATA / "plaza2", tmp_path / "p")
    path = tmp_path / "p" / "odometry.txt"
    path.write_text(path.read_text() + path.read_text().splitlines()[-1] + "\n")
    with pytest.raises(pf.DataError, match=r"odometry.txt, line \d+: no time passed"):
        load_plaza(tmp_path / "p")


def test_the_twin_has_labels_of_false_measurements():
    log = load_mrclam(DATA / "mrclam_twin")
    false = np.concatenate(log.outlier)
    assert 0.01 < false.mean() < 0.04
    x, y, theta = np.hstack([log.truth[:, [k] * zk.shape[1]] for k, zk in enumerate(log.z)])
    _, phi, s = np.hstack(log.z)
    mx, my = log.world.locate(s)
    error = pf.wrap(phi - np.arctan2(my - y, mx - x) + theta)
    assert np.median(abs(error[false])) > 20 * np.median(abs(error[~false]))


def test_the_twin_is_what_its_script_makes(tmp_path):
    tool = DATA.parent / "tools" / "make_twin.py"
    subprocess.run([sys.executable, tool, tmp_path], check=True, timeout=100)
    for path in (DATA / "mrclam_twin").iterdir():
        new, kept = np.loadtxt(tmp_path / path.name), np.loadtxt(path)
        np.testing.assert_allclose(new, kept, atol=0.0011)  # the last printed digit may turn
