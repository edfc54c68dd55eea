"""What a robot recorded: controls, measurements, and (for scoring only) the truth.

Time runs in steps. Step k holds the control u that carried the robot from the previous
instant to t, the measurements z taken at t, and the true pose at t if somebody filmed it.
Most steps of a real log carry no measurement; then z has K = 0 columns.

A filter may look at t, u and z. The truth is there for the referee.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from pfkit.errors import DataError, require_array
from pfkit.worlds.rig import ODOMETRY, Rig


class Step(NamedTuple):
    """One instant of a log.

    Attributes
    ----------
    t : float, seconds
    u : array (n_u,), the control since the previous instant, as the motion model reads it
    z : array (n_z, K), the K measurements at t, as the sensor model reads them
    truth : array (3,) or None, the true pose at t
    """

    t: float
    u: NDArray[np.float64]
    z: NDArray[np.float64]
    truth: NDArray[np.float64] | None


@dataclass(frozen=True)
class Log:
    """A recorded (or simulated) drive; iterates as `Step`.

    Parameters
    ----------
    t : array (T,), seconds, never decreasing
    u : array (n_u, T) or, for a batch of B drives, (n_u, T, B, 1)
    z : sequence of T arrays (n_z, K), or (n_z, K, B, 1)
    truth : array (3, T) or (3, T, B, 1), optional
    start : array (3,) or (3, B, 1), optional
        The true pose before the first control.
    world : map
        Landmarks or grid on which z was measured.
    source : str
        Where the log came from, for tables and captions.
    outlier : sequence of T bool arrays (K,), optional
        True labels of false measurements, where they are known (simulations).
    scored : bool array (T,), optional
        Steps at which errors are to be scored; all if left out. A recorded log marks its
        odometry stamps, so that a score does not depend on when the sensor spoke.
    rig : Rig, optional
        What the rows of u and z mean; `localise` wants to know.
    notes : tuple of str
        What a reader mended or decided, a sentence each.

    Raises
    ------
    DataError
        If a value is not a finite number (truth may be NaN where nobody filmed), shapes or
        lengths do not belong together, or time runs backwards.
    """

    t: NDArray[np.float64]
    u: NDArray[np.float64]
    z: Sequence[NDArray[np.float64]]
    truth: NDArray[np.float64] | None = None
    start: NDArray[np.float64] | None = None
    world: Any = None
    source: str = ""
    outlier: Sequence[NDArray[np.bool_]] | None = field(default=None, repr=False)
    scored: NDArray[np.bool_] | None = field(default=None, repr=False)
    rig: Rig | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        T = np.size(self.t)
        shapes = dict(t=(T,), u=("n", T, ...), truth=("D", T, ...), start=(...,))
        for name, shape in shapes.items():
            value, rule = getattr(self, name), None if name == "truth" else "finite"
            if value is not None:
                object.__setattr__(self, name, require_array(name, value, shape, rule, DataError))
        if len(self.z) != T or any(getattr(zk, "ndim", 0) < 2 for zk in self.z):
            raise DataError(
                f"z must be a list of {T} arrays (n, K), one per step and one column for each "
                f"measurement, got {len(self.z)}: {self.z!r:.60}"
            )
        if self.scored is not None and len(self.scored) != T:
            raise DataError(f"log has {T} times but {len(self.scored)} of scored; align them")
        back = np.flatnonzero(np.diff(self.t) < 0)
        if back.size:
            raise DataError(f"time runs backwards after t = {self.t[back[0]]}; sort the log")
        if self.rig is not None:
            self._require_rows(self.rig)

    def _require_rows(self, rig: Rig) -> None:
        """The rows of u and z must be those that the rig states."""
        rows = {zk.shape[0] for zk in self.z if zk.shape[1]} - {len(rig.rows)}
        if rows:
            raise DataError(
                f"the sensor {rig.sensor} has {len(rig.rows)} rows ({', '.join(rig.rows)}), but z "
                f"has {rows.pop()}; state another sensor, or named=False"
            )
        if len(self.u) != len(ODOMETRY[rig.odometry]):
            raise DataError(
                f"odometry as {rig.odometry} has the rows {', '.join(ODOMETRY[rig.odometry])}, "
                f"but u has {len(self.u)}; state another"
            )

    def __len__(self) -> int:
        return len(self.t)

    def __iter__(self) -> Iterator[Step]:
        for k in range(len(self.t)):
            truth = None if self.truth is None else self.truth[:, k]
            yield Step(float(self.t[k]), self.u[:, k], self.z[k], truth)

    def __getitem__(self, part: slice) -> Log:
        """A stretch of the log, e.g. ``log[:500]``; its start is the truth before it, if known."""
        if not isinstance(part, slice) or part.step not in (None, 1):
            raise DataError(f"a log is cut by slices of step 1, got {part!r}; iterate for steps")
        first, _, _ = part.indices(len(self.t))
        start = self.start
        if first > 0:
            before = None if self.truth is None else self.truth[:, first - 1]
            start = None if before is None or np.isnan(before).any() else before
        return replace(
            self,
            t=self.t[part],
            u=self.u[:, part],
            z=self.z[part],
            truth=None if self.truth is None else self.truth[:, part],
            start=start,
            outlier=None if self.outlier is None else self.outlier[part],
            scored=None if self.scored is None else self.scored[part],
        )

    def first_measured(self) -> int:
        """The first step that measured something; `DataError` if there is none."""
        for k, zk in enumerate(self.z):
            if zk.shape[1]:
                return k
        raise DataError("the log holds no measurement of the map; there is nothing to localise by")

    def __repr__(self) -> str:
        span = self.t[-1] - self.t[0] if len(self) else 0.0
        K = sum(zk.shape[1] for zk in self.z)
        return f"Log({self.source or 'unnamed'}: {len(self)} steps, {span:.1f} s, {K} measurements)"
