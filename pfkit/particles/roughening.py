r"""Roughening and regularisation: make copies differ again.

Resampling leaves copies. If the robot's own noise is too small to tell them apart, a thousand
particles soon hold a handful of different guesses, and when those are a little wrong, nothing
can correct them. Both remedies add a little noise to every copy.

*Roughening* takes a share of the cloud's extent E in each component,

.. math:: \sigma_d = K\, E_d\, M^{-1/D} .

*Regularisation* takes it from kernel density estimation: resampling then draws from a smooth
density instead of from M points,

.. math:: x \leftarrow x + h\, \mathcal N(0, \Sigma), \qquad
          h = \Big(\frac{4}{D + 2}\Big)^{1/(D+4)} M^{-1/(D+4)} .

Both make the belief a little wider than it is: they pay bias for diversity. They belong right
after a resampling and nowhere else. Noise on weighted particles at every step would be process
noise that nobody asked for, so both refuse sets whose weights differ.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import ParameterError
from pfkit.geometry import wrap
from pfkit.particles.estimators import covariance, deviation
from pfkit.particles.particle_set import Particles

Array = NDArray[np.float64]


def roughen(
    bel: Particles, rng: np.random.Generator, K: float = 0.2, where: ArrayLike = True
) -> Particles:
    r"""Add noise in proportion to the cloud's extent: :math:`\sigma_d = K E_d M^{-1/D}`.

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M), just resampled
    rng : numpy.random.Generator
    K : float >= 0
        The usual 0.2 is a habit, not a law.
    where : bool or (B,)
        Which filters to treat: pass ``info.resampled``.

    Returns
    -------
    Particles with the same weights

    Raises
    ------
    ParameterError
        If the weights are not equal: resample first.

    Notes
    -----
    Source: N. J. Gordon, D. J. Salmond and A. F. M. Smith, IEE Proc. F 140 (1993). The extent
    of the heading is measured about its mean direction.
    """
    where = _fresh(bel, where)
    extent = np.ptp(deviation(bel), axis=-1)
    scale = K * extent[..., None] * bel.M ** (-1 / len(bel.state))
    return _jitter(bel, scale * draw_normal(bel.state.shape, rng), where)


def regularise(bel: Particles, rng: np.random.Generator, where: ArrayLike = True) -> Particles:
    r"""Add noise shaped like the cloud: :math:`h\,\mathcal N(0, \Sigma)`.

    Parameters
    ----------
    bel : Particles with state (D, M) or (D, B, M), just resampled
    rng : numpy.random.Generator
    where : bool or (B,)
        Which filters to treat: pass ``info.resampled``.

    Returns
    -------
    Particles with the same weights

    Raises
    ------
    ParameterError
        If the weights are not equal: resample first.

    Notes
    -----
    Source: C. Musso, N. Oudjane and F. Le Gland (2001), with a Gaussian kernel. The bandwidth is
    right for one Gaussian mode. Two modes far apart have a large Sigma and are smeared too much.
    """
    where = _fresh(bel, where)
    D = len(bel.state)
    h = (4 / (D + 2)) ** (1 / (D + 4)) * bel.M ** (-1 / (D + 4))
    values, vectors = np.linalg.eigh(np.moveaxis(covariance(bel), (0, 1), (-2, -1)))
    root = vectors * np.sqrt(np.maximum(values, 0.0))[..., None, :]
    noise = np.einsum("...ij,j...m->i...m", root, draw_normal(bel.state.shape, rng))
    return _jitter(bel, h * noise, where)


def _fresh(bel: Particles, where: ArrayLike) -> NDArray[np.bool_]:
    """Which filters of the set to treat, after a check that they were just resampled."""
    batch = bel.log_w.shape[:-1]
    chosen = np.broadcast_to(np.asarray(where, dtype=bool), batch)
    if np.ptp(bel.log_w, axis=-1)[chosen].any():
        raise ParameterError(
            "noise on weighted particles would be process noise; resample first, or pass "
            "where=info.resampled"
        )
    return chosen


def _jitter(bel: Particles, noise: Array, where: NDArray[np.bool_]) -> Particles:
    """Move the chosen filters' particles; keep headings on the circle."""
    moved = bel.state + noise
    if len(moved) >= 3:
        moved[2] = wrap(moved[2])
    return Particles(np.where(where[..., None], moved, bel.state), bel.log_w)
