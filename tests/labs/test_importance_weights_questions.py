"""Right answers to the questions on weights in forms that their author did not think of."""

import numpy as np
import pytest

from pfkit.labs.importance_weights import LAB

ITEMS = LAB.items


def averaged(f, log_p, log_q):
    log_w = np.subtract(log_p, log_q)
    return np.average(f, weights=np.exp(log_w - np.logaddexp.reduce(log_w)))


def by_loop(f, log_p, log_q):
    logs = [p - q for p, q in zip(log_p, log_q, strict=True)]
    weights = [np.exp(x - max(logs)) for x in logs]
    return sum(w * v for w, v in zip(weights, f, strict=True)) / sum(weights)


def giants_still_to_come(weigh, rng):
    """The heaviest of many draws keeps growing only where the tails are too thin."""
    few, many = (np.median([weigh(M, rng).max() for _ in range(20)]) for M in (500, 10_000))
    return int(many > 2 * few)


def mostly_below(weigh, rng):
    """Small sets miss what few draws carry: most of them lie below the mean of all."""
    means = np.array([weigh(100, rng).mean() for _ in range(2_000)])
    return np.median(means) < 0.93 * means.mean()


def large_pilot(cloud, rng):
    w = np.exp(cloud(500_000, rng))
    return 100 * w.size * np.sum(w**2) / w.sum() ** 2


RIGHT = [
    ("estimate", averaged),
    ("estimate", by_loop),
    ("from_variance", lambda s2, M: 1 / (1 / M + (M - 1) * s2)),
    ("narrow_x", giants_still_to_come),
    ("narrow_x", mostly_below),
    ("dim_x", large_pilot),
    ("hand", ["25/47", "21.3 %", 0.255]),
    ("ess", 2.8576),
]


@pytest.mark.parametrize(("item", "answer"), RIGHT)
def test_a_right_answer_in_another_form_passes(item, answer):
    judged = ITEMS[item].judge(answer)
    assert judged.fraction == 1, judged
