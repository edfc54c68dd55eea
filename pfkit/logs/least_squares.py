"""Least squares for errors that are not linear in what is sought: the method of Gauss and Newton.

Near a guess every smooth error is nearly linear. So replace it there by its tangent, solve that
linear problem exactly, move to its solution, and do it again. A few rounds are enough where the
guess is good; a bad one may end in another valley, so begin with the best of several. The tangent
needs derivatives, and central differences give them without a formula for each model.
"""

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
