"""The velocity model: the arc, its limits, its noise, its density."""

import math

import numpy as np
import pytest

import pfkit as pf

FULL = pf.VelocityMotion((0.02, 0.01, 0.01, 0.05, 0.005, 0.01))


def drive_in_small_steps(pose, v, omega, dt, n=20_000):
    """Loop twin of the arc: many short straight moves (midpoint rule)."""
    x, y, theta = pose
    h = dt / n
    for _ in range(n):
        x += v * h * math.cos(theta + omega * h / 2)
        y += v * h * math.sin(theta + omega * h / 2)
        theta += omega * h
    return np.array((x, y, math.remainder(theta, 2 * math.pi)))


@pytest.mark.parametrize("v, omega", [(1.0, 0.0), (0.7, 1.3), (-0.5, 2.0), (0.0, 1.0), (1.0, -3.0)])
def test_the_arc_agrees_with_many_short_moves(v, omega):
    pose, dt = np.array((1.0, -2.0, 2.5)), 1.7
    expected = drive_in_small_steps(pose, v, omega, dt)
    reached = pf.VelocityMotion().mean(pose, (v, omega, dt))
    np.testing.assert_allclose(reached, expected, atol=1e-7)


def test_the_arc_agrees_with_the_textbook_circle():
    x, y, theta = pose = np.array((0.3, 0.4, 0.5))
    v, omega, dt = 1.2, 0.8, 0.9
    radius = v / omega
    expected = (
        x - radius * math.sin(theta) + radius * math.sin(theta + omega * dt),
        y + radius * math.cos(theta) - radius * math.cos(theta + omega * dt),
        theta + omega * dt,
    )
    np.testing.assert_allclose(pf.VelocityMotion().mean(pose, (v, omega, dt)), expected, rtol=1e-13)


def test_the_straight_line_is_the_limit_of_the_arc():
    pose = np.array((1.0, 2.0, 0.3))
    straight = pf.drive_arc(pose, 2.0, 0.0)
    np.testing.assert_array_equal(
        straight[:2], pose[:2] + 2.0 * np.array((math.cos(0.3), math.sin(0.3)))
    )
    turns = 10.0 ** np.arange(-3, -16, -1.0)
    arcs = pf.drive_arc(pose, 2.0, turns)
    off = np.abs(arcs[:2] - straight[:2, None]).max(axis=0)
    assert (off <= 1.01 * turns + 1e-15).all()  # first order in the turn, down to rounding


def test_a_robot_without_a_command_stays_exactly():
    rng = np.random.default_rng(0)
    pose = np.array((1.0, 2.0, 3.0))
    for motion in (pf.VelocityMotion(), FULL):
        np.testing.assert_array_equal(motion.sample(pose, (0.0, 0.0, 1.0), rng), pose)


def test_a_full_circle_comes_home_and_half_a_turn_on_the_spot_only_turns():
    motion, pose = pf.VelocityMotion(), np.array((1.0, 2.0, 0.3))
    np.testing.assert_allclose(motion.mean(pose, (1.0, 2 * np.pi, 1.0)), pose, atol=1e-15)
    turned = motion.mean(pose, (0.0, np.pi, 1.0))
    np.testing.assert_allclose(turned, (1.0, 2.0, 0.3 - np.pi), atol=1e-15)


def test_the_open_loop_commands_of_the_2019_report():
    """Five commands of a second each, from the origin: three legs and two quarter turns."""
    pose = np.zeros(3)
    for v, omega in ((0.5, 0), (0, -np.pi / 2), (0.5, 0), (0, np.pi / 2), (0.5, 0)):
        pose = pf.VelocityMotion().mean(pose, (v, omega, 1.0))
    np.testing.assert_allclose(pose, (1.0, -0.5, 0.0), atol=1e-15)


def test_shapes_one_pose_a_cloud_a_batch_and_a_control_for_each_filter():
    rng = np.random.default_rng(1)
    u = np.array((1.0, 0.2, 0.5))
    each = np.broadcast_to(u[:, None, None], (3, 4, 1))
    for shape, control in (((), u), ((7,), u), ((4, 7), u), ((4, 7), each)):
        assert FULL.mean(np.zeros((3, *shape)), control).shape == (3, *shape)
        assert FULL.sample(np.zeros((3, *shape)), control, rng).shape == (3, *shape)


def test_one_pose_with_many_controls_gets_noise_of_its_own_for_each():
    many = np.broadcast_to(np.array((1.0, 0.2, 0.5))[:, None], (3, 50))
    moved = FULL.sample(np.zeros(3), many, np.random.default_rng(2))
    assert np.unique(moved[0]).size == 50


def test_moving_the_world_moves_the_answer_along():
    rng = np.random.default_rng(3)
    pose, g = rng.normal(size=(3, 9)), np.array((3.0, -1.0, 2.0))
    u = (0.8, -0.7, 1.1)
    moved = FULL.sample(pf.compose(g, pose), u, np.random.default_rng(4))
    same = pf.compose(g, FULL.sample(pose, u, np.random.default_rng(4)))
    np.testing.assert_allclose(moved[:2], same[:2], atol=1e-13)
    np.testing.assert_allclose(pf.wrap(moved[2] - same[2]), 0.0, atol=1e-13)
    np.testing.assert_allclose(
        FULL.log_density(moved, u, pf.compose(g, pose)),
        FULL.log_density(pf.compose(pf.inverse(g), same), u, pose),
    )


def test_noise_has_the_stated_variances():
    """Read v, omega and gamma back from samples; 5 standard errors, false-fail below 1e-5."""
    M, (v, omega, dt) = 40_000, (1.0, 0.4, 0.5)
    moved = FULL.sample(np.zeros((3, M)), (v, omega, dt), np.random.default_rng(5))
    half = np.arctan2(moved[1], moved[0])
    v_hat = np.hypot(moved[0], moved[1]) / np.sinc(half / np.pi) / dt
    omega_hat, gamma_hat = 2 * half / dt, pf.wrap(moved[2] - 2 * half) / dt
    errors = np.stack((v_hat - v, omega_hat - omega, gamma_hat))
    variance = FULL.variances((v, omega, dt))
    assert (np.abs(errors.mean(axis=1)) < 5 * np.sqrt(variance / M)).all()
    np.testing.assert_allclose(errors.var(axis=1), variance, rtol=5 * math.sqrt(2 / M))
    correlation = np.corrcoef(errors)[np.triu_indices(3, 1)]
    assert (np.abs(correlation) < 5 / math.sqrt(M)).all()


@pytest.mark.parametrize("backwards", [False, True])
def test_the_inverse_arc_leads_back_to_where_one_came_from(backwards):
    """Any two poses, the same numbers again by driving: forwards, backwards, at any heading."""
    rng = np.random.default_rng(7)
    pose0 = rng.uniform((-3, -3, -np.pi), (3, 3, np.pi), (200, 3)).T
    pose1 = rng.uniform((-3, -3, -np.pi), (3, 3, np.pi), (200, 3)).T
    distance, turn, extra = pf.inverse_arc(pose0, pose1, backwards)
    assert (np.sign(distance) == (-1 if backwards else 1)).all()
    assert (np.abs(turn) <= 2 * np.pi).all() and (np.abs(extra) <= np.pi).all()
    reached = pf.drive_arc(pose0, distance, turn)
    np.testing.assert_allclose(reached[:2], pose1[:2], atol=1e-9)
    np.testing.assert_allclose(pf.wrap(reached[2] + extra - pose1[2]), 0, atol=1e-9)


def test_the_inverse_arc_is_the_circle_of_the_textbook():
    """Table 5.1 by the centre of the circle: the same distance and turn, where it has one."""
    (x, y, theta), (x1, y1, theta1) = pose0, pose1 = (0.3, -0.2, 0.7), (1.4, 0.9, 1.5)
    c, s = math.cos(theta), math.sin(theta)
    mu = 0.5 * ((x - x1) * c + (y - y1) * s) / ((y - y1) * c - (x - x1) * s)
    cx, cy = (x + x1) / 2 + mu * (y - y1), (y + y1) / 2 + mu * (x1 - x)
    radius = math.hypot(x - cx, y - cy)
    turn = math.atan2(y1 - cy, x1 - cx) - math.atan2(y - cy, x - cx)
    expected = (radius * turn, turn, theta1 - theta - turn)
    np.testing.assert_allclose(pf.inverse_arc(pose0, pose1), expected, rtol=1e-12)


def test_the_inverse_arc_of_straight_lines_and_turns_on_the_spot():
    ahead, behind = np.array((2.0, 0, 0)), np.array((-2.0, 0, 0))
    np.testing.assert_array_equal(pf.inverse_arc(np.zeros(3), ahead), (2, 0, 0))
    np.testing.assert_array_equal(pf.inverse_arc(np.zeros(3), behind, backwards=True), (-2, 0, 0))
    np.testing.assert_array_equal(pf.inverse_arc(np.zeros(3), (0, 0, 0.5)), (0, 0, 0.5))


def test_the_jacobian_is_that_of_driving():
    """Volume of the poses that a small box of (v, omega, gamma) reaches, by differences."""
    v, omega, dt, h = 0.9, 0.7, 0.8, 1e-6

    def reached(p):
        x, y, theta = pf.drive_arc(np.array((1.0, 2.0, 2.5)), p[0] * dt, p[1] * dt)
        return np.array((x, y, theta + p[2] * dt))

    p = np.array((v, omega, 0.1))
    columns = [(reached(p + h * e) - reached(p - h * e)) / (2 * h) for e in np.eye(3)]
    chord = v * dt * np.sinc(omega * dt / 2 / np.pi)
    volume = 0.5 * chord * np.sinc(omega * dt / 2 / np.pi) * dt**3
    assert abs(np.linalg.det(np.transpose(columns))) == pytest.approx(volume, rel=1e-6)


def polar_integral(motion, u, chord, beta, turn, pose0):
    """Integrate exp(log_density) over poses; polar coordinates take the pole away."""
    c, b, t = np.meshgrid(chord, beta, turn, indexing="ij")
    move = np.stack((c * np.cos(b), c * np.sin(b), t))
    density = np.exp(motion.log_density(pf.compose(pose0[:, None, None, None], move), u, pose0))
    cell = (chord[1] - chord[0]) * (beta[1] - beta[0]) * (turn[1] - turn[0])
    return float((density * c).sum() * cell)


def midpoints(low, high, n):
    return low + (np.arange(n) + 0.5) * (high - low) / n


@pytest.mark.parametrize(
    "u, reach",
    [
        ((1.0, 0.5, 0.8), 2.0),
        ((0.1, 0.8, 0.5), 0.5),
        ((-0.6, -0.4, 1.0), 1.5),
        ((0.8, 3.0, 1.0), 1.5),
    ],
    ids=["driving", "nearly turning on the spot", "reversing", "half a circle"],
)
def test_the_density_integrates_to_one(u, reach):
    total = polar_integral(
        FULL,
        u,
        midpoints(0, reach, 100),
        midpoints(-np.pi, np.pi, 160),
        midpoints(-np.pi, np.pi, 100),
        np.array((1.0, -1.0, 2.0)),
    )
    assert total == pytest.approx(1.0, abs=2e-3)


def test_the_density_is_that_of_the_samples():
    """The mean of 1 / p over samples in a box is the volume of the box (5 standard errors)."""
    u, M = (1.0, 0.5, 0.8), 200_000
    pose0 = np.zeros(3)
    moved = FULL.sample(np.zeros((3, M)), u, np.random.default_rng(6))
    centre, half = FULL.mean(pose0, u), np.array((0.05, 0.05, 0.05))
    inside = (np.abs(pf.wrap(moved - centre[:, None])) < half[:, None]).all(axis=0)
    inverse_density = np.where(inside, np.exp(-FULL.log_density(moved, u, pose0)), 0.0)
    volume, error = inverse_density.mean(), inverse_density.std() / math.sqrt(M)
    assert abs(volume - (2 * half).prod()) < 5 * error
    assert error < 0.03 * volume


def test_a_surface_has_no_density():
    with pytest.raises(pf.ParameterError, match="no density"):
        pf.VelocityMotion((0.1, 0.1, 0.1, 0.1)).log_density(np.ones(3), (1, 0, 1), np.zeros(3))


@pytest.mark.parametrize(
    "alpha, error",
    [((0.1,), pf.ShapeError), ((-0.1, 0, 0, 0), pf.ParameterError), ("abcd", pf.ParameterError)],
)
def test_bad_alphas_are_named(alpha, error):
    with pytest.raises(error, match="alpha"):
        pf.VelocityMotion(alpha)


def test_a_seed_is_no_generator_and_no_time_has_no_density():
    with pytest.raises(pf.ParameterError, match="default_rng"):
        FULL.sample(np.zeros(3), (1.0, 0.0, 1.0), 7)
    with pytest.raises(pf.ParameterError, match="dt"):
        FULL.log_density(np.ones(3), (1.0, 0.0, 0.0), np.zeros(3))


def test_a_cloud_that_is_transposed_is_named():
    with pytest.raises(pf.ShapeError, match="transpose"):
        pf.VelocityMotion().mean(np.zeros((7, 3)), (1.0, 0.0, 1.0))
