"""Where a wrong function differs from the reference, as small as its check has met it."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

MOST_CALLS = 300  # that are remembered: a check may call a function thousands of times
LARGEST = 2_000  # numbers in the arguments of a call that is remembered


@dataclass(frozen=True)
class Call:
    """One call of a student's function: its arguments, and what came of it."""

    args: tuple[Any, ...]
    kwargs: dict[str, Any]
    returned: Any = None
    raised: str = ""

    @property
    def size(self) -> int:
        """How many numbers the arguments hold."""
        return sum(_size(a) for a in (*self.args, *self.kwargs.values()))


def can_be_told(args: tuple[Any, ...], kwargs: dict[str, Any]) -> bool:
    """Only numbers and a random generator go in, no function or object, and not too many."""
    values = (*args, *kwargs.values())
    return all(_is_plain(a) for a in values) and sum(_size(a) for a in values) <= LARGEST


def smallest(calls: list[Call], reference: Callable[..., Any]) -> str:
    """The call with the smallest arguments that the reference answers otherwise; "" if none.

    Returns
    -------
    str
        ``For w = [0.5, 0.5] you returned 1; expected 2.``
    """
    for call in sorted(calls, key=lambda c: c.size):
        args, kwargs = copy.deepcopy((call.args, call.kwargs))
        by_chance = any(isinstance(a, np.random.Generator) for a in (*args, *kwargs.values()))
        try:
            expected = reference(*args, **kwargs)
        except Exception:
            continue  # an input that the reference refuses shows nothing
        given = _told(call, reference)
        lead = f"For {given}" if given else "Called with a generator"
        if call.raised:
            return f"{lead} it raised {call.raised}; {_wanted(expected)}."
        difference = _difference(call.returned, expected)
        if difference and by_chance:
            right = "a right answer with the same random numbers"
            difference = difference.replace("expected", f"{right} can return", 1)
        if difference:
            return f"{lead} {difference}."
    return ""


def _is_plain(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.dtype.kind in "biuf"
    if isinstance(value, list | tuple):
        return all(_is_plain(v) for v in value)
    if isinstance(value, dict):
        return all(_is_plain(v) for v in (*value, *value.values()))
    return isinstance(value, bool | int | float | np.number | str | np.random.Generator)


def _size(value: Any) -> int:
    if isinstance(value, list | tuple):
        return sum(_size(v) for v in value)
    if isinstance(value, dict):
        return sum(_size(v) for v in value.values())
    return 0 if isinstance(value, np.random.Generator) else int(np.size(value))


def _told(call: Call, reference: Callable[..., Any]) -> str:
    """``w = [0.5, 0.5], M = 2``, by the names of the reference's parameters."""
    try:
        names = list(inspect.signature(reference).parameters)
    except (TypeError, ValueError):
        names = []
    names += [f"argument {k + 1}" for k in range(len(names), len(call.args))]
    given = [*zip(names, call.args, strict=False), *call.kwargs.items()]
    plain = [(n, a) for n, a in given if not isinstance(a, np.random.Generator)]
    return ", ".join(f"{n} = {shown(a)}" for n, a in plain)


def shown(value: Any, most: int = 120, digits: int = 4) -> str:
    """Numbers to four digits, long arrays shortened."""
    if isinstance(value, np.ndarray | list | tuple) and _is_plain(value):
        try:
            array = np.asarray(value)
        except ValueError:
            return repr(value)[:most]
        with np.printoptions(precision=digits, suppress=True, threshold=8, edgeitems=2):
            return " ".join(np.array2string(array, separator=", ").split())[:most]
    if isinstance(value, float | np.floating):
        return f"{value:.{digits}g}"
    return repr(value)[:most]


def _wanted(expected: Any) -> str:
    return f"expected {shown(expected)}"


def _difference(returned: Any, expected: Any) -> str:
    """``you returned 1; expected 2``, or "" where both are the same."""
    if isinstance(returned, tuple) and isinstance(expected, tuple):
        return _difference_in_parts(returned, expected)
    try:
        a, b = np.asarray(returned, dtype=float), np.asarray(expected, dtype=float)
    except (TypeError, ValueError):
        several = isinstance(returned, tuple | list) and isinstance(expected, tuple | list)
        if several:
            return _difference_in_parts(returned, expected)
        return f"you returned {shown(returned)}; {_wanted(expected)}"
    if a.shape != b.shape:
        return (
            f"you returned {shown(returned)} of shape {a.shape}; {_wanted(expected)} of {b.shape}"
        )
    apart = ~np.isclose(a, b, rtol=1e-6, atol=1e-9, equal_nan=True)
    if not apart.any():
        return ""
    if a.size <= 8:
        digits = 4 if shown(returned) != shown(expected) else 12  # all that tells them apart
        one, other = shown(returned, digits=digits), shown(expected, digits=digits)
        return f"you returned {one}; expected {other}"
    at = tuple(int(k) for k in np.argwhere(apart)[0])
    place = at[0] if len(at) == 1 else at
    return (
        f"you returned {a[at]:.4g} at index {place}; expected {b[at]:.4g} there "
        f"({int(apart.sum())} of {a.size} numbers differ)"
    )


def _difference_in_parts(returned: Sequence[Any], expected: Sequence[Any]) -> str:
    """The same for results of several parts: the first part that differs."""
    if len(returned) != len(expected):
        return f"you returned {len(returned)} parts; expected {len(expected)}"
    for k, (a, b) in enumerate(zip(returned, expected, strict=True), start=1):
        if difference := _difference(a, b):
            return f"in part {k} of the result {difference}"
    return ""
