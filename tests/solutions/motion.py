# ruff: noqa
# mypy: ignore-errors
"""Motion: solutions. One block per item; `# %% id` names the answer cell it belongs to.

They use the chapter's own `motion`, `u` and `together`.
"""

# %% rigid
rigid = ("c", 60)

# %% split
split = ("b", 60)

# %% hand
radius = 0.5 / (np.pi / 2)
hand = (radius, -radius)


# %% arc
def arc(pose, v, omega, dt):
    # BEGIN SOLUTION
    x, y, theta = pose
    half = omega * dt / 2
    c = v * dt * np.sinc(half / np.pi)
    heading = pf.wrap(theta + omega * dt)
    return np.array([x + c * np.cos(theta + half), y + c * np.sin(theta + half), heading])
    # END SOLUTION


# %% sample
def sample(pose, u, alpha, rng):
    # BEGIN SOLUTION
    (v, omega, dt), M = u, pose.shape[1]
    v_hat = v + np.sqrt(alpha[0] * v**2 + alpha[1] * omega**2) * rng.standard_normal(M)
    omega_hat = omega + np.sqrt(alpha[2] * v**2 + alpha[3] * omega**2) * rng.standard_normal(M)
    return arc(pose, v_hat, omega_hat, dt)
    # END SOLUTION


# %% wheels
left, right = 0.1 * 8, 0.1 * 12
wheels = ((left + right) / 2, (right - left) / 0.5, 1.0 / 0.8)

# %% vehicle
vehicle = "b"

# %% odometry
rot1, trans, rot2 = pf.odometry_control([2, 1, np.radians(90)], [1, 2, np.radians(-150)])
odometry = (np.degrees(rot1), trans, np.degrees(rot2))

# %% drift
drift = 0.02 * np.sqrt(np.sum(np.arange(1, 11) ** 2))

# %% literal
literal = "b"


# %% rigid_x
def rigid_x(rng):
    # BEGIN SOLUTION
    own = common = rng.standard_normal((3, 500)) * [[0.1], [0.1], [0]]
    for _ in range(12):
        own, common = motion.sample(own, u, rng), together(common, u, rng)
    spread = [np.sqrt(cloud[:2].var(axis=1).sum()) for cloud in (own, common)]
    return spread[0] / spread[1]
    # END SOLUTION


# %% split_x
def split_x(rng):
    # BEGIN SOLUTION
    model, spread = pf.VelocityMotion((0.02, 0, 0, 0)), []
    for steps in (1, 16):
        cloud = np.zeros((3, 2000))
        for _ in range(steps):
            cloud = model.sample(cloud, np.array([1.0, 0.0, 4 / steps]), rng)
        spread.append(cloud[0].std())
    return spread[0] / spread[1]
    # END SOLUTION


# %% why
why = (
    "A wrong turn bends the track and swings everything that follows, so the cloud bends. "
    "Particles are different guesses at what the robot did, so each needs errors of its own."
)
