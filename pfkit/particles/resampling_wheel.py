r"""The resampling wheel: a resampling scheme to look at, not to use.

Udacity's course CS373 taught robot localisation to more people than any book, with a resampling
wheel of seven lines that everybody remembers. Draw the particles as slices of a wheel, start at
the edge of one of them, and walk round in random steps of at most twice the widest slice. After
each step, copy the slice you stand on.

It works well enough to localise a robot, and it is still a good example of a claim that nobody
checked. Is it unbiased? On average a step is as long as the widest slice, so the walk goes round
many times and forgets where it began. But it begins at the edge of a slice that is chosen
*uniformly*, whatever the weights, and it forgets only slowly. With 20 particles whose weights
fall off evenly, the first gets too many copies: twenty thousand runs show it beyond doubt, and
the tests of this module do so.

The comb of `systematic` needs one random number where the wheel needs n + 1, has no bias, and
scatters less.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from pfkit.particles.resampling import Indices, _find, _read


def resampling_wheel(w: ArrayLike, rng: np.random.Generator, n: int | None = None) -> Indices:
    r"""The resampling wheel of a famous first course: a specimen, not a recommendation.

    Start at the edge of a particle that is chosen *uniformly*, then walk round the wheel in n
    independent steps, each uniform on 0 to twice the largest weight:

    .. math:: b_k = b_{k-1} + 2\, w_{\max} U_k , \qquad U_k \sim \mathcal U(0, 1)

    It looks like systematic resampling and needs n + 1 random numbers instead of one. The walk
    forgets its start only slowly, and the start ignores the weights: for few particles, and for
    many whose like weights lie side by side, :math:`E[N_m]` is *not* :math:`n w_m`. Its copies
    also scatter more than a comb's.

    Parameters, returns and errors are those of `multinomial`, but its indices are *not* sorted:
    they come in the order of the walk.

    Notes
    -----
    Source: S. Thrun, CS373 Programming a Robotic Car, unit 3 (2012). O(M + n log M).
    """
    w, total, n = _read(w, rng, n)
    edges, batch = np.cumsum(w, axis=-1), w.shape[:-1]
    start = rng.integers(w.shape[-1], size=(*batch, 1))
    first = np.take_along_axis(edges - w, start, axis=-1) / total  # the start's left edge
    steps = 2 * w.max(axis=-1, keepdims=True) / total * rng.random((*batch, n))
    return _find(edges, (first + np.cumsum(steps, axis=-1)) % 1.0)
