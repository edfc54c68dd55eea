# ruff: noqa
# mypy: ignore-errors
"""Bayes filter: solutions. One block per item; `# %% id` names the answer cell it belongs to.

The experiments use the chapter's own `drive`.
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
def twice_x(rng):
    # BEGIN SOLUTION
    _, after, cells, _, _ = drive(rng, B=200, T=25, looks=2)
    claim, best = after[-1].max(axis=1), after[-1].argmax(axis=1)
    return claim.mean() - np.mean(best == cells[-1])
    # END SOLUTION


# %% zero_x
def zero_x(rng):
    # BEGIN SOLUTION
    _, after, cells, _, _ = drive(rng, T=40, real=(0.8, 0.05), assumed=(0.8, 1e-12))
    return float(after[np.arange(40), 0, cells[:, 0]].min() < 1e-6)
    # END SOLUTION


# %% why
why = (
    "A zero stays zero under every later product, while a small number grows back. "
    "The small number belongs into the sensor model, as the chance of a false report."
)
