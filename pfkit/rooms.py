"""The rooms of the package: the one table that says which module stands where, and what it offers.

A module imports only from modules that stand before it, so the table can be read from top to
bottom. The core (every room of `CORE`) needs NumPy and the standard library only. What else a part
of the edge may import stands beside it.

From this table follow the names of ``import pfkit as pf``, its stub for editors, the pages that
describe the package, what a page of the book loads, and the test that reads every import.
`tools/rooms.py` writes what is written.
"""

from __future__ import annotations

# Room -> module -> the names that `pf` offers from it.
CORE: dict[str, dict[str, str]] = {
    "ground": {
        "errors": (
            "DataError DegenerateWeightsError ParameterError PfkitError ShapeError "
            "UnknownLandmarkError"
        ),
        "geometry": "between circular_mean compose inverse resultant_length wrap",
        "densities": "chi2_quantile chi2_tail log_gaussian",
    },
    "particles": {
        "particles.particle_set": "Particles equal_log_weights ess from_weights normalise",
        "particles.priors": "gaussian_prior uniform_prior",
        "particles.ticks": "",
        "particles.resampling": "SCHEMES multinomial residual stratified systematic",
        "particles.resampling_wheel": "resampling_wheel",
        "particles.survival": "survival_probability",
        "particles.genealogy": (
            "Genealogy ancestry coalescence_time count_distinct drift_time founders offspring_z"
        ),
        "particles.triggers": "ess_below every information on_information",
        "particles.estimators": "covariance map_particle mean_pose top_share_mean",
        "particles.density": "kde silverman_bandwidth",
        "particles.modes": "Clusters clusters",
        "particles.roughening": "regularise roughen",
    },
    "worlds": {
        "worlds.rig": "Rig",
        "worlds.log": "Log Step",
        "worlds.maps": "LandmarkMap",
        "worlds.map_files": "",
        "worlds.occupancy": "OccupancyGrid",
        "worlds.distance": "distance_field",
        "worlds.raycast": "RayCaster",
        "worlds.symmetry": "hypothesis_mass images symmetries",
        "worlds.arenas": "",
    },
    "models": {
        "models.motion": "MotionModel VelocityMotion drive_arc inverse_arc",
        "models.odometry_motion": "OdometryMotion odometry_control",
        "models.increments": "IncrementMotion increments",
        "models.wheels": "Bicycle DifferentialDrive",
        "models.targets": "CircleTarget FixedTarget HeadingTarget LineTarget",
        "models.sensors": "Compass Position Sensor SensorModel",
        "models.landmark_sensors": "Bearing Range RangeBearing",
        "models.association": "MaximumLikelihood",
        "models.beams": "BeamModel",
        "models.beam_fit": "fit_beams",
        "models.likelihood_field": "LikelihoodField",
        "models.robust": "Gate OutlierMixture Tempered",
        "models.masked": "Masked",
        "models.mounted": "Mounted",
    },
    "filters": {
        "filters.particle_filter": "Info predict resample step take update",
        "filters.recovery": "Memory augmented_step inject poses_seeing",
        "filters.tempering": "tempered_update",
        "filters.history": "History run",
        "filters.kld": "kld_bound kld_count kld_step",
    },
    "exact": {
        "exact.histogram": "door_likelihood predict_1d shift_kernel update_1d",
        "exact.posegrid": "PoseGrid gaussian_grid uniform_grid",
        "exact.gridfilter": "predict_by_convolution predict_by_transport update_grid",
        "exact.divergence": "Divergence equal_mass_boxes kl_divergence refinement",
        "exact.kalman": "Gaussian kalman_predict kalman_update",
        "exact.gaussian": "gaussian_predict gaussian_update linearise unscented",
        "exact.smoother": "GaussianHistory rts_smooth run_gaussian",
    },
    "logs": {
        "logs.odometry": "ComposedMotion Drift Preintegrated preintegrate fill_in",
        "logs.headings": "face_course",
        "logs.datasets.text": "",
        "logs.datasets.timeline": "",
        "logs.logfile": "read_log save_log",
        "logs.datasets": "load_log load_mrclam load_plaza",
        "logs.routes": "PurePursuit commands",
        "logs.driving": "drive",
        "logs.faults": "Outliers FieldOfView",
        "logs.simulate": "sense simulate_log",
        "logs.least_squares": "",
        "logs.seat": "",
        "logs.calibration": "Calibration calibrate",
        "logs.encoders": "WheelGeometry calibrate_wheels encoder_odometry square_turns",
    },
    "judging": {
        "judging.comparison": (
            "Comparison Interval bootstrap_interval compare paired root_mean_square wilson_interval"
        ),
        "judging.intervals": "cluster_interval t_interval t_quantile",
        "judging.table": "summarise tabulate",
        "judging.consistency": "coverage nees nees_band",
        "judging.diagnostics": (
            "dead_reckoning heading_rmse pose_error position_error rmse settling_time trace"
        ),
        "judging.study": "",
        "judging.settings": "",
        "judging.localise": "",
    },
}

# Part of the edge -> what it may import besides NumPy and pfkit. A page has none of these.
EDGE: dict[str, tuple[str, ...]] = {
    "palette": (),
    "explore": (),
    "labs": (),
    "labs.grade": ("nbformat", "nbclient", "jupyter_client", "tqdm"),
    "labs.release": ("nbformat", "nbclient"),
    "plotting": ("matplotlib",),
    "widgets": ("anywidget", "ipywidgets", "traitlets", "IPython"),
    "__main__": ("matplotlib", "tqdm"),
}

# Module -> what it imports inside a function, where it is there: extras that read files of others.
OPTIONAL: dict[str, tuple[str, ...]] = {
    "worlds.map_files": ("PIL",),
    "logs.datasets": ("rosbags", "yaml"),
    "labs": ("ipywidgets", "IPython"),
}

# Name -> module that it is imported from.
HOME = {
    name: f"pfkit.{module}"
    for modules in CORE.values()
    for module, names in modules.items()
    for name in names.split()
}
# Modules that readers use by name: pf.worlds.arena().
MODULES = {"worlds": "pfkit.worlds", "study": "pfkit.judging.study"}
