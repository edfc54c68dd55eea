"""P5: when is the average a bad summary?"""

from __future__ import annotations

import math

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, code
from pfkit.labs.statistics import rng_of

P5 = Question("When is the average a bad summary?")


SEEDS = (1, 2, 5, 8, 13)
CORRIDOR = 60.0  # metres


def _density(x, at, h=1.0):
    """Kernels of sd ``h`` on every number, up to a factor."""
    return np.exp(-0.5 * ((np.atleast_1d(at)[:, None] - x) / h) ** 2).mean(axis=1)


def height_at_mean(x: np.ndarray, h: float = 1.0) -> float:
    """Density at the mean as a share of the highest density; kernels of sd ``h``."""
    x = np.asarray(x, dtype=float)
    return float(_density(x, x.mean(), h)[0] / _density(x, x, h).max())


def _sets(f):
    """What the function returns for three seeds, as numbers."""
    return [np.asarray(f(rng_of(seed)), dtype=float) for seed in SEEDS]


def _enough(f):
    for x in _sets(f):
        if not (x.ndim == 1 and 100 <= x.size <= 10_000 and np.isfinite(x).all()):
            return f"the shape is {x.shape}"
    return True


def _short(f):
    longest = max(np.ptp(x) for x in _sets(f))
    return bool(longest <= CORRIDOR) or f"they lie up to {longest:.3g} m apart"


def _low(f):
    highest = max(height_at_mean(x) for x in _sets(f))
    return highest < 0.01 or f"it is {100 * highest:.1f} %"


@code(
    """A set whose mean is a bad place
    Think of a robot that is in one of two rooms.
    The mean of two places lies between them.
    Half of the samples near -10, half near +10.""",
    id="p5a",
)
def two_places(rng):
    """A one-dimensional array of samples."""
    return np.concatenate([rng.normal(-10, 1, 200), rng.normal(10, 1, 200)])


two_places.holds("between 100 and 10,000 finite numbers, one dimension", _enough)
two_places.holds("they fit into a corridor of 60 m", _short)
two_places.holds("density at the mean below 1 % of the highest", _low)


class _Shape:
    """What a set looks like: hills, gaps, strays."""

    def __init__(self, f):
        self.x = x = np.sort(np.asarray(f(rng_of(SEEDS[-1])), dtype=float))
        self.at_mean = height_at_mean(x)
        grid = np.linspace(x[0] - 3, x[-1] + 3, 1000)
        height = _density(x, grid)
        self.height = height / height.max()
        high = self.height > 0.6
        self.hills = int(np.sum(np.diff(high.astype(int)) == 1) + high[0])
        k = int(np.argmax(np.diff(x)))
        few, most = sorted((x[: k + 1], x[k + 1 :]), key=len)
        self.gap = float(np.diff(x)[k])  # the widest place without a number
        self.minority = few.size / x.size  # what lies on its poorer side
        self.apart = self.gap > max(4.0, 3 * most.std())

    @property
    def valley(self):
        """The lowest density between the first and the last hill."""
        high = np.flatnonzero(self.height > 0.6)
        return float(self.height[high[0] : high[-1] + 1].min())

    @property
    def even(self):
        """The sd is that of a uniform law over the range, and nothing is missing."""
        return abs(self.x.std() / np.ptp(self.x) - 12**-0.5) < 0.03 and self.gap < 4


two_places.wrong("""even: is spread evenly: the mean is as good a place as any other
    How high is your density at the mean, compared with elsewhere?
    A wide belief alone does not make the mean a bad place.
    Leave a gap around the mean: half of the samples near -10, half near +10.""")(
    lambda rng: rng.uniform(0, 50, 400),
    when=lambda f: _Shape(f).even and _Shape(f).at_mean > 0.3,
)
two_places.wrong("""one-hill: is a single hill, and its mean is its best point
    Where is the mean of one symmetric hill?
    Let the belief hold two places at once.
    Half of the samples near -10, half near +10.""")(
    lambda rng: rng.normal(0, 1, 400),
    when=lambda f: (s := _Shape(f)).hills == 1 and s.at_mean > 0.9 and s.gap < 4 and not s.even,
)
two_places.wrong("""too-close: has hills that still overlap
    How high is the density half way between your hills?
    Move them apart: the valley must fall below one hundredth of the top.
    Hills of sd 1 at -10 and +10 leave nothing at 0.""")(
    lambda rng: np.concatenate([rng.normal(-3.5, 1, 200), rng.normal(3.5, 1, 200)]),
    when=lambda f: (s := _Shape(f)).hills == 2 and s.valley > 0.01 and s.at_mean > 0.01,
)
two_places.wrong("""stray: is one hill with strays; they move the mean only a little
    How far can one particle in 400 pull the mean?
    The second place must hold a good part of the weight.
    Half of the samples near -10, half near +10.""")(
    lambda rng: np.concatenate([rng.normal(0, 1, 399), [30.0]]),
    when=lambda f: (s := _Shape(f)).apart and s.minority <= 0.05 and s.at_mean > 0.01,
)
two_places.wrong("""uneven: has nearly all of its numbers in one place, and the mean on its flank
    Which share of your numbers lies in the second place?
    The mean of .9 at -10 and .1 at +10 is -8, and many stand there.
    Half of the samples near -10, half near +10.""")(
    lambda rng: np.concatenate([rng.normal(-10, 1, 360), rng.normal(10, 1, 40)]),
    when=lambda f: (s := _Shape(f)).apart and 0.05 < s.minority <= 0.25 and s.at_mean > 0.01,
)
two_places.wrong("""middle-hill: puts a hill where the mean lies
    Mark the mean in your picture: is anything there?
    An odd number of symmetric hills has one in the middle.
    Leave the middle hill out.""")(
    lambda rng: np.concatenate([rng.normal(m, 1, 200) for m in (-15, 0, 15)]),
    when=lambda f: (s := _Shape(f)).hills >= 3 and s.gap > 1 and s.at_mean > 0.5,
)
two_places.refuses("one stray so far away that it drags the mean out of the hill")(
    lambda rng: np.append(rng.normal(0, 1, 399), 1e6)
)
two_places.refuses("99 numbers")(
    lambda rng: np.concatenate([rng.normal(-10, 1, 50), rng.normal(10, 1, 49)])
)
two_places.refuses("two hills by luck only: the second is there for some seeds", named="one-hill")(
    lambda rng: rng.normal(0, 1, 400) + 20.0 * (rng.random() < 0.3) * (np.arange(400) % 2)
)
two_places.refuses("a skewed hill, whose mean is not its best point")(
    lambda rng: 4 * rng.exponential(size=400)
)
two_places.refuses("two numbers")(lambda rng: np.array([-10.0, 10.0]))
two_places.refuses("two hills so wide that they meet")(
    lambda rng: np.concatenate([rng.normal(-10, 8, 200), rng.normal(10, 8, 200)])
)
two_places.refuses("poses of two components")(lambda rng: rng.normal(0, 1, (2, 400)))


def _same_angle(a, b):
    return abs(pf.wrap(np.asarray(a, dtype=float) - b)) < 1e-9


def _turned(f):
    rng = rng_of(3)
    theta, w = rng.normal(0.5, 0.4, 20), rng.random(20)
    for turn in (1.0, 2.5, -2.0):
        if not _same_angle(f(pf.wrap(theta + turn), w), f(theta, w) + turn):
            return f"turning the set by {turn} rad does not turn the mean by {turn} rad"
    return True


def _headings(seed):
    """Headings around a direction of their own, with weights that sum to one."""
    rng = rng_of(seed)
    w = rng.random(9)
    return pf.wrap(1.5 * seed + rng.uniform(-1, 1, 9)), w / w.sum()


@code(
    """Circular mean
    Add arrows, not numbers.
    Sum the weighted sines and cosines.
    arctan2(sum(w sin), sum(w cos)).""",
    id="p5b",
    points=2,
    fingerprint=lambda f: [f(*_headings(seed)) for seed in range(4)],
)
def circular_mean(theta, w):
    """Mean direction of angles theta (M,) in radians with weights w (M,)."""
    return np.arctan2(np.sum(w * np.sin(theta)), np.sum(w * np.cos(theta)))


circular_mean.holds(
    "359 and 1 degree have the mean 0",
    lambda f: _same_angle(f(np.deg2rad([359.0, 1.0]), np.array([0.5, 0.5])), 0),
)
circular_mean.holds(
    "weights count: 0 and 90 degrees with weights .9 and .1 give 6.3 degrees",
    lambda f: _same_angle(f(np.array([0.0, np.pi / 2]), np.array([0.9, 0.1])), math.atan2(1, 9)),
)
circular_mean.holds("turning all headings turns the mean", _turned)


@circular_mean.wrong("""averages the angles as plain numbers
    Try it on 3.1 and -3.1 rad. Which way do these two headings point?
    Add arrows, not numbers: each angle is an arrow (cos, sin).
    Sum w cos and w sin over the set, and return arctan2(sum of sines, sum of cosines).""")
def arithmetic_mean(theta, w):
    return np.sum(w * theta) / np.sum(w)


circular_mean.wrong("""arctan: behaves like arctan of a ratio, which knows only half of the
         circle
    Try it on a set of headings that all point to the left, such as 3.0 rad.
    A ratio forgets the signs of its two parts: (-1)/(-1) equals 1/1.
    Give both parts to arctan2(sine, cosine), which keeps the quadrant.""")(
    lambda theta, w: np.arctan(np.sum(w * np.sin(theta)) / np.sum(w * np.cos(theta)))
)
circular_mean.wrong("""no-weights: gives every particle the same say: the weights are not used
    What should the mean be if one particle holds all the weight?
    The arrow of a particle is as long as its weight.
    Multiply sines and cosines by w before you sum.""")(
    lambda theta, w: np.arctan2(np.sin(theta).mean(), np.cos(theta).mean())
)
circular_mean.wrong("""swapped-arguments: passes the cosine first to arctan2
    What is your mean of the single heading 0?
    arctan2 takes y first, then x.
    Write arctan2(sum of sines, sum of cosines).""")(
    lambda theta, w: np.arctan2(np.sum(w * np.cos(theta)), np.sum(w * np.sin(theta)))
)


def _as_degrees(mean):
    """Are degrees taken for radians on the way in, on the way out, or both?"""
    theta, w = np.array([40.0, 90.0, 200.0]), np.array([0.2, 0.5, 0.3])
    both = degrees(theta, w)
    ways = (both, np.deg2rad(both), np.rad2deg(circular_mean(theta, w)))
    return any(np.isclose(mean(theta, w), x) for x in ways)


@circular_mean.wrong(
    """treats the angles as degrees
    All angles of this course are in radians.
    np.sin and np.cos take radians already: no conversion is needed.
    Remove deg2rad and rad2deg.""",
    when=_as_degrees,
)
def degrees(theta, w):
    t = np.deg2rad(theta)
    return np.rad2deg(np.arctan2(np.sum(w * np.sin(t)), np.sum(w * np.cos(t))))


circular_mean.refuses("unrolls the headings about the first, then averages numbers")(
    lambda theta, w: theta[0] + np.sum(w * pf.wrap(theta - theta[0])) / np.sum(w)
)
circular_mean.refuses("averages numbers, then wraps the mean")(
    lambda theta, w: pf.wrap(np.sum(w * (theta % (2 * np.pi))) / np.sum(w))
)
circular_mean.refuses("squares the weights")(
    lambda theta, w: np.angle(np.sum(w**2 * np.exp(1j * theta)))
)
circular_mean.refuses("the heading of the heaviest particle")(lambda theta, w: theta[np.argmax(w)])
circular_mean.refuses("arccos of the mean cosine, which knows no sign")(
    lambda theta, w: np.arccos(np.sum(w * np.cos(theta)) / np.sum(w))
)
circular_mean.refuses("an angle right up to half a turn")(
    lambda theta, w: np.arctan2(-np.sum(w * np.sin(theta)), -np.sum(w * np.cos(theta)))
)


p5c = Choice("""What to report for a belief with four hills
    a* The hills: cluster the particles, or take the highest point
       = Yes: a list of hypotheses with their weights, or the mode if one is needed.
    b  The mean, after stratified resampling
       = Stratified sampling changes which copies are made, not what the mean is.
    c  The mean of more particles
       = More particles find the same bad mean more precisely.
    d  The median of x and the median of y
       = The medians of four corners can lie where no particle is, too.""")
