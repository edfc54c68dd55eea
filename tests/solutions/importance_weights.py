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
def narrow_x(weigh, rng):
    # BEGIN SOLUTION
    def share(M):
        w = np.array([weigh(M, rng) for _ in range(20)])
        return np.mean(w.sum(axis=1) ** 2 / np.sum(w**2, axis=1)) / M

    return share(10_000) < 0.7 * share(100)
    # END SOLUTION


# %% dim_x
def dim_x(cloud, rng):
    # BEGIN SOLUTION
    M, ess = 100, 0
    while ess < 200:
        M = 2 * M
        log_w, _ = pf.normalise(cloud(M, rng))
        ess = pf.ess(log_w)
    return 100 * M / ess
    # END SOLUTION


# %% why
why = (
    "In its tails the weights grow without bound, and draws there are too rare to be seen. "
    "The effective sample size knows only the draws it has."
)
