"""P5: when is the average a bad summary?"""

from __future__ import annotations

import math

import numpy as np

import pfkit as pf
from pfkit.labs import Choice, Question, code
from pfkit.labs.statistics import rng_of

P5 = Question("When is the average a bad summary?")


def height_at_mean(x: np.ndarray, h: float = 1.0) -> float:
    """Density at the mean as a share of the highest density; kernels of sd ``h``."""
    x = np.asarray(x, dtype=float)

    def density(at):
        return np.exp(-0.5 * ((np.atleast_1d(at)[:, None] - x) / h) ** 2).mean(axis=1)

    return float(density(x.mean())[0] / density(x).max())


def _enough(f):
    x = np.asarray(f(rng_of(1)), dtype=float)
    fine = x.ndim == 1 and 100 <= x.size <= 10_000 and np.isfinite(x).all()
    return bool(fine) or f"the shape is {x.shape}"


def _same_angle(a, b):
    return abs(pf.wrap(np.asarray(a, dtype=float) - b)) < 1e-9


def _turned(f):
    rng = rng_of(3)
    theta, w = rng.normal(0.5, 0.4, 20), rng.random(20)
    for turn in (1.0, 2.5, -2.0):
        if not _same_angle(f(pf.wrap(theta + turn), w), f(theta, w) + turn):
            return f"turning the set by {turn} rad does not turn the mean by {turn} rad"
    return True


@code(
    """A set whose mean is a bad place
    Think of a robot that is in one of two rooms.
    The mean of two places lies between them.
    Half of the samples near -10, half near +10.""",
    id="p5a",
)
def two_places(rng):
    return np.concatenate([rng.normal(-10, 1, 200), rng.normal(10, 1, 200)])


two_places.holds("between 100 and 10,000 finite numbers, one dimension", _enough)
two_places.holds(
    "density at the mean below 1 % of the highest",
    lambda f: (
        height_at_mean(f(rng_of(1))) < 0.01 or f"it is {100 * height_at_mean(f(rng_of(1))):.1f} %"
    ),
)


def _even(f):
    """Is the sd that of a uniform law over the range, range / sqrt(12)?"""
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    return abs(x.std() / np.ptp(x) - 12**-0.5) < 0.03


def _low_at_mean(f):
    """Density at the mean over the highest; kernels of sd 1."""
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    at = np.append(x, x.mean())
    height = np.exp(-0.5 * (at[:, None] - x) ** 2).sum(axis=1)
    return height[-1] / height.max()


two_places.wrong("""even: is spread evenly: the mean is as good a place as any other
    How high is your density at the mean, compared with elsewhere?
    A wide belief alone does not make the mean a bad place.
    Leave a gap around the mean: half of the samples near -10, half near +10.""")(
    lambda rng: rng.uniform(0, 100, 400), when=lambda f: _even(f) and _low_at_mean(f) > 0.3
)


def _modes(f):
    """How many hills a histogram of unit cells shows, valleys at half height."""
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    grid = np.linspace(np.percentile(x, 0.5) - 3, np.percentile(x, 99.5) + 3, 400)
    height = np.exp(-0.5 * (grid[:, None] - x) ** 2).sum(1)
    high = height > 0.6 * height.max()
    return int(np.sum(np.diff(high.astype(int)) == 1) + high[0])


def _stray(f):
    x = np.asarray(f(np.random.default_rng(5)), dtype=float)
    return np.abs(x - np.median(x)).max() > 8 * np.median(np.abs(x - np.median(x)))


two_places.wrong("""one-hill: is a single hill, and its mean is its best point
    Where is the mean of one symmetric hill?
    Let the belief hold two places at once.
    Half of the samples near -10, half near +10.""")(
    lambda rng: rng.normal(0, 1, 400),
    when=lambda f: _modes(f) == 1 and not _stray(f) and _low_at_mean(f) > 0.01,
)
two_places.wrong("""too-close: has hills that still overlap at the mean
    How high is the density half way between your hills?
    Move them apart: the valley must fall below one hundredth of the top.
    Hills of sd 1 at -10 and +10 leave nothing at 0.""")(
    lambda rng: np.concatenate([rng.normal(-3.5, 1, 200), rng.normal(3.5, 1, 200)]),
    when=lambda f: _modes(f) == 2 and _low_at_mean(f) > 0.01,
)
two_places.wrong("""stray: is one hill with strays; they move the mean only a little
    How far can one particle in 400 pull the mean?
    The second place must hold a good part of the weight.
    Half of the samples near -10, half near +10.""")(
    lambda rng: np.concatenate([rng.normal(0, 1, 399), [30.0]]),
    when=lambda f: _modes(f) == 1 and _stray(f) and _low_at_mean(f) > 0.01,
)
two_places.wrong("""middle-hill: puts a hill where the mean lies
    Mark the mean in your picture: is anything there?
    An odd number of symmetric hills has one in the middle.
    Leave the middle hill out.""")(
    lambda rng: np.concatenate([rng.normal(m, 1, 200) for m in (-15, 0, 15)]),
    when=lambda f: _modes(f) >= 3 and _low_at_mean(f) > 0.01,
)


@code(
    """Circular mean
    Add arrows, not numbers.
    Sum the weighted sines and cosines.
    arctan2(sum(w sin), sum(w cos)).""",
    id="p5b",
    points=2,
    fingerprint=lambda f: [
        f(rng_of(s).uniform(1.7, 4.0, 9), rng_of(s + 9).random(9)) for s in range(4)
    ],
)
def circular_mean(theta, w):
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
circular_mean.wrong("""arithmetic-mean: averages the angles as plain numbers
    Try it on 3.1 and -3.1 rad. Which way do these two headings point?
    Add arrows, not numbers: each angle is an arrow (cos, sin).
    Sum w cos and w sin over the set, and return arctan2(sum of sines, sum of cosines).""")(
    lambda theta, w: np.sum(w * theta) / np.sum(w)
)
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


def in_degrees(theta, w):
    t = np.deg2rad(theta)
    return np.rad2deg(np.arctan2(np.sum(w * np.sin(t)), np.sum(w * np.cos(t))))


def _as_degrees(mean):
    """Are degrees taken for radians on the way in, on the way out, or both?"""
    theta, w = np.array([0.4, 0.9, 2.0]), np.array([0.2, 0.5, 0.3])
    right = np.arctan2(np.sum(w * np.sin(theta)), np.sum(w * np.cos(theta)))
    both = in_degrees(theta, w)
    return any(np.isclose(mean(theta, w), x) for x in (both, np.deg2rad(both), np.rad2deg(right)))


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


p5c = Choice("""What to report for a belief with four hills
    a* The hills: cluster the particles, or take the highest point
       = Yes: a list of hypotheses with their weights, or the mode if one is needed.
    b  The mean, after stratified resampling
       = Stratified sampling changes which copies are made, not what the mean is.
    c  The mean of more particles
       = More particles find the same bad mean more precisely.
    d  The median of x and the median of y
       = The medians of four corners can lie where no particle is, too.""")
