r"""The chi-square distribution: how long may a normal vector be?

The squared length of a standard normal vector with k components has the chi-square
distribution with k degrees of freedom. Squared *normalised* errors have it too, if an
estimator's covariance is honest. Gates and consistency bands are its quantiles.

Two components of honest size stay inside squared length 5.99 in 95 of 100 cases: that is the
95 % ellipse of a position. A gate of 9.21 lets 99 of 100 honest measurements of range and
bearing pass. Independent squares add: n errors with D components have n D degrees of freedom.

For whole k the tail is a finite sum, so a dozen lines replace a statistics library:

.. math:: P(\chi^2_k > x) &= P(\chi^2_{k-2} > x) + \frac{(x/2)^{k/2-1} e^{-x/2}}{\Gamma(k/2)}, \\
          P(\chi^2_1 > x) &= \mathrm{erfc}\sqrt{x/2}, \qquad P(\chi^2_2 > x) = e^{-x/2} .
"""

from __future__ import annotations

import math

from pfkit.errors import ParameterError, require_count, require_number


def chi2_tail(x: float, k: int) -> float:
    """Probability that a chi-square variable with k degrees of freedom exceeds x.

    Parameters
    ----------
    x : float
    k : int >= 1

    Returns
    -------
    float between 0 and 1; O(k)

    Raises
    ------
    ParameterError
        If x is not a number or k is not a whole number of at least 1.
    """
    k = require_count("degrees of freedom k", k)
    x = require_number("x", x)
    if x <= 0:
        return 1.0
    if math.isinf(x):
        return 0.0
    half = 0.5 * x
    tail = math.erfc(math.sqrt(half)) if k % 2 else math.exp(-half)
    for j in range(3 if k % 2 else 4, k + 1, 2):
        tail += math.exp((0.5 * j - 1) * math.log(half) - half - math.lgamma(0.5 * j))
    return min(tail, 1.0)


def chi2_quantile(p: float, k: int) -> float:
    """The value that a chi-square variable stays below with probability p.

    Parameters
    ----------
    p : float in [0, 1)
    k : int >= 1

    Returns
    -------
    float, e.g. 5.99 for p = 0.95 and k = 2; found by bisection to 1e-12 of its size

    Raises
    ------
    ParameterError
        If p is not in [0, 1) or k is not a whole number of at least 1.
    """
    if not 0 <= require_number("p", p) < 1:
        raise ParameterError(f"p must be in [0, 1), got {p}; the quantile of 1 is infinite")
    low, high = 0.0, 1.0
    while chi2_tail(high, k) > 1 - p:
        high *= 2
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if chi2_tail(middle, k) > 1 - p else (low, middle)
    return 0.5 * (low + high)
