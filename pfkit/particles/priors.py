r"""Priors: what is known before the first measurement.

A filter needs a first belief. The two that matter are the two ends of ignorance. *Uniform* over
the map: the robot has been switched on somewhere, which is global localisation. *Gaussian* about
a pose: somebody put the robot down and told it where, up to an error; that is tracking.

.. math:: x^{[m]} \sim \mathcal U(\text{map}) \qquad \text{or} \qquad
          x^{[m]} \sim \mathcal N(\mu, \Sigma), \qquad w^{[m]} = 1/M .

A prior that is narrower than the truth adds information that nobody has, and no measurement can
bring back a place where there is no particle.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.densities import draw_normal
from pfkit.errors import Shape, require_array, require_covariance
from pfkit.geometry import wrap
from pfkit.particles.particle_set import Particles, equal_log_weights


class SamplesPoses(Protocol):
    """A map that can draw poses uniformly over the places where the robot can be."""

    def sample_poses(self, shape: Shape, rng: np.random.Generator) -> NDArray[np.float64]:
        """Draw poses of some shape, components first, in metres and radians."""


def uniform_prior(M: Shape, world: SamplesPoses, rng: np.random.Generator) -> Particles:
    """Know nothing but the map: poses uniform over its free space, heading on the circle.

    Parameters
    ----------
    M : int or (B, M)
        Number of particles, or the shape of a batch.
    world : map with ``sample_poses(shape, rng)``
        `LandmarkMap` (its bounding box) or `OccupancyGrid` (its free cells).
    rng : numpy.random.Generator

    Returns
    -------
    Particles with equal weights

    Raises
    ------
    ParameterError
        If M is not a whole number of at least 1, or `world` cannot draw poses.

    Notes
    -----
    Source: Probabilistic Robotics, Table 8.2 and section 8.3.1 (global localisation).
    """
    log_w = equal_log_weights(M)
    return Particles(world.sample_poses(log_w.shape, rng), log_w)


def gaussian_prior(
    M: Shape, mean: ArrayLike, Sigma: ArrayLike, rng: np.random.Generator, heading: bool = True
) -> Particles:
    """Know the state up to a Gaussian error.

    Parameters
    ----------
    M : int or (B, M)
    mean : array_like (D,), metres and radians
    Sigma : array_like (D, D) covariance, or (D,) standard deviations, which may be 0
    rng : numpy.random.Generator
    heading : bool
        Whether the third component is a heading, to be wrapped.

    Returns
    -------
    Particles with equal weights

    Raises
    ------
    ShapeError, ParameterError
        If mean and Sigma do not match, or Sigma is not a covariance.
    """
    mean, log_w = require_array("mean", mean, ("D",)), equal_log_weights(M)
    D, shape = mean.size, log_w.shape
    values, vectors = np.linalg.eigh(require_covariance("Sigma", Sigma, D))
    root = vectors * np.sqrt(np.maximum(values, 0.0))
    noise = np.tensordot(root, draw_normal((D, *shape), rng), axes=1)
    state = mean.reshape(D, *(1,) * len(shape)) + noise
    if heading and D >= 3:
        state[2] = wrap(state[2])
    return Particles(state, log_w)
