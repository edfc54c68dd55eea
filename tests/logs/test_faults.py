"""FieldOfView and outliers: what is hidden, what is false, and how it is labelled."""

import math

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


def residuals(log, sensor=SENSOR):
    """Measured minus true, all steps: rows r and phi."""
    out = []
    for _, _, z, truth in log:
        e = z - sensor.expected(truth)
        out.append(np.stack((e[0], pf.wrap(e[1]))))
    return np.stack(out)


def test_sight_by_range_and_by_field_of_view():
    near = pf.FieldOfView(WORLD, r_max=4.0)
    np.testing.assert_array_equal(near(np.array([3.0, 2.0, 0.0])), [True, True, False])
    ahead = pf.FieldOfView(WORLD, fov=np.pi)
    np.testing.assert_array_equal(ahead(np.array([3.0, 2.0, 0.0])), [False, True, True])
    np.testing.assert_array_equal(ahead(np.array([3.0, 2.0, np.pi])), [True, False, False])
    poses = rng().uniform(-3, 3, size=(3, 7, 1))
    assert ahead(poses).shape == (3, 7, 1)


def test_only_seen_landmarks_are_measured():
    sight = pf.FieldOfView(WORLD, r_max=4.0, fov=np.pi)
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(), sight=sight)
    assert {z.shape[1] for z in log.z} != {3}
    for _, _, z, truth in log:
        np.testing.assert_array_equal(z[2], WORLD.ids[sight(truth)])


def test_outliers_are_labelled_and_as_many_as_asked_for():
    false = pf.Outliers(0.3, (0.0, -np.pi), (10.0, np.pi))
    log = pf.simulate_log(START, np.tile(TURN, 30), NOISY, SENSOR, rng(), outliers=false)
    labels = np.stack(log.outlier)
    n = labels.size
    assert abs(labels.mean() - 0.3) < 4.5 * math.sqrt(0.3 * 0.7 / n)
    e = residuals(log)[:, 0]
    assert np.abs(e[~labels]).max() < 6 * 0.2  # honest ones stay honest
    z = np.stack(log.z)
    wild = z[:, 0][labels]
    assert abs(wild.mean() - 5) < 4.5 * 10 / math.sqrt(12 * wild.size)
    np.testing.assert_array_equal(z[:, 2], np.tile(WORLD.ids, (len(log), 1)))  # ids stay
    assert false.density == pytest.approx(1 / (20 * np.pi))


def test_outliers_do_not_change_the_honest_measurements():
    false = pf.Outliers(0.3, (0.0, -np.pi), (10.0, np.pi))
    _, truth = pf.drive(START, TURN, NOISY, rng())
    never = pf.Outliers(0.0, false.low, false.high)
    a, _ = pf.sense(truth, SENSOR, rng(1), outliers=never)
    b, labels = pf.sense(truth, SENSOR, rng(1), outliers=false)
    for one, other, bad in zip(a, b, labels, strict=True):
        np.testing.assert_array_equal(one[:, ~bad], other[:, ~bad])


def test_a_batch_has_labels_of_its_own():
    false = pf.Outliers(0.5, (0.0,), (10.0,))
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(), batch=4, outliers=false)
    assert log.outlier[0].shape == (3, 4, 1)


def test_bad_parts_are_named():
    with pytest.raises(pf.ParameterError, match="r_max"):
        pf.FieldOfView(WORLD, r_max=0)
    with pytest.raises(pf.ParameterError, match="fov"):
        pf.FieldOfView(WORLD, fov=7)
    with pytest.raises(pf.ParameterError, match="low"):
        pf.Outliers(0.1, (1.0,), (0.0,))
