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


# %% recover
d, phi, left = pf.inverse_arc((1, 2, np.radians(90)), (1.75, 3.299, np.radians(40)))
recover = (d / 2, phi / 2, left / 2)


# %% invert
def invert(pose0, pose1):
    # BEGIN SOLUTION
    dx, dy, change = pf.between(pose0, pose1)
    beta = np.arctan2(dy, dx)
    distance = np.hypot(dx, dy) / np.sinc(beta / np.pi)
    return np.array([distance, 2 * beta, pf.wrap(change - 2 * beta)])
    # END SOLUTION


# %% jacobian
jacobian = "b"


# %% density
def density(pose1, u, alpha, pose0):
    # BEGIN SOLUTION
    v, omega, dt = u
    distance, turn, extra = invert(pose0, pose1)
    errors = distance / dt - v, turn / dt - omega, extra / dt
    log_p = 0
    for error, a, b in zip(errors, alpha[::2], alpha[1::2]):
        var = a * v**2 + b * omega**2
        log_p = log_p - error**2 / (2 * var) - 0.5 * np.log(2 * np.pi * var)
    bend = np.sinc(turn / 2 / np.pi)
    chord = distance * bend
    return log_p - np.log(chord * bend * dt**3 / 2)
    # END SOLUTION


# %% rescale
rescale = 0.08 * 0.1 / 0.5


# %% rigid_x
def rigid_x(M, steps, rng):
    # BEGIN SOLUTION
    own = common = rng.standard_normal((3, M)) * [[0.1], [0.1], [0]]
    for _ in range(steps):
        own, common = motion.sample(own, u, rng), together(common, u, rng)
    spread = [np.sqrt(cloud[:2].var(axis=1).sum()) for cloud in (own, common)]
    return spread[0] / spread[1]
    # END SOLUTION


# %% split_x
def split_x(M, n, rng):
    # BEGIN SOLUTION
    model, spread = pf.VelocityMotion((0.02, 0, 0, 0)), []
    for steps in (1, n):
        cloud = np.zeros((3, M))
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
