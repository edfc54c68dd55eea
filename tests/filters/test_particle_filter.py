"""The filter as a whole: against Kalman, in any frame, in batches, by seed, with careless parts."""

import numpy as np
import pytest

import pfkit as pf

WORLD = pf.LandmarkMap(np.array([[0.0, 6.0, 3.0], [0.0, 1.0, 5.0]]))
MOTION = pf.VelocityMotion((0.05, 0.02, 0.02, 0.05, 0.01, 0.01))
SENSOR = pf.RangeBearing(WORLD, 0.3, 0.1)
U = np.array((1.0, 0.3, 0.5))


def rng(seed=0):
    return np.random.default_rng(seed)


def drive(T=12, seed=7):
    """A log from the models themselves, every third step without a measurement."""
    generator, pose, poses, measured = rng(seed), np.array((1.0, 1.0, 0.2)), [], []
    for k in range(T):
        pose = MOTION.sample(pose, U, generator)
        poses.append(pose)
        measured.append(SENSOR.sample(pose, generator) if k % 3 else np.empty((3, 0)))
    t, u = 0.5 * np.arange(1, T + 1), np.tile(U[:, None], T)
    return pf.Log(t, u, measured, np.array(poses).T, np.array((1.0, 1.0, 0.2)), WORLD)


LOG = drive()


def start(M, seed=1):
    return pf.gaussian_prior(M, LOG.start, (0.2, 0.2, 0.1), rng(seed))


# --- a linear Gaussian world, where Kalman knows the answer -----------------------------------


class Drift:
    """x' = x + u + noise, a plain class of a student's."""

    def __init__(self, sigma):
        self.sigma = sigma

    def mean(self, pose, u):
        return pose + np.reshape(u, (2, *(1,) * (pose.ndim - 1)))

    def sample(self, pose, u, generator):
        return self.mean(pose, u) + self.sigma * generator.standard_normal(pose.shape)


def kalman(log, mean, variance, q, r):
    """Scalar Kalman filter on each of two equal axes: means, variances, log evidences."""
    means, variances, evidences = [], [], []
    for _, u, z, _ in log:
        mean, variance = mean + u, variance + q**2
        S = variance + r**2
        error = z[:, 0] - mean
        evidences.append(float(np.sum(-0.5 * error**2 / S - 0.5 * np.log(2 * np.pi * S))))
        gain = variance / S
        mean, variance = mean + gain * error, (1 - gain) * variance
        means.append(mean)
        variances.append(variance)
    return np.array(means).T, np.array(variances), np.array(evidences)


@pytest.mark.parametrize("scheme", pf.SCHEMES.values())
def test_on_a_linear_gaussian_world_it_is_a_kalman_filter(scheme):
    """25 filters of 2,000 particles: their mean is within 5 standard errors of the exact answer,
    and within a bias of order 1/M. Fixed seeds; nominal false-fail below 1e-4."""
    T, q, r, generator = 8, 0.3, 0.5, rng(4)
    truth = np.cumsum(1.0 + q * generator.standard_normal((2, T)), axis=1)
    z = truth + r * generator.standard_normal((2, T))
    log = pf.Log(np.arange(T, dtype=float), np.ones((2, T)), [z[:, k : k + 1] for k in range(T)])
    means, variances, evidences = kalman(log, np.zeros(2), 1.0, q, r)
    bel = pf.gaussian_prior((25, 2000), (0.0, 0.0), (1.0, 1.0), rng(2))
    history = pf.run(log, bel, Drift(q), pf.Position(r), rng(3), scheme)

    def close(batch, exact, slack):
        error = batch.mean(axis=-1) - exact
        noise = batch.std(axis=-1) / np.sqrt(25)
        assert (np.abs(error) < 5 * noise + slack).all()

    close(history.estimate, means, 1e-3)
    close(history.covariance[0, 0], variances, 1e-3)
    close(history.covariance[1, 1], variances, 1e-3)
    close(history.log_evidence, evidences, 2e-3)


# --- symmetries ------------------------------------------------------------------------------


def test_when_the_world_moves_the_answer_moves_along():
    """SE(2) equivariance: same random numbers, a turned and shifted world, the same weights."""
    g = np.array((5.0, -3.0, 2.2))
    column = g[:, None]
    moved_landmarks = pf.compose(column, np.vstack((WORLD.positions, np.zeros(3))))[:2]
    moved_sensor = pf.RangeBearing(pf.LandmarkMap(moved_landmarks), 0.3, 0.1)
    bel = start(500)
    moved = pf.Particles(pf.compose(column, bel.state), bel.log_w)
    here = pf.run(LOG, bel, MOTION, SENSOR, rng(5))
    there = pf.run(LOG, moved, MOTION, moved_sensor, rng(5))
    np.testing.assert_allclose(there.log_evidence, here.log_evidence, atol=1e-9)
    np.testing.assert_array_equal(there.resampled, here.resampled)
    error = pf.pose_error(there.estimate, pf.compose(column, here.estimate))
    np.testing.assert_allclose(error, 0, atol=1e-9)
    np.testing.assert_allclose(there.bel.state[:2], pf.compose(column, here.bel.state)[:2])


def test_the_order_of_particles_does_not_matter():
    """Without noise and resampling, permuting the particles permutes the answer."""
    still = pf.VelocityMotion((0, 0, 0, 0))
    bel, order = start(200), rng(0).permutation(200)
    permuted = pf.Particles(bel.state[:, order], bel.log_w[order])
    a = pf.run(LOG, bel, still, SENSOR, rng(), threshold=0)
    b = pf.run(LOG, permuted, still, SENSOR, rng(), threshold=0)
    np.testing.assert_allclose(a.bel.log_w[order], b.bel.log_w, atol=1e-9)
    np.testing.assert_allclose(a.estimate, b.estimate, atol=1e-9)
    np.testing.assert_allclose(a.log_evidence, b.log_evidence, atol=1e-9)


def test_the_order_of_measurements_does_not_matter():
    z = SENSOR.expected(np.array((1.0, 1.0, 0.2)))
    one, evidence = pf.update(start(100), z, SENSOR)
    other, same = pf.update(start(100), z[:, ::-1], SENSOR)
    np.testing.assert_allclose(one.log_w, other.log_w, atol=1e-12)
    assert evidence == pytest.approx(same)
    bel, total = start(100), 0.0
    for k in range(3):  # one at a time is the same as all at once
        bel, part = pf.update(bel, z[:, k : k + 1], SENSOR)
        total += part
    np.testing.assert_allclose(bel.log_w, one.log_w, atol=1e-12)
    assert total == pytest.approx(evidence)


# --- batches and seeds -----------------------------------------------------------------------


@pytest.mark.parametrize("scheme", [*pf.SCHEMES.values(), pf.resampling_wheel])
def test_a_batch_of_one_is_a_single_run_bit_for_bit(scheme):
    single = pf.run(LOG, start(300), MOTION, SENSOR, rng(5), scheme, threshold=0.7)
    batch = pf.run(LOG, start((1, 300)), MOTION, SENSOR, rng(5), scheme, threshold=0.7)
    assert single.resampled.any() and not single.resampled.all()
    np.testing.assert_array_equal(batch.bel.state[:, 0], single.bel.state)
    np.testing.assert_array_equal(batch.bel.log_w[0], single.bel.log_w)
    np.testing.assert_array_equal(batch.ess[:, 0], single.ess)
    np.testing.assert_array_equal(batch.log_evidence[:, 0], single.log_evidence)
    np.testing.assert_array_equal(batch.resampled[:, 0], single.resampled)
    np.testing.assert_array_equal(batch.estimate[..., 0], single.estimate)


def test_a_batch_agrees_with_single_runs_in_distribution():
    """Two-sample z of five answers after 12 steps, 100 runs each: |z| < 4.2, false-fail 1e-4."""
    R = 100
    batch = pf.run(LOG, start((R, 60)), MOTION, SENSOR, rng(11), threshold=0.7)
    singles = [
        pf.run(LOG, start(60, seed=100 + r), MOTION, SENSOR, rng(500 + r), threshold=0.7)
        for r in range(R)
    ]
    pairs = [(batch.estimate[i, -1], [s.estimate[i, -1] for s in singles]) for i in range(3)]
    pairs.append((batch.log_evidence.sum(axis=0), [s.log_evidence.sum() for s in singles]))
    pairs.append((batch.ess.mean(axis=0), [s.ess.mean() for s in singles]))
    for together, apart in pairs:
        z = np.mean(together) - np.mean(apart)
        z /= np.sqrt((np.var(together) + np.var(apart)) / R)
        assert abs(z) < 4.2


def test_only_the_poor_of_a_batch_resample():
    w = np.array([[1.0] * 8, [1.0] + [1e-6] * 7])
    bel = pf.from_weights(rng().normal(size=(3, 2, 8)), w)
    flat = pf.Compass(50.0)  # says next to nothing
    after, info = pf.step(bel, (0, 0, 0), [[0.1]], pf.VelocityMotion((0,) * 4), flat, rng())
    np.testing.assert_array_equal(info.resampled, [False, True])
    np.testing.assert_array_equal(info.ancestors[0], np.arange(8))
    np.testing.assert_array_equal(info.ancestors[1], 0)
    np.testing.assert_array_equal(after.state[:, 1], np.tile(bel.state[:, 1, :1], 8))
    np.testing.assert_allclose(after.state[:, 0], bel.state[:, 0])
    np.testing.assert_allclose(after.w.sum(axis=-1), 1)


def test_each_filter_of_a_batch_may_have_its_own_data():
    """u (n, B, 1) and z (n, K, B, 1) give each row what a single update would."""
    bel = start((2, 50))
    u = np.array([[1.0, 2.0], [0.0, 0.5], [1.0, 1.0]])[:, :, None]
    still = pf.VelocityMotion((0,) * 4)
    moved = pf.predict(bel, u, still, rng())
    poses = np.array([[1.0, 2.0], [1.0, 0.0], [0.2, 0.1]])
    z = SENSOR.expected(poses[:, :, None])
    after, evidence = pf.update(moved, z, SENSOR)
    for b in range(2):
        alone = pf.Particles(bel.state[:, b], bel.log_w[b])
        alone = pf.predict(alone, u[:, b, 0], still, rng())
        alone, one = pf.update(alone, z[:, :, b, 0], SENSOR)
        np.testing.assert_allclose(after.state[:, b], alone.state)
        np.testing.assert_allclose(after.log_w[b], alone.log_w)
        assert evidence[b] == pytest.approx(one)


def test_the_seed_decides():
    a, b, c = (pf.run(LOG, start(100), MOTION, SENSOR, rng(s)).estimate for s in (5, 5, 6))
    np.testing.assert_array_equal(a, b)
    assert (a != c).any()


# --- the parts -------------------------------------------------------------------------------


def test_no_measurement_changes_nothing():
    bel = start(10)
    for z in (None, np.empty((3, 0))):
        same, evidence = pf.update(bel, z, SENSOR)
        assert same is bel and evidence == 0
        after, info = pf.step(bel, U, z, MOTION, SENSOR, rng(), threshold=1.0)
        assert not info.resampled and info.log_evidence == 0
        np.testing.assert_array_equal(after.log_w, bel.log_w)


def test_update_multiplies_weights_by_densities():
    bel = pf.from_weights(start(30).state, rng().random(30))
    z = SENSOR.sample(LOG.start, rng())
    after, evidence = pf.update(bel, z, SENSOR)
    by_hand = [
        w * np.exp(SENSOR.log_likelihood(z, pose))
        for w, pose in zip(bel.w, bel.state.T, strict=True)
    ]
    np.testing.assert_allclose(after.w, np.array(by_hand) / np.sum(by_hand))
    assert evidence == pytest.approx(np.log(np.sum(by_hand)))


def test_one_measurement_may_be_given_as_a_column():
    z = SENSOR.expected(LOG.start)[:, 0]
    column, _ = pf.update(start(20), z[:, None], SENSOR)
    flat, _ = pf.update(start(20), z, SENSOR)
    np.testing.assert_array_equal(column.log_w, flat.log_w)


def test_resample_copies_and_forgets_the_weights():
    bel = pf.from_weights(start(4).state, [0, 1, 0, 3])
    after = pf.resample(bel, pf.systematic, rng(), n=8)
    assert after.M == 8 and after.ess == pytest.approx(8)
    np.testing.assert_array_equal(after.state, bel.state[:, [1, 1, 3, 3, 3, 3, 3, 3]])
    batch = pf.from_weights(start((2, 4)).state, [[0, 1, 0, 3], [1, 0, 0, 0]])
    after = pf.take(batch, np.array([[3, 1], [0, 0]]))
    np.testing.assert_array_equal(after.state[:, 0], batch.state[:, 0, [3, 1]])
    np.testing.assert_array_equal(after.state[:, 1], batch.state[:, 1, [0, 0]])


def test_an_impossible_measurement_is_an_error_and_not_a_guess():
    class Never:
        def log_likelihood(self, z, pose):
            return np.full(pose.shape[1:], -np.inf)

    with pytest.raises(pf.DegenerateWeightsError, match="OutlierMixture"):
        pf.update(start(5), [[0.0]], Never())


class Careless:
    """Parts that return the wrong thing."""

    def sample(self, pose, u, generator):
        return pose[:, :1]

    def log_likelihood(self, z, pose):
        return np.zeros((2, *pose.shape[1:]))


def test_careless_parts_are_named():
    bel = start(5)
    with pytest.raises(pf.ShapeError, match=r"moved state must have shape \(3, 5\), got \(3, 1\)"):
        pf.predict(bel, U, Careless(), rng())
    with pytest.raises(
        pf.ShapeError, match=r"log-likelihood of each particle must have shape \(5,\), got \(2, 5\)"
    ):
        pf.update(bel, [[0.0]], Careless())
    with pytest.raises(pf.ShapeError, match=r"indices of shape \(5,\), got \(3,\)"):
        pf.resample(bel, lambda w, generator, n: np.arange(3), rng())
    with pytest.raises(pf.ParameterError, match="0 to 4, got array"):
        pf.resample(bel, lambda w, generator, n: w, rng())
    for wrong in (np.full(5, 5), np.full(5, -1)):
        with pytest.raises(pf.ParameterError, match="0 to 4"):
            pf.take(bel, wrong)
    with pytest.raises(pf.ShapeError, match=r"ancestors must have shape"):
        pf.take(bel, np.zeros((2, 3), int))


def test_a_run_keeps_what_the_filter_said():
    seen = []
    history = pf.run(LOG, start(200), MOTION, SENSOR, rng(), watch=lambda *a: seen.append(a))
    assert [k for k, _, _ in seen] == list(range(12))
    assert history.bel is seen[-1][1]
    np.testing.assert_array_equal(history.t, LOG.t)
    np.testing.assert_array_equal(history.truth, LOG.truth)
    np.testing.assert_array_equal(history.estimate[:, -1], pf.mean_pose(history.bel))
    np.testing.assert_array_equal(history.covariance[..., -1], pf.covariance(history.bel))
    trace = history.covariance[0, 0] + history.covariance[1, 1]
    np.testing.assert_allclose(history.position_sd, np.sqrt(trace))
    assert repr(history) == f"History(12 steps, resampled {history.resampled.sum()} times)"
    assert pf.rmse(history.estimate, LOG.truth) < 0.5


def test_a_batched_truth_loses_its_last_axis():
    truth = np.repeat(LOG.truth[:, :, None, None], 2, axis=2)
    log = pf.Log(LOG.t, LOG.u, LOG.z, truth)
    assert pf.run(log, start((2, 20)), MOTION, SENSOR, rng()).truth.shape == (3, 12, 2)


def test_resampling_some_filters_of_a_batch_leaves_the_others_as_they_are():
    w = rng(0).random((3, 50))
    bel = pf.from_weights(rng(1).normal(size=(3, 3, 50)), w)
    where = np.array([True, False, True])
    some = pf.resample(bel, pf.systematic, rng(2), where=where)
    np.testing.assert_array_equal(some.state[:, 1], bel.state[:, 1])
    np.testing.assert_array_equal(some.log_w[1], bel.log_w[1])
    pair = pf.Particles(bel.state[:, where], bel.log_w[where])
    alone = pf.resample(pair, pf.systematic, rng(2))
    np.testing.assert_array_equal(some.state[:, where], alone.state)
    np.testing.assert_array_equal(some.log_w[where], alone.log_w)
    assert pf.resample(bel, pf.systematic, rng(2), where=False) is bel


def test_filters_side_by_side_keep_one_size():
    bel = pf.from_weights(np.zeros((3, 2, 5)))
    with pytest.raises(pf.ParameterError, match="n must be 5, got 7"):
        pf.resample(bel, pf.systematic, rng(), n=7, where=[True, False])
    assert pf.resample(bel, pf.systematic, rng(), n=7).M == 7
