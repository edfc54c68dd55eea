"""Densities, the base class, and the sensors that need no map."""

import math

import numpy as np
import pytest

import pfkit as pf
from pfkit.densities import error_density

GRID = np.linspace(-60, 60, 240_001)


def integral(log_density, x):
    return float(np.exp(log_density).sum() * (x[1] - x[0]))


@pytest.mark.parametrize("sigma", [0.3, 2.0])
def test_the_densities_integrate_to_one(sigma):
    assert integral(pf.log_gaussian(GRID, sigma), GRID) == pytest.approx(1.0, abs=1e-9)
    for nu in (3.0, 8.0):
        assert integral(error_density(GRID, sigma, nu), GRID) == pytest.approx(1.0, abs=2e-4)


def test_students_t_tends_to_the_gaussian_and_has_the_cauchy_peak():
    e = np.linspace(-3, 3, 11)
    np.testing.assert_allclose(error_density(e, 1.0, 1e8), pf.log_gaussian(e, 1.0), atol=1e-6)
    assert error_density(np.zeros(1), 2.0, 1.0) == pytest.approx(-math.log(2 * math.pi))


def test_several_measurements_multiply():
    sensor = pf.Compass(0.3)
    pose, z = np.random.default_rng(0).normal(size=(3, 6)), np.array([[0.1, -0.4, 2.0]])
    each = [sensor.log_likelihood(z[:, [k]], pose) for k in range(3)]
    np.testing.assert_allclose(sensor.log_likelihood(z, pose), sum(each))
    np.testing.assert_allclose(sensor.log_likelihood(z[:, 0], pose), each[0])
    np.testing.assert_array_equal(sensor.log_likelihood(np.empty((1, 0)), pose), np.zeros(6))


def test_a_set_for_each_filter_of_a_batch():
    rng = np.random.default_rng(1)
    pose, z = rng.normal(size=(3, 4, 6)), rng.normal(size=(2, 5, 4, 1))
    sensor = pf.Position(sigma=0.5)
    batch = sensor.log_likelihood(z, pose)
    for b in range(4):
        np.testing.assert_allclose(batch[b], sensor.log_likelihood(z[:, :, b, 0], pose[:, b]))


def test_the_compass_reads_across_the_seam():
    sensor = pf.Compass(0.1)
    pose = np.array([[0.0, 0.0], [0.0, 0.0], [np.pi - 0.01, -np.pi + 0.03]])
    log_p = sensor.log_likelihood(np.array([[np.pi]]), pose)
    np.testing.assert_allclose(log_p, pf.log_gaussian([0.01, 0.03], 0.1))


def test_the_compass_draws_what_it_expects():
    sensor, M = pf.Compass(0.2, bias=0.1), 20_000
    pose = np.tile(np.array((5.0, 6.0, 3.0))[:, None], M)
    assert sensor.expected(pose).shape == (1, 1, M)
    error = pf.wrap(sensor.sample(pose, np.random.default_rng(2))[0, 0] - 3.1)
    assert abs(error.mean()) < 5 * 0.2 / math.sqrt(M)
    assert error.std() == pytest.approx(0.2, rel=5 / math.sqrt(2 * M))
    peak = sensor.log_likelihood(np.array([[3.1]]), pose[:, :1])
    assert peak[0] == pytest.approx(-math.log(0.2 * math.sqrt(2 * math.pi)))


def test_a_position_has_the_density_of_the_book():
    """Loop twin: the quadratic form with the inverse and the determinant written out."""
    rng = np.random.default_rng(3)
    state, z = rng.normal(size=(5, 20)), np.array([[0.7, 1.0], [-0.4, 0.0]])
    for sigma, Sigma in ((1.5, 2.25 * np.eye(2)), ((1.0, 2.0), np.diag((1.0, 4.0)))):
        log_p = pf.Position(sigma).log_likelihood(z, state)
        for m in range(20):
            expected = 0.0
            for nu in (z - state[:2, [m]]).T:
                form = nu @ np.linalg.inv(Sigma) @ nu
                expected -= 0.5 * form + math.log(2 * math.pi * math.sqrt(np.linalg.det(Sigma)))
            assert log_p[m] == pytest.approx(expected)


def test_position_fixes_have_the_stated_covariance():
    """Entries of a sample covariance within 5 standard errors."""
    M, Sigma = 40_000, np.diag((0.25, 4.0))
    z = pf.Position((0.5, 2.0)).sample(np.zeros((2, M)), np.random.default_rng(5))
    assert z.shape == (2, 1, M)
    error = np.sqrt((Sigma**2 + np.outer(np.diag(Sigma), np.diag(Sigma))) / M)
    assert (np.abs(np.cov(z[:, 0]) - Sigma) < 5 * error).all()


@pytest.mark.parametrize(
    "make, error, match",
    [
        (
            lambda: pf.Position(sigma=(1.0, 2.0, 3.0)),
            pf.ShapeError,
            r"sigma must have shape \(2,\), got \(3,\)",
        ),
        (lambda: pf.Position(sigma=0.0), pf.ParameterError, "no density"),
        (lambda: pf.Compass(-0.1), pf.ParameterError, "sigma_theta"),
        (lambda: pf.Compass(0.1, nu=0.0), pf.ParameterError, "nu"),
        (lambda: pf.Compass(0.1, bias=math.nan), pf.ParameterError, "bias"),
        (lambda: pf.Compass(0.1).log_likelihood([[math.nan]], np.zeros((3, 2))), pf.DataError, "z"),
        (lambda: pf.Compass(0.1).log_likelihood([[1], [2]], np.zeros((3, 2))), pf.ShapeError, "z"),
    ],
)
def test_bad_input_is_named(make, error, match):
    with pytest.raises(error, match=match):
        make()


def test_a_sensor_without_a_density_says_so():
    class Half(pf.Sensor):
        components = 1

    with pytest.raises(NotImplementedError):
        Half().log_likelihood([[1.0]], np.zeros((3, 2)))
