"""Tables of numbers in text files, read fast and judged strictly.

A log that somebody else recorded is an untrusted guest. A row that was cut short, a word
where a number belongs or a NaN must stop us at the door, with the file and the line, not
forty frames deep in a filter. Reading is fast because good files go through NumPy's own parser
in one piece; only a file that fails is looked at again, line by line, to say where and why.
"""

from __future__ import annotations

import gzip
import io
import re
import warnings
import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError

Array = NDArray[np.float64]
TIME = "time"
JUMP = 10  # rows in a row that all lie before what came first: the clock was set back
LARGEST = 1e12  # no second, metre or radian of a log is larger; nanoseconds since 1970 are


def read_table(path: Path, columns: Sequence[str], ordered: bool = True) -> Array:
    """Read whitespace-separated numbers, components first.

    Lines that are blank or start with ``#`` are skipped; line ends may be those of any
    system; the file may be gzipped. A column called ``time`` must never decrease.

    Parameters
    ----------
    path : Path
        The file; if it is missing, the same name with ``.gz`` is tried.
    columns : names of the columns, in order
    ordered : bool
        Whether time must not decrease; if it may, see `in_order`.

    Returns
    -------
    array (len(columns), N), N >= 1

    Raises
    ------
    DataError
        With file, line and reason, if the file is missing, empty, cut short, not numeric, not
        finite, absurdly large or runs backwards in time.
    """
    path = existing(path)
    text = read_text(path)
    try:
        with warnings.catch_warnings(action="ignore", category=UserWarning):  # "no data": ours
            table = np.loadtxt(io.StringIO(text, newline=None), ndmin=2, unpack=True)
    except ValueError:
        raise DataError(_diagnosis(path, text, columns)) from None
    if table.size == 0:
        raise DataError(f"{path}: no rows of numbers in the file; it should hold {_list(columns)}")
    sound = (np.abs(table) <= LARGEST).all()  # false for NaN, too
    backwards = ordered and _runs_backwards(table, columns)
    if len(table) != len(columns) or not sound or backwards:
        raise DataError(_diagnosis(path, text, columns))
    return np.ascontiguousarray(table)


def in_order(path: Path, table: Array, names: Array | None = None) -> tuple[Array, list[str]]:
    """Sort measurements by their time, row 0, stably; say how many were out of order.

    Rows are out of order where several sensors share a file, or where a file holds one landmark
    after the other. Where a whole stretch of them starts again earlier, the clock was set back,
    and nobody can sort that.

    Parameters
    ----------
    path : Path of the file
    table : array (n, N)
    names : array (N,), optional
        What each row measured.

    Returns
    -------
    table : array (n, N)
    notes : list of str

    Raises
    ------
    DataError
        If the clock jumped back.
    """
    back = jump_back(table[0], names)
    if back is not None:
        raise DataError(f"{_place(path, back)}: {_jump(table[0], back)}")
    order = np.argsort(table[0], kind="stable")
    moved = int((np.maximum.accumulate(table[0]) > table[0]).sum())
    notes = (
        [f"{path.name}: {moved} rows were out of order and were sorted by time"] if moved else []
    )
    return table[:, order], notes


def jump_back(t: Array, names: Array | None = None) -> int | None:
    """The first row before which the clock jumped back, if it did."""
    for row in np.flatnonzero(np.diff(t) < 0) + 1:
        later = np.flatnonzero(t[row:] >= t[row - 1])
        stretch = slice(row, row + later[0] if later.size else t.size)
        if stretch.stop - row < JUMP or (np.diff(t[stretch]) < 0).any():
            continue
        if names is None or np.isin(names[stretch], names[:row]).any():
            return int(row)
    return None


def _jump(t: Array, row: int) -> str:
    """What to say of a clock that jumped back before a row."""
    by = t[row - 1] - t[row]
    return (
        f"the clock jumps back by {by:g} s, from {t[row - 1]:.10g} to {t[row]:.10g}; sorting would "
        f"mix two stretches: cut the file here, or add {by:g} s to all that follows"
    )


def read_truth(path: Path, needed: bool) -> Array | None:
    """Read time, x, y and heading (4, N); None if there is no such file and none is needed."""
    if _find(path) is None:
        if not needed:
            return None
        raise DataError(
            f"{path}: no such file; a known start, a calibration and a score need the truth. "
            "Without one, use a global start (need_truth=False, --start global)"
        )
    return read_table(path, (TIME, "x", "y", "heading"))


def existing(path: Path) -> Path:
    """The path itself or its gzipped twin; `DataError` if neither is a file."""
    found = _find(path)
    if found is None:
        raise DataError(f"{path}: no such file; see data/README.md for the layout of a log folder")
    return found


def _find(path: Path) -> Path | None:
    candidates = (path, path.with_name(path.name + ".gz"))
    return next((candidate for candidate in candidates if candidate.is_file()), None)


def refuse(path: Path, wrong: NDArray[np.bool_], values: Array, reason: str) -> None:
    """Raise `DataError` for the first row that is wrong: file, line, reason with its value.

    Parameters
    ----------
    path : Path of a table that has been read
    wrong : bool array (N,), one per row
    values : array (N,)
    reason : str with ``{:g}`` where the value belongs
    """
    rows = np.flatnonzero(wrong)
    if rows.size:
        raise DataError(f"{_place(path, int(rows[0]))}: {reason.format(values[rows[0]])}")


def _place(path: Path, row: int) -> str:
    """The file and the line of a row of numbers; of a folder, or a file of messages, the row."""
    lines: list[int] = []
    if _find(path) is not None:
        text = read_text(existing(path)).splitlines()
        lines = [n for n, line in enumerate(text, start=1) if re.match(r"\s*[-+.]?\d", line)]
    return f"{path}, line {lines[row]}" if row < len(lines) else f"{path}, row {row + 1}"


def identities(path: Path, name: str, values: Array) -> NDArray[np.int64]:
    """Whole numbers that name things, each a different one; `DataError` if they are not."""
    refuse(path, values != np.round(values), values, name + " must be whole, got {:g}; repair it")
    again = np.ones(values.size, dtype=bool)
    again[np.unique(values, return_index=True)[1]] = False
    refuse(path, again, values, name + " {:g} is listed twice; delete one line")
    return values.astype(np.int64)


def read_text(path: Path) -> str:
    """The text of a file, gzipped or not; `DataError` if it is none."""
    try:
        raw = path.read_bytes()
        if raw[:2] == b"\x1f\x8b":  # gzip's signature: trust it more than the name
            raw = gzip.decompress(raw)
        return raw.decode("utf-8-sig")
    except (OSError, EOFError, zlib.error) as error:
        raise DataError(f"{path}: cannot be read ({error}); copy the file again") from None
    except UnicodeDecodeError as error:
        line = raw[: error.start].count(b"\n") + 1
        raise DataError(f"{path}, line {line}: not a text file; save it as plain text") from None


def _words(line: str) -> list[str]:
    """What a line holds before any comment."""
    return line.split("#", 1)[0].split()


def _runs_backwards(table: Array, columns: Sequence[str]) -> bool:
    return TIME in columns and bool((np.diff(table[columns.index(TIME)]) < 0).any())


def _diagnosis(path: Path, text: str, columns: Sequence[str]) -> str:
    """Name the first line that is wrong, and what is wrong with it."""
    before = -np.inf
    for number, line in enumerate(text.splitlines(), start=1):
        words, where = _words(line), f"{path}, line {number}"
        if not words:
            continue
        for name, word in zip(columns, words, strict=False):
            try:
                value = float(word if "_" not in word else "no number")
            except ValueError:
                return f"{where}: {name} must be a number, got {word!r:.40}; repair the line"
            if not np.isfinite(value):
                return f"{where}: {name} must be finite, got {word}; repair or delete the line"
            if abs(value) > LARGEST:
                return f"{where}: {name} is {word}, which is absurd; are the units SI?"
            if name == TIME and value < before:
                t = _times(text, columns)
                if t is not None and (back := jump_back(t)) is not None:
                    return f"{where}: {_jump(t, back)}"
                return f"{where}: time runs backwards, {word} after {before!r}; sort the file"
            if name == TIME:
                before = value
        if len(words) != len(columns):
            return f"{where}: expected {len(columns)} numbers ({_list(columns)}), got {len(words)}"
    return f"{path}: cannot be read as a table of numbers; save it as plain text"


def _times(text: str, columns: Sequence[str]) -> Array | None:
    """The column of times of a text, if all of its rows are sound."""
    try:
        return np.loadtxt(io.StringIO(text, newline=None), ndmin=2)[:, columns.index(TIME)]
    except (ValueError, IndexError):
        return None


def _list(columns: Sequence[str]) -> str:
    return ", ".join(columns)
