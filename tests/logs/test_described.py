"""Tables of one's own: the same drive in other columns, units and frames; drafts; what is wrong."""

from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.__main__ import main
from pfkit.logs.datasets.describe import describe

T0 = 1_700_000_000.0


@pytest.fixture(scope="module")
def drive():
    return pf.simulate_log(
        pf.worlds.ARENA_START,
        pf.worlds.arena_route(),
        pf.VelocityMotion((0.005, 0.001, 0.001, 0.005)),
        pf.RangeBearing(pf.worlds.arena(), 0.1, 0.02),
        np.random.default_rng(4),
        every=2,
    )


def table(path, header, *columns):
    rows = np.stack(columns, axis=1)
    text = [header, *(",".join(f"{v:.9g}" for v in row) for row in rows)]
    path.write_text("\n".join(text) + "\n")


def write(folder, log, units=(1, 1, 1), frame="enu", kind="speeds"):
    """Write a drive; `units` multiply seconds, metres and radians. Time is that of each row."""
    second, metre, radian = units
    clockwise = 1 if frame == "enu" else -1
    t = log.t * second
    if kind == "speeds":  # a row holds from its stamp on
        starts = (log.t - log.u[2]) * second
        v, w = log.u[0] * metre, clockwise * log.u[1] * radian
        end = (np.append(c, last) for c, last in zip((starts, v, w), (t[-1], 0, 0), strict=True))
        table(folder / "wheels.csv", "t,vel,gyro", *end)
    elif kind == "increments":
        turn = clockwise * log.u[1] * log.u[2] * radian
        table(folder / "wheels.csv", "t,distance,turn", t, log.u[0] * log.u[2] * metre, turn)
    else:
        o = np.column_stack((np.zeros(3), pf.dead_reckoning(log, start=np.zeros(3))))
        table(folder / "wheels.csv", "t,x,y,theta", np.append(0, t), *seen(o, frame, metre, radian))
    k = np.repeat(np.arange(len(log)), [zk.shape[1] for zk in log.z])
    r, phi, s = np.hstack(log.z)
    table(folder / "seen.csv", "t,dist,angle,id", t[k], r * metre, clockwise * phi * radian, s)
    x, y, theta = seen(log.truth, frame, metre, radian)
    table(folder / "truth.csv", "t,x,y,heading", t, x, y, theta)
    x, y = seen(np.vstack((log.world.positions, log.world.ids * 0)), frame, metre, radian)[:2]
    table(folder / "map.csv", "id,x,y", log.world.ids, x, y)


def seen(pose, frame, metre, radian):
    """Poses as another frame has them."""
    x, y, theta = pose
    if frame != "enu":
        theta = pf.wrap(np.pi / 2 - theta)
    if frame == "ned":
        x, y = y, x
    return x * metre, y * metre, theta * radian


def said(kind="speeds", frame="enu", s="s", m="m", rad="rad"):
    columns = {
        "speeds": f"v: {{column: vel, unit: {m}/s}}\n  omega: {{column: gyro, unit: {rad}/s}}",
        "increments": f"distance: {{column: distance, unit: {m}}}\n"
        f"  turn: {{column: turn, unit: {rad}}}",
        "poses": f"x: {{column: x, unit: {m}}}\n  y: {{column: y, unit: {m}}}\n"
        f"  theta: {{column: theta, unit: {rad}}}",
    }[kind]
    time = f"time: {{column: t, unit: {s}}}"
    xy = f"x: {{column: x, unit: {m}}}\n  y: {{column: y, unit: {m}}}"
    return f"""frame: {frame}
odometry:
  file: wheels.csv
  kind: {kind}
  {time}
  {columns}
measurements:
  file: seen.csv
  sensor: range-bearing
  {time}
  range: {{column: dist, unit: {m}}}
  bearing: {{column: angle, unit: {rad}}}
  landmark: {{column: id}}
landmarks:
  file: map.csv
  landmark: {{column: id}}
  {xy}
truth:
  file: truth.csv
  {time}
  {xy}
  theta: {{column: heading, unit: {rad}}}
"""


@pytest.mark.parametrize("kind", ["speeds", "increments", "poses"])
@pytest.mark.parametrize("frame", ["enu", "ned", "compass"])
@pytest.mark.parametrize("units", [("s", "m", "rad"), ("ms", "mm", "deg")])
def test_any_columns_units_and_frame_give_the_same_drive(tmp_path, drive, kind, frame, units):
    factor = {"s": 1, "m": 1, "rad": 1, "ms": 1e3, "mm": 1e3, "deg": 180 / np.pi}
    write(tmp_path, drive, [factor[unit] for unit in units], frame, kind)
    (tmp_path / "log.yaml").write_text(said(kind, frame, *units))
    log = pf.load_log(tmp_path)
    assert log.notes == ()
    np.testing.assert_allclose(np.hstack(log.z), np.hstack(drive.z), atol=1e-5)
    np.testing.assert_allclose(log.truth[:, -1], drive.truth[:, -1], atol=1e-5)
    path, expected = (pf.dead_reckoning(one, start=np.zeros(3)) for one in (log, drive))
    first = np.searchsorted(log.t, drive.t[0] - 1e-6)
    moved = pf.between(path[:, first], path[:, -1])
    np.testing.assert_allclose(moved, pf.between(expected[:, 0], expected[:, -1]), atol=1e-4)


def test_a_clock_offset_is_added(tmp_path, drive):
    write(tmp_path, drive)
    text = said().replace(
        "sensor: range-bearing\n  time: {column: t, unit: s}",
        "sensor: range-bearing\n  time: {column: t, unit: s, offset: -0.25}",
    )
    (tmp_path / "log.yaml").write_text(text)
    moved = pf.load_log(tmp_path)
    (tmp_path / "log.yaml").write_text(said())
    plain = pf.load_log(tmp_path)
    assert moved.t[moved.first_measured()] == pytest.approx(plain.t[plain.first_measured()] - 0.25)


def test_without_names_mounted_and_bounded(tmp_path, drive):
    write(tmp_path, drive)
    text = said().replace("  landmark: {column: id}\nlandmarks", "landmarks")
    text += "mount: [0.1, 0, 0.2]\nflipped: true\nbounds: [0, 10, 0, 8]\n"
    (tmp_path / "log.yaml").write_text(text)
    log = pf.load_log(tmp_path)
    assert log.rig == pf.Rig("range-bearing", named=False, mount=(0.1, 0, 0.2), flipped=True)
    assert log.world.bounds == (0, 10, 0, 8) and np.hstack(log.z).shape[0] == 2


@pytest.mark.parametrize("units", [(1, 1, 1), (1e3, 1e3, 180 / np.pi)])
def test_a_draft_of_these_tables_is_right(tmp_path, drive, units, capsys):
    write(tmp_path, drive, units)
    assert main(["describe", str(tmp_path)]) == 0
    text = capsys.readouterr().out
    assert "guess" in text and (tmp_path / "log.yaml").read_text() in text
    drafted = pf.load_log(tmp_path)
    (tmp_path / "log.yaml").write_text(
        said() if units == (1, 1, 1) else said(s="ms", m="mm", rad="deg")
    )
    log = pf.load_log(tmp_path)
    np.testing.assert_array_equal(drafted.u, log.u)
    np.testing.assert_array_equal(np.hstack(drafted.z), np.hstack(log.z))
    np.testing.assert_array_equal(drafted.truth, log.truth)
    with pytest.raises(pf.DataError, match="is there already"):
        describe(tmp_path)


def test_a_draft_says_what_is_missing_and_a_folder_without_tables_is_refused(tmp_path):
    (tmp_path / "notes.txt").write_text("We drove twice round the hall.\n")
    with pytest.raises(pf.DataError, match="no table of numbers"):
        describe(tmp_path)
    table(tmp_path / "track.csv", "stamp_ms,x,y", np.arange(9.0), np.arange(9.0), np.arange(9.0))
    text = describe(tmp_path)
    assert "# odometry: no file seems to hold it" in text and "unit: ms" in text


def test_the_command_localises_what_is_described(tmp_path, drive, capsys):
    write(tmp_path, drive, kind="poses")
    (tmp_path / "log.yaml").write_text(said("poses"))
    line = f"localise {tmp_path} --particles 300 --out {tmp_path / 'o'}"
    assert main(line.split()) == 0
    rmse = float(capsys.readouterr().out.split("filter ")[1].split()[0])
    assert rmse < 0.15


BAD = {
    "no frame": (("frame: enu\n", ""), "frame must be one of enu, ned, compass, got None"),
    "another frame": (("frame: enu", "frame: utm"), "got 'utm'"),
    "another unit": (
        ("vel, unit: m/s", "vel, unit: knots"),
        "v of wheels.csv needs a unit, one of",
    ),
    "no unit": (("vel, unit: m/s", "vel"), "needs a unit.*got ''"),
    "another column": (("column: vel", "column: speed"), "no column 'speed'; it has t, vel, gyro"),
    "a column too far": (("column: vel", "column: 9"), "no column 9; it has 1 to 3"),
    "another kind": (("kind: speeds", "kind: ticks"), "odometry needs kind, one of"),
    "another sensor": (("sensor: range-bearing", "sensor: sonar"), "measurements need sensor"),
    "no measurements": (("measurements:", "seen:"), "'seen' is none of"),
    "no file": (("file: seen.csv", "file: other.csv"), "other.csv: no such file"),
    "no YAML": (("frame: enu", "frame: [enu"), "no sound YAML"),
    "bad bounds": (("frame: enu", "frame: enu\nbounds: [1, 2]"), "bounds must have shape"),
    "bad mount": (("frame: enu", "frame: enu\nmount: [1, 2]"), "mount must have"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_description_that_is_wrong(tmp_path, drive, case):
    write(tmp_path, drive)
    (old, new), reason = BAD[case]
    (tmp_path / "log.yaml").write_text(said().replace(old, new, 1))
    with pytest.raises(pf.DataError, match=reason):
        pf.load_log(tmp_path)


SPOILED = {
    "empty": (lambda lines: [], "no rows of numbers"),
    "names only": (lambda lines: lines[:1], "a line of names and no rows"),
    "a short row": (lambda lines: [*lines, "9,9"], r"line \d+: expected 4 columns, got 2"),
    "a word": (lambda lines: [*lines, "18,near,0,1"], r"line \d+: 'near' is no number"),
    "not finite": (lambda lines: [*lines, "18,nan,0,1"], r"line \d+: nan is not finite"),
    "negative": (lambda lines: [*lines, "18,-1,0,1"], r"line \d+: range is -1"),
    "a stranger": (lambda lines: [*lines, "18,1,0,77"], "landmark 77 is not in the map"),
    "an hour off": (
        lambda lines: [lines[0], *(_later(line, 3600) for line in lines[1:])],
        "clocks do not agree",
    ),
    "mixed units": (
        lambda lines: [lines[0], *(_degrees(line) for line in lines[1:])],
        r"bearing of seen.csv reaches .* is it deg\?",
    ),
}


def _later(line, seconds):
    t, rest = line.split(",", 1)
    return f"{float(t) + seconds},{rest}"


def _degrees(line):
    t, r, phi, s = line.split(",")
    return f"{t},{r},{np.degrees(float(phi))},{s}"


@pytest.mark.parametrize("case", SPOILED)
def test_a_table_that_is_wrong(tmp_path, drive, case):
    write(tmp_path, drive)
    (tmp_path / "log.yaml").write_text(said())
    change, reason = SPOILED[case]
    path = Path(tmp_path / "seen.csv")
    path.write_text("\n".join(change(path.read_text().splitlines())) + "\n")
    with pytest.raises(pf.DataError, match=rf"(?s)seen\.csv.*{reason}|{reason}"):
        pf.load_log(tmp_path)


def test_a_laser_in_a_wide_table(tmp_path, capsys):
    angles = np.linspace(-np.pi / 2, np.pi / 2, 19)
    laser = pf.BeamModel(pf.worlds.office(), angles, 8.0, 0.03)
    driver = pf.PurePursuit(pf.worlds.OFFICE_ROUTE, v=0.5, dt=0.2)
    drive = pf.simulate_log(
        pf.worlds.OFFICE_START,
        driver,
        pf.VelocityMotion(),
        laser,
        np.random.default_rng(0),
        steps=40,
    )
    drive.world.save(tmp_path / "map.yaml")
    o = pf.dead_reckoning(drive)
    table(tmp_path / "odom.csv", "t,x,y,theta", drive.t, *o)
    names = ",".join(f"r{i}" for i in range(19))
    table(tmp_path / "scan.csv", f"t,{names}", drive.t, *np.stack([z[0] for z in drive.z], axis=1))
    text = describe(tmp_path)
    assert "sensor: laser" in text and "map: map.yaml" in text and "max: 8" in text
    log = pf.load_log(tmp_path, need_truth=False)
    np.testing.assert_allclose(log.z[7], drive.z[7], atol=1e-6)
    assert log.rig == pf.Rig("laser", "increments", r_max=8.0)
    (tmp_path / "log.yaml").write_text(text.replace(", max: 8", ""))
    with pytest.raises(pf.DataError, match=r"a laser needs beams: .* max: 8"):
        pf.load_log(tmp_path, need_truth=False)
