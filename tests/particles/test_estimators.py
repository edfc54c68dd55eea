"""From a cloud to an answer: means, heaviest particles, densities, hypotheses."""

import numpy as np
import pytest

import pfkit as pf


def rng(seed=0):
    return np.random.default_rng(seed)


def cloud(M=400, seed=0):
    state = rng(seed).normal(0, 1, (3, M)) * np.array([[2.0], [1.0], [0.5]])
    return pf.from_weights(np.vstack((state[:2], pf.wrap(state[2:] + 3.0))), rng(seed).random(M))


def batch(M=50):
    parts = [cloud(M, seed) for seed in range(4)]
    return pf.Particles(
        np.stack([p.state for p in parts], axis=1), np.stack([p.log_w for p in parts])
    ), parts


ESTIMATORS = [pf.mean_pose, pf.map_particle, pf.top_share_mean, pf.covariance]


@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_batch_equals_single(estimator):
    together, parts = batch()
    result = estimator(together)
    for b, part in enumerate(parts):
        np.testing.assert_allclose(result[..., b], estimator(part), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("estimator", ESTIMATORS)
def test_order_of_particles_does_not_matter(estimator):
    bel, order = cloud(), rng(5).permutation(400)
    shuffled = pf.Particles(bel.state[:, order], bel.log_w[order])
    np.testing.assert_allclose(estimator(shuffled), estimator(bel), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("estimator", [pf.mean_pose, pf.map_particle, pf.top_share_mean])
def test_a_moved_world_moves_the_answer(estimator):
    bel, g = cloud(), np.array([3.0, -1.0, 2.2])
    moved = pf.Particles(pf.compose(g[:, None], bel.state), bel.log_w)
    error = pf.pose_error(estimator(moved), pf.compose(g, estimator(bel)))
    assert np.abs(error).max() < 1e-9


def test_mean_by_loop():
    bel = cloud(20)
    x = sum(w * s for w, s in zip(bel.w, bel.state[0], strict=True))
    sine = sum(w * np.sin(s) for w, s in zip(bel.w, bel.state[2], strict=True))
    cosine = sum(w * np.cos(s) for w, s in zip(bel.w, bel.state[2], strict=True))
    assert pf.mean_pose(bel)[[0, 2]] == pytest.approx([x, np.arctan2(sine, cosine)])


def test_covariance_wraps_the_heading():
    bel = pf.from_weights(np.array([[0.0, 0], [0, 0], [np.pi - 0.1, -np.pi + 0.1]]))
    assert pf.covariance(bel)[2, 2] == pytest.approx(0.01)


def test_map_particle_is_the_heaviest():
    bel = cloud()
    np.testing.assert_array_equal(pf.map_particle(bel), bel.state[:, bel.w.argmax()])


def test_top_share_runs_from_the_heaviest_to_the_mean():
    bel = cloud()
    np.testing.assert_allclose(pf.top_share_mean(bel, 1.0), pf.mean_pose(bel))
    np.testing.assert_allclose(pf.top_share_mean(bel, 1 / 400), pf.map_particle(bel))
    top = np.argsort(bel.w)[-100:]
    x = (bel.w[top] * bel.state[0, top]).sum() / bel.w[top].sum()
    for share in (0.25, 0.2476):  # 99.04 particles are rounded up
        assert pf.top_share_mean(bel, share)[0] == pytest.approx(x)


def test_share_must_be_positive():
    for share in (0.0, 1.5, -0.1):
        with pytest.raises(pf.ParameterError):
            pf.top_share_mean(cloud(), share)


def test_headings_that_cancel_have_no_mean():
    bel = pf.from_weights(np.array([[0.0, 2], [0, 0], [0.4, 0.4 - np.pi]]))
    mean = pf.mean_pose(bel)
    assert mean[0] == 1 and np.isnan(mean[2])
    assert np.isnan(pf.covariance(bel)[2]).all() and pf.covariance(bel)[0, 0] == pytest.approx(1)
    nearly = pf.Particles(bel.state, np.log([0.5 + 1e-6, 0.5 - 1e-6]))
    assert pf.mean_pose(nearly)[2] == pytest.approx(0.4)
    with pytest.raises(pf.PfkitError, match=r"finite"):
        pf.roughen(bel, rng())
