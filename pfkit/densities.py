r"""The densities that everything else is built from: Gaussian, Student's t and chi-square.

The first two are densities of one error. Their constants are kept: they cancel in the weights,
but not in the evidence, nor in a mixture.

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

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import require_array, require_count, require_number, require_rng

Array = NDArray[np.float64]


def log_gaussian(error: ArrayLike, sigma: float) -> Array:
    r"""Log density of a zero-mean Gaussian.

    .. math:: \log \mathcal N(e;\, 0, \sigma^2) = -\frac{e^2}{2\sigma^2} - \log(\sigma\sqrt{2\pi})

    Parameters
    ----------
    error : array_like, any shape and unit
    sigma : float, > 0, in the unit of the error

    Returns
    -------
    array of the shape of the error

    Raises
    ------
    ParameterError
        If sigma is not positive, or an error is not a number.
    """
    return gaussian(require_array("error", error), require_number("sigma", sigma, "finite and > 0"))


def gaussian(error: Array, sigma: float) -> Array:
    """As `log_gaussian`, for callers that have checked their numbers."""
    log_p = np.square(error)
    log_p *= -0.5 / sigma**2
    log_p -= math.log(sigma * math.sqrt(2 * math.pi))
    return log_p


def draw_normal(shape: int | tuple[int, ...], rng: np.random.Generator) -> Array:
    """Draw standard normal numbers of that shape; refuse a generator that all share."""
    require_rng(rng)
    return rng.standard_normal(shape)


def error_density(error: Array, sigma: float, nu: float) -> Array:
    r"""Log density of Student's t with scale sigma and nu degrees of freedom; inf: Gaussian.

    .. math:: -\tfrac{\nu+1}{2}\log\Big(1+\frac{e^2}{\nu\sigma^2}\Big)
              + \log\frac{\Gamma((\nu+1)/2)}{\Gamma(\nu/2)\,\sigma\sqrt{\pi\nu}}

    Its tails are heavy: one wild measurement cannot veto a particle. For sensors, which have
    checked their numbers.
    """
    if math.isinf(nu):
        return gaussian(error, sigma)
    scaled = error / sigma
    constant = math.lgamma((nu + 1) / 2) - math.lgamma(nu / 2) - 0.5 * math.log(math.pi * nu)
    return constant - math.log(sigma) - 0.5 * (nu + 1) * np.log1p(scaled * scaled / nu)


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
    x = require_number("x", x, "a number")
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
    p = require_number("p", p, "in [0, 1)")
    low, high = 0.0, 1.0
    while chi2_tail(high, k) > 1 - p:
        high *= 2
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if chi2_tail(middle, k) > 1 - p else (low, middle)
    return 0.5 * (low + high)
