"""EKF, UKF and smoother: exact where the world is linear, honest where it is nearly so."""

import math

import numpy as np
import pytest

import pfkit as pf

WORLD = pf.worlds.arena()
BOTH = pytest.mark.parametrize("transform", [pf.linearise, pf.unscented])
NOISY = pf.VelocityMotion((0.02, 0.01, 0.01, 0.02, 0.005, 0.005))
START = pf.Gaussian((3.0, 2.0, 0.4), (0.2, 0.1, 0.1))


def rng(seed=0):
    return np.random.default_rng(seed)


class LinearMotion:
    """x' = F x + s + noise, for a state of two."""

    F = np.array([[1.0, 0.5], [0.0, 0.9]])
    root = np.array([[0.5, 0.0], [0.2, 0.4]])

    def mean(self, state, u):
        return np.tensordot(self.F, state, axes=1) + u.reshape(2, *(1,) * (state.ndim - 1))

    def sample(self, state, u, rng):
        noise = np.stack([rng.standard_normal(state.shape[1:]) for _ in range(2)])
        return self.mean(state, u) + np.tensordot(self.root, noise, axes=1)


@BOTH
def test_a_linear_function_is_carried_exactly(transform):
    J = np.array([[1.0, 2.0, -0.5], [0.3, 0.0, 1.0]])
    mean, Sigma = np.array([1.0, -2.0, 0.5]), np.diag((0.5, 0.2, 1.0)) + 0.1
    y, Y, cross = transform(lambda x: J @ x, mean, Sigma)
    np.testing.assert_allclose(y, J @ mean, rtol=1e-9)
    np.testing.assert_allclose(Y, J @ Sigma @ J.T, rtol=1e-8)
    np.testing.assert_allclose(cross, Sigma @ J.T, rtol=1e-8)


def test_unscented_gets_the_mean_of_a_square_and_linearise_does_not():
    square = (lambda x: x[:1] ** 2 + x[1:], np.array([1.0, 0.0]), np.diag((0.25, 0.0)))
    assert pf.unscented(*square)[0] == pytest.approx(1.25)  # mu^2 + sigma^2
    assert pf.linearise(*square)[0] == pytest.approx(1.0)


@BOTH
def test_angles_that_straddle_pi_stay_together(transform):
    y, Y, _ = transform(
        lambda x: pf.wrap(x + np.pi), np.array([0.001]), np.array([[0.04]]), angles=(0,)
    )
    assert abs(pf.wrap(y - np.pi - 0.001))[0] < 1e-9
    assert Y[0, 0] == pytest.approx(0.04)


@BOTH
def test_predict_and_update_equal_kalman_on_a_linear_world(transform):
    motion, sensor = LinearMotion(), pf.Position(np.sqrt((0.5, 0.3)))
    bel = exact = pf.Gaussian((1.0, -1.0), [[2.0, 0.3], [0.3, 1.0]])
    for z in ((0.7, -0.2), (1.9, 0.1)):
        bel, _ = pf.gaussian_predict(bel, (0.2, -0.1), motion, transform)
        exact = pf.kalman_predict(exact, motion.F, motion.root @ motion.root.T, (0.2, -0.1))
        bel, e, _ = pf.gaussian_update(bel, np.array(z)[:, None], sensor, transform)
        exact, e_exact, _ = pf.kalman_update(exact, z, np.eye(2), np.diag((0.5, 0.3)))
        assert e == pytest.approx(e_exact, rel=1e-7)
        np.testing.assert_allclose(bel.mean, exact.mean, rtol=1e-7)
        np.testing.assert_allclose(bel.Sigma, exact.Sigma, rtol=1e-7)


@BOTH
@pytest.mark.parametrize(
    "motion, u",
    [
        (NOISY, (1.0, 0.5, 0.5)),
        (pf.OdometryMotion((0.02, 0.01, 0.02, 0.01)), (0.1, 0.5, 0.2)),
        (pf.DifferentialDrive(r=0.1, L=0.4, alpha=0.02, sigma_omega=0.1), (5.0, 6.0, 0.5)),
        (pf.Bicycle(L=1.0, alpha=0.02, sigma_delta=0.05), (1.0, 0.3, 0.5)),
    ],
)
def test_predict_agrees_with_a_large_cloud(transform, motion, u):
    """400,000 draws; the tangent's own error on these small noises is below the bounds."""
    cloud = pf.gaussian_prior(400_000, START.mean, START.Sigma, rng())
    cloud = pf.predict(cloud, u, motion, rng(1))
    bel, _ = pf.gaussian_predict(START, u, motion, transform)
    assert bel.mean == pytest.approx(pf.mean_pose(cloud), abs=4e-3)
    assert np.abs(bel.Sigma - pf.covariance(cloud)).max() < 8e-4


@BOTH
@pytest.mark.parametrize(
    "sensor, z",
    [
        (pf.RangeBearing(WORLD, 0.3, 0.1, bias_phi=0.05), [[1.9, 5.8], [-3.1, -0.3], [0, 1]]),
        (pf.Range(WORLD, 0.3, bias=0.5), [[2.2, 6.4], [0, 1]]),
        (pf.Bearing(WORLD, 0.1), [[3.05], [0]]),
        (pf.Compass(0.1), [[0.35]]),
        (pf.Position(sigma=0.2), [[3.1], [2.1]]),
    ],
)
def test_update_agrees_with_weighted_draws(transform, sensor, z):
    """Importance sampling with 400,000 draws of the prior gives moments and evidence."""
    prior = pf.Gaussian((3.0, 2.0, 0.4), (0.1, 0.1, 0.05))
    cloud = pf.gaussian_prior(400_000, prior.mean, prior.Sigma, rng())
    cloud, log_evidence = pf.update(cloud, z, sensor)
    bel, ours, rejected = pf.gaussian_update(prior, z, sensor, transform)
    assert rejected == 0
    assert ours == pytest.approx(log_evidence, abs=0.05)
    assert bel.mean == pytest.approx(pf.mean_pose(cloud), abs=0.01)
    assert np.sqrt(np.diag(bel.Sigma)) == pytest.approx(
        np.sqrt(np.diag(pf.covariance(cloud))), rel=0.05
    )


def test_heading_across_pi_is_wrapped():
    west = pf.Gaussian((5.0, 4.0, math.pi - 0.01), (0.1, 0.1, 0.1))
    bel, _, _ = pf.gaussian_update(west, [[-math.pi + 0.03]], pf.Compass(0.1))
    assert bel.mean[2] == pytest.approx(-math.pi + 0.01, abs=1e-6)


def test_gate_is_per_column():
    sensor = pf.Range(WORLD, 0.1)
    z = sensor.expected(START.mean, ids=[0, 1, 2])
    z[0, 1] += 5.0
    bel, log_evidence, rejected = pf.gaussian_update(START, z, sensor, gate=6.63)
    without, same, _ = pf.gaussian_update(START, z[:, [0, 2]], sensor)
    assert rejected == 1 and log_evidence == pytest.approx(same)
    np.testing.assert_allclose(bel.mean, without.mean)


def test_nothing_measured_changes_nothing():
    for z in (None, np.empty((3, 0))):
        result = pf.gaussian_update(START, z, pf.RangeBearing(WORLD, 0.3, 0.1))
        assert result == (START, 0.0, 0)


@pytest.mark.parametrize("wrap", [pf.Masked, pf.MaximumLikelihood, lambda s: pf.Tempered(s, 0.5)])
def test_a_wrapper_has_no_gaussian_of_its_own(wrap):
    """Nor may it be read as the sensor that it wraps: its columns name no landmark."""
    sensor = wrap(pf.RangeBearing(WORLD, 0.3, 0.1))
    with pytest.raises(pf.ParameterError, match="the sensor it wraps"):
        pf.gaussian_update(START, np.ones((sensor.components, 2)), sensor)


def test_noise_that_is_not_gaussian_is_named():
    with pytest.raises(pf.ParameterError, match="standard_t"):
        pf.gaussian_update(START, [[3.0], [0]], pf.Range(WORLD, 0.3, nu=3.0))
    laser = pf.BeamModel(pf.worlds.office(), [0.0], 8.0)
    with pytest.raises(pf.ParameterError, match="random"):
        pf.gaussian_update(START, [[3.0], [0]], laser)
    mixture = pf.OutlierMixture(pf.Range(WORLD, 0.3), 0.1, 0.1)
    with pytest.raises(pf.ParameterError, match="gate"):
        pf.gaussian_update(START, [[3.0], [0]], mixture)


@BOTH
@pytest.mark.parametrize(
    "f", [lambda x: x[0], lambda x: x[:, :1], lambda x: np.full_like(x, np.nan)]
)
def test_a_function_that_returns_something_else_is_named(transform, f):
    with pytest.raises(pf.PfkitError, match="f"):
        transform(f, np.zeros(2), np.eye(2))
