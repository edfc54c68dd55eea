"""The worlds are what their docstrings promise."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds

ROOT = Path(__file__).resolve().parents[2]
STILL = pf.VelocityMotion((0.0,) * 4)


def test_the_arena_route_closes_and_stays_inside():
    _, truth = pf.drive(worlds.ARENA_START, worlds.arena_route(), STILL, np.random.default_rng())
    np.testing.assert_allclose(truth[:, -1], worlds.ARENA_START, atol=1e-9)
    assert worlds.arena().contains(*truth[:2]).all()


@pytest.mark.parametrize(
    ("world", "L"),
    [
        (worlds.square(), 4),
        (worlds.broken_square(), 5),
        (worlds.pentagon(10), 10),
        (worlds.pentagon(40), 40),
        (worlds.six_beacons(), 6),
        (worlds.one_landmark(), 1),
    ],
)
def test_landmarks_are_counted_and_apart(world, L):
    assert len(world) == L
    points = world.positions[0] + 1j * world.positions[1]
    gaps = np.abs(points[:, None] - points) + 1e9 * np.eye(L)
    assert gaps.min() > 0.5


def test_other_pentagons_are_refused():
    with pytest.raises(pf.ParameterError, match="10 or 40"):
        worlds.pentagon(12)


def test_the_fifth_landmark_comes_into_view_late():
    driver = pf.PurePursuit(worlds.BROKEN_SQUARE_ROUTE, v=1.0, dt=0.25, closed=False)
    start = worlds.BROKEN_SQUARE_START
    _, truth = pf.drive(start, driver, STILL, np.random.default_rng(), steps=250)
    seen = pf.FieldOfView(worlds.broken_square(), r_max=6.0)(truth)  # (K, T)
    first = np.argmax(seen[4])
    assert seen[4].any() and first > 0.8 * 230
    assert seen[:4].any(axis=0)[:first].mean() > 0.5  # until then the square is often in view


def test_the_circle_closes_and_keeps_its_distance():
    u = worlds.circle_route()
    _, truth = pf.drive(worlds.CIRCLE_START, u, STILL, np.random.default_rng())
    np.testing.assert_allclose(truth[:, -1], worlds.CIRCLE_START, atol=1e-9)
    np.testing.assert_allclose(np.hypot(*(truth[:2] - 10)), 5.0)
    assert u[0, 0] == pytest.approx(0.5, rel=0.01)
    with pytest.raises(ZeroDivisionError):
        worlds.circle_route(v=0)


def test_the_first_step_of_the_walk_through():
    u = np.array([[np.sqrt(2)], [0.0], [1.0]])
    _, truth = pf.drive(worlds.SIX_BEACONS_START, u, STILL, np.random.default_rng())
    np.testing.assert_allclose(truth[:, 0], [8.0, 8.0, np.pi / 4])


def test_the_office_route_stays_free_of_walls():
    grid = worlds.office()
    driver = pf.PurePursuit(worlds.OFFICE_ROUTE, v=0.5, dt=0.2, lookahead=0.5)
    _, truth = pf.drive(worlds.OFFICE_START, driver, STILL, np.random.default_rng(), steps=240)
    assert grid.contains(*truth[:2]).all()
    assert truth[0].max() > 10 and truth[1].min() < 1.8  # it went round
    back = np.hypot(*(truth[:2, 200:] - worlds.OFFICE_START[:2, None]))
    assert back.min() < 0.2


def test_every_room_of_the_office_can_be_reached():
    free = worlds.office().free
    reached = np.zeros_like(free)
    reached[40, 20] = True
    for _ in range(400):  # flood from the corridor
        grown = reached.copy()
        grown[1:] |= reached[:-1]
        grown[:-1] |= reached[1:]
        grown[:, 1:] |= reached[:, :-1]
        grown[:, :-1] |= reached[:, 1:]
        reached = grown & free
    assert (reached == free).all()


# the drives in data/worlds


def load_maker():
    path = ROOT / "tools" / "make_worlds.py"
    spec = importlib.util.spec_from_file_location("make_worlds", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


MAKER = load_maker()


@pytest.mark.parametrize("name", MAKER.WORLDS)
def test_the_stored_drive_is_what_the_script_makes(name):
    stored, made = pf.read_log(MAKER.HERE / name), MAKER.WORLDS[name]()
    close = {"rtol": 1e-4, "atol": 1e-9, "err_msg": "run python tools/make_worlds.py"}
    np.testing.assert_allclose(stored.truth, made.truth, **close)
    np.testing.assert_allclose(stored.u, made.u, **close)
    for one, other in zip(stored.z, made.z, strict=True):
        np.testing.assert_allclose(one, other, **close)
    if made.outlier is not None:
        assert all((a == b).all() for a, b in zip(stored.outlier, made.outlier, strict=True))
    if stored.world is not None:
        assert stored.world.contains(*stored.truth[:2]).mean() > 0.95


def test_the_stored_drives_are_small():
    files = [path for path in MAKER.HERE.rglob("*") if path.is_file()]
    assert sum(path.stat().st_size for path in files) < 1_000_000


def test_a_filter_follows_the_stored_square():
    log = pf.read_log(MAKER.HERE / "square")
    sensor = pf.RangeBearing(log.world, 0.2, 0.05)
    rng = np.random.default_rng(1)
    bel = pf.gaussian_prior(500, log.start, np.full(3, 0.1), rng)
    history = pf.run(log, bel, MAKER.MOTION, sensor, rng)
    assert pf.rmse(history.estimate, history.truth) < 0.15
