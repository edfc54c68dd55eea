"""Clusters: heaps with known masses are found, across the end of the circle too."""

import numpy as np
import pytest

import pfkit as pf


def heap(centre, M, seed, sigma=0.2):
    return pf.gaussian_prior(M, centre, (sigma, sigma, 0.1), np.random.default_rng(seed)).state


def test_heaps_with_their_masses_heaviest_first():
    state = np.hstack((heap((2, 2, 0), 200, 0), heap((8, 2, 1), 500, 1), heap((5, 7, -2), 300, 2)))
    found = pf.clusters(pf.from_weights(state))
    np.testing.assert_allclose(found.mass, [0.5, 0.3, 0.2])
    np.testing.assert_allclose(found.mean[:2].T, [(8, 2), (5, 7), (2, 2)], atol=0.1)
    np.testing.assert_array_equal(found.label, np.repeat([2, 0, 1], (200, 500, 300)))


def test_weights_decide_the_mass():
    state = np.hstack((heap((2, 2, 0), 100, 0), heap((8, 2, 1), 100, 1)))
    found = pf.clusters(pf.from_weights(state, np.repeat([3.0, 1.0], 100)))
    np.testing.assert_allclose(found.mass, [0.75, 0.25])
    assert found.mean[0, 0] == pytest.approx(2, abs=0.1)


@pytest.mark.parametrize("cell", [np.pi / 4, 1.0, 0.3])
def test_a_heap_across_pi_is_one(cell):
    found = pf.clusters(pf.from_weights(heap((2, 2, np.pi), 500, 0)), (1, 1, cell))
    assert found.mass[0] > 0.97
    assert abs(pf.wrap(found.mean[2, 0] - np.pi)) < 0.05


def test_opposite_headings_are_two():
    state = np.hstack((heap((2, 2, 0), 100, 0), heap((2, 2, np.pi), 100, 1)))
    assert pf.clusters(pf.from_weights(state)).mass.tolist() == pytest.approx([0.5, 0.5])


def test_a_thin_bridge_joins():
    bridge = np.stack((np.linspace(2, 8, 25), np.full(25, 2.0), np.zeros(25)))
    state = np.hstack((heap((2, 2, 0), 500, 0), heap((8, 2, 0), 500, 1), bridge))
    assert pf.clusters(pf.from_weights(state)).mass.size == 1


def test_particles_without_weight_are_strays():
    state = np.hstack((heap((2, 2, 0), 10, 0), heap((8, 2, 0), 1, 1)))
    found = pf.clusters(pf.from_weights(state, np.repeat([1.0, 0.0], (10, 1))), (2, 2, 2))
    assert found.label[-1] == -1 and found.mass.sum() == pytest.approx(1)


def test_a_plane_has_no_circle():
    state = np.random.default_rng(0).normal(0, 0.1, (2, 50)) + np.array([[0.5], [0.5]])
    assert pf.clusters(pf.from_weights(state), (1, 1)).mean.shape == (2, 1)


@pytest.mark.parametrize("cell", [(1, 1), (1, 1, 0), (1, 1, np.nan), (1e-300, 1, 1)])
def test_bad_cells_are_named(cell):
    with pytest.raises(pf.PfkitError):
        pf.clusters(pf.from_weights(heap((0, 0, 0), 9, 0)), cell)


def test_batches_are_refused():
    with pytest.raises(pf.ShapeError, match="one set"):
        pf.clusters(pf.from_weights(np.ones((3, 2, 9))))


def test_covariances_add_up_to_that_of_the_cloud():
    state = np.hstack((heap((2, 2, 0), 200, 0), heap((8, 2, 1), 500, 1, 0.3)))
    bel = pf.from_weights(state, np.random.default_rng(2).random(700))
    found = pf.clusters(bel)
    off = found.mean[:2] - pf.mean_pose(bel)[:2, None]
    within = np.einsum("c,ijc->ij", found.mass, found.covariance[:2, :2])
    between = np.einsum("c,ic,jc->ij", found.mass, off, off)
    np.testing.assert_allclose(within + between, pf.covariance(bel)[:2, :2], rtol=1e-9)


def test_each_heap_has_its_own_covariance_across_pi():
    found = pf.clusters(pf.from_weights(heap((2, 2, np.pi), 4000, 0)), (2, 2, 1))
    sd = np.sqrt(np.diag(found.covariance[:, :, 0]))
    np.testing.assert_allclose(sd, (0.2, 0.2, 0.1), rtol=0.05)
