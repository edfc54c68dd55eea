# ruff: noqa
# mypy: ignore-errors
"""Resampling: solutions. One block per item; `# %% id` names the answer cell it belongs to."""

# %% clock
clock = ("c", 50)

# %% best
best = ("d", 50)

# %% hand
hand = (2, 2, 0, 1, 0)

# %% variance
variance = (5 * 0.25 * 0.75, 0.25 * 0.75)

# %% survive
survive = (1 - (1 - 0.012) ** 100, min(1, 100 * 0.012))


# %% comb
def comb(w, rng):
    # BEGIN SOLUTION
    edges = np.cumsum(w / np.sum(w))
    edges[np.flatnonzero(w)[-1] :] = np.inf
    return np.searchsorted(edges, (np.arange(w.size) + rng.random()) / w.size, side="right")
    # END SOLUTION


# %% leftover
def leftover(w):
    # BEGIN SOLUTION
    rest = w.size * w - np.floor(w.size * w)
    return rest / rest.sum()
    # END SOLUTION


# %% clock_x
def clock_x(scheme, N, rng):
    # BEGIN SOLUTION
    of_a, age = N // 2, 0
    while 0 < of_a < N:
        ancestors = scheme(np.full(N, 1 / N), rng)
        of_a, age = np.sum(ancestors < of_a), age + 1  # the first ones are of cluster A
    return age
    # END SOLUTION


# %% best_x
def best_x(w):
    # BEGIN SOLUTION
    order = np.empty(w.size, dtype=int)
    order[::2] = np.flatnonzero(w > 1 / w.size)
    order[1::2] = np.flatnonzero(w < 1 / w.size)
    return order
    # END SOLUTION


# %% when
when = "b"

# %% why
why = (
    "The number of copies is random, so the share of a hypothesis drifts even at equal weights, "
    "and zero is for ever. Combs or strata slow this down, and so does resampling rarely."
)
