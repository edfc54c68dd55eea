"""Named errors, and the few checks that raise them.

An object is validated when it is made, by `require_fields` and `require_array`. A function checks
at its boundary what NumPy would silently stretch or lose, and what a student's own model returned.
Who draws random numbers looks at the generator. What fails clearly by itself, such as None where a
sensor should be, needs no check. An error of ours says three things: what was wrong, the value it
got, and the remedy. All derive from `PfkitError`, which is a `ValueError`, so ``except ValueError``
still works for those who prefer it.

A crash is the lesser evil. NumPy stretches arrays until they fit, so particles stored as
``(M, 3)``, a standard deviation with one sign too many or a covariance that is none often run
through and give a filter that converges, to something. So the checks look at shapes first and
refuse what would have been stretched.

Inside the package nothing is checked twice: functions that begin with an underscore, and
`Particles.trusted`, take numbers that have passed the boundary.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache
from types import ModuleType
from typing import Any

import numpy as np

Shape = int | tuple[int, ...]
Pattern = tuple[Any, ...]


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
    array = np.asarray(value)
    if array.dtype.kind not in "fiub":  # no text, objects, complex numbers or dates
        raise error(f"{name} must be real numbers, got {value!r:.80}; pass floats or an array")
    return array.astype(float, copy=False)


RULES: dict[str, tuple[Callable[[np.ndarray], Any], str]] = {
    "finite": (np.isfinite, "remove or repair that value"),
    "a number": (lambda x: x == x, "remove or repair that value"),
    "not infinite": (lambda x: ~np.isinf(x), "NaN says that nobody knows, infinity nothing"),
    "> 0": (lambda x: x > 0, "infinity switches it off"),
    ">= 0": (lambda x: x >= 0, "drop the sign; of a logarithm take exp"),
    "finite and > 0": (lambda x: (x > 0) & (x < math.inf), "a noise of 0 has no density"),
    "finite and >= 0": (lambda x: (x >= 0) & (x < math.inf), "drop the sign"),
    "in [0, 1]": (lambda x: (x >= 0) & (x <= 1), "it is a share or a probability"),
    "in (0, 1]": (lambda x: (x > 0) & (x <= 1), "a share of nothing has no mean"),
    "in [0, 1)": (lambda x: (x >= 0) & (x < 1), "at 1 the answer is infinite"),
    "in (0, 1)": (lambda x: (x > 0) & (x < 1), "it is a probability, and neither 0 nor 1"),
    "whole": (lambda x: np.isfinite(x) & (x == np.floor(x)), "round it"),
    "whole and >= 1": (lambda x: (x < math.inf) & (x == np.floor(x)) & (x >= 1), "round it"),
}
"""What numbers may have to be: the words of the message, their meaning, the remedy."""


@lru_cache(maxsize=1024)
def _fits(shape: tuple[int, ...], wanted: Pattern) -> bool:
    """Whether a shape is the wanted one: a number is a length, a name any length but 0."""
    if wanted[:1] == (...,):
        return wanted == (...,) or _fits(shape[::-1], wanted[::-1])
    if wanted[-1:] == (...,):
        return len(shape) >= len(wanted) - 1 and _fits(shape[: len(wanted) - 1], wanted[:-1])
    pairs = zip(shape, wanted, strict=False)
    return len(shape) == len(wanted) and all(n == w or (n > 0 and type(w) is str) for n, w in pairs)


def _written(wanted: Pattern) -> str:
    """A wanted shape as in the docstrings: ``(3, ...)``, or ``(2, L), L >= 1``."""
    words = ["..." if w is ... else str(w) for w in wanted]
    least = [f", {w} >= 1" for w in wanted if isinstance(w, str)]
    return f"({', '.join(words)}{',' * (len(words) == 1)})" + "".join(least)


def require_array(
    name: str,
    value: Any,
    shape: Pattern = (...,),
    rule: str | None = "finite",
    error: type[PfkitError] = ParameterError,
) -> np.ndarray:
    """Return `value` as a float array of the wanted shape whose numbers obey the rule, if any.

    The shape is written as in the docstrings: ``(3, ...)`` for components first, ``(2, "L")`` for
    any number of columns but none, ``(D, D)``. Raises `ShapeError`, or `error` for the numbers.
    """
    array = as_numbers(name, value, error)
    if not _fits(array.shape, shape):
        hint = "; transpose it" if array.ndim == 2 and _fits(array.shape[::-1], shape) else ""
        raise ShapeError(
            f"{name} must have shape {_written(shape)}, got {array.shape}{hint}: {value!r:.60}"
        )
    if rule is None:
        return array
    obeys, remedy = RULES[rule]
    good = obeys(array)
    if np.count_nonzero(good) < good.size:  # all() in a third of its time
        raise error(f"{name} must be {rule}, got {array[~good].flat[0]}; {remedy}")
    return array


def require_number(name: str, value: Any, rule: str = "finite") -> float:
    """Return `value` as a float; raise unless it is one number by the rule."""
    return float(require_array(name, value, (), rule))


def require_fields(thing: Any, **rules: str) -> None:
    """Raise unless each named field of an object is one number by its rule."""
    for name, rule in rules.items():
        require_number(name, getattr(thing, name), rule)


def require_count(name: str, value: Any, least: int = 1) -> int:
    """Return `value` as an int; raise `ParameterError` unless it is a whole number >= least."""
    whole = isinstance(value, int | np.integer) and not isinstance(value, bool)
    if not whole or value < least:
        raise ParameterError(f"{name} must be a whole number >= {least}, got {value!r}")
    return int(value)


def require_shape(name: str, value: Shape) -> tuple[int, ...]:
    """Read a number M, or a shape such as (B, M), as a tuple of whole numbers >= 1."""
    shape = value if isinstance(value, tuple) else (value,)
    return tuple(require_count(name, n) for n in shape)


def require_bounds(value: Any) -> tuple[float, float, float, float]:
    """Return ``(x_min, x_max, y_min, y_max)`` as four floats that span an area."""
    x0, x1, y0, y1 = require_array("bounds", value, (4,)).tolist()
    if not (x0 < x1 and y0 < y1):
        raise ParameterError(f"bounds must be (x_min, x_max, y_min, y_max), got {value!r:.80}")
    return x0, x1, y0, y1


def require_covariance(name: str, value: Any, n: int) -> np.ndarray:
    """Return a covariance (n, n) as an array; standard deviations (n,), maybe 0, become one."""
    if np.ndim(value) == 1:
        return np.diag(require_array(name, value, (n,), "finite and >= 0") ** 2)
    Sigma = require_array(name, value, (n, n))
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
