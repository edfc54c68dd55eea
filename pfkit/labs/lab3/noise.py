"""Q6: which noise is which?"""

from __future__ import annotations

import numpy as np

from pfkit.labs.items import (
    Choice,
    Code,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import rng_of

MUTANT = MUTANTS["lab3"]


def diffuse(state, sigma, rng):
    """One step of a target that stands still: fresh noise for every particle and axis."""
    return state + sigma * rng.standard_normal(state.shape)


def _sample(f, M=4000, sigma=3.0, at=0.0):
    """The noise alone: what a cloud that starts at one place became, minus that place."""
    return np.asarray(f(np.full((2, M), at), sigma, rng_of(11)), dtype=float) - at


def _draws(f):
    """Does chance come from rng, and afresh at each call?"""
    one, two = rng_of(4), rng_of(4)
    first, again, second = (f(np.zeros((2, 5)), 1.0, rng) for rng in (one, two, one))
    return bool(np.array_equal(first, again) and not np.array_equal(first, second))


Q6 = Question(
    "q6",
    "Which noise is which?",
    (
        Choice(
            id="q6a",
            title="pf.FixedTarget(sigma=2), pf.Position(sigma=3)",
            key="c",
            options={
                "a": "Process variance 2 px^2, measurement variance 3 px^2",
                "b": "Measurement sd 2 px, process sd 3 px",
                "c": "Process sd 2 px per step, so variance 4 px^2; measurement variance 9 px^2",
                "d": "Process variance 2 px^2, measurement sd 3 px",
            },
            feedback={
                "a": "In pfkit every sigma is a standard deviation; square it for the variance.",
                "b": "Motion models hold the process noise, sensors the measurement noise.",
                "c": "Yes. In the literature Q and R change places: say which noise, and sd or "
                "variance.",
                "d": "Both are standard deviations.",
            },
        ),
        Code(
            id="q6b",
            title="Process noise",
            points=2,
            reference=diffuse,
            hints=(
                "Every particle gets its own noise, in x and in y.",
                "A standard normal times s has standard deviation s.",
                "state + sigma * rng.standard_normal(state.shape).",
            ),
            properties=(
                Property("the shape stays (2, M)", lambda f: _sample(f).shape == (2, 4000)),
                Property(
                    "noise is added to the state",
                    lambda f: abs(_sample(f, at=100.0).mean()) < 10,
                ),
                Property("its chance comes from rng, afresh at each call", _draws),
                Property(
                    "sd 3 in x and in y, within 5 standard errors",
                    lambda f: (
                        np.abs(_sample(f).std(axis=1) - 3).max() < 5 * 3 / np.sqrt(8000)
                        or f"sd {_sample(f).std(axis=1).round(2)}"
                    ),
                ),
                Property(
                    "mean 0, within 5 standard errors",
                    lambda f: np.abs(_sample(f).mean(axis=1)).max() < 15 / np.sqrt(4000),
                ),
                Property(
                    "x and y are independent",
                    lambda f: abs(np.mean(_sample(f)[0] * _sample(f)[1])) < 5 * 9 / np.sqrt(4000),
                ),
            ),
            fingerprint=lambda f: [
                *_sample(f).std(axis=1),
                *np.clip(_sample(f).mean(axis=1), -3, 3),
                np.mean(_sample(f)[0] * _sample(f)[1]) if _sample(f).std() > 0.1 else 0.0,
                float(_sample(f, at=100.0).mean() < -50),
                2 * float(_draws(f) is True),
            ],
            atol=0.6,
            misconceptions=MUTANT["q6b"],
        ),
    ),
)


QUESTIONS = (Q6,)
