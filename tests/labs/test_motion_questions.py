"""Motion: keys follow from formulas, references are the package's model."""

import numpy as np

import pfkit as pf
from pfkit.labs import motion
from pfkit.labs.motion import arcs

ITEMS = motion.LAB.items


def test_references_are_the_motion_model_of_the_package():
    rng, u, alpha = np.random.default_rng(1), np.array([1.0, 0.4, 0.5]), (0.1, 0.02, 0.03, 0.2)
    pose = rng.normal(size=(3, 50))
    model = pf.VelocityMotion(alpha)
    assert np.allclose(ITEMS["arc"].reference(pose, *u), model.mean(pose, u))
    ours = ITEMS["sample"].reference(pose, u, alpha, np.random.default_rng(2))
    assert np.allclose(ours, model.sample(pose, u, np.random.default_rng(2)))


def test_keys_follow_from_the_package():
    quarter = pf.VelocityMotion().mean(np.zeros(3), np.array([0.5, -np.pi / 2, 1.0]))
    assert np.allclose(quarter[:2], ITEMS["hand"].key, atol=1e-3)
    v, omega = pf.DifferentialDrive(0.1, 0.5).body_speed(8, 12)
    assert np.allclose((v, omega, v / omega), ITEMS["wheels"].key)


def test_a_careful_threshold_is_as_good_as_sinc():
    """Two cases are no mistake if the border lies where both are exact enough."""

    def arc(pose, v, omega, dt):
        slow = np.abs(omega) < 1e-6
        curved = arcs.naive(pose, v, np.where(slow, 1.0, omega), dt)
        found = np.where(slow, arcs.along(0.5, arcs.full)(pose, v, omega, dt), curved)
        found[2] = pf.wrap(pose[2] + omega * dt)
        return found

    assert motion.check("arc", arc).status == "passed"
