"""The divergence estimator on clouds drawn from known densities, and the bell."""

import math

import numpy as np
import pytest

import pfkit as pf

BOUNDS = (0.0, 8.0, 0.0, 8.0)


def rng(seed=0):
    return np.random.default_rng(seed)


def four_modes(keep=(0, 1, 2, 3)):
    """Four equal modes, like those of the square; `keep` leaves some out."""
    grid = pf.uniform_grid((32, 32, 16), BOUNDS)
    centres = [(2, 2, 0.8), (6, 2, 2.4), (6, 6, -2.4), (2, 6, -0.8)]
    p = sum(pf.gaussian_grid(grid.p.shape, BOUNDS, centres[k], (0.3, 0.3, 0.2)).p for k in keep)
    return pf.PoseGrid(p / len(keep), BOUNDS)


def draw(grid, shape, seed=0):
    """Poses from the grid's own density: a cell by its mass, uniform inside."""
    generator = rng(seed)
    cell = generator.choice(grid.p.size, size=shape, p=grid.p.ravel())
    inside = (generator.random((3, *np.atleast_1d(shape))) - 0.5) * grid.cell.reshape(
        3, *(1,) * np.ndim(cell)
    )
    return pf.from_weights(grid.poses.reshape(3, -1)[:, cell] + inside)


def test_boxes_hold_about_equal_mass_and_never_none():
    for grid in (four_modes(), pf.uniform_grid((7, 9, 5), BOUNDS)):
        box = pf.equal_mass_boxes(grid.p, 32).ravel()
        mass = np.bincount(box, grid.p.ravel())
        assert mass.size == 32
        assert 0.4 / 32 < mass.min() and mass.max() < 2.5 / 32


def test_boxes_are_boxes():
    box = pf.equal_mass_boxes(four_modes().p, 20)
    for number in range(20):
        i, j, k = np.nonzero(box == number)
        assert i.size == np.ptp(i) + 1 or i.size == np.prod([np.ptp(a) + 1 for a in (i, j, k)])


def test_fewer_boxes_where_mass_sits_in_few_cells():
    p = np.zeros((4, 4, 4))
    p[1, 1, 1], p[3, 3, 3], p[3, 3, 2] = 0.5, 0.3, 0.2
    box = pf.equal_mass_boxes(p, 64)
    assert np.sort(np.bincount(box.ravel(), p.ravel())) == pytest.approx([0.2, 0.3, 0.5])


def test_no_divergence_is_found_where_there_is_none():
    """2,000 clouds from the grid itself: mean 0 within 4 standard errors, coverage near 95 %."""
    grid = four_modes()
    d = pf.kl_divergence(draw(grid, (2000, 600)), grid, bins=32)
    assert abs(d.kl.mean()) < 4 * d.kl.std() / math.sqrt(2000) + 2e-4
    covered = np.mean((d.low <= 0) & (0 <= d.high))
    assert 0.93 < covered < 0.99
    assert d.bias.mean() == pytest.approx(31 / 1200, rel=0.01)


def test_a_known_divergence_is_found_and_covered():
    """Mixture shares (.55, .25, .15, .05) against equal ones: KL = sum q log 4 q."""
    grid, shares = four_modes(), np.array([0.55, 0.25, 0.15, 0.05])
    true = float((shares * np.log(4 * shares)).sum())
    p = sum(s * four_modes((k,)).p for k, s in enumerate(shares))
    other = pf.PoseGrid(p, BOUNDS)
    d = pf.kl_divergence(draw(other, (1000, 800), seed=3), grid, bins=32)
    assert d.kl.mean() == pytest.approx(true, abs=0.01)
    assert 0.92 < np.mean((d.low <= true) & (true <= d.high)) < 0.98


@pytest.mark.parametrize("lost, nats", [(2, math.log(2)), (3, math.log(4))])
def test_lost_modes_cost_what_they_should(lost, nats):
    alive = tuple(range(4 - lost))
    d = pf.kl_divergence(draw(four_modes(alive), 4000), four_modes(), bins=32)
    assert d.low < nats < d.high
    assert d.kl == pytest.approx(nats, abs=0.05)


def test_weights_count():
    """Draws from the uniform, weighted by p, stand for p."""
    grid = four_modes()
    poses = draw(pf.uniform_grid(grid.p.shape, BOUNDS), 60_000).state
    bel = pf.from_weights(poses, grid.p.ravel()[grid.index(poses)[0]])
    d = pf.kl_divergence(bel, grid, bins=16)
    assert d.low < 0 < d.high
    assert d.bias == pytest.approx(15 / (2 * bel.ess))


def test_one_wrong_copy_is_far_off_though_its_ess_is_perfect():
    grid = four_modes()
    copies = pf.from_weights(np.tile([[2.0], [2.0], [0.8]], 1000))
    d = pf.kl_divergence(copies, grid, bins=64)
    assert copies.ess == pytest.approx(1000)
    assert d.kl == pytest.approx(math.log(64), abs=0.7)


def test_particles_outside_are_told():
    grid = four_modes()
    state = draw(grid, 100).state
    state[0, :25] = 11.0
    assert pf.kl_divergence(pf.from_weights(state), grid).outside == pytest.approx(0.25)


def test_batch_equals_single():
    grid = four_modes()
    batch = draw(grid, (3, 200))
    d = pf.kl_divergence(batch, grid, bins=16)
    for b in range(3):
        one = pf.kl_divergence(pf.Particles(batch.state[:, b], batch.log_w[b]), grid, bins=16)
        assert (one.kl, one.low, one.bias) == pytest.approx((d.kl[b], d.low[b], d.bias[b]))


def test_refinement_sees_an_answer_that_moved_and_one_that_stands_still():
    def smooth(shape, x):
        return pf.gaussian_grid(shape, BOUNDS, (x, 4, 0), (0.8, 0.8, 0.6))

    coarse, fine = (16, 16, 16), (32, 32, 32)
    assert abs(pf.refinement(smooth(coarse, 4), smooth(fine, 4))) < 0.01
    moved = pf.refinement(smooth(coarse, 4), smooth(fine, 5))
    assert 0.5 < moved / (1 / (2 * 0.8**2)) <= 1  # KL of shifted Gaussians; boxes see a part


def test_bad_input_is_named():
    grid = pf.uniform_grid((4, 4, 4), BOUNDS)
    with pytest.raises(pf.ShapeError):
        pf.kl_divergence(pf.from_weights(np.zeros((2, 5))), grid)
    with pytest.raises(pf.ShapeError, match="twice"):
        pf.refinement(grid, grid)
    with pytest.raises(pf.ParameterError):
        pf.equal_mass_boxes(grid.p, 0)


def test_a_sliver_of_mass_still_leaves_every_box_some():
    """Beside a cell with nearly all of it, 1e-30 is lost in rounding but not in the cut."""
    p = np.zeros((4, 3, 2))
    p[2, 1, 1], p[3, 1, 1], p[3, 2, 0] = 1.0, 1e-30, 1e-31
    label = pf.equal_mass_boxes(p, 8)
    assert all(p[label == name].sum() > 0 for name in np.unique(label))
