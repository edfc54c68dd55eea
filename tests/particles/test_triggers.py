"""When to resample: the ESS, the clock, the information."""

import numpy as np
import pytest

import pfkit as pf


def belief(*weights):
    w = np.array(weights)
    return pf.from_weights(np.zeros((3, *w.shape)), w)


BATCH = belief([1.0, 1.0, 1.0, 1.0], [1.0, 0.0, 0.0, 0.0], [3.0, 1.0, 1.0, 1.0])


def test_ess_below_asks_each_filter_of_a_batch():
    np.testing.assert_allclose(BATCH.ess, [4, 1, 36 / 12])
    np.testing.assert_array_equal(pf.ess_below(0.5)(BATCH, 0), [False, True, False])
    np.testing.assert_array_equal(pf.ess_below(0.8)(BATCH, 0), [False, True, True])
    assert not np.any(pf.ess_below(0.0)(BATCH, 0))


def test_every_counts_steps_from_nought():
    assert [k for k in range(10) if pf.every(3)(BATCH, k)] == [2, 5, 8]
    assert all(pf.every(1)(BATCH, k) for k in range(5))


def test_information_runs_from_nought_to_log_M():
    np.testing.assert_allclose(
        pf.information(BATCH), [0, np.log(4), np.log(2) - 0.5 * np.log(3)], atol=1e-12
    )
    half = belief(1.0, 1.0, 0.0, 0.0)
    assert pf.information(half) == pytest.approx(np.log(2))
    assert pf.on_information(0.69)(half, 0) and not pf.on_information(0.70)(half, 0)


def test_information_is_what_a_filter_learnt_from_one_likelihood():
    rng = np.random.default_rng(0)
    log_w, _ = pf.normalise(rng.normal(size=200))
    w = np.exp(log_w)
    by_hand = sum(wm * np.log(wm * 200) for wm in w)
    assert pf.information(pf.Particles(np.zeros((3, 200)), log_w)) == pytest.approx(by_hand)


WORLD = pf.LandmarkMap(np.array([[0.0, 4.0], [3.0, 0.0]]))
SENSOR = pf.RangeBearing(WORLD, 0.5, 0.2)
MOTION = pf.VelocityMotion()


def drive(threshold, with_z=lambda k: True, steps=12, M=200, batch=()):
    rng = np.random.default_rng(3)
    bel = pf.gaussian_prior((*batch, M), np.zeros(3), (0.3, 0.3, 0.1), rng)
    z = SENSOR.expected(np.zeros(3))
    log = pf.Log(
        np.arange(steps, dtype=float),
        np.tile([[0.0], [0.1], [0.1]], steps),
        [z if with_z(k) else np.empty((3, 0)) for k in range(steps)],
    )
    return pf.run(log, bel, MOTION, SENSOR, rng, threshold=threshold)


def test_a_filter_obeys_its_trigger():
    assert np.flatnonzero(drive(pf.every(4)).resampled).tolist() == [3, 7, 11]
    np.testing.assert_array_equal(drive(0.5).ess, drive(pf.ess_below(0.5)).ess)
    assert not drive(0.0).resampled.any()
    assert drive(1.0).resampled.all() and drive(pf.on_information(0.0)).resampled.all()
    one, many = drive(pf.every(4), batch=(1,)), drive(pf.every(4), batch=(3,))
    assert many.resampled[3].all() and one.resampled.sum() == 3


def test_no_trigger_resamples_without_a_measurement():
    history = drive(pf.every(1), with_z=lambda k: k % 3 == 0)
    assert np.flatnonzero(history.resampled).tolist() == [0, 3, 6, 9]
