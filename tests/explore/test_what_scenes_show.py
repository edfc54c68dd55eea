"""What each scene claims is true: readouts against theory, missions that can be done."""

from __future__ import annotations

import numpy as np
import pytest

import pfkit as pf
from pfkit.explore import SCENES, scene
from pfkit.explore.banana import energy_distance
from pfkit.explore.camera import ease, say_outside, wanted
from pfkit.explore.comb import FIVE, WEIGHTS, teeth, wheel
from pfkit.explore.pen import Pen, handles, records, words

PANELS = [(name, panel) for name in SCENES for panel in type(scene(name)).panels]


@pytest.mark.parametrize("name", list(FIVE))
def test_teeth_lie_in_the_particle_that_was_picked(name):
    w = np.array(WEIGHTS["chapter"])
    edges = np.concatenate(([0.0], np.cumsum(w)))
    for seed in range(50):
        picks = FIVE[name](w, np.random.default_rng(seed), 9)
        at = teeth(name, w, picks, np.random.default_rng(seed))
        assert np.all((edges[picks] <= at + 1e-12) & (at <= edges[picks + 1] + 1e-12))


def test_comb_measures_the_multinomial_variance():
    s = scene("comb", seed=1)
    s.set("pace", 200)
    for _ in range(40):
        s.step()
    w = np.array(WEIGHTS["chapter"])
    assert s.variance("multinomial") == pytest.approx(5 * (w * (1 - w)).sum(), rel=0.05)
    assert s.variance("systematic") < s.variance("residual") < s.variance("multinomial")


def test_comb_with_equal_weights_has_two_schemes_without_luck():
    s = scene("comb")
    s.set("weights", "equal")
    for _ in range(30):
        s.step()
    quiet = {name for name in FIVE if s.variance(name) < 1e-12}
    assert quiet == {"stratified", "systematic", "residual"}


def test_wheel_is_biased_and_the_others_are_not():
    w, rng = np.array(WEIGHTS["chapter"]), np.random.default_rng(0)
    runs = 20_000
    copies = sum(np.bincount(wheel(w, rng, 5), minlength=5) for _ in range(runs)) / runs
    assert copies[0] - 5 * w[0] > 4 * np.sqrt(5 / runs) / 2


def test_one_founder_is_left_in_the_end():
    s = scene("comb", seed=2)
    for _ in range(300):
        s.step()
    assert s.founders == 1


def test_corridor_is_the_bayes_filter():
    s = scene("corridor", seed=4)
    s.set("auto", False)
    s.set("look", True)
    expected = np.where(s.is_door, 0.9, 0.08) if s.saw else np.where(s.is_door, 0.1, 0.92)
    assert s.bel == pytest.approx(expected / expected.sum())
    assert s.readouts()["evidence"] == pytest.approx(expected.mean())


def test_corridor_learns_nothing_from_a_blind_detector():
    s = scene("corridor", seed=4)
    s.set("hit", 0.3)
    s.set("false", 0.3)
    before = s.bel.copy()
    for _ in range(12):
        s.set("look", True)
    assert s.bel == pytest.approx(before) and s.achieved[1]


def test_corridor_is_as_sure_as_it_is_right():
    """Share of runs whose most likely cell is the robot's equals the belief there (4 SE)."""
    surprise, right = [], []
    for seed in range(150):
        s = scene("corridor", seed=seed)
        for _ in range(60):
            s.step()
        right.append(int(s.bel.argmax()) == s.robot)
        surprise.append(right[-1] - s.bel.max())
    assert abs(np.mean(surprise)) < 4 * np.std(surprise) / np.sqrt(150)
    assert np.mean(right) > 0.3  # by chance: 0.04


def test_proposal_predicts_the_ess_it_measures():
    s = scene("proposal", seed=3)
    s.set("target", "one")
    s.set("M", 2000)
    for sigma in (1.5, 2.5):
        s.set("sigma", sigma)
        measured = []
        for _ in range(20):
            s.step()
            measured.append(s.ess)
        assert np.mean(measured) == pytest.approx(s.predicted(), rel=0.03)


def test_proposal_has_no_predicted_ess_when_the_weights_have_no_variance():
    s = scene("proposal")
    s.set("target", "one")
    s.set("sigma", 0.7)
    assert s.predicted() == 0.0
    s.set("tails", "student")
    assert s.predicted() > 0


def test_energy_distance_is_zero_on_average_for_one_law_and_grows_with_a_shift():
    clouds = np.random.default_rng(1).standard_normal((40, 2, 2, 50))
    same = np.array([energy_distance(a, b) for a, b in clouds])
    assert abs(same.mean()) < 4 * same.std() / np.sqrt(same.size)  # fixed seed
    assert same.min() < 0 < same.max()
    a, b = clouds[0]
    assert energy_distance(a, b + 2) > 10 * np.abs(same).max()


def test_banana_can_be_matched():
    s = scene("banana", seed=3)
    for name, value in zip(("a1", "a3", "a4", "a5"), s.hidden_sd, strict=True):
        s.set(name, float(np.round(value, 2)))
    s.set("guess", s.hidden)
    assert s.mismatch < 0.05 and s.achieved[2]


@pytest.mark.parametrize("sense", ["both", "range", "bearing"])
def test_drive_finds_the_robot(sense):
    found = 0
    for seed in range(6):
        s = scene("drive", "localise", seed)
        s.set("sense", sense)
        s.set("M", 2000)
        for _ in range(420):
            s.step()
        found += s.error < 0.5
    assert found >= 4


def test_drive_recovers_from_a_kidnap_only_with_fresh_particles():
    def after_kidnap(fresh):
        s = scene("drive", "kidnap", 2)
        s.set("fresh", fresh)
        for _ in range(60):
            s.step()
        s.set("kidnap", True)
        for _ in range(600):
            s.step()
            if s.error < 0.3:
                return True
        return False

    assert after_kidnap(5.0)
    assert not after_kidnap(0.0)


def test_likelihood_map_is_the_sensors_likelihood():
    s = scene("drive", "sensing", 1)
    log_p, p = s.likelihood_map()
    assert p.sum() == pytest.approx(1)
    x0, x1, y0, y1 = s.bounds
    ny, nx = p.shape
    j, i = np.unravel_index(int(log_p.argmax()), p.shape)
    best = np.array([x0 + (i + 0.5) * (x1 - x0) / nx, y0 + (j + 0.5) * (y1 - y0) / ny])
    ranges = np.hypot(*(s.landmarks - best[:, None]))
    assert ranges == pytest.approx(np.hypot(*(s.landmarks - s.truth[:2, None])), abs=0.25)


def test_square_has_four_copies_that_measure_the_same():
    s = scene("drive", "symmetry", 1)
    for pose in s.copies().T:
        z, here = (s.real.expected(p) for p in (pose, s.truth))
        assert np.sort(z[0]) == pytest.approx(np.sort(here[0]))
        assert np.sort(np.cos(z[1])) == pytest.approx(np.sort(np.cos(here[1])))


def test_symmetry_counts_hypotheses_that_die():
    s = scene("drive", "symmetry", 1)
    for _ in range(300):
        s.step()
    assert 1 <= s.readouts()["hypotheses"] < 4
    assert s.masses().sum() == pytest.approx(1, abs=0.1)


def test_switches_take_the_filter_apart():
    s = scene("drive", "assembly", 1)
    s.set("do_resample", False)
    for _ in range(200):
        s.step()
    assert s.ess < 3 and s.counts["resampled"] == 0
    s = scene("drive", "assembly", 1)
    s.set("do_predict", False)
    for _ in range(200):
        s.step()
    assert np.unique(s.bel.state[0]).size < 20 and s.ess > 10


def test_landmarks_can_be_moved_added_and_removed():
    s = scene("drive", "sensing", 1)
    s.set("add", True)
    assert s.landmarks.shape[1] == 3
    for _ in range(5):
        s.set("remove", True)
    assert s.landmarks.shape[1] == 1  # the last one stays
    s.hold("landmark 1", *s.landmarks[:, 0], "press")
    s.hold("landmark 1", 4.0, 4.0, "drag")
    assert s.landmarks[:, 0] == pytest.approx([4, 4]) and isinstance(s.world, pf.LandmarkMap)


def test_more_particles_come_closer_to_the_exact_posterior():
    def nats(M):
        out = []
        for seed in range(4):
            s = scene("exact", seed=seed)
            s.set("M", M)
            for _ in range(8):
                s.step()
            out.append(s.nats)
        return np.mean(out)

    assert nats(4000) < nats(60)


def test_the_grid_does_not_touch_the_cloud():
    with_grid, without = scene("exact", seed=3), scene("exact", seed=3)
    without.grid = None
    for _ in range(5):
        with_grid.step()
        for _ in super(type(without), without).advance():
            pass
        without.ticks += 1
    assert with_grid.bel.state == pytest.approx(without.bel.state)


@pytest.mark.parametrize("model", ["beam", "field"])
def test_office_is_tracked_by_either_sensor_model(model):
    s = scene("office", seed=2)
    for name, value in (("prior", "known"), ("M", 300), ("model", model)):
        s.set(name, value)
    for _ in range(200):
        s.step()
    assert s.error < 0.5


def test_the_robot_stays_out_of_walls():
    s = scene("office", seed=5)
    s.set("autopilot", False)
    for steer in (0.0, 1.0, -1.0):
        s.set("throttle", 1.0)
        s.set("steer", steer)
        for _ in range(150):
            s.step()
            assert s.world.contains(*s.truth[:2])


# ---- handles -----------------------------------------------------------------------------------


def drag(s, name, to):
    s.hold(name, *handles(s.frame()[0])[name], "press")
    s.hold(name, *to, "drag")
    s.hold(name, *to, "release")


def test_a_robot_that_is_carried_and_put_down_is_kidnapped():
    s = scene("drive", "kidnap", 1)
    s.set("autopilot", False)
    before = s.truth
    s.hold("robot", *before[:2], "press")
    s.hold("robot", 8.0, 6.0, "drag")
    assert not s.kidnapped and s.truth[:2] == pytest.approx([8, 6])
    s.hold("robot", 8.0, 6.0, "cancel")
    assert not s.kidnapped and s.truth == pytest.approx(before)
    drag(s, "robot", (8.0, 6.0))
    assert s.kidnapped and s.truth[:2] == pytest.approx([8, 6])
    assert any("carried off" in w for w in s.news())


@pytest.mark.parametrize("seed", (1, 2, 3))
def test_the_rim_of_the_noise_and_the_threshold_are_controls(seed):
    s = scene("drive", "localise", seed)
    r, phi = np.hypot(*(s.landmarks[:, 0] - s.truth[:2])), s._from_first(*s.landmarks[:, 0])
    assert phi == pytest.approx((0, 0))
    rim = handles(s.frame()[0])["range noise"]
    assert s._from_first(*rim)[0] == pytest.approx(-2 * s.values["sigma_r"], abs=1e-5)
    toward = (s.truth[:2] - s.landmarks[:, 0]) / r
    drag(s, "range noise", s.landmarks[:, 0] + 1.2 * toward)
    assert s.values["sigma_r"] == pytest.approx(0.6)
    drag(s, "threshold", (3.0, 0.83))
    assert s.values["threshold"] == 0.85


def test_a_press_on_the_floor_is_where_the_robot_drives_to():
    s = scene("drive", "localise", 1)
    s.hold("", 5.0, 4.0, "tap")
    for _ in range(600):
        s.step()
        if s.goal is None:
            break
    assert np.hypot(*(s.truth[:2] - (5, 4))) < 0.5


def test_a_proposal_is_held_at_its_centre_and_its_width():
    s = scene("proposal", seed=1)
    drag(s, "centre", (1.04, 0.1))
    drag(s, "width", (2.5, 0.1))
    assert s.values["mu"] == 1.0 and s.values["sigma"] == 1.5


def test_a_phase_of_the_drive_is_counted_from_its_particles():
    s = scene("drive", "localise", 2)
    s.to_phase(99)
    assert s.phase == "predict"
    before = s.bel.state.copy()
    s.to_phase(1)
    light = int((np.exp(s.bel.log_w) < 0.1 / s.bel.M).sum())
    assert s.phase == "weigh" and f"{light} of {s.bel.M} particles" in s.sentence
    s.to_phase(1)
    distinct = np.unique(s.bel.state, axis=1).shape[1]
    assert s.phase == "resample" and f"descend from {distinct}." in s.sentence
    assert s.bel.state == pytest.approx(before[:, s.lineage])


# ---- the belief stays in sight, and is told ----------------------------------------------------


def first_view(drawing):
    return next(numbers for op, _, numbers in records(drawing) if op == "view")


def texts(drawing):
    return [words(numbers[4:]) for op, _, numbers in records(drawing) if op == "text"]


def test_after_a_kidnap_the_belief_is_in_sight_or_pointed_at():
    left = pointed = 0
    for seed in (1, 2, 3, 4):
        s = scene("drive", "kidnap", seed)
        for tick in range(1500):
            if tick == 60:
                s.set("kidnap", True)
            s.step()
            if tick % 10:
                continue
            drawing, _ = s.frame()
            (x0, x1, y0, y1), (x, y, _) = first_view(drawing)[4:8], s.estimate
            outside = not (x0 <= x <= x1 and y0 <= y <= y1)
            assert outside == any("outside" in w for w in texts(drawing))
            pointed += outside
            left += not (s.bounds[0] <= x <= s.bounds[1] and s.bounds[2] <= y <= s.bounds[3])
    assert left > 10, "no cloud left the arena: the test shows nothing"
    assert pointed < left, "the camera never widened"


def test_the_camera_widens_and_comes_back():
    world, rng = (0.0, 10.0, 0.0, 8.0), np.random.default_rng(1)
    near, far = rng.normal(5, 0.3, (2, 500)), rng.normal(13, 0.3, (2, 500))
    assert wanted(world, *near) == world
    assert wanted(world, 10.1 + 0 * near[0], near[1]) == world  # a little over the edge
    x0, x1, y0, y1 = wanted(world, *far)
    assert (x0, y0) == (0, 0) and x1 == pytest.approx(13.5, abs=0.3) and y1 == 12  # at most half
    view = world
    for goal, end in (((x0, x1, y0, y1), (x0, x1, y0, y1)), (world, world)):
        for _ in range(600):
            view = ease(view, goal, rate=60)
        assert view == end


@pytest.mark.parametrize("at", [(20, 4), (-9, 4), (5, 30), (5, -30), (30, 30), (10.5, 4)])
def test_what_is_outside_is_named_with_its_distance(at):
    pen, view = Pen(), (0.0, 10.0, 0.0, 8.0)
    say_outside(pen, view, np.array([*at, 0.0]))
    away = np.hypot(at[0] - np.clip(at[0], 0, 10), at[1] - np.clip(at[1], 0, 8))
    (said,) = texts(pen.array())
    assert said == ("belief just outside" if away < 1 else f"belief {away:.0f} m outside")
    for op, _, d in records(pen.array()):
        x, y = d[1:].reshape(4, 2)[[0, 1]] if op == "segments" else (d[0], d[1])
        assert np.all((x > 0) & (x < 10) & (y > 0) & (y < 8))
    empty = Pen()
    say_outside(empty, view, np.array([5.0, 5.0, 0.0]))
    assert empty.array().size == 0


@pytest.mark.parametrize(
    ("name", "panel"), [("drive", "kidnap"), ("exact", None), ("office", None), ("mower", None)]
)
def test_the_mean_is_drawn_under_the_robot(name, panel):
    s = scene(name, panel, 1)
    s.step()
    order = [style for op, style, _ in records(s.frame()[0]) if op == "robots"][:2]
    assert order == ["estimate", "truth"]


def test_a_kidnap_and_a_recovery_are_told_once_each():
    s = scene("drive", "kidnap", 2)
    s.set("fresh", 5)
    for _ in range(60):
        s.step()
    s.news()
    s.set("kidnap", True)
    for _ in range(600):
        s.step()
    said = s.news()
    assert sum("carried off" in w for w in said) == 1
    assert 1 <= sum(w.startswith("Found") for w in said) <= 2 and len(said) < 12
    assert s.news() == []


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_a_run_of_twenty_seconds_is_told_in_few_sentences(name, panel):
    s = scene(name, panel, 2)
    for _ in range(int(20 * s.rate)):
        s.step()
    assert len(s.news()) <= 10


def test_the_story_goes_anywhere_ring_two_places_here():
    """Of 24 seeds; in the ring and before, most guesses are elsewhere, and so is the mean."""
    ends = 0
    for seed in range(1, 25):
        s = scene("story", seed=seed)
        shares = {}
        for _ in range(s.record_steps):
            s.step()
            shares.setdefault(s.stage, s.near())
        ends += s.stage == "here" and s.near() > 0.9
        assert list(shares)[:3] == ["anywhere", "a ring", "two places"]
        assert shares["anywhere"] < 0.1 and shares["a ring"] < 0.3
    assert ends >= 20


def test_reports_pay_what_the_belief_promises():
    """The mean's squared error is the trace of the covariance, within and between heaps."""
    s = scene("estimates", seed=4)
    s.hold("heap A", 4.0, 1.0, "drag")
    s.hold("heap B", 4.0, 5.0, "drag")
    for _ in range(400):
        s.step()
    promised = 2 * 0.4**2 + 0.65 * 0.35 * 4.0**2
    assert s.price("mean")[0] == pytest.approx(promised, rel=0.1)
    assert s.price("mean")[0] < s.price("mode")[0] and s.price("mean")[2] > s.price("mode")[2]


def test_tuning_is_cheapest_at_the_truth_only_with_the_right_model():
    wrong, right = scene("tuning", seed=1), scene("tuning", seed=1)
    right.set("model", "moves")
    i_wrong, i_right = (s.surface.min(axis=0).argmin() for s in (wrong, right))
    assert i_right < i_wrong  # less process noise
    assert right.surface.min() < 0.6 * wrong.surface.min() < 0.3
