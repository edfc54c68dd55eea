"""A mounted sensor is the sensor at another pose."""

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds

MOUNT = (0.3, -0.1, 0.4)
LANDMARKS = pf.RangeBearing(worlds.arena(), 0.2, 0.05)
FIELD = pf.LikelihoodField(worlds.office(), 5.0)


@pytest.mark.parametrize("shape", [(), (7,), (2, 5)])
def test_it_weighs_the_robot_by_what_the_sensor_sees_from_its_seat(shape):
    rng = np.random.default_rng(0)
    poses = worlds.arena().sample_poses(shape or 1, rng).reshape(3, *shape)
    mounted = pf.Mounted(LANDMARKS, MOUNT)
    seat = pf.compose(poses, np.reshape(MOUNT, (3, *(1,) * len(shape))))
    z = LANDMARKS.sample(np.array([3.0, 2.0, 0.5]), rng)
    np.testing.assert_allclose(
        mounted.log_likelihood(z, poses), LANDMARKS.log_likelihood(z, seat), atol=1e-9
    )
    np.testing.assert_allclose(mounted.expected(poses), LANDMARKS.expected(seat), atol=1e-12)


def test_upside_down_left_is_right():
    pose = np.array([2.0, 4.0, 0.3])
    plain, flipped = pf.Mounted(LANDMARKS, MOUNT), pf.Mounted(LANDMARKS, MOUNT, flipped=True)
    np.testing.assert_allclose(flipped.expected(pose)[1], -plain.expected(pose)[1])
    z = flipped.expected(pose)
    assert flipped.log_likelihood(z, pose) == pytest.approx(
        plain.log_likelihood(plain.expected(pose), pose)
    )
    scan = np.stack((np.full(9, 2.0), np.linspace(-1, 1, 9) + 0.2))
    mirrored = scan * [[1], [-1]]
    over = pf.Mounted(FIELD, MOUNT, flipped=True)
    assert over.log_likelihood(mirrored, pose) == pf.Mounted(FIELD, MOUNT).log_likelihood(
        scan, pose
    )
