"""Draw a cloud: each particle drives the arc with a speed and a turn rate of its own.

Every model here is a function of (pose, u, alpha, rng).
"""

import numpy as np

from pfkit.labs import code
from pfkit.labs.motion.arcs import arc, near, sinc


def _variances(u, alpha):
    v, omega, _ = u
    return np.array((alpha[0] * v**2 + alpha[1] * omega**2, alpha[2] * v**2 + alpha[3] * omega**2))


def _errors(variances, M, rng):
    return np.sqrt(variances)[:, None] * rng.standard_normal((2, M))


def _drive(pose, u, errors):
    return arc(pose, u[0] + errors[0], u[1] + errors[1], u[2])


def _ends(f, u, alpha, M=4000, seed=5):
    found = f(np.zeros((3, M)), np.array(u), alpha, np.random.default_rng(seed))
    return np.asarray(found, dtype=float)


def _says(found, wanted):
    ok = abs(found / wanted - 1) < 0.08
    return True if ok else f"found a standard deviation of {found:.4f}, not {wanted:.4f}"


def _noise_free(f):
    pose = np.array([[0.0, 1.0], [2.0, 3.0], [0.5, -2.0]])
    found = f(pose.copy(), np.array((1.0, 0.4, 0.5)), (0, 0, 0, 0), np.random.default_rng(1))
    return near(np.asarray(found), arc(pose, 1.0, 0.4, 0.5))


def _own(f):
    x, _, theta = _ends(f, (1.0, 0.3, 0.5), (0.02, 0.01, 0.05, 0.05), 50)
    return np.unique(x).size == 50 and np.unique(theta).size == 50


def _speed(f):
    return _says(_ends(f, (2.0, 0.0, 0.5), (0.04, 0, 0, 0))[0].std(), 0.2)


def _cross(f):
    x, y, _ = _ends(f, (0.0, 1.0, 0.5), (0, 0.04, 0, 0))
    return _says(np.sqrt(np.mean(x**2 + y**2)), 0.1 * sinc(0.25))


def _still(f):
    return np.abs(_ends(f, (0.0, 0.0, 0.5), (0.1, 0.1, 0.1, 0.1), 20)).max() == 0


def _bends(f):
    x, y, theta = _ends(f, (1.0, 0.0, 1.0), (0, 0, 0.05, 0), 200)
    return (
        np.allclose(x, sinc(theta / 2) * np.cos(theta / 2), atol=1e-9)
        and np.allclose(y, sinc(theta / 2) * np.sin(theta / 2), atol=1e-9)
        and theta.std() > 0
    )


@code(
    """Each particle with errors of its own
    First draw M wrong speeds and M wrong turn rates, then drive M arcs.
    np.sqrt(variance) * rng.standard_normal(M), with M = pose.shape[1].
    v_hat = v + np.sqrt(a1 * v**2 + a2 * omega**2) * rng.standard_normal(M), and arc(...).""",
    points=2,
)
def sample(pose, u, alpha, rng):
    return _drive(pose, u, _errors(_variances(u, alpha), pose.shape[1], rng))


sample.holds("with all alphas 0 it is the arc", _noise_free)
sample.holds("every particle ends somewhere else", _own)
sample.holds("speed has the variance alpha_1 v^2, within 8 %", _speed)
sample.holds(
    "turn rate has alpha_3 v^2 + alpha_4 omega^2, within 8 %",
    lambda f: _says(_ends(f, (1.0, 0.8, 0.5), (0, 0, 0.04, 0.09))[2].std(), 0.1562),
)
sample.holds("turning on the spot slips by alpha_2 omega^2, within 8 %", _cross)
sample.holds("a robot at rest gets no error", _still)
sample.holds("an error in omega bends the track and turns the heading", _bends)
sample.wrong(
    """one-error: draws one error for the whole cloud
    How many random numbers does your function draw for 50 particles?
    One robot errs once, but each particle is a different guess at that robot.
    rng.standard_normal(M) gives each particle its own.""",
    when=lambda f: not _own(f),
)(
    lambda pose, u, alpha, rng: _drive(
        pose, u, np.sqrt(_variances(u, alpha)) * rng.standard_normal(2)
    )
)


@sample.wrong(
    """adds its errors to the pose after a perfect drive
    A wheel slips during the drive. Where does the robot end that turned too far?
    Put the error into v and omega, and drive the wrong arc exactly.
    Draw v_hat and omega_hat first, then call arc with them.""",
    when=lambda f: _own(f) and _still(f) and not _bends(f),
)
def _on_pose(pose, u, alpha, rng):
    moved = arc(pose, *u)
    sd_v, sd_omega = np.sqrt(_variances(u, alpha))
    sd = u[2] * np.array((sd_v, sd_v, sd_omega))
    return moved + sd[:, None] * rng.standard_normal(moved.shape)


sample.wrong(
    """constant: gives the same error to a robot at rest and to one at full speed
    Should a parked robot drift?
    The variances multiply v^2 and omega^2.
    alpha_1 * v**2 + alpha_2 * omega**2""",
    when=lambda f: not _still(f),
)(lambda pose, u, alpha, rng: _drive(pose, u, _errors((alpha[0], alpha[2]), pose.shape[1], rng)))
sample.wrong(
    """no-root: takes the variance for a standard deviation
    What does a standard normal draw have to be multiplied by?
    By the standard deviation, the root of the variance.
    np.sqrt(alpha_1 * v**2 + alpha_2 * omega**2)""",
    when=lambda f: _own(f) and _still(f) and _bends(f) and _speed(f) is not True,
)(
    lambda pose, u, alpha, rng: _drive(
        pose, u, _errors(_variances(u, alpha) ** 2, pose.shape[1], rng)
    )
)
