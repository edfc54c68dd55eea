r"""Triggers: when to resample.

Resampling spends diversity. It pays when many particles carry next to no weight, and it only
costs when they all still count. So a filter asks first, and a trigger is the question: a
function ``trigger(bel, k)`` of the weighted belief and the number k of the step, counted from
0, that answers yes or no (for a batch: one answer per filter).

=====================  =========================================================
`ess_below`            the effective sample size has fallen below a share of M
`every`                each n-th step, whatever the weights say
`on_information`       the weights have gathered enough information
=====================  =========================================================

The information is that of the weights over equal weights,

.. math:: \mathrm{KL}(w \,\|\, 1/M) = \log M + \sum_m w_m \log w_m \quad\text{nats},

zero after a resampling and log M when one particle holds everything. :math:`M e^{-KL}` counts
particles as the ESS does, but a few heavy weights frighten it less.

Whatever the trigger says, `step` never resamples after a step without a measurement:
nothing was learnt, and copies would be lost for nothing.

Hand a trigger to `step` or `history.run` as `threshold`; a plain number x there is
short for ``ess_below(x)``.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import require_count, require_number
from pfkit.particles.particle_set import Particles

Trigger = Callable[[Particles, int], "bool | np.bool_ | NDArray[np.bool_]"]


def ess_below(share: float = 0.5) -> Trigger:
    r"""Resample when :math:`\mathrm{ESS} < \text{share} \cdot M`.

    Parameters
    ----------
    share : float in [0, 1]
        0 never resamples; 1 resamples as soon as the weights differ.

    Returns
    -------
    function (bel, k) -> bool, or bool (B,) for a batch

    Raises
    ------
    ParameterError
        If the share is not in [0, 1].

    Notes
    -----
    Source: J. S. Liu and R. Chen, JASA 93 (1998).
    """
    share = require_number("share", share, "in [0, 1]")
    return lambda bel, k: bel.ess < share * bel.M


def every(n: int) -> Trigger:
    """Resample at each n-th step (steps n-1, 2n-1, ... counted from 0), blind to the weights.

    Parameters
    ----------
    n : int, at least 1

    Returns
    -------
    function (bel, k) -> bool

    Raises
    ------
    ParameterError
        If n is not a whole number of at least 1.
    """
    n = require_count("n", n)
    return lambda bel, k: (k + 1) % n == 0


def on_information(nats: float) -> Trigger:
    r"""Resample when the weights hold more than so many nats over equal weights.

    .. math:: \log M + \sum_m w_m \log w_m > \text{nats}

    Parameters
    ----------
    nats : float, at least 0
        log 2 = 0.69 is the information of one fair coin: half the particles ruled out.

    Returns
    -------
    function (bel, k) -> bool, or bool (B,) for a batch

    Raises
    ------
    ParameterError
        If nats is negative or not finite.
    """
    level = require_number("nats", nats, "finite and >= 0")
    return lambda bel, k: information(bel) > level


def information(bel: Particles) -> NDArray[np.float64] | np.float64:
    r"""Information in the weights over equal weights.

    .. math:: \mathrm{KL}(w \,\|\, 1/M) = \log M + \sum_m w_m \log w_m

    Parameters
    ----------
    bel : Particles

    Returns
    -------
    float or (B,), nats, between 0 and log M

    Raises
    ------
    ParameterError
        If `bel` is not a particle set.
    """
    w = bel.w
    gained = np.where(w > 0, w * (np.where(w > 0, bel.log_w, 0.0) + np.log(bel.M)), 0.0)
    return np.maximum(gained.sum(axis=-1), 0.0)
