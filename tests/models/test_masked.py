"""A column that was not measured says nothing."""

import numpy as np
import pytest

import pfkit as pf

NOISY = pf.VelocityMotion((0.02, 0.01, 0.01, 0.02))
WORLD = pf.LandmarkMap([[0.0, 6.0, 6.0], [0.0, 0.0, 5.0]], bounds=(-1, 7, -1, 6))
SENSOR = pf.RangeBearing(WORLD, sigma_r=0.2, sigma_phi=0.1)
START = np.array([3.0, 2.0, 0.5])
TURN = np.tile(np.array([[0.5], [0.3], [0.1]]), 30)


def rng(seed=0):
    return np.random.default_rng(seed)


def test_intermittent_columns_say_nothing_when_unseen():
    sensor = pf.Masked(SENSOR)
    pose = rng().uniform(-3, 3, size=(3, 50))
    z = sensor.sample(START, rng())
    z[-1] = [1, 0, 1]
    expected = SENSOR.log_likelihood(z[:3, [0, 2]], pose)
    np.testing.assert_allclose(sensor.log_likelihood(z, pose), expected)
    assert sensor.components == 4 and sensor.angles == (1,)


def test_a_batch_with_sight_marks_what_each_robot_sees():
    sight, sensor = pf.FieldOfView(WORLD, r_max=4.0), pf.Masked(SENSOR)
    log = pf.simulate_log(START, TURN, NOISY, sensor, rng(), batch=5, sight=sight)
    for _, _, z, truth in log:
        np.testing.assert_array_equal(z[-1], sight(truth))
    with pytest.raises(pf.ParameterError, match="Masked"):
        pf.simulate_log(START, TURN, NOISY, SENSOR, rng(), batch=5, sight=sight)
