"""The likelihood field against its loop twin, and against the beam model's verdict."""

import math

import numpy as np
import pytest

import pfkit as pf

WALLS = np.ones((22, 32), dtype=bool)
WALLS[1:-1, 1:-1] = False
WALLS[5:8, 20:24] = True
ROOM = pf.OccupancyGrid(WALLS, 0.2, (1.0, -1.0, 0.3))
FIELD = pf.LikelihoodField(ROOM, r_max=5.0, sigma_hit=0.25, z_hit=0.9, z_rand=0.1)
LASER = pf.BeamModel(ROOM, np.linspace(-2, 2, 9), 5.0)


def loop_log_likelihood(z, pose):
    """Loop twin of Table 6.3: every beam, every wall."""
    walls = [ROOM.from_cells(i + 0.5, j + 0.5) for j, i in np.argwhere(WALLS)]
    total = 0.0
    for r, phi in z.T:
        if r >= 5.0:
            continue
        x, y = (pose[0] + r * math.cos(pose[2] + phi), pose[1] + r * math.sin(pose[2] + phi))
        i, j = np.floor(ROOM.to_cells(x, y))
        q = 0.1 / 5.0
        if 0 <= i < 32 and 0 <= j < 22:
            d = min(math.dist(ROOM.from_cells(i + 0.5, j + 0.5), wall) for wall in walls)
            q += 0.9 * math.exp(-0.5 * (d / 0.25) ** 2) / (0.25 * math.sqrt(2 * math.pi))
        total += math.log(q)
    return total


def test_it_agrees_with_its_loop_twin_on_and_off_the_map():
    rng = np.random.default_rng(0)
    pose = np.hstack((ROOM.sample_poses(12, rng), [[-3.0, 90.0], [0.0, 90.0], [1.0, 2.0]]))
    z = np.stack((rng.uniform(0, 6, 10), rng.uniform(-4, 4, 10)))
    assert (z[0] >= 5).any()
    expected = [loop_log_likelihood(z, x) for x in pose.T]
    np.testing.assert_allclose(FIELD.log_likelihood(z, pose), expected, rtol=1e-10)


def test_it_multiplies_over_beams_and_reads_batches():
    rng = np.random.default_rng(1)
    pose = ROOM.sample_poses((3, 6), rng)
    z = LASER.sample(pose[:, :, :1], rng)
    batch = FIELD.log_likelihood(z, pose)
    for b in range(3):
        one = FIELD.log_likelihood(z[:, :, b, 0], pose[:, b])
        np.testing.assert_allclose(batch[b], one)
        each = sum(FIELD.log_density(zk, pose[:, b]) for zk in z[:, :, b, 0].T)
        np.testing.assert_allclose(one, each)


def test_lost_beams_say_nothing():
    z = np.array([[5.0, 7.0], [0.0, 1.0]])
    np.testing.assert_array_equal(FIELD.log_likelihood(z, np.zeros((3, 4))), np.zeros(4))


def test_the_truth_scores_better_than_a_pose_beside_it():
    """Over 200 scans the truth wins against a shift of 0.6 m nearly always."""
    rng = np.random.default_rng(2)
    wins = 0
    for _ in range(200):
        truth = ROOM.sample_poses(1, rng)
        z = LASER.sample(truth[:, 0], rng)
        turn = rng.uniform(0, 2 * np.pi)
        beside = truth + 0.6 * np.array([[np.cos(turn)], [np.sin(turn)], [0.0]])
        wins += FIELD.log_likelihood(z, truth)[0] > FIELD.log_likelihood(z, beside)[0]
    assert wins > 160  # a coin would reach that in less than one of 1e17 runs


def test_bad_input_is_named():
    for settings in ({"r_max": 0.0}, {"sigma_hit": 0.0}, {"z_hit": 0.99}, {"z_rand": -0.1}):
        with pytest.raises(pf.ParameterError):
            pf.LikelihoodField(ROOM, **{"r_max": 5.0, **settings})
    with pytest.raises(AttributeError, match="occupied"):
        pf.LikelihoodField(WALLS, r_max=5.0)
    with pytest.raises(pf.DataError, match=">= 0"):
        FIELD.log_likelihood([[-1.0], [0.0]], np.zeros((3, 2)))
    with pytest.raises(pf.DataError, match="z"):
        FIELD.log_likelihood([[np.inf], [0.0]], np.zeros((3, 2)))


def test_a_single_reading_is_a_set_of_one():
    pose, z = ROOM.sample_poses(9, np.random.default_rng(6)), np.array((1.5, 0.3))
    for sensor in (FIELD, LASER):
        one = sensor.log_likelihood(z, pose)
        np.testing.assert_array_equal(one, sensor.log_likelihood(z[:, None], pose))
