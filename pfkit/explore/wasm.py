"""What is different about NumPy in the page, and made the same.

WebAssembly is a 32-bit machine: NumPy counts and indexes with 32-bit integers there, and its two
counting functions refuse the 64-bit indices that pfkit's resamplers return and that work on every
desktop. `accept_int64` makes them take both, so that the same code runs in the page.
"""

from __future__ import annotations

import functools

import numpy as np


def accept_int64() -> None:
    """On a 32-bit NumPy let `np.bincount` and `np.repeat` take int64; elsewhere do nothing."""
    if np.dtype(np.intp).itemsize >= 8 or getattr(np.bincount, "takes_int64", False):
        return
    bincount, repeat = np.bincount, np.repeat

    @functools.wraps(bincount)
    def bincount_any(x, /, weights=None, minlength=0):
        return bincount(_narrow(x), weights, minlength)

    @functools.wraps(repeat)
    def repeat_any(a, repeats, axis=None):
        return repeat(a, _narrow(repeats), axis)

    bincount_any.takes_int64 = True  # type: ignore[attr-defined]
    np.bincount, np.repeat = bincount_any, repeat_any


def _narrow(values):
    """64-bit integers as the machine's own; anything else as it is."""
    values = np.asarray(values)
    return values.astype(np.intp) if values.dtype in (np.int64, np.uint64) else values
