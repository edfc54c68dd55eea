# ruff: noqa
# mypy: ignore-errors
"""Outliers: solutions. One block per item; `# %% id` names the answer cell it belongs to."""

# %% lock
lock = ("b", 60)

# %% ushape
ushape = ("c", 60)

# %% byhand
density = np.exp(pf.log_gaussian(5 - np.arange(5.0), 1.0))
mixed = 0.9 * density + 0.1 / 20
byhand = (density[4] / density.sum(), mixed[4] / mixed.sum())

# %% peak
peak = 1e4 / (2 * np.pi)

# %% unit
unit = "d"


# %% mixture
def mixture(log_p, epsilon, A):
    # BEGIN SOLUTION
    return np.logaddexp(np.log(1 - epsilon) + log_p, np.log(epsilon / A))
    # END SOLUTION


# %% responsibility
def responsibility(log_w, log_p, epsilon, A):
    # BEGIN SOLUTION
    L = np.sum(np.exp(log_w + log_p))
    return (epsilon / A) / ((1 - epsilon) * L + epsilon / A)
    # END SOLUTION


# %% lock_x
def lock_x(rng):
    # BEGIN SOLUTION
    log = target.target_log("circle", "outliers")[:60]
    motion, honest = pf.CircleTarget(sigma=1.4, sigma_theta=0.01), pf.Position(sigma=5.0)
    bel = target.anywhere(1000, rng, D=3)
    return target.track(log, bel, motion, honest, rng, gate=1e-4).rejected.mean()
    # END SOLUTION


# %% ushape_x
def ushape_x(rng):
    # BEGIN SOLUTION
    clean, shares = target.target_log("circle", "low")[:60], []
    motion = pf.CircleTarget(sigma=1.4, sigma_theta=0.01)
    for variance in (1e-4, 1000, 5000):
        bel, sensor = target.around(clean.start, 300, rng), pf.Position(np.sqrt(variance))
        seen = target.track(clean, bel, motion, sensor, rng, gate=1e-4)
        shares.append(seen.rejected.mean())
    return shares
    # END SOLUTION


# %% why
why = (
    "A wide cloud gives every report a mean likelihood of about 1/A, below the threshold, so all "
    "are rejected and it stays wide. A mixture compares with chance. I would watch rejections."
)
