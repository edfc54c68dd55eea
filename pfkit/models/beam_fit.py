r"""Learning a beam model: which readings were hits, which were people?

The shares and widths of a beam model differ from laser to laser and from building to building.
Readings at known poses can teach them, were it not for one thing: nobody says of which kind
each reading was. If we knew the kinds, we could fit each kind's parameters to its readings. If
we knew the parameters, we could say how probably each reading was of which kind.

*Expectation maximisation* does one after the other, again and again. Each turn explains the
readings at least as well as the one before, so it climbs; it may end on a hill that is not the
highest, so start it from sensible values.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pfkit.errors import DataError, require_array
from pfkit.models.beams import SHARES, BeamModel

Array = NDArray[np.float64]


def fit_beams(
    model: BeamModel, r: ArrayLike, length: ArrayLike, iterations: int = 200
) -> BeamModel:
    r"""Learn the six parameters of a beam model from readings at known poses.

    Expectation maximisation. First guess of which kind each reading was,

    .. math:: e_{i,c} = z_c\, p_c(r_i) \,/\, \textstyle\sum_{c'} z_{c'}\, p_{c'}(r_i),

    then refit each kind to its share of the readings, and repeat:

    .. math:: z_c &= \frac1n \sum_i e_{i,c}, \qquad
              \sigma_{hit}^2 = \frac{\sum_i e_{i,hit} (r_i - r_i^*)^2}{\sum_i e_{i,hit}}, \\
              \lambda &= \frac{\sum_i e_{i,short} (1 + n_i)}
                             {\sum_i e_{i,short} (r_i + n_i (r_i^* + 1/\lambda))} .

    :math:`n_i = 1 / (e^{\lambda r_i^*} - 1)` stands for the people behind the wall, whom the
    beam would have met had there been no wall; without them lambda comes out too large.

    Parameters
    ----------
    model : BeamModel
        Where to start. A share of 0 stays 0.
    r : array_like (n,), metres
        Readings.
    length : array_like (n,), metres
        How far each beam should have flown: ``model.lengths(pose)``; inf if it meets nothing.
    iterations : int
        At most so many; fewer if no parameter moves by more than one part in 10^8.

    Returns
    -------
    BeamModel with the new shares, sigma_hit and lambda_short

    Raises
    ------
    ShapeError, DataError, ParameterError
        If r and length do not match, or a reading is impossible under the model.

    Notes
    -----
    Source: Probabilistic Robotics, Table 6.2, which leaves n out. Readings cut off at 0 or at
    r_max are left out of sigma_hit. One kind that hardly ever occurs is learned badly: look
    at the shares before you trust its width.
    """
    r = np.ravel(r)
    length = require_array("length", np.ravel(length), r.shape, ">= 0", DataError)
    for _ in range(iterations):
        previous, model = model, _refit(model, r, length)
        old, new = _settings(previous), _settings(model)
        if np.allclose(old, new, rtol=1e-8, atol=1e-12):
            break
    return model


def _settings(model: BeamModel) -> Array:
    return np.array((*model.shares, model.sigma_hit, model.lambda_short))


def _refit(model: BeamModel, r: Array, length: Array) -> BeamModel:
    """One turn of expectation maximisation."""
    share = model.shares[:, None] * model.parts(r, length)
    total = share.sum(axis=0)
    if not (total > 0).all():
        bad = r[total == 0][0]
        raise DataError(f"a reading of {bad} m is impossible; start with every share > 0")
    hit, short, _, _ = kind = share / total
    z = kind.mean(axis=1)
    settings: dict[str, Any] = dict(zip(SHARES, (z / z.sum()).tolist(), strict=True))
    seen = np.isfinite(length) & (r < model.r_max)
    if hit[seen].sum() > 0:
        error = r[seen] - length[seen]
        settings["sigma_hit"] = math.sqrt(hit[seen] @ error**2 / hit[seen].sum())
    who = short > 0
    if who.any():
        lam = model.lambda_short
        far = np.minimum(length[who], 600 / lam)  # beyond that nobody is hidden: n < 1e-260
        hidden = 1 / np.expm1(lam * far)
        people = short[who] * (1 + hidden)
        past = np.maximum(far - r[who], 1e-9)  # a reading of r_max: that person stood further on
        late = np.where(r[who] < model.r_max, 0.0, 1 / lam - past / np.expm1(lam * past))
        metres = short[who] * (r[who] + late + hidden * (far + 1 / lam))
        settings["lambda_short"] = people.sum() / metres.sum()
    return replace(model, **settings)
