"""Turn, drive, turn: the control from two odometer poses, the noise, the density."""

import math

import numpy as np
import pytest

import pfkit as pf

NOISY = pf.OdometryMotion((0.05, 0.02, 0.02, 0.03))


def test_the_mean_repeats_what_the_odometer_saw():
    rng = np.random.default_rng(0)
    pose0, pose1 = rng.uniform(-3, 3, (2, 3, 40))
    back = NOISY.mean(pose0, pf.odometry_control(pose0, pose1))
    np.testing.assert_allclose(back[:2], pose1[:2], atol=1e-12)
    np.testing.assert_allclose(pf.wrap(back[2] - pose1[2]), 0.0, atol=1e-12)


def test_the_control_agrees_with_the_textbook_table():
    rng = np.random.default_rng(1)
    pose0, pose1 = rng.uniform(-3, 3, (2, 3))
    rot1 = math.atan2(pose1[1] - pose0[1], pose1[0] - pose0[0]) - pose0[2]
    expected = (rot1, math.dist(pose0[:2], pose1[:2]), pose1[2] - pose0[2] - rot1)
    u = pf.odometry_control(pose0, pose1)
    np.testing.assert_allclose(u[1], expected[1])
    np.testing.assert_allclose(pf.wrap(u[::2] - np.array(expected[::2])), 0.0, atol=1e-12)


def test_turning_on_the_spot_and_standing_still():
    spot = pf.odometry_control((1.0, 2.0, 0.5), (1.0, 2.0, 1.5))
    np.testing.assert_allclose(spot, (0.0, 0.0, 1.0))
    pose = np.array((1.0, 2.0, 0.5))
    np.testing.assert_array_equal(pf.odometry_control(pose, pose), np.zeros(3))
    np.testing.assert_array_equal(NOISY.sample(pose, np.zeros(3), np.random.default_rng(2)), pose)


def test_noise_has_the_stated_variances():
    """5 standard errors, false-fail below 1e-5."""
    M, u = 40_000, np.array((0.3, 1.0, -0.4))
    moved = NOISY.sample(np.zeros((3, M)), u, np.random.default_rng(3))
    errors = pf.wrap(pf.odometry_control(np.zeros((3, 1)), moved) - u[:, None])
    a1, a2, a3, a4 = NOISY.alpha
    variance = (
        a1 * 0.3**2 + a2 * 1.0**2,
        a3 * 1.0**2 + a4 * (0.3**2 + 0.4**2),
        a1 * 0.4**2 + a2 * 1.0**2,
    )
    np.testing.assert_allclose(errors.var(axis=1), variance, rtol=5 * math.sqrt(2 / M))
    assert (np.abs(errors.mean(axis=1)) < 5 * np.sqrt(np.array(variance) / M)).all()


@pytest.mark.parametrize("u", [(0.3, 1.0, -0.4), (0.2, 0.15, 0.9), (2.0, -0.5, 0.3)])
def test_the_density_integrates_to_one(u):
    pose0 = np.array((1.0, -1.0, 2.0))
    n = (100, 140, 120)
    chord = (np.arange(n[0]) + 0.5) * 2.4 / n[0]
    beta, turn = ((np.arange(k) + 0.5) * 2 * np.pi / k - np.pi for k in n[1:])
    c, b, t = np.meshgrid(chord, beta, turn, indexing="ij")
    move = np.stack((c * np.cos(b), c * np.sin(b), t))
    density = np.exp(NOISY.log_density(pf.compose(pose0[:, None, None, None], move), u, pose0))
    total = (density * c).sum() * (2.4 / n[0]) * (2 * np.pi / n[1]) * (2 * np.pi / n[2])
    assert total == pytest.approx(1.0, abs=2e-3)


def test_the_density_is_that_of_the_samples():
    """The mean of 1 / p over samples in a box is the volume of the box (5 standard errors)."""
    u, M = (0.3, 1.0, -0.4), 40_000
    moved = NOISY.sample(np.zeros((3, M)), u, np.random.default_rng(4))
    centre = NOISY.mean(np.zeros(3), u)
    inside = (np.abs(pf.wrap(moved - centre[:, None])) < 0.1).all(axis=0)
    inverse_density = np.where(inside, np.exp(-NOISY.log_density(moved, u, np.zeros(3))), 0.0)
    volume, error = inverse_density.mean(), inverse_density.std() / math.sqrt(M)
    assert abs(volume - 0.2**3) < 5 * error
    assert error < 0.02 * volume


def test_moving_the_world_moves_the_answer_along():
    pose, g, u = np.random.default_rng(5).normal(size=(3, 9)), (3.0, -1.0, 2.0), (0.4, 1.0, 0.2)
    moved = NOISY.sample(pf.compose(g, pose), u, np.random.default_rng(6))
    same = pf.compose(g, NOISY.sample(pose, u, np.random.default_rng(6)))
    np.testing.assert_allclose(moved[:2], same[:2], atol=1e-13)
    np.testing.assert_allclose(pf.wrap(moved[2] - same[2]), 0.0, atol=1e-13)


def test_shapes_and_a_control_for_each_filter():
    rng = np.random.default_rng(7)
    each = np.array((0.1, 1.0, 0.2))[:, None, None] * np.ones((3, 4, 1))
    assert NOISY.sample(np.zeros((3, 4, 7)), each, rng).shape == (3, 4, 7)
    assert NOISY.sample(np.zeros(3), each[:, :, 0], rng).shape == (3, 4)


def test_no_motion_has_no_density_and_bad_alphas_are_named():
    with pytest.raises(pf.ParameterError, match="no density"):
        NOISY.log_density(np.ones(3), np.zeros(3), np.zeros(3))
    with pytest.raises(pf.ShapeError, match=r"alpha must have shape \(4,\)"):
        pf.OdometryMotion((0.1, 0.1))  # type: ignore[arg-type]
    with pytest.raises(pf.ParameterError, match="alpha"):
        pf.OdometryMotion((0.1, 0.1, -0.1, 0.1))


def test_what_is_unknown_stays_unknown():
    """A pose that nobody saw has no turn, not a turn of zero."""
    unknown = np.array((np.nan, 1.0, 0.0))
    assert np.isnan(pf.odometry_control(np.zeros(3), unknown)).all()
