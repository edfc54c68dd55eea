r"""Studies: the same experiment for many seeds and settings.

An *experiment* is a function ``(rng, B, **setting)`` that performs B independent runs side by
side and returns a mapping from names to arrays ``(B,)``, one number per run:

>>> import numpy as np
>>> import pfkit as pf
>>> def experiment(rng, B, M):  # how well does the mean of M draws find 0?
...     return {"error": np.abs(rng.standard_normal((B, M)).mean(axis=1))}
>>> table = pf.study.run(experiment, pf.study.grid(M=[1, 100]), runs=200, seed=1)
>>> table.dtype.names
('M', 'run', 'error')
>>> pf.study.summarise(table, "error", by="M")["value"].round(2)
array([0.84, 0.08])

B runs on an array axis beat B processes for small particle sets: nothing is copied between
processes and NumPy sees one long array. What does not batch goes through `one_by_one`.

The runs of a setting are cut into blocks, and each block has a random stream of its own,
spawned from the seed by the block's number. So the table is the same whoever computed it: this
process, a pool, or a cluster. Equal blocks of different settings share their stream. An
experiment that first draws the drive and then filters it therefore shows all settings the same
drives, and `comparison.paired` may compare them run by run.

On a cluster, with Dask::

    from dask.distributed import Client
    from my_module import experiment          # the workers must be able to import it

    with Client("tcp://scheduler:8786") as client:
        table = pf.study.run(
            experiment, pf.study.grid(M=[100, 1000, 10_000]), runs=1000, seed=1,
            executor=client.get_executor(),
        )
    pf.study.to_csv(table, "study.csv")
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Executor, Future, as_completed
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import ParameterError, ShapeError
from pfkit.judging.table import Table, from_csv, summarise, tabulate, to_csv

__all__ = ["from_csv", "grid", "one_by_one", "run", "summarise", "to_csv"]

Setting = Mapping[str, Any]
Experiment = Callable[..., Mapping[str, Any]]
Progress = Callable[..., Iterable[Any]]


def grid(**values: Sequence[Any]) -> list[dict[str, Any]]:
    """All combinations of the given values, the last one changing fastest.

    ``grid(M=[100, 1000], sigma_r=[0.1, 0.3])`` is a list of four settings.
    """
    for name, some in values.items():
        if not isinstance(some, Iterable) or isinstance(some, str):
            raise ParameterError(f"{name} must be a list of values, got {some!r:.60}; write [...]")
    return [
        dict(zip(values, combination, strict=True))
        for combination in itertools.product(*values.values())
    ]


class one_by_one:
    """Make an experiment of a function that performs a single run.

    Parameters
    ----------
    function : function (rng, ``**setting``) -> mapping from names to numbers
        Each run gets a stream of its own.
    """

    def __init__(self, function: Callable[..., Mapping[str, float]]) -> None:
        self.function = function

    def __call__(self, rng: np.random.Generator, B: int, **setting: Any) -> dict[str, list[float]]:
        """Perform B runs one after the other."""
        rows = [self.function(stream, **setting) for stream in rng.spawn(B)]
        return {name: [row[name] for row in rows] for name in rows[0]}


def run(
    experiment: Experiment,
    settings: Iterable[Setting],
    runs: int,
    seed: int = 0,
    *,
    block: int = 50,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> Table:
    """Perform an experiment for all settings, in blocks of runs.

    Parameters
    ----------
    experiment : function (rng, B, ``**setting``) -> mapping from names to arrays (B,)
        For an executor with processes it must be importable: a function of a module.
    settings : iterable of mappings with the same keys, e.g. of `grid`
    runs : int, per setting
    seed : int
    block : int
        Runs that are performed side by side. Part of the recipe, like the seed: another block
        size gives other random numbers.
    executor : concurrent.futures.Executor, optional
        A process pool, ``client.get_executor()`` of Dask, or nothing for this process.
    progress : function (iterable, total=n) -> iterable, optional
        What the blocks pass through when they are done, such as `tqdm`, which draws a bar.

    Returns
    -------
    structured array, one row per run
        The setting's values, ``run``, and what the experiment returned. Functions and objects
        among the values appear by name.

    Raises
    ------
    ParameterError, ShapeError
        If there is no setting, keys differ, or a result has not one number per run.
    """
    settings = _check_settings(settings)
    first = range(0, runs, block)
    tasks = [
        (experiment, dict(setting), seed, i, min(block, runs - start))
        for setting in settings
        for i, start in enumerate(first)
    ]
    shown = progress or silent
    results = _serially(tasks, shown) if executor is None else _submitted(tasks, executor, shown)
    columns = {name: _column([s[name] for s in settings], runs) for name in settings[0]}
    columns["run"] = np.tile(np.arange(runs, dtype=np.int64), len(settings))
    for name in results[0]:
        if name in columns:
            raise ParameterError(f"result {name!r} has the name of a setting; rename one")
        columns[name] = np.concatenate([result[name] for result in results])
    return tabulate(columns)


def _one_block(
    experiment: Experiment, setting: Setting, seed: int, i: int, B: int
) -> dict[str, NDArray[Any]]:
    """Block i of a setting; everything it needs travels with it."""
    rng = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(i,)))
    try:
        returned = experiment(rng, B, **setting)
        result = {name: np.asarray(column) for name, column in returned.items()}
    except Exception as error:
        error.add_note(f"in block {i} of setting {dict(setting)}")
        raise
    for name, column in result.items():
        if column.shape != (B,):
            raise ShapeError(
                f"result {name!r} must have one number per run, shape ({B},), got {column.shape}"
            )
    return result


def _serially(tasks: list[tuple], shown: Progress) -> list[dict[str, NDArray[Any]]]:
    return [_one_block(*task) for task in shown(tasks, total=len(tasks))]


def _submitted(
    tasks: list[tuple], executor: Executor, shown: Progress
) -> list[dict[str, NDArray[Any]]]:
    futures: list[Future] = [executor.submit(_one_block, *task) for task in tasks]
    try:
        for done in shown(as_completed(futures), total=len(futures)):
            done.result()  # the first failure ends the study
    finally:
        for future in futures:
            future.cancel()
    return [future.result() for future in futures]


def silent(steps: Iterable[Any], total: int) -> Iterable[Any]:
    """The progress that nobody asked to see."""
    return steps


def _check_settings(settings: Iterable[Setting]) -> list[Setting]:
    settings = list(settings)
    for setting in settings:
        if list(setting) != list(settings[0]):
            raise ParameterError(
                f"settings must have the same keys: {list(settings[0])} and {list(setting)}"
            )
        if "run" in setting:
            raise ParameterError("a setting cannot be called 'run': the table numbers runs so")
    return settings


def _column(values: list[Any], runs: int) -> NDArray[Any]:
    """The values of one setting key, repeated for each run; names for what is no number."""
    plain = (bool, int, float, str, np.generic)
    named = [v if isinstance(v, plain) else getattr(v, "__name__", str(v)) for v in values]
    if len({isinstance(v, str) for v in named}) > 1:
        named = [str(v) for v in named]
    column = np.array(named)
    return np.repeat(column.astype(np.int64) if column.dtype.kind == "i" else column, runs)
