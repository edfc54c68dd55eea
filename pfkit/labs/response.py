"""An experiment is judged by its response: to settings, and against the reference.

A constant at the right value, a coin with the right bias, half the size or another quantity all
look right at one setting. So the check chooses settings that the student did not see, runs the
student's function and the reference with the same random numbers, and asks whether the first
does what the second does: the same mean at every setting, the same scatter from run to run.

A right answer that draws its random numbers in another order scatters by itself, and then the means
are compared. One that draws them in the same order goes with the reference run by run, and then the
differences of the runs are: they show what is nearly right, as a plain mean for a weighted one.

`each_setting` makes the outcomes, `same_mean` and `same_scatter` decide, `Counted` and `Watched`
see whether an experiment was made at all, `calls` whether an answer only calls what it should
write.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from types import FrameType
from typing import Any

import numpy as np
from numpy.typing import NDArray

Outcomes = NDArray[np.float64]

TOGETHER = 0.7  # correlation from which on two programs count as going together run by run
LEAST = 0.2  # share of the standard error of independent runs that a difference keeps


def each_setting(
    f: Callable[..., Any],
    settings: Sequence[tuple],
    seed: int,
    runs: int,
    together: bool = False,
) -> Outcomes:
    """Outcomes of ``f(*setting, rng)``; the random numbers depend on ``seed`` alone.

    Parameters
    ----------
    together : bool
        ``f(*setting, rng, runs)`` makes all runs side by side: (runs,) numbers, or rows of them.

    Returns
    -------
    array (runs, settings), or (runs, settings, rows)

    Raises
    ------
    ValueError
        If a run does not give one finite number, or not as many rows as another.
    """
    rng = np.random.default_rng(seed)
    seeds = rng.integers(2**63, size=(runs, len(settings)), dtype=np.int64)
    if together:
        return np.stack(
            [
                _side_by_side(f(*setting, np.random.default_rng(seeds[0, k]), runs), runs)
                for k, setting in enumerate(settings)
            ],
            axis=1,
        )
    found = np.empty((runs, len(settings)))
    for i, k in np.ndindex(runs, len(settings)):
        value = np.asarray(f(*settings[k], np.random.default_rng(seeds[i, k])), dtype=float)
        if value.size != 1:
            raise ValueError(f"expected one number per run, got shape {value.shape}")
        found[i, k] = value.item()
    return found


def _side_by_side(found: Any, runs: int) -> Outcomes:
    """Numbers (runs,) or (rows, runs), the runs first."""
    x = np.asarray(found, dtype=float)
    if x.ndim not in (1, 2) or x.shape[-1] != runs:
        raise ValueError(f"expected one number for each of {runs} runs, got shape {x.shape}")
    return np.moveaxis(x, -1, 0)


def distance(x: Outcomes, slack: float = 0.0) -> NDArray[np.float64]:
    """Difference of the means of a pair of outcomes (runs, ..., 2), in its standard errors."""
    mean, wanted = np.moveaxis(x.mean(axis=0), -1, 0)
    off = np.sign(mean - wanted) * np.maximum(np.abs(mean - wanted) - slack, 0)
    return off / _standard_error(x)


def _standard_error(x: Outcomes) -> NDArray[np.float64]:
    """Of the difference of the means, with a hair for outcomes that do not scatter.

    Two independent programs correlate by `TOGETHER` in fewer than one in 10,000 checks of 30 runs.
    """
    hair = 1e-9 * (1 + np.abs(x[..., 1].mean(axis=0)))
    own = x.var(axis=0, ddof=1)
    apart = own.sum(axis=-1)
    paired = np.diff(x, axis=-1)[..., 0].var(axis=0, ddof=1)
    go_together = apart - paired > 2 * TOGETHER * np.sqrt(own.prod(axis=-1))
    variance = np.where(go_together, np.maximum(paired, LEAST**2 * apart), apart)
    return np.sqrt(variance / len(x)) + hair


def _in_all(x: Outcomes, z: NDArray[np.float64]) -> float:
    """The differences of all settings and rows together; rows of one run may vary together."""
    sums = (x / _standard_error(x)[..., None]).reshape(len(x), -1, 2).sum(axis=1)
    return float(abs(z.sum()) / max(_standard_error(sums), 1.0))


def _place(at: NDArray[np.float64]) -> tuple[tuple[int, ...], str]:
    """Where the largest value stands: its index, and ``setting 2, row 1``."""
    index = tuple(int(k) for k in np.unravel_index(int(np.argmax(at)), at.shape))
    return index, f"setting {index[0] + 1}" + "".join(f", row {k + 1}" for k in index[1:])


def same_mean(standard_errors: float = 4.5, slack: float = 0.0) -> Callable[[Outcomes], Any]:
    """The means agree, within standard errors of their difference: at each setting, and in all.

    The second test adds up the differences of all settings, so that an answer which is off by a
    little everywhere is seen as well.

    Parameters
    ----------
    standard_errors : float
    slack : float
        Absolute difference of means that is accepted besides.
    """

    def holds(x: Outcomes) -> Any:
        z = distance(x, slack)
        if max(np.abs(z).max(), _in_all(x, z)) <= standard_errors:
            return True
        index, place = _place(np.abs(z))
        mean, wanted = x.mean(axis=0)[index]
        return f"{place}: {mean:.4g} on average, a right one {wanted:.4g}"

    return holds


def same_scatter(ratio: float = 2.0) -> Callable[[Outcomes], Any]:
    """At each setting the runs scatter as those of the reference, within a factor.

    Where the reference does not scatter, the answer must not either.
    """

    def holds(x: Outcomes) -> Any:
        sd, wanted = np.moveaxis(x.std(axis=0, ddof=1), -1, 0)
        tiny = 1e-9 * (1 + np.abs(x[..., 1]).max(axis=0))
        off = (sd > ratio * wanted + tiny) | (ratio * sd + tiny < wanted)
        if not off.any():
            return True
        index, place = _place(off)
        return f"{place}: sd {sd[index]:.3g} from run to run, a right one {wanted[index]:.3g}"

    return holds


class Counted:
    """A function that counts its calls: hand it to an experiment that must use it.

    Attributes
    ----------
    calls : int
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function, self.calls = function, 0

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        self.calls += 1
        return self._function(*args, **kwargs)


class Watched:
    """An object of which every method call is counted, by name.

    Attributes
    ----------
    calls : dict of str to int
    """

    def __init__(self, thing: Any) -> None:
        self._thing = thing
        self.calls: dict[str, int] = {}

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._thing, name)
        if not callable(found) or name.startswith("__"):
            return found

        def called(*args: Any, **kwargs: Any) -> Any:
            self.calls[name] = self.calls.get(name, 0) + 1
            return found(*args, **kwargs)

        return called


def calls(run: Callable[[], Any], *things: Any) -> bool:
    """Does ``run()`` reach the module of one of these functions or classes, under whatever name?

    What is written oneself must not be a call of what stands in the library.
    """
    found, modules = False, {thing.__module__ for thing in things}

    def look(frame: FrameType, event: str, _: Any) -> None:
        nonlocal found
        found = found or (event == "call" and frame.f_globals.get("__name__") in modules)

    before = sys.getprofile()
    sys.setprofile(look)
    try:
        run()
    finally:
        sys.setprofile(before)
    return found
