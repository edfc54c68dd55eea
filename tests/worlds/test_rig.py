"""A rig states what u and z are, and a log is held to it."""

import numpy as np
import pytest

import pfkit as pf


def make(rig, n_u=3, n_z=3):
    return pf.Log(np.arange(3.0), np.zeros((n_u, 3)), [np.zeros((n_z, 2))] * 3, rig=rig)


def test_rows_without_names_lack_the_landmark():
    assert pf.Rig("range-bearing").rows == ("range", "bearing", "landmark")
    assert pf.Rig("range-bearing", named=False).rows == ("range", "bearing")
    assert pf.Rig("laser", mount=[0.1, 0, 0]).mount == (0.1, 0.0, 0.0)


@pytest.mark.parametrize(
    "arguments, reason",
    [
        (dict(sensor="sonar"), "sensor must be one of range-bearing, .* got 'sonar'"),
        (dict(sensor="laser", odometry="steps"), "odometry must be one of speeds"),
        (dict(sensor="laser", mount=(0, 0)), r"mount must have shape \(3,\)"),
        (dict(sensor="laser", mount=(0, 0, np.inf)), "inf"),
        (dict(sensor="laser", r_max=0.0), "r_max"),
    ],
)
def test_a_rig_that_is_none(arguments, reason):
    with pytest.raises(pf.PfkitError, match=reason):
        pf.Rig(**arguments)


@pytest.mark.parametrize(
    "rig, rows", [(pf.Rig("range"), 3), (pf.Rig("range-bearing", named=False), 3)]
)
def test_measurements_must_be_what_the_rig_says(rig, rows):
    make(rig, n_z=len(rig.rows))
    with pytest.raises(pf.DataError, match=r"has 2 rows .* but z has 3"):
        make(rig, n_z=rows)
    with pytest.raises(pf.DataError, match="rows v, omega, dt, but u has 2"):
        make(rig, n_u=2, n_z=2)
