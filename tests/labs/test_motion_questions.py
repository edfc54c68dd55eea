"""Motion: keys follow from formulas, references are the package's model."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import motion

ITEMS = motion.LAB.items


def test_references_are_the_motion_model_of_the_package():
    rng, u, alpha = np.random.default_rng(1), np.array([1.0, 0.4, 0.5]), (0.1, 0.02, 0.03, 0.2)
    pose = rng.normal(size=(3, 50))
    model = pf.VelocityMotion(alpha)
    assert np.allclose(ITEMS["arc"].reference(pose, *u), model.mean(pose, u))
    ours = ITEMS["sample"].reference(pose, u, alpha, np.random.default_rng(2))
    assert np.allclose(ours, model.sample(pose, u, np.random.default_rng(2)))


def test_the_inverse_and_the_density_are_those_of_the_package():
    rng, u = np.random.default_rng(3), np.array([1.0, 0.4, 0.5])
    pose0, pose1 = rng.normal(size=(2, 3, 50))
    ours = ITEMS["invert"].reference(pose0, pose1)
    assert np.allclose(ours, pf.inverse_arc(pose0, pose1))
    model = pf.VelocityMotion((0.002, 0.001, 0.01, 0.02, 0.005, 0.005))
    near = model.sample(pose0, u, rng)  # the arc backwards explains nothing here
    ours = ITEMS["density"].reference(near, u, model.alpha, pose0)
    assert np.allclose(ours, model.log_density(near, u, pose0))


def test_keys_follow_from_the_package():
    quarter = pf.VelocityMotion().mean(np.zeros(3), np.array([0.5, -np.pi / 2, 1.0]))
    assert np.allclose(quarter[:2], ITEMS["hand"].key, atol=1e-3)


@pytest.mark.parametrize("student", range(20))
def test_what_is_recovered_leads_back_to_the_printed_pose(student):
    item = ITEMS["recover"].personal(np.random.default_rng(student))
    v, omega, gamma = item.key
    x1, y1, start, end, dt = _printed(item.title)
    reached = pf.drive_arc((1, 2, np.radians(start)), v * dt, omega * dt)
    assert np.allclose(reached[:2], (x1, y1), atol=2e-3)
    assert abs(pf.wrap(reached[2] + gamma * dt - np.radians(end))) < 1e-2


def _printed(title):
    """x1, y1, start, end and dt as a student reads them."""
    dt, _, _, start, x1, y1, end = (
        float(word.strip("(),"))
        for word in title.split()
        if word.strip("(),").replace("-", "").replace(".", "").isdigit()
    )
    return x1, y1, start, end, dt


@pytest.mark.parametrize("n", [2, 16])
def test_the_same_alpha_per_second_gives_the_same_spread(n):
    """rescale: what alpha * dt keeps is the variance of the distance."""
    M, T, alpha = 40_000, 4.0, 0.02
    cloud, rng = np.zeros((3, M)), np.random.default_rng(4)
    model = pf.VelocityMotion((alpha * n, 0, 0, 0))
    for _ in range(n):
        cloud = model.sample(cloud, np.array((1.0, 0.0, T / n)), rng)
    assert cloud[0].var() == pytest.approx(alpha * T**2, rel=5 * np.sqrt(2 / M))


def test_a_careful_threshold_is_as_good_as_sinc():
    """Two cases are no mistake if the border lies where both are exact enough."""

    def arc(pose, v, omega, dt):
        slow = np.abs(omega) < 1e-6
        curved = motion.naive(pose, v, np.where(slow, 1.0, omega), dt)
        found = np.where(slow, motion.along(0.5, motion.full)(pose, v, omega, dt), curved)
        found[2] = pf.wrap(pose[2] + omega * dt)
        return found

    assert motion.check("arc", arc).status == "passed"
