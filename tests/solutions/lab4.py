# ruff: noqa
# mypy: ignore-errors
"""Solutions to lab 4. One block per item; `# %% id` names the answer cell it belongs to.

The markers BEGIN SOLUTION and END SOLUTION are those of otter-grader.
"""

# %% q9a
q9a = ("c", 60)


# %% q9b
def sensor_sweep(variance, M, rng, runs):
    """Mean error in px of frames 50 to 120, one per run."""
    # BEGIN SOLUTION
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=100.0)
    motion, sensor = pf.FixedTarget(1.4), pf.Position(np.sqrt(variance))
    return lab.track(lab.film[:120], bel, motion, sensor, rng).error[50:].mean(axis=0)
    # END SOLUTION


# %% q9c
q9c = "b"

# %% q10a
q10a = ("c", 50)


# %% q10b
def motion_sweep(variance, M, frames, rng, runs):
    """Mean error of all frames and of the last hundred: shape (2, runs)."""
    # BEGIN SOLUTION
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=100.0)
    motion = pf.FixedTarget(np.sqrt(variance))
    error = lab.track(lab.film[:frames], bel, motion, pf.Position(5.0), rng).error
    return np.array([error.mean(axis=0), error[-100:].mean(axis=0)])
    # END SOLUTION


# %% q11a
q11a = ("a", 80)


# %% q11b
def ratio_sweep(model, ratio, M, rng, runs):
    """Mean error in px of frames 50 to 120, one per run."""
    # BEGIN SOLUTION
    bel = lab.start_of(model, lab.circle, (runs, M), rng)
    motion = lab.model_of(model, np.sqrt(ratio * 400))
    run = lab.track(lab.circle[:120], bel, motion, pf.Position(20.0), rng)
    return run.error[50:].mean(axis=0)
    # END SOLUTION


# %% q12a
def error_with(model, M, rng, runs):
    """Mean error in px of frames 50 to 150, one per run."""
    # BEGIN SOLUTION
    sigma, sigma_theta = {"fixed": (6.0, 0.0), "line": (1.0, 0.05), "circle": (0.5, 0.01)}[model]
    bel = lab.start_of(model, lab.circle, (runs, M), rng)
    motion = lab.model_of(model, sigma, sigma_theta)
    run = lab.track(lab.circle[:150], bel, motion, pf.Position(20.0), rng)
    return run.error[50:].mean(axis=0)
    # END SOLUTION


# %% q12b
q12b = "c"


# %% q13a
def gate(likelihood, threshold):
    """True if the measurement is to be rejected."""
    # BEGIN SOLUTION
    return np.mean(likelihood) < threshold
    # END SOLUTION


# %% q13b
def mixture(likelihood, epsilon, area):
    """Density of the measurement: array like likelihood, per px²."""
    # BEGIN SOLUTION
    return (1 - epsilon) * likelihood + epsilon / area
    # END SOLUTION


# %% q13c
def scores(film, M, rng, runs):
    """A score of each frame, low for false measurements: shape (frames, runs)."""
    # BEGIN SOLUTION
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA)
    bel = lab.start_of("circle", film, (runs, M), rng)
    return lab.track(film, bel, lab.model_of("circle", 1.4), sensor, rng).likelihood
    # END SOLUTION


# %% q14a
def precision(model, sigma, M, rng, runs):
    """Mean errors of filter and measurements, a film per run: shape (2, runs)."""
    # BEGIN SOLUTION
    films = lab.target_log("circle", "high", seed=int(rng.integers(2**31)), runs=runs)[:150]
    bel = lab.start_of(model, films, (runs, M), rng)
    motion = lab.model_of(model, sigma, 0.01 if model == "circle" else 0.05)
    error = lab.track(films, bel, motion, pf.Position(20.0), rng).error
    raw = lab.measurement_error(films)
    return np.array([error[50:].mean(axis=0), raw[50:].mean(axis=0)])
    # END SOLUTION


# %% q14b
q14b = "a"

# %% q15a
q15a = ("a", 70)


# %% q15b
def rejected(variance, threshold, M, rng, runs):
    """Share of rejected frames, one per run."""
    # BEGIN SOLUTION
    bel = lab.around(lab.film.start[:2], (runs, M), rng)
    sensor = pf.Position(np.sqrt(variance))
    run = lab.track(lab.film[:120], bel, pf.FixedTarget(1.4), sensor, rng, gate=threshold)
    return run.rejected.mean(axis=0)
    # END SOLUTION


# %% q15c
q15c = 1 / (2 * np.pi * 1e-4)


# %% q16a
def four_filters(M, sigma, gate, rng, runs):
    """Median errors in px of four filters: shape (4, runs)."""
    # BEGIN SOLUTION
    film, motion, sensor = lab.half_false[:120], pf.FixedTarget(1.4), pf.Position(sigma)
    mixed = pf.OutlierMixture(sensor, 0.5, 1 / lab.AREA)
    known = lab.around(lab.half_false.start[:2], (runs, M), rng, sigma=5.0)
    lost = lab.anywhere((runs, M), rng)
    tracks = [
        lab.track(film, known, motion, sensor, rng),
        lab.track(film, known, motion, mixed, rng),
        lab.track(film, known, motion, sensor, rng, gate=gate),
        lab.track(film, lost, motion, sensor, rng, gate=gate),
    ]
    return np.array([np.median(t.error, axis=0) for t in tracks])
    # END SOLUTION


# %% q16b
q16b = "d"
