"""Logs: iterate, cut, and refuse what does not fit together."""

import numpy as np
import pytest

import pfkit as pf


def make(T=5, **changes):
    fields = dict(
        t=np.arange(T, dtype=float),
        u=np.arange(2.0 * T).reshape(2, T),
        z=[np.full((3, k % 2), float(k)) for k in range(T)],
        truth=np.arange(3.0 * T).reshape(3, T),
        start=np.full(3, -1.0),
        outlier=[np.zeros(k % 2, bool) for k in range(T)],
        scored=np.arange(T) % 2 == 0,
        source="a test",
    )
    return pf.Log(**{**fields, **changes})


def test_a_log_iterates_as_steps():
    steps = list(make())
    assert len(steps) == len(make()) == 5
    t, u, z, truth = steps[3]
    assert t == 3.0 and isinstance(steps[3], pf.Step)
    np.testing.assert_array_equal(u, [3, 8])
    np.testing.assert_array_equal(z, [[3]] * 3)
    np.testing.assert_array_equal(truth, [3, 8, 13])
    assert next(iter(make(truth=None))).truth is None


def test_a_cut_starts_from_the_truth_before_it():
    log = make()
    tail = log[2:4]
    assert len(tail) == 2 and tail.t[0] == 2
    np.testing.assert_array_equal(tail.start, log.truth[:, 1])
    np.testing.assert_array_equal(tail.scored, [True, False])
    assert len(tail.outlier) == 2
    np.testing.assert_array_equal(log[:3].start, log.start)
    assert make(truth=None)[1:].start is None
    bare = make(outlier=None, scored=None)[:2]
    assert bare.outlier is None and bare.scored is None
    np.testing.assert_array_equal(log[-2:].t, [3, 4])


@pytest.mark.parametrize("part", [3, slice(None, None, 2), slice(None, None, -1), "a"])
def test_only_stretches_can_be_cut(part):
    with pytest.raises(pf.DataError, match="slices of step 1"):
        make()[part]


@pytest.mark.parametrize(
    "changes, words",
    [
        (dict(u=np.zeros((2, 4))), r"u must have shape \(n, 5, ...\), n >= 1, got \(2, 4\)"),
        (dict(z=[np.empty((3, 0))] * 6), "list of 5 arrays.*got 6"),
        (
            dict(truth=np.zeros((3, 2))),
            r"truth must have shape \(D, 5, ...\), D >= 1, got \(3, 2\)",
        ),
        (dict(scored=np.ones(3, bool)), "5 times but 3 of scored"),
        (dict(t=[0, 1, 3, 2, 4]), "backwards after t = 3"),
        (dict(t=[0, 1, np.nan, 2, 4]), "t must be finite, got nan"),
        (dict(t=np.zeros((5, 1))), r"t must have shape \(5,\), got \(5, 1\)"),
        (dict(u=np.zeros(5)), r"u must have shape \(n, 5, ...\)"),
        (dict(u="fast"), "u must be real numbers, got 'fast'"),
        (dict(truth=np.zeros(5)), r"truth must have shape \(D, 5, ...\)"),
        (dict(z=[np.zeros(3)] * 5), "one column for each measurement"),
        (dict(start=[0, np.inf, 0]), "start must be finite, got inf"),
    ],
)
def test_parts_that_do_not_fit_are_named(changes, words):
    with pytest.raises((pf.DataError, pf.ShapeError), match=words):
        make(**changes)


def test_equal_times_and_missing_truth_are_allowed():
    make(t=[0, 0, 1, 1, 1])
    make(truth=np.full((3, 5), np.nan))


def test_what_it_prints():
    assert repr(make()) == "Log(a test: 5 steps, 4.0 s, 2 measurements)"
    empty = pf.Log(np.empty(0), np.empty((2, 0)), [])
    assert repr(empty) == "Log(unnamed: 0 steps, 0.0 s, 0 measurements)" and list(empty) == []
