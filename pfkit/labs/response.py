"""An experiment is judged by its response: to settings, and against the reference.

A constant at the right value, a coin with the right bias, half the size or another quantity all
look right at one setting. So the check chooses settings that the student did not see, runs the
student's function and the reference with the same random numbers, and asks whether the first
does what the second does: the same mean at every setting, the same scatter from run to run.

`each_setting` makes the outcomes, `same_mean` and `same_scatter` decide, `Counted` and `Watched`
see whether an experiment was made at all.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Outcomes = NDArray[np.float64]


def each_setting(
    f: Callable[..., Any], settings: Sequence[tuple], seed: int, runs: int
) -> Outcomes:
    """Outcomes of ``f(*setting, rng)``; the random numbers depend on ``seed`` alone.

    Returns
    -------
    array (runs, settings)

    Raises
    ------
    ValueError
        If a run does not give one finite number.
    """
    rng = np.random.default_rng(seed)
    seeds = rng.integers(2**63, size=(runs, len(settings)), dtype=np.int64)
    found = np.empty((runs, len(settings)))
    for i, k in np.ndindex(runs, len(settings)):
        value = np.asarray(f(*settings[k], np.random.default_rng(seeds[i, k])), dtype=float)
        if value.size != 1:
            raise ValueError(f"expected one number per run, got shape {value.shape}")
        found[i, k] = value.item()
    return found


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
        mean, wanted = x.mean(axis=0).T
        off = np.sign(mean - wanted) * np.maximum(np.abs(mean - wanted) - slack, 0)
        error = np.sqrt(x.var(axis=0, ddof=1).sum(axis=-1) / len(x)) + 1e-9 * (1 + np.abs(wanted))
        z = off / error
        if max(np.abs(z).max(), abs(z.sum()) / np.sqrt(z.size)) <= standard_errors:
            return True
        k = int(np.argmax(np.abs(z)))
        return f"setting {k + 1}: {mean[k]:.4g} on average, a right one {wanted[k]:.4g}"

    return holds


def same_scatter(ratio: float = 2.0) -> Callable[[Outcomes], Any]:
    """At each setting the runs scatter as those of the reference, within a factor.

    Where the reference does not scatter, the answer must not either.
    """

    def holds(x: Outcomes) -> Any:
        sd, wanted = x.std(axis=0, ddof=1).T
        tiny = 1e-9 * (1 + np.abs(x[..., 1]).max(axis=0))
        off = (sd > ratio * wanted + tiny) | (ratio * sd + tiny < wanted)
        if not off.any():
            return True
        k = int(np.argmax(off))
        return f"setting {k + 1}: sd {sd[k]:.3g} from run to run, a right one {wanted[k]:.3g}"

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
