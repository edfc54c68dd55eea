# ruff: noqa
# mypy: ignore-errors
"""Exact beliefs: solutions. One block per item; `# %% id` names the answer cell it belongs to.

`gauss_x` uses the chapter's own `robots`, `even`, `move`, `look`, `match` and `bell`.
"""

# %% between
between = ("c", 60)

# %% toowide
toowide = ("d", 70)

# %% product
share = 3**2 / (3**2 + 1**2)
product_by_hand = (4 + share * (9 - 4), 3**2 * (1 - share))

# %% surprise
surprise = "c"

# %% gain
gain_by_hand = (10 + 0.8 * 3, 1 + 0.4 * 3, 2 - 0.4 * 5 * 0.4)


# %% kalman_1d
def kalman_1d(mean, var, u, var_u, z, var_z):
    # BEGIN SOLUTION
    mean, var = mean + u, var + var_u
    S = var + var_z
    K = var / S
    evidence = np.exp(-0.5 * (z - mean) ** 2 / S) / np.sqrt(2 * np.pi * S)
    return mean + K * (z - mean), (1 - K) * var, evidence
    # END SOLUTION


# %% kl
def kl(p, q):
    # BEGIN SOLUTION
    held = p > 0
    with np.errstate(divide="ignore"):
        return np.sum(p[held] * np.log(p[held] / q[held]))
    # END SOLUTION


# %% direction
direction = "a"

# %% lost
lost_by_hand = np.log(1 / (0.5 + 0.2))

# %% bent
bent_by_hand = (2**2, (1.5**2 + 2.5**2) / 2, (2.5**2 - 1.5**2) / 2)


# %% gauss_x
def gauss_x(doors, rates, steps, rng, runs):
    # BEGIN SOLUTION
    cell, z = robots(doors, steps, rng, runs, rates)
    exact = gauss = even(runs)
    for k in range(steps):
        if k:
            exact, gauss = move(exact), move(gauss)
        exact = look(exact, doors, z[k], rates)
        gauss = bell(*match(look(gauss, doors, z[k], rates)))
    own = np.arange(runs), cell[-1]
    return np.log([exact[own], gauss[own]])
    # END SOLUTION


# %% coarse_x
def coarse_x(h, sigma, rng, runs):
    # BEGIN SOLUTION
    x = rng.uniform(3, 7, runs)
    z = x + sigma * rng.standard_normal(runs)
    like = np.exp(pf.log_gaussian(z[:, None] - np.arange(h / 2, 10, h), sigma))
    density = like / like.sum(axis=1, keepdims=True) / h
    return pf.log_gaussian(z - x, sigma) - np.log(density[np.arange(runs), (x / h).astype(int)])
    # END SOLUTION


# %% table
table = "c"

# %% when
when = (
    "The first needs one bump, so a Kalman filter will do and costs nothing. "
    "The second has several bumps but few cells, so a grid is exact. "
    "The third needs 23 million cells and has many bumps: neither, it waits for particles."
)
