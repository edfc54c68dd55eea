# ruff: noqa
# mypy: ignore-errors
"""Sensing: solutions. One block per item; `# %% id` names the answer cell it belongs to.

They use the chapter's own `world`, `pose`, `sensor` and `look`.
"""

# %% average
average = ("c", 60)

# %% beams
beams = ("d", 60)

# %% hand
hand = np.degrees(pf.wrap(np.arctan2(-2, -2) - np.radians(150)))

# %% weight
w = np.exp(-0.5 * np.array([[0.5, 0, 3, 2], [0.5, 3, 0, 2], [2, 0, 1, 0]]) ** 2).prod(axis=0)
weight = w[0] / w.sum()

# %% likelihood
likelihood = "b"

# %% sd
sd = np.exp(-36 / 18) / np.exp(-36 / 6)

# %% field
field = "b"


# %% expected
def expected(pose, m):
    # BEGIN SOLUTION
    dx, dy = m[0] - pose[0], m[1] - pose[1]
    return np.hypot(dx, dy), pf.wrap(np.arctan2(dy, dx) - pose[2])
    # END SOLUTION


# %% place
def place(pose, r, phi):
    # BEGIN SOLUTION
    x, y, theta = pose
    return x + r * np.cos(theta + phi), y + r * np.sin(theta + phi)
    # END SOLUTION


# %% score
def score(z, m, pose, sigma_r, sigma_phi):
    # BEGIN SOLUTION
    total = np.zeros(pose.shape[1])
    for (r, phi), mk in zip(z.T, m.T):
        r_hat, phi_hat = expected(pose, mk)
        total += pf.log_gaussian(r - r_hat, sigma_r)
        total += pf.log_gaussian(pf.wrap(phi - phi_hat), sigma_phi)
    return total
    # END SOLUTION


# %% average_x
def average_x(rng):
    # BEGIN SOLUTION
    (product, average), _ = look(rng, 2)
    return average / product
    # END SOLUTION


# %% beams_x
def beams_x(rng):
    # BEGIN SOLUTION
    office = pf.worlds.office()
    laser = pf.BeamModel(office, np.linspace(-np.pi / 2, np.pi / 2, 5), r_max=12.0)
    robot = laser.lengths(office.sample_poses(1, rng)) + 0.1 * rng.standard_normal((5, 1))
    cloud = laser.lengths(office.sample_poses(1000, rng))
    p = np.exp(pf.log_gaussian(robot - cloud, 0.1)).prod(axis=0)
    return np.mean(p == 0)
    # END SOLUTION


# %% why
why = (
    "Given the pose the errors are independent, so the densities multiply. An average adds unlike "
    "units and lets one good reading excuse an impossible one. Products underflow, sums of logs "
    "do not."
)
