"""Simulated logs: the right densities, the right shapes, and the truth told as it was."""

import math

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds

STILL = pf.VelocityMotion((0.0,) * 4)
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


def test_a_log_tells_its_shapes_and_times():
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng())
    assert len(log) == 30
    assert log.truth.shape == (3, 30)
    assert log.z[0].shape == (3, 3)
    np.testing.assert_allclose(log.t, 0.1 * np.arange(1, 31))
    assert log.world is WORLD
    assert log.outlier is None
    np.testing.assert_array_equal(log.start, START)


def test_without_motion_noise_the_truth_is_dead_reckoning():
    log = pf.simulate_log(START, TURN, STILL, SENSOR, rng())
    np.testing.assert_allclose(log.truth, pf.dead_reckoning(log, STILL), atol=1e-12)


def test_measurement_errors_are_those_of_the_sensor():
    log = pf.simulate_log(START, np.tile(TURN, 40), NOISY, SENSOR, rng())
    e = residuals(log)  # (T, 2, K)
    n = e[:, 0].size
    for row, sigma in enumerate((0.2, 0.1)):
        assert abs(e[:, row].mean()) < 4.5 * sigma / math.sqrt(n)
        assert abs(e[:, row].std() / sigma - 1) < 4.5 / math.sqrt(2 * n)


def test_a_batch_of_one_is_the_single_run_bit_for_bit():
    one = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(5))
    batch = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(5), batch=1)
    np.testing.assert_array_equal(batch.truth[..., 0, 0], one.truth)
    np.testing.assert_array_equal(np.stack(batch.z)[..., 0, 0], np.stack(one.z))


def test_a_batched_log_runs_a_batch_of_filters():
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(1), batch=6, every=3)
    assert log.truth.shape == (3, 30, 6, 1)
    assert log.z[2].shape == (3, 3, 6, 1)
    assert log.z[0].shape == (3, 0, 6, 1)
    bel = pf.gaussian_prior((6, 300), START, np.full(3, 0.1), rng(2))
    history = pf.run(log, bel, NOISY, SENSOR, rng(3))
    errors = pf.rmse(history.estimate, history.truth)
    assert errors.shape == (6,)
    assert errors.max() < 0.3


def test_robots_of_a_batch_differ():
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(1), batch=4)
    assert len(np.unique(log.truth[0, -1])) == 4


def test_the_route_does_not_depend_on_the_sensor():
    plain = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(7))
    sparse = pf.simulate_log(START, TURN, NOISY, pf.Range(WORLD, 1.0), rng(7), every=4)
    np.testing.assert_array_equal(plain.truth, sparse.truth)


def test_every_measures_at_the_nth_step_only():
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(), every=4)
    assert [k for k, z in enumerate(log.z) if z.shape[1]] == list(range(3, 30, 4))


def test_the_world_may_move_with_the_robot():
    g = np.array([5.0, -3.0, 1.2])
    corners = np.vstack((WORLD.positions, np.zeros(3)))
    moved_world = pf.LandmarkMap(pf.compose(g[:, None], corners)[:2])
    moved = pf.RangeBearing(moved_world, 0.2, 0.1)
    here = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(4))
    there = pf.simulate_log(pf.compose(g, START), TURN, NOISY, moved, rng(4))
    np.testing.assert_allclose(there.truth, pf.compose(g[:, None], here.truth), atol=1e-12)
    np.testing.assert_allclose(np.stack(there.z), np.stack(here.z), atol=1e-12)


def test_states_need_not_be_poses():
    class Drift:
        def mean(self, state, u):
            return np.stack((state[0] + u[0], state[1] + u[1]))

        def sample(self, state, u, rng):
            return self.mean(state, u) + rng.standard_normal(state.shape)

    class Where:
        components = 2

        def sample(self, state, rng):
            return state[:, None] + rng.standard_normal((2, 1, *state.shape[1:]))

    u = np.ones((2, 12))
    log = pf.simulate_log(np.zeros(2), u, Drift(), Where(), rng(), batch=3)
    assert log.truth.shape == (2, 12, 3, 1)
    assert log.z[0].shape == (2, 1, 3, 1)
    np.testing.assert_allclose(log.t, np.arange(1, 13))


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"start": np.zeros((3, 4))}, pf.ShapeError, "start"),
        ({"u": np.zeros(3)}, pf.ShapeError, "u must have shape"),
        ({"u": np.full((3, 5), np.nan)}, pf.ParameterError, "u must be finite"),
        ({"u": lambda k, pose: TURN[:, 0]}, pf.ParameterError, "steps"),
        ({"every": 0}, pf.ParameterError, "every"),
        ({"kidnap": {99: None}}, pf.ParameterError, "kidnap at step 99"),
        ({"dt": 0.0}, pf.ParameterError, "dt"),
        ({"batch": 0}, pf.ParameterError, "batch"),
        ({"outliers": pf.Outliers(0.1, (0,) * 4, (1,) * 4)}, pf.ShapeError, "rows"),
    ],
)
def test_bad_input_is_named(change, error, message):
    good = {"start": START, "u": TURN, "motion": NOISY, "sensor": SENSOR, "rng": rng()}
    with pytest.raises(error, match=message):
        pf.simulate_log(**(good | change))


def test_beams_of_a_batch_are_those_of_ray_casting_but_for_labelled_ones():
    grid = worlds.office()
    directions = np.linspace(-2.0, 2.0, 9)
    perfect = {"z_hit": 1.0, "z_short": 0.0, "z_max": 0.0, "z_rand": 0.0}
    sensor = pf.BeamModel(grid, directions, 8.0, sigma_hit=0.02, **perfect)
    log = pf.simulate_log(
        worlds.OFFICE_START,
        pf.PurePursuit(worlds.OFFICE_ROUTE, v=0.5, dt=0.2),
        pf.VelocityMotion((0.005, 0.001, 0.001, 0.01)),
        sensor,
        rng(),
        steps=40,
        batch=3,
        every=5,
        outliers=pf.Outliers(0.2, (0.0,), (8.0,)),
        kidnap={20: None},
    )
    assert log.world is grid
    assert grid.contains(*log.truth[:2, 20]).all()
    for k in range(4, 40, 5):
        honest = ~log.outlier[k]
        miss = log.z[k][0] - sensor.expected(log.truth[:, k])[0]
        assert np.abs(miss[honest]).max() < 6 * 0.02
        assert log.z[k].shape == (2, 9, 3, 1)
    assert 0.1 < np.mean([labels.mean() for labels in log.outlier[4::5]]) < 0.3


def test_bad_parts_are_named():
    clocks = np.ones((3, 4, 2, 1)) * np.array([1.0, 2.0]).reshape(2, 1)
    with pytest.raises(pf.ParameterError, match="clock"):
        pf.simulate_log(np.zeros((3, 2, 1)), clocks, STILL, SENSOR, rng())
    with pytest.raises(pf.ShapeError, match="truth"):
        pf.sense(START, SENSOR, rng())
    with pytest.raises(pf.ShapeError, match=r"start must have shape \(D,\)"):
        pf.simulate_log(np.zeros((3, 2, 1)), TURN, STILL, SENSOR, rng(), batch=2)
