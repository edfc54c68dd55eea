"""Lab 4, part 2: half of the measurements are false. Q13 to Q16."""

from __future__ import annotations

import numpy as np

import pfkit as pf
from pfkit.labs.items import (
    Choice,
    Code,
    Experiment,
    Misconception,
    Numeric,
    Prediction,
    Property,
)
from pfkit.labs.lab import Question
from pfkit.labs.lab4_tuning import MODELS, SIGMA, model_of, start_of
from pfkit.labs.mutants import MUTANTS
from pfkit.labs.statistics import z_of_mean
from pfkit.labs.target import AREA, anywhere, around, target_log, track

MUTANT = MUTANTS["lab4"]
FILM, FALSE = target_log("fixed", "low"), target_log("fixed", "outliers")
HOME = FILM.start[:2]
IS_FALSE = np.array([bool(k[0]) for k in FALSE.outlier or ()])


def rng_of(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


# -- Q13: detecting outliers -----------------------------------------------------------------


def gate(likelihood, threshold):
    """Reject a measurement whose mean likelihood over the particles is below the threshold."""
    return bool(np.mean(likelihood) < threshold)


def mixture(likelihood, epsilon, area):
    """Density of a measurement that is false with probability epsilon."""
    return (1 - epsilon) * likelihood + epsilon / area


def likelihoods(rng, runs):
    """Mean likelihood of each of 200 frames, (200, runs), from a filter that expects outliers."""
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / AREA)
    bel = around(HOME, (runs, 200), rng, sigma=5.0)
    return track(FALSE[:200], bel, pf.FixedTarget(1.4), sensor, rng).likelihood


def auc(score: np.ndarray, label: np.ndarray) -> float:
    """Probability that a random false measurement has a lower score than a random honest one."""
    bad, good = score[label][:, None], score[~label][None, :]
    return float(np.mean((bad < good) + 0.5 * (bad == good)))


def _aucs(f, rng, runs):
    found = np.asarray(f(rng, runs), dtype=float)
    if found.shape != (200, runs):
        raise ValueError(f"expected scores of shape (200, {runs}), got {found.shape}")
    return np.array([auc(found[:, k], IS_FALSE[:200]) for k in range(runs)])


_SURE, _MIXED = np.array([1e-3, 2e-3, 4e-4]), np.array([3e-2, 1e-9, 1e-9, 1e-9])

Q13 = Question(
    "q13",
    "Detecting outliers",
    (
        Code(
            id="q13a",
            title="A gate",
            reference=gate,
            hints=(
                "Which single number says how probable the measurement is under the belief?",
                "Average the likelihoods over the particles, before normalising.",
                "np.mean(likelihood) < threshold.",
            ),
            properties=(
                Property("an improbable measurement is rejected", lambda f: bool(f(_SURE, 0.1))),
                Property("a probable one is kept", lambda f: not f(_SURE, 1e-4)),
                Property(
                    "one lucky particle of four does not decide alone",
                    lambda f: bool(f(_MIXED, 0.01)) and not f(_MIXED, 0.005),
                ),
                Property(
                    "copying every particle changes nothing",
                    lambda f: all(
                        bool(f(np.tile(_SURE, 50), t)) == bool(f(_SURE, t))
                        for t in (1e-4, 1.1e-3, 2e-3, 0.1)
                    ),
                ),
            ),
            fingerprint=lambda f: [
                float(bool(f(x, t)))
                for x in (_SURE, _MIXED, np.tile(_SURE, 50))
                for t in (1e-6, 1e-4, 1.1e-3, 3e-3, 1e-2, 0.2, 0.3, 0.5)
            ],
            misconceptions=MUTANT["q13a"],
        ),
        Code(
            id="q13b",
            title="A mixture",
            reference=mixture,
            hints=(
                "Two cases: honest with probability 1 - epsilon, false with epsilon.",
                "A false measurement falls anywhere in the image: density 1/area.",
                "(1 - epsilon) * likelihood + epsilon / area.",
            ),
            properties=(
                Property(
                    "epsilon = 0 changes nothing",
                    lambda f: np.allclose(f(_SURE, 0.0, 100.0), _SURE),
                ),
                Property(
                    "epsilon = 1 knows nothing",
                    lambda f: np.allclose(f(_SURE, 1.0, 100.0), 0.01),
                ),
                Property(
                    "it integrates to one over the image",
                    lambda f: np.isclose(np.sum(f(_BOX, 0.3, 100.0)), 1.0),
                ),
                Property(
                    "it is a sum, not a choice, of the two parts",
                    lambda f: np.allclose(f(np.array([0.02, 0.01]), 0.5, 100.0), [0.015, 0.01]),
                ),
            ),
            fingerprint=lambda f: f(np.array([0.0, 1e-3, 0.05, 0.2]), 0.3, 40.0),
            misconceptions=MUTANT["q13b"],
        ),
        Experiment(
            id="q13c",
            title="Does the mean likelihood tell false from honest?",
            points=2,
            claim="the mean likelihood ranks honest frames above false ones: AUC above .95",
            test="median over runs of the area under the ROC curve, against the known labels",
            runs=5,
            margin="AUC .9996, sd below .001: over 40 standard errors",
            measure=_aucs,
            reference=likelihoods,
            hints=(
                "lab.track(...).likelihood has one row per frame.",
                "Use the mixture as the sensor, so that outliers do not carry the filter away.",
                "pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA).",
            ),
            properties=(
                Property(
                    "AUC above .95",
                    lambda x: np.median(x) > 0.95 or f"it is {np.median(x):.3f}",
                ),
            ),
            misconceptions=(
                Misconception(
                    "upside-down",
                    "gives high scores to false measurements",
                    (
                        "Your AUC is close to 0: the ranking is perfect, and upside down.",
                        "A false measurement has a low likelihood.",
                        "Return the likelihood itself, not its negative or inverse.",
                    ),
                    lambda rng, runs: -likelihoods(rng, runs),
                    lambda x: np.median(x) < 0.05,
                ),
                Misconception(
                    "normalised",
                    "does not depend on the measurement: normalised weights have the mean 1/M",
                    (
                        "All your scores are alike. What is the mean of M weights that sum to one?",
                        "Normalising divides out exactly what the detector needs.",
                        "lab.track(...).likelihood is taken before the weights are normalised.",
                    ),
                    lambda rng, runs: np.full((200, runs), 1 / 200),
                    lambda x: abs(np.median(x) - 0.5) < 0.1,
                ),
            ),
        ),
    ),
)

_BOX = np.full(100, 0.01)  # a density on 100 cells of size 1


# -- Q14: best precision ---------------------------------------------------------------------


def precision(model, rng, runs):
    """Mean error of frames 50 to 250, a fresh film of the circling target in each run."""
    films = target_log("circle", "high", seed=int(rng.integers(2**31)), runs=runs)
    bel = start_of(model, films, (runs, 200), rng)
    motion = model_of(model, SIGMA[model], 0.01 if model == "circle" else 0.05)
    return track(films[:250], bel, motion, pf.Position(20.0), rng).error[50:].mean(axis=0)


def _paired(f, rng, runs):
    seed = int(rng.integers(2**31))  # the same films for all three models
    found = [np.asarray(f(m, rng_of(seed), runs), dtype=float) for m in MODELS]
    if any(x.shape != (runs,) for x in found):
        raise ValueError(f"expected one number per run, got shape {found[0].shape}")
    return np.stack(found, axis=1)


Q14 = Question(
    "q14",
    "Best precision under noise of 20 px",
    (
        Experiment(
            id="q14a",
            title="Fixed, line, circle: paired over 20 films",
            points=2,
            claim="the better the model, the smaller the error, film by film; fixed is between "
            "8 and 14 px, circle below 6",
            test="paired z > 3 for fixed - line and for line - circle; means in the bands",
            runs=20,
            margin="z 21 and 13, sd of their logarithm .2, against 3; 11.1 px (.19), 3.9 px (.16): 7 sd",
            measure=_paired,
            reference=precision,
            hints=(
                "One number per run: the mean error of frames 50 to 250.",
                "The seed of the films comes from rng, so the three models see the same films.",
                "films = lab.target_log('circle', 'high', seed=int(rng.integers(2**31)), runs=runs).",
            ),
            properties=(
                Property(
                    "line beats fixed, paired",
                    lambda x: (
                        z_of_mean(x[:, 0] - x[:, 1], 0) > 3 or f"means {x.mean(0).round(1)} px"
                    ),
                ),
                Property(
                    "circle beats line, paired",
                    lambda x: (
                        z_of_mean(x[:, 1] - x[:, 2], 0) > 3 or f"means {x.mean(0).round(1)} px"
                    ),
                ),
                Property(
                    "fixed between 8 and 14 px, circle below 6 px",
                    lambda x: (
                        (8 < x[:, 0].mean() < 14 and x[:, 2].mean() < 6)
                        or f"means {x.mean(0).round(1)} px"
                    ),
                ),
            ),
            misconceptions=(
                Misconception(
                    "low-noise",
                    "uses the film with noise of 1 px",
                    (
                        "Your errors are below 2 px. Which film did you use?",
                        "The question is about measurements with sd 20 px.",
                        "lab.target_log('circle', 'high', ...).",
                    ),
                    lambda m, rng, runs: _quiet_film(m, rng, runs),
                    lambda x: x[:, 0].mean() < 8,
                ),
                Misconception(
                    "raw",
                    "is the error of the measurements, not of the filter",
                    (
                        "25 px is what the camera does without any filter.",
                        "Compare the weighted mean of the particles with the truth.",
                        "lab.track(...).error.",
                    ),
                    lambda m, rng, runs: 25.0 + 0.3 * rng.standard_normal(runs),
                    lambda x: x.mean() > 20,
                ),
            ),
        ),
        Choice(
            id="q14b",
            title="A report gives .5, 1.1 and 1.2 px for this experiment. Can that be?",
            key="a",
            options={
                "a": "No: the order is that of another data set, and .5 px from a fixed model on a "
                "target at 2 px per frame is out of reach",
                "b": "Yes, with enough particles",
                "c": "Yes, with the right process noise",
                "d": "Yes, by luck: one run proves nothing",
            },
            feedback={
                "a": "Yes: these are numbers of a film with noise of 1 px; check what was asked.",
                "b": "Particles remove Monte-Carlo error; 11 px of lag and noise remain.",
                "c": "Your sweep of Q11 covers it: 11 px is the best the fixed model does.",
                "d": "A mean over hundreds of frames does not drop from 11 px to .5 by luck.",
            },
        ),
    ),
)


def _quiet_film(m, rng, runs):
    films = target_log("circle", "low", seed=int(rng.integers(2**31)), runs=runs)
    bel = start_of(m, films, (runs, 200), rng)
    return track(films[:250], bel, model_of(m, 3.0), pf.Position(1.0), rng).error[50:].mean(axis=0)


# -- Q15: what moves the detector? -----------------------------------------------------------

BELIEVED = (1e-4, 1.0, 100.0, 1000.0, 2000.0, 1e4)


def rejected(variance, rng, runs):
    """Share of 150 honest frames that a gate at 1e-4 rejects; known start, target stands still."""
    bel = around(HOME, (runs, 300), rng, sigma=1.0)
    sensor = pf.Position(np.sqrt(variance))
    run = track(FILM[:150], bel, pf.FixedTarget(1.4), sensor, rng, gate=1e-4)
    return run.rejected.mean(axis=0)


def _rejections(f, rng, runs):
    rows = [np.asarray(f(v, rng, runs), dtype=float) for v in BELIEVED]
    if any(r.shape != (runs,) for r in rows):
        raise ValueError(f"expected one share per run, got shape {rows[0].shape}")
    return np.stack(rows, axis=1)


Q15 = Question(
    "q15",
    "What moves the detector?",
    (
        Prediction(
            id="q15a",
            title="Rejected share of honest frames as the believed sensor variance grows",
            key="c",
            options={
                "a": "It falls: a modest sensor forgives",
                "b": "It rises",
                "c": "It falls from nearly all to none, then jumps to all",
                "d": "It does not depend on it",
            },
        ),
        Experiment(
            id="q15b",
            after="q15a",
            title="A U-shape",
            points=2,
            claim="above .8 at variance .0001, below .05 from 1 to 1,000, all at 2,000 and 10,000",
            test="mean share over runs at each variance",
            runs=4,
            margin=".992 (sd .004), 0, 1: over 12 standard errors",
            measure=_rejections,
            reference=rejected,
            hints=(
                "lab.track(..., gate=1e-4).rejected is True where the gate was closed.",
                "One number per run: the mean over frames.",
                "pf.Position(np.sqrt(variance)).",
            ),
            properties=(
                Property(
                    "an overconfident sensor: more than .8 rejected",
                    lambda x: x[:, 0].mean() > 0.8 or f"{x[:, 0].mean():.2f}",
                ),
                Property(
                    "in between: below .05",
                    lambda x: x[:, 1:4].mean(0).max() < 0.05 or f"{x.mean(0)[1:4].round(2)}",
                ),
                Property(
                    "too modest: all rejected",
                    lambda x: bool((x[:, 4:] == 1).all()) or f"{x.mean(0)[4:].round(2)}",
                ),
            ),
            misconceptions=(
                Misconception(
                    "accepted",
                    "gives the share that is accepted",
                    (
                        "Your curve is upside down.",
                        "rejected is True where the gate was closed.",
                        "run.rejected.mean(axis=0), without one minus.",
                    ),
                    lambda v, rng, runs: 1 - rejected(v, rng, runs),
                    lambda x: x[:, 1:4].mean() > 0.95 and x[:, 4:].mean() < 0.05,
                ),
                Misconception(
                    "from-anywhere",
                    "starts anywhere, where the mean likelihood is about 1/area whatever you believe",
                    (
                        "Your gate never opens. How likely is any measurement if you know nothing?",
                        "1/area is 3.3e-6, far below the threshold of 1e-4.",
                        "Start around the truth: lab.around(lab.film.start[:2], (runs, 300), rng).",
                    ),
                    lambda v, rng, runs: _rejected_from_anywhere(v, rng, runs),
                    lambda x: x[:, 2:].mean() > 0.95,
                ),
            ),
        ),
        Numeric(
            id="q15c",
            title="Variance at which even a perfect hit has a density of 1e-4",
            key=1e4 / (2 * np.pi),
            tol=5.0,
            unit="px^2",
            hints=(
                "What is the highest value of the density in two dimensions?",
                "The peak is 1/(2 pi variance).",
                "variance = 1/(2 pi 1e-4).",
            ),
            misconceptions=(
                Misconception(
                    "one-dimension",
                    "uses the peak of a one-dimensional Gaussian",
                    (
                        "The measurement has two components.",
                        "In two dimensions the peak is 1/(2 pi variance), without a root.",
                        "variance = 1/(2 pi 1e-4).",
                    ),
                    1e8 / (2 * np.pi),
                    lambda x: abs(x / (1e8 / (2 * np.pi)) - 1) < 0.01,
                ),
                Misconception(
                    "deviation",
                    "is a standard deviation",
                    (
                        "Square your number.",
                        "The unit asked for is px^2.",
                        "variance = 1/(2 pi 1e-4).",
                    ),
                    np.sqrt(1e4 / (2 * np.pi)),
                    lambda x: abs(x - np.sqrt(1e4 / (2 * np.pi))) < 1,
                ),
                Misconception(
                    "no-two-pi",
                    "leaves 2 pi out",
                    (
                        "Write the constant of the density down.",
                        "The peak is 1/(2 pi variance).",
                        "variance = 1/(2 pi 1e-4).",
                    ),
                    1e4,
                ),
            ),
        ),
    ),
)


def _rejected_from_anywhere(v, rng, runs):
    run = track(
        FILM[:150],
        anywhere((runs, 300), rng),
        pf.FixedTarget(1.4),
        pf.Position(np.sqrt(v)),
        rng,
        gate=1e-4,
    )
    return run.rejected.mean(axis=0)


# -- Q16: undetected outliers ----------------------------------------------------------------


def four_filters(rng, runs):
    """Median error of 200 frames, half of them false: four filters, one number per run."""
    motion, sensor = pf.FixedTarget(1.4), pf.Position(5.0)
    mixed = pf.OutlierMixture(sensor, 0.5, 1 / AREA)
    known = around(HOME, (runs, 200), rng, sigma=5.0)
    film = FALSE[:200]
    results = (
        track(film, known, motion, sensor, rng),
        track(film, known, motion, mixed, rng),
        track(film, known, motion, sensor, rng, gate=1e-4),
        track(film, anywhere((runs, 200), rng), motion, sensor, rng, gate=1e-4),
    )
    return np.array([np.median(r.error, axis=0) for r in results])


def _four(f, rng, runs):
    found = np.asarray(f(rng, runs), dtype=float)
    if found.shape != (4, runs):
        raise ValueError(f"expected shape (4, {runs}), got {found.shape}")
    return found.T


def _middle(x):
    return np.median(x, axis=0)


Q16 = Question(
    "q16",
    "Outliers that nobody detects",
    (
        Experiment(
            id="q16a",
            title="Naive, mixture, gate from a known start, gate from anywhere",
            points=2,
            claim="naive above 5 px; mixture and gate from a known start below 1 px; "
            "the same gate from anywhere above 100 px",
            test="medians over runs",
            runs=5,
            margin="28.7 (sd 1.0), .66 (.02), .65 (.03), 199 (6) px: over 14 standard errors",
            measure=_four,
            reference=four_filters,
            hints=(
                "Four rows of medians over frames, one number per run in each.",
                "Only the sensor, the gate and the start differ.",
                "np.median(lab.track(...).error, axis=0) for each.",
            ),
            properties=(
                Property(
                    "naive: above 5 px",
                    lambda x: _middle(x)[0] > 5 or f"{_middle(x)[0]:.1f} px",
                ),
                Property(
                    "mixture: below 1 px",
                    lambda x: _middle(x)[1] < 1 or f"{_middle(x)[1]:.2f} px",
                ),
                Property(
                    "gate from a known start: below 1 px",
                    lambda x: _middle(x)[2] < 1 or f"{_middle(x)[2]:.2f} px",
                ),
                Property(
                    "gate from anywhere: above 100 px, it never opens",
                    lambda x: _middle(x)[3] > 100 or f"{_middle(x)[3]:.1f} px",
                ),
            ),
            misconceptions=(
                Misconception(
                    "no-gate",
                    "has a gate that is never closed",
                    (
                        "Your gate from a known start is as bad as no gate.",
                        "Which argument of lab.track sets the threshold?",
                        "gate=1e-4.",
                    ),
                    lambda rng, runs: four_filters(rng, runs)[[0, 1, 0, 0]],
                    lambda x: _middle(x)[2] > 5 and _middle(x)[1] < 1,
                ),
                Misconception(
                    "known-start-always",
                    "starts the last filter near the truth, too",
                    (
                        "Your last two filters are the same.",
                        "What does a gate see if the filter does not know where the target is?",
                        "lab.anywhere((runs, 200), rng) for the last one.",
                    ),
                    lambda rng, runs: four_filters(rng, runs)[[0, 1, 2, 2]],
                    lambda x: _middle(x)[3] < 5,
                ),
            ),
        ),
        Choice(
            id="q16b",
            title="A gate that works from a known start locks the filter out from anywhere. "
            "What would you build in?",
            key="d",
            options={
                "a": "A lower threshold, found by trial",
                "b": "No gate at all",
                "c": "More particles",
                "d": "A mixture in the likelihood, which needs no threshold and lets a lost filter "
                "listen",
            },
            feedback={
                "a": "It must lie below 1/area at the start and above it later: no constant does.",
                "b": "Then half of the measurements drag the filter away.",
                "c": "The mean likelihood from anywhere is about 1/area for any number.",
                "d": "Yes: (1 - epsilon) N + epsilon / area, with both constants from the sensor.",
            },
        ),
    ),
)

QUESTIONS = (Q13, Q14, Q15, Q16)
