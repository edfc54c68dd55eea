"""Ancestor trees against hand-made ones, and the drift clock against theory."""

import math

import numpy as np
import pytest

import pfkit as pf


def rng(seed=0):
    return np.random.default_rng(seed)


def wright_fisher(N, T, B, seed=0, scheme=pf.multinomial):
    """Ancestors (T, B, N) of T resamplings of equal weights."""
    source, w = rng(seed), np.full((B, N), 1 / N)
    return np.stack([scheme(w, source) for _ in range(T)])


TREE = np.array([[0, 0, 2, 3], [1, 1, 2, 2], [0, 0, 0, 3]])  # three generations of four


def test_a_small_tree_by_hand():
    np.testing.assert_array_equal(
        pf.ancestry(TREE), [[0, 0, 0, 2], [1, 1, 1, 2], [0, 0, 0, 3], [0, 1, 2, 3]]
    )
    np.testing.assert_array_equal(
        pf.founders(TREE), [[0, 1, 2, 3], [0, 0, 2, 3], [0, 0, 2, 2], [0, 0, 0, 2]]
    )
    np.testing.assert_array_equal(pf.count_distinct(pf.ancestry(TREE)), [2, 2, 2, 4])
    assert pf.coalescence_time(TREE) == np.inf
    assert pf.coalescence_time(np.vstack((TREE[:2], [[0, 0, 0, 1]]))) == 2


def test_both_directions_name_the_same_founders():
    a = wright_fisher(20, 15, 3)
    np.testing.assert_array_equal(pf.ancestry(a)[0], pf.founders(a)[-1])


def test_a_batch_is_its_runs():
    a = wright_fisher(12, 60, 5)
    together = pf.coalescence_time(a)
    for b in range(5):
        assert pf.coalescence_time(a[:, b]) == together[b]
        np.testing.assert_array_equal(pf.ancestry(a)[:, b], pf.ancestry(a[:, b]))


def test_ancestors_only_get_fewer_into_the_past():
    counts = pf.count_distinct(pf.ancestry(wright_fisher(50, 40, 4)))
    assert (np.diff(counts, axis=0) >= 0).all()


def test_systematic_resampling_of_equal_weights_loses_nobody():
    a = wright_fisher(64, 50, 2, scheme=pf.systematic)
    assert (pf.count_distinct(pf.founders(a)) == 64).all()


@pytest.mark.parametrize(("N", "exact"), [(50, 67.5), (100, 136.6), (200, 275.0)])
def test_the_drift_clock_has_the_published_values(N, exact):
    assert pf.drift_time(N) == pytest.approx(exact, abs=0.06)
    assert pf.drift_time(N) == pytest.approx(2 * N * math.log(2), rel=0.03)


def test_the_drift_clock_of_two_particles_is_two():
    """With one particle each, every resampling separates with probability 1/2: geometric."""
    assert pf.drift_time(2) == pytest.approx(2.0)
    assert pf.drift_time(10, share=0.0) == pf.drift_time(10, share=1.0) == 0.0
    assert pf.drift_time(30, share=0.2) == pytest.approx(pf.drift_time(30, share=0.8))


def test_the_drift_clock_agrees_with_resampling():
    N, B, T = 20, 400, 400
    in_first = pf.founders(wright_fisher(N, T, B)) < N // 2
    share = in_first.mean(axis=-1)
    lost = np.argmax((share == 0) | (share == 1), axis=0)
    assert (lost > 0).all()  # 400 generations are 15 times the mean
    z = (lost.mean() - pf.drift_time(N)) / (lost.std(ddof=1) / math.sqrt(B))
    assert abs(z) < 4.5


def exact_coalescence(N):
    """Mean generations to one ancestor: i lines have j parents with chance S(i,j) N!/(N-j)!/N^i."""
    move = np.zeros((N + 1, N + 1))
    move[0, 0] = 1.0
    for i in range(N):  # throw one line more at N parents
        for j in range(i + 1):
            move[i + 1, j] += move[i, j] * j / N
            move[i + 1, j + 1] += move[i, j] * (N - j) / N
    lines = slice(2, N + 1)
    stay = move[lines, lines]
    return np.linalg.solve(np.eye(N - 1) - stay, np.ones(N - 1))[-1]


def test_the_time_to_one_ancestor_agrees_with_the_exact_chain():
    N, B = 16, 400
    times = pf.coalescence_time(wright_fisher(N, 400, B, seed=1))
    assert np.isfinite(times).all()
    z = (times.mean() - exact_coalescence(N)) / (times.std(ddof=1) / math.sqrt(B))
    assert abs(z) < 4.5


@pytest.mark.parametrize("N", [50, 100, 200])
def test_the_time_to_one_ancestor_is_about_two_n(N):
    assert exact_coalescence(N) == pytest.approx(2 * N, rel=0.05)


def test_the_recorder_keeps_what_the_filter_did():
    motion = pf.VelocityMotion()
    world = pf.LandmarkMap([[5.0, 0.0], [0.0, 5.0]])
    sensor = pf.RangeBearing(world, 0.1, 0.1)
    u = np.tile(np.array([[0.5], [0.2], [0.1]]), 12)
    log = pf.simulate_log(np.zeros(3), u, motion, sensor, rng(), batch=2, every=2)
    bel = pf.gaussian_prior((2, 100), np.zeros(3), np.full(3, 0.2), rng(1))
    tree = pf.Genealogy()
    history = pf.run(log, bel, motion, sensor, rng(2), watch=tree)
    assert tree.ancestors.shape == (12, 2, 100)
    copied = (tree.ancestors != np.arange(100)).any(axis=-1)
    np.testing.assert_array_equal(copied, history.resampled)
    assert pf.count_distinct(pf.founders(tree.ancestors))[-1].max() < 100


@pytest.mark.parametrize(
    ("ancestors", "error"),
    [
        (np.zeros(3, dtype=int), pf.ShapeError),
        (np.zeros((3, 0), dtype=int), pf.ShapeError),
        (np.zeros((3, 4)), pf.ShapeError),
        (np.full((3, 4), 4), pf.ParameterError),
        (np.full((3, 4), -1), pf.ParameterError),
    ],
)
def test_bad_ancestors_are_named(ancestors, error):
    for function in (pf.ancestry, pf.founders, pf.coalescence_time):
        with pytest.raises(error):
            function(ancestors)


@pytest.mark.parametrize("scheme", pf.SCHEMES.values(), ids=pf.SCHEMES.keys())
def test_offspring_scores_of_an_honest_scheme_are_standard_normal(scheme):
    w = np.array([0.4, 0.25, 0.15, 0.12, 0.08])
    z = pf.offspring_z(scheme, w, rng(3), draws=3000)
    assert np.abs(z).max() < 4.5  # five scores: false alarm 3e-5


def test_offspring_scores_expose_a_scheme_that_favours_the_first():
    def biased(w, rng, n):
        chosen = pf.multinomial(w, rng, n)
        chosen[0] = 0
        return chosen

    assert pf.offspring_z(biased, np.full(10, 0.1), rng(), draws=3000)[0] > 20


def test_a_count_that_never_varies_is_exact_or_infinitely_wrong():
    w = np.full(4, 0.25)
    np.testing.assert_array_equal(pf.offspring_z(pf.systematic, w, rng(), 10), 0)

    def always_first(w, rng, n):
        return np.zeros(n, dtype=np.int64)

    z = pf.offspring_z(always_first, w, rng(), 10)
    assert z[0] == np.inf and (z[1:] == -np.inf).all()


def test_a_record_counts_its_steps():
    tree = pf.Genealogy()
    with pytest.raises(ValueError, match="need at least one array"):
        tree.ancestors  # noqa: B018
    tree(0, None, pf.Info(0.0, 1.0, False, np.arange(3)))
    assert repr(tree) == "Genealogy(1 steps)" and tree.ancestors.shape == (1, 3)
