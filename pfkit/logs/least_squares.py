"""Least squares for errors that are not linear: Gauss-Newton by differences."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def slopes(error: Callable[[Array], Array], p: Array, h: float = 1e-3) -> Array:
    """Derivatives (n, P) of an error (n,) by its parameters p (P,), as central differences."""
    steps = h * np.eye(p.size)
    return np.stack([(error(p + step) - error(p - step)) / (2 * h) for step in steps], axis=1)


def least_squares(error: Callable[[Array], Array], start: Array, rounds: int = 8) -> Array:
    """Gauss-Newton: linearise the error (n,) about the parameters, solve, repeat."""
    p = start
    for _ in range(rounds):
        p = p - np.linalg.lstsq(slopes(error, p), error(p), rcond=None)[0]
    return p
