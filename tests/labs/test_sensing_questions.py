"""Sensing: the reference score is the package's sensor."""

import numpy as np

import pfkit as pf
from pfkit.labs import sensing
from pfkit.labs.sensing.score import readings


def test_the_reference_score_is_the_range_bearing_sensor():
    z, m, pose, sigma_r, sigma_phi = readings(9)
    world = pf.LandmarkMap(m)
    sensor = pf.RangeBearing(world, sigma_r, sigma_phi)
    ours = sensing.LAB.items["score"].reference(z, m, pose, sigma_r, sigma_phi)
    assert np.allclose(ours, sensor.log_likelihood(np.vstack((z, world.ids)), pose))
