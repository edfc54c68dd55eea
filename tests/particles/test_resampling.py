"""Resampling schemes: unbiased, as noisy as theory says, exact about edges, the same in batches."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import pfkit as pf
from pfkit.particles import resampling, ticks

SKEWED = np.array((0.4, 0.25, 0.15, 0.12, 0.08))
WEIGHTS = {
    "skewed": SKEWED,
    "zeros at both ends": np.array((0.0, 0.0, 3.0, 0.0, 1.0, 2.0, 0.0)),
    "ties": np.full(8, 0.125),
    "one holds nearly all": np.array((1e-9, 1.0, 1e-9, 1e-3)),
    "many": np.random.default_rng(5).exponential(size=40),
}
ALL = {**pf.SCHEMES, "resampling_wheel": pf.resampling_wheel}
weight_sets = arrays(
    float,
    st.integers(1, 30),
    elements=st.one_of(st.just(0.0), st.floats(1e-6, 1e6)),
).filter(lambda w: w.sum() > 0)


def rng(seed=0):
    return np.random.default_rng(seed)


def offspring(ancestors, M):
    """Copies of each particle, (R, M), from R sets of ancestors (R, n)."""
    rows = ancestors + M * np.arange(len(ancestors))[:, None]
    return np.bincount(rows.ravel(), minlength=M * len(ancestors)).reshape(-1, M)


def many_draws(scheme, w, n, runs=6_000, seed=1):
    return offspring(scheme(np.tile(w, (runs, 1)), rng(seed), n), w.size)


def overlaps(w, n):
    """Length of particle m's stretch within unit cell k of the ruler: (M, n), by a plain loop."""
    right = n * np.cumsum(w / w.sum())
    left = np.concatenate(([0.0], right[:-1]))
    return np.array(
        [
            [max(0.0, min(b, k + 1) - max(a, k)) for k in range(n)]
            for a, b in zip(left, right, strict=True)
        ]
    )


def theoretical_variance(name, w, n):
    w = w / w.sum()
    if name == "multinomial":
        return n * w * (1 - w)
    if name == "stratified":
        o = overlaps(w, n)
        return (o * (1 - o)).sum(axis=1)
    fraction = n * w - np.floor(n * w + 1e-9)
    fraction = np.maximum(fraction, 0.0)
    if name == "systematic":
        return fraction * (1 - fraction)
    draws = round(fraction.sum())
    share = fraction / max(draws, 1)
    return draws * share * (1 - share)


def table_4_4(w, u, n):
    """The low variance sampler of Probabilistic Robotics, line by line."""
    w = w / w.sum()
    r, c, i, ancestors = u / n, w[0], 0, []
    for m in range(n):
        while r + m / n > c and i < w.size - 1:
            i += 1
            c += w[i]
        ancestors.append(i)
    return np.array(ancestors)


def wheel_by_hand(w, generator, n):
    """The wheel as it is usually written: subtract weights while the step exceeds them."""
    w = w / w.sum()
    index, beta, ancestors = int(generator.integers(w.size, size=1)[0]), 0.0, []
    for u in generator.random(n):
        beta += 2 * w.max() * u
        while beta > w[index]:
            beta -= w[index]
            index = (index + 1) % w.size
        ancestors.append(index)
    return np.array(ancestors)


@pytest.mark.parametrize("n", [None, 3, 17])
@pytest.mark.parametrize("weights", WEIGHTS)
@pytest.mark.parametrize("name", pf.SCHEMES)
def test_copies_are_unbiased_and_as_noisy_as_theory_says(name, weights, n):
    """Fixed seeds; |z| < 4.5 on at most 40 particles has a false-fail rate below 3e-4 a case."""
    w = WEIGHTS[weights]
    n, runs = n or w.size, 6_000
    copies = many_draws(pf.SCHEMES[name], w, n, runs)
    expected, variance = n * w / w.sum(), theoretical_variance(name, w, n)
    assert (copies.sum(axis=1) == n).all()
    noise = np.sqrt(np.maximum(variance, 1e-3) / runs)
    assert np.abs((copies.mean(axis=0) - expected) / noise).max() < 4.5
    fourth = ((copies - copies.mean(axis=0)) ** 4).mean(axis=0)
    noise = np.sqrt(np.maximum(fourth - variance**2, 1e-3) / runs)
    assert (np.abs(copies.var(axis=0) - variance) / noise).max() < 4.5


@pytest.mark.parametrize("name", pf.SCHEMES)
def test_the_floor_and_ceiling_bounds(name):
    w = rng(3).exponential(size=200)
    expected = 300 * w / w.sum()
    copies = many_draws(pf.SCHEMES[name], w, 300, runs=300)
    spread = np.abs(copies - expected).max()
    if name == "systematic":
        assert (copies >= np.floor(expected)).all() and (copies <= np.ceil(expected)).all()
    elif name == "stratified":
        assert spread < 2  # two strata can be met in part, at one end each
    elif name == "residual":
        assert (copies >= np.floor(expected)).all() and spread > 2
    else:
        assert spread > 3


def test_stratified_and_residual_never_vary_more_than_multinomial():
    for seed in range(20):
        w = rng(seed).exponential(size=12) ** 2
        reference = theoretical_variance("multinomial", w, 12)
        for name in ("stratified", "residual"):
            assert (theoretical_variance(name, w, 12) <= reference + 1e-12).all()


def test_a_cloud_in_step_with_the_comb_is_sampled_badly():
    """Alternating weights: all pairs share one outcome, and the estimate's variance is M/3 times
    multinomial's, though each particle's own copies vary less."""
    M, runs = 300, 4000
    w = np.tile((1.5, 0.5), M // 2) / M
    heavy = {
        name: many_draws(pf.SCHEMES[name], w, M, runs)[:, ::2].sum(axis=1) / M
        for name in ("systematic", "multinomial", "stratified")
    }
    ratio = heavy["systematic"].var() / heavy["multinomial"].var()
    assert ratio == pytest.approx(M / 3, rel=0.1)
    assert heavy["stratified"].var() < heavy["multinomial"].var()


@given(w=weight_sets, seed=st.integers(0, 2**32 - 1), n=st.integers(1, 50))
def test_properties_of_any_weights(w, seed, n):
    for name, scheme in ALL.items():
        ancestors = scheme(w, rng(seed), n)
        assert ancestors.shape == (n,) and ancestors.dtype == np.int64
        assert (w[ancestors] > 0).all(), f"{name} copied a particle without weight"
        if name != "resampling_wheel":
            assert (np.diff(ancestors) >= 0).all()


@given(w=weight_sets, seed=st.integers(0, 2**32 - 1), scale=st.floats(1e-200, 1e200))
def test_the_scale_of_the_weights_does_not_matter(w, seed, scale):
    for scheme in (pf.multinomial, pf.stratified, pf.systematic):
        power = 2.0 ** round(np.log2(scale))  # exact, so that not even rounding differs
        np.testing.assert_array_equal(scheme(w, rng(seed)), scheme(w * power, rng(seed)))


@pytest.mark.parametrize("weights", WEIGHTS)
@pytest.mark.parametrize("n", [1, 5, 64])
def test_systematic_is_table_4_4(weights, n):
    w = WEIGHTS[weights]
    for seed in range(50):
        expected = table_4_4(w, rng(seed).random(), n)
        np.testing.assert_array_equal(pf.systematic(w, rng(seed), n), expected)


def test_stratified_searches_one_point_in_each_stratum():
    w = WEIGHTS["many"]
    points = (np.arange(60) + rng(2).random(60)) / 60
    expected = np.searchsorted(np.cumsum(w / w.sum()), points)
    np.testing.assert_array_equal(pf.stratified(w, rng(2), 60), expected)


class Fixed(np.random.Generator):
    """A generator whose uniforms are all the same chosen number."""

    def __init__(self, value):
        super().__init__(np.random.PCG64(0))
        self.value = value

    def random(self, size=None):
        return np.full(size, self.value)


@pytest.mark.parametrize("u", [0.0, np.nextafter(1.0, 0.0)])
@pytest.mark.parametrize("n", [1, 7, 1000])
def test_the_extreme_offsets_lose_no_tooth(u, n):
    for w in (*WEIGHTS.values(), np.full(10, 0.1), np.full(1000, 1e-3)):
        for scheme in (pf.systematic, pf.stratified):
            ancestors = scheme(w, Fixed(u), n)
            assert ancestors.max() < w.size and (w[ancestors] > 0).all()
            batch = scheme(np.tile(w, (2, 1)), Fixed(u), n)
            np.testing.assert_array_equal(batch, np.tile(ancestors, (2, 1)))


@pytest.mark.parametrize("name", ALL)
def test_a_batch_of_one_is_a_single_run_bit_for_bit(name):
    w = WEIGHTS["many"]
    for n in (None, 7, 90):
        single = ALL[name](w, rng(4), n)
        for shape in ((1, w.size), (1, 1, w.size)):
            batch = ALL[name](w.reshape(shape), rng(4), n)
            assert batch.shape == (*shape[:-1], single.size) and batch.dtype == np.int64
            np.testing.assert_array_equal(batch.reshape(-1), single)


@pytest.mark.parametrize("name", ALL)
def test_rows_of_a_batch_keep_to_themselves(name):
    w = np.zeros((3, 5))
    w[0, 1], w[1, 4], w[2, :2] = 1.0, 2.0, 1.0
    ancestors = ALL[name](w, rng(), 6)
    assert (ancestors[0] == 1).all() and (ancestors[1] == 4).all() and (ancestors[2] <= 1).all()


@pytest.mark.parametrize("name", ALL)
def test_the_seed_decides(name):
    w = WEIGHTS["many"]
    np.testing.assert_array_equal(ALL[name](w, rng(8)), ALL[name](w, rng(8)))
    assert (ALL[name](w, rng(8)) != ALL[name](w, rng(9))).any()


@pytest.mark.parametrize("name", ["multinomial", "residual"])
def test_the_order_of_particles_does_not_matter(name):
    """Copies of a permuted set, put back in order, have the same mean and variance."""
    w, order = WEIGHTS["skewed"], np.array((3, 0, 4, 1, 2))
    plain = many_draws(pf.SCHEMES[name], w, 5, seed=1)
    permuted = many_draws(pf.SCHEMES[name], w[order], 5, seed=2)[:, np.argsort(order)]
    np.testing.assert_allclose(plain.mean(axis=0), permuted.mean(axis=0), atol=0.06)
    np.testing.assert_allclose(plain.var(axis=0), permuted.var(axis=0), atol=0.05)


def test_residual_with_whole_expectations_draws_nothing():
    w = np.array((0.1, 0.2, 0.3, 0.4))
    ancestors = pf.residual(w, rng(), 10)
    np.testing.assert_array_equal(ancestors, np.repeat(np.arange(4), (1, 2, 3, 4)))


@pytest.mark.parametrize("weights", WEIGHTS)
def test_the_wheel_is_the_loop_it_is_taught_as(weights):
    w = WEIGHTS[weights]
    for seed in range(20):
        expected = wheel_by_hand(w, rng(seed), 9)
        np.testing.assert_array_equal(pf.resampling_wheel(w, rng(seed), 9), expected)


def test_the_wheel_is_biased_for_few_particles():
    """Its start ignores the weights; an honest scheme stays within 4.5 standard errors."""
    w, runs = np.linspace(1.0, 0.01, 20), 20_000
    copies = many_draws(pf.resampling_wheel, w, 20, runs)
    z = (copies.mean(axis=0) - 20 * w / w.sum()) / (copies.std(axis=0) / np.sqrt(runs))
    assert np.abs(z).max() > 9


@pytest.mark.parametrize("M", [1, 2, 7, 100, 1000, 20_000])
@pytest.mark.parametrize("teeth", ["one offset", "one for each stratum"])
def test_whole_numbers_and_floats_comb_alike(M, teeth, monkeypatch):
    """5,000 and more weights go through ticks; they are no other scheme."""
    random = rng(M)
    w = random.exponential(size=M) ** 3 * (random.random(M) < 0.7)
    w[M // 2] += 0.1
    for n in (M, M + 3, max(M // 2, 1)):
        u = random.random(1 if teeth == "one offset" else n)
        monkeypatch.setattr(resampling, "MANY", M)
        plain = resampling._comb(w, n, u)
        np.testing.assert_array_equal(plain, ticks.comb(w, n, u))
        monkeypatch.setattr(resampling, "MANY", M - 1)
        np.testing.assert_array_equal(resampling._comb(w, n, u), plain)


@pytest.mark.parametrize("share", [0.0, 0.5, np.nextafter(1.0, 0.0)])
@pytest.mark.parametrize("M", [1, 3, 999, 4096, 6000])
def test_a_tooth_at_either_end_of_its_stratum_finds_a_particle_with_weight(share, M):
    w = np.concatenate(([0.0], rng(M).exponential(size=M), [0.0]))
    for n in (1, M, 100_000):
        for size in (1, n):
            found = resampling._comb(w, n, np.full(size, share))
            assert found.min() >= 1 and found.max() <= M and found.size == n


def test_a_comb_that_waits_lets_shares_drift_further():
    """Log-weights of variance .25 a step, two clusters side by side: 4 N times the variance."""
    N, runs, rng = 100, 8000, np.random.default_rng(0)
    in_a = np.tile(np.arange(N) < N // 2, (runs, 1))
    log_w, _ = pf.normalise(0.5 * np.sqrt(3) * rng.standard_normal((runs, N)))
    waited = np.sum(np.exp(log_w) * in_a, axis=1).var() * 4 * N
    for _ in range(3):
        log_w, _ = pf.normalise(0.5 * rng.standard_normal((runs, N)))
        in_a = np.take_along_axis(in_a, pf.systematic(np.exp(log_w), rng), axis=1)
    each = in_a.mean(axis=1).var() * 4 * N
    assert each == pytest.approx(3 * (np.exp(0.25) - 1), rel=0.06)
    assert waited == pytest.approx(np.exp(0.75) - 1, rel=0.1) and waited > 1.1 * each
