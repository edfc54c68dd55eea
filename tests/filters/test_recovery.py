"""Augmented MCL: its memory, what it injects, and that it comes home after a kidnapping."""

import math

import numpy as np
import pytest

import pfkit as pf

WORLD = pf.worlds.arena()
SENSOR = pf.RangeBearing(WORLD, 0.3, 0.1)
MOTION = pf.VelocityMotion((0.02, 0.01, 0.01, 0.02, 0.005, 0.005))


def rng(seed=0):
    return np.random.default_rng(seed)


def test_memory_is_two_running_means():
    memory, slow, fast = pf.Memory(), 0.0, 0.0
    for w in (0.5, 0.2, 0.9, 0.01, 0.02):
        memory = memory.remember(2 * math.log(w), K=2, alpha_slow=0.1, alpha_fast=0.5)
        slow, fast = slow + 0.1 * (w - slow), fast + 0.5 * (w - fast)
    assert np.exp(memory.log_slow) == pytest.approx(slow)
    assert np.exp(memory.log_fast) == pytest.approx(fast)
    assert memory.share == pytest.approx(max(0, 1 - fast / slow))


def test_share_is_zero_at_the_start_and_while_things_go_well():
    memory = pf.Memory()
    assert memory.share == 0
    for log_evidence in (-900.0, -880.0, -870.0):  # far below what a float can hold
        memory = memory.remember(log_evidence)
        assert memory.share == 0


def test_share_tends_to_one_when_all_goes_wrong():
    memory = pf.Memory()
    for _ in range(300):
        memory = memory.remember(0.0)
    for _ in range(15):
        memory = memory.remember(-2000.0)
    assert memory.share == pytest.approx(1 - 0.7**15 / 0.98**15, rel=0.02)


def test_inject_replaces_the_share_it_is_told():
    bel = pf.from_weights(np.full((3, 4, 20_000), -99.0))
    share = np.array([0.0, 0.1, 0.5, 1.0])
    after, new = pf.inject(bel, share, WORLD.sample_poses, rng())
    assert np.abs(new.mean(axis=-1) - share).max() < 4 * math.sqrt(0.25 / 20_000)
    assert ((after.state[0] != -99.0) == new).all()
    assert after.log_w is bel.log_w
    assert pf.inject(bel, 0.0, WORLD.sample_poses, rng())[0] is bel


@pytest.mark.parametrize("shape", [20_000, (2, 10_000)])
def test_drawn_poses_would_see_the_landmark_so(shape):
    """Back through the sensor they give the measurement, with its noise."""
    sensor = pf.RangeBearing(WORLD, 0.3, 0.1, bias_phi=0.2)
    z = np.array([[2.0], [0.7], [1.0]])
    poses = pf.poses_seeing(z, sensor, shape, rng())
    r, phi, _ = sensor.expected(poses, ids=[1])[:, 0]
    assert r.mean() == pytest.approx(2.0, abs=0.01) and r.std() == pytest.approx(0.3, rel=0.03)
    error = pf.wrap(phi - 0.7)
    assert error.mean() == pytest.approx(0.0, abs=0.004)
    assert error.std() == pytest.approx(0.1, rel=0.03)
    dx = poses[0] - WORLD.positions[0, 1]  # all round the landmark
    assert abs(np.mean(dx > 0) - 0.5) < 0.02


def kidnapped(seed, world, batch=20, M=400):
    """20 steps at one end of the arena, 40 at the other; who is at home in the end?"""
    generator, sensor = rng(seed), pf.OutlierMixture(SENSOR, 0.01, 0.02)
    bel = plain = pf.gaussian_prior((batch, M), (2.0, 2.0, 0.0), (0.2, 0.2, 0.1), generator)
    memory, u, quiet = pf.Memory(), (0.0, 0.0, 1.0), []
    for k in range(60):
        truth = np.array([2.0, 2.0, 0.0]) if k < 20 else np.array([8.0, 6.0, -2.0])
        z = SENSOR.sample(truth, generator)[:, :2]
        bel, memory, _ = pf.augmented_step(bel, memory, u, z, MOTION, sensor, generator, world)
        plain, _ = pf.step(plain, u, z, MOTION, sensor, generator)
        if k < 20:
            quiet.append(memory.share)
    home = [np.hypot(*(pf.mean_pose(b) - truth[:, None])[:2]) < 0.5 for b in (bel, plain)]
    return *home, np.mean(quiet)


@pytest.mark.parametrize("world, least", [(WORLD, 0.4), (None, 0.7)])
def test_a_kidnapped_filter_comes_home_and_a_plain_one_does_not(world, least):
    """Five drives of 20 filters; over ten other seeds the shares were .61 and .92 (sd of one drive
    .09 and .12), so the mean of five falls below the limit in less than 1 of 10,000."""
    drives = [kidnapped(seed, world) for seed in range(2, 7)]
    assert np.mean([augmented for augmented, _, _ in drives]) >= least
    for _, plain, quiet in drives:
        assert plain.mean() == 0
        assert quiet < 0.05  # at home, hardly any particle is replaced


def test_ancestor_minus_one_marks_the_newborn():
    bel = pf.gaussian_prior(500, (2.0, 2.0, 0.0), (0.2, 0.2, 0.1), rng())
    z = SENSOR.sample(np.array([8.0, 6.0, -2.0]), rng())[:, :2]
    memory = pf.Memory(0.0, -1.0)
    after, memory, info = pf.augmented_step(bel, memory, (0, 0, 1.0), z, MOTION, SENSOR, rng())
    share = (info.ancestors == -1).mean()
    assert share == pytest.approx(memory.share, abs=4 * math.sqrt(0.25 / 500))
    old = info.ancestors >= 0
    np.testing.assert_array_equal(after.state[:, old], bel.state[:, info.ancestors[old]])


def test_without_a_measurement_nothing_is_remembered():
    bel, memory = pf.gaussian_prior(50, (2, 2, 0), (1, 1, 1), rng()), pf.Memory(-1.0, -2.0)
    _, after, info = pf.augmented_step(bel, memory, (1, 0, 1), None, MOTION, SENSOR, rng(), WORLD)
    assert after is memory and not info.resampled


def test_a_single_measurement_counts_as_one():
    """(3,) and (3, 1) are the same set: memory divides the evidence by K = 1."""
    bel = pf.gaussian_prior(50, (2, 2, 0), (1, 1, 1), rng())
    z = SENSOR.expected(np.array((2.0, 2.0, 0.0)), ids=[0])
    arguments = (bel, pf.Memory(), (1, 0, 1))
    one, two = (
        pf.augmented_step(*arguments, zk, MOTION, SENSOR, rng(), WORLD)[1] for zk in (z, z[:, 0])
    )
    assert one == two


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda: pf.Memory().remember(0.0, alpha_slow=0.5, alpha_fast=0.1), pf.ParameterError),
        (lambda: pf.Memory().remember(np.nan), pf.ParameterError),
        (lambda: pf.Memory().remember(0.0, K=0), pf.ParameterError),
        (
            lambda: pf.inject(pf.from_weights(np.ones((3, 4))), 1.5, WORLD.sample_poses, rng()),
            pf.ParameterError,
        ),
        (
            lambda: pf.inject(
                pf.from_weights(np.ones((3, 4))), 1.0, lambda shape, rng: np.zeros(2), rng()
            ),
            pf.ShapeError,
        ),
        (
            lambda: pf.inject(
                pf.from_weights(np.ones((3, 4))), (0.1, 0.2), WORLD.sample_poses, rng()
            ),
            pf.ShapeError,
        ),
        (lambda: pf.poses_seeing(np.empty((3, 0)), SENSOR, 5, rng()), pf.ShapeError),
        (lambda: pf.poses_seeing(np.ones((3, 1)), pf.Range(WORLD, 1), 5, rng()), AttributeError),
        (lambda: pf.poses_seeing(np.ones((2, 1)), SENSOR, 5, rng()), pf.ShapeError),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call()
