r"""The histogram filter in one dimension: a belief as one number per cell.

Cut a corridor into n cells and write down the probability of each. That list *is* the belief,
and both lines of the Bayes filter become sums that can be done by hand:

.. math:: \overline{bel}_i = \sum_j p(x_i \mid u, x_j)\, bel_j, \qquad
          bel_i = \eta\, p(z \mid x_i)\, \overline{bel}_i .

The first line spreads: a robot that was told to move two cells may have moved one or three.
When every cell spreads in the same way, the sum is a convolution with a *kernel*, the
probabilities of moving by -1, 0, 1, 2, ... cells. The second line sharpens: cells that explain
the measurement gain. Its normaliser is not a nuisance: :math:`1/\eta` is the probability of
the measurement itself, the *evidence*.

Nothing here is random and nothing is approximated but the cells. That is the strength of the
histogram, and its price: cells multiply with every dimension. `posegrid` pays it for a robot
with a heading; particles avoid it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import (
    DegenerateWeightsError,
    ParameterError,
    Pattern,
    ShapeError,
    require_array,
    require_number,
)

Array = NDArray[np.float64]


def shift_kernel(u: int, undershoot: float = 0.0, overshoot: float = 0.0) -> Array:
    r"""Probabilities of moving by a number of cells, when told to move u of them.

    .. math:: p(u) &= 1 - p_{under} - p_{over} \\
              p(u \mp 1) &= p_{under},\; p_{over} \text{ (short of, beyond the goal)}

    Parameters
    ----------
    u : int, cells; negative moves towards cell 0, 0 stands still
    undershoot, overshoot : float in [0, 1]
        Probability of stopping one cell short of, or beyond, the goal. For u = 0 they are one
        cell towards 0 and one cell away from it.

    Returns
    -------
    array (2 k + 1,) with k = abs(u) + 1: entry k + s is the probability of moving by s cells

    Raises
    ------
    ParameterError
        If u is not a whole number, or the two probabilities do not leave room for the rest.
    """
    undershoot = require_number("undershoot", undershoot, "in [0, 1]")
    overshoot = require_number("overshoot", overshoot, "in [0, 1]")
    if undershoot + overshoot > 1:
        raise ParameterError(
            f"undershoot + overshoot must be <= 1, got {undershoot + overshoot}; lower one of them"
        )
    k = abs(int(u)) + 1
    forward = -1 if u < 0 else 1
    kernel = np.zeros(2 * k + 1)
    kernel[k + u - forward] = undershoot
    kernel[k + u] = 1 - undershoot - overshoot
    kernel[k + u + forward] = overshoot
    return kernel


def predict_1d(bel: ArrayLike, kernel: ArrayLike, ring: bool = False) -> Array:
    r"""Move a belief by a kernel: a convolution.

    .. math:: \overline{bel}_i = \sum_s k_s\, bel_{i - s}

    Parameters
    ----------
    bel : array_like (..., n), probabilities of the cells
    kernel : array_like (2 k + 1,)
        Entry k + s is the probability of moving by s cells; see `shift_kernel`.
    ring : bool
        What happens at the ends. False: walls, the robot stops in the last cell. True: the
        corridor is a ring and the robot comes back at the other end.

    Returns
    -------
    array (..., n)

    Raises
    ------
    ShapeError, ParameterError
        If bel or kernel is not a list of probabilities, or the kernel has no middle.

    Notes
    -----
    Source: Probabilistic Robotics, Table 4.1, line 3. Cost O(n (2 k + 1)).
    """
    bel, kernel = _probabilities("bel", bel), _probabilities("kernel", kernel, ("n",))
    if kernel.size % 2 == 0:
        raise ShapeError(
            f"kernel must have an odd length, its middle for 'no move', got {kernel.shape}"
        )
    n, k = bel.shape[-1], kernel.size // 2
    moved = np.zeros_like(bel.T)  # cells first
    for s in range(-k, k + 1):
        target = np.arange(n, dtype=np.int64) + s
        target = target % n if ring else np.clip(target, 0, n - 1)
        np.add.at(moved, target, kernel[k + s] * bel.T)
    return moved.T


def update_1d(bel: ArrayLike, likelihood: ArrayLike) -> tuple[Array, Array | np.float64]:
    r"""Weigh every cell by the likelihood of the measurement: Bayes' rule.

    .. math:: bel_i = \frac{p(z \mid x_i)\, \overline{bel}_i}{\sum_j p(z \mid x_j)\,
              \overline{bel}_j}

    Parameters
    ----------
    bel : array_like (..., n), probabilities of the cells
    likelihood : array_like (..., n), p(z | cell), >= 0; it need not sum to one

    Returns
    -------
    bel : array (..., n)
    evidence : float or array (...)
        The denominator: the probability (or density) of this measurement.

    Raises
    ------
    DegenerateWeightsError
        If the measurement is impossible in every cell that the belief allows.
    ShapeError, ParameterError
        If there is not one likelihood >= 0 for each cell.

    Notes
    -----
    Source: Probabilistic Robotics, Table 4.1, line 4.
    """
    bel = _probabilities("bel", bel)
    cells = (..., bel.shape[-1])
    likelihood = require_array("likelihood", likelihood, cells, "finite and >= 0")
    joint = likelihood * bel
    evidence = joint.sum(axis=-1, keepdims=True)
    if not (evidence > 0).all():
        raise DegenerateWeightsError(
            "the measurement has probability 0 in every cell the belief allows; "
            "give the sensor a false-alarm rate above 0, or start from a wider belief"
        )
    return joint / evidence, evidence[..., 0]


def door_likelihood(doors: ArrayLike, z: bool, hit: float, false: float) -> Array:
    r"""What a door detector says about each cell.

    .. math:: p(z = 1 \mid \text{door}) &= p_{hit}, \qquad
              p(z = 1 \mid \text{wall}) = p_{false}, \\ p(z = 0 \mid x) &= 1 - p(z = 1 \mid x)

    Parameters
    ----------
    doors : array_like (n,) of bool, which cells have a door
    z : bool, what the detector reported
    hit : float in [0, 1], how often it sees a door that is there
    false : float in [0, 1], how often it sees a door that is not

    Returns
    -------
    array (n,), p(z | cell). With hit = false it is the same everywhere: nothing is learned.

    Raises
    ------
    ParameterError
        If doors or z are not True and False, or a rate is not in [0, 1].
    """
    hit = require_number("hit", hit, "in [0, 1]")
    false = require_number("false", false, "in [0, 1]")
    doors, report = np.asarray(doors), np.asarray(z)
    if doors.ndim != 1 or doors.size == 0 or not np.isin(doors, (0, 1)).all():
        raise ParameterError(f"doors must be a list of True and False, got {doors!r:.80}")
    if report.ndim or report not in (0, 1):
        raise ParameterError(f"z must be True (a door) or False (none), got {z!r:.80}")
    p_door = np.where(doors.astype(bool), hit, false)
    return p_door if z else 1 - p_door


def _probabilities(name: str, value: ArrayLike, shape: Pattern = (..., "n")) -> Array:
    """Check that the last axis holds probabilities that sum to one."""
    p = require_array(name, value, shape, "finite and >= 0")
    if not np.allclose(p.sum(axis=-1), 1.0, atol=1e-9):
        raise ParameterError(
            f"{name} must sum to 1, got {p.sum(axis=-1).flat[0]:.6g}; divide it by its sum"
        )
    return p
