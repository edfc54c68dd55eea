# ruff: noqa
# mypy: ignore-errors
"""Particle filter: solutions. One block per item; `# %% id` names the answer cell it belongs to."""

# %% no_copy
no_copy = ("d", 80)

# %% frozen
frozen = ("b", 60)

# %% hand
x = np.array([4.0, 5, 5, 6, 6])
w = np.exp(-0.5 * (4.6 - (10 - x)) ** 2)
w /= w.sum()
hand = w[0]

# %% ess
ess = 1 / np.sum(w**2)

# %% proposal
proposal = "b"

# %% norm
norm = "c"


# %% update
def update(log_w, log_likelihood):
    # BEGIN SOLUTION
    total = log_w + log_likelihood
    log_sum = total.max() + np.log(np.sum(np.exp(total - total.max())))
    return total - log_sum, log_sum
    # END SOLUTION


# %% sir
def sir(state, log_w, rng):
    # BEGIN SOLUTION
    M = log_w.size
    edges = np.cumsum(np.exp(log_w))
    edges[-1] = np.inf
    ancestors = np.searchsorted(edges, (np.arange(M) + rng.random()) / M)
    return state[:, ancestors], np.full(M, -np.log(M))
    # END SOLUTION


# %% no_copy_x
def no_copy_x(M, steps, rng):
    # BEGIN SOLUTION
    log = pf.simulate_log(start_pose, route[:, :steps], motion, sensor, rng)
    bel = pf.gaussian_prior(M, start_pose, [0.5, 0.5, 0.1], rng)
    return pf.run(log, bel, motion, sensor, rng, threshold=0).ess[-1]
    # END SOLUTION


# %% frozen_x
def frozen_x(sensor, M, rng):
    # BEGIN SOLUTION
    state, log_w = pf.uniform_prior(M, world, rng).state, np.full(M, -np.log(M))
    for step in range(1, 41):
        log_w, _ = update(log_w, sensor.log_likelihood(sensor.sample(pose, rng), state))
        state, log_w = sir(state, log_w, rng)
        if len(set(state[0])) < 5:
            break
    return step
    # END SOLUTION


# %% blind
blind = (
    "It looks at weights only, and copies of one guess weigh the same, so it is M in any wrong "
    "place. The number of distinct particles would have told us."
)
