"""Staged tempering: the same posterior in stages, and a robot that is found."""

from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.judging.localise import localise

DATA = Path(__file__).parents[2] / "data"
WORLD = pf.LandmarkMap(np.array([[0.0, 4.0], [3.0, -1.0]]), bounds=(-5, 5, -5, 5))


def cloud(M=4000, seed=0):
    return pf.uniform_prior(M, WORLD, np.random.default_rng(seed))


def measurement(pose=(1.0, 1.0, 0.5), ids=(0, 1)):
    return pf.RangeBearing(WORLD, 0.1, 0.05).expected(np.array(pose), ids=np.array(ids))


def test_a_vague_measurement_is_weighed_plainly_and_moves_nobody():
    bel, sensor = cloud(), pf.RangeBearing(WORLD, 30.0, 10.0)
    tempered, stages = pf.tempered_update(bel, measurement(), sensor, np.random.default_rng(1))
    plain, _ = pf.update(bel, measurement(), sensor)
    assert stages == 1
    np.testing.assert_array_equal(tempered.state, bel.state)
    np.testing.assert_allclose(tempered.log_w, plain.log_w, atol=1e-12)


@pytest.mark.parametrize("z", [None, np.empty((3, 0))])
def test_no_measurement_leaves_the_belief(z):
    bel = cloud()
    same, stages = pf.tempered_update(bel, z, pf.RangeBearing(WORLD, 1, 1), None)
    assert same is bel and stages == 0


@pytest.mark.parametrize("keep", [0.2, 0.5, 0.8])
def test_every_stage_keeps_the_promised_sample_size(keep):
    bel, sensor, M = cloud(), pf.RangeBearing(WORLD, 0.1, 0.05), 4000
    rng = np.random.default_rng(2)
    bel, stages = pf.tempered_update(bel, measurement(), sensor, rng, keep=keep)
    assert stages > 3
    assert bel.ess >= keep * M * (1 - 1e-3)


def test_exponents_sum_to_one():
    """Without a kernel and with fixed particles the weights end as plain weights do."""
    bel, sensor = cloud(200), pf.RangeBearing(WORLD, 0.5, 0.3)
    seen = []

    class Spy:
        def log_likelihood(self, z, pose):
            seen.append(pose.copy())
            return sensor.log_likelihood(z, pose)

    copy = lambda w, rng, n=None: np.arange(w.size, dtype=np.int64)  # noqa: E731
    frozen, stages = pf.tempered_update(
        bel, measurement(), Spy(), np.random.default_rng(0), kernel=0.0, scheme=copy, keep=0.9
    )
    assert stages == len(seen) > 1
    np.testing.assert_array_equal(frozen.state, bel.state)


def test_gaussian_posterior_up_to_the_kernel():
    """Linear-Gaussian: mean right, spread right or a little wider."""

    class Linear:
        def log_likelihood(self, z, pose):
            return pf.log_gaussian(z[0, 0] - pose[0], 0.1) + pf.log_gaussian(pose[1], 1.0)

    rng = np.random.default_rng(4)
    bel = pf.gaussian_prior(20_000, np.zeros(3), np.array([1.0, 1.0, 0.1]), rng)
    bel, stages = pf.tempered_update(bel, np.array([[1.0], [0.0], [0.0]]), Linear(), rng)
    exact, sd = 1.0 / 1.01, 0.1 / np.sqrt(1.01)
    found = np.sqrt(pf.covariance(bel)[0, 0])
    assert stages > 2
    assert pf.mean_pose(bel)[0] == pytest.approx(exact, abs=0.02)
    assert 0.97 * sd < found < 1.15 * sd


def test_a_batch_of_one_is_a_single_run():
    sensor, bel = pf.RangeBearing(WORLD, 0.2, 0.1), cloud(500)
    batch = pf.Particles(bel.state[:, None], bel.log_w[None])
    one, n = pf.tempered_update(bel, measurement(), sensor, np.random.default_rng(5))
    many, n_many = pf.tempered_update(batch, measurement(), sensor, np.random.default_rng(5))
    np.testing.assert_array_equal(many.state[:, 0], one.state)
    assert n_many[0] == n


def test_filters_of_a_batch_do_not_touch_each_other():
    sensor = pf.RangeBearing(WORLD, 0.2, 0.1)
    narrow = pf.gaussian_prior(500, (1.0, 1.0, 0.5), (0.05, 0.05, 0.03), np.random.default_rng(0))
    wide = cloud(500)
    batch = pf.Particles(
        np.stack((narrow.state, wide.state), axis=1), np.stack((narrow.log_w, wide.log_w))
    )
    after, stages = pf.tempered_update(batch, measurement(), sensor, np.random.default_rng(1))
    assert stages[0] == 1 < stages[1]
    np.testing.assert_array_equal(after.state[:, 0], narrow.state)


def test_each_filter_of_a_batch_keeps_its_own_share():
    sensor, cloud_of_two = pf.RangeBearing(WORLD, 0.2, 0.1), cloud(1000)
    bel = pf.Particles(np.stack([cloud_of_two.state] * 2, 1), np.stack([cloud_of_two.log_w] * 2))
    after, stages = pf.tempered_update(
        bel, measurement(), sensor, np.random.default_rng(1), keep=[0.0, 0.5]
    )
    plain = pf.update(bel, measurement(), sensor)[0]
    assert stages[0] == 1 < stages[1]
    np.testing.assert_array_equal(after.state[:, 0], bel.state[:, 0])
    np.testing.assert_allclose(after.log_w[0], plain.log_w[0], atol=1e-12)
    with pytest.raises(pf.ShapeError, match="keep"):
        pf.tempered_update(bel, measurement(), sensor, np.random.default_rng(1), keep=[0.5] * 3)


def test_a_symmetric_world_keeps_both_hypotheses():
    """Two ranges leave a mirror image: the cloud must not choose."""
    sensor = pf.Range(WORLD, 0.1)
    pose = np.array([1.0, -1.0, 0.3])
    z = sensor.expected(pose)
    axis = WORLD.positions[:, 1] - WORLD.positions[:, 0]
    side = lambda x: np.sign(axis[0] * (x[1] - 3.0) - axis[1] * x[0])  # noqa: E731
    world = pf.LandmarkMap(WORLD.positions, bounds=(-12, 12, -12, 12))
    shares = []
    for seed in range(10):
        rng = np.random.default_rng(seed)
        bel, _ = pf.tempered_update(pf.uniform_prior(2000, world, rng), z, sensor, rng)
        shares.append((bel.w * (side(bel.state) == side(pose))).sum())
    assert 0.2 < np.mean(shares) < 0.8
    assert 0.02 < min(shares) and max(shares) < 0.98


@pytest.mark.slow
def test_tempering_is_never_sure_of_the_wrong_place_where_plain_weighting_is():
    """Starts all along the twin, 44 runs each; lost: wrong by 0.5 m and by 4 of its own sds.

    Where only one landmark is in sight the answer may be wrong by metres; it must say so.
    """
    log = pf.load_mrclam(DATA / "mrclam_twin")
    lost = {False: 0, True: 0}
    for begin in range(11, 280, 25):
        i, j = np.searchsorted(log.t, (begin, begin + 12))
        part = log[i:j]
        for plain in lost:
            track = localise(part, np.random.default_rng(begin), "global", 1500, 4, plain=plain)
            error = pf.position_error(track.estimate[:, -1], part.truth[:, -1])
            lost[plain] += int(((error > 0.5) & (error > 4 * track.sd[-1])).sum())
    assert lost[False] <= 1
    assert lost[True] >= 4


@pytest.mark.parametrize("bad", [{"keep": 1.5}, {"keep": -0.1}, {"kernel": -1}])
def test_parameters_are_checked(bad):
    with pytest.raises(pf.ParameterError):
        pf.tempered_update(cloud(10), measurement(), pf.RangeBearing(WORLD, 1, 1), None, **bad)
