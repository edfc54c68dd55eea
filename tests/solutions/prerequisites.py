# ruff: noqa
# mypy: ignore-errors
"""Prerequisites: solutions. One block per item; `# %% id` names its cell."""

# %% column
column = "b"

# %% door
door = 0.25 * 0.8 / (0.25 * 0.8 + 0.75 * 0.2)

# %% spread
spread = (0.1**2, 0.1 / 100**0.5)

# %% landmark
landmark = (1, 5, 0)

# %% heading
heading = "b"

# %% density
density = "b"

# %% turned
turned = (-1, 2)

# %% summed
summed = (4 + 1 + 2 * 1.5, 4 + 1 - 2 * 1.5)

# %% pooled
pooled = ((10 + 13 / 2) / 1.5, 1 / 1.5)

# %% scaled
scaled = (1 / 3, 0.3 / 3)
