"""The same filter on several foundations. Each contestant is a function (work, M, seed) -> (T, 3).

The models of the rivals are written once, plainly, as a careful user of that library would write
them (NumPy over all particles where the library allows it), and then left alone.
"""

# ruff: noqa: NPY002 - the rivals draw from NumPy's global generator, and so do their models
from __future__ import annotations

import ctypes
import math
import subprocess
import tempfile
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
from world import DT, OMEGA, SIGMA_OMEGA, SIGMA_PHI, SIGMA_R, SIGMA_V, START, START_SD, V, Work

HERE = Path(__file__).parent


def pfkit(work: Work, M: int, seed: int = 0) -> np.ndarray:
    """The course's own package, used as a chapter uses it."""
    import pfkit as pf

    rng = np.random.default_rng(seed)
    motion = pf.VelocityMotion((SIGMA_V**2 / V**2, 0.0, SIGMA_OMEGA**2 / V**2, 0.0))
    sensor = pf.RangeBearing(pf.LandmarkMap(work.landmarks), SIGMA_R, SIGMA_PHI)
    bel = pf.gaussian_prior(M, START, START_SD, rng)
    path = []
    for z in work.z:
        bel = pf.predict(bel, (V, OMEGA, DT), motion, rng)
        bel, _ = pf.update(bel, z, sensor)
        path.append(pf.mean_pose(bel))
        if bel.ess < 0.5 * bel.M:
            bel = pf.resample(bel, pf.systematic, rng)
    return np.array(path)


def _move(x, y, theta, normal, M):
    v = V + SIGMA_V * normal(size=M)
    omega = OMEGA + SIGMA_OMEGA * normal(size=M)
    x1 = x + v / omega * (np.sin(theta + omega * DT) - np.sin(theta))
    y1 = y - v / omega * (np.cos(theta + omega * DT) - np.cos(theta))
    return x1, y1, theta + omega * DT


def _log_weight(x, y, theta, z, landmarks):
    log_w = np.zeros(x.shape)
    for k in range(landmarks.shape[1]):
        dx, dy = landmarks[0, k] - x, landmarks[1, k] - y
        error_r = z[0, k] - np.sqrt(dx**2 + dy**2)
        error_phi = (z[1, k] - np.arctan2(dy, dx) + theta + np.pi) % (2 * np.pi) - np.pi
        log_w -= 0.5 * (error_r / SIGMA_R) ** 2 + 0.5 * (error_phi / SIGMA_PHI) ** 2
    return log_w


def particles(work: Work, M: int, seed: int = 0) -> np.ndarray:
    """`particles` 0.4: a Feynman-Kac model whose three methods are NumPy over all particles."""
    import particles as library
    from particles.collectors import Moments

    np.random.seed(seed)

    class Localise(library.FeynmanKac):
        def M0(self, N):
            return self.M(0, START + START_SD * np.random.normal(size=(N, 3)))

        def M(self, t, xp):
            return np.stack(_move(*xp.T, np.random.normal, len(xp)), axis=1)

        def logG(self, t, xp, x):
            return _log_weight(x[:, 0], x[:, 1], x[:, 2], work.z[t], work.landmarks)

    def mean(W, X):
        x, y = W @ X[:, 0], W @ X[:, 1]
        return np.array((x, y, np.arctan2(W @ np.sin(X[:, 2]), W @ np.cos(X[:, 2]))))

    model = Localise(len(work.z))
    collect = [Moments(mom_func=mean)]
    run = library.SMC(model, N=M, resampling="systematic", ESSrmin=0.5, collect=collect)
    run.run()
    return np.array(run.summaries.moments)


def filterpy(work: Work, M: int, seed: int = 0) -> np.ndarray:
    """filterpy's way: (M, 3) arrays, multiplied scipy densities, its systematic_resample."""
    from filterpy.monte_carlo import systematic_resample
    from scipy.stats import norm

    np.random.seed(seed)
    X = START + START_SD * np.random.randn(M, 3)
    w, path = np.full(M, 1.0 / M), []
    for z in work.z:
        X[:, 0], X[:, 1], X[:, 2] = _move(X[:, 0], X[:, 1], X[:, 2], np.random.normal, M)
        for k, landmark in enumerate(work.landmarks.T):
            distance = np.linalg.norm(X[:, :2] - landmark, axis=1)
            bearing = np.arctan2(landmark[1] - X[:, 1], landmark[0] - X[:, 0]) - X[:, 2]
            error = (z[1, k] - bearing + np.pi) % (2 * np.pi) - np.pi
            w *= norm(distance, SIGMA_R).pdf(z[0, k])
            w *= norm(0.0, SIGMA_PHI).pdf(error)
        w += 1.0e-300
        w /= w.sum()
        x, y = np.average(X[:, :2], weights=w, axis=0)
        heading = np.arctan2(
            np.average(np.sin(X[:, 2]), weights=w), np.average(np.cos(X[:, 2]), weights=w)
        )
        path.append((x, y, heading))
        if 1.0 / np.sum(np.square(w)) < M / 2:
            X = X[systematic_resample(w)]
            w = np.full(M, 1.0 / M)
    return np.array(path)


def python_robotics(work: Work, M: int, seed: int = 0) -> np.ndarray:
    """PythonRobotics' formulation: one particle after the other, columns of a (3, M) array."""
    rng = np.random.default_rng(seed)
    px = START[:, None] + START_SD[:, None] * rng.standard_normal((3, M))
    pw, path = np.full(M, 1.0 / M), []
    for z in work.z:
        for i in range(M):
            x, w = px[:, i], pw[i]
            v, omega = V + rng.normal() * SIGMA_V, OMEGA + rng.normal() * SIGMA_OMEGA
            turn = x[2] + omega * DT
            x = np.array(
                (
                    x[0] + v / omega * (math.sin(turn) - math.sin(x[2])),
                    x[1] - v / omega * (math.cos(turn) - math.cos(x[2])),
                    turn,
                )
            )
            for k in range(z.shape[1]):
                dx, dy = work.landmarks[0, k] - x[0], work.landmarks[1, k] - x[1]
                error_r = z[0, k] - math.hypot(dx, dy)
                error_phi = math.remainder(z[1, k] - math.atan2(dy, dx) + x[2], 2 * math.pi)
                w *= math.exp(-0.5 * (error_r / SIGMA_R) ** 2 - 0.5 * (error_phi / SIGMA_PHI) ** 2)
            px[:, i], pw[i] = x, w
        pw = pw / pw.sum()
        path.append((*(px[:2] @ pw), math.atan2(np.sin(px[2]) @ pw, np.cos(px[2]) @ pw)))
        if 1.0 / (pw @ pw) < M / 2:
            cumulative = np.cumsum(pw)
            teeth = np.arange(0.0, 1.0, 1 / M) + rng.uniform(0, 1 / M)
            chosen, index = [], 0
            for tooth in teeth[:M]:
                while index < M - 1 and tooth > cumulative[index]:
                    index += 1
                chosen.append(index)
            px, pw = px[:, chosen], np.full(M, 1.0 / M)
    return np.array(path)


def stone_soup(work: Work, M: int, seed: int = 0) -> np.ndarray:
    """Stone Soup 1.9.1: its predictor, updater and resampler with a model of the arc."""
    from stonesoup.base import Property
    from stonesoup.models.measurement.nonlinear import CartesianToBearingRange
    from stonesoup.models.transition.base import TransitionModel
    from stonesoup.predictor.particle import ParticlePredictor
    from stonesoup.resampler.particle import ESSResampler, SystematicResampler
    from stonesoup.types.array import StateVectors
    from stonesoup.types.detection import Detection
    from stonesoup.types.hypothesis import SingleHypothesis
    from stonesoup.types.state import ParticleState
    from stonesoup.updater.particle import ParticleUpdater

    np.random.seed(seed)

    class Arc(TransitionModel):
        noise: bool = Property(default=True)

        @property
        def ndim_state(self):
            return 3

        def rvs(self, *args, **kwargs):
            raise NotImplementedError

        def pdf(self, *args, **kwargs):
            raise NotImplementedError

        def function(self, state, noise=False, **kwargs):
            x, y, theta = np.asarray(state.state_vector, dtype=float)
            return StateVectors(np.stack(_move(x, y, theta, np.random.normal, x.size)))

    class Relative(CartesianToBearingRange):
        """Bearing from the robot's nose: the heading is the third component of the state."""

        def function(self, state, noise=False, **kwargs):
            x, y, theta = np.asarray(state.state_vector, dtype=float)
            dx, dy = self.landmark[0] - x, self.landmark[1] - y
            bearing = (np.arctan2(dy, dx) - theta + np.pi) % (2 * np.pi) - np.pi
            return StateVectors(np.stack((bearing, np.sqrt(dx**2 + dy**2))))

        landmark: np.ndarray = Property(default=None)

        def logpdf(self, state1, state2, **kwargs):
            z = np.asarray(state1.state_vector, dtype=float)
            bearing, distance = np.asarray(self.function(state2), dtype=float)
            error = (z[0] - bearing + np.pi) % (2 * np.pi) - np.pi
            return -0.5 * (error / SIGMA_PHI) ** 2 - 0.5 * ((z[1] - distance) / SIGMA_R) ** 2

    when, covariance = datetime(2020, 1, 1), np.diag((SIGMA_PHI**2, SIGMA_R**2))
    sensors = [
        Relative(ndim_state=3, mapping=(0, 1), noise_covar=covariance, landmark=landmark)
        for landmark in work.landmarks.T
    ]
    cloud = START[:, None] + START_SD[:, None] * np.random.normal(size=(3, M))
    state = ParticleState(StateVectors(cloud), weight=np.full(M, 1.0 / M), timestamp=when)
    predictor, updater = ParticlePredictor(Arc()), ParticleUpdater(None, resampler=None)
    resampler = ESSResampler(threshold=M / 2, resampler=SystematicResampler())
    path = []
    for step, z in enumerate(work.z):
        state = predictor.predict(state, timestamp=when + (step + 1) * timedelta(seconds=DT))
        for k, sensor in enumerate(sensors):
            seen = Detection(np.array(((z[1, k],), (z[0, k],))), state.timestamp, sensor)
            state = updater.update(SingleHypothesis(state, seen))
        w = np.exp(np.asarray(state.log_weight, dtype=float))
        x, y, theta = np.asarray(state.state_vector, dtype=float)
        path.append((w @ x, w @ y, np.arctan2(w @ np.sin(theta), w @ np.cos(theta))))
        state = resampler.resample(state)
    return np.array(path)


def compile_kernel() -> ctypes.CDLL:
    """Build kernel.c with what the machine has; raises if there is no C compiler."""
    target = Path(tempfile.gettempdir()) / f"kernel-{(HERE / 'kernel.c').stat().st_mtime_ns}.so"
    if not target.exists():
        flags = ["-O3", "-march=native", "-ffast-math", "-shared", "-fPIC"]
        subprocess.run(
            ["cc", *flags, str(HERE / "kernel.c"), "-o", str(target), "-lmvec", "-lm"], check=True
        )
    return ctypes.CDLL(str(target))


def c_kernel(work: Work, M: int, seed: int = 0) -> np.ndarray:
    """The bound: the whole loop in C, float32, compiled for this machine, one thread."""
    library = compile_kernel()
    T, _, L = work.z.shape
    f32 = ctypes.POINTER(ctypes.c_float)
    setting = np.array(
        (V, OMEGA, DT, SIGMA_V, SIGMA_OMEGA, SIGMA_R, SIGMA_PHI, *START, *START_SD), np.float32
    )
    landmarks, z = work.landmarks.astype(np.float32), work.z[:, :2].astype(np.float32)
    path = np.empty((T, 3), np.float32)
    library.run(
        *(ctypes.c_int(n) for n in (M, L, T, seed + 1)),
        *(a.ctypes.data_as(f32) for a in (setting, landmarks, z, path)),
    )
    return path.astype(float)


CONTESTANTS = {
    "pfkit": pfkit,
    "particles": particles,
    "stone soup": stone_soup,
    "filterpy": filterpy,
    "PythonRobotics": python_robotics,
    "C": c_kernel,
}
