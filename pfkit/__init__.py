"""pfkit: particle filters for robot localisation, small and readable.

``import pfkit as pf`` gives every name of the core (layers L0 to L5). The core needs NumPy
and the standard library only, so that the same code runs in Jupyter, in the tests and in the
page. `pfkit.plotting`, `pfkit.widgets`, `pfkit.explore` and `pfkit.labs` are imported by name.
"""

# L0: the ground
from pfkit.errors import (
    DataError,
    DegenerateWeightsError,
    ParameterError,
    PfkitError,
    ShapeError,
    UnknownLandmarkError,
)
from pfkit.chi2 import chi2_quantile, chi2_tail
from pfkit.geometry import between, circular_mean, compose, inverse, wrap

# L1: beliefs, logs, maps, resampling
from pfkit.particles import Particles, equal_log_weights, ess, from_weights, normalise
from pfkit.priors import gaussian_prior, uniform_prior
from pfkit.log import Log, Step
from pfkit.maps import LandmarkMap
from pfkit.occupancy import OccupancyGrid
from pfkit.distance import distance_field
from pfkit.raycast import RayCaster
from pfkit.resampling import SCHEMES, multinomial, residual, stratified, systematic
from pfkit.roulette import roulette_wheel
from pfkit.survival import survival_probability
from pfkit.triggers import ess_below, every, information, on_information
from pfkit.genealogy import (
    Genealogy,
    ancestry,
    coalescence_time,
    count_distinct,
    drift_time,
    founders,
    offspring_z,
)

# L2: models, answers
from pfkit.motion import MotionModel, VelocityMotion, drive_arc
from pfkit.odometry_motion import OdometryMotion, odometry_control
from pfkit.targets import CircleTarget, FixedTarget, HeadingTarget, LineTarget
from pfkit.wheels import Bicycle, DifferentialDrive
from pfkit.sensors import Compass, Position, Sensor, SensorModel, log_gaussian
from pfkit.landmark_sensors import Bearing, Range, RangeBearing
from pfkit.association import MaximumLikelihood
from pfkit.beams import BeamModel
from pfkit.beam_fit import fit_beams
from pfkit.likelihood_field import LikelihoodField
from pfkit.intermittent import Intermittent
from pfkit.robust import Gate, OutlierMixture, Tempered
from pfkit.estimators import covariance, map_particle, mean_pose, top_share_mean
from pfkit.density import kde, silverman_bandwidth
from pfkit.modes import Clusters, clusters

# L3: filters
from pfkit.filters import Info, predict, resample, select, step, update
from pfkit.history import History, run
from pfkit.recovery import Memory, augmented_step, inject, poses_seeing
from pfkit.kld import kld_bound, kld_count, kld_step
from pfkit.roughening import regularise, roughen
from pfkit.histogram import door_likelihood, predict_1d, shift_kernel, update_1d
from pfkit.posegrid import PoseGrid, gaussian_grid, uniform_grid
from pfkit.gridfilter import predict_by_convolution, predict_by_transport, update_grid
from pfkit.oracle import Divergence, equal_mass_boxes, kl_divergence, refinement
from pfkit.kalman import Gaussian, kalman_predict, kalman_update
from pfkit.gaussian import gaussian_predict, gaussian_update, linearise, unscented
from pfkit.smoother import GaussianHistory, rts_smooth, run_gaussian
from pfkit.tempering import tempered_update

# L4: simulation, data, judgement
from pfkit import worlds
from pfkit.diagnostics import (
    dead_reckoning,
    heading_rmse,
    pose_error,
    position_error,
    rmse,
    settle_time,
    trace,
)
from pfkit.comparison import (
    Comparison,
    Interval,
    bootstrap_interval,
    compare,
    paired,
    root_mean_square,
    wilson_interval,
)
from pfkit.table import summarise, tabulate
from pfkit.consistency import coverage, nees, nees_band
from pfkit.symmetry import hypothesis_mass, images, symmetries
from pfkit.faults import Outliers, Sight
from pfkit.odometry import ComposedMotion, Drift, Odometer, compose_odometry, fill_in
from pfkit.calibration import Calibration, calibrate
from pfkit.datasets import load_log, load_mrclam, load_plaza
from pfkit.routes import PurePursuit, commands
from pfkit.logfile import read_log, save_log
from pfkit.driving import drive
from pfkit.simulate import sense, simulate_log

# L5: studies
from pfkit import study

__version__ = "0.1.0"
