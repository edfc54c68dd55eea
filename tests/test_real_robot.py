"""The real MRCLAM log, where it is found: the promises, and the table that the book prints.

The log may not be shipped. Name the folder that holds it in the environment variable
PFKIT_DATA (data/README.md says where to get it); without it these tests are skipped.
"""

import csv
import json
import os
import sys
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.judging.localise import score

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tools"))
import real_robot_results as results  # noqa: E402


def find_log() -> Path | None:
    """The folder of data set 4, robot 3, below PFKIT_DATA."""
    root = os.environ.get("PFKIT_DATA")
    if not root:
        return None
    for name in ("ds0_Odometry.dat", "Robot3_Odometry.dat"):
        for path in [*Path(root).glob(name), *Path(root).glob(f"*/{name}")]:
            if "ds0" in path.name or "Dataset4" in path.parent.name:
                return path.parent
    return None


FOLDER = find_log()
if FOLDER is None:
    pytest.skip("PFKIT_DATA names no folder with the MRCLAM log", allow_module_level=True)


@pytest.fixture(scope="module")
def log():
    return pf.load_mrclam(FOLDER, robot=None if (FOLDER / "ds0_Odometry.dat").exists() else 3)


def test_the_log_is_read_whole(log):
    assert log.scored.sum() == len(np.unique(log.t[log.scored])) > 95_800
    assert sum(zk.shape[1] for zk in log.z) == 6443
    assert np.isfinite(log.truth).all()


def test_dead_reckoning(log):
    s = score(log, pf.dead_reckoning(log), 0.5)
    assert s.rmse == pytest.approx(4.72, abs=0.01)
    assert np.degrees(s.heading_rmse) == pytest.approx(91, abs=1)


@pytest.mark.slow
@pytest.mark.parametrize("calibrated, metres, degrees", [(False, 0.11, 4.5), (True, 0.075, 3.5)])
def test_known_start(log, calibrated, metres, degrees):
    s = results.measure(log, "known", 5, calibrated)[-1]
    assert s.rmse.mean() <= metres
    assert np.degrees(s.heading_rmse.mean()) <= degrees
    _the_table_says("known start, calibrated" if calibrated else "known start", s)


@pytest.mark.slow
def test_global_start_along_the_first_minute(log):
    """Twenty seeds; the table, which took the whole log, has its own row for this."""
    name = "first minute, global start"
    s = results.measure(log, **results.EXPERIMENTS[name])[-1]
    assert (s.converged <= 20).sum() >= 19
    _the_table_says(name, s)


def test_the_table_keeps_the_promises():
    rows = {row["experiment"]: row for row in _rows()}
    assert float(rows["global start"]["rmse_m"]) <= 0.12
    assert int(rows["global start"]["converged_within_20_s"]) >= 19
    about = json.loads((results.RESULTS / "mrclam_ds0.json").read_text())
    assert about["date"] and about["pfkit"] and "first third" in about["settings chosen on"]


def _rows():
    with (results.RESULTS / "mrclam_ds0.csv").open(encoding="ascii") as file:
        return list(csv.DictReader(file))


def _the_table_says(name, s):
    """The committed row agrees with the one just measured."""
    kept = next(row for row in _rows() if row["experiment"] == name)
    fresh = results.row(name, int(kept["particles"]), s)
    tolerance = {"rmse_m": 0.006, "median_m": 0.004, "p95_m": 0.02, "heading_rmse_deg": 0.2}
    for column, most in tolerance.items():
        assert float(kept[column]) == pytest.approx(float(fresh[column]), abs=most), column
