# ruff: noqa
# mypy: ignore-errors
"""Solutions to lab 4. One block per item; `# %% id` names the answer cell it belongs to.

The markers BEGIN SOLUTION and END SOLUTION are those of otter-grader.
"""

# %% q9a
q9a = ("c", 60)


# %% q9b
def sensor_sweep(variance, rng, runs):
    """Mean error in px of frames 50 to 200, one per run."""
    # BEGIN SOLUTION
    return settled_error(np.sqrt(variance), rng, runs)
    # END SOLUTION


# %% q9c
q9c = "b"

# %% q10a
q10a = ("c", 50)


# %% q10b
def motion_sweep(variance, rng, runs):
    """Mean error of all frames and of the last hundred: shape (2, runs)."""
    # BEGIN SOLUTION
    bel = lab.around(lab.film.start[:2], (runs, 200), rng, sigma=100.0)
    motion = pf.FixedTarget(np.sqrt(variance))
    error = lab.track(lab.film[:400], bel, motion, pf.Position(5.0), rng).error
    return np.array([error.mean(axis=0), error[-100:].mean(axis=0)])
    # END SOLUTION


# %% q11a
q11a = ("a", 80)


# %% q11b
def ratio_sweep(model, ratio, rng, runs):
    """Mean error in px of frames 50 to 150, one per run."""
    # BEGIN SOLUTION
    bel = lab.start_of(model, lab.circle, (runs, 200), rng)
    motion = lab.model_of(model, np.sqrt(ratio * 400))
    run = lab.track(lab.circle[:150], bel, motion, pf.Position(20.0), rng)
    return run.error[50:].mean(axis=0)
    # END SOLUTION


# %% q12a
def error_with(model, M, rng, runs):
    """Mean error in px of frames 50 to 250, one per run."""
    # BEGIN SOLUTION
    sigma, sigma_theta = {"fixed": (6.0, 0.0), "line": (1.0, 0.05), "circle": (0.5, 0.01)}[model]
    bel = lab.start_of(model, lab.circle, (runs, M), rng)
    motion = lab.model_of(model, sigma, sigma_theta)
    run = lab.track(lab.circle[:250], bel, motion, pf.Position(20.0), rng)
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
def scores(rng, runs):
    """Mean likelihood of each frame: shape (200, runs)."""
    # BEGIN SOLUTION
    sensor = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA)
    bel = lab.around(lab.half_false.start[:2], (runs, 200), rng, sigma=5.0)
    return lab.track(lab.half_false[:200], bel, pf.FixedTarget(1.4), sensor, rng).likelihood
    # END SOLUTION


# %% q14a
def precision(model, rng, runs):
    """Mean error in px of frames 50 to 250, one per film."""
    # BEGIN SOLUTION
    films = lab.target_log("circle", "high", seed=int(rng.integers(2**31)), runs=runs)
    sigma, sigma_theta = {"fixed": (6.0, 0.0), "line": (1.0, 0.05), "circle": (0.5, 0.01)}[model]
    bel = lab.start_of(model, films, (runs, 200), rng)
    motion = lab.model_of(model, sigma, sigma_theta)
    return lab.track(films[:250], bel, motion, pf.Position(20.0), rng).error[50:].mean(axis=0)
    # END SOLUTION


# %% q14b
q14b = "a"

# %% q15a
q15a = ("a", 70)


# %% q15b
def rejected(variance, rng, runs):
    """Share of rejected frames, one per run."""
    # BEGIN SOLUTION
    bel = lab.around(lab.film.start[:2], (runs, 300), rng)
    sensor = pf.Position(np.sqrt(variance))
    run = lab.track(lab.film[:150], bel, pf.FixedTarget(1.4), sensor, rng, gate=1e-4)
    return run.rejected.mean(axis=0)
    # END SOLUTION


# %% q15c
q15c = 1 / (2 * np.pi * 1e-4)


# %% q16a
def four_filters(rng, runs):
    """Median errors in px of four filters: shape (4, runs)."""
    # BEGIN SOLUTION
    film, motion, sensor = lab.half_false[:200], pf.FixedTarget(1.4), pf.Position(5.0)
    mixed = pf.OutlierMixture(sensor, 0.5, 1 / lab.AREA)
    known = lab.around(lab.half_false.start[:2], (runs, 200), rng, sigma=5.0)
    lost = lab.anywhere((runs, 200), rng)
    tracks = [
        lab.track(film, known, motion, sensor, rng),
        lab.track(film, known, motion, mixed, rng),
        lab.track(film, known, motion, sensor, rng, gate=1e-4),
        lab.track(film, lost, motion, sensor, rng, gate=1e-4),
    ]
    return np.array([np.median(t.error, axis=0) for t in tracks])
    # END SOLUTION


# %% q16b
q16b = "d"
