r"""Settings: what a filter should assume of a log, by a procedure and not by the log's name.

**Where the first part of the log has a truth** (`calibrate_first`), everything is measured there.
Noise is the spread of the errors that calibration leaves (1.48 times the median deviation) times

.. math:: \sqrt{(1 + \rho) / (1 - \rho)} ,

with :math:`\rho` the correlation of consecutive errors of one landmark: errors that repeat tell
the same news many times, and a filter that takes them as independent must be told a wider sigma.
On MRCLAM data set 4, robot 3, that factor is 3.5 for ranges and 1.7 for bearings. The odometry's
drift is twice the variance that is left over windows of four seconds.

**Where there is none**, the landmarks' own extent is the yardstick: a range is believed to 1/24 of
the diagonal of the box about them, a bearing to 0.02 rad, a laser to two cells of its map (and its
beams count by half, since a wrong wall spoils several at once), and odometry to 14 cm and 13
degrees after a metre. Commands are not measurements: what is not calibrated must be paid for as
noise.

The errors have Student's t with four degrees of freedom, because one bar code that was misread must
not overrule everything else.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, ParameterError, require_array
from pfkit.logs.calibration import USUAL_DRIFT, Calibration, calibrate
from pfkit.logs.odometry import Drift
from pfkit.models.association import MaximumLikelihood
from pfkit.models.beams import BeamModel
from pfkit.models.landmark_sensors import Bearing, Range, RangeBearing
from pfkit.models.mounted import Mounted
from pfkit.models.robust import Tempered
from pfkit.models.sensors import Sensor
from pfkit.worlds.log import Log
from pfkit.worlds.maps import LandmarkMap
from pfkit.worlds.occupancy import OccupancyGrid
from pfkit.worlds.rig import Rig

Array = NDArray[np.float64]
NU = 4.0
RANGE_SHARE, LIMIT_SHARE = 1 / 24, 1 / 21  # of the diagonal of the landmarks' box
SIGMA_PHI = 0.02  # radians
PARTICLES = {  # for a known and for a global start
    "range-bearing": (1000, 5000),
    "range": (2000, 20000),
    "bearing": (2000, 10000),
    "laser": (1000, 5000),
}
BEAM_SHARES = {"z_hit": 0.8, "z_short": 0.05, "z_max": 0.05, "z_rand": 0.1}
BEAM_TRUST = 0.5  # the exponent of a scan: its beams are no independent witnesses
PER_SQUARE_METRE = 50  # particles of a laser's global start, on a large map


@dataclass(frozen=True)
class Settings:
    """What the filter assumes about one log.

    Parameters
    ----------
    drift : Drift
    sensor : Sensor
    M : (int, int), particles for a known and for a global start
    start_sd : (3,), metres and radians, of a "known" start
    limit : float, metres; an error below it counts as converged
    """

    drift: Drift
    sensor: Sensor
    M: tuple[int, int]
    start_sd: tuple[float, float, float]
    limit: float


def rig_of(log: Log) -> Rig:
    """The rig that a log states; `DataError` if it states none."""
    if log.rig is None:
        raise DataError(
            "the log does not say what its numbers mean; give it a rig, such as "
            "Log(..., rig=pf.Rig('range-bearing')) (--sensor range-bearing)"
        )
    return log.rig


def settings_for(
    log: Log,
    calibration: Calibration | None = None,
    sigma: ArrayLike | None = None,
    drift: Drift | None = None,
) -> Settings:
    """Settings for a log, by the procedure above.

    Parameters
    ----------
    log : Log with a rig and a map
    calibration : Calibration, optional
        What was measured in the log's first part.
    sigma : float or (sigma_r, sigma_phi), optional
        Noise of the measurements, metres and radians, instead of the procedure's.
    drift : Drift, optional

    Returns
    -------
    Settings

    Raises
    ------
    DataError, ParameterError
        If the log measured nothing, states no rig, or its map does not fit its sensor.
    """
    rig, fitted = rig_of(log), calibration or Calibration()
    log.first_measured()
    is_grid = isinstance(log.world, OccupancyGrid)
    if is_grid != (rig.sensor == "laser") or not isinstance(log.world, OccupancyGrid | LandmarkMap):
        raise ParameterError(
            f"a {rig.sensor} log needs {'an OccupancyGrid' if rig.sensor == 'laser' else 'a '}"
            f"{'' if rig.sensor == 'laser' else 'LandmarkMap'} as its map, got {log.world!r:.60}"
        )
    size = extent(log.world)
    limit = 0.5 if is_grid else float(f"{LIMIT_SHARE * size:.0e}")
    sigmas = _sigmas(log, rig, fitted, sigma)
    sensor = _seated(_sensor(log, rig, fitted, sigmas), rig, fitted)
    near = sigmas[0] / 20 if rig.sensor.startswith("range") else limit / 25
    heading = 0.02 if log.truth is None or np.isfinite(log.truth[2]).any() else 0.2
    M = PARTICLES[rig.sensor]
    if isinstance(log.world, OccupancyGrid):
        room = log.world.free.sum() * log.world.resolution**2
        M = (M[0], int(np.clip(PER_SQUARE_METRE * room, M[1], 10 * M[1])))
    return Settings(drift or fitted.drift or USUAL_DRIFT, sensor, M, (near, near, heading), limit)


def extent(world: LandmarkMap | OccupancyGrid) -> float:
    """The diagonal of the landmarks' box, or of a lone landmark's bounds, or of a grid, metres."""
    if isinstance(world, LandmarkMap):
        diagonal = float(np.hypot(*np.ptp(world.positions, axis=1)))
        if diagonal > 0:
            return diagonal
    x0, x1, y0, y1 = world.bounds
    return float(np.hypot(x1 - x0, y1 - y0))


def _sigmas(log: Log, rig: Rig, fitted: Calibration, given: ArrayLike | None) -> tuple[float, ...]:
    """Noise of a range and of a bearing; of a laser, the width of its walls."""
    usual = (RANGE_SHARE * extent(log.world), SIGMA_PHI)
    if rig.sensor == "laser":
        usual = (max(2 * log.world.resolution, 0.1), SIGMA_PHI)
    measured = [own or other for own, other in zip(fitted.sigma, usual, strict=True)]
    if given is None:
        return tuple(measured)
    own = require_array("sigma", given, (2,) if np.size(given) > 1 else (...,), "finite and > 0")
    if rig.sensor == "bearing" and own.size == 1:
        return measured[0], float(own.reshape(-1)[0])
    return (*own.reshape(-1).tolist(), measured[1])[:2]


def _sensor(log: Log, rig: Rig, fitted: Calibration, sigmas: tuple[float, ...]) -> Sensor:
    """The model of what the rig measures, before it is seated on the robot."""
    sigma_r, sigma_phi = sigmas
    if rig.sensor == "laser":
        reach = rig.r_max if np.isfinite(rig.r_max) else extent(log.world)
        return Tempered(BeamModel(log.world, [0.0], reach, sigma_r, **BEAM_SHARES), BEAM_TRUST)
    sensor: RangeBearing | Range | Bearing
    if rig.sensor == "range-bearing":
        sensor = RangeBearing(log.world, sigma_r, sigma_phi, NU, fitted.bearing_bias)
    elif rig.sensor == "bearing":
        sensor = Bearing(log.world, sigma_phi, NU, fitted.bearing_bias)
    else:
        sensor = Range(log.world, sigma_r, fitted.range_bias, NU)
    return sensor if rig.named else MaximumLikelihood(sensor)


def _seated(sensor: Sensor, rig: Rig, fitted: Calibration) -> Sensor:
    """The sensor where it sits: as fitted, else as the rig says."""
    mount = rig.mount if fitted.mount is None else fitted.mount
    if not any(mount) and not rig.flipped:
        return sensor
    return Mounted(sensor, mount, rig.flipped)


def calibrate_first(log: Log, seconds: float) -> Calibration:
    """Calibrate on the first seconds of a log.

    Raises
    ------
    ParameterError
        If `seconds` is not positive.
    DataError
        If these seconds hold too little driving, measuring or truth.
    """
    if not seconds > 0:
        raise ParameterError(f"seconds to calibrate on must be > 0, got {seconds}")
    part = log[: int(np.searchsorted(log.t, log.t[0] + seconds))]
    if len(part) == 0 or not any(zk.shape[1] for zk in part.z):
        raise DataError(f"nothing is measured in the first {seconds:g} s; calibrate on more")
    return calibrate(part)
