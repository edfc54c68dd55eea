"""Driving: the truth is a draw from the motion model, and kidnapping tells nobody."""

import math

import numpy as np
import pytest

import pfkit as pf

STILL = pf.VelocityMotion((0.0,) * 4)
WORLD = pf.LandmarkMap([[0.0, 6.0, 6.0], [0.0, 0.0, 5.0]], bounds=(-1, 7, -1, 6))
SENSOR = pf.RangeBearing(WORLD, sigma_r=0.2, sigma_phi=0.1)
START = np.array([3.0, 2.0, 0.5])
TURN = np.tile(np.array([[0.5], [0.3], [0.1]]), 30)


def rng(seed=0):
    return np.random.default_rng(seed)


def test_execution_errors_are_those_of_the_motion_model():
    motion = pf.VelocityMotion((0.04, 0.0, 0.0, 0.0))
    u = np.tile(np.array([[1.0], [0.0], [1.0]]), 4000)
    _, truth = pf.drive(np.zeros(3), u, motion, rng())
    strides = np.diff(truth[0], prepend=0.0)
    assert abs(strides.mean() - 1) < 4.5 * 0.2 / math.sqrt(4000)
    assert abs(strides.std() / 0.2 - 1) < 4.5 / math.sqrt(8000)


def test_kidnapping_moves_the_robot_and_tells_nobody():
    goal = np.array([0.0, 5.0, -1.0])
    log = pf.simulate_log(START, TURN, STILL, SENSOR, rng(), kidnap={9: goal})
    free = pf.simulate_log(START, TURN, STILL, SENSOR, rng())
    np.testing.assert_array_equal(log.u, free.u)
    np.testing.assert_array_equal(log.truth[:, :9], free.truth[:, :9])
    np.testing.assert_array_equal(log.truth[:, 9], goal)
    np.testing.assert_allclose(log.truth[:, 10], STILL.mean(goal, TURN[:, 10]))


def test_kidnapping_to_anywhere_stays_in_the_world():
    log = pf.simulate_log(START, TURN, STILL, SENSOR, rng(), kidnap={9: None}, batch=50)
    taken = log.truth[:, 9, :, 0]
    assert WORLD.contains(*taken[:2]).all()
    assert len(np.unique(taken[0])) == 50


def test_a_motion_model_that_breaks_the_shape_is_named():
    class Careless:
        def sample(self, pose, u, rng):
            return pose + u

    with pytest.raises(pf.ShapeError, match="row by row"):
        pf.drive(START[:, None, None], TURN, Careless(), rng())


def test_bad_parts_are_named():
    with pytest.raises(AttributeError, match="sample_poses"):
        pf.drive(START, TURN, STILL, rng(), kidnap={0: None})
    with pytest.raises(AttributeError, match="sample_poses"):
        pf.drive(START, TURN, STILL, rng(), kidnap={0: None}, world=3)
    with pytest.raises(TypeError):
        pf.drive(START, TURN, STILL, rng(), kidnap=3)
    for goal in ([1.0], [1.0, 2.0]):
        with pytest.raises(pf.ShapeError, match="kidnap pose"):
            pf.drive(START, TURN, STILL, rng(), kidnap={0: goal})
