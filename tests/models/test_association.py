"""Maximum-likelihood association, each particle for itself."""

import numpy as np
import pytest

import pfkit as pf

WORLD = pf.LandmarkMap(np.array([[0.0, 4.0, -2.0], [3.0, -1.0, -5.0]]), [6, 13, 2])
SENSORS = [pf.Range(WORLD, 0.3), pf.Bearing(WORLD, 0.2), pf.RangeBearing(WORLD, 0.3, 0.2)]


@pytest.mark.parametrize("sensor", SENSORS, ids=lambda s: type(s).__name__)
def test_it_finds_the_landmark_with_the_largest_density(sensor):
    """Loop twin: every particle, every measurement, every landmark."""
    rng = np.random.default_rng(0)
    pose = rng.uniform(-4, 4, (3, 12))
    z = sensor.sample(pose[:, 0], rng)[:-1]
    free = pf.MaximumLikelihood(sensor)
    log_p = free.log_likelihood(z, pose)
    for m in range(12):
        total = 0.0
        for k in range(3):
            each = [
                float(sensor.log_likelihood(np.append(z[:, k], s)[:, None], pose[:, [m]])[0])
                for s in WORLD.ids
            ]
            total += max(each)
        assert log_p[m] == pytest.approx(total)


def test_at_the_truth_it_is_as_sure_as_with_names():
    pose = np.array((1.0, 0.5, 0.3))
    free = pf.MaximumLikelihood(SENSORS[2])
    named = SENSORS[2].expected(pose)
    assert free.log_likelihood(named[:-1], pose) == pytest.approx(
        SENSORS[2].log_likelihood(named, pose)
    )
    assert free.components == 2
    some = free.sample(pose, np.random.default_rng(1), ids=[13])
    assert some.shape == (2, 1)


def test_known_association_is_never_more_likely():
    rng = np.random.default_rng(2)
    pose = rng.uniform(-4, 4, (3, 40))
    z = SENSORS[2].sample(pose[:, 0], rng)
    known, free = SENSORS[2], pf.MaximumLikelihood(SENSORS[2])
    assert (free.log_likelihood(z[:-1], pose) >= known.log_likelihood(z, pose)).all()


def test_a_set_for_each_filter_of_a_batch():
    rng = np.random.default_rng(3)
    pose, free = rng.uniform(-4, 4, (3, 5, 8)), pf.MaximumLikelihood(SENSORS[2])
    z = free.sample(pose[:, :, :1], rng)
    assert z.shape == (2, 3, 5, 1)
    batch = free.log_likelihood(z, pose)
    for b in range(5):
        np.testing.assert_allclose(batch[b], free.log_likelihood(z[:, :, b, 0], pose[:, b]))


def test_the_gate_goes_about_it():
    pose = np.random.default_rng(4).normal((1.0, 0.5, 0.3), 0.05, (50, 3)).T
    gated = pf.Gate(pf.MaximumLikelihood(SENSORS[2]), 1e-4)
    z = SENSORS[2].expected(np.array((1.0, 0.5, 0.3)))[:-1]
    z = np.hstack((z, [[20.0], [0.0]]))
    np.testing.assert_array_equal(gated.accepts(z, pose), (True, True, True, False))


def test_what_has_no_identity_is_refused():
    with pytest.raises(AttributeError, match="'Compass' object has no attribute 'world'"):
        pf.MaximumLikelihood(pf.Compass(0.1)).log_density(np.zeros(1), np.zeros((3, 2)))
