"""What is different about NumPy in the page, and made the same.

WebAssembly is a 32-bit machine: NumPy counts and indexes with 32-bit integers there, and some of
its functions refuse the 64-bit indices that pfkit's resamplers return and that work on every
desktop. `accept_int64` makes them take both, so that the same code runs in the page. The *methods*
``array.take`` and ``array.repeat`` cannot be taught: write ``np.take(array, ...)``.
"""

from __future__ import annotations

import functools

import numpy as np


def accept_int64() -> None:
    """On a 32-bit NumPy let `bincount`, `choose`, `repeat` and `take` accept int64."""
    if np.dtype(np.intp).itemsize >= 8 or getattr(np.bincount, "takes_int64", False):
        return
    bincount, choose, repeat, take = np.bincount, np.choose, np.repeat, np.take

    @functools.wraps(bincount)
    def bincount_any(x, /, weights=None, minlength=0):
        return bincount(_narrow(x), weights, minlength)

    @functools.wraps(choose)
    def choose_any(a, choices, out=None, mode="raise"):
        return choose(_narrow(a), choices, out, mode)

    @functools.wraps(repeat)
    def repeat_any(a, repeats, axis=None):
        return repeat(a, _narrow(repeats), axis)

    @functools.wraps(take)
    def take_any(a, indices, axis=None, out=None, mode="raise"):
        return take(a, _narrow(indices), axis, out, mode)

    bincount_any.takes_int64 = True  # type: ignore[attr-defined]
    np.bincount, np.choose = bincount_any, choose_any
    np.repeat, np.take = repeat_any, take_any


def _narrow(values):
    """64-bit integers as the machine's own; anything else as it is."""
    values = np.asarray(values)
    return values.astype(np.intp) if values.dtype in (np.int64, np.uint64) else values
