# ruff: noqa
# mypy: ignore-errors
"""Global localisation: solutions. One block per item; `# %% id` names the answer cell it belongs to.

They use the chapter's own `world`, `start`, `sensor`, `motion`, `g` and `forward`.
"""

# %% keep
keep = ("c", 60)

# %% luck
luck = ("c", 80)

# %% hand
hand = 6 / 27, 3 * (1 - (2 / 3) ** 3)

# %% mirror
mirror = "b"

# %% unnamed
unnamed = 2, 5

# %% nats
nats = 0.75 * np.log(3)

# %% founders
founders = np.exp(-1)


# %% copies
def copies(pose, n, centre):
    # BEGIN SOLUTION
    turn = 2 * np.pi / n * np.arange(n)
    dx, dy = pose[0] - centre[0], pose[1] - centre[1]
    x = centre[0] + np.cos(turn) * dx - np.sin(turn) * dy
    y = centre[1] + np.sin(turn) * dx + np.cos(turn) * dy
    return np.stack((x, y, pf.wrap(pose[2] + turn)))
    # END SOLUTION


# %% missing
def missing(W):
    # BEGIN SOLUTION
    W = W / W.sum()
    some = W[W > 0]
    return np.log(W.size) + np.sum(some * np.log(some))
    # END SOLUTION


# %% luck_x
def luck_x(sensor, bel, rng):
    # BEGIN SOLUTION
    log = pf.simulate_log(start, forward, motion, sensor, rng, batch=len(bel.log_w))
    bel = pf.run(log, bel, motion, sensor, rng).bel
    W = pf.hypothesis_mass(bel, pf.images(log.truth[:, -1, :, 0], g), 3.0)
    heaviest = W.argmax(axis=0)
    heaviest[W.max(axis=0) <= 0.01] = -1
    return heaviest
    # END SOLUTION


# %% prior
prior = "b"


# %% alive_x
def alive_x(M, sigma_r, rng):
    # BEGIN SOLUTION
    look = pf.MaximumLikelihood(pf.RangeBearing(world, sigma_r, 0.1))
    bel = pf.uniform_prior(M, world, rng)
    bel, _ = pf.update(bel, look.sample(start, rng), look)
    return np.sum(pf.hypothesis_mass(bel, pf.images(start, g), 1.5) > 0.01)
    # END SOLUTION


# %% report
report = (
    "Four poses explain all measurements, so the exact belief keeps four clouds and a single one "
    "means that three were lost. Which one is left is chance, one in four for the true one. "
    "Report over many seeds how often the true hypothesis is alive."
)
