"""Roughening and regularisation: how much noise, on whom, and never on weights."""

import numpy as np
import pytest

import pfkit as pf


def rng(seed=0):
    return np.random.default_rng(seed)


def copies(shape=(3, 4000)):
    state = rng(1).normal(0, 1, (3, *shape[1:]))
    state[0] *= 2.0
    state[2] = pf.wrap(0.3 * state[2] + 3.0)
    return pf.from_weights(state)


def test_roughening_has_gordons_size():
    bel = copies()
    moved = pf.roughen(bel, rng(), K=0.2)
    noise = pf.pose_error(moved.state, bel.state)
    deviation = bel.state - pf.mean_pose(bel)[:, None]
    deviation[2] = pf.wrap(deviation[2])
    expected = 0.2 * np.ptp(deviation, axis=1) * 4000 ** (-1 / 3)
    np.testing.assert_allclose(noise.std(axis=1), expected, rtol=0.05)
    assert abs(noise.mean(axis=1) / expected).max() < 4 / np.sqrt(4000)


def test_regularisation_has_the_clouds_shape():
    bel = copies((3, 20_000))
    bel = pf.from_weights(bel.state + np.array([0.0, 0.5, 0.0])[:, None] * bel.state[0])
    noise = pf.pose_error(pf.regularise(bel, rng()).state, bel.state)
    h = (4 / 5) ** (1 / 7) * 20_000 ** (-1 / 7)
    np.testing.assert_allclose(np.cov(noise), h**2 * pf.covariance(bel), rtol=0.04, atol=2e-3)


def test_bandwidth_in_one_dimension_is_exact():
    bel = pf.from_weights(rng(1).normal(size=(1, 500)))
    noise = pf.regularise(bel, rng(2)).state - bel.state
    scale = noise / rng(2).standard_normal((1, 500)) / np.sqrt(pf.covariance(bel)[0, 0])
    np.testing.assert_allclose(np.abs(scale), (4 / 3) ** (1 / 5) * 500 ** (-1 / 5), rtol=1e-6)


@pytest.mark.parametrize("remedy", [pf.roughen, pf.regularise])
def test_copies_differ_afterwards_and_headings_stay_on_the_circle(remedy):
    few = pf.from_weights(np.repeat(copies((3, 10)).state, 100, axis=1))
    moved = remedy(few, rng())
    assert np.unique(moved.state[0]).size == 1000
    assert (np.abs(moved.state[2]) <= np.pi).all()
    assert moved.log_w is few.log_w


@pytest.mark.parametrize("remedy", [pf.roughen, pf.regularise])
def test_in_a_batch_only_the_chosen_ones_move(remedy):
    bel = copies((3, 2, 500))
    log_w = bel.log_w.copy()
    log_w[1] = pf.normalise(rng().normal(size=500))[0]
    bel = pf.Particles(bel.state, log_w)
    moved = remedy(bel, rng(), where=np.array([True, False]))
    np.testing.assert_array_equal(moved.state[:, 1], bel.state[:, 1])
    assert (moved.state[:, 0] != bel.state[:, 0]).all()
    with pytest.raises(pf.ParameterError, match="resample first"):
        remedy(bel, rng())


@pytest.mark.parametrize("remedy", [pf.roughen, pf.regularise])
def test_states_of_two_components_have_no_heading(remedy):
    bel = pf.from_weights(10.0 + rng().normal(size=(2, 300)))
    assert remedy(bel, rng()).state.mean() == pytest.approx(10.0, abs=0.5)


@pytest.mark.parametrize("remedy", [pf.roughen, pf.regularise])
def test_bad_input_is_named(remedy):
    bel = copies((3, 10))
    with pytest.raises(pf.ParameterError):
        remedy(bel, 7)
    with pytest.raises(ValueError, match="broadcast"):
        remedy(bel, rng(), where=np.array([True, False]))
    with pytest.raises(pf.ParameterError):
        pf.roughen(bel, rng(), K=np.nan)
