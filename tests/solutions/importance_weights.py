# ruff: noqa
# mypy: ignore-errors
"""Importance weights: solutions. One block per item; `# %% id` names the answer cell it belongs to."""

# %% narrow
narrow = ("b", 70)

# %% dim
dim = ("d", 80)

# %% hand
w = np.array([2.5, 1.0, 0.4])
hand = w * np.array([1, 1, 3]) / np.sum(w * np.array([1, 1, 3]))

# %% ess
five = np.array([0.4, 1.0, 0.4, 2.5, 0.4])
ess = five.sum() ** 2 / np.sum(five**2)

# %% unbiased
unbiased = "b"

# %% threshold
threshold = 1000 / (1 + 1000 * 999 * 4e-10)


# %% from_variance
def ess_from_variance(s2, M):
    # BEGIN SOLUTION
    return M / (1 + M * (M - 1) * s2)
    # END SOLUTION


# %% estimate
def estimate(f, log_p, log_q):
    # BEGIN SOLUTION
    log_w = log_p - log_q
    w = np.exp(log_w - log_w.max())
    return np.sum(w * f) / np.sum(w)
    # END SOLUTION


# %% narrow_x
def narrow_x(rng):
    # BEGIN SOLUTION
    x = 0.4 * rng.standard_normal(1000)
    return np.exp(pf.log_gaussian(x, 1) - pf.log_gaussian(x, 0.4)).mean()
    # END SOLUTION


# %% dim_x
def dim_x(rng):
    # BEGIN SOLUTION
    x = rng.uniform(-5, 5, (3, 20_000))
    log_w, _ = pf.normalise(pf.log_gaussian(x, 0.3).sum(axis=0))
    return pf.ess(log_w) / 20_000
    # END SOLUTION


# %% why
why = (
    "In its tails the weights grow without bound, and draws there are too rare to be seen. "
    "The effective sample size knows only the draws it has."
)
