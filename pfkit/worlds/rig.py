"""The rig: what the numbers of a log mean.

Three rows of a measurement may be range, bearing and landmark, or something else; three rows of a
control may be a speed, a turn rate and a time, or a turn, a drive and a turn. Whoever guesses from
the number of rows guesses wrong one day, without a word. So a log that is to be localised *states*
what drove the robot and what it measured with, and where on the robot the sensor sits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from pfkit.errors import ParameterError, require_array, require_fields

SENSORS = {  # the rows of z; "laser" is a range and a bearing that belong to no landmark
    "range-bearing": ("range", "bearing", "landmark"),
    "range": ("range", "landmark"),
    "bearing": ("bearing", "landmark"),
    "laser": ("range", "bearing"),
}
ODOMETRY = {  # the rows of u
    "speeds": ("v", "omega", "dt"),
    "turns": ("rot1", "trans", "rot2"),
    "increments": ("dx", "dy", "dtheta"),
}


@dataclass(frozen=True)
class Rig:
    """A robot's odometry and its one sensor.

    Parameters
    ----------
    sensor : str
        "range-bearing", "range", "bearing" (landmarks) or "laser" (an occupancy grid).
    odometry : str
        What u holds: "speeds" (v, omega, dt), "turns" (rot1, trans, rot2) or "increments"
        (dx, dy, dtheta), the motion since the last instant in the frame of the pose then.
    named : bool
        Whether landmarks have names; else z lacks its last row.
    mount : (x, y, yaw), metres and radians
        Pose of the sensor on the robot.
    flipped : bool
        The sensor hangs upside down: its bearings run clockwise.
    r_max : float, metres, > 0
        A laser reading of r_max says that no wall is nearer.

    Raises
    ------
    ParameterError, ShapeError
        If a kind is not known, or a number is none.
    """

    sensor: str
    odometry: str = "speeds"
    named: bool = True
    mount: tuple[float, float, float] = (0.0, 0.0, 0.0)
    flipped: bool = False
    r_max: float = math.inf

    def __post_init__(self) -> None:
        for name, kinds in (("sensor", SENSORS), ("odometry", ODOMETRY)):
            if getattr(self, name) not in kinds:
                raise ParameterError(
                    f"{name} must be one of {', '.join(kinds)}, got {getattr(self, name)!r:.60}"
                )
        mount = require_array("mount", self.mount, (3,))
        object.__setattr__(self, "mount", tuple(mount.tolist()))
        require_fields(self, r_max="> 0")

    @property
    def rows(self) -> tuple[str, ...]:
        """What the rows of z are."""
        rows = SENSORS[self.sensor]
        return rows if self.named else tuple(name for name in rows if name != "landmark")
