# ruff: noqa
# mypy: ignore-errors
"""Diversity: solutions. One block per item; `# %% id` names the answer cell it belongs to."""

# %% gauge
gauge = ("c", 60)

# %% lie
lie = ("b", 60)

# %% near
near = (1 - np.pi * 0.3**2 / 80) ** 200

# %% shrink
shrink = (2 * (1 + 0.3**2), (1 - 0.3**2) ** 0.5)

# %% kld
kld = 217


# %% regularised
def regularised(x, h, rng):
    # BEGIN SOLUTION
    mean = x.mean(axis=1)[:, None]
    noise = rng.multivariate_normal(np.zeros(len(x)), np.cov(x), x.shape[1]).T
    return mean + np.sqrt(1 - h * h) * (x - mean) + h * noise
    # END SOLUTION


# %% enough
def enough(cells, bound):
    # BEGIN SOLUTION
    for n in range(1, len(cells) + 1):
        if n >= bound(len(set(cells[:n].tolist()))):
            return n
    return len(cells)
    # END SOLUTION


# %% distinct_x
def distinct_x(M, T, rng, runs):
    # BEGIN SOLUTION
    left = []
    for _ in range(runs):
        a = np.arange(M)
        for _ in range(T):
            a = rng.choice(a, M)
        left.append(np.unique(a).size)
    return np.array(left)
    # END SOLUTION


# %% lie_x
def lie_x(v, q, r, rng, runs):
    # BEGIN SOLUTION
    x, P = np.zeros(runs), 1.0
    for t in range(1, 41):
        z = v * t + rng.normal(0, r, runs)
        P = P + q
        x = (x * r**2 + z * P) / (P + r**2)
        P = P * r**2 / (P + r**2)
    return (x - 40 * v) ** 2
    # END SOLUTION


# %% count
count = "c"

# %% scans
scans = "b"

# %% why
why = (
    "Copies of one particle have equal weights, so the ESS is M. If the truth had no particle "
    "near it all are wrong together. Count distinct particles, and move the copies apart."
)
