"""An experiment responds to settings it did not choose; what only looks right does not pass."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import experiment, replay
from pfkit.labs.replay import in_its_own_way
from pfkit.labs.response import (
    Counted,
    Watched,
    calls,
    distance,
    each_setting,
    same_mean,
    same_scatter,
)


@pytest.fixture(scope="module")
def item():
    @experiment(
        """Resamplings until one of two clusters is lost
        h1
        h2
        h3""",
        claim="about 2 N ln 2",
        test="mean within 4.5 standard errors of a right experiment's, at each N",
        runs=200,
        settings=lambda rng: [(int(n),) for n in rng.choice(np.arange(10, 60, 2), 3, False)],
    )
    def lost(N, rng):
        k, age = N // 2, 0
        while 0 < k < N:
            k, age = rng.binomial(N, k / N), age + 1
        return age

    lost.holds("the mean follows N", same_mean())
    lost.holds("the runs scatter", same_scatter())
    return lost


def test_right_programs_pass_whatever_their_random_numbers(item):
    def by_choice(N, rng):
        cloud, age = np.arange(N) % 2, 0
        while 0 < cloud.sum() < N:
            cloud, age = cloud[rng.integers(N, size=N)], age + 1
        return age

    assert item.judge(item.reference).fraction == 1
    rate = replay(item, by_choice, decisions=300, pool=4800)
    assert rate.fails == 0, rate


@pytest.mark.parametrize(
    "lazy",
    [
        lambda N, rng: 2 * N * np.log(2),
        lambda N, rng: rng.integers(1, 60),
        lambda N, rng: 40,
        lambda N, rng: rng.normal(2 * N * np.log(2), 1.0),
        lambda N, rng: N,
        lambda N, rng: rng.exponential(0.8 * N),
    ],
    ids=["no scatter", "random", "constant", "little scatter", "N itself", "two thirds as long"],
)
def test_lazy_answers_are_refused(item, lazy):
    rate = replay(item, lazy, decisions=200, pool=4800)
    assert rate.share >= 0.95, rate


def test_half_the_size_is_refused(item):
    half = lambda N, rng: item.reference(N // 4 * 2, rng)  # noqa: E731
    assert replay(item, half, decisions=200, pool=4800).share >= 0.95


def test_the_random_numbers_depend_on_the_seed_alone():
    settings = [(1,), (2,)]
    a = each_setting(lambda k, rng: k * rng.random(), settings, 5, 4)
    b = each_setting(lambda k, rng: rng.random(), settings, 5, 4)
    np.testing.assert_allclose(a, b * [1, 2])


@pytest.fixture(scope="module")
def walk():
    @experiment(
        """Where a walk of n steps ends, and how far out
        h1
        h2
        h3""",
        claim="mean 0, distance as the root of n",
        test="as a right experiment",
        runs=400,
        together=True,
        settings=lambda rng: [(int(n),) for n in rng.choice(np.arange(10, 60, 10), 2, False)],
    )
    def ends(n, rng, runs):
        x = rng.standard_normal((n, runs)).sum(axis=0)
        return x, np.abs(x)

    ends.holds("the means follow n", same_mean())
    ends.holds("the runs scatter", same_scatter())
    hints = """{}
    h1
    h2
    h3"""
    ends.wrong(hints.format("one-way: only ever goes up"))(
        lambda n, rng, runs: _one_way(n, rng, runs)
    )
    ends.wrong(hints.format("half: goes half the way"))(
        lambda n, rng, runs: ends(n // 2, rng, runs)
    )
    return ends


def _one_way(n, rng, runs):
    x = np.abs(rng.standard_normal((n, runs))).sum(axis=0)
    return x, np.abs(x)


def test_runs_side_by_side_give_rows(walk):
    assert walk.outcomes(walk.reference, 30).shape == (30, 2, 2, 2)
    assert walk.judge(walk.reference).fraction == 1
    assert replay(walk, in_its_own_way(walk.reference), 300).fails == 0
    for wrong in (lambda n, rng, runs: np.zeros(3), lambda n, rng, runs: np.zeros(runs)):
        (line,) = walk.judge(wrong).lines
        assert not line.ok and "shape" in line.detail


def test_a_wrong_program_is_known_by_its_response(walk):
    """Also in another order of random numbers; what resembles none is not named."""
    for mistake in walk.misconceptions:
        for answer in (mistake.example, in_its_own_way(mistake.example)):
            assert walk.judge(answer).misconception is mistake
    judged = walk.judge(lambda n, rng, runs: walk(3 * n, rng, runs))
    assert judged.fraction < 1 and judged.misconception is None
    assert judged.example.startswith("Setting 1: n = ")


def test_calls_of_a_module_are_seen_under_any_name():
    hidden = {"f": pf.systematic}
    w = np.full(4, 0.25)
    assert calls(lambda: hidden["f"](w, np.random.default_rng(1)), pf.systematic)
    assert not calls(lambda: pf.wrap(4.0), pf.systematic)


def test_more_than_one_number_is_named():
    with pytest.raises(ValueError, match=r"one number per run, got shape \(3,\)"):
        each_setting(lambda rng: np.ones(3), [()], 1, 2)


def test_where_a_right_one_does_not_scatter_the_answer_must_not():
    x = np.zeros((20, 1, 2))
    assert same_scatter()(x) is True
    x[:, 0, 0] = np.random.default_rng(1).normal(size=20)
    assert "sd" in same_scatter()(x)


def test_calls_are_counted():
    counted = Counted(np.sum)
    assert counted([1, 2]) == 3 and counted.calls == 1
    watched = Watched(np.random.default_rng(1))
    watched.random()
    watched.random()
    assert watched.calls == {"random": 2}


def test_rows_that_vary_together_count_once_in_all():
    """Six rows that are one number: together they are as far off as one of them."""
    rng = np.random.default_rng(3)
    one = rng.standard_normal((40, 1, 1, 2))
    six = np.repeat(np.repeat(one, 2, axis=1), 3, axis=2)
    far = abs(float(distance(one).item()))
    assert same_mean(far * 1.01)(six) is True
    assert same_mean(far * 0.99)(six) is not True


def test_what_goes_with_the_reference_is_compared_run_by_run():
    """Nearly right, on the same random numbers: seen. As far off, but independent: not."""
    rng = np.random.default_rng(5)
    right, other = rng.normal(size=(2, 30, 3))
    nearly = right + 0.3 + 0.05 * rng.normal(size=right.shape)
    assert same_mean()(np.stack([nearly, right], axis=-1)) is not True
    assert same_mean()(np.stack([other + 0.3, right], axis=-1)) is True


def test_a_difference_far_below_the_scatter_is_let_pass():
    """A mean over one frame fewer is right in another form."""
    right = np.random.default_rng(6).normal(size=(30, 3))
    assert same_mean()(np.stack([right + 0.01, right], axis=-1)) is True


def test_independent_answers_seldom_seem_to_go_together():
    rng = np.random.default_rng(7)
    fails = sum(same_mean(5.0)(rng.normal(size=(24, 4, 2))) is not True for _ in range(3000))
    assert fails == 0
