r"""Driving: where the robot really goes.

A robot carries out commands imperfectly. Its true path is a draw from the motion model, step
by step,

.. math:: x_t \sim p(x_t \mid u_t, x_{t-1}) .

Commands come from a list (open loop) or from a driver who looks where the robot is
(`PurePursuit`). And now and then somebody lifts the robot and puts it down elsewhere. That is
the kidnapped robot problem: no control tells of it, and a filter that is sure of itself has no
particle where the robot is now.

The same density serves twice. Here it is drawn from once, for the robot; a filter draws from it
for every particle. The log holds the commands as they were *given*. Whoever follows them without
noise, by dead reckoning, leaves the true path just as fast as the model says.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import ParameterError, require_array, require_count
from pfkit.models.motion import MotionModel

Array = NDArray[np.float64]
Driver = Callable[[int, Array], ArrayLike]
Kidnap = Mapping[int, ArrayLike | None]


def drive(
    start: ArrayLike,
    u: ArrayLike | Driver,
    motion: MotionModel,
    rng: np.random.Generator,
    *,
    steps: int | None = None,
    kidnap: Kidnap | None = None,
    world: Any = None,
) -> tuple[Array, Array]:
    r"""Where the robot really went: :math:`x_t \sim p(x_t \mid u_t, x_{t-1})`.

    Parameters
    ----------
    start : array_like (D,) or (D, B, 1)
    u : array_like (n, T) or (n, T, B, 1), or a function (k, pose) -> (n, ...)
        Commands, or a driver who looks where the robot is, such as `PurePursuit`.
    motion : MotionModel
    rng : numpy.random.Generator
    steps : int
        How long a driver drives; not needed with commands.
    kidnap : mapping from step k to a pose (D,), or to None for anywhere in the world
        The robot is put there at the end of step k, and nobody tells it.
    world : map with ``sample_poses``, for kidnapping to None

    Returns
    -------
    u : array (n, T, ...), the controls that were given
    truth : array (D, T, ...)

    Raises
    ------
    ShapeError, ParameterError
        If start or u have the wrong shape, or a kidnapping has no step or no world.
    """
    pose = require_array("start", start, ("D",) if np.ndim(start) < 2 else ("D", "B", 1))
    driver, steps = _driver(u, steps)
    off = _kidnap_steps(kidnap, steps)
    controls, truth = [], []
    for k in range(steps):
        controls.append(np.asarray(driver(k, pose), dtype=float))
        moved = motion.sample(pose, controls[-1], rng)
        pose = require_array(
            "the moved pose (use u row by row: v, omega, dt = u)", moved, pose.shape
        )
        if k in off:
            pose = _carry_off(off[k], pose.shape, world, rng)
        truth.append(pose)
    return np.stack(controls, axis=1), np.stack(truth, axis=1)


def _driver(u: ArrayLike | Driver, steps: int | None) -> tuple[Driver, int]:
    """Commands and drivers alike as a function (k, pose), and the number of steps."""
    if callable(u):
        return u, require_count("steps (how long the driver drives)", steps)
    given = require_array("u", u, ("n", "T") if np.ndim(u) < 3 else ("n", "T", "B", 1))
    return lambda k, pose: given[:, k], given.shape[1]


def _kidnap_steps(kidnap: Kidnap | None, steps: int) -> Kidnap:
    wrong = [k for k in kidnap or {} if k not in range(steps)]
    if wrong:
        raise ParameterError(f"kidnap at step {wrong[0]}: the drive has steps 0 to {steps - 1}")
    return kidnap or {}


def _carry_off(
    goal: ArrayLike | None, shape: tuple[int, ...], world: Any, rng: np.random.Generator
) -> Array:
    """The pose after a kidnapping, in the shape of the pose before."""
    if goal is None:
        return world.sample_poses(shape[1:] or (1,), rng).reshape(shape)
    goal = require_array("kidnap pose", goal, shape[:1])
    return np.broadcast_to(goal.reshape(-1, *(1,) * (len(shape) - 1)), shape).copy()
