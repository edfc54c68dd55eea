"""The pose grid against closed forms, against the particle filter's models, and against itself."""

import numpy as np
import pytest

import pfkit as pf

WORLD = pf.LandmarkMap(np.array([[1.0, 7.0], [1.0, 6.0]]), bounds=(0.0, 8.0, 0.0, 7.0))
BOUNDS = WORLD.bounds
STILL = pf.VelocityMotion((0.0, 0.0, 0.0, 0.0))
NOISY = pf.VelocityMotion((0.05, 0.02, 0.02, 0.05, 0.02, 0.02))


def rng(seed=0):
    return np.random.default_rng(seed)


def known(shape=(32, 28, 24), sigma=(0.5, 0.5, 0.4)):
    return pf.gaussian_grid(shape, BOUNDS, (3.0, 3.0, 0.3), sigma)


@pytest.mark.parametrize("predict", [pf.predict_by_convolution, pf.predict_by_transport])
@pytest.mark.parametrize("u", [(1.0, 0.0, 1.0), (1.0, 0.8, 1.0), (-0.7, 0.3, 1.5)])
def test_predict_moves_mean_and_covariance_like_a_cloud(predict, u):
    """Against 200,000 particles; the cells add at most a third of a cell squared."""
    grid = known()
    cloud = pf.gaussian_prior(200_000, (3.0, 3.0, 0.3), (0.5, 0.5, 0.4), rng(1))
    cloud = pf.predict(cloud, u, NOISY, rng(2))
    moved = predict(grid, u, NOISY, rng(3)).particles()
    assert pf.mean_pose(moved) == pytest.approx(pf.mean_pose(cloud), abs=0.02)
    grown = np.diag(pf.covariance(moved)) - np.diag(pf.covariance(cloud))
    assert (grown > -0.02).all() and (grown < grid.cell**2 / 3 + 0.02).all()


def test_convolution_is_exact_for_whole_cells():
    """Turned by a quarter and driven by two cells, every cell lands on a cell."""
    grid = pf.uniform_grid((8, 8, 4), (0.0, 8.0, 0.0, 8.0))
    p = np.zeros(grid.p.shape)
    p[3, 3, 0] = 1.0  # heading -3 pi / 4
    straight = pf.OdometryMotion((0.0, 0.0, 0.0, 0.0))
    turned = pf.predict_by_convolution(
        pf.PoseGrid(p, grid.bounds), (np.pi / 4, 2.0, np.pi / 4), straight, rng()
    )
    # heads along -pi / 2 while it drives: two cells down, then faces -pi / 4, the next cell
    assert turned.p[3, 1, 1] == pytest.approx(1)


def test_standing_still_changes_nothing():
    grid = known()
    assert pf.predict_by_convolution(grid, (0.0, 0.0, 1.0), STILL, rng()) is grid


def test_mass_is_kept_or_its_loss_is_told():
    inside = pf.predict_by_convolution(known(), (0.5, 0.1, 1.0), NOISY, rng())
    assert inside.p.sum() == pytest.approx(1) and (inside.p >= 0).all()
    assert inside.lost < 1e-4
    for predict in (pf.predict_by_convolution, pf.predict_by_transport):
        uniform = pf.uniform_grid((16, 14, 12), BOUNDS)
        # a robot that drives 1 m in any direction leaves an 8 x 7 box with this chance
        expected = 1 - np.mean(
            [
                (8 - abs(np.cos(a))) * (7 - abs(np.sin(a))) / 56
                for a in np.linspace(0, 2 * np.pi, 999)
            ]
        )
        moved = predict(uniform, (1.0, 0.0, 1.0), STILL, rng())
        assert moved.lost == pytest.approx(expected, abs=0.02)
        assert moved.p.sum() == pytest.approx(1)


def test_losses_compound():
    grid = pf.uniform_grid((16, 14, 12), BOUNDS)
    first = pf.predict_by_convolution(grid, (1.0, 0.0, 1.0), STILL, rng())
    fresh = pf.PoseGrid(first.p, first.bounds)
    second = pf.predict_by_convolution(first, (1.0, 0.0, 1.0), STILL, rng())
    alone = pf.predict_by_convolution(fresh, (1.0, 0.0, 1.0), STILL, rng())
    assert 1 - second.lost == pytest.approx((1 - first.lost) * (1 - alone.lost))


def test_all_mass_gone_is_named():
    for predict in (pf.predict_by_convolution, pf.predict_by_transport):
        with pytest.raises(pf.DegenerateWeightsError, match="bounds"):
            predict(known(), (50.0, 0.0, 1.0), STILL, rng())


def test_wide_heading_noise_goes_round_the_circle():
    spin = pf.VelocityMotion((0.0, 0.0, 0.0, 4.0))
    moved = pf.predict_by_convolution(known(), (0.0, 3.0, 1.0), spin, rng(), draws=20_000)
    marginal = moved.p.sum(axis=(0, 1))
    assert marginal.min() > 0.9 / 24 and marginal.max() < 1.1 / 24


def test_update_is_bayes_with_full_constants():
    sensor = pf.RangeBearing(WORLD, 0.5, 0.3)
    grid, z = known(), np.array([[2.6, 4.9], [1.4, 0.2], [0, 1]])
    after, log_evidence = pf.update_grid(grid, z, sensor)
    joint = grid.p * np.exp(sensor.log_likelihood(z, grid.poses.reshape(3, -1))).reshape(
        grid.p.shape
    )
    assert log_evidence == pytest.approx(np.log(joint.sum()))
    np.testing.assert_allclose(after.p, joint / joint.sum(), rtol=1e-9)
    for nothing in (None, np.empty((3, 0))):
        assert pf.update_grid(grid, nothing, sensor) == (grid, 0.0)
