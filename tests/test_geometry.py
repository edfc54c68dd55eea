"""Angles and rigid motions: the circle's and the group's laws."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import pfkit as pf

angles = st.floats(-1e4, 1e4)
lengths = st.floats(-1e3, 1e3)
poses = st.tuples(lengths, lengths, st.floats(-math.pi, math.pi)).map(np.array)


def same_pose(a, b, atol=1e-9):
    np.testing.assert_allclose(a[:2], b[:2], atol=atol)
    np.testing.assert_allclose(np.exp(1j * a[2]), np.exp(1j * b[2]), atol=atol)


@given(angles)
def test_wrap_lands_in_its_interval_on_the_same_direction(a):
    w = float(pf.wrap(a))
    assert -math.pi - 1e-11 < w <= math.pi + 1e-11
    assert math.cos(w) == pytest.approx(math.cos(a), abs=1e-9)
    assert math.sin(w) == pytest.approx(math.sin(a), abs=1e-9)


@given(angles)
def test_wrap_agrees_with_the_standard_library(a):
    difference = float(pf.wrap(a)) - math.remainder(a, 2 * math.pi)
    assert min(abs(difference), abs(abs(difference) - 2 * math.pi)) < 1e-9


def test_wrap_leaves_what_is_wrapped_and_includes_pi_only():
    inside = np.linspace(-math.pi, math.pi, 101)[1:]
    np.testing.assert_array_equal(pf.wrap(inside), inside)
    assert pf.wrap(-math.pi) == math.pi
    np.testing.assert_allclose(pf.wrap(np.array((3, -3, 5)) * math.pi), math.pi)
    assert pf.wrap(np.zeros((2, 3, 4))).shape == (2, 3, 4)


@given(poses, poses, poses)
def test_motions_are_a_group(a, b, c):
    origin = np.zeros(3)
    same_pose(pf.compose(a, origin), a)
    same_pose(pf.compose(origin, a), a)
    same_pose(pf.compose(a, pf.inverse(a)), origin)
    same_pose(pf.compose(pf.inverse(a), a), origin)
    same_pose(pf.compose(pf.compose(a, b), c), pf.compose(a, pf.compose(b, c)))


@given(poses, poses, poses)
def test_between_is_the_motion_seen_from_the_first_pose(a, b, g):
    same_pose(pf.compose(a, pf.between(a, b)), b)
    same_pose(pf.between(pf.compose(g, a), pf.compose(g, b)), pf.between(a, b), atol=1e-8)


@given(poses, poses)
def test_compose_multiplies_matrices(a, b):
    def matrix(pose):
        x, y, t = pose
        c, s = math.cos(t), math.sin(t)
        return np.array(((c, -s, x), (s, c, y), (0, 0, 1)))

    np.testing.assert_allclose(matrix(pf.compose(a, b)), matrix(a) @ matrix(b), atol=1e-9)


def test_poses_clouds_and_batches_broadcast():
    g, cloud = np.array((1.0, 2.0, 3.0)), np.random.default_rng(0).normal(size=(3, 4, 5))
    moved = pf.compose(g.reshape(3, 1, 1), cloud)
    for b in range(4):
        for m in range(5):
            np.testing.assert_allclose(moved[:, b, m], pf.compose(g, cloud[:, b, m]))


@given(st.lists(st.tuples(angles, st.floats(0.1, 5)), min_size=1, max_size=20), angles)
def test_the_circular_mean_turns_with_the_circle(pairs, turn):
    theta, w = np.array(pairs).T
    x, y = np.sum(w * np.cos(theta)), np.sum(w * np.sin(theta))
    if math.hypot(x, y) < 1e-3 * w.sum():
        return  # directions that cancel have no mean
    mean = pf.circular_mean(theta, w)
    assert mean == pytest.approx(math.atan2(y, x), abs=1e-9)
    turned = pf.circular_mean(theta + turn, w)
    assert abs(pf.wrap(turned - mean - turn)) < 1e-6


def test_the_circular_mean_crosses_the_cut():
    theta = np.radians([[170.0, -170.0], [10.0, 30.0]])
    np.testing.assert_allclose(np.abs(np.degrees(pf.circular_mean(theta))), [180.0, 20.0])
    np.testing.assert_allclose(np.degrees(pf.circular_mean(theta[1], [3.0, 0.0])), 10.0)


def test_weights_must_belong_to_the_angles():
    with pytest.raises(pf.ShapeError, match=r"w must have shape \(3,\), got \(2,\)"):
        pf.circular_mean(np.zeros(3), np.ones(2))


def test_what_nobody_knows_stays_unknown_and_spoils_nothing_else():
    truth = np.array([[0.0, np.nan, 3.0], [1.0, np.nan, 1.0], [7.0, np.nan, np.nan]])
    np.testing.assert_array_equal(np.isnan(pf.wrap(truth[2])), [False, True, True])
    moved = pf.between(truth[:, :1], truth)
    assert np.isnan(moved[:, 1]).all() and np.isnan(moved[2, 2])
    np.testing.assert_allclose(moved[:, 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.hypot(*moved[:2, 2]), 3.0)
    for refused in (pf.compose, pf.between):
        with pytest.raises(pf.PfkitError, match="inf"):
            refused(truth[:, 0], [np.inf, 0, 0])
    with pytest.raises(pf.ParameterError, match="nan"):
        pf.compose(truth[:, 1], truth[:, 0])


def test_opposite_directions_have_no_mean():
    theta = np.array([[0.0, np.pi], [0.3, 0.5]])
    mean = pf.circular_mean(theta)
    assert np.isnan(mean[0]) and mean[1] == pytest.approx(0.4)
    assert np.isnan(pf.circular_mean(np.arange(7) * 2 * np.pi / 7))
    assert pf.circular_mean(theta[0], [1.0, 1.0 - 1e-6]) == pytest.approx(0, abs=1e-6)


def test_the_resultant_is_the_length_of_the_mean_vector():
    rng = np.random.default_rng(3)
    theta, w = rng.uniform(-4, 4, (5, 9)), rng.random((5, 9))
    vector = np.sum(w * np.exp(1j * theta), axis=-1) / w.sum(axis=-1)
    np.testing.assert_allclose(pf.resultant_length(theta, w), np.abs(vector))
    np.testing.assert_allclose(pf.resultant_length(theta + 1.0, 3 * w), np.abs(vector))
    assert pf.resultant_length([0.0, np.pi]) == pytest.approx(0)
    assert pf.resultant_length([2.0, 2.0]) == pytest.approx(1)
    spread = rng.normal(1.0, 0.8, 40_000)
    assert pf.resultant_length(spread) == pytest.approx(np.exp(-0.32), abs=0.01)


def test_rayleighs_tail():
    """Of n directions without a common one, R exceeds r with probability exp(-n r^2)."""
    theta = np.random.default_rng(4).uniform(-np.pi, np.pi, (20_000, 50))
    share = np.mean(pf.resultant_length(theta) > 0.2)
    assert share == pytest.approx(np.exp(-2.0), abs=0.01)
