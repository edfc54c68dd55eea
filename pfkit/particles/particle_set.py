r"""Particles: a belief as a weighted set of guesses.

A particle filter carries its belief about the state as M guesses (particles) with weights,

.. math:: bel(x) \approx \sum_{m=1}^M w^{[m]}\, \delta(x - x^{[m]}), \qquad \sum_m w^{[m]} = 1 .

Weights are products of many likelihoods and soon become smaller than any floating-point
number. So we store their logarithms, and normalise with the log-sum-exp identity

.. math:: \log \sum_m e^{\ell_m} = \ell_* + \log \sum_m e^{\ell_m - \ell_*},
          \qquad \ell_* = \max_m \ell_m ,

whose largest term is one, so that nothing overflows and the largest never underflows.

How many of the M particles still matter? The effective sample size

.. math:: \mathrm{ESS} = 1 / \sum_m (w^{[m]})^2

is M for equal weights and 1 when one particle holds everything. It looks only at weights:
M copies of one wrong guess have a perfect ESS of M.

States are stored components first: ``(D, M)`` for one filter, ``(D, B, M)`` for B
independent filters run side by side. Log-weights have the shape without the first axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import (
    DegenerateWeightsError,
    ParameterError,
    Shape,
    require_array,
    require_shape,
)


@dataclass(frozen=True)
class Particles:
    """A weighted particle set.

    Parameters
    ----------
    state : array (D, M) or (D, B, M)
        The guesses, components first; a pose has D = 3: x and y in metres, theta in radians.
    log_w : array (M,) or (B, M)
        Natural logarithms of weights that sum to one over the last axis. The filter's own
        functions keep that promise; build a set of your own with `from_weights`.

    Raises
    ------
    ShapeError, ParameterError, DegenerateWeightsError
        If the shapes do not belong together, the set is empty, a state is not finite, or
        `log_w` cannot be logarithms of weights that sum to one.
    """

    state: NDArray[np.float64]
    log_w: NDArray[np.float64]

    def __post_init__(self) -> None:
        state = require_array("state", self.state, ("D", "M", ...))
        log_w = require_array("log_w of state (D, M)", self.log_w, state.shape[1:], rule=None)
        object.__setattr__(self, "state", state)
        object.__setattr__(self, "log_w", log_w)
        peak = self.log_w.max(axis=-1)
        if not (np.isfinite(peak) & (peak < 1e-9)).all():
            raise ParameterError(
                f"log_w must be logarithms of weights that sum to 1, got {np.max(peak)}; "
                "build a set from linear weights with from_weights"
            )

    @classmethod
    def trusted(cls, state: NDArray[np.float64], log_w: NDArray[np.float64]) -> Particles:
        """Build a set without the checks, for code that has just made both parts itself."""
        bel = object.__new__(cls)
        object.__setattr__(bel, "state", state)
        object.__setattr__(bel, "log_w", log_w)
        return bel

    @property
    def w(self) -> NDArray[np.float64]:
        """Weights (M,) or (B, M), summing to one over the last axis; a copy, yours to change."""
        return self._w.copy()

    @cached_property
    def _w(self) -> NDArray[np.float64]:
        return np.exp(self.log_w)

    @property
    def M(self) -> int:
        """Number of particles (in each filter of a batch)."""
        return int(self.log_w.shape[-1])

    @property
    def ess(self) -> NDArray[np.float64] | np.float64:
        """Effective sample size, a number (or (B,) for a batch) between 1 and M."""
        return 1.0 / np.einsum("...m,...m->...", self._w, self._w)

    def __repr__(self) -> str:
        shape = " x ".join(str(n) for n in self.log_w.shape)
        return f"Particles({shape} of dimension {self.state.shape[0]}, ESS {np.mean(self.ess):.1f})"


def normalise(
    log_w: ArrayLike,
) -> tuple[NDArray[np.float64], NDArray[np.float64] | np.float64]:
    r"""Shift log-weights so that their weights sum to one.

    .. math:: \ell_m \leftarrow \ell_m - \log\sum_k e^{\ell_k}

    Parameters
    ----------
    log_w : array (..., M)
        Unnormalised log-weights; ``-inf`` is a weight of zero.

    Returns
    -------
    log_w : array (..., M)
        Normalised: logsumexp is zero over the last axis.
    log_sum : array (...)
        The logarithm of the sum that was divided out. In `update` it is the log of
        the evidence.

    Raises
    ------
    DegenerateWeightsError
        If all weights of a set are zero, or one is NaN or infinite.
    ParameterError, ShapeError
        If `log_w` is not an array of numbers, or it is empty.

    Examples
    --------
    >>> log_w, log_sum = normalise(np.array([-1000.0, -1000.0]))  # exp() would give 0 / 0
    >>> np.exp(log_w), round(float(log_sum) + 1000.0, 6)
    (array([0.5, 0.5]), 0.693147)
    """
    log_w = require_array("log_w", log_w, (..., "M"), rule=None)
    peak = log_w.max(axis=-1, keepdims=True)
    if not math.isfinite(peak.sum()):
        bad = peak[~np.isfinite(peak)].flat[0]
        if bad != -np.inf:
            raise DegenerateWeightsError(
                f"a log-weight is {bad}: a likelihood is not a number or not finite; look for a "
                "division by zero or the logarithm of a negative number in the sensor model"
            )
        raise DegenerateWeightsError(
            f"every particle has weight 0 (log-weight {bad}): the measurement is impossible for "
            f"all {log_w.shape[-1]} of them. Widen the sensor noise, wrap the sensor in "
            "OutlierMixture, use more particles, or check the units of measurement and map"
        )
    shifted = log_w - peak  # first, so that large log-weights keep their digits
    log_sum = np.log(np.exp(shifted).sum(axis=-1, keepdims=True))
    return shifted - log_sum, (peak + log_sum)[..., 0]


def ess(log_w: ArrayLike) -> NDArray[np.float64] | np.float64:
    r"""Effective sample size.

    .. math:: \mathrm{ESS} = \frac{(\sum_m w^{[m]})^2}{\sum_m (w^{[m]})^2}

    Parameters
    ----------
    log_w : array (..., M)
        Log-weights. Their scale does not matter, as long as exp() neither over- nor underflows.

    Returns
    -------
    array (...), between 1 and M

    Raises
    ------
    DegenerateWeightsError
        If all weights are zero, or one is NaN or infinite.
    ParameterError, ShapeError
        If `log_w` is not an array of numbers, or it is empty.

    Notes
    -----
    Source: A. Kong, J. S. Liu and W. H. Wong, "Sequential imputations and Bayesian missing
    data problems", JASA 89 (1994). ESS = M / (1 + CV^2) with CV the coefficient of variation.

    Examples
    --------
    >>> round(float(ess(np.log([0.5, 0.25, 0.25]))), 3)
    2.667
    """
    with np.errstate(over="ignore"):
        w = np.exp(require_array("log_w", log_w, (..., "M"), rule=None))
    total, squares = w.sum(axis=-1), np.einsum("...m,...m->...", w, w)
    if not ((squares > 0) & (squares < np.inf)).all():
        raise DegenerateWeightsError(
            f"no effective sample size: the weights sum to {np.max(total)}; normalise() them first"
        )
    return total * total / squares


def equal_log_weights(shape: Shape) -> NDArray[np.float64]:
    """Log-weights of a set in which every particle counts the same: ``-log M``.

    Parameters
    ----------
    shape : int M, or (B, M)

    Returns
    -------
    array (M,) or (B, M)

    Raises
    ------
    ParameterError
        If a number of particles is not a whole number of at least 1.
    """
    shape = require_shape("number of particles M", shape)
    return np.full(shape, -np.log(shape[-1]))


def from_weights(state: ArrayLike, w: ArrayLike | None = None) -> Particles:
    """Build a particle set from states and (unnormalised, linear) weights.

    Parameters
    ----------
    state : array_like (D, M) or (D, B, M)
    w : array_like (M,) or (B, M), optional
        Non-negative weights; equal if left out.

    Returns
    -------
    Particles

    Raises
    ------
    ParameterError
        If a state is not finite, or a weight is negative, NaN or infinite.
    DegenerateWeightsError
        If all weights are zero.
    ShapeError
        If the shapes do not belong together or the set is empty.
    """
    state = np.asarray(state, dtype=float)
    if w is None:
        return Particles(state, equal_log_weights(state.shape[1:]))
    w = require_array("w", w, state.shape[1:], "finite and >= 0")
    with np.errstate(divide="ignore"):  # log 0 = -inf is what a weight of zero means
        return Particles(state, normalise(np.log(w))[0])
