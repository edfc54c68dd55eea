"""Bad input, everywhere: wrong shape, dtype, NaN, infinity, empty, negative noise, unknown key.

`TABLE` holds one row for each public name of the package: how to call it, and what each of its
arguments is. Each argument is then replaced by everything that it must not be (`BAD`), and the
call must raise: an error of ours that repeats the value or its shape and says what to do, or, for
what `PLAIN` lists, Python's or NumPy's own. What none of them refuses is a silent wrong answer. A
public name without a row fails `test_every_public_name_has_a_row`.

Not in the table is what gives a right answer: True where a count is wanted (it is 1, as everywhere
in Python), no pose at all from a shape with a 0, one pose from the shape ``()``, noise of scale -K
for K, no iteration of a fit, a level of 0. Nor an object that is only kept: a sensor that wraps
None fails when it is asked (`test_a_wrapped_object_fails_when_it_is_asked`).
"""

from __future__ import annotations

import inspect
from typing import Any

import numpy as np
import pytest

import pfkit as pf

NAN, INF = float("nan"), float("inf")
M, T = 6, 4


class Any_:
    """A class, where an object is wanted."""


Z_NONE = np.empty((3, 0))
NUMBERS = [("fast", "fast"), (NAN, "nan"), (INF, "inf"), ([1.0, NAN], "nan"), (1j, "1j")]
NOT_MODELS = [(None, "None"), (3, "3")]
# Every kind of argument with what it must not be: (value, a piece of the message).
BAD: dict[str, list[tuple[Any, str]]] = {
    "angle": NUMBERS,
    "angle or unknown": [NUMBERS[0], NUMBERS[2], NUMBERS[4]],
    "numbers": NUMBERS,
    "number": [*NUMBERS[:3]],
    "pose": [
        ("here", "here"),
        (np.zeros((5, 3)), "(5, 3)"),
        (np.zeros(2), "(2,)"),
        (np.empty(0), "(0,)"),
        (0.0, "()"),
        ([0.0, NAN, 0.0], "nan"),
        ([0.0, INF, 0.0], "inf"),
        ([1, 2, 1j], "1j"),
    ],
    "pose or unknown": [
        *[("here", "here"), (np.zeros((5, 3)), "(5, 3)"), (np.zeros(2), "(2,)"), (0.0, "()")],
        *[([0.0, INF, 0.0], "inf"), ([1, 2, 1j], "1j")],
    ],
    "control": [("go", "go"), (np.zeros(5), "(5,)"), ([NAN, 0.1, 0.1], "nan"), (1.0, "()")],
    "positive": [
        *[(0.0, "0"), (-1.0, "-1"), (NAN, "nan"), (INF, "inf"), ("wide", "wide")],
        ([1.0, 2.0], "2"),
    ],
    "one or two": [(0.0, "0"), (NAN, "nan"), ("wide", "wide"), ([1.0, 2.0, 3.0], "(3,)")],
    "positive or inf": [(0.0, "0"), (-1.0, "-1"), (NAN, "nan"), ("wide", "wide")],
    "non-negative": [(-1.0, "-1"), (NAN, "nan"), ("wide", "wide"), ([1.0, 2.0], "2")],
    "fraction": [(-0.1, "-0.1"), (1.1, "1.1"), (NAN, "nan"), ("half", "half")],
    "level": [(0.0, "0"), (1.0, "1"), (NAN, "nan"), ("most", "most")],
    "count": [(0, "0"), (-1, "-1"), (2.5, "2.5"), (True, "True"), ("many", "many")],
    "seed": [(-1, "-1"), (0.5, "0.5"), ("a", "a")],
    "shape": [(0, "0"), ((2, 0), "0"), (2.5, "2.5"), ((), "()"), ("many", "many")],
    "cells": [((0, 2, 2), "0"), ((2, 2), "(2, 2)"), ((2, 2, 2.5), "2.5")],
    "rng": [
        (None, "None"),
        (7, "7"),
        (np.random, "numpy.random"),
        (np.random.RandomState(0), "Rand"),
    ],
    "weights": [
        ([-0.1, 1.1], "-0.1"),
        ([NAN, 1.0], "nan"),
        ([INF, 1.0], "inf"),
        ([0.0, 0.0], "0"),
        ([], "(0,)"),
        (0.5, "()"),
        (["a", "b"], "a"),
        ([1e-300, 1e-300], "e-300"),
    ],
    "linear weights": [
        ([-0.1, 1.1], "-0.1"),
        ([NAN, 1.0], "nan"),
        ([0.0, 0.0], "0"),
        ([1.0], "(1,)"),
    ],
    "one set of weights": [([-0.1, 1.1], "-0.1"), ([NAN, 1.0], "nan"), ([], "(0,)"), (["a"], "a")],
    "log-weights": [
        ([NAN, 0.0], "nan"),
        ([-INF, -INF], "0"),
        ([INF, 0.0], "inf"),
        ([], "(0,)"),
        (0.0, "()"),
        ("a", "a"),
    ],
    "log-weights of M": [
        (np.full(M, NAN), "nan"),
        (np.full(M, -INF), "-inf"),
        (np.zeros(M) + 0.5, "0.5"),
        (np.zeros(2), "(2,)"),
        ("a", "a"),
    ],
    "truth": [("a", "a"), (np.zeros(T), f"({T},)"), (np.zeros((3, 1)), "1")],
    "series": [(1.0, "1.0"), ([np.zeros(3)] * T, "array"), ([Z_NONE], "1")],
    "particles": [(None, "None"), (np.zeros((3, M)), "array"), ("bel", "bel")],
    "log": [(None, "None"), (7, "7"), ([1, 2], "[1, 2]")],
    "history": [(None, "None"), (7, "7")],
    "motion": NOT_MODELS,
    "sensor": NOT_MODELS,
    "world": NOT_MODELS,
    "function": [(None, "None"), (3, "3")],
    "wheels": [(None, "None"), (3, "3")],
    "z": [("near", "near"), ([[NAN], [0.0], [0.0]], "nan"), (np.zeros((4, 2)), "(4, 2)")],
    "named z": [([[1.0], [0.0], [99.0]], "99"), ([[1.0], [0.0], [0.5]], "0.5")],
    "ancestors": [
        (np.full(M, M), str(M)),
        (np.full(M, -1), "-1"),
        (np.zeros(M), "0."),
        ("a", "()"),
    ],
    "indices": [(np.zeros((2, 3)), "float"), (np.zeros(3, int), "(3,)"), ("a", "a")],
    "positions": [
        (np.zeros((5, 2)), "(5, 2)"),
        ([[0.0, NAN], [0.0, 1.0]], "nan"),
        (np.empty((2, 0)), "(2, 0)"),
        ("here", "here"),
    ],
    "ids": [([1, 1], "[1, 1]"), ([1, 2, 3], "[1, 2, 3]"), ([0.5, 1], "0.5"), (["a", "b"], "a")],
    "id": [(99, "99"), (-1, "-1"), (NAN, "nan"), (INF, "inf"), ("door", "door")],
    "bounds": [((0, 1), "(0, 1)"), ((1, 0, 0, 1), "1"), ((0, INF, 0, 1), "inf"), ("box", "box")],
    "alpha4": [((-0.1, 0, 0, 0), "-0.1"), ((1, 2), "(2,)"), ((NAN, 0, 0, 0), "nan"), ("a", "a")],
    "state": [
        ([[0.0, NAN]], "nan"),
        ([[0.0, INF]], "inf"),
        (np.zeros(3), "(3,)"),
        (np.empty((3, 0)), "(3, 0)"),
        ("a", "a"),
    ],
    "errors": [([[0.0, NAN], [0.0, 1.0]], "nan"), ("a", "a"), (0.0, "()")],
    "covariance": [
        *[([[1.0, 2.0], [2.0, 1.0]], "1"), ([[NAN, 0], [0, 1]], "nan"), ("a", "a")],
        *[((-1.0, 1.0), "-1"), (np.eye(3), "(3, 3)"), ([[1.0, 0.5], [0.0, 1.0]], "0.5")],
    ],
    "scores": [([1.0, NAN, 2.0], "nan"), ([], "(0,)"), ("a", "a")],
    "probabilities": [([0.5, -0.5, 1.0], "-0.5"), ([NAN, 1.0], "nan"), ([], "(0,)"), ("a", "a")],
    "key": [("lottery", "lottery"), (None, "None")],
    "folder": [("/no/such/folder", "/no/such/folder"), (3, "3")],
    "times": [([0.0, NAN, 1.0, 2.0], "nan"), ("noon", "noon")],
}

RNG = np.random.default_rng(0)
WORLD = pf.LandmarkMap(np.array([[0.0, 4.0], [3.0, 0.0]]))
MOTION, SENSOR = pf.VelocityMotion(), pf.RangeBearing(WORLD, 0.3, 0.1)
POSE, U = np.array((1.0, 1.0, 0.5)), np.array((1.0, 0.2, 0.1))
BEL = pf.gaussian_prior(M, POSE, (0.1, 0.1, 0.1), RNG)
Z = SENSOR.expected(POSE)
LOG = pf.Log(
    np.arange(T, dtype=float),
    np.tile(U[:, None], T),
    [Z] * T,
    np.tile(POSE[:, None], T),
    POSE,
    WORLD,
)
"""A row: (function, {argument: (good value, kind or kinds)})."""
Row = tuple[Any, dict[str, tuple[Any, str]]]
r, x2 = (RNG, "rng"), (np.array(((1.0, 2.0), (0.0, 1.0))), "errors")
pose, bel, motion, sensor = (
    (POSE, "pose"),
    (BEL, "particles"),
    (MOTION, "motion"),
    (SENSOR, "sensor"),
)
u, z, w, n = (U, "control"), (Z, "z"), ([0.5, 0.5], "weights"), (3, "count")
half, one = (0.5, "fraction"), (1.0, "positive")
scheme = dict(w=w, rng=r, n=n)

TABLE: dict[str, Row] = {
    "wrap": (pf.wrap, dict(angle=(1.0, "angle or unknown"))),
    "compose": (pf.compose, dict(pose=pose, motion=pose)),
    "inverse": (pf.inverse, dict(pose=pose)),
    "between": (
        pf.between,
        dict(pose0=(POSE, "pose or unknown"), pose1=(POSE, "pose or unknown")),
    ),
    "circular_mean": (
        pf.circular_mean,
        dict(theta=([1.0, 2.0], "scores"), w=([1.0, 1.0], "numbers")),
    ),
    "resultant_length": (
        pf.resultant_length,
        dict(theta=([1.0, 2.0], "scores"), w=([1.0, 1.0], "numbers")),
    ),
    "Particles": (
        pf.Particles,
        dict(state=(BEL.state, "state"), log_w=(BEL.log_w, "log-weights of M")),
    ),
    "normalise": (pf.normalise, dict(log_w=(BEL.log_w, "log-weights"))),
    "ess": (pf.ess, dict(log_w=(BEL.log_w, "log-weights"))),
    "equal_log_weights": (pf.equal_log_weights, dict(shape=(3, "shape"))),
    "from_weights": (
        pf.from_weights,
        dict(state=(np.zeros((3, 2)), "state"), w=([0.5, 0.5], "linear weights")),
    ),
    "uniform_prior": (pf.uniform_prior, dict(M=(3, "shape"), world=(WORLD, "world"), rng=r)),
    "gaussian_prior": (
        pf.gaussian_prior,
        dict(M=(3, "shape"), mean=((0.0, 0.0), "scores"), Sigma=((1.0, 1.0), "covariance"), rng=r),
    ),
    "Log": (
        pf.Log,
        dict(
            t=(LOG.t, "times"), u=(LOG.u, "errors"), z=(LOG.z, "series"), truth=(LOG.truth, "truth")
        ),
    ),
    "LandmarkMap": (
        pf.LandmarkMap,
        dict(
            positions=(WORLD.positions, "positions"),
            ids=([4, 7], "ids"),
            bounds=((0, 1, 0, 1), "bounds"),
        ),
    ),
    **{name: (getattr(pf, name), scheme) for name in (*pf.SCHEMES, "resampling_wheel")},
    "survival_probability": (
        pf.survival_probability,
        dict(w=([0.5, 0.5], "one set of weights"), scheme=("systematic", "key"), n=n),
    ),
    "ess_below": (pf.ess_below, dict(share=half)),
    "every": (pf.every, dict(n=n)),
    "on_information": (pf.on_information, dict(nats=(0.5, "non-negative"))),
    "information": (pf.information, dict(bel=bel)),
    "drive_arc": (
        pf.drive_arc,
        dict(pose=pose, distance=(1.0, "numbers"), turn=(0.1, "numbers")),
    ),
    "inverse_arc": (
        pf.inverse_arc,
        dict(pose0=(POSE, "pose or unknown"), pose1=(POSE, "pose or unknown")),
    ),
    "VelocityMotion": (pf.VelocityMotion, dict(alpha=((0.1,) * 4, "alpha4"))),
    "OdometryMotion": (pf.OdometryMotion, dict(alpha=((0.1,) * 4, "alpha4"))),
    "odometry_control": (
        pf.odometry_control,
        dict(pose0=(POSE, "pose or unknown"), pose1=(POSE, "pose or unknown")),
    ),
    "log_gaussian": (pf.log_gaussian, dict(error=(0.1, "number"), sigma=one)),
    "RangeBearing": (
        pf.RangeBearing,
        dict(
            world=(WORLD, "nothing"),
            sigma_r=one,
            sigma_phi=one,
            nu=(3.0, "positive or inf"),
            bias_phi=(0.0, "number"),
        ),
    ),
    "Bearing": (
        pf.Bearing,
        dict(world=(WORLD, "nothing"), sigma_phi=one, nu=(3.0, "positive or inf")),
    ),
    "Range": (
        pf.Range,
        dict(
            world=(WORLD, "world"), sigma_r=one, bias=(0.0, "numbers"), nu=(3.0, "positive or inf")
        ),
    ),
    "Compass": (
        pf.Compass,
        dict(sigma_theta=one, bias=(0.0, "number"), nu=(3.0, "positive or inf")),
    ),
    "Position": (pf.Position, dict(sigma=(1.0, "one or two"))),
    "OutlierMixture": (
        pf.OutlierMixture,
        dict(sensor=(SENSOR, "nothing"), epsilon=half, density=one),
    ),
    "mean_pose": (pf.mean_pose, dict(bel=bel)),
    "covariance": (pf.covariance, dict(bel=bel)),
    "predict": (pf.predict, dict(bel=bel, u=u, motion=motion, rng=r)),
    "update": (pf.update, dict(bel=bel, z=z, sensor=sensor)),
    "take": (pf.take, dict(bel=bel, ancestors=(np.zeros(M, int), "ancestors"))),
    "resample": (
        pf.resample,
        dict(bel=bel, scheme=(pf.systematic, "function"), rng=r, n=n),
    ),
    "step": (
        pf.step,
        dict(
            bel=bel,
            u=u,
            z=z,
            motion=motion,
            sensor=sensor,
            rng=r,
            scheme=(pf.systematic, "function"),
            threshold=(1.0, "fraction"),
        ),
    ),
    "run": (
        pf.run,
        dict(
            log=(LOG, "log"),
            bel=bel,
            motion=motion,
            sensor=sensor,
            rng=r,
            scheme=(pf.systematic, "function"),
            threshold=(1.0, "fraction"),
        ),
    ),
}

MOTIONS = {"VelocityMotion": MOTION, "OdometryMotion": pf.OdometryMotion()}
SENSORS = {
    "RangeBearing": SENSOR,
    "Bearing": pf.Bearing(WORLD, 0.1),
    "Range": pf.Range(WORLD, 0.1),
    "Compass": pf.Compass(0.1),
    "OutlierMixture": pf.OutlierMixture(SENSOR, 0.1, 0.1),
}
for name, model in MOTIONS.items():
    TABLE[f"{name}.mean"] = model.mean, dict(pose=pose, u=u)
    TABLE[f"{name}.sample"] = model.sample, dict(pose=pose, u=u, rng=r)
for name, model in SENSORS.items():
    if hasattr(model, "sample"):
        TABLE[f"{name}.expected"] = model.expected, dict(pose=pose)
        TABLE[f"{name}.sample"] = model.sample, dict(pose=pose, rng=r)
    seen = model.expected(POSE) if hasattr(model, "sample") else Z
    BAD[f"z of {name}"] = [
        ("near", "near"),
        (np.zeros((4, 2)), "(4, 2)"),
        (np.full_like(seen, NAN), "nan"),
        (np.full_like(seen, INF), "inf"),
    ]
    arguments = dict(z=(seen, f"z of {name}"), pose=pose)
    TABLE[f"{name}.log_likelihood"] = model.log_likelihood, arguments
TABLE["RangeBearing.log_likelihood of names"] = (
    SENSOR.log_likelihood,
    dict(z=(Z, "named z"), pose=pose),
)
TABLE["LandmarkMap.locate"] = WORLD.locate, dict(ids=(0, "id"))
TABLE["LandmarkMap.sample_poses"] = WORLD.sample_poses, dict(shape=(3, "size"), rng=r)
TABLE["LandmarkMap.contains"] = WORLD.contains, dict(x=(0.0, "number"), y=(0.0, "number"))

GRID = pf.OccupancyGrid(np.pad(np.zeros((6, 6)), 1, constant_values=1.0), 0.5)
CELLS = pf.uniform_grid((4, 4, 4), (0, 4, 0, 4))
GAUSS = pf.Gaussian(POSE, np.eye(3) * 0.1)
BEAMS = pf.BeamModel(GRID, np.array((0.0, 1.0)), 5.0)
NOISE = pf.Drift()
MEMORY = pf.Memory()
TREE = np.zeros((T, M), dtype=np.int64)
WHEELS = pf.WheelGeometry(0.1, 0.1, 0.5)
SQUARES = [pf.square_turns(4.0, WHEELS, clockwise) for clockwise in (True, False)]
HISTORY = pf.run(LOG, BEL, MOTION, SENSOR, RNG)
SMOOTH = pf.run_gaussian(LOG, GAUSS, MOTION, SENSOR)
ERRORS, COVARIANCES = np.zeros((2, 5)), np.repeat(np.eye(2)[..., None], 5, axis=2)
STUDY = pf.tabulate({"N": [1, 1, 2, 2], "error": [0.1, 0.2, 0.3, 0.4]})
world, grid = (WORLD, "world"), (GRID, "world")
log, r_max = (LOG, "log"), (5.0, "positive")
estimate = dict(estimate=(HISTORY.estimate, "track"), truth=(LOG.truth, "track"))
box = (CELLS, "particles")
gauss = (GAUSS, "particles")


def identity(x):
    return x


TABLE |= {
    "OccupancyGrid": (
        pf.OccupancyGrid,
        dict(p=(np.zeros((3, 3)), "errors"), resolution=one, origin=((0.0, 0.0, 0.0), "pose")),
    ),
    "distance_field": (
        pf.distance_field,
        dict(occupied=(np.eye(3, dtype=bool), "map"), resolution=one),
    ),
    "RayCaster": (pf.RayCaster, dict(world=grid)),
    "RayCaster.cast": (
        pf.RayCaster(GRID).cast,
        dict(pose=pose, angles=([0.0], "scores"), r_max=(5.0, "positive or inf")),
    ),
    "ancestry": (pf.ancestry, dict(ancestors=(TREE, "indices"))),
    "founders": (pf.founders, dict(ancestors=(TREE, "indices"))),
    "coalescence_time": (pf.coalescence_time, dict(ancestors=(TREE, "indices"))),
    "count_distinct": (pf.count_distinct, dict(indices=(TREE[0], "whole numbers"))),
    "drift_time": (pf.drift_time, dict(N=(3, "count"), share=half)),
    "offspring_z": (
        pf.offspring_z,
        dict(scheme=(pf.systematic, "function"), w=([0.5, 0.5], "one set of weights"), rng=r, n=n),
    ),
    "Genealogy": (pf.Genealogy, {}),
    "Bicycle": (pf.Bicycle, dict(L=one, alpha=(0.1, "non-negative"))),
    "DifferentialDrive": (pf.DifferentialDrive, dict(r=one, L=one, alpha=(0.1, "non-negative"))),
    "FixedTarget": (pf.FixedTarget, dict(sigma=(1.0, "non-negative"))),
    "LineTarget": (pf.LineTarget, dict(sigma=(1.0, "non-negative"))),
    "CircleTarget": (pf.CircleTarget, dict(sigma=(1.0, "non-negative"))),
    "HeadingTarget": (
        pf.HeadingTarget,
        dict(sigma=(1.0, "non-negative"), heading=(0.0, "number")),
    ),
    "Gate": (pf.Gate, dict(sensor=(SENSOR, "nothing"), threshold=(0.1, "non-negative"))),
    "Tempered": (pf.Tempered, dict(sensor=(SENSOR, "nothing"), exponent=half)),
    "Masked": (pf.Masked, dict(sensor=(SENSOR, "nothing"))),
    "Mounted": (pf.Mounted, dict(sensor=(SENSOR, "nothing"), mount=(POSE, "pose"))),
    "increments": (pf.increments, dict(poses=(np.zeros((3, 4)), "pose"))),
    "IncrementMotion": (pf.IncrementMotion, dict(sigma=((0.1, 0.1, 0.1), "alpha3"))),
    "Rig": (lambda mount: pf.Rig("laser", mount=mount), dict(mount=(POSE, "pose"))),
    "face_course": (pf.face_course, dict(log=log)),
    "MaximumLikelihood": (pf.MaximumLikelihood, dict(sensor=(SENSOR, "nothing"))),
    "BeamModel": (
        pf.BeamModel,
        dict(
            world=grid,
            directions=([0.0], "scores"),
            r_max=r_max,
            sigma_hit=one,
            lambda_short=one,
            z_hit=(0.85, "fraction"),
        ),
    ),
    "LikelihoodField": (
        pf.LikelihoodField,
        dict(world=grid, r_max=r_max, sigma_hit=one, z_hit=(0.9, "fraction")),
    ),
    "fit_beams": (
        pf.fit_beams,
        dict(
            model=(BEAMS, "sensor"),
            r=(np.linspace(0.9, 1.1, 9), "readings"),
            length=(np.full(9, 1.0), "readings"),
            iterations=(3, "iterations"),
        ),
    ),
    "FieldOfView": (
        pf.FieldOfView,
        dict(world=(WORLD, "nothing"), r_max=(5.0, "positive or inf"), fov=one),
    ),
    "Outliers": (pf.Outliers, dict(epsilon=half, low=((0.0,), "angle"), high=((1.0,), "angle"))),
    "map_particle": (pf.map_particle, dict(bel=bel)),
    "top_share_mean": (pf.top_share_mean, dict(bel=bel, share=half)),
    "clusters": (pf.clusters, dict(bel=bel, cell=((1.0, 1.0, 1.0), "positive"))),
    "kde": (pf.kde, dict(bel=bel, points=pose)),
    "silverman_bandwidth": (pf.silverman_bandwidth, dict(bel=bel)),
    "door_likelihood": (
        pf.door_likelihood,
        dict(doors=([True, False], "doors"), z=(True, "truth value"), hit=half, false=half),
    ),
    "shift_kernel": (
        pf.shift_kernel,
        dict(u=(1, "whole number"), undershoot=(0.1, "fraction"), overshoot=(0.1, "fraction")),
    ),
    "predict_1d": (
        pf.predict_1d,
        dict(bel=([0.5, 0.5], "probabilities"), kernel=([0.5, 0.5, 0.0], "probabilities")),
    ),
    "update_1d": (
        pf.update_1d,
        dict(bel=([0.5, 0.5], "probabilities"), likelihood=([0.5, 0.5], "cell numbers")),
    ),
    "PoseGrid": (pf.PoseGrid, dict(p=(CELLS.p, "errors"), bounds=((0, 4, 0, 4), "bounds"))),
    "uniform_grid": (
        pf.uniform_grid,
        dict(shape=((4, 4, 4), "cells"), bounds=((0, 4, 0, 4), "bounds")),
    ),
    "gaussian_grid": (
        pf.gaussian_grid,
        dict(
            shape=((4, 4, 4), "cells"),
            bounds=((0, 4, 0, 4), "bounds"),
            mean=pose,
            sigma=([1.0] * 3, "pose"),
        ),
    ),
    "predict_by_convolution": (
        pf.predict_by_convolution,
        dict(bel=box, u=u, motion=motion, rng=r, draws=n),
    ),
    "predict_by_transport": (
        pf.predict_by_transport,
        dict(bel=box, u=u, motion=motion, rng=r, draws=n),
    ),
    "update_grid": (pf.update_grid, dict(bel=box, z=z, sensor=sensor)),
    "kl_divergence": (pf.kl_divergence, dict(bel=bel, grid=box, bins=n)),
    "equal_mass_boxes": (pf.equal_mass_boxes, dict(p=(CELLS.p, "errors"), bins=n)),
    "refinement": (
        pf.refinement,
        dict(coarse=box, fine=(pf.uniform_grid((8, 8, 8), (0, 4, 0, 4)), "particles"), bins=n),
    ),
    "Gaussian": (pf.Gaussian, dict(mean=([0.0, 0.0], "scores"), Sigma=(np.eye(2), "covariance"))),
    "kalman_predict": (
        pf.kalman_predict,
        dict(bel=gauss, F=(np.eye(3), "covariance of 3"), Sigma_u=(np.eye(3), "covariance of 3")),
    ),
    "kalman_update": (
        pf.kalman_update,
        dict(
            bel=gauss,
            z=([0.0], "angle"),
            H=(np.eye(3)[:1], "covariance of 3"),
            Sigma_z=([[1.0]], "covariance of 3"),
            gate=(9.0, "positive or inf"),
        ),
    ),
    "gaussian_predict": (pf.gaussian_predict, dict(bel=gauss, u=u, motion=motion)),
    "gaussian_update": (
        pf.gaussian_update,
        dict(bel=gauss, z=z, sensor=sensor, gate=(9.0, "positive or inf")),
    ),
    "linearise": (
        pf.linearise,
        dict(f=(identity, "function"), mean=(POSE, "scores"), Sigma=(np.eye(3), "covariance of 3")),
    ),
    "unscented": (
        pf.unscented,
        dict(f=(identity, "function"), mean=(POSE, "scores"), Sigma=(np.eye(3), "covariance of 3")),
    ),
    "run_gaussian": (pf.run_gaussian, dict(log=log, bel=gauss, motion=motion, sensor=sensor)),
    "rts_smooth": (pf.rts_smooth, dict(history=(SMOOTH, "history"))),
    "Memory.remember": (
        MEMORY.remember,
        dict(log_evidence=(-1.0, "number"), K=n, alpha_slow=(0.1, "fraction"), alpha_fast=half),
    ),
    "inject": (
        pf.inject,
        dict(bel=bel, share=half, draw=(WORLD.sample_poses, "function"), rng=r),
    ),
    "poses_seeing": (pf.poses_seeing, dict(z=z, sensor=sensor, M=(3, "draws"), rng=r)),
    "augmented_step": (
        pf.augmented_step,
        dict(
            bel=bel,
            memory=(MEMORY, "particles"),
            u=u,
            z=z,
            motion=motion,
            sensor=sensor,
            rng=r,
            world=(WORLD, "a world"),
        ),
    ),
    "kld_bound": (
        pf.kld_bound,
        dict(k=(3, "whole number"), epsilon=(1.0, "positive or inf"), delta=(0.1, "level")),
    ),
    "kld_count": (
        pf.kld_count,
        dict(
            state=(BEL.state, "state"),
            cell=((1.0, 1.0, 1.0), "positive"),
            epsilon=(1.0, "positive or inf"),
            least=n,
        ),
    ),
    "kld_step": (
        pf.kld_step,
        dict(
            bel=bel, u=u, z=z, motion=motion, sensor=sensor, rng=r, epsilon=(1.0, "positive or inf")
        ),
    ),
    "roughen": (pf.roughen, dict(bel=bel, rng=r, K=(0.2, "scale"))),
    "regularise": (pf.regularise, dict(bel=bel, rng=r)),
    "tempered_update": (
        pf.tempered_update,
        dict(bel=bel, z=z, sensor=sensor, rng=r, keep=(0.95, "fraction"), kernel=(0.3, "scale")),
    ),
    "pose_error": (pf.pose_error, estimate),
    "position_error": (pf.position_error, estimate),
    "rmse": (pf.rmse, estimate),
    "heading_rmse": (pf.heading_rmse, estimate),
    "settling_time": (
        pf.settling_time,
        dict(t=(LOG.t, "times"), error=(np.zeros(T), "times"), limit=(1.0, "positive or inf")),
    ),
    "dead_reckoning": (pf.dead_reckoning, dict(log=log, start=pose)),
    "trace": (pf.trace, dict(history=(HISTORY, "history"))),
    "hypothesis_mass": (
        pf.hypothesis_mass,
        dict(bel=bel, poses=(POSE[:, None], "pose"), radius=(1.0, "positive or inf")),
    ),
    "images": (pf.images, dict(pose=pose, g=pose)),
    "symmetries": (pf.symmetries, dict(world=world, tolerance=(1.0, "positive or inf"))),
    "nees": (pf.nees, dict(error=(ERRORS, "errors"), Sigma=(COVARIANCES, "errors"))),
    "nees_band": (pf.nees_band, dict(D=(3, "freedom"), runs=(3, "freedom"), level=(0.9, "level"))),
    "coverage": (
        pf.coverage,
        dict(error=(ERRORS, "errors"), Sigma=(COVARIANCES, "errors"), level=(0.9, "share below 1")),
    ),
    "chi2_quantile": (pf.chi2_quantile, dict(p=(0.5, "probability"), k=n)),
    "chi2_tail": (pf.chi2_tail, dict(x=(1.0, "log number"), k=n)),
    "root_mean_square": (pf.root_mean_square, dict(x=([1.0, 2.0], "scores"))),
    "bootstrap_interval": (
        pf.bootstrap_interval,
        dict(
            x=([1.0, 2.0], "scores"),
            rng=r,
            statistic=(np.mean, "function"),
            level=(0.9, "level"),
            draws=n,
        ),
    ),
    "wilson_interval": (pf.wilson_interval, dict(successes=(1, "seed"), n=n, level=(0.9, "level"))),
    "t_quantile": (pf.t_quantile, dict(level=(0.9, "level"), freedom=n)),
    "t_interval": (
        pf.t_interval,
        dict(x=([1.0, 2.0, 4.0], "scores of three"), level=(0.9, "level")),
    ),
    "cluster_interval": (
        pf.cluster_interval,
        dict(x=([1.0, 2.0, 4.0], "scores of three"), clusters=(list("aab"), "names of worlds")),
    ),
    "paired": (
        pf.paired,
        dict(
            a=([1.0, 2.0, 4.0], "scores"),
            b=([1.0, 3.0, 4.0], "scores"),
            rng=r,
            level=(0.9, "level"),
        ),
    ),
    "compare": (
        pf.compare,
        dict(
            run_a=(lambda rng: rng.normal(), "function"),
            run_b=(lambda rng: rng.normal(), "function"),
            seeds=(9, "count"),
            seed=(0, "seed"),
        ),
    ),
    "Drift": (pf.Drift, dict(drive=((0.1, 0, 0), "alpha3"), turn=((0.1, 0, 0), "alpha3"))),
    "Preintegrated": (pf.Preintegrated, dict(u=(LOG.u, "control"), drift=(NOISE, "particles"))),
    "ComposedMotion": (pf.ComposedMotion, {}),
    "preintegrate": (pf.preintegrate, dict(log=log, drift=(NOISE, "particles"))),
    "fill_in": (
        pf.fill_in,
        dict(
            log=log,
            drift=(NOISE, "particles"),
            ends=(np.arange(T), "instants"),
            estimate=(HISTORY.estimate, "track"),
            Sigma=(HISTORY.covariance, "spread"),
        ),
    ),
    "Calibration": (pf.Calibration, dict(speed=(1.0, "number"), turn=(1.0, "number"))),
    "calibrate": (pf.calibrate, dict(log=(None, "log"))),
    "WheelGeometry": (pf.WheelGeometry, dict(r_l=one, r_r=one, L=one)),
    "encoder_odometry": (
        pf.encoder_odometry,
        dict(turns=(np.ones((2, T)), "errors"), wheels=(WHEELS, "wheels"), start=pose),
    ),
    "square_turns": (pf.square_turns, dict(side=one, wheels=(WHEELS, "wheels"))),
    "calibrate_wheels": (
        pf.calibrate_wheels,
        dict(
            ends=(np.zeros((2, 2)), "errors"),
            drives=(SQUARES, "function"),
            wheels=(WHEELS, "wheels"),
        ),
    ),
    "commands": (pf.commands, dict(segments=([(1.0, 0.0, 1.0)], "segments"), dt=one)),
    "PurePursuit": (
        pf.PurePursuit,
        dict(
            points=(np.array(((0.0, 1, 1), (0, 0, 1))), "positions"), v=one, dt=one, lookahead=one
        ),
    ),
    "drive": (pf.drive, dict(start=pose, u=(LOG.u, "angle"), motion=motion, rng=r)),
    "sense": (pf.sense, dict(truth=(LOG.truth, "driven"), sensor=sensor, rng=r, every=n)),
    "simulate_log": (
        pf.simulate_log,
        dict(start=pose, u=(LOG.u, "angle"), motion=motion, sensor=sensor, rng=r, every=n),
    ),
    "load_log": (pf.load_log, dict(folder=(None, "folder"))),
    "load_mrclam": (pf.load_mrclam, dict(folder=(None, "folder"))),
    "load_plaza": (pf.load_plaza, dict(folder=(None, "folder"))),
    "read_log": (pf.read_log, dict(folder=(None, "folder"))),
    "save_log": (pf.save_log, dict(log=(None, "log"), folder=("unused", "nothing"))),
    "tabulate": (pf.tabulate, dict(columns=({"a": [1]}, "columns"))),
    "summarise": (
        pf.summarise,
        dict(
            table=(STUDY, "history"), value=("error", "key"), by=("N", "key"), level=(0.9, "level")
        ),
    ),
}
BAD |= {
    "scores of three": [([1.0, NAN, 2.0], "nan"), ([], "0"), ([1.0], "1"), ("a", "a")],
    "names of worlds": [(list("aaa"), "1"), (list("ab"), "(2,)"), (list("aabb"), "(4,)")],
    "iterations": [(2.5, "2.5"), ("many", "many")],
    "size": [(0, "0"), ((2, 0), "0"), (2.5, "2.5"), ("many", "many")],
    "draws": [(-1, "-1"), (2.5, "2.5"), ("many", "many")],
    "scale": [(NAN, "nan"), (INF, "inf"), ("wide", "wide"), ([1.0, 2.0], "2")],
    "freedom": [(0, "0"), (-1, "-3"), (2.5, "7.5"), ("many", "many")],
    "share below 1": [(-0.1, "-0.1"), (1.0, "1"), (NAN, "nan"), ("most", "most")],
    "map": [(np.zeros(3, bool), "(3,)"), ("a", "()"), (np.eye(3), "float64")],
    "whole numbers": [(np.zeros(3), "float"), ("a", "a")],
    "whole number": [(0.5, "0.5"), ("a", "a"), (NAN, "nan")],
    "probability": [(1.0, "1"), (-0.1, "-0.1"), (NAN, "nan"), ("most", "most")],
    "driven": [("a", "a"), (np.full((3, T), NAN), "nan"), (0.0, "(")],
    "instants": [(np.zeros(T), "float"), (np.zeros(3, int), "(3, 3"), ("a", "<U1")],
    "spread": [(np.full((3, 3, T), NAN), "nan"), (np.zeros((3, 3)), "(3, 3)"), ("a", "a")],
    "log number": [(NAN, "nan"), ("a", "a")],
    "readings": [(np.full(9, NAN), "nan"), ([], "0"), ("a", "a")],
    "cell numbers": [([0.5, -0.5], "-0.5"), ([NAN, 1.0], "nan"), ([], "(0,)"), ("a", "a")],
    "track": [(np.full((3, T), INF), "inf"), (np.zeros((2, 2)), "(2, "), ("a", "a"), (0.0, "(")],
    "doors": [([0.5, 2.0], "0.5"), ("wall", "wall"), ([], "[]")],
    "truth value": [("maybe", "maybe"), (2, "2"), (NAN, "nan")],
    "covariance of 3": [(np.full((3, 3), NAN), "nan"), ("a", "a"), (np.eye(2), "(2, 2)")],
    "a world": [(3, "3")],
    "alpha3": [((-0.1, 0, 0), "-0.1"), ((1, 2), "(2,)"), ((NAN, 0, 0), "nan"), ("a", "a")],
    "segments": [
        ([(1.0, 0.0)], "1.0, 0.0"),
        ([(1.0, 0.0, NAN)], "nan"),
        ("ahead", "'a'"),
        (3, "3"),
    ],
    "columns": [({"a": [1], "b": [1, 2]}, "2"), (3, "3"), ({}, "[]")],
    "nothing": [],
}
# Good calls that need a recorded drive or touch the disk have tests of their own.
ELSEWHERE = {"calibrate", "load_log", "load_mrclam", "load_plaza", "read_log", "save_log"}

# What the package hands out and nobody builds by hand, and interfaces: nothing to check.
RESULTS = {
    *("Clusters", "Comparison", "Divergence", "GaussianHistory", "History", "Info", "Interval"),
    "Memory",
}
INTERFACES = {"MotionModel", "Sensor", "SensorModel", "Step"}


def public_names() -> set[str]:
    """Functions and classes of the package that a caller can hand something wrong."""
    names = set()
    for name in pf.__all__:
        value = getattr(pf, name)
        known = inspect.isfunction(value) or inspect.isclass(value)
        error = inspect.isclass(value) and issubclass(value, Exception)
        if known and not error:
            names.add(name)
    return names - RESULTS - INTERFACES


CASES = [
    pytest.param(name, argument, value, piece, id=f"{name}-{argument}-{i}")
    for name, (_, arguments) in TABLE.items()
    for argument, (_, kind) in arguments.items()
    for i, (value, piece) in enumerate(BAD[kind])
]


def test_every_public_name_has_a_row():
    missing = sorted(public_names() - set(TABLE))
    assert not missing, f"add a row to TABLE in {__file__} for each of {missing}"


@pytest.mark.parametrize("name", sorted(TABLE.keys() - ELSEWHERE))
def test_the_good_call_works(name):
    function, arguments = TABLE[name]
    function(**{argument: good for argument, (good, _) in arguments.items()})


# "'NoneType' object has no attribute 'log_likelihood'" needs no help from us.
NO_OBJECT = {
    *("particles", "log", "history", "motion", "sensor", "world", "a world", "function", "columns"),
    "wheels",
}
# Arguments whose bad values Python or NumPy refuses itself, or a check of ours further in: a word
# where a number is wanted, a number where a list or a path is, an index or a size that does not
# exist, a key that no table has, a generator without the method that is called.
PLAIN = {
    "augmented_step": "u z",
    "gaussian_predict": "u",
    "update_grid": "z",
    "predict_by_convolution": "u",
    "step": "u z",
    "update": "z",
    "predict": "u",
    "equal_log_weights": "shape",
    "from_weights": "state",
    "uniform_prior": "M",
    "gaussian_prior": "M",
    "Log": "z",
    "survival_probability": "scheme",
    "Range": "world",
    "VelocityMotion.mean": "u",
    "offspring_z": "w",
    "fit_beams": "iterations",
    "shift_kernel": "u",
    "uniform_grid": "shape",
    "gaussian_grid": "shape mean sigma",
    "predict_by_transport": "rng u",
    "kalman_predict": "F",
    "Memory.remember": "alpha_slow alpha_fast",
    "inject": "rng",
    "poses_seeing": "M rng",
    "kld_step": "rng u z",
    "roughen": "K",
    "tempered_update": "kernel z",
    "bootstrap_interval": "rng draws",
    "paired": "rng",
    "compare": "seeds seed",
    "commands": "segments",
    "simulate_log": "rng",
    "load_log": "folder",
    "load_mrclam": "folder",
    "load_plaza": "folder",
    "read_log": "folder",
    "summarise": "table value by",
}
OURS_OR_PYTHONS = (
    *(pf.PfkitError, TypeError, ValueError, AttributeError, LookupError),
    *(ZeroDivisionError, FileNotFoundError),
)


def test_what_is_left_to_python_stands_in_the_table():
    for name, arguments in PLAIN.items():
        assert set(arguments.split()) <= set(TABLE[name][1]), name


@pytest.mark.parametrize("name, argument, value, piece", CASES)
def test_a_bad_argument_is_named(name, argument, value, piece):
    function, arguments = TABLE[name]
    call = {key: good for key, (good, _) in arguments.items()} | {argument: value}
    plain = arguments[argument][1] in NO_OBJECT or argument in PLAIN.get(name, "").split()
    with pytest.raises(OURS_OR_PYTHONS if plain else pf.PfkitError) as why:
        function(**call)
    message = str(why.value)
    if not plain:
        assert piece in message, f"the message does not say what it got: {message}"
        marks = (";", "must", "needs", ":")
        assert any(mark in message for mark in marks), f"no remedy in: {message}"


@pytest.mark.parametrize("nothing", [None, 3])
@pytest.mark.parametrize(
    "ask",
    [
        lambda world: pf.RangeBearing(world, 0.3, 0.1).expected(POSE),
        lambda world: pf.Bearing(world, 0.1).expected(POSE),
        lambda world: pf.FieldOfView(world)(POSE),
        lambda sensor: pf.OutlierMixture(sensor, 0.1, 0.1).log_likelihood(Z, POSE),
        lambda sensor: pf.Gate(sensor, 0.1).log_likelihood(Z, BEL.state),
        lambda sensor: pf.Tempered(sensor, 0.5).log_likelihood(Z, POSE),
        lambda sensor: pf.Masked(sensor).log_likelihood(np.vstack((Z, Z[:1])), POSE),
        lambda sensor: pf.MaximumLikelihood(sensor).log_likelihood(Z[:2], POSE),
    ],
)
def test_a_wrapped_object_fails_when_it_is_asked(ask, nothing):
    with pytest.raises(AttributeError, match="has no attribute"):
        ask(nothing)
