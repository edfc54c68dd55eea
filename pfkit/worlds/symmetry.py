r"""Symmetry: poses that no measurement can tell apart.

A rigid motion g that maps the set of landmarks onto itself is a *symmetry* of the map. If the
landmarks have no names, a robot at x and one at :math:`g \oplus x` measure the same,

.. math:: p(z \mid g \oplus x) = p(z \mid x) ,

and they go on doing so when both drive by the same commands. Then a belief that starts out
symmetric must stay symmetric: with G symmetries the exact posterior keeps G hypotheses of
equal mass for ever. A particle filter does not. Resampling shuffles mass between the clusters
until one holds all; `genealogy` says how soon.

Mirror images do not count. A mirrored world has the same ranges, but left and right change
places, so bearings have the wrong sign: a square has four hypotheses, not eight.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ParameterError, require_array, require_number
from pfkit.geometry import compose, wrap
from pfkit.particles.particle_set import Particles
from pfkit.worlds.maps import LandmarkMap

Array = NDArray[np.float64]


def symmetries(world: LandmarkMap, tolerance: float = 1e-6, mirror: bool = False) -> Array:
    r"""All rigid motions that map the landmarks onto themselves, by brute force.

    .. math:: \{\, g : \{g \oplus m_i\} = \{m_i\} \,\}

    Two landmarks fix a motion. So we send the first two to every ordered pair at the same
    distance, and keep the motions that send every landmark to some landmark.

    Parameters
    ----------
    world : LandmarkMap with at least two landmarks
    tolerance : float, > 0, metres
    mirror : bool
        Look for reflections instead: motions of the world's mirror image (x, -y).

    Returns
    -------
    g : array (3, G); without `mirror` the first is the identity

    Raises
    ------
    ParameterError
        If there is one landmark only: then every turn about it is a symmetry. Or if two stand
        at the same place.

    Notes
    -----
    O(L^4) in the worst case: 40 landmarks take some milliseconds.
    """
    require_number("tolerance", tolerance, "> 0")
    m = world.positions[0] + 1j * world.positions[1]
    apart = np.abs(m[:, None] - m)
    if np.count_nonzero(apart < tolerance) > m.size:
        raise ParameterError(f"two landmarks are less than {tolerance} m apart; merge them")
    source = m.conj() if mirror else m
    side = source[1] - source[0]
    i, j = np.nonzero(np.abs(apart - np.abs(side)) < tolerance)
    keep = i != j
    i, j = i[keep], j[keep]
    turn = (m[j] - m[i]) / side
    turn /= np.abs(turn)
    shift = m[i] - turn * source[0]
    images = turn[:, None] * source + shift[:, None]
    gap = np.abs(images[:, :, None] - m).min(axis=2).max(axis=1)
    good = gap < 2 * tolerance
    g = np.stack((shift.real, shift.imag, np.angle(turn)))[:, good]
    g = g[:, np.argsort(np.abs(g[2]), kind="stable")]
    return g


def images(pose: ArrayLike, g: ArrayLike) -> Array:
    r"""The copies of a pose under each of G symmetries: :math:`g_i \oplus x`.

    Parameters
    ----------
    pose : array_like (3, ...)
    g : array_like (3, G), of `symmetries`

    Returns
    -------
    array (3, G, ...)

    Raises
    ------
    ParameterError, ShapeError
        If a pose or a motion does not have three finite components.
    """
    pose, g = require_array("pose", pose, (3, ...)), require_array("g", g, (3, ...))
    return compose(g.reshape(3, -1, *(1,) * (pose.ndim - 1)), pose[:, None])


def hypothesis_mass(bel: Particles, poses: ArrayLike, radius: float, angle: float = np.pi) -> Array:
    r"""How much of the belief lies near each of several candidate poses.

    .. math:: \mu_h = \sum_m w_m\, [\,\|x_m - x_h\| < r
                      \ \text{and}\ |\mathrm{wrap}(\theta_m - \theta_h)| \le a\,]

    A hypothesis is *alive* while its mass is above some floor, say 1 %. In a symmetric world
    the candidates are the truth and its mirror images under `symmetries`.

    Parameters
    ----------
    bel : Particles with state (3, M) or (3, B, M)
    poses : array_like (3, H), or (3, H, B) with different candidates per run
    radius : float, > 0, metres
    angle : float, > 0, radians
        Largest heading difference; pi ignores the heading.

    Returns
    -------
    array (H,) or (H, B), between 0 and 1

    Raises
    ------
    ParameterError, ShapeError
        If a pose is not finite, or a radius is not positive.
    """
    batch = bel.log_w.shape[:-1] if np.ndim(poses) > 2 else ()
    poses = require_array("poses", poses, (3, "H", *batch))
    require_number("radius", radius, "> 0")
    require_number("angle", angle, "> 0")
    missing = bel.state.ndim - poses.ndim + 1
    candidates = poses.reshape(poses.shape + (1,) * missing)
    dx, dy, turn = bel.state[:3, None] - candidates
    near = (dx * dx + dy * dy < radius * radius) & (np.abs(wrap(turn)) <= angle)
    return np.sum(near * bel.w, axis=-1)
