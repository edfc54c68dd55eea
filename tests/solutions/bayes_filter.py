# ruff: noqa
# mypy: ignore-errors
"""Bayes filter: solutions. One block per item; `# %% id` names the answer cell it belongs to.

`zero_x` uses the chapter's own `drive`.
"""

# %% twice
twice = ("c", 70)

# %% zero
zero = ("d", 60)

# %% moved
bel = np.array([0.2, 0.2, 0.025, 0.025]) / 0.45
moved_by_hand = 0.9 * np.roll(bel, 1) + 0.1 * bel

# %% looked
products = moved_by_hand * np.array([0.2, 0.2, 0.9, 0.9])
looked_by_hand = (products[2] / products.sum(), products.sum())

# %% markov
markov = "b"

# %% evidence
evidence = "d"


# %% correct
def correct(bel, likelihood):
    # BEGIN SOLUTION
    joint = bel * likelihood
    return joint / joint.sum(), joint.sum()
    # END SOLUTION


# %% predict_line
def predict(bel, moves):
    # BEGIN SOLUTION
    return sum(p * np.roll(bel, cells) for cells, p in moves.items())
    # END SOLUTION


# %% twice_x
def twice_x(run, rng):
    # BEGIN SOLUTION
    low, high = 0.05, 2.0
    for _ in range(10):
        power = np.sqrt(low * high)
        beliefs, cells = run(power, rng)
        too_sure = beliefs.max(axis=1).mean() > np.mean(beliefs.argmax(axis=1) == cells)
        low, high = (low, power) if too_sure else (power, high)
    return np.sqrt(low * high)
    # END SOLUTION


# %% zero_x
def zero_x(steps, real, assumed, rng):
    # BEGIN SOLUTION
    _, after, cells, _, _ = drive(rng, B=100, T=steps, real=(0.8, real), assumed=(0.8, assumed))
    own = np.take_along_axis(after, cells[..., None], axis=2)[..., 0]
    return np.mean(own.min(axis=0) < 1e-6)
    # END SOLUTION


# %% why
why = (
    "A zero stays zero under every later product, while a small number grows back. "
    "The small number belongs into the sensor model, as the chance of a false report."
)
