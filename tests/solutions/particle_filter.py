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
def no_copy_x(rng):
    # BEGIN SOLUTION
    world = pf.worlds.arena()
    motion = pf.VelocityMotion(alpha=(0.02, 0.002, 0.002, 0.02, 0.002, 0.002))
    sensor = pf.RangeBearing(world, sigma_r=0.3, sigma_phi=0.1)
    route = pf.worlds.arena_route()[:, :50]
    log = pf.simulate_log(pf.worlds.ARENA_START, route, motion, sensor, rng)
    bel = pf.uniform_prior(1000, world, rng)
    return pf.run(log, bel, motion, sensor, rng, threshold=0).ess[-1]
    # END SOLUTION


# %% frozen_x
def frozen_x(rng):
    # BEGIN SOLUTION
    world, pose = pf.worlds.arena(), np.array([5.0, 4.0, 0.0])
    vague, bel = pf.RangeBearing(world, 2.0, 0.5), pf.uniform_prior(100, world, rng)
    for _ in range(60):
        bel, _ = pf.update(bel, vague.sample(pose, rng), vague)
        bel = pf.resample(bel, pf.systematic, rng)
    return np.unique(bel.state[0]).size
    # END SOLUTION


# %% blind
blind = (
    "It looks at weights only, and copies of one guess weigh the same, so it is M in any wrong "
    "place. The number of distinct particles would have told us."
)
