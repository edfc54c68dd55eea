"""Tables: what is written comes back, and groups are summarised one by one."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.judging import study


@pytest.fixture
def table():
    rng = np.random.default_rng(0)
    return pf.tabulate(
        {
            "M": np.repeat([50, 200], 20),
            "sigma_r": np.tile([0.2, 0.6], 20),
            "scheme": ["systematic", "residual"] * 20,
            "rmse": rng.exponential(size=40),
        }
    )


def test_csv_round_trip_keeps_every_digit(table, tmp_path):
    study.to_csv(table, tmp_path / "t.csv")
    back = study.from_csv(tmp_path / "t.csv")
    assert back.dtype == table.dtype
    np.testing.assert_array_equal(back, table)


def test_csv_keeps_text_truth_and_commas(tmp_path):
    columns = np.array(
        [("a, b", True, 0.1), ("c", False, np.inf)], [("s", "U4"), ("ok", bool), ("x", float)]
    )
    study.to_csv(columns, tmp_path / "t.csv")
    np.testing.assert_array_equal(study.from_csv(tmp_path / "t.csv"), columns)


def test_a_damaged_csv_is_named(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("a,b\n1,2\n3\n")
    with pytest.raises(pf.DataError, match="line 3"):
        study.from_csv(path)
    with pytest.raises(FileNotFoundError, match=r"none\.csv"):
        study.from_csv(tmp_path / "none.csv")
    path.write_text("")
    with pytest.raises(pf.DataError, match="no rows"):
        study.from_csv(path)


def test_a_summary_has_one_row_per_group(table):
    summary = study.summarise(table, "rmse", by="M")
    np.testing.assert_array_equal(summary["M"], [50, 200])
    np.testing.assert_array_equal(summary["runs"], [20, 20])
    np.testing.assert_allclose(summary["value"][0], table["rmse"][table["M"] == 50].mean())
    assert (summary["low"] < summary["value"]).all() and (summary["value"] < summary["high"]).all()
    both = study.summarise(table, "rmse", by=("M", "sigma_r"), statistic=np.median)
    assert both.shape == (4,)
    assert study.summarise(table, "rmse").shape == (1,)


def test_columns_must_have_one_length():
    for columns in ({"a": [1, 2], "b": [1]}, {"a": 3.0}, {"a": np.ones((2, 2))}, {}):
        with pytest.raises(pf.ShapeError, match="columns"):
            pf.tabulate(columns)


def test_an_unknown_column_is_named(table):
    with pytest.raises(ValueError, match="no field of name size"):
        pf.summarise(table, "size")


def test_a_summary_does_not_overwrite_a_column():
    with pytest.raises(pf.ParameterError, match="rename"):
        pf.summarise(pf.tabulate({"runs": [1, 1], "a": [1.0, 2.0]}), "a", by="runs")
