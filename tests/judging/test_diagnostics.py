"""Errors, dead reckoning and counts, against hand computation and loop twins."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.worlds.log import Log


def rng(seed=0):
    return np.random.default_rng(seed)


def circle_log(T=40, v=1.0, omega=0.2, dt=0.1):
    u = np.tile(np.array([[v], [omega], [dt]]), T)
    t = dt * np.arange(1, T + 1)
    R = v / omega
    truth = np.stack((R * np.sin(omega * t), R - R * np.cos(omega * t), omega * t))
    return Log(t, u, [np.empty((3, 0))] * T, truth, np.zeros(3))


def test_pose_error_wraps_the_heading():
    error = pf.pose_error([1.0, 2.0, np.pi - 0.1], [0.0, 4.0, -np.pi + 0.1])
    np.testing.assert_allclose(error, [1.0, -2.0, -0.2], atol=1e-12)
    assert pf.position_error([4.0, 6.0, 0.0], [1.0, 2.0, 0.0]) == pytest.approx(5.0)


def test_two_component_states_have_no_heading():
    np.testing.assert_allclose(pf.pose_error([7.0, 7.0], [0.0, 0.0]), [7.0, 7.0])


def test_rmse_matches_a_loop_and_a_truth_serves_a_whole_batch():
    estimate, truth = rng().normal(size=(3, 20, 4)), rng(1).normal(size=(3, 20))
    by_hand = [
        np.sqrt(
            sum(
                (estimate[0, t, b] - truth[0, t]) ** 2 + (estimate[1, t, b] - truth[1, t]) ** 2
                for t in range(20)
            )
            / 20
        )
        for b in range(4)
    ]
    np.testing.assert_allclose(pf.rmse(estimate, truth), by_hand)
    np.testing.assert_allclose(pf.rmse(estimate[..., 0], truth), by_hand[0])
    batched = np.repeat(truth[..., None, None], 4, axis=2)  # (3, T, B, 1), as a log has it
    np.testing.assert_allclose(pf.rmse(estimate, batched), by_hand)


def test_rmse_does_not_change_when_the_world_moves():
    estimate, truth = rng().normal(size=(3, 30)), rng(1).normal(size=(3, 30))
    g = np.array([3.0, -2.0, 2.5])[:, None]
    moved = pf.compose(g, estimate), pf.compose(g, truth)
    assert pf.rmse(*moved) == pytest.approx(pf.rmse(estimate, truth))
    assert pf.heading_rmse(*moved) == pytest.approx(pf.heading_rmse(estimate, truth))


def test_heading_rmse_of_a_whole_turn_is_zero():
    truth = rng().normal(size=(3, 10))
    assert pf.heading_rmse(truth + np.array([[5.0], [5.0], [2 * np.pi]]), truth) < 1e-12


@pytest.mark.parametrize(
    ("estimate", "truth", "error"),
    [
        (np.zeros((3, 5)), np.zeros((3, 4)), pf.ShapeError),
        (np.zeros((3, 5)), np.zeros(5), pf.ShapeError),
        (np.zeros((3, 5)), 0.0, pf.ShapeError),
        (np.zeros((1, 5)), np.zeros((1, 5)), TypeError),
        (np.full((3, 5), np.nan), np.zeros((3, 5)), pf.DataError),
        (np.zeros((3, 5)), np.full((3, 5), np.inf), pf.ParameterError),
    ],
)
def test_bad_errors_are_named(estimate, truth, error):
    with pytest.raises(error):
        pf.rmse(estimate, truth)


def test_steps_without_a_truth_are_not_scored():
    estimate, truth = rng().normal(size=(3, 20, 2)), rng(1).normal(size=(3, 20))
    truth[:, 5:9] = np.nan
    keep = np.r_[:5, 9:20]
    np.testing.assert_allclose(pf.rmse(estimate, truth), pf.rmse(estimate[:, keep], truth[:, keep]))
    np.testing.assert_allclose(
        pf.heading_rmse(estimate, truth), pf.heading_rmse(estimate[:, keep], truth[:, keep])
    )
    assert np.isnan(pf.position_error(estimate, truth)[5:9]).all()


def test_settle_time_is_the_start_of_the_good_ending():
    t = np.arange(1.0, 7.0)
    error = np.array([9, 0.1, 9, 0.1, 0.2, 0.3])
    assert pf.settling_time(t, error, 0.5) == 4.0
    assert pf.settling_time(t, error, 0.25) == np.inf
    assert pf.settling_time(t, np.zeros(6), 0.5) == 1.0
    both = pf.settling_time(t, np.stack((error, np.zeros(6)), axis=1), 0.5)
    np.testing.assert_array_equal(both, [4.0, 1.0])


def test_dead_reckoning_follows_the_circle_exactly():
    log = circle_log()
    path = pf.dead_reckoning(log, pf.VelocityMotion())
    assert pf.rmse(path, log.truth) < 1e-12


def test_dead_reckoning_batches_and_moves_with_its_start():
    log = circle_log()
    g = np.array([4.0, -1.0, 1.0])
    moved = pf.dead_reckoning(log, pf.VelocityMotion(), start=g)
    np.testing.assert_allclose(moved, pf.compose(g[:, None], log.truth), atol=1e-12)
    starts = np.stack((np.zeros(3), g), axis=1)[..., None]  # (3, B, 1)
    both = pf.dead_reckoning(log, pf.VelocityMotion(), start=starts)
    assert both.shape == (3, 40, 2, 1)
    np.testing.assert_allclose(both[:, :, 1, 0], moved, atol=1e-12)


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning")
def test_a_truth_that_is_never_known_gives_no_number():
    assert np.isnan(pf.rmse(np.zeros((3, 5)), np.full((3, 5), np.nan)))
    assert np.isnan(pf.rmse(np.zeros((3, 0)), np.zeros((3, 0))))


def test_dead_reckoning_without_a_start_is_refused():
    log = Log(np.ones(1), np.zeros((3, 1)), [np.empty((3, 0))])
    with pytest.raises(pf.ParameterError, match="pose must be real numbers, got None"):
        pf.dead_reckoning(log, pf.VelocityMotion())


def test_trace_repeats_the_history():
    log = circle_log(10)
    bel = pf.gaussian_prior(50, np.zeros(3), np.full(3, 0.1), rng())
    world = pf.LandmarkMap([[5.0], [5.0]])
    history = pf.run(log, bel, pf.VelocityMotion(), pf.RangeBearing(world, 0.1, 0.1), rng())
    table = pf.trace(history)
    np.testing.assert_array_equal(table["ess"], history.ess)
    np.testing.assert_allclose(
        np.sqrt(np.mean(table["error"] ** 2)), pf.rmse(history.estimate, history.truth)
    )


def test_what_cannot_be_tabulated_or_timed_is_named():
    log = circle_log(3)
    bel = pf.gaussian_prior((2, 50), np.zeros(3), np.full(3, 0.1), rng())
    sensor = pf.RangeBearing(pf.LandmarkMap([[5.0], [5.0]]), 0.1, 0.1)
    with pytest.raises(pf.ShapeError, match="columns must be"):
        pf.trace(pf.run(log, bel, pf.VelocityMotion(), sensor, rng()))
    with pytest.raises(pf.ShapeError, match=r"error must have shape \(3, ...\)"):
        pf.settling_time(np.arange(3), np.zeros(4), 1.0)
    with pytest.raises(pf.ParameterError, match="limit"):
        pf.settling_time(np.arange(3), np.zeros(3), 0.0)


def test_trace_without_a_truth_has_no_error():
    log = circle_log(3)
    blind = Log(log.t, log.u, log.z)
    bel = pf.gaussian_prior(50, np.zeros(3), np.full(3, 0.1), rng())
    sensor = pf.RangeBearing(pf.LandmarkMap([[5.0], [5.0]]), 0.1, 0.1)
    table = pf.trace(pf.run(blind, bel, pf.VelocityMotion(), sensor, rng()))
    assert np.isnan(table["error"]).all()
