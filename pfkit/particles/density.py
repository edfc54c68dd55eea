r"""Kernel density estimation: from points to a smooth density.

Points have no density. Put a small bump on each and there is one:

.. math:: \hat p(x) = \sum_m w_m \prod_d \mathcal N(x_d - x^{[m]}_d;\, 0, h_d^2) .

The width h decides. Too narrow, and the density has a spike on every particle; too wide, and it
smears what the particles know. Silverman's rule,

.. math:: h_d = \sigma_d \Big(\frac{4}{(D + 2)\, n}\Big)^{1/(D+4)}, \qquad n = \mathrm{ESS},

is right for one Gaussian mode. With several modes sigma_d measures their distance, and h is
far too wide: give a width of your own, or cut the cloud with `clusters` first.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import log_gaussian
from pfkit.errors import ParameterError, require_array
from pfkit.geometry import wrap
from pfkit.particles.estimators import covariance
from pfkit.particles.particle_set import Particles

Array = NDArray[np.float64]
BLOCK = 2**20  # kernels evaluated at a time: bounds the memory, not the result


def silverman_bandwidth(bel: Particles) -> Array:
    r"""Kernel widths by Silverman's rule, :math:`h_d = \sigma_d (4 / ((D+2) n))^{1/(D+4)}`.

    Parameters
    ----------
    bel : Particles with state (D, M)

    Returns
    -------
    array (D,), metres and radians; n is the ESS

    Raises
    ------
    ShapeError
        If the set is a batch.
    """
    D = len(require_array("the state of one set", bel.state, ("D", "M")))
    return np.sqrt(np.diag(covariance(bel))) * (4 / ((D + 2) * bel.ess)) ** (1 / (D + 4))


def kde(bel: Particles, points: ArrayLike, bandwidth: ArrayLike | None = None) -> Array:
    r"""Density of a cloud at some points.

    .. math:: \hat p(x) = \sum_m w_m \prod_d \mathcal N(x_d - x^{[m]}_d;\, 0, h_d^2)

    Parameters
    ----------
    bel : Particles with state (D, M)
    points : array_like (D, ...), where to evaluate
    bandwidth : array_like (D,) > 0, metres and radians; Silverman's rule if left out

    Returns
    -------
    array (...), per square metre (and radian)

    Raises
    ------
    ShapeError, ParameterError
        If shapes do not match, the set is a batch, or a width is 0 (all particles agree in one
        component: give a width).

    Notes
    -----
    O(M N) for N points. Heading differences are wrapped; keep h well below pi.
    """
    D = len(require_array("the state of one set", bel.state, ("D", "M")))
    points = require_array("points", points, (D, ...))
    if bandwidth is None:
        h = silverman_bandwidth(bel)
        if not (h > 1e-9 * np.abs(bel.state).max()).all():  # only rounding
            raise ParameterError(f"all particles agree in a component (widths {h}); give bandwidth")
    else:
        h = require_array("bandwidth", bandwidth, (D,), "finite and > 0")
    flat, w = points.reshape(D, -1), bel.w
    density = np.empty(flat.shape[1])
    block = max(BLOCK // bel.M, 1)
    for start in range(0, flat.shape[1], block):
        at = slice(start, start + block)
        difference = flat[:, at, None] - bel.state[:, None]
        if D >= 3:
            difference[2] = wrap(difference[2])
        log_kernel = sum(log_gaussian(difference[d], h[d]) for d in range(D))
        density[at] = np.exp(log_kernel) @ w
    return density.reshape(points.shape[1:])
