"""Tables of numbers in text files, read fast and judged strictly.

A log that somebody else recorded is an untrusted guest. A row that was cut short, a word
where a number belongs or a NaN must stop us at the door, with the file and the line, not
forty frames deep in a filter. Reading is fast because good files take one path without a
Python-level check per number; only a file that fails is looked at again, line by line, to
say where and why.
"""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Sequence
from itertools import chain
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError

Array = NDArray[np.float64]
TIME = "time"


def read_table(path: Path, columns: Sequence[str]) -> Array:
    """Read whitespace-separated numbers, components first.

    Lines that are blank or start with ``#`` are skipped; line ends may be those of any
    system; the file may be gzipped. A column called ``time`` must never decrease.

    Parameters
    ----------
    path : Path
        The file; if it is missing, the same name with ``.gz`` is tried.
    columns : names of the columns, in order

    Returns
    -------
    array (len(columns), N), N >= 1

    Raises
    ------
    DataError
        With file, line and reason, if the file is missing, empty, cut short, not numeric, not
        finite or runs backwards in time.
    """
    path = existing(path)
    lines = _read_text(path).splitlines()
    rows = [line.split() for line in lines if not line.startswith("#")]
    rows = [row for row in rows if row and not row[0].startswith("#")]
    if not rows:
        raise DataError(f"{path}: no rows of numbers in the file; it should hold {_list(columns)}")
    if set(map(len, rows)) == {len(columns)}:
        try:
            flat = np.fromiter(map(float, chain.from_iterable(rows)), float)
        except ValueError:
            raise DataError(_diagnosis(path, lines, columns)) from None
        table = np.ascontiguousarray(flat.reshape(len(rows), len(columns)).T)
        if np.isfinite(table).all() and not _runs_backwards(table, columns):
            return table
    raise DataError(_diagnosis(path, lines, columns))


def existing(path: Path) -> Path:
    """The path itself or its gzipped twin; `DataError` if neither is a file."""
    for candidate in (path, path.with_name(path.name + ".gz")):
        if candidate.is_file():
            return candidate
    raise DataError(f"{path}: no such file; see data/README.md for the layout of a log folder")


def line_of_row(path: Path, row: int) -> int:
    """The line number (from 1) of the row-th (from 0) row of numbers in a file."""
    lines = enumerate(_read_text(existing(path)).splitlines(), start=1)
    return [number for number, line in lines if not _is_skipped(line)][row]


def _read_text(path: Path) -> str:
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


def _is_skipped(line: str) -> bool:
    return not line.strip() or line.lstrip().startswith("#")


def _runs_backwards(table: Array, columns: Sequence[str]) -> bool:
    return TIME in columns and bool((np.diff(table[columns.index(TIME)]) < 0).any())


def _diagnosis(path: Path, lines: Sequence[str], columns: Sequence[str]) -> str:
    """Name the first line that is wrong, and what is wrong with it."""
    before = -np.inf
    for number, line in enumerate(lines, start=1):
        if _is_skipped(line):
            continue
        words, where = line.split(), f"{path}, line {number}"
        for name, word in zip(columns, words, strict=False):
            try:
                value = float(word)
            except ValueError:
                return f"{where}: {name} must be a number, got {word!r:.40}; repair the line"
            if not np.isfinite(value):
                return f"{where}: {name} must be finite, got {word}; repair or delete the line"
            if name == TIME and value < before:
                return f"{where}: time runs backwards, {word} after {before!r}; sort the file"
            if name == TIME:
                before = value
        if len(words) != len(columns):
            return f"{where}: expected {len(columns)} numbers ({_list(columns)}), got {len(words)}"
    raise AssertionError(f"{path} was refused without a reason")


def _list(columns: Sequence[str]) -> str:
    return ", ".join(columns)
