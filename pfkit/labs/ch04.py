"""Chapter 4: sensing. Questions on what a measurement says about a pose."""

import numpy as np

import pfkit as pf
from pfkit.labs import (
    Choice,
    Code,
    Experiment,
    Lab,
    Misconception,
    Numeric,
    Prediction,
    Property,
    Question,
    Text,
)

# -- predictions --------------------------------------------------------------------------------

average = Prediction(
    id="average",
    title="Averaging likelihoods instead of multiplying them",
    options={
        "a": "as wide: both use all four numbers",
        "b": "wider by a few per cent",
        "c": "three to five times as wide",
        "d": "narrower, because averaging removes noise",
    },
    key="c",
)

beams = Prediction(
    id="beams",
    title="Share of weights that are exactly zero after five laser beams",
    options={
        "a": "none: a Gaussian is never zero",
        "b": "about one in a hundred",
        "c": "about one in ten",
        "d": "more than half",
    },
    key="d",
)

# -- by hand ------------------------------------------------------------------------------------

hand = Numeric(
    id="hand",
    title="Bearing, in degrees, of a landmark at (1, -1) from (3, 1), heading 150 degrees",
    key=75.0,
    tol=0.5,
    hints=(
        "Which way does the vector from the robot to the landmark point on the map?",
        "It is (-2, -2), which points to -135 degrees. Then subtract the heading.",
        "-135 - 150 = -285; add a whole turn.",
    ),
    misconceptions=(
        Misconception(
            "no-heading",
            "is the direction on the map, not seen from the robot's nose",
            (
                "The same landmark looks different when the robot turns.",
                "A bearing is measured from the nose: subtract the heading.",
                "-135 - 150, wrapped.",
            ),
            -135.0,
        ),
        Misconception(
            "no-wrap",
            "is not wrapped into (-180, 180]",
            (
                "Would a sensor report more than half a turn?",
                "Add or subtract whole turns until it lies between -180 and 180.",
                "-285 + 360.",
            ),
            -285.0,
        ),
        Misconception(
            "half-turn",
            "is half a turn off",
            (
                "Is the landmark really up and to the right of the robot?",
                "arctan(dy / dx) forgets both signs, and robot minus landmark turns both round.",
                "Use atan2(-2, -2) = -135 degrees.",
            ),
            -105.0,
        ),
        Misconception(
            "plus-heading",
            "adds the heading instead of subtracting it",
            (
                "Turn left: does what is in front of you move left or right?",
                "The bearing falls as the heading grows.",
                "-135 - 150, wrapped.",
            ),
            15.0,
        ),
        Misconception(
            "radians",
            "is in radians",
            ("Which unit was asked for?", "Degrees, please.", "1.309 rad times 180 / pi."),
            1.309,
            lambda x: abs(x - 1.309) < 0.01,
        ),
    ),
)

ERRORS = np.array([[0.5, 0.0, 3.0, 2.0], [0.5, 3.0, 0.0, 2.0], [2.0, 0.0, 1.0, 0.0]])
_P = np.exp(-0.5 * ERRORS**2)


def _first(p):
    return float(p[0] / p.sum())


weight = Numeric(
    id="weight",
    title="Weight of guess A after three measurements",
    key=_first(_P.prod(axis=0)),
    tol=0.004,
    hints=(
        "What does the new measurement say about each guess: exp(-e^2 / 2)?",
        "Multiply: 0.951 * 0.135 for A, 0.014 * 1 for B, and so on.",
        "The products are 0.129, 0.014, 0.008, 0.022; divide the first by their sum.",
    ),
    misconceptions=(
        Misconception(
            "averages",
            "averages the three likelihoods",
            (
                "B was three deviations off in bearing. Should one good range excuse that?",
                "Independent measurements multiply.",
                "0.951 * 0.135 for A; then the same for the others, and normalise.",
            ),
            _first(_P.mean(axis=0)),
        ),
        Misconception(
            "only-new",
            "uses the last measurement only",
            (
                "What did the first two measurements say?",
                "The old weight stays in: multiply it.",
                "Start from 0.951, 0.014, 0.014, 0.022.",
            ),
            _first(_P[2]),
        ),
        Misconception(
            "not-normalised",
            "is not divided by the sum",
            ("Weights sum to one.", "Add the four products.", "Divide 0.129 by 0.173."),
            float(_P.prod(axis=0)[0] / _P[:2].prod(axis=0).sum()),
        ),
        Misconception(
            "no-half",
            "uses exp(-e^2) for the new measurement",
            (
                "Look at the exponent of the Gaussian.",
                "At two deviations it has fallen to 0.135.",
                "The exponent is -e^2 / 2.",
            ),
            _first(_P[:2].prod(axis=0) * _P[2] ** 2),
        ),
    ),
)

# -- what a likelihood is -----------------------------------------------------------------------

likelihood = Choice(
    id="likelihood",
    title="The likelihood of a range at a particle is 0.8. What may you say?",
    options={
        "a": "the robot is at the particle with probability 0.8",
        "b": "if the robot were there, a reading like this one would have density 0.8 per metre",
        "c": "the particle is the best guess, because 0.8 is close to one",
        "d": "the likelihoods of all particles sum to one, so 0.2 is left for the others",
    },
    key="b",
    feedback={
        "a": "That is p(x | z); it also takes the prior, and the sum over all other places.",
        "b": "Yes: p(z | x) is a density of readings, with x given.",
        "c": "Densities have units and no ceiling: with a sharper sensor it could be 80.",
        "d": "Likelihoods sum to nothing in particular; normalised weights sum to one.",
    },
)

sd = Numeric(
    id="sd",
    title="How many times more the second particle weighs if 3 is a standard deviation",
    key=float(np.exp(4)),
    tol=0.5,
    hints=(
        "Write exp(-e^2 / (2 sigma^2)) twice, with sigma^2 = 9 and with sigma^2 = 3.",
        "The exponents are -36 / 18 = -2 and -36 / 6 = -6.",
        "exp(-2) / exp(-6).",
    ),
    misconceptions=(
        Misconception(
            "no-half",
            "leaves out the one half in the exponent",
            (
                "Look at the exponent of the Gaussian.",
                "It is e^2 over twice the variance.",
                "The exponents are -2 and -6.",
            ),
            float(np.exp(8)),
            lambda x: abs(x - np.exp(8)) < 10,
        ),
        Misconception(
            "inverse",
            "is the other way round",
            (
                "Which bell is wider?",
                "A deviation of 3 m is a variance of 9, the more forgiving one.",
                "Turn the fraction over.",
            ),
            float(np.exp(-4)),
            lambda x: abs(x - np.exp(-4)) < 0.005,
        ),
        Misconception(
            "keeps-constants",
            "compares densities; relative to the perfect particle the constants cancel",
            (
                "What does the perfect particle weigh in either case?",
                "The factor 1 / (sigma sqrt(2 pi)) is in both particles' weights.",
                "Only the exponents are left: -2 and -6.",
            ),
            float(np.exp(4) / np.sqrt(3)),
        ),
    ),
)

# -- code: there and back -----------------------------------------------------------------------


def _expected(pose, m):
    dx, dy = m[0] - pose[0], m[1] - pose[1]
    return np.hypot(dx, dy), pf.wrap(np.arctan2(dy, dx) - pose[2])


def _poses(seed, M=40):
    rng = np.random.default_rng(seed)
    return rng.uniform((-5, -5, -3), (5, 5, 3), (M, 3)).T


LANDMARK = np.array([1.2, -0.7])


def _apart(a, b):
    """Largest difference of two sets of angles on the circle."""
    return float(np.abs(pf.wrap(np.asarray(a) - b)).max())


def _ranges(f):
    pose = _poses(1)
    return np.allclose(f(pose, LANDMARK)[0], _expected(pose, LANDMARK)[0])


def _bearings(f):
    pose = _poses(2)
    return _apart(f(pose, LANDMARK)[1], _expected(pose, LANDMARK)[1]) < 1e-9


def _wrapped(f):
    phi = np.asarray(f(_poses(3, 400), LANDMARK)[1])
    return bool((phi > -np.pi - 1e-9).all() and (phi < np.pi + 1e-9).all())


def _rigid(f):
    """Turn and shift the world with the robot in it: nothing it measures changes."""
    pose, (c, s) = _poses(4), (np.cos(0.9), np.sin(0.9))

    def move(x, y):
        return np.array((c * x - s * y + 2, s * x + c * y - 1))

    moved = np.vstack((move(*pose[:2]), pf.wrap(pose[2] + 0.9)))
    here, there = f(pose, LANDMARK), f(moved, move(*LANDMARK))
    return np.allclose(here[0], there[0]) and _apart(here[1], there[1]) < 1e-9


def _both(f):
    r, phi = f(_poses(5), LANDMARK)
    return np.concatenate((np.ravel(r), np.ravel(phi)))


def _raw(pose, m):
    return np.arctan2(m[1] - pose[1], m[0] - pose[0])


def _range_to(pose, m):
    return _expected(pose, m)[0]


expected = Code(
    id="expected",
    title="Range and bearing that a pose expects",
    reference=_expected,
    properties=(
        Property("ranges are distances, in metres", _ranges),
        Property("bearings point from the robot's nose, up to whole turns", _bearings),
        Property("bearings lie between -pi and pi", _wrapped),
        Property("nothing changes when world and robot turn together", _rigid),
    ),
    fingerprint=_both,
    hints=(
        "Take the vector from robot to landmark: its length, and its direction on the map.",
        "np.hypot(dx, dy) and np.arctan2(dy, dx); then the heading.",
        "phi = pf.wrap(np.arctan2(dy, dx) - pose[2])",
    ),
    misconceptions=(
        Misconception(
            "no-heading",
            "forgets the heading",
            (
                "The robot turns on the spot. Does your bearing change?",
                "A bearing is measured from the nose.",
                "Subtract pose[2], then wrap.",
            ),
            lambda pose, m: (_range_to(pose, m), _raw(pose, m)),
        ),
        Misconception(
            "no-wrap",
            "does not wrap",
            (
                "Look at the largest of your bearings.",
                "A difference of two angles can be nearly two turns wide.",
                "Put pf.wrap(...) round the difference.",
            ),
            lambda pose, m: (_range_to(pose, m), _raw(pose, m) - pose[2]),
        ),
        Misconception(
            "arctan",
            "uses arctan of the quotient, which knows only half of the circle",
            (
                "Put the landmark behind the robot.",
                "dy / dx forgets which of the two was negative.",
                "np.arctan2(dy, dx) keeps both signs.",
            ),
            lambda pose, m: (
                _range_to(pose, m),
                pf.wrap(np.arctan((m[1] - pose[1]) / (m[0] - pose[0])) - pose[2]),
            ),
        ),
        Misconception(
            "reversed",
            "looks from the landmark to the robot: half a turn off",
            (
                "Where does your vector start?",
                "Landmark minus robot, not robot minus landmark.",
                "dx, dy = m[0] - pose[0], m[1] - pose[1]",
            ),
            lambda pose, m: (_range_to(pose, m), pf.wrap(_raw(pose, m) + np.pi - pose[2])),
        ),
        Misconception(
            "plus-heading",
            "adds the heading",
            (
                "Turn left: does the landmark move to the left or to the right?",
                "The bearing falls as the heading grows.",
                "Subtract pose[2].",
            ),
            lambda pose, m: (_range_to(pose, m), pf.wrap(_raw(pose, m) + pose[2])),
        ),
        Misconception(
            "degrees",
            "answers in degrees",
            (
                "Which unit has the heading?",
                "All angles here are in radians.",
                "Leave np.degrees away.",
            ),
            lambda pose, m: (_range_to(pose, m), np.degrees(_expected(pose, m)[1])),
        ),
    ),
)


def _place(pose, r, phi):
    x, y, theta = pose
    return x + r * np.cos(theta + phi), y + r * np.sin(theta + phi)


def _returns(poses):
    def holds(f):
        r, phi = _expected(poses, LANDMARK)
        x, y = f(poses, r, phi)
        return np.allclose(x, LANDMARK[0]) and np.allclose(y, LANDMARK[1])

    return holds


def _straight(f):
    return np.allclose(f(np.array([2.0, 1.0, 0.0]), 3.0, 0.0), (5.0, 1.0))


place = Code(
    id="place",
    title="Where a measurement puts its landmark",
    reference=_place,
    properties=(
        Property("3 m straight ahead of (2, 1), heading 0, is (5, 1)", _straight),
        Property(
            "the round trip comes home for heading 0",
            _returns(_poses(6) * np.array([[1], [1], [0]])),
        ),
        Property("the round trip comes home for every heading", _returns(_poses(7))),
    ),
    fingerprint=lambda f: np.ravel(f(_poses(8), *_expected(_poses(8), LANDMARK))),
    hints=(
        "In which direction of the map does the beam fly?",
        "The heading plus the bearing.",
        "x + r * cos(theta + phi), y + r * sin(theta + phi)",
    ),
    misconceptions=(
        Misconception(
            "no-heading",
            "forgets the heading, which a test with heading 0 cannot notice",
            (
                "Try a robot that looks along the y axis.",
                "The bearing counts from the nose; the map counts from the x axis.",
                "The direction on the map is theta + phi.",
            ),
            lambda pose, r, phi: _place(np.array((*pose[:2], 0 * pose[2])), r, phi),
        ),
        Misconception(
            "minus-heading",
            "subtracts the heading",
            (
                "You subtracted it to get the bearing. How do you go back?",
                "Undo a subtraction by an addition.",
                "theta + phi",
            ),
            lambda pose, r, phi: _place(np.array((*pose[:2], -pose[2])), r, phi),
        ),
        Misconception(
            "from-origin",
            "starts at the origin instead of the robot",
            (
                "Where does the beam start?",
                "r and phi give a vector; add it to a place.",
                "x + ..., y + ...",
            ),
            lambda pose, r, phi: _place(
                pose * np.array([0, 0, 1]).reshape(3, *[1] * np.ndim(r)), r, phi
            ),
        ),
        Misconception(
            "swapped",
            "swaps sine and cosine",
            (
                "What is straight ahead of a robot that looks along x?",
                "cos goes with x.",
                "x + r * cos(...), y + r * sin(...)",
            ),
            lambda pose, r, phi: (
                pose[0] + r * np.sin(pose[2] + phi),
                pose[1] + r * np.cos(pose[2] + phi),
            ),
        ),
    ),
)

# -- code: the likelihood -----------------------------------------------------------------------


def _errors(z, m, pose):
    """Range and bearing errors (2, K, M), bearings not wrapped."""
    d = np.asarray(m)[:, :, None] - pose[:2, None]
    r, phi = np.asarray(z)[:, :, None]
    return r - np.hypot(*d), phi - (np.arctan2(d[1], d[0]) - pose[2])


def _parts(z, m, pose, sigma_r, sigma_phi):
    e_r, e_phi = _errors(z, m, pose)
    return pf.log_gaussian(e_r, sigma_r), pf.log_gaussian(pf.wrap(e_phi), sigma_phi)


def _score(z, m, pose, sigma_r, sigma_phi):
    r, phi = _parts(z, m, pose, sigma_r, sigma_phi)
    return (r + phi).sum(axis=0)


def _case(seed=0, K=3, M=30):
    rng = np.random.default_rng(seed)
    m, pose = rng.uniform(-5, 5, (2, K)), _poses(seed + 50, M)
    z = np.array([_expected(pose[:, 0], mk) for mk in m.T]).T
    return z + 0.1 * rng.standard_normal(z.shape), m, pose, 0.5, 0.4


def _scores(f):
    case = _case(2)
    return np.allclose(f(*case), _score(*case), rtol=1e-9, atol=1e-9)


def _one_at_a_time(f):
    z, m, pose, *sigmas = _case(3)
    alone = [f(z[:, k : k + 1], m[:, k : k + 1], pose, *sigmas) for k in range(3)]
    return np.allclose(f(z, m, pose, *sigmas), np.sum(alone, axis=0), rtol=1e-9, atol=1e-9)


def _seam(f):
    """A landmark right behind the robot, seen over the seam of the circle."""
    pose = np.array([[0.0, 0.0], [0.0, 0.0], [3.1, -3.1]])
    z, m = np.array([[2.0], [0.0]]), np.array([[-2.0], [0.0]])
    return np.allclose(f(z, m, pose, 0.5, 0.4), _score(z, m, pose, 0.5, 0.4))


def _tiny(f):
    z, m, pose, _, _ = _case(4)
    found = np.asarray(f(z, m, pose, 1e-3, 1e-3))
    return bool(np.isfinite(found).all())


def _in_the_open(z, m, pose, sigma_r, sigma_phi):
    with np.errstate(divide="ignore"):
        parts = np.exp(_parts(z, m, pose, sigma_r, sigma_phi))
        return np.log(parts.prod(axis=(0, 1)))


def _unwrapped(z, m, pose, sigma_r, sigma_phi):
    e_r, e_phi = _errors(z, m, pose)
    return (pf.log_gaussian(e_r, sigma_r) + pf.log_gaussian(e_phi, sigma_phi)).sum(axis=0)


def _averaged(*case):
    parts = np.concatenate(_parts(*case))
    return np.logaddexp.reduce(parts) - np.log(len(parts))


def _no_constant(z, m, pose, sigma_r, sigma_phi):
    e_r, e_phi = _errors(z, m, pose)
    return -0.5 * ((e_r / sigma_r) ** 2 + (pf.wrap(e_phi) / sigma_phi) ** 2).sum(axis=0)


def _headless(z, m, pose, *sigmas):
    return _score(z, m, pose * np.array([[1], [1], [0]]), *sigmas)


score = Code(
    id="score",
    title="Log-likelihood of K ranges and bearings",
    points=2,
    reference=_score,
    properties=(
        Property("the sum of all Gaussian log densities", _scores),
        Property("three together say what each says alone, added up", _one_at_a_time),
        Property("a bearing error is short, even across the seam at pi", _seam),
        Property("thousands of deviations off stay finite", _tiny),
    ),
    fingerprint=lambda f: np.ravel(f(*_case(5))),
    hints=(
        "Errors first: range minus expected range, bearing minus expected bearing, wrapped.",
        "pf.log_gaussian(error, sigma) for each; logs of a product add up.",
        "Sum over the K measurements, axis 0 of an array (K, M), ranges and bearings both.",
    ),
    misconceptions=(
        Misconception(
            "averages",
            "averages the likelihoods",
            (
                "Which excuse does a good range give a bad bearing?",
                "Independent densities multiply, so their logs add up.",
                "Return the sum of the log densities.",
            ),
            _averaged,
        ),
        Misconception(
            "mean-log",
            "averages the log-likelihoods",
            (
                "Should ten measurements count no more than one?",
                "Logs of a product add up; do not divide.",
                "Use sum, not mean.",
            ),
            lambda *case: _score(*case) / case[0].shape[1],
        ),
        Misconception(
            "no-wrap",
            "does not wrap the bearing error",
            (
                "How far is a bearing of 3.1 from one of -3.1?",
                "Wrap the difference before you square it.",
                "pf.wrap(phi - phi_hat)",
            ),
            _unwrapped,
        ),
        Misconception(
            "no-heading",
            "forgets the heading in the bearing",
            (
                "Two particles at one place look in two directions. Do they score alike?",
                "Subtract the heading from the direction on the map.",
                "arctan2(dy, dx) - theta",
            ),
            _headless,
        ),
        Misconception(
            "first-only",
            "scores the first landmark only",
            (
                "How many columns has z?",
                "Every column is a measurement.",
                "Sum over all K of them.",
            ),
            lambda z, m, *rest: _score(z[:, :1], m[:, :1], *rest),
        ),
        Misconception(
            "variance",
            "takes the standard deviation for a variance",
            (
                "Which unit has sigma_r?",
                "Metres, not square metres: it is squared in the exponent.",
                "pf.log_gaussian takes the standard deviation as it is.",
            ),
            lambda z, m, pose, a, b: _score(z, m, pose, np.sqrt(a), np.sqrt(b)),
        ),
        Misconception(
            "no-constant",
            "leaves out the constant of the Gaussians",
            (
                "Your weights are right. Is your density?",
                "The constant cancels in the weights, but not in the evidence.",
                "Add -log(sigma sqrt(2 pi)) for each, or use pf.log_gaussian.",
            ),
            _no_constant,
        ),
        Misconception(
            "underflow",
            "multiplies ordinary densities, which underflow to zero",
            (
                "What is exp(-1000) in a computer?",
                "Never leave the logarithms.",
                "Add log densities; do not take the log of a product.",
            ),
            _in_the_open,
            lambda f: bool(_scores(f) and not _tiny(f)),
        ),
    ),
)

# -- lasers -------------------------------------------------------------------------------------

field = Choice(
    id="field",
    title="A beam would have to fly through one wall to end exactly at the next. Who objects?",
    options={
        "a": "both models",
        "b": "only the beam model",
        "c": "only the likelihood field",
        "d": "neither",
    },
    key="b",
    feedback={
        "a": "The field looks at the end of the beam only, and the end is at a wall.",
        "b": "Yes: it knows how far the beam should fly. The field only knows where it ends.",
        "c": "The other way round: the field is happy with any end that touches a wall.",
        "d": "The beam model compares with the first wall, and finds the reading too long.",
    },
)

# -- experiments --------------------------------------------------------------------------------


def _spread(bel):
    return np.sqrt(np.trace(pf.covariance(bel)[:2, :2]))


def _spreads(rng, K=2, M=3000):
    world, guess = pf.worlds.arena(), np.array([6.0, 3.0, np.pi / 2])
    truth, bel = (pf.gaussian_prior(n, guess, [1.0, 1.0, 0.1], rng) for n in (1, M))
    z = pf.RangeBearing(world, 0.3, 0.1).sample(truth.state[:, 0], rng, ids=np.arange(K))
    r, phi = pf.Range(world, 0.3), pf.Bearing(world, 0.1)
    parts = np.array(
        [r.log_density(zk, bel.state) for zk in z[[0, 2]].T]
        + [phi.log_density(zk, bel.state) for zk in z[[1, 2]].T]
    )
    scores = parts.sum(axis=0), np.logaddexp.reduce(parts)
    return [_spread(pf.Particles(bel.state, pf.normalise(s)[0])) for s in scores]


def _average_run(rng):
    product, mean = _spreads(rng)
    return mean / product


average_x = Experiment(
    id="average_x",
    title="Spread after averaging over spread after multiplying",
    points=2,
    after="average",
    runs=20,
    claim="averaging leaves the belief three to five times as wide",
    test="median of 20 runs between 3 and 5, none below 2",
    reference=_average_run,
    properties=(
        Property("the averaged belief is the wider one in every run", lambda x: bool(x.min() > 1)),
        Property("median ratio between 3 and 5", lambda x: bool(3 < np.median(x) < 5)),
        Property("the runs differ", lambda x: bool(x.std() > 1e-6)),
    ),
    margin="median 3.6, the median of 20 runs has sd 0.11: 5 standard errors",
    hints=(
        "Weigh the same cloud twice: once by the sum of the logs, once by the log of the mean.",
        "look(rng, K=2) of the chapter returns both spreads.",
        "product, average = look(rng, 2)[0]; return average / product",
    ),
    misconceptions=(
        Misconception(
            "inverse",
            "returns the ratio upside down",
            (
                "Which belief is wider?",
                "Average over product was asked for.",
                "Turn the fraction over.",
            ),
            lambda rng: 1 / _average_run(rng),
            lambda x: bool((x < 1).all() and (x > 0).all()),
        ),
        Misconception(
            "squared",
            "compares variances, not standard deviations",
            (
                "In which unit is your spread?",
                "The trace of a covariance is in square metres.",
                "Take the square root of the trace.",
            ),
            lambda rng: _average_run(rng) ** 2,
            lambda x: bool(8 < np.median(x) < 25),
        ),
        Misconception(
            "one-landmark",
            "uses one landmark only",
            (
                "How many measurements enter your sum?",
                "Two landmarks, range and bearing each: four parts.",
                "Draw z with ids=[0, 1].",
            ),
            lambda rng: float(np.divide(*_spreads(rng, 1)[::-1])),
            lambda x: bool(1.4 < np.median(x) < 2.6),
        ),
    ),
)


def _zeros(rng, K=5, sigma=0.1, M=1000):
    office = pf.worlds.office()
    laser = pf.BeamModel(office, np.linspace(-np.pi / 2, np.pi / 2, K), r_max=12.0)
    poses = office.sample_poses(M + 1, rng)
    length = laser.lengths(poses)
    r = length[:, :1] + sigma * rng.standard_normal((K, 1))
    return np.exp(pf.log_gaussian(r - length[:, 1:], sigma)).prod(axis=0)


def _beams_run(rng):
    return np.mean(_zeros(rng) == 0)


beams_x = Experiment(
    id="beams_x",
    title="Weights that are exactly zero after five beams",
    points=2,
    after="beams",
    runs=30,
    claim="the plain product of five beams is exactly zero for more than half of a lost cloud",
    test="mean of 30 runs between 0.45 and 0.75",
    reference=_beams_run,
    properties=(
        Property("shares between 0 and 1", lambda x: bool((x >= 0).all() and (x <= 1).all())),
        Property("mean share between 0.45 and 0.75", lambda x: bool(0.45 < x.mean() < 0.75)),
        Property("the runs differ", lambda x: bool(x.std() > 1e-6)),
    ),
    margin="mean 0.6, the mean of 30 runs has sd 0.03: 5 standard errors",
    hints=(
        "Draw a pose for the robot and 1,000 for the cloud, all from office.sample_poses.",
        "Multiply exp(log_gaussian(r - length, 0.1)) over the five beams, as numbers.",
        "return np.mean(p == 0)",
    ),
    misconceptions=(
        Misconception(
            "logs",
            "keeps the logarithms, which never underflow",
            (
                "You did what a filter should do. What happens without it?",
                "Multiply the densities themselves here.",
                "np.exp(...).prod(axis=0) == 0",
            ),
            lambda rng: 0.0,
            lambda x: bool((x == 0).all()),
        ),
        Misconception(
            "vague",
            "uses a far wider sensor than 0.1 m",
            (
                "Which standard deviation have your beams?",
                "0.1 m was asked for.",
                "pf.log_gaussian(error, 0.1)",
            ),
            lambda rng: np.mean(_zeros(rng, sigma=0.25) == 0),
            lambda x: bool(0 < x.mean() < 0.35),
        ),
        Misconception(
            "count",
            "returns a number of particles, not a share",
            ("Can a share be 600?", "Divide by the number of particles.", "np.mean, not np.sum"),
            lambda rng: np.sum(_zeros(rng) == 0),
            lambda x: bool((x > 1).any()),
        ),
    ),
)

why = Text(
    id="why",
    title="Why multiply, and why in logarithms?",
    rubric=(
        "says that the measurements are independent given the pose, so that densities multiply",
        "says that an average lets one good measurement excuse an impossible one",
        "says that products of small numbers underflow to zero and sums of logarithms do not",
    ),
    model=(
        "Given the pose the errors of the measurements are independent, so their densities "
        "multiply. An average adds densities of different units, and lets one good reading excuse "
        "an impossible one. Products of many small numbers round to zero, while their logarithms "
        "only add up."
    ),
)

LAB = Lab(
    "ch04",
    "Chapter 4: sensing",
    [
        Question("predict", "Predictions", (average, beams)),
        Question("hand", "By hand", (hand, weight)),
        Question("idea", "What a likelihood is", (likelihood, sd, field)),
        Question("code", "Code", (expected, place, score)),
        Question("break", "Experiments", (average_x, beams_x, why)),
    ],
)
check, use, predict, answer, summary, save, load = LAB.verbs()
