"""Kernel densities: they integrate to one, know the circle, and approach the true density."""

import numpy as np
import pytest

import pfkit as pf


def rng(seed=0):
    return np.random.default_rng(seed)


def test_density_is_the_double_loop():
    bel = pf.from_weights(rng().normal(size=(3, 7)), rng().random(7))
    points, h = rng(1).normal(size=(3, 5)), (0.5, 0.4, 0.3)
    expected = np.zeros(5)
    for i in range(5):
        for m in range(7):
            kernel = [
                np.exp(-0.5 * (e / s) ** 2) / (s * np.sqrt(2 * np.pi))
                for e, s in zip(pf.pose_error(points[:, i], bel.state[:, m]), h, strict=True)
            ]
            expected[i] += bel.w[m] * np.prod(kernel)
    np.testing.assert_allclose(pf.kde(bel, points, h), expected)


def test_density_integrates_to_one_over_plane_and_circle():
    bel = pf.gaussian_prior(100, (0, 0, 3.0), (0.5, 0.3, 0.4), rng())
    grid = pf.uniform_grid((30, 30, 24), (-4, 4, -3, 3))
    total = pf.kde(bel, grid.poses).sum() * grid.cell.prod()
    assert total == pytest.approx(1, abs=1e-3)


def test_silverman_on_a_gaussian():
    bel = pf.from_weights(rng().normal(size=(2, 5000)) * np.array([[2.0], [1.0]]))
    np.testing.assert_allclose(
        pf.silverman_bandwidth(bel), np.array([2.0, 1.0]) * (1 / 5000) ** (1 / 6), rtol=0.05
    )


def test_silverman_counts_effective_particles():
    """Giving half of the particles no weight is the same as leaving them out."""
    half = rng().normal(size=(2, 300))
    state = np.hstack((half, rng(1).normal(size=(2, 300)) + 9))
    weighted = pf.from_weights(state, np.repeat([1.0, 0.0], 300))
    ours, expected = (pf.silverman_bandwidth(b) for b in (weighted, pf.from_weights(half)))
    np.testing.assert_allclose(ours, expected)


def test_kde_approaches_the_true_density():
    bel = pf.from_weights(rng().normal(size=(2, 20_000)))
    at = np.array([[0.0, 1.0], [0.0, -0.5]])
    true = np.exp(-0.5 * (at**2).sum(axis=0)) / (2 * np.pi)
    np.testing.assert_allclose(pf.kde(bel, at), true, rtol=0.1)


def test_blocks_do_not_change_the_result(monkeypatch):
    bel, points = pf.from_weights(rng().normal(size=(2, 50))), rng(1).normal(size=(2, 4, 30))
    whole = pf.kde(bel, points)
    monkeypatch.setattr("pfkit.particles.density.BLOCK", 130)
    np.testing.assert_allclose(pf.kde(bel, points), whole, rtol=1e-12)
    assert whole.shape == (4, 30)


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda b: pf.kde(b, np.zeros((2, 4))), pf.ShapeError),
        (lambda b: pf.kde(b, np.zeros((3, 4)), (1, 1)), pf.ShapeError),
        (lambda b: pf.kde(b, np.zeros((3, 4)), (1, 1, 0)), pf.ParameterError),
        (lambda b: pf.kde(pf.from_weights(np.ones((3, 9))), np.zeros((3, 4))), pf.ParameterError),
        (lambda b: pf.kde(pf.from_weights(np.ones((3, 2, 9))), np.zeros((3, 4))), pf.ShapeError),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call(pf.from_weights(rng().normal(size=(3, 20))))
