"""Symmetry groups by brute force, against those we know."""

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds


def rng(seed=0):
    return np.random.default_rng(seed)


def same_set(a, b):
    """Whether two point sets (2, L) are equal, in any order."""
    return np.abs(np.subtract.outer(a[0], b[0]) + 1j * np.subtract.outer(a[1], b[1])).min(1).max()


@pytest.mark.parametrize(
    ("world", "turns", "mirrors"),
    [
        (worlds.square(), 4, 4),
        (worlds.broken_square(), 1, 0),
        (worlds.pentagon(10), 5, 0),
        (worlds.pentagon(40), 5, 0),
        (worlds.arena(), 1, 0),
        (worlds.six_beacons(), 1, 0),
        (pf.LandmarkMap([[0.0, 2.0], [0.0, 0.0]]), 2, 2),
    ],
    ids=["square", "broken", "pentagon 10", "pentagon 40", "arena", "six", "pair"],
)
def test_known_symmetry_groups(world, turns, mirrors):
    g = pf.symmetries(world)
    assert g.shape == (3, turns)
    np.testing.assert_allclose(g[:, 0], 0, atol=1e-9)
    assert pf.symmetries(world, mirror=True).shape == (3, mirrors)
    points = np.vstack((world.positions, np.zeros(len(world))))
    for motion in g.T:
        assert same_set(pf.compose(motion[:, None], points)[:2], world.positions) < 1e-6


def test_symmetries_turn_along_with_the_world():
    g = np.array([3.0, -1.0, 0.7])
    square = worlds.square()
    moved = pf.LandmarkMap(pf.compose(g[:, None], np.vstack((square.positions, np.zeros(4))))[:2])
    expected = pf.compose(pf.compose(g[:, None], pf.symmetries(square)), pf.inverse(g)[:, None])
    got = pf.symmetries(moved)
    key = np.round(np.exp(1j * got[2]), 6), np.round(np.exp(1j * expected[2]), 6)
    got, expected = got[:, np.argsort(key[0])], expected[:, np.argsort(key[1])]
    np.testing.assert_allclose(got[:2], expected[:2], atol=1e-9)


def test_copies_of_the_origin_in_the_square():
    copies = pf.images(np.zeros(3), pf.symmetries(worlds.square()))
    assert {tuple(np.round(c).astype(int)) for c in copies[:2].T} == {
        (0, 0),
        (15, 0),
        (15, 15),
        (0, 15),
    }
    assert worlds.square().contains(*copies[:2]).all()


def test_copies_measure_the_same_unnamed_landmarks():
    world = worlds.pentagon(40)
    sensor = pf.RangeBearing(world, 1.0, 1.0)
    pose = rng().uniform(-5, 5, size=3)
    z = sensor.expected(pf.images(pose, pf.symmetries(world)))  # (3, K, G)
    x, y = z[0] * np.cos(z[1]), z[0] * np.sin(z[1])
    for i in range(1, 5):
        assert same_set(np.stack((x[:, 0], y[:, 0])), np.stack((x[:, i], y[:, i]))) < 1e-9


def test_copies_are_equally_likely_for_a_sensor_without_names():
    world = worlds.square()
    sensor = pf.MaximumLikelihood(pf.RangeBearing(world, 0.1, 0.05))
    truth = np.array([1.0, 6.0, 0.7])
    copies = pf.images(truth, pf.symmetries(world))
    logs = sensor.log_likelihood(sensor.sample(truth, rng()), copies)
    np.testing.assert_allclose(logs, logs[0])
    mirrored = pf.images(truth * [1, -1, -1], pf.symmetries(world, mirror=True))
    logs_mirrored = sensor.log_likelihood(sensor.sample(truth, rng()), mirrored)
    assert logs_mirrored.max() < logs[0] - 10  # left and right have changed places


def test_images_of_a_cloud_have_the_group_as_second_axis():
    cloud = rng().normal(size=(3, 7, 2))
    g = pf.symmetries(worlds.square())
    out = pf.images(cloud, g)
    assert out.shape == (3, 4, 7, 2)
    np.testing.assert_allclose(out[:, 2, 3, 1], pf.compose(g[:, 2], cloud[:, 3, 1]))


def test_one_landmark_is_refused():
    with pytest.raises(IndexError, match="out of bounds"):
        pf.symmetries(worlds.one_landmark())


def test_landmarks_at_one_place_are_refused():
    with pytest.raises(pf.ParameterError, match="merge"):
        pf.symmetries(pf.LandmarkMap([[0.0, 1.0, 1.0], [0.0, 0.0, 0.0]]))


def test_hypothesis_mass_counts_weight_near_each_candidate():
    bel = pf.from_weights(
        [[0.0, 0.1, 5.0, 9.0], [0.0, 0.0, 0.0, 0.0], [0.0, 3.0, 0.0, 0.0]], [0.4, 0.3, 0.2, 0.1]
    )
    poses = [[0.0, 5.0], [0.0, 0.0], [0.0, 0.0]]
    np.testing.assert_allclose(pf.hypothesis_mass(bel, poses, 0.5), [0.7, 0.2])
    np.testing.assert_allclose(pf.hypothesis_mass(bel, poses, 0.5, angle=1.0), [0.4, 0.2])


def test_hypothesis_mass_of_a_batch_is_that_of_its_runs():
    state = rng().uniform(-2, 2, size=(3, 3, 200))
    bel = pf.from_weights(state, rng(1).random((3, 200)))
    poses = rng(2).uniform(-2, 2, size=(3, 5, 3))
    together = pf.hypothesis_mass(bel, poses, 1.0, angle=1.0)
    for b in range(3):
        one = pf.from_weights(state[:, b], bel.w[b])
        np.testing.assert_allclose(
            together[:, b], pf.hypothesis_mass(one, poses[..., b], 1.0, angle=1.0)
        )


def test_candidates_of_the_wrong_shape_are_refused():
    bel = pf.from_weights(np.zeros((3, 5)))
    with pytest.raises(pf.ShapeError, match="poses"):
        pf.hypothesis_mass(bel, np.zeros(3), 1.0)
    with pytest.raises(pf.ParameterError, match="radius"):
        pf.hypothesis_mass(bel, np.zeros((3, 1)), 0.0)
