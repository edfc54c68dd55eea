"""Global localisation: keys follow from formulas, and one experiment's luck has an exact law."""

from math import comb

import numpy as np

from pfkit.labs import Numeric, global_localisation


def test_keys_follow_from_their_formulas():
    items = global_localisation.LAB.items.values()
    keys = {i.id: i.key for i in items if isinstance(i, Numeric)}
    assert np.allclose(keys["hand"], (6 / 27, 3 * (1 - (2 / 3) ** 3)), atol=6e-4)
    assert np.isclose(keys["founders"], np.exp(-5000 * 0.0002), atol=5e-4)
    W = np.array([0.75, 0.25])
    assert np.isclose(keys["nats"], np.sum(W * np.log(4 * W)), atol=5e-4)


def test_luck_fails_a_right_answer_less_than_once_in_ten_thousand():
    """The index is uniform over four by symmetry, so each share is binomial."""
    n = global_localisation.luck_x.runs
    far = [k for k in range(n + 1) if abs(k / n - 0.25) >= 0.18]
    tail = sum(comb(n, k) * 0.25**k * 0.75 ** (n - k) for k in far)
    assert 4 * tail < 1e-4
