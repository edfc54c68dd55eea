"""Outlier mixture, gate, tempering."""

import math

import numpy as np
import pytest

import pfkit as pf

FIX = pf.Position(sigma=1.0)


def test_the_mixture_is_the_mixture():
    pose, z = np.random.default_rng(0).normal(size=(2, 9)), np.array([[0.3], [4.0]])
    mixed = pf.OutlierMixture(FIX, 0.2, 1e-3).log_likelihood(z, pose)
    np.testing.assert_allclose(
        np.exp(mixed), 0.8 * np.exp(FIX.log_likelihood(z, pose)) + 0.2 * 1e-3
    )


def test_the_mixture_has_its_limits_and_a_floor():
    pose, z = np.zeros((2, 3)), np.array([[0.3], [400.0]])
    np.testing.assert_array_equal(
        pf.OutlierMixture(FIX, 0.0, 1e-3).log_likelihood(z, pose), FIX.log_likelihood(z, pose)
    )
    for epsilon in (0.01, 1.0):
        floor = pf.OutlierMixture(FIX, epsilon, 1e-3).log_likelihood(z, pose)
        np.testing.assert_allclose(floor, math.log(epsilon * 1e-3))


def test_one_false_reading_moves_a_gaussian_belief_and_not_a_mixture():
    bel = pf.gaussian_prior(2_000, (0, 0), (2, 2), np.random.default_rng(1), heading=False)
    z = np.array([[0.0, 0.1, -0.1, 6.0], [0.0, 0.0, 0.1, 6.0]])
    plain, _ = pf.update(bel, z, FIX)
    mixed, _ = pf.update(bel, z, pf.OutlierMixture(FIX, 0.1, 1e-3))
    assert np.hypot(*(plain.state @ plain.w)) > 1.0
    assert np.hypot(*(mixed.state @ mixed.w)) < 0.5


def test_the_gate_uses_the_mean_density_of_the_set():
    rng = np.random.default_rng(2)
    pose, z = rng.normal(size=(2, 50)), np.array([[0.3, 3.0, 9.0], [0.0, 2.0, 9.0]])
    means = [np.mean(np.exp(FIX.log_likelihood(z[:, [k]], pose))) for k in range(3)]
    assert means[0] > means[1] > means[2]
    gate = pf.Gate(FIX, math.sqrt(means[1] * means[2]))
    np.testing.assert_array_equal(gate.accepts(z, pose), (True, True, False))
    np.testing.assert_allclose(gate.log_likelihood(z, pose), FIX.log_likelihood(z[:, :2], pose))
    np.testing.assert_allclose(
        pf.Gate(FIX, 0.0).log_likelihood(z, pose), FIX.log_likelihood(z, pose)
    )


def test_each_filter_of_a_batch_has_its_own_gate():
    pose = np.zeros((2, 2, 30))
    pose[0, 1] = 20.0
    gate, z = pf.Gate(FIX, 1e-4), np.array([[0.0, 20.0], [0.0, 0.0]])
    np.testing.assert_array_equal(gate.accepts(z, pose), np.eye(2, dtype=bool))
    np.testing.assert_allclose(gate.log_likelihood(z, pose), pf.log_gaussian(0.0, 1.0) * 2)


def test_the_peak_of_a_wide_sensor_lies_under_the_gate():
    """1 / (2 pi sigma^2) = 1e-4 at a variance of 1592 square pixels: above it nothing passes."""
    at_truth, z = np.zeros((2, 10)), np.zeros((2, 1))
    for variance, passes in ((1591.0, True), (1592.0, False)):
        gate = pf.Gate(pf.Position(sigma=math.sqrt(variance)), 1e-4)
        assert gate.accepts(z, at_truth)[0] == passes


def test_the_gate_locks_out_a_filter_that_starts_anywhere():
    rng = np.random.default_rng(3)
    anywhere = rng.uniform((0, 0), (640, 480), (1000, 2)).T
    z = np.array([[320.0], [240.0]])
    assert not pf.Gate(pf.Position(sigma=5.0), 1e-4).accepts(z, anywhere)[0]
    assert pf.Gate(pf.Position(sigma=5.0), 1e-4).accepts(z, rng.normal(z, 5.0, (2, 1000)))[0]


def test_tempering_is_a_power():
    pose, z = np.random.default_rng(4).normal(size=(2, 9)), np.array([[0.3, 1.0], [1.0, 0.2]])
    full = FIX.log_likelihood(z, pose)
    half = pf.Tempered(FIX, 0.5)
    np.testing.assert_allclose(half.log_likelihood(z, pose), 0.5 * full)
    np.testing.assert_allclose(
        half.log_density(z[:, 0], pose) + half.log_density(z[:, 1], pose), 0.5 * full
    )
    np.testing.assert_array_equal(pf.Tempered(FIX, 0.0).log_likelihood(z, pose), np.zeros(9))


def test_a_gaussian_to_the_power_beta_has_its_variance_over_beta():
    bel = pf.from_weights(np.stack(np.meshgrid(*[np.linspace(-9, 9, 181)] * 2)).reshape(2, -1))
    tempered, _ = pf.update(bel, np.zeros((2, 1)), pf.Tempered(FIX, 0.25))
    assert tempered.state[0] ** 2 @ tempered.w == pytest.approx(4.0, rel=1e-3)


def test_wrappers_nest_and_pass_on_what_they_do_not_change():
    nested = pf.Gate(pf.Tempered(pf.OutlierMixture(FIX, 0.1, 1e-3), 0.5), 0.0)
    assert nested.components == 2 and nested.angles == FIX.angles
    z, pose = np.zeros((2, 2)), np.zeros((2, 5))
    np.testing.assert_allclose(
        nested.log_likelihood(z, pose),
        0.5 * pf.OutlierMixture(FIX, 0.1, 1e-3).log_likelihood(z, pose),
    )


@pytest.mark.parametrize(
    "make",
    [
        lambda: pf.OutlierMixture(FIX, 1.5, 1e-3),
        lambda: pf.OutlierMixture(FIX, 0.5, 0.0),
        lambda: pf.Gate(FIX, -1.0),
        lambda: pf.Tempered(FIX, 2.0),
    ],
)
def test_bad_settings_are_named(make):
    with pytest.raises(pf.ParameterError, match="must be"):
        make()


def test_a_gate_asks_a_set_not_one_pose():
    gate, pose = pf.Gate(pf.Position(1.0), 0.01), np.array((1.0, 2.0, 0.0))
    for call in (gate.log_likelihood, gate.accepts):
        with pytest.raises(ValueError, match=r"set of particles|axis -1 is out"):
            call([[1.0, 5.0], [2.0, 2.0]], pose)
