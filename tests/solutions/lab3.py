# ruff: noqa
# mypy: ignore-errors
"""Solutions to lab 3. One block per item; `# %% id` names the answer cell it belongs to.

The markers BEGIN SOLUTION and END SOLUTION are those of otter-grader.
"""

# %% p1a
p1a = "c"

# %% p1b
p1b = 0.75, 0.75**4, 0.75**10

# %% p2a
p2a = 0.5 / 0.2, 0.3 / 0.3, 0.2 / 0.5


# %% p2b
def estimate(values, target, proposal):
    """Mean under the target; three arrays of one length."""
    # BEGIN SOLUTION
    w = target / proposal
    return np.sum(w * values) / np.sum(w)
    # END SOLUTION


# %% p2c
p2c = "b"


# %% p3a
def deprived(film, M, radius, rng, runs):
    """One True or False per run: is nobody within radius px of the truth?"""
    # BEGIN SOLUTION
    bel = lab.anywhere((runs, M), rng)
    run = lab.track(film, bel, pf.FixedTarget(1.0), pf.Position(10.0), rng)
    x, y = run.bel.state
    tx, ty = film.truth[:2, -1]
    return (np.hypot(x - tx, y - ty) > radius).all(axis=-1)
    # END SOLUTION


# %% p3b
p3b = "d"

# %% p3c
p3c = (
    "No particle is near the truth, and resampling only copies what is there. "
    "The cloud is narrow all the same, so the filter looks sure while it is wrong."
)

# %% p4a
p4a = ("c", 80)


# %% p4b
def ess_history(scheme, M, sd, rng, runs):
    """ESS before each resampling by the scheme, 50 frames: shape (50, runs)."""
    # BEGIN SOLUTION
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=5.0)
    run = lab.track(lab.film[:50], bel, pf.FixedTarget(1.0), pf.Position(sd), rng, scheme=scheme)
    return run.ess
    # END SOLUTION


# %% p5a
def bad_for_the_mean(rng):
    """A one-dimensional array of samples."""
    # BEGIN SOLUTION
    return np.concatenate([rng.normal(-10, 1, 300), rng.normal(10, 1, 300)])
    # END SOLUTION


# %% p5b
def circular_mean(theta, w):
    """Mean direction of angles theta (M,) in radians with weights w (M,)."""
    # BEGIN SOLUTION
    return np.arctan2(np.sum(w * np.sin(theta)), np.sum(w * np.cos(theta)))
    # END SOLUTION


# %% p5c
p5c = "a"


# %% p6a
def kde(x, samples, h):
    """Density at each x: shape (len(x),)."""
    # BEGIN SOLUTION
    d = (x[:, None] - samples[None, :]) / h
    return np.mean(np.exp(-0.5 * d**2) / (np.sqrt(2 * np.pi) * h), axis=1)
    # END SOLUTION


# %% p6b
def fit_scores(train, test):
    """Mean log density of test: Gaussian, histogram, KDE, mixture."""

    # BEGIN SOLUTION
    def normal(x, samples):
        mu, sd = samples.mean(), samples.std()
        return np.exp(-0.5 * ((x - mu) / sd) ** 2) / (sd * np.sqrt(2 * np.pi))

    edges = np.linspace(-15, 15, 31)
    counts = np.histogram(train, edges)[0] + 0.5
    height = counts / counts.sum() / np.diff(edges)
    cell = np.clip(np.searchsorted(edges, test, side="right") - 1, 0, 29)
    parts = train[train < train.mean()], train[train >= train.mean()]
    mixture = sum(len(part) / len(train) * normal(test, part) for part in parts)
    curves = normal(test, train), height[cell], kde(test, train, 0.6), mixture
    return [np.log(density).mean() for density in curves]
    # END SOLUTION


# %% p7a
def copies(scheme, w, rng, runs):
    """How many copies each particle got: whole numbers, shape (runs, M)."""
    # BEGIN SOLUTION
    return np.array([np.bincount(scheme(w, rng), minlength=len(w)) for _ in range(runs)])
    # END SOLUTION


# %% p7b
def final_error(film, threshold, sigma, M, rng, runs):
    """Error in x of the last estimate, px: shape (runs,)."""
    # BEGIN SOLUTION
    bel = lab.around(film.start[:2], (runs, M), rng, sigma=80.0)
    motion, sensor = pf.FixedTarget(sigma), pf.Position(300.0)
    for t, u, z, truth in film:
        bel, info = pf.step(bel, u, z, motion, sensor, rng, pf.multinomial, threshold)
    return pf.mean_pose(bel)[0] - truth[0]
    # END SOLUTION


# %% p7c
p7c = "c"

# %% p8a
a = 2 / (9 * 99)
p8a = 99 / (2 * 0.05) * (1 - a + np.sqrt(a) * 2.326) ** 3


# %% p8b
def success(side, radius, M, rng, runs):
    """One True or False per run: is somebody within radius px of the centre?"""
    # BEGIN SOLUTION
    x, y = side * (rng.random((2, runs, M)) - 0.5)
    return (np.hypot(x, y) < radius).any(axis=-1)
    # END SOLUTION


# %% p8c
p8c = "b"

# %% q1a
q1a = "b"


# %% q1b
def follow(D, wrong, M, rng, runs):
    """Mean error in px of frames 200 to 300, shape (runs,); the state has D = 2 or 3 components."""
    # BEGIN SOLUTION
    start = lab.line.start + np.array([0, 0, wrong])
    motion = pf.HeadingTarget(0.1, heading=start[2]) if D == 2 else pf.LineTarget(0.1, 0.02)
    bel = lab.around(start[:D], (runs, M), rng)
    run = lab.track(lab.line[:300], bel, motion, pf.Position(20.0), rng)
    return run.error[200:].mean(axis=0)
    # END SOLUTION


# %% q2a
q2a = 2.0 / (2 * np.pi / 688)

# %% q2b
q2b = "c"


# %% q2c
def circle_mean(state, dt):
    """State (5, ...) after dt: the position moves along theta, then theta turns."""
    # BEGIN SOLUTION
    x, y, theta, v, omega = state
    x, y = x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)
    return np.stack([x, y, pf.wrap(theta + omega * dt), v, omega])
    # END SOLUTION


# %% q3a
q3a = "a"

# %% q3b
q3b = "d"


# %% q3c
def log_likelihood(z, state, sigma):
    """log p(z | x) at every particle: z (2,), state (2, M), sigma in px; result (M,)."""
    # BEGIN SOLUTION
    dx, dy = z[0] - state[0], z[1] - state[1]
    return -(dx**2 + dy**2) / (2 * sigma**2) - np.log(2 * np.pi * sigma**2)
    # END SOLUTION


# %% q3d
def weights_of(log_l):
    """Normalised weights (M,) from log-likelihoods log_l (M,)."""
    # BEGIN SOLUTION
    w = np.exp(log_l - log_l.max())
    return w / w.sum()
    # END SOLUTION


# %% q4a
q4a = 5, 5, 1, 2


# %% q4b
def systematic(w, rng):
    """Ancestor indices, M whole numbers; w (M,) sums to one."""
    # BEGIN SOLUTION
    M = len(w)
    teeth = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), teeth), M - 1)
    # END SOLUTION


# %% q4c
def residual(w, rng):
    """Ancestor indices, M whole numbers, in any order."""
    # BEGIN SOLUTION
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    certain = np.repeat(np.arange(M), copies)
    left = M - len(certain)
    if left == 0:
        return certain
    rest = np.maximum(M * w - copies, 0)
    return np.concatenate([certain, rng.choice(M, left, p=rest / rest.sum())])
    # END SOLUTION


# %% q4d
def select(state, w, ancestors):
    """New state (2, n) and new weights (n,) after resampling."""
    # BEGIN SOLUTION
    return state[:, ancestors], np.full(len(ancestors), 1 / len(ancestors))
    # END SOLUTION


# %% q5a
q5a = 1 - (1 - 0.012) ** 100, 1 - (1 - 0.005) ** 100, 1, 0.5


# %% q5b
def survival(w, M):
    """Probability to survive: (multinomial, systematic)."""
    # BEGIN SOLUTION
    return 1 - (1 - w) ** M, min(1, M * w)
    # END SOLUTION


# %% q5c
def survived(scheme, w, M, rng):
    """One run: True or False."""
    # BEGIN SOLUTION
    weights = np.full(M, (1 - w) / (M - 1))
    weights[0] = w
    return 0 in scheme(weights, rng)
    # END SOLUTION


# %% q6a
q6a = "c"


# %% q6b
def diffuse(state, sigma, rng):
    """State (2, M) plus noise of sd sigma (px) on x and y of every particle."""
    # BEGIN SOLUTION
    return state + sigma * rng.standard_normal(state.shape)
    # END SOLUTION


# %% q7a
q7a = ("b", 70)


# %% q7b
def collapse(sigma, M, frames, rng, runs):
    """Distinct particles and last ESS: shape (2, runs)."""
    # BEGIN SOLUTION
    bel = lab.around(lab.film.start[:2], (runs, M), rng, sigma=20.0)
    run = lab.track(lab.film[:frames], bel, pf.FixedTarget(sigma), pf.Position(3.0), rng)
    distinct = [len(np.unique(x)) for x in run.bel.state[0]]
    return np.array([distinct, run.ess[-1]])
    # END SOLUTION


# %% q7c
q7c = "a"

# %% q8a
q8a = ("b", 60)


# %% q8b
def three_filters(M, sigma, rng, runs):
    """Mean errors in px of A, B, C: shape (3, runs)."""
    # BEGIN SOLUTION
    rows = []
    for options in ({"scheme": None, "weighted": False}, {"scheme": None}, {}):
        bel = lab.anywhere((runs, M), rng)
        motion, sensor = pf.FixedTarget(1.4), pf.Position(sigma)
        run = lab.track(lab.film[:200], bel, motion, sensor, rng, **options)
        rows.append(run.error[100:].mean(axis=0))
    return np.array(rows)
    # END SOLUTION
