"""Outliers. Mixtures, gates and their trap door."""

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Lab, Numeric, Prediction, Question, Text, code, experiment, target

PREDICT = Question("Predictions")

lock = Prediction("""A gate, and a start anywhere
    a  it takes a little longer, then all is well
    b* it rejects every report, for ever
    c  it accepts every report
    d  nothing changes""")

ushape = Prediction("""Rejected honest reports against the modelled noise
    a  it falls steadily to none
    b  it rises steadily
    c* it falls to none, then jumps to all
    d  it does not change""")

HAND = Question("By hand")

byhand = Numeric(
    """Weight of the particle at 4 m for a report at 5 m
    Errors are 5, 4, 3, 2, 1 m; the Gaussian densities at 1 and 2 m are .2420 and .0540.
    Mixture: .9 times the density plus .005, for each of the five.
    Gaussian .2420 / .3005; mixture (.2178 + .005) / .2955.""",
    (0.805, 0.754),
    tol=0.003,
    names=("Gaussian", "mixture"),
)
byhand.wrong("""not-normalised: is not divided by the sum over the particles
    Do the five weights sum to one?
    Add all five.
    Divide by their sum.""")((0.242, 0.2228))
byhand.wrong("""no-share: adds the floor without the factor 1 - epsilon on the honest part
    A report is honest with which probability?
    The honest part counts .9.
    .9 * .2420 + .005.""")(
    (0.8051, 0.7587), when=lambda x: abs(x[0] - 0.8051) < 0.003 and abs(x[1] - 0.7587) < 0.0015
)

peak = Numeric(
    """Variance at which the peak density is {gate} per square pixel
    The peak in the plane is 1 / (2 pi sigma^2).
    Set it equal to {gate} and solve for sigma^2.
    1 / (2 pi {gate}).""",
    lambda gate: 1 / (2 * np.pi * gate),
    tol=8.0,
    unit="px^2",
    world={"gate": 1e-4},
    draw=lambda rng: {"gate": int(rng.integers(6, 30)) / 1e5},
)
peak.wrong("""sd: is the standard deviation, not the variance
    Which of the two is asked?
    Do not take the root.
    1 / (2 pi {gate}).""")(lambda gate: np.sqrt(1 / (2 * np.pi * gate)))
peak.wrong("""one-dimension: uses the peak of a Gaussian on the line
    How many coordinates does a report have?
    In the plane the constant is 1 / (2 pi sigma^2).
    1 / (2 pi {gate}).""")(lambda gate: 1 / (2 * np.pi * gate**2), when=lambda x: float(x) > 1e5)

unit = Choice("""Millimetres instead of pixels
    a  nothing, it is a probability
       = It is a density, and a density has units: one per area.
    b  it is multiplied by 4
       = One square pixel is 16 square millimetres: the density per square millimetre falls.
    c  it is divided by 4
       = There are two directions, and each one divides by 4.
    d* it is divided by 16
       = Yes: per square millimetre it is 16 times smaller, and lambda did not move along.""")

CODE = Question("Code")

LOG_P = np.array([-1.0, -3.0, -8.0, -2.5])


def _mixes(f):
    want = np.log(0.7 * np.exp(LOG_P) + 0.3 / 50)
    return np.allclose(f(LOG_P.copy(), 0.3, 50.0), want)


@code(
    """The mixture in logarithms
    A sum of two densities, each as a logarithm: np.logaddexp.
    The honest part is log(1 - epsilon) + log_p; the floor log(epsilon / A).
    np.logaddexp(np.log(1 - epsilon) + log_p, np.log(epsilon / A))""",
    fingerprint=lambda f: np.concatenate((f(LOG_P.copy(), 0.3, 50.0), f(LOG_P - 2, 0.6, 9.0))),
)
def mixture(log_p, epsilon, A):
    return np.logaddexp(np.log1p(-epsilon) + log_p, np.log(epsilon / A))


mixture.holds("(1 - epsilon) p + epsilon / A, as a logarithm", _mixes)
mixture.holds(
    "hopeless particles get the floor, not zero",
    lambda f: np.allclose(f(np.full(3, -1e4), 0.2, 100.0), np.log(0.2 / 100)),
)
mixture.holds(
    "a density of exp(-10000) gives no nan",
    lambda f: np.isfinite(f(np.full(2, -1e4), 0.5, 1.0)).all(),
)
mixture.wrong("""floor-only: adds the floor but leaves the honest part whole
    How often is a report honest?
    The two parts must share the probability.
    Add log(1 - epsilon) to log_p.""")(
    lambda log_p, epsilon, A: np.logaddexp(log_p, np.log(epsilon / A))
)
mixture.wrong("""no-area: forgets the area: a false report has density 1 / A, not 1
    What does a false report's density integrate to?
    It is spread over A.
    np.log(epsilon / A)""")(
    lambda log_p, epsilon, A: np.logaddexp(np.log1p(-epsilon) + log_p, np.log(epsilon))
)
mixture.wrong("""average: mixes the logarithms instead of the densities
    Is the log of a sum the sum of the logs?
    Mix first, then take the logarithm.
    np.logaddexp""")(lambda log_p, epsilon, A: (1 - epsilon) * log_p + epsilon * np.log(1 / A))
mixture.wrong("""maximum: takes the larger of the two parts
    Two ways for the same report: or, not the better of the two.
    Probabilities of exclusive cases add.
    np.logaddexp instead of np.maximum""")(
    lambda log_p, epsilon, A: np.maximum(np.log1p(-epsilon) + log_p, np.log(epsilon / A))
)

LOG_W = np.log(np.array([0.5, 0.2, 0.2, 0.1]))


@code(
    """Probability that a report was false
    L is the weighted mean of exp(log_p).
    Numerator epsilon / A; denominator (1 - epsilon) L + epsilon / A.
    L = np.sum(np.exp(log_w + log_p))""",
    fingerprint=lambda f: [f(LOG_W, LOG_P, 0.3, 50.0), f(LOG_W, LOG_P - 3, 0.6, 9.0)],
)
def responsibility(log_w, log_p, epsilon, A):
    L = np.sum(np.exp(log_w + log_p))
    return (epsilon / A) / ((1 - epsilon) * L + epsilon / A)


responsibility.holds(
    "Bayes' rule on the label, with weights",
    (
        lambda f: np.isclose(
            f(LOG_W, LOG_P, 0.3, 50.0), responsibility(LOG_W, LOG_P, 0.3, 50.0), atol=1e-9
        )
    ),
)
responsibility.holds(
    "a hopeless report is false for certain",
    lambda f: np.isclose(f(LOG_W, np.full(4, -800.0), 0.3, 50.0), 1),
)
responsibility.holds(
    "where the cloud does no better than chance, epsilon stays what it was",
    lambda f: np.isclose(f(LOG_W, np.full(4, np.log(1 / 50)), 0.3, 50.0), 0.3),
)
responsibility.wrong("""honest: is the probability of being honest
    Which label is asked for?
    One minus yours.
    epsilon / A goes into the numerator.""")(lambda *a: 1 - responsibility(*a))
responsibility.wrong("""unweighted: takes the plain mean over the particles and forgets their
         weights
    Does every particle count the same?
    L is a weighted mean.
    np.sum(np.exp(log_w + log_p))""")(
    lambda log_w, log_p, e, A: responsibility(np.full(log_w.size, -np.log(log_w.size)), log_p, e, A)
)
responsibility.wrong("""best: looks at the best particle only
    The cloud is asked, not its best member.
    Average the likelihood over the set.
    np.sum(np.exp(log_w + log_p))""")(
    lambda log_w, log_p, e, A: responsibility(np.zeros(1), np.max(log_p), e, A)
)

BREAK = Question("Experiments")

# As the chapter has them: a worked answer runs there.
motion, honest = pf.CircleTarget(sigma=1.4, sigma_theta=0.01), pf.Position(sigma=5.0)
log = target.target_log("circle", "outliers")[:300]
clean = target.target_log("circle", "low")[:100]


@experiment(
    """Share of reports rejected from a start anywhere
    bel = target.anywhere(1000, rng, D=3) starts anywhere.
    target.track(log[:60], bel, motion, honest, rng, gate=1e-4) has .rejected.
    return that.rejected.mean()""",
    points=2,
    after=lock,
    runs=20,
    pool=120,
    claim="from a start anywhere the gate rejects every report, honest or not",
    test="every one of 20 runs rejects at least 95 %",
    margin="the mean likelihood of an honest report would have to be thirty times its mean",
)
def lock_x(rng, gate=1e-4, known=False):
    bel = target.around(log.start, 1000, rng) if known else target.anywhere(1000, rng, D=3)
    return target.track(log[:60], bel, motion, honest, rng, gate=gate).rejected.mean()


lock_x.holds("a share between 0 and 1", lambda x: ((x >= 0) & (x <= 1)).all())
lock_x.holds("at least 0.95 in every run", lambda x: (x >= 0.95).all())
lock_x.wrong("""known-start: starts near the ball: then only the outliers are rejected
    Where do your particles start?
    Use target.anywhere, not target.around.
    target.anywhere(1000, rng, D=3)""")(
    lambda rng: lock_x(rng, known=True), when=lambda x: 0.25 < x.mean() < 0.8
)
lock_x.wrong("""no-gate: leaves the gate open
    Is anything rejected?
    Pass gate=1e-4.
    target.track(..., gate=1e-4)""")(
    lambda rng: lock_x(rng, gate=0.0), when=lambda x: (x == 0).all()
)


@experiment(
    """Rejected at three modelled variances
    The clean film is target.target_log('circle', 'low')[:60].
    pf.Position takes a standard deviation: the root of the variance.
    Return [share at 1e-4, share at 1000, share at 5000].""",
    points=2,
    after=ushape,
    runs=10,
    pool=60,
    claim="the gate rejects honest reports at both ends of the modelled noise, none between",
    test="every one of 10 runs: at least 0.7, at most 0.05, at least 0.99",
    margin="at 1e-4 the share is 0.97 with sd 0.025: 10 of them above 0.7; the others are certain",
)
def ushape_x(rng, gate=1e-4, scale=np.sqrt):
    found = []
    for variance in (1e-4, 1000.0, 5000.0):
        bel = target.around(clean.start, 300, rng)
        sensor = pf.Position(scale(variance))
        found.append(target.track(clean[:60], bel, motion, sensor, rng, gate=gate).rejected.mean())
    return found


ushape_x.holds("three shares", lambda x: x.ndim == 2 and x.shape[1] == 3)
ushape_x.holds("at least 0.7 rejected at 1e-4", lambda x: (x[:, 0] >= 0.7).all())
ushape_x.holds("at most 0.05 rejected at 1000", lambda x: (x[:, 1] <= 0.05).all())
ushape_x.holds("at least 0.99 rejected at 5000", lambda x: (x[:, 2] >= 0.99).all())
ushape_x.wrong("""variance-as-sd: hands the variance to pf.Position, which wants a standard
         deviation
    What does pf.Position take?
    sigma, in pixels, is the root of the variance.
    pf.Position(np.sqrt(variance))""")(
    lambda rng: ushape_x(rng, scale=lambda v: v), when=lambda x: (x[:, 1] > 0.9).all()
)
ushape_x.wrong("""no-gate: leaves the gate open
    Is anything rejected?
    Pass gate=1e-4.
    target.track(..., gate=1e-4)""")(
    lambda rng: ushape_x(rng, gate=0.0), when=lambda x: (x == 0).all()
)

why = Text(
    """Why can a gate lock a filter out that starts anywhere?
    says that a wide cloud has a small mean likelihood for every report
    says that rejecting everything keeps the cloud wide, so nothing changes
    says that a mixture compares with chance, and names rejections or spread to watch""",
    model="A wide cloud gives every report a mean likelihood of about 1/A, below the threshold, so "
    "all are rejected and the cloud stays wide. "
    "A mixture compares with the density of chance instead and always learns a little. "
    "I would watch the share of rejected reports.",
)


LAB = Lab.of(__name__, "Outliers")
__getattr__ = LAB.verb
