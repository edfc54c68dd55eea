"""The 1-D histogram filter against sums done by hand, against loops, and against enumeration."""

import itertools

import numpy as np
import pytest

import pfkit as pf

DOORS = np.array([1, 1, 0, 0, 0, 0, 0, 1, 0, 0])


def rng():
    return np.random.default_rng(1)


@pytest.mark.parametrize("u", [-3, -1, 0, 1, 2])
def test_kernel_has_its_mass_where_it_says(u):
    kernel = pf.shift_kernel(u, undershoot=0.1, overshoot=0.2)
    k = kernel.size // 2
    ahead = -1 if u < 0 else 1
    assert kernel[k + u] == pytest.approx(0.7)
    assert kernel[k + u - ahead] == 0.1 and kernel[k + u + ahead] == 0.2
    assert kernel.sum() == pytest.approx(1)


@pytest.mark.parametrize("ring", [False, True])
def test_predict_is_the_double_sum(ring):
    bel = rng().dirichlet(np.ones(7))
    kernel = pf.shift_kernel(2, 0.2, 0.1)
    expected = np.zeros(7)
    for j, s in itertools.product(range(7), range(-3, 4)):
        i = (j + s) % 7 if ring else min(max(j + s, 0), 6)
        expected[i] += kernel[3 + s] * bel[j]
    moved = pf.predict_1d(bel, kernel, ring=ring)
    np.testing.assert_allclose(moved, expected, rtol=1e-14)
    assert moved.sum() == pytest.approx(1)


def test_walls_stop_and_a_ring_turns():
    bel = np.array([0.0, 0.0, 1.0])
    two = pf.shift_kernel(2)
    np.testing.assert_array_equal(pf.predict_1d(bel, two), [0, 0, 1])
    np.testing.assert_array_equal(pf.predict_1d(bel, two, ring=True), [0, 1, 0])
    np.testing.assert_array_equal(pf.predict_1d(bel, pf.shift_kernel(-1)), [0, 1, 0])


def test_a_kernel_longer_than_the_corridor_keeps_all_mass():
    bel = np.array([0.5, 0.5])
    for ring in (False, True):
        assert pf.predict_1d(bel, pf.shift_kernel(5, 0.3, 0.3), ring=ring).sum() == pytest.approx(1)


def test_update_by_hand():
    # four cells, one door: prior 1/4 each, hit .8, false .2 -> evidence .35, door cell 4/7
    likelihood = pf.door_likelihood([1, 0, 0, 0], True, hit=0.8, false=0.2)
    bel, evidence = pf.update_1d(np.full(4, 0.25), likelihood)
    assert evidence == pytest.approx(0.35)
    np.testing.assert_allclose(bel, [4 / 7, 1 / 7, 1 / 7, 1 / 7])


def test_both_reports_together_have_probability_one():
    bel = rng().dirichlet(np.ones(10))
    sum_of_evidence = sum(
        pf.update_1d(bel, pf.door_likelihood(DOORS, z, 0.9, 0.15))[1] for z in (True, False)
    )
    assert sum_of_evidence == pytest.approx(1)


def test_a_blind_detector_teaches_nothing():
    bel = rng().dirichlet(np.ones(10))
    after, _ = pf.update_1d(bel, pf.door_likelihood(DOORS, False, 0.4, 0.4))
    np.testing.assert_allclose(after, bel)


def test_filter_is_the_sum_over_all_paths():
    """Three steps on five cells: enumerate all 5^4 paths and apply Bayes once, at the end."""
    doors, zs, kernel = np.array([1, 0, 0, 1, 0]), (True, False, True), pf.shift_kernel(1, 0.2, 0.1)
    bel = rng().dirichlet(np.ones(5))
    move = np.array([pf.predict_1d(np.eye(5)[j], kernel) for j in range(5)])  # p(i | j)
    joint = np.zeros(5)
    for path in itertools.product(range(5), repeat=4):
        p = bel[path[0]]
        for t, z in enumerate(zs):
            p *= move[path[t], path[t + 1]]
            p *= pf.door_likelihood(doors, z, 0.8, 0.1)[path[t + 1]]
        joint[path[-1]] += p
    log_evidence = 0.0
    for z in zs:
        bel, evidence = pf.update_1d(
            pf.predict_1d(bel, kernel), pf.door_likelihood(doors, z, 0.8, 0.1)
        )
        log_evidence += np.log(evidence)
    np.testing.assert_allclose(bel, joint / joint.sum(), rtol=1e-12)
    assert log_evidence == pytest.approx(np.log(joint.sum()))


def test_batches_equal_single_runs():
    bel = rng().dirichlet(np.ones(6), size=(3, 2))
    kernel = pf.shift_kernel(1, 0.2, 0.1)
    likelihood = rng().random((2, 6))
    moved = pf.predict_1d(bel, kernel)
    after, evidence = pf.update_1d(moved, likelihood)
    for a, b in itertools.product(range(3), range(2)):
        np.testing.assert_allclose(moved[a, b], pf.predict_1d(bel[a, b], kernel))
        one, one_evidence = pf.update_1d(moved[a, b], likelihood[b])
        np.testing.assert_allclose(after[a, b], one)
        assert evidence[a, b] == pytest.approx(one_evidence)


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda: pf.shift_kernel(1.5), IndexError),
        (lambda: pf.shift_kernel(1, 0.6, 0.6), pf.ParameterError),
        (lambda: pf.predict_1d([0.5, 0.4], [0, 1, 0]), pf.ParameterError),
        (lambda: pf.predict_1d([0.5, 0.5], [0.5, 0.5]), pf.ShapeError),
        (lambda: pf.predict_1d([], [1.0]), pf.ShapeError),
        (lambda: pf.predict_1d([1.5, -0.5], [1.0]), pf.ParameterError),
        (lambda: pf.update_1d([0.5, 0.5], [1.0]), pf.ShapeError),
        (lambda: pf.update_1d([0.5, 0.5], [1.0, -1.0]), pf.ParameterError),
        (lambda: pf.update_1d([1.0, 0.0], [0.0, 1.0]), pf.DegenerateWeightsError),
        (lambda: pf.door_likelihood([0, 2], True, 0.8, 0.1), pf.ParameterError),
        (lambda: pf.door_likelihood([0, 1], True, 1.8, 0.1), pf.ParameterError),
    ],
)
def test_bad_input_is_named(call, error):
    with pytest.raises(error):
        call()
