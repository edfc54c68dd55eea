# ruff: noqa
# mypy: ignore-errors
"""Estimates: solutions. One block per item; `# %% id` names the answer cell it belongs to."""

# %% halfway
halfway = ("a", 60)

# %% cancel
cancel = ("b", 60)

# %% hand
hand = (0.3 + 0.5 + 0.4 + 1.35 + 2, 2, 1)

# %% turn
turn = (np.degrees(np.arctan2(1, 4 - 2)), np.hypot(1, 2) / 7)

# %% total
total = (0.5**2, 0.7 * 0.3 * 4**2)

# %% ask
ask = 1 - 3 / 20


# %% direction
def direction(theta, w):
    # BEGIN SOLUTION
    mean = np.sum(w * np.exp(1j * theta)) / np.sum(w)
    R = np.abs(mean)
    if R < 1e-9:
        return np.nan, R
    return np.angle(mean), R
    # END SOLUTION


# %% best
def best(x, w, loss):
    # BEGIN SOLUTION
    expected = [np.sum(w * loss(np.hypot(*(x - report[:, None])))) for report in x.T]
    return x[:, np.argmin(expected)]
    # END SOLUTION


# %% halfway_x
def halfway_x(p, d, s, rng, runs):
    # BEGIN SOLUTION
    centre = d * (rng.random(runs) >= p)
    truth = rng.normal(centre, s)
    return np.stack(((truth - (1 - p) * d) ** 2, truth**2))
    # END SOLUTION


# %% length_x
def length_x(M, sigma, rng, runs):
    # BEGIN SOLUTION
    theta = rng.normal(0, sigma, (runs, M))
    return np.abs(np.exp(1j * theta).mean(axis=1))
    # END SOLUTION


# %% which
which = "c"

# %% stale
stale = "c"

# %% why
why = (
    "No: the mean has the smallest expected squared error, whatever the shape. It may stand in a "
    "wall, far from all particles. What to report depends on what an error costs."
)
