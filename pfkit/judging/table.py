r"""Tables: one row per run, one column per thing.

A *tidy* table repeats the setting in every row. That looks wasteful and makes everything else
simple: select rows by a condition, group them, write them to a file that any program reads.
Here a table is a NumPy structured array, ``table["rmse"]`` its column.

A table keeps every run. Whoever stores only means cannot ask later how far the runs scatter, or
whether the one large error was one seed. `summarise` makes a statistic of each group *with its
interval*, because a difference that is smaller than the interval is none; CSV files keep all
digits, so that what was read is what was written.

>>> t = tabulate({"M": [10, 10, 99, 99], "rmse": [3.0, 5.0, 1.0, 1.0]})
>>> t["rmse"][t["M"] == 10]
array([3., 5.])
>>> summarise(t, "rmse", by="M")["value"]
array([4., 1.])
"""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, ParameterError, ShapeError
from pfkit.judging.comparison import bootstrap_interval

Table = NDArray[np.void]


def tabulate(columns: Mapping[str, ArrayLike]) -> Table:
    """Columns of one length as a structured array.

    Parameters
    ----------
    columns : mapping from names to array_like (n,)

    Returns
    -------
    structured array (n,), one field per column

    Raises
    ------
    ParameterError, ShapeError
        If the columns are not a mapping, or they differ in length.
    """
    arrays = {name: np.asarray(column) for name, column in columns.items()}
    shapes = {array.shape for array in arrays.values()}
    if len(shapes) != 1 or len(min(shapes)) != 1:
        raise ShapeError(f"columns must be (n,) with one n, got shapes {sorted(shapes)}")
    table = np.empty(shapes.pop(), dtype=[(name, array.dtype) for name, array in arrays.items()])
    for name, array in arrays.items():
        table[name] = array
    return table


def summarise(
    table: Table,
    value: str,
    by: str | Sequence[str] = (),
    statistic: Callable[..., Any] = np.mean,
    level: float = 0.95,
    seed: int = 0,
) -> Table:
    """A statistic of each group of runs, with its bootstrap interval.

    Parameters
    ----------
    table : structured array of `run` or `from_csv`
    value : str, the column to summarise
    by : str or sequence of str, the columns whose values make a group
    statistic, level
        As in `bootstrap_interval`.
    seed : int, of the bootstrap

    Returns
    -------
    structured array, one row per group in order of appearance
        The columns of `by`, ``runs``, ``value``, ``low`` and ``high``.

    Raises
    ------
    ParameterError
        If the table has no such column, or the level is not in (0, 1).
    """
    by = [by] if isinstance(by, str) or not isinstance(by, Sequence) else list(by)
    if taken := {"runs", "value", "low", "high"} & set(by):
        raise ParameterError(f"the summary has a column {min(taken)!r} of its own; rename yours")
    groups: dict[tuple, list[int]] = {}
    for i, row in enumerate(table):
        groups.setdefault(tuple(row[name] for name in by), []).append(i)
    rng = np.random.default_rng(seed)
    intervals = [
        bootstrap_interval(table[value][members], rng, statistic, level)
        for members in groups.values()
    ]
    columns = {name: np.array([key[k] for key in groups]) for k, name in enumerate(by)}
    columns["runs"] = np.array([len(members) for members in groups.values()], dtype=np.int64)
    for k, name in enumerate(("value", "low", "high")):
        columns[name] = np.array([interval[k] for interval in intervals])
    return tabulate(columns)


def to_csv(table: Table, path: str | os.PathLike[str]) -> None:
    """Write a table as CSV with a header; numbers keep all their digits."""
    with Path(path).open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(table.dtype.names)  # type: ignore[arg-type]
        writer.writerows(table.tolist())


def from_csv(path: str | os.PathLike[str]) -> Table:
    """Read a table that `to_csv` wrote.

    Raises
    ------
    DataError
        If the file cannot be read, is empty, or a row has another number of fields than the
        header.
    """
    with Path(path).open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    if len(rows) < 2:
        raise DataError(f"{path} holds no rows; was it written by study.to_csv?")
    for number, row in enumerate(rows[1:], start=2):
        if len(row) != len(rows[0]):
            raise DataError(f"{path}, line {number}: {len(row)} fields, header has {len(rows[0])}")
    cells = zip(*rows[1:], strict=True)
    return tabulate({name: _parse(column) for name, column in zip(rows[0], cells, strict=True)})


def _parse(column: Sequence[str]) -> NDArray[Any]:
    """Text as whole numbers, else numbers, else truth values, else text."""
    for kind in (np.int64, np.float64):
        try:
            return np.array([kind(cell) for cell in column])
        except ValueError:
            pass
    if set(column) <= {"True", "False"}:
        return np.array([cell == "True" for cell in column])
    return np.array(column)
