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


def test_execution_errors_are_those_of_the_motion_model():
    motion = pf.VelocityMotion((0.04, 0.0, 0.0, 0.0))
    u = np.tile(np.array([[1.0], [0.0], [1.0]]), 4000)
    _, truth = pf.drive(np.zeros(3), u, motion, rng())
    strides = np.diff(truth[0], prepend=0.0)
    assert abs(strides.mean() - 1) < 4.5 * 0.2 / math.sqrt(4000)
    assert abs(strides.std() / 0.2 - 1) < 4.5 / math.sqrt(8000)


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


# sight


def test_sight_by_range_and_by_field_of_view():
    near = pf.Sight(WORLD, r_max=4.0)
    np.testing.assert_array_equal(near(np.array([3.0, 2.0, 0.0])), [True, True, False])
    ahead = pf.Sight(WORLD, fov=np.pi)
    np.testing.assert_array_equal(ahead(np.array([3.0, 2.0, 0.0])), [False, True, True])
    np.testing.assert_array_equal(ahead(np.array([3.0, 2.0, np.pi])), [True, False, False])
    poses = rng().uniform(-3, 3, size=(3, 7, 1))
    assert ahead(poses).shape == (3, 7, 1)


def test_only_seen_landmarks_are_measured():
    sight = pf.Sight(WORLD, r_max=4.0, fov=np.pi)
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(), sight=sight)
    assert {z.shape[1] for z in log.z} != {3}
    for _, _, z, truth in log:
        np.testing.assert_array_equal(z[2], WORLD.ids[sight(truth)])


def test_intermittent_columns_say_nothing_when_unseen():
    sensor = pf.Intermittent(SENSOR)
    pose = rng().uniform(-3, 3, size=(3, 50))
    z = sensor.sample(START, rng())
    z[-1] = [1, 0, 1]
    expected = SENSOR.log_likelihood(z[:3, [0, 2]], pose)
    np.testing.assert_allclose(sensor.log_likelihood(z, pose), expected)
    np.testing.assert_array_equal(sensor.expected(START)[:3], SENSOR.expected(START))


def test_a_batch_with_sight_marks_what_each_robot_sees():
    sight, sensor = pf.Sight(WORLD, r_max=4.0), pf.Intermittent(SENSOR)
    log = pf.simulate_log(START, TURN, NOISY, sensor, rng(), batch=5, sight=sight)
    for _, _, z, truth in log:
        np.testing.assert_array_equal(z[-1], sight(truth))
    with pytest.raises(pf.ParameterError, match="Intermittent"):
        pf.simulate_log(START, TURN, NOISY, SENSOR, rng(), batch=5, sight=sight)


# outliers


def test_outliers_are_labelled_and_as_many_as_asked_for():
    false = pf.Outliers(0.3, (0.0, -np.pi), (10.0, np.pi))
    log = pf.simulate_log(START, np.tile(TURN, 30), NOISY, SENSOR, rng(), outliers=false)
    labels = np.stack(log.outlier)
    n = labels.size
    assert abs(labels.mean() - 0.3) < 4.5 * math.sqrt(0.3 * 0.7 / n)
    e = residuals(log)[:, 0]
    assert np.abs(e[~labels]).max() < 6 * 0.2  # honest ones stay honest
    z = np.stack(log.z)
    wild = z[:, 0][labels]
    assert abs(wild.mean() - 5) < 4.5 * 10 / math.sqrt(12 * wild.size)
    np.testing.assert_array_equal(z[:, 2], np.tile(WORLD.ids, (len(log), 1)))  # ids stay
    assert false.density == pytest.approx(1 / (20 * np.pi))


def test_outliers_do_not_change_the_honest_measurements():
    false = pf.Outliers(0.3, (0.0, -np.pi), (10.0, np.pi))
    _, truth = pf.drive(START, TURN, NOISY, rng())
    never = pf.Outliers(0.0, false.low, false.high)
    a, _ = pf.sense(truth, SENSOR, rng(1), outliers=never)
    b, labels = pf.sense(truth, SENSOR, rng(1), outliers=false)
    for one, other, bad in zip(a, b, labels, strict=True):
        np.testing.assert_array_equal(one[:, ~bad], other[:, ~bad])


def test_a_batch_has_labels_of_its_own():
    false = pf.Outliers(0.5, (0.0,), (10.0,))
    log = pf.simulate_log(START, TURN, NOISY, SENSOR, rng(), batch=4, outliers=false)
    assert log.outlier[0].shape == (3, 4, 1)


# kidnapping


def test_kidnapping_moves_the_robot_and_tells_nobody():
    goal = np.array([0.0, 5.0, -1.0])
    log = pf.simulate_log(START, TURN, STILL, SENSOR, rng(), kidnap={9: goal})
    free = pf.simulate_log(START, TURN, STILL, SENSOR, rng())
    np.testing.assert_array_equal(log.u, free.u)
    np.testing.assert_array_equal(log.truth[:, :9], free.truth[:, :9])
    np.testing.assert_array_equal(log.truth[:, 9], goal)
    np.testing.assert_allclose(log.truth[:, 10], STILL.mean(goal, TURN[:, 10]))


def test_kidnapping_to_anywhere_stays_in_the_world():
    log = pf.simulate_log(START, TURN, STILL, SENSOR, rng(), kidnap={9: None}, batch=50)
    taken = log.truth[:, 9, :, 0]
    assert WORLD.contains(*taken[:2]).all()
    assert len(np.unique(taken[0])) == 50


# drivers


def test_commands_cut_time_into_steps_that_add_up():
    u = pf.commands([(0.5, 0.0, 1.0), (0.0, 0.3, 0.25)], dt=0.1)
    np.testing.assert_allclose(u[2], [0.1] * 10 + [0.1, 0.1, 0.05])
    assert u[0] @ u[2] == pytest.approx(0.5)
    assert u[1] @ u[2] == pytest.approx(0.075)


def test_command_lists_drive_the_published_figure():
    """Ahead, quarter turn right, ahead, quarter turn left, ahead: (1, -.5, 0)."""
    quarter = np.pi / 2
    u = pf.commands([(0.5, 0, 1), (0, -quarter, 1), (0.5, 0, 1), (0, quarter, 1), (0.5, 0, 1)], 0.1)
    _, truth = pf.drive(np.zeros(3), u, STILL, rng())
    np.testing.assert_allclose(truth[:, -1], [1.0, -0.5, 0.0], atol=1e-12)


def test_pure_pursuit_stays_on_the_route_despite_noise():
    points = np.array([[0.0, 6.0, 6.0, 0.0], [0.0, 0.0, 4.0, 4.0]])
    driver = pf.PurePursuit(points, v=0.5, dt=0.1, lookahead=0.4)
    _, truth = pf.drive(np.zeros((3, 5, 1)), driver, NOISY, rng(), steps=600)
    x, y = truth[:2, ..., 0]
    to_sides = np.minimum.reduce([np.abs(y), np.abs(y - 4), np.abs(x), np.abs(x - 6)])
    assert to_sides.max() < 0.4
    assert x.max() > 5.8 and y.max() > 3.8  # it went round


def test_pure_pursuit_stops_at_the_end_of_an_open_route():
    driver = pf.PurePursuit([[0.0, 2.0], [0.0, 0.0]], v=0.5, dt=0.1, closed=False)
    u, truth = pf.drive(np.zeros(3), driver, STILL, rng(), steps=60)
    assert (u[0, -15:] == 0).all()
    np.testing.assert_allclose(truth[:, -1], [2.0, 0.0, 0.0], atol=0.06)


def test_pure_pursuit_of_a_batch_is_that_of_its_robots():
    driver = pf.PurePursuit([[0.0, 6.0, 3.0], [0.0, 0.0, 4.0]], v=0.5, dt=0.1)
    poses = rng().uniform(-1, 5, size=(3, 8, 1))
    together = driver(0, poses)
    for b in range(8):
        np.testing.assert_allclose(together[:, b, 0], driver(0, poses[:, b, 0]))


def test_odometry_along_a_path_leads_back_along_it():
    _, truth = pf.drive(START, TURN, NOISY, rng())
    u = pf.odometry_along(START, truth)
    log = pf.simulate_log(START, u, pf.OdometryMotion((0.0,) * 4), SENSOR, rng())
    np.testing.assert_allclose(log.truth, truth, atol=1e-12)
    np.testing.assert_allclose(log.t, np.arange(1, 31))
    noisy = pf.odometry_along(START, truth, pf.OdometryMotion(), rng())
    assert not np.allclose(noisy, u)


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
        ({"u": np.zeros(3)}, pf.ShapeError, "u must be"),
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


def test_a_motion_model_that_breaks_the_shape_is_named():
    class Careless:
        def sample(self, pose, u, rng):
            return pose + u

    with pytest.raises(pf.ShapeError, match="row by row"):
        pf.drive(START[:, None, None], TURN, Careless(), rng())


def test_bad_parts_are_named():
    with pytest.raises(pf.ParameterError, match="r_max"):
        pf.Sight(WORLD, r_max=0)
    with pytest.raises(pf.ParameterError, match="fov"):
        pf.Sight(WORLD, fov=7)
    with pytest.raises(pf.ParameterError, match="low"):
        pf.Outliers(0.1, (1.0,), (0.0,))
    with pytest.raises(pf.ParameterError, match="way-points"):
        pf.PurePursuit([[0, 0, 1], [0, 0, 1]], 1, 0.1)
    with pytest.raises(pf.ShapeError, match="points"):
        pf.PurePursuit([[0], [0]], 1, 0.1)
    with pytest.raises(pf.ParameterError, match="last"):
        pf.commands([(1, 0, -1)], 0.1)
    with pytest.raises(pf.ShapeError, match="command"):
        pf.commands([(1, 0)], 0.1)
    with pytest.raises(pf.ParameterError, match="rng"):
        pf.odometry_along(START, START[:, None], pf.OdometryMotion())
    with pytest.raises(pf.ParameterError, match="world"):
        pf.drive(START, TURN, STILL, rng(), kidnap={0: None})
    clocks = np.ones((3, 4, 2, 1)) * np.array([1.0, 2.0]).reshape(2, 1)
    with pytest.raises(pf.ParameterError, match="clock"):
        pf.simulate_log(np.zeros((3, 2, 1)), clocks, STILL, SENSOR, rng())
    with pytest.raises(pf.ShapeError, match="truth"):
        pf.sense(START, SENSOR, rng())
    with pytest.raises(pf.ShapeError, match="drop batch"):
        pf.simulate_log(np.zeros((3, 2, 1)), TURN, STILL, SENSOR, rng(), batch=2)


# beams in a grid


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
