"""What a student is given in lab 4: three films, models by name, and measures of error."""

import numpy as np

import pfkit as pf
from pfkit.labs.target import AREA, anywhere, around, target_log, track

film = target_log("fixed", "low")  # a target that stands still, seen with little noise
circle = target_log("circle", "high")  # one that goes round, seen with much
half_false = target_log("fixed", "outliers")  # half of its measurements are false


def model_of(name, sigma, sigma_theta=0.05):
    """One of the three motion models by name."""
    if name == "fixed":
        return pf.FixedTarget(sigma)
    return {"line": pf.LineTarget, "circle": pf.CircleTarget}[name](sigma, sigma_theta)


def start_of(name, log, shape, rng):
    """Particles around the true start (sd 20 px), with a heading if the model has one."""
    return around(log.start[: 2 if name == "fixed" else 3], shape, rng, sigma=20.0)


def auc(score: np.ndarray, label: np.ndarray) -> float:
    """Probability that a random false measurement has a lower score than a random honest one."""
    bad, good = score[label][:, None], score[~label][None, :]
    return float(np.mean((bad < good) + 0.5 * (bad == good)))


def measurement_error(films: pf.Log) -> np.ndarray:
    """Distance of each measurement from the truth.

    Parameters
    ----------
    films : Log of one film or of several, from `target_log`

    Returns
    -------
    array (frames, films), px
    """
    assert films.truth is not None
    off = np.stack(films.z).reshape(len(films), 2, -1) - films.truth[:2].T[..., None]
    return np.hypot(off[:, 0], off[:, 1])


__all__ = [
    "AREA", "anywhere", "around", "auc", "circle", "film", "half_false", "measurement_error",
    "model_of", "start_of", "target_log", "track",
]  # fmt: skip
