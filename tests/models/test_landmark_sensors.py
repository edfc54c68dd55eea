"""Range, bearing, and both: round trips, densities, equivariance, published figures."""

import math

import numpy as np
import pytest

import pfkit as pf
from pfkit.densities import error_density

WORLD = pf.LandmarkMap(np.array([[0.0, 4.0, -2.0, 7.0], [3.0, -1.0, -5.0, 2.5]]), [6, 13, 17, 4])


def sensors(**noise):
    return (
        pf.Range(WORLD, 0.4, bias=(0.1, 0.2, 0.3, 0.4), **noise),
        pf.Bearing(WORLD, 0.2, bias_phi=0.05, **noise),
        pf.RangeBearing(WORLD, 0.4, 0.2, bias_phi=-0.05, **noise),
    )


def test_range_and_bearing_lead_back_to_the_robot_in_all_quadrants():
    rng = np.random.default_rng(0)
    pose = rng.uniform((-9, -9, -np.pi), (9, 9, np.pi), (300, 3)).T
    r, phi, s = pf.RangeBearing(WORLD, 1.0, 1.0).expected(pose)
    assert (np.abs(phi) <= np.pi).all() and r.shape == (4, 300)
    mx, my = WORLD.locate(s)
    np.testing.assert_allclose(mx - r * np.cos(phi + pose[2]), np.tile(pose[0], (4, 1)), atol=1e-12)
    np.testing.assert_allclose(my - r * np.sin(phi + pose[2]), np.tile(pose[1], (4, 1)), atol=1e-12)
    quadrants = np.stack((np.cos(phi) > 0, np.sin(phi) > 0)).reshape(2, -1)
    assert np.unique(quadrants, axis=1).shape[1] == 4


@pytest.mark.parametrize(
    "pose, landmark, position, r, phi",
    [
        ((2, 3, 0), 6, (0.48704624, -4.95127346), 8.09393468689, -1.75882673717),
        ((0, 3, 0), 13, (0.91765949, 0.59631939), 2.5728931992, -1.20610126119),
        ((1, -2, 0), 17, (3.26730988, 2.52731607), 5.06332745234, 1.10650362626),
    ],
)
def test_the_figures_published_in_2019(pose, landmark, position, r, phi):
    world = pf.LandmarkMap(np.array(position)[:, None], [landmark], (-5, 5, -5, 5))
    z = pf.RangeBearing(world, 1.0, 1.0).expected(np.array(pose, float))[:, 0]
    np.testing.assert_allclose(z, (r, phi, landmark), atol=1e-10)


def loop_log_likelihood(sensor, z, pose):
    """Loop twin: one particle and one measurement at a time, with `math` only."""
    total = np.zeros(pose.shape[1])
    for m, (x, y, theta) in enumerate(pose.T):
        for column in z.T:
            mx, my = WORLD.locate(int(column[-1]))
            errors = []
            if isinstance(sensor, pf.Range):
                bias = sensor.bias[list(WORLD.ids).index(int(column[-1]))]
                errors.append((column[0] - bias - math.dist((x, y), (mx, my)), sensor.sigma_r))
            else:
                phi = column[-2] - sensor.bias_phi - (math.atan2(my - y, mx - x) - theta)
                errors.append((math.remainder(phi, 2 * math.pi), sensor.sigma_phi))
            if isinstance(sensor, pf.RangeBearing):
                errors.append((column[0] - math.dist((x, y), (mx, my)), sensor.sigma_r))
            for error, sigma in errors:
                total[m] += float(error_density(np.array(error), sigma, sensor.nu))
    return total


@pytest.mark.parametrize("sensor", [*sensors(), *sensors(nu=4.0)], ids=lambda s: type(s).__name__)
def test_the_likelihood_agrees_with_its_loop_twin(sensor):
    rng = np.random.default_rng(1)
    z = sensor.sample(np.array((1.0, -1.0, 3.0)), rng)
    pose = rng.uniform(-4, 4, (3, 30))
    np.testing.assert_allclose(
        sensor.log_likelihood(z, pose), loop_log_likelihood(sensor, z, pose), rtol=1e-10
    )


@pytest.mark.parametrize("sensor", sensors(), ids=lambda s: type(s).__name__)
def test_samples_scatter_about_the_expected_measurement(sensor):
    """Mean and deviation of 20,000 draws within 5 standard errors."""
    M = 20_000
    pose = np.tile(np.array((1.0, -1.0, 2.8))[:, None], M)
    error = sensor.sample(pose, np.random.default_rng(2)) - sensor.expected(pose)
    sigmas = [v for v in (getattr(sensor, "sigma_r", 0), getattr(sensor, "sigma_phi", 0)) if v]
    for row, sigma in zip(error, sigmas, strict=False):
        row = pf.wrap(row)
        assert (np.abs(row.mean(axis=-1)) < 5 * sigma / math.sqrt(M)).all()
        np.testing.assert_allclose(row.std(axis=-1), sigma, rtol=5 / math.sqrt(2 * M))
    np.testing.assert_array_equal(error[-1], 0.0)


@pytest.mark.parametrize("sensor", sensors(), ids=lambda s: type(s).__name__)
def test_the_density_of_one_measurement_integrates_to_one(sensor):
    pose = np.array((1.0, -1.0, 2.8))
    r, phi = np.linspace(0, 12, 601), np.linspace(-np.pi, np.pi, 601)[:-1]
    axes = {2: [r] if isinstance(sensor, pf.Range) else [phi], 3: [r, phi]}[sensor.components]
    grid = np.stack(np.meshgrid(*axes, np.array([17.0]), indexing="ij")).reshape(len(axes) + 1, -1)
    cell = math.prod(axis[1] - axis[0] for axis in axes)
    density = np.exp(sensor.log_density(grid, pose[:, None])).sum() * cell
    assert density == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize("kind", [0, 1, 2])
def test_moving_robot_and_world_together_changes_nothing(kind):
    g = np.array((5.0, -2.0, 2.2))
    moved_marks = pf.compose(g, np.vstack((WORLD.positions, np.zeros((1, 4)))))[:2]
    moved = pf.LandmarkMap(moved_marks, WORLD.ids)
    rng = np.random.default_rng(3)
    here = sensors()[kind]
    settings = {k: v for k, v in vars(here).items() if k[0] != "_" and k != "world"}
    there = type(here)(moved, **settings)
    pose = rng.uniform(-4, 4, (3, 30))
    z = here.sample(pose[:, 0], rng)
    np.testing.assert_allclose(
        there.log_likelihood(z, pf.compose(g, pose)), here.log_likelihood(z, pose), atol=1e-9
    )


def test_range_and_bearing_to_one_landmark_leave_a_circle():
    """Turning robot and heading about the landmark changes no likelihood."""
    world = pf.LandmarkMap(np.array([[2.0], [1.0]]), [0], (0, 5, 0, 5))
    sensor = pf.RangeBearing(world, 0.1, 0.1)
    about = np.linspace(-3, 3, 40)
    turn = np.stack((np.full(40, 2.0), np.full(40, 1.0), about))
    pose = pf.compose(turn, (1.5, 0.0, 0.4))
    log_p = sensor.log_likelihood(sensor.expected(pose[:, 0]), pose)
    np.testing.assert_allclose(log_p, log_p[0], atol=1e-9)


def test_some_landmarks_only_and_a_batch():
    pose = np.zeros((3, 5, 7))
    for sensor in sensors():
        z = sensor.expected(pose, ids=[17, 6])
        assert z.shape == (sensor.components, 2, 5, 7)
        np.testing.assert_array_equal(z[-1, :, 0, 0], (17, 6))
        assert sensor.log_likelihood(z[..., :1], pose).shape == (5, 7)


def test_bad_input_is_named():
    with pytest.raises(pf.UnknownLandmarkError, match="99"):
        pf.Bearing(WORLD, 0.1).log_likelihood([[0.1], [99]], np.zeros((3, 2)))
    with pytest.raises(pf.ShapeError, match=r"bias must have shape \(4,\), got \(2,\)"):
        pf.Range(WORLD, 0.1, bias=(1.0, 2.0))
    for make in (
        lambda: pf.Range(WORLD, 0.0),
        lambda: pf.Bearing(WORLD, -1.0),
        lambda: pf.Bearing(WORLD, 1.0, nu=-1.0),
        lambda: pf.RangeBearing(WORLD, 0.1, 0.1, bias_phi=math.inf),
    ):
        with pytest.raises(pf.ParameterError):
            make()
