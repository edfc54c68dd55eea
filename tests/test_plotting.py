"""Figures show what they are given: into the axes they are given, and in the right place."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import pytest

import pfkit as pf
from pfkit import plotting

WORLD = pf.worlds.arena()
POSE = np.array((3.0, 2.0, 0.7))
Z = pf.RangeBearing(WORLD, 0.3, 0.1).expected(POSE)
BEL = pf.from_weights(np.random.default_rng(0).normal(size=(3, 50)), np.arange(1.0, 51.0))
SIGMA = np.array([[0.5, 0.2], [0.2, 0.3]])
CALLS = {
    "draw_world": lambda ax: plotting.draw_world(ax, WORLD),
    "draw_particles": lambda ax: plotting.draw_particles(ax, BEL, headings=True),
    "draw_pose": lambda ax: plotting.draw_pose(ax, POSE, "estimate"),
    "draw_path": lambda ax: plotting.draw_path(ax, np.eye(3), "dead reckoning"),
    "draw_measurements": lambda ax: plotting.draw_measurements(ax, POSE, Z),
    "draw_ellipse": lambda ax: plotting.draw_ellipse(ax, POSE, SIGMA),
    "draw_density": lambda ax: plotting.draw_density(ax, np.eye(4), WORLD.bounds),
    "draw_weights": lambda ax: plotting.draw_weights(ax, [0.0, 1.0], [0.3, 0.7]),
}


@pytest.fixture
def axes():
    figure, pair = plt.subplots(1, 2)
    yield pair
    plt.close(figure)


@pytest.mark.parametrize("name", sorted(n for n in vars(plotting) if n.startswith("draw_")))
def test_it_draws_into_the_given_axes_only_and_returns_what_it_drew(name, axes, monkeypatch):
    monkeypatch.setattr(plt, "show", lambda *_, **__: pytest.fail("a drawing function shows"))
    before, (ax, other) = len(plt.get_fignums()), axes
    assert plt.gca() is other  # so that whoever draws into the current axes is seen
    drawn = CALLS[name](ax)
    assert not (other.lines or other.collections or other.images or other.texts)
    artists = drawn if isinstance(drawn, list) else [getattr(drawn, "markerline", drawn)]
    assert artists and all(artist.axes is ax for artist in artists)
    assert len(plt.get_fignums()) == before


def test_landmarks_stand_where_they_are_with_their_names(axes):
    world = pf.LandmarkMap([[1.0, 4.0], [2.0, 3.0]], ids=[7, 12], bounds=(0, 5, 0, 6))
    artist = plotting.draw_world(axes[0], world)
    np.testing.assert_array_equal(artist.get_offsets(), world.positions.T)
    assert [text.get_text() for text in axes[0].texts] == ["7", "12"]
    (x0, x1), (y0, y1) = axes[0].get_xlim(), axes[0].get_ylim()
    assert x0 < 0 and x1 > 5 and y0 < 0 and y1 > 6 and axes[0].get_aspect() == 1
    plotting.draw_world(axes[1], world, ids=False)
    assert not axes[1].texts


def test_the_area_of_a_particle_is_its_weight(axes):
    artist = plotting.draw_particles(axes[0], BEL)
    np.testing.assert_array_equal(artist.get_offsets(), BEL.state[:2].T)
    assert np.ptp(artist.get_sizes() / BEL.w) < 1e-9 * artist.get_sizes().max()
    crowd = pf.from_weights(np.zeros((2, 5001)))
    assert len(plotting.draw_particles(axes[0], crowd, most=1000).get_offsets()) <= 1000


@pytest.mark.parametrize("kind", plotting.KINDS)
def test_a_robot_stands_at_its_pose_and_its_nose_points_ahead(kind, axes):
    artist = plotting.draw_pose(axes[0], POSE, kind)
    np.testing.assert_array_equal(artist.get_offsets(), [POSE[:2]])
    if kind == "truth":
        tip = artist.get_paths()[0].vertices
        nose = tip[np.argmax(np.hypot(*tip.T))]
    else:
        nose = np.array(axes[0].texts[0].xyann)
    assert np.arctan2(nose[1], nose[0]) == pytest.approx(POSE[2])


def test_a_path_is_the_path_in_the_look_of_its_kind(axes):
    path = np.arange(6.0).reshape(3, 2)
    line = plotting.draw_path(axes[0], path, "estimate", lw=3)
    np.testing.assert_array_equal(line.get_data(), path[:2])
    assert (line.get_color(), line.get_ls()) == (plotting.ESTIMATE, "--")
    assert (line.get_lw(), line.get_label()) == (3, "estimate")


def test_rays_of_perfect_measurements_end_on_the_landmarks(axes):
    rays = plotting.draw_measurements(axes[0], POSE, Z)
    ends = np.array([ray.get_xydata() for ray in rays])
    np.testing.assert_allclose(ends[:, 0], np.tile(POSE[:2], (4, 1)))
    np.testing.assert_allclose(ends[:, 1], WORLD.positions.T)


def test_an_ellipse_has_one_mahalanobis_distance(axes):
    error = plotting.draw_ellipse(axes[0], POSE, SIGMA, sds=1.5).get_xydata() - POSE[:2]
    distance = np.einsum("ni,ij,nj->n", error, np.linalg.inv(SIGMA), error)
    np.testing.assert_allclose(distance, 1.5**2)


def test_the_first_axis_of_a_density_runs_to_the_right(axes):
    density = np.zeros((4, 3))
    density[3, 0] = 1.0  # far right, at the bottom
    image = plotting.draw_density(axes[0], density, (0.0, 8.0, 0.0, 3.0))
    shown = np.asarray(image.get_array())
    assert image.origin == "lower" and tuple(image.get_extent()) == (0.0, 8.0, 0.0, 3.0)
    assert shown.shape == (3, 4) and shown[0, 3] == 1.0


def test_stems_are_as_high_as_weights(axes):
    stems = plotting.draw_weights(axes[0], [0.0, 1.0, 5.0], [0.2, 0.5, 0.3])
    np.testing.assert_array_equal(stems.markerline.get_data(), [[0, 1, 5], [0.2, 0.5, 0.3]])


def test_panels_stand_side_by_side_with_their_titles():
    figure, axes = plotting.panels(3, width=9.0, titles=("a", "b", "c"))
    assert [ax.get_title() for ax in axes] == ["a", "b", "c"] and figure.get_figwidth() == 9
    figure.canvas.draw()
    lefts = [ax.get_position().x0 for ax in axes]
    assert lefts == sorted(lefts) and len(set(ax.get_position().y0 for ax in axes)) == 1
    plt.close(figure)


def test_the_style_is_the_book_s():
    with plt.rc_context():
        plotting.use_style()
        assert plt.rcParams["image.cmap"] == "Purples"
        assert plt.rcParams["axes.spines.top"] is False
