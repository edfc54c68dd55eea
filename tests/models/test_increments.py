"""Odometry poses become increments, and increments a motion model."""

import numpy as np
import pytest

import pfkit as pf


def test_increments_lead_from_pose_to_pose_in_any_frame():
    rng = np.random.default_rng(0)
    poses = np.cumsum(rng.normal(size=(3, 20)), axis=1)
    moves = pf.increments(poses)
    pose, path = poses[:, 0], []
    for u in moves.T:
        pose = pf.IncrementMotion((0, 0, 0)).mean(pose, u)
        path.append(pose)
    found = np.array(path).T
    np.testing.assert_allclose(found[:2], poses[:2], atol=1e-9)
    np.testing.assert_allclose(pf.wrap(found[2] - poses[2]), 0, atol=1e-9)
    frame = np.array([3.0, -1.0, 2.0])[:, None]
    np.testing.assert_allclose(pf.increments(pf.compose(frame, poses)), moves, atol=1e-9)


@pytest.mark.parametrize("shape", [(4000,), (2, 2000)])
def test_the_noise_has_the_stated_size_whatever_the_motion(shape):
    sigma = np.array([0.1, 0.02, 0.05])
    motion = pf.IncrementMotion(tuple(sigma))
    for u in (np.zeros(3), np.array([2.0, 0.0, 1.0])):
        start = np.tile(np.array([1.0, 2.0, 0.7]).reshape(3, *(1,) * len(shape)), (1, *shape))
        moved = motion.sample(start, u, np.random.default_rng(1))
        error = pf.between(np.array([1.0, 2.0, 0.7]), moved.reshape(3, -1)) - u[:, None]
        np.testing.assert_allclose(error.std(axis=1), sigma, rtol=0.05)  # four standard errors
        np.testing.assert_allclose(error.mean(axis=1), 0, atol=4 * sigma.max() / 60)


def test_constant_noise_on_odometry_poses_runs_a_filter():
    world = pf.worlds.arena()
    rng = np.random.default_rng(2)
    driven = pf.simulate_log(
        pf.worlds.ARENA_START,
        pf.worlds.arena_route(),
        pf.VelocityMotion((0, 0, 0, 0)),
        pf.RangeBearing(world, 0.2, 0.05),
        rng,
    )
    u = pf.increments(np.column_stack((driven.start, driven.truth)))[:, 1:]
    rig = pf.Rig("range-bearing", "increments")
    log = pf.Log(driven.t, u, driven.z, driven.truth, driven.start, world, rig=rig)
    bel = pf.gaussian_prior(300, log.start, (0.1, 0.1, 0.05), rng)
    sensor = pf.RangeBearing(world, 0.2, 0.05)
    history = pf.run(log, bel, pf.IncrementMotion((0.03, 0.01, 0.01)), sensor, rng)
    assert pf.rmse(history.estimate, log.truth) < 0.15
    np.testing.assert_allclose(pf.dead_reckoning(log)[:2], log.truth[:2], atol=1e-9)
