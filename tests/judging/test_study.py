"""Studies: the same table whoever computed it, and tables that survive a file."""

import importlib.util
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds
from pfkit.judging import study

WORLD = worlds.arena()
MOTION = pf.VelocityMotion((0.02, 0.01, 0.01, 0.02))
SENSOR = pf.RangeBearing(WORLD, sigma_r=0.2, sigma_phi=0.1)


def localise(rng, B, M, sigma_r=0.2):
    """B robots drive side by side, each with a filter of its own."""
    log = pf.simulate_log(
        worlds.ARENA_START, worlds.arena_route()[:, :12], MOTION, SENSOR, rng, batch=B
    )
    bel = pf.gaussian_prior((B, M), worlds.ARENA_START, np.full(3, 0.2), rng)
    sensor = pf.RangeBearing(WORLD, sigma_r, sigma_phi=0.1)
    history = pf.run(log, bel, MOTION, sensor, rng)
    return {
        "rmse": pf.rmse(history.estimate, history.truth),
        "resampled": history.resampled.sum(axis=0),
        "end_x": log.truth[0, -1, :, 0],
    }


def one_draw(rng, scale):
    return {"value": scale * rng.standard_normal()}


def failing(rng, B, bad):
    if bad:
        raise FloatingPointError("no luck")
    return {"value": np.zeros(B)}


SETTINGS = study.grid(M=[50, 200], sigma_r=[0.2, 0.6])


@pytest.fixture(scope="module")
def table():
    return study.run(localise, SETTINGS, runs=10, seed=3, block=4)


def test_a_table_has_one_row_per_run(table):
    assert table.dtype.names == ("M", "sigma_r", "run", "rmse", "resampled", "end_x")
    assert table.shape == (40,)
    np.testing.assert_array_equal(table["M"], np.repeat([50, 50, 200, 200], 10))
    np.testing.assert_array_equal(table["run"], np.tile(np.arange(10), 4))
    assert np.isfinite(table["rmse"]).all()


def test_a_study_repeats_itself_and_follows_its_seed(table):
    again = study.run(localise, SETTINGS, runs=10, seed=3, block=4)
    np.testing.assert_array_equal(table, again)
    other = study.run(localise, SETTINGS, runs=10, seed=4, block=4)
    assert (table["rmse"] != other["rmse"]).all()


def test_all_settings_face_the_same_drives(table):
    ends = table["end_x"].reshape(4, 10)
    np.testing.assert_array_equal(ends, np.broadcast_to(ends[0], (4, 10)))
    assert len(np.unique(ends[0])) == 10


def test_more_runs_leave_the_first_blocks_as_they_were(table):
    longer = study.run(localise, SETTINGS[:1], runs=12, seed=3, block=4)
    np.testing.assert_array_equal(longer["rmse"][:8], table["rmse"][:8])


@pytest.mark.parametrize("pool", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_the_table_does_not_depend_on_the_executor(pool, table):
    with pool(2) as executor:
        pooled = study.run(localise, SETTINGS, runs=10, seed=3, block=4, executor=executor)
    np.testing.assert_array_equal(pooled, table)


@pytest.mark.slow
@pytest.mark.skipif(
    importlib.util.find_spec("distributed") is None,
    reason="dask.distributed is not installed: pip install dask distributed",
)
def test_a_dask_cluster_gives_the_same_table(table):
    from dask.distributed import Client, LocalCluster

    with (
        LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=None
        ) as cluster,
        Client(cluster) as client,
    ):
        executor = client.get_executor()
        farmed = study.run(localise, SETTINGS, runs=10, seed=3, block=4, executor=executor)
    np.testing.assert_array_equal(farmed, table)


def test_single_runs_go_one_by_one():
    experiment = study.one_by_one(one_draw)
    table = study.run(experiment, study.grid(scale=[1.0, 3.0]), runs=7, block=3)
    a, b = table["value"].reshape(2, 7)
    np.testing.assert_allclose(3 * a, b)  # common random numbers
    assert len(np.unique(a)) == 7
    with ProcessPoolExecutor(1) as executor:
        pooled = study.run(
            experiment, study.grid(scale=[1.0, 3.0]), runs=7, block=3, executor=executor
        )
    np.testing.assert_array_equal(pooled, table)


def test_a_failure_names_its_setting():
    with pytest.raises(FloatingPointError) as caught:
        study.run(failing, study.grid(bad=[False, True]), runs=2)
    assert "block 0 of setting {'bad': True}" in caught.value.__notes__[0]
    with ThreadPoolExecutor(1) as executor, pytest.raises(FloatingPointError):
        study.run(failing, study.grid(bad=[False, True]), runs=2, executor=executor)


def test_functions_and_models_appear_by_name():
    def experiment(rng, B, scheme, nu):
        return {"copies": [scheme(np.ones(4), rng).size] * B}

    table = study.run(
        experiment, study.grid(scheme=[pf.systematic, pf.residual], nu=[4, "inf"]), runs=2
    )
    assert set(table["scheme"]) == {"systematic", "residual"}
    assert set(table["nu"]) == {"4", "inf"}


def test_blocks_pass_through_the_progress_that_is_asked_for(capsys):
    seen = []

    def bar(steps, total):
        seen.append(total)
        for step in steps:
            seen.append("block")
            yield step

    quiet = study.run(localise, [{"M": 20}], runs=6, block=2)
    assert capsys.readouterr() == ("", "")
    with ThreadPoolExecutor(2) as pool:
        for executor in (None, pool):
            shown = study.run(
                localise, [{"M": 20}], runs=6, block=2, executor=executor, progress=bar
            )
            np.testing.assert_array_equal(shown, quiet)
    assert seen == [3, "block", "block", "block"] * 2


def test_tqdm_is_such_a_progress(capsys):
    tqdm = pytest.importorskip("tqdm").tqdm
    study.run(localise, [{"M": 20}], runs=6, block=2, progress=tqdm)
    out, err = capsys.readouterr()
    assert out == "" and "3/3" in err


@pytest.mark.parametrize(
    ("change", "error"),
    [
        ({"settings": []}, IndexError),
        ({"settings": [{"a": 1}, {"b": 1}]}, pf.ParameterError),
        ({"settings": [{"run": 1}]}, pf.ParameterError),
        ({"settings": [{"value": 1}]}, pf.ParameterError),
        ({"runs": 0}, IndexError),
        ({"block": 0}, ValueError),
        ({"experiment": lambda rng, B, **s: {"value": np.zeros(B + 1)}}, pf.ShapeError),
        ({"experiment": lambda rng, B, **s: {"value": 1.0}}, pf.ShapeError),
        ({"experiment": lambda rng, B, **s: np.zeros(B)}, AttributeError),
        ({"experiment": study.one_by_one(lambda rng, **s: 1.0)}, TypeError),
    ],
)
def test_bad_input_is_named(change, error):
    good = {
        "experiment": lambda rng, B, **s: {"value": np.zeros(B)},
        "settings": [{"a": 1}],
        "runs": 2,
    }
    with pytest.raises(error):
        study.run(**(good | change))


def test_a_setting_that_is_no_list_is_named():
    with pytest.raises(pf.ParameterError, match="M must be a list"):
        study.grid(M=100)
