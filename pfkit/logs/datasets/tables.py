"""Tables of anybody's making: commas, semicolons, tabs or blanks, with or without a first line.

`text` reads the files of known layouts, whose columns are known, too. Here the first line may name
the columns, and only those that are asked for are read.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError
from pfkit.logs.datasets.text import LARGEST, existing, read_text

Array = NDArray[np.float64]


class Table(NamedTuple):
    """Columns of a file.

    Attributes
    ----------
    path : Path
    rows : array (n, N), one row per column that was asked for
    """

    path: Path
    rows: Array


def split_lines(path: Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """The names in the first line (empty if it holds numbers), and all rows with their lines."""
    lines = [
        (number, line.strip())
        for number, line in enumerate(read_text(path).splitlines(), start=1)
        if line.strip()
    ]
    names: list[str] = []
    body = [(number, line) for number, line in lines if not line.startswith(("#", "%"))]
    if not body:
        raise DataError(f"{path}: no rows of numbers in the file")
    mark = next((m for m in (",", ";", "\t") if m in body[-1][1]), None)

    def words(line: str) -> list[str]:
        return [w.strip().strip('"') for w in (line.split(mark) if mark else line.split())]

    if any(not _is_number(word) for word in words(body[0][1])):
        names = words(body[0][1])
        body = body[1:]
    elif lines[0][1].startswith(("#", "%")):
        said = words(lines[0][1].lstrip("#% "))
        names = said if len(said) == len(words(body[0][1])) else []
    if not body:
        raise DataError(f"{path}: a line of names and no rows of numbers")
    return names, [(number, words(line)) for number, line in body]


def _is_number(word: str) -> bool:
    return bool(re.fullmatch(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?(inf|nan)|", word, re.I))


def read_columns(path: Path, wanted: list[str | int], count: int = 1) -> Table:
    """Columns of a table by name, or by number from 1.

    Parameters
    ----------
    path : Path
    wanted : list of names or numbers
    count : int
        How many columns from each of them on.

    Returns
    -------
    Table with len(wanted) * count rows

    Raises
    ------
    DataError
        With file, line and reason.
    """
    path = existing(path)
    names, body = split_lines(path)
    width = len(body[0][1])
    columns = [
        at + i for at in (_find(path, w, names, width) for w in wanted) for i in range(count)
    ]
    if max(columns) >= width:
        raise DataError(f"{path}: {max(columns) + 1} columns are asked for, it has {width}")
    values = np.empty((len(columns), len(body)))
    for k, (number, words) in enumerate(body):
        if len(words) != width:
            raise DataError(f"{path}, line {number}: expected {width} columns, got {len(words)}")
        for i, column in enumerate(columns):
            values[i, k] = _number(path, number, words[column], count > 1)
    return Table(path, values)


def _find(path: Path, wanted: str | int, names: list[str], width: int) -> int:
    """The place of a column."""
    if isinstance(wanted, int) and not isinstance(wanted, bool):
        if not 1 <= wanted <= width:
            raise DataError(f"{path}: no column {wanted}; it has 1 to {width}")
        return wanted - 1
    if wanted not in names:
        there = ", ".join(names) or f"no names, only columns 1 to {width}"
        raise DataError(f"{path}: no column {wanted!r}; it has {there}")
    return names.index(str(wanted))


def _number(path: Path, line: int, word: str, lost: bool) -> float:
    """One finite number; a beam that was lost may be infinite or no number."""
    try:
        value = float(word if "_" not in word else "no number")
    except ValueError:
        raise DataError(
            f"{path}, line {line}: {word!r:.40} is no number; repair the line"
        ) from None
    if not lost and not np.isfinite(value):
        raise DataError(f"{path}, line {line}: {word} is not finite; repair or delete the line")
    if abs(value) > LARGEST**2:
        raise DataError(f"{path}, line {line}: {word} is absurd; repair the line")
    return value
