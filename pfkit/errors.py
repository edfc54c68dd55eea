"""Named errors, and the few checks that raise them.

Every public function checks its input once, at the boundary, and says three things:
what was wrong, the value it got, and the remedy. All errors derive from `PfkitError`,
which is a `ValueError`, so ``except ValueError`` still works for those who prefer it.

A crash is the lesser evil. NumPy stretches arrays until they fit, so particles stored as
``(M, 3)``, a standard deviation with one sign too many or a covariance that is none often run
through and give a filter that converges, to something. So the checks look at shapes first and
refuse what would have been stretched.

Inside the package nothing is checked twice: functions that begin with an underscore, and
`Particles.trusted`, take numbers that have passed the boundary.
"""

from __future__ import annotations

import math
import os
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

Shape = int | tuple[int, ...]


class PfkitError(ValueError):
    """Base of every error that pfkit raises on purpose."""


class ShapeError(PfkitError):
    """An array has the wrong shape; components come first: ``(3, M)``, not ``(M, 3)``."""


class ParameterError(PfkitError):
    """A parameter has a value that the model does not allow."""


class DataError(PfkitError):
    """A data file or a measurement cannot be used; names file, line and reason."""


class DegenerateWeightsError(PfkitError):
    """Every particle has weight zero (or a weight is NaN): there is nothing to normalise."""


class UnknownLandmarkError(PfkitError):
    """A measurement names a landmark that the map does not have."""


def as_numbers(name: str, value: Any, error: type[PfkitError] = ParameterError) -> np.ndarray:
    """Return `value` as a float array; raise `error` if it does not consist of numbers."""
    if type(value) is np.ndarray and value.dtype == np.float64:
        return value  # the common case, inside a filter
    try:
        array = np.asarray(value)
    except ValueError:  # a ragged list
        array = np.asarray("ragged")
    if array.dtype.kind not in "fiub":  # no text, objects, complex numbers or dates
        raise error(f"{name} must be real numbers, got {value!r:.80}; pass floats or an array")
    return array.astype(float, copy=False)


def require_finite(name: str, value: Any, error: type[PfkitError] = ParameterError) -> np.ndarray:
    """Return `value` as a float array; raise `error` if it is not numeric and finite."""
    array = as_numbers(name, value, error)
    finite = np.isfinite(array)
    if not finite.all():
        bad = array[~finite].flat[0]
        raise error(f"{name} must be finite, got {bad}; remove or repair that value")
    return array


def require_positive(name: str, value: Any) -> np.ndarray:
    """Return `value` as a float array; raise `ParameterError` unless every entry is > 0."""
    array = require_finite(name, value)
    if not (array > 0).all():
        raise ParameterError(f"{name} must be > 0, got {array.min()}; a noise of 0 has no density")
    return array


def require_non_negative(name: str, value: Any) -> np.ndarray:
    """Return `value` as a float array; raise `ParameterError` unless every entry is >= 0."""
    array = require_finite(name, value)
    if not (array >= 0).all():
        raise ParameterError(f"{name} must be >= 0, got {array.min()}; drop the sign")
    return array


def as_path(name: str, value: Any) -> Path:
    """Return `value` as a path; raise `ParameterError` unless it is text or a path."""
    if not isinstance(value, str | os.PathLike):
        raise ParameterError(f"{name} must be a path, got {value!r:.60}; give its name as text")
    return Path(value)


def require_positive_number(name: str, value: Any) -> float:
    """Return `value` as a float; raise `ParameterError` unless it is one finite number > 0."""
    return _one(name, require_positive(name, value))


def require_non_negative_number(name: str, value: Any) -> float:
    """Return `value` as a float; raise `ParameterError` unless it is one finite number >= 0."""
    return _one(name, require_non_negative(name, value))


def _one(name: str, array: np.ndarray) -> float:
    if array.ndim:
        raise ParameterError(f"{name} must be one number, got {array!r:.60} of shape {array.shape}")
    return float(array)


def require_fraction(name: str, value: Any) -> float:
    """Return `value` as a float; raise `ParameterError` unless it lies in [0, 1]."""
    array = require_finite(name, value)
    if array.ndim or not 0 <= array <= 1:
        raise ParameterError(f"{name} must be one number in [0, 1], got {value!r}")
    return float(array)


def require_count(name: str, value: Any, least: int = 1) -> int:
    """Return `value` as an int; raise `ParameterError` unless it is a whole number >= least."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or value < least:
        raise ParameterError(f"{name} must be a whole number >= {least}, got {value!r}")
    return int(value)


def require_shape(name: str, value: Shape) -> tuple[int, ...]:
    """Read a number M, or a shape such as (B, M), as a tuple of whole numbers >= 1."""
    shape = value if isinstance(value, tuple) else (value,)
    if not shape:
        raise ParameterError(f"{name} must be a whole number or (B, M), got {value!r}")
    return tuple(require_count(name, n) for n in shape)


def components_first(name: str, value: Any, n: int) -> np.ndarray:
    """Return `value` as a float array; raise `ShapeError` unless its first axis has length `n`."""
    array = as_numbers(name, value, ShapeError)
    if array.ndim == 0 or array.shape[0] != n:
        hint = "; transpose it" if array.ndim == 2 and array.shape[1] == n else ""
        raise ShapeError(
            f"{name} must have its {n} components first, shape ({n}, ...), got {array.shape}{hint}"
        )
    return array


def require_components(
    name: str, value: Any, n: int, error: type[PfkitError] = ParameterError
) -> np.ndarray:
    """Return `value` as a finite float array whose first axis has length `n`.

    Raises `ShapeError` if it does not have that shape, and `error` if it is not finite.
    """
    return require_finite(name, components_first(name, value, n), error)


def require_plane(state: Any) -> np.ndarray:
    """Return a state (D, ...) of any dimension D >= 2 as a finite array: x and y come first."""
    array = require_finite("state", state)
    if array.ndim == 0 or array.shape[0] < 2:
        raise ShapeError(f"state must have x and y first, shape (2, ...), got {array.shape}")
    return array


def require_covariance(name: str, value: Any, n: int) -> np.ndarray:
    """Return a covariance (n, n) as an array; standard deviations (n,), maybe 0, become one."""
    Sigma = require_finite(name, value)
    if n == 0 or Sigma.shape not in ((n,), (n, n)):
        raise ShapeError(f"{name} must have shape {(n, n)} or {(n,)}, n >= 1, got {Sigma.shape}")
    if Sigma.ndim == 1:
        return np.diag(require_non_negative(name, Sigma) ** 2)
    lowest, slack = np.linalg.eigvalsh(Sigma)[0], 1e-9 * max(np.trace(Sigma), 1.0)
    if np.abs(Sigma - Sigma.T).max() > slack or lowest < -slack:
        raise ParameterError(
            f"{name} must be symmetric with eigenvalues >= 0, got {Sigma.tolist()!r:.80}"
        )
    return 0.5 * (Sigma + Sigma.T)


def whole_cells(at: np.ndarray) -> np.ndarray:
    """Numbers of cells, int64, from positions counted in cells; too large ones are refused."""
    if np.abs(at).max(initial=0.0) > 2**62:
        raise ParameterError(f"{np.abs(at).max():g} cells from the origin; take larger cells")
    return np.floor(at).astype(np.int64)


def require_rng(rng: Any) -> None:
    """Refuse what is no generator of one's own: a seed, None, np.random itself, a RandomState.

    The last two would work, from a state that all share; anything else says itself what it lacks.
    """
    if isinstance(rng, _NO_GENERATOR):
        raise ParameterError(
            f"rng must be a numpy.random.Generator, got {rng!r:.60}; "
            "make one with np.random.default_rng(seed)"
        )


_NO_GENERATOR = (int, np.integer, type(None), ModuleType, np.random.RandomState)


def require_method(name: str, model: Any, *methods: str) -> None:
    """Raise `ParameterError` unless `model` has the methods a caller is about to use."""
    for method in methods:
        if not callable(getattr(model, method, None)):
            raise ParameterError(
                f"{name} must have a method {method}(...), got {model!r:.60}; "
                "pass a model object, not its class or a number"
            )


def require_number(name: str, value: Any, above: float = -math.inf) -> float:
    """Return `value` as a float; raise `ParameterError` unless it is one number > `above`.

    Infinity is a number here, because it switches a bound off; NaN is not.
    """
    array = as_numbers(name, value)
    if array.ndim or not array > above:
        raise ParameterError(f"{name} must be one number > {above}, got {value!r:.60}")
    return float(array)
