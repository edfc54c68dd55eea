# ruff: noqa
# mypy: ignore-errors
"""Drift: solutions. One block per item; `# %% id` names the answer cell it belongs to.

They use the chapter's own `books`.
"""

# %% aside
aside = ("c", 60)

# %% oneway
oneway = ("b", 60)

# %% wheels
left, right = 0.1 * 8, 0.1 * 12
wheels = ((left + right) / 2, (right - left) / 0.5, 1.0 / 0.8)

# %% printed
printed = (1, 0, 0)

# %% vehicle
vehicle = "b"

# %% odometry
rot1, trans, rot2 = pf.odometry_control([2, 1, np.radians(90)], [1, 2, np.radians(-150)])
odometry = (np.degrees(rot1), trans, np.degrees(rot2))


# %% odometer
def odometer(ticks, N, r, L):
    # BEGIN SOLUTION
    left, right = 2 * np.pi * r * ticks / N
    pose = np.zeros(3)
    for d, turn in zip((left + right) / 2, (right - left) / L):
        pose = pf.drive_arc(pose, d, turn)
    return pose
    # END SOLUTION


# %% drift
drift = 0.02 * np.sqrt(np.sum(np.arange(1, 11) ** 2))

# %% crossover
crossover = (12 / 2) ** 2 * 0.5

# %% square
x_ccw, x_cw = 0.042, -0.293
square = (np.degrees((x_ccw + x_cw) / (4 * 4)), np.degrees((x_ccw - x_cw) / (4 * 4)))

# %% scale
scale = "b"


# %% aside_x
def aside_x(n, bias, sigma, rng):
    # BEGIN SOLUTION
    pose = np.zeros(3)
    for turn in bias + sigma * rng.standard_normal(n):
        pose = pf.drive_arc(pose, 1.0, turn)
    return pose[1]
    # END SOLUTION


# %% oneway_x
def oneway_x(robot, side, rng):
    # BEGIN SOLUTION
    end = pf.encoder_odometry(pf.square_turns(side, books), robot)[:2, -1]
    eps = (end[0] + 0.01 * rng.standard_normal()) / (2 * side)
    new = pf.WheelGeometry(0.1, 0.1, books.L * (1 - eps / (np.pi / 2)))
    turns = pf.square_turns(side, new, clockwise=True)
    return np.hypot(*pf.encoder_odometry(turns, robot)[:2, -1])
    # END SOLUTION


# %% why
why = (
    "What repeats itself grows like n, and noise like its root, so no noise covers a bias for long. "
    "It is measured on squares in both directions and taken out; what is left is noise."
)
