"""The film of labs 3 and 4, and the loop that follows it."""

import math

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs.target import FRAMES, HEIGHT, WIDTH, anywhere, around, target_log, track


@pytest.mark.parametrize("path", ["fixed", "line", "circle"])
def test_the_target_stays_in_the_image_and_moves_at_its_speed(path):
    x, y, _ = target_log(path).truth
    assert (0 < x).all() and (x < WIDTH).all() and (0 < y).all() and (y < HEIGHT).all()
    speed = np.hypot(np.diff(x), np.diff(y))
    np.testing.assert_allclose(speed, {"fixed": 0, "line": 1, "circle": 2}[path], atol=1e-9)


def test_noise_and_labels_are_as_stated():
    for noise, sigma in (("low", 1.0), ("high", 20.0)):
        log = target_log("circle", noise)
        error = np.array(log.z)[:, :, 0].T - log.truth[:2]
        assert abs(error.std() - sigma) < 5 * sigma / math.sqrt(4 * FRAMES)
        assert not np.any(log.outlier)
    log = target_log("fixed", "outliers")
    false = np.array([o[0] for o in log.outlier])
    assert abs(false.mean() - 0.5) < 5 * 0.5 / math.sqrt(FRAMES)
    error = np.array(log.z)[:, :, 0].T - log.truth[:2]
    assert np.abs(error[:, ~false]).max() < 5 and np.median(np.hypot(*error[:, false])) > 100


def test_one_film_is_fixed_and_many_differ():
    np.testing.assert_array_equal(target_log(seed=3).z[5], target_log(seed=3).z[5])
    z = target_log("circle", "high", runs=4).z[0]
    assert z.shape == (2, 1, 4, 1) and np.unique(z).size == 8


def test_a_batch_of_one_equals_a_single_run():
    log = target_log("fixed")[:20]
    single = track(
        log, anywhere(50, np.random.default_rng(1)), pf.FixedTarget(1.0), pf.Position(3.0),
        np.random.default_rng(2),
    )  # fmt: skip
    batch = track(
        log, anywhere((1, 50), np.random.default_rng(1)), pf.FixedTarget(1.0), pf.Position(3.0),
        np.random.default_rng(2),
    )  # fmt: skip
    np.testing.assert_allclose(batch.error[:, 0], single.error)
    np.testing.assert_allclose(batch.ess[:, 0], single.ess)


def test_the_filter_agrees_with_the_kalman_filter():
    """Linear and Gaussian: the mean of many particles is the Kalman mean, in every frame."""
    log, r, q = target_log("fixed")[:40], 1.0, 9.0
    mean, variance = log.start[:2].astype(float), 4.0
    rng, exact = np.random.default_rng(3), []
    bel = around(log.start[:2], 20_000, rng, sigma=2.0)
    found = track(log, bel, pf.FixedTarget(math.sqrt(r)), pf.Position(math.sqrt(q)), rng)
    for z in log.z:
        variance += r
        gain = variance / (variance + q)
        mean, variance = mean + gain * (z[:, 0] - mean), (1 - gain) * variance
        exact.append(np.hypot(*(mean - log.truth[:2, 0])))
    # Monte-Carlo error of a mean: sd / sqrt(M), times a few for resampling
    assert np.abs(found.error - exact).max() < 10 * math.sqrt(variance / 20_000)


def test_a_closed_gate_leaves_the_belief_alone():
    log, rng = target_log("fixed")[:5], np.random.default_rng(4)
    bel = anywhere((3, 100), rng)
    found = track(log, bel, pf.FixedTarget(0.0), pf.Position(1.0), rng, gate=np.inf)
    assert found.rejected.all()
    np.testing.assert_array_equal(found.bel.state, bel.state)


def test_a_students_scheme_that_knows_single_sets_only_works_in_a_batch():
    def scheme(w, rng):
        assert w.ndim == 1
        return rng.choice(len(w), len(w), p=w)

    rng = np.random.default_rng(5)
    found = track(
        target_log("fixed")[:5], anywhere((3, 100), rng), pf.FixedTarget(1.0), pf.Position(9.0),
        rng, scheme,
    )  # fmt: skip
    assert np.isfinite(found.error).all()
