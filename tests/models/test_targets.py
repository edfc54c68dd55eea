"""The target models: their means, their noise, and that one replaces another."""

import math

import numpy as np
import pytest

import pfkit as pf
from pfkit.models.targets import CircleTarget, FixedTarget, HeadingTarget, LineTarget

U = (2.0, 0.1, 1.5)
MODELS = [
    (FixedTarget(1.0), 2),
    (HeadingTarget(1.0, heading=0.3), 2),
    (LineTarget(1.0, 0.1), 3),
    (CircleTarget(1.0, 0.1), 3),
]


@pytest.mark.parametrize(("model", "D"), MODELS)
def test_one_state_a_cloud_and_a_batch_agree(model, D):
    rng = np.random.default_rng(0)
    batch = rng.normal(size=(D, 4, 5))
    whole = model.mean(batch, U)
    for b in range(4):
        np.testing.assert_allclose(model.mean(batch[:, b], U), whole[:, b])
        np.testing.assert_allclose(model.mean(batch[:, b, 0], U), whole[:, b, 0])


@pytest.mark.parametrize(("model", "D"), MODELS)
def test_inputs_are_left_alone(model, D):
    state = np.ones((D, 3))
    model.mean(state, U)
    model.sample(state, U, np.random.default_rng(0))
    assert (state == 1).all()


def test_means_against_the_equations():
    x, y, theta = 1.0, 2.0, 0.7
    v, omega, dt = U
    state = np.array([x, y, theta])
    ahead = [x + v * dt * math.cos(theta), y + v * dt * math.sin(theta)]
    np.testing.assert_allclose(FixedTarget(0).mean(state, U), state)
    np.testing.assert_allclose(LineTarget(0).mean(state, U), [*ahead, theta])
    np.testing.assert_allclose(CircleTarget(0).mean(state, U), [*ahead, theta + omega * dt])
    np.testing.assert_allclose(HeadingTarget(0, heading=theta).mean(state[:2], U), ahead)


def test_the_circle_closes_and_has_its_radius():
    n, v = 400, 2.0
    omega = 2 * math.pi / n
    model, state = CircleTarget(0.0), np.array([10.0, 20.0, 0.4])
    path = [state]
    for _ in range(n):
        path.append(model.mean(path[-1], (v, omega, 1.0)))
    np.testing.assert_allclose(path[-1], state, atol=1e-9)
    xy = np.array(path)[:-1, :2]
    radii = np.hypot(*(xy - xy.mean(0)).T)
    # a polygon of n sides of length v: its corners lie at v / (2 sin(omega / 2))
    np.testing.assert_allclose(radii, v / (2 * math.sin(omega / 2)), rtol=1e-9)
    assert radii[0] == pytest.approx(v / omega, rel=1e-4)


@pytest.mark.parametrize(("model", "D"), MODELS)
def test_noise_is_fresh_for_each_particle_and_has_the_stated_sd(model, D):
    n = 20_000
    state = np.zeros((D, n))
    moved = model.sample(state, U, np.random.default_rng(1)) - model.mean(state, U)
    z = (moved[:2].std(axis=1) - 1.0) * math.sqrt(2 * n)
    assert np.abs(z).max() < 5  # standard error of an sd is sd / sqrt(2 n)
    assert abs(np.corrcoef(moved[:2])[0, 1]) < 5 / math.sqrt(n)
    if D == 3:
        assert abs(moved[2].std() - 0.1) < 5 * 0.1 / math.sqrt(2 * n)


def test_headings_stay_wrapped():
    state = np.full((3, 100), 3.1)
    moved = CircleTarget(0.0, 0.5).sample(state, U, np.random.default_rng(2))
    assert (np.abs(moved[2]) <= math.pi).all()


def test_rigid_motion_of_the_world_moves_the_answer():
    turn, shift = 0.9, np.array([3.0, -2.0])
    R = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    state = np.random.default_rng(3).normal(size=(3, 50))

    def move(s):
        return np.vstack([R @ s[:2] + shift[:, None], pf.wrap(s[2] + turn)])

    for model in (LineTarget(0.0), CircleTarget(0.0)):
        np.testing.assert_allclose(
            model.mean(move(state), U), move(model.mean(state, U)), atol=1e-12
        )


def test_errors_name_the_value():
    with pytest.raises(pf.ParameterError, match="sigma"):
        FixedTarget(-1.0)
    with pytest.raises(pf.ShapeError):
        LineTarget(1.0).mean(np.zeros((2, 5)), U)
