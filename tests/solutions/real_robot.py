# ruff: noqa
# mypy: ignore-errors
"""Real robot: solutions. One block per item; `# %% id` names the answer cell it belongs to."""

# %% biased
biased = ("c", 70)

# %% lost
lost = ("c", 60)

# %% held
held = 0.1 * 0.2 + 0.6 * 0.1 + 0.2 * 0.3

# %% lever
lever = 40 * np.sin(np.radians(3))


# %% follow
def follow(u):
    x = y = theta = 0.0
    for v, omega, dt in np.asarray(u).T:
        half = omega * dt / 2
        chord = v * dt * np.sinc(half / np.pi)
        x += chord * np.cos(theta + half)
        y += chord * np.sin(theta + half)
        theta += omega * dt
    return x, y, theta


# %% bias
def fit_bias(r, expected, s, ids):
    return np.array([np.mean((r - expected)[s == i]) for i in ids])


# %% biased_x
def biased_run(rng):
    log = lab.minute()
    sensor = pf.Range(log.world, sigma_r=3.0, nu=4)
    bel = pf.gaussian_prior(500, log.start, (0.2, 0.2, 0.02), rng)
    history = pf.run(log, bel, pf.ComposedMotion(), sensor, rng)
    return pf.rmse(history.estimate, log.truth), np.mean(history.position_sd)


# %% lost_x
def found(rng):
    log = lab.stretch()
    sensor = pf.RangeBearing(log.world, sigma_r=0.45, sigma_phi=0.02, nu=4)
    bel = pf.uniform_prior(1000, log.world, rng)
    for _, u, z, _ in log:
        bel = pf.predict(bel, u, pf.ComposedMotion(), rng)
        bel, _ = pf.tempered_update(bel, z, sensor, rng)
        if bel.ess < bel.M / 2:
            bel = pf.resample(bel, pf.systematic, rng)
    return pf.position_error(pf.mean_pose(bel), log.truth[:, -1])


# %% cause
cause = "b"

# %% third
third_answer = "b"

# %% since
since = "c"

# %% report
report = (
    "I ask for errors in metres of dead reckoning and of the filter, over several seeds and with "
    "an interval. I ask which part of the data the settings were chosen on."
)
