r"""Intervals: how sure is a mean, when runs are few or come in clusters?

With few runs their own spread is uncertain, too. Student's t pays for that with wider intervals: at
5 runs 2.78 standard errors to either side instead of 1.96. An interval of 1.96 standard errors then
covers the truth in 88 % of cases and calls it 95 %.

Runs of one world, one film or one map share what is special about it. They are a cluster, and there
are as many independent numbers as clusters: a thousand seeds on one film say nothing about films.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array, require_count, require_number
from pfkit.judging.comparison import Interval

Array = NDArray[np.float64]


@cache
def t_quantile(level: float, freedom: int) -> float:
    r"""The number t with :math:`P(|T| \le t) = \ell` for Student's distribution.

    For whole degrees of freedom the probability is a finite sum in
    :math:`\varphi = \arctan(t / \sqrt\nu)`,

    .. math:: P = \sin\varphi \sum_{k < \nu/2} c_k \cos^{2k}\varphi \quad (\nu \text{ even}),
              \qquad P = \frac2\pi \Big(\varphi + \sin\varphi \sum_{k < (\nu-1)/2}
              c_k \cos^{2k+1}\varphi \Big) \quad (\nu \text{ odd})

    which rises with :math:`\varphi`; halving finds where it is :math:`\ell`.

    Parameters
    ----------
    level : float in (0, 1)
    freedom : int >= 1, degrees of freedom

    Returns
    -------
    float

    Raises
    ------
    ParameterError
        If the level is not in (0, 1) or there is no degree of freedom.

    Notes
    -----
    Source: Abramowitz and Stegun, Handbook of Mathematical Functions (1964), 26.7.3 and 26.7.4.
    """
    require_number("level", level, "in (0, 1)")
    odd = require_count("freedom", freedom) % 2
    k = np.arange(1, (freedom - odd) // 2)
    c = np.cumprod(np.append(1.0, 2 * k / (2 * k + 1) if odd else (2 * k - 1) / (2 * k)))
    low, high = 0.0, math.pi / 2
    for _ in range(60):
        phi = (low + high) / 2
        terms = c * math.cos(phi) ** (2 * np.arange(c.size) + odd) if freedom > 1 else 0.0
        p = math.sin(phi) * float(np.sum(terms))
        p = 2 / math.pi * (phi + p) if odd else p
        low, high = (phi, high) if p < level else (low, phi)
    return math.tan(low) * math.sqrt(freedom)


def t_interval(x: ArrayLike, level: float = 0.95) -> Interval:
    r"""Student's interval of the mean of n independent runs.

    .. math:: \bar x \pm t_{n-1}\, \frac{s}{\sqrt n}

    Parameters
    ----------
    x : array_like (n,), n >= 2
        One number per independent run, not far from normal or n not small.
    level : float in (0, 1)

    Returns
    -------
    Interval

    Raises
    ------
    ParameterError, ShapeError
        If a number is not finite, there are fewer than two, or the level makes no sense.

    Notes
    -----
    Source: Student, Biometrika 6 (1908).
    """
    return cluster_interval(x, np.arange(np.size(x)), level)


def cluster_interval(x: ArrayLike, clusters: ArrayLike, level: float = 0.95) -> Interval:
    r"""Interval of the mean of runs that come in clusters, such as seeds within worlds.

    .. math:: \bar x \pm t_{G-1} \sqrt{\frac{G}{G-1} \sum_g
              \Big( \frac{1}{n} \sum_{i \in g} (x_i - \bar x) \Big)^2}

    Parameters
    ----------
    x : array_like (n,), one number per run
    clusters : array_like (n,), the world, film or map of each run; G >= 2 different ones
    level : float in (0, 1)

    Returns
    -------
    Interval

    Raises
    ------
    ParameterError, ShapeError
        If a number is not finite, or there are fewer than two clusters.

    Notes
    -----
    With one run a cluster it is `t_interval`. Source: K.-Y. Liang and S. Zeger, Biometrika 73
    (1986), with the usual correction for few clusters.
    """
    names, of = np.unique(clusters, return_inverse=True)
    x = require_array("x", x, (of.size,))
    G, mean = require_count("clusters (worlds, films, maps)", names.size, 2), float(np.mean(x))
    sums = np.bincount(of, x - mean) / x.size
    half = t_quantile(level, G - 1) * math.sqrt(G / (G - 1) * float(np.sum(sums**2)))
    return Interval(mean, mean - half, mean + half)
