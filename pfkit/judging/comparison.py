r"""Comparison: is A better than B, or was A lucky?

One run is an anecdote: another seed, another winner. So we run both filters on many seeds and
look at the differences. Two ideas make that cheap and honest.

*Common random numbers.* Let A and B face the same drive with the same noise. What the seed
does to both cancels in the difference, and its variance shrinks from
:math:`\sigma_A^2 + \sigma_B^2` to :math:`\sigma_A^2 + \sigma_B^2 - 2\,\mathrm{Cov}(A, B)`.

*An interval instead of a number.* The bootstrap draws the runs again with replacement and
looks how much the statistic moves. A permutation test asks the other question: if A and B were
equal, each difference could as well have had the other sign; how often would their mean then
be as large as the one we saw?
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ShapeError, require_array, require_count, require_number

Array = NDArray[np.float64]


class Interval(NamedTuple):
    """A number with its confidence limits."""

    value: float
    low: float
    high: float

    @property
    def half(self) -> float:
        """Half the distance between the limits: what stands behind a ±."""
        return (self.high - self.low) / 2

    def __repr__(self) -> str:
        return f"{self.value:.4g} [{self.low:.4g}, {self.high:.4g}]"


def root_mean_square(x: ArrayLike, axis: int = -1) -> Array:
    r"""The RMSE of runs from their RMSEs: :math:`\sqrt{\tfrac1n \sum_i x_i^2}`.

    Parameters
    ----------
    x : array_like (..., n), in any unit
    axis : int, the axis that is averaged away

    Returns
    -------
    array (...), in that unit

    Raises
    ------
    ParameterError, ShapeError
        If a number is not finite, or there is none.
    """
    x = require_array("x", x, (..., "n"))
    return np.sqrt(np.mean(x * x, axis=axis))


def bootstrap_interval(
    x: ArrayLike,
    rng: np.random.Generator,
    statistic: Callable[..., Array] = np.mean,
    level: float = 0.95,
    draws: int = 2000,
) -> Interval:
    r"""Percentile bootstrap interval of a statistic of n independent runs.

    .. math:: [\,q_{(1-\ell)/2},\; q_{(1+\ell)/2}\,] \text{ of } s(x^*),
              \qquad x^*_i \sim \text{uniform over } x

    Parameters
    ----------
    x : array_like (n,), n >= 2
        One number per run; never one per step: steps of a run are not independent.
    rng : numpy.random.Generator
    statistic : function (array, axis=-1) -> array
        ``numpy.mean``, ``numpy.median``, `root_mean_square` ...
    level : float in (0, 1)
    draws : int

    Returns
    -------
    Interval

    Raises
    ------
    ParameterError, ShapeError
        If a score is not finite, there is none, or the level or the number of draws makes no
        sense.

    Notes
    -----
    Source: B. Efron and R. Tibshirani, An Introduction to the Bootstrap (1993). With fewer
    than about 15 runs the interval is too short.
    """
    x = _runs(x)
    require_number("level", level, "in (0, 1)")
    again = x[rng.integers(0, x.size, (draws, x.size), dtype=np.int64)]
    low, high = np.quantile(statistic(again, axis=-1), (0.5 - level / 2, 0.5 + level / 2))
    return Interval(float(statistic(x, axis=-1)), float(low), float(high))


def wilson_interval(successes: int, n: int, level: float = 0.95) -> Interval:
    r"""Interval of a success rate; sound even for 0 or n successes.

    .. math:: \frac{\hat p + z^2/2n \pm z \sqrt{\hat p (1 - \hat p)/n + z^2/4n^2}}{1 + z^2/n}

    Parameters
    ----------
    successes : int, 0 to n
    n : int >= 1, independent runs
    level : float in (0, 1)

    Returns
    -------
    Interval

    Raises
    ------
    ParameterError
        If the counts are not whole numbers, or there are more successes than runs.

    Notes
    -----
    Source: E. B. Wilson, JASA 22 (1927).
    """
    require_number("level", level, "in (0, 1)")
    share = require_count("successes", successes, 0) / require_count("n", n)
    p = require_number("the share of successes", share, "in [0, 1]")
    z = NormalDist().inv_cdf(0.5 + level / 2)
    centre, scale = p + z * z / (2 * n), 1 + z * z / n
    half = z * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return Interval(p, max(0.0, (centre - half) / scale), min(1.0, (centre + half) / scale))


@dataclass(frozen=True)
class Comparison:
    """Two filters on the same seeds; differences are A minus B.

    Parameters
    ----------
    a, b : arrays (n,), one score per seed
    difference : Interval, mean difference with its bootstrap interval
    p : float, of the sign-flip permutation test, two-sided
    """

    a: Array
    b: Array
    difference: Interval
    p: float

    @property
    def wins(self) -> int:
        """On how many seeds A's score was smaller."""
        return int(np.sum(self.a < self.b))

    def __repr__(self) -> str:
        wins = f"A smaller on {self.wins} of {self.a.size}"
        return f"A - B = {self.difference!r}, p = {self.p:.2g}, {wins}"


def paired(
    a: ArrayLike, b: ArrayLike, rng: np.random.Generator, level: float = 0.95, draws: int = 5000
) -> Comparison:
    r"""Compare scores that belong to the same seeds.

    .. math:: p = \frac{1 + \#\{|\tfrac1n \sum_i s_i d_i| \ge |\bar d|\}}{1 + draws},
              \qquad d = a - b,\; s_i = \pm 1 \text{ at random}

    Parameters
    ----------
    a, b : array_like (n,), n >= 2, one score per seed, in the same order
    rng : numpy.random.Generator
    level : float in (0, 1), of the interval
    draws : int, of the bootstrap and of the test; p is at least 1 / (1 + draws)

    Returns
    -------
    Comparison

    Raises
    ------
    ParameterError, ShapeError
        If the two lists of scores differ in length, or a score is not finite.
    """
    a, b = _runs(a), _runs(b)
    d = a - b
    signs = rng.integers(0, 2, (draws, d.size), dtype=np.int64) * 2 - 1
    # rounding must not make a sum differ from itself with another order of signs
    extreme = np.abs(signs @ d) >= abs(d.sum()) * (1 - 1e-12)
    p = (1 + np.count_nonzero(extreme)) / (1 + draws)
    return Comparison(a, b, bootstrap_interval(d, rng, level=level, draws=draws), p)


def compare(
    run_a: Callable[[np.random.Generator], float],
    run_b: Callable[[np.random.Generator], float],
    seeds: int,
    seed: int = 0,
) -> Comparison:
    """Run two filters on common random numbers and compare their scores.

    Parameters
    ----------
    run_a, run_b : functions (rng) -> score
        Each gets its own copy of the same generator. Let both draw the drive first, and the
        filter's own noise afterwards; then they face the same drive.
    seeds : int >= 2, how many
    seed : int, the root of all of them

    Returns
    -------
    Comparison

    Raises
    ------
    ParameterError
        If a run is not a function, or there are fewer than two seeds.
    """
    streams = np.random.SeedSequence(seed).spawn(seeds + 1)
    a, b = (
        [run(np.random.default_rng(stream)) for stream in streams[1:]] for run in (run_a, run_b)
    )
    return paired(a, b, np.random.default_rng(streams[0]))


def _runs(x: ArrayLike) -> Array:
    x = require_array("scores", x, ("n",))
    if x.size < 2:
        raise ShapeError(f"scores must be one per run, of two runs at least, got {x.shape}")
    return x
