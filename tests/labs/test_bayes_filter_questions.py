"""Right answers to the Bayes filter's questions in forms that their author did not think of."""

import numpy as np
import pytest

from pfkit.labs.bayes_filter import LAB, drive

ITEMS = LAB.items


def by_loop(bel, likelihood):
    joint = [b * p for b, p in zip(bel, likelihood, strict=True)]
    return [j / sum(joint) for j in joint], sum(joint)


def single_precision(bel, likelihood):
    joint = bel.astype(np.float32) * likelihood
    return (joint / joint.sum()).astype(np.float32), joint.sum()


def where_from(bel, moves):
    n = len(bel)
    return [sum(p * bel[(i - c) % n] for c, p in moves.items()) for i in range(n)]


def where_to(bel, moves):
    new = np.zeros(len(bel))
    for cell, b in enumerate(bel):
        for cells, p in moves.items():
            new[(cell + cells) % len(bel)] += p * b
    return new


def least_surprise(run, rng):
    """The power with the smallest mean of -log belief in the true cell, on the same robots."""
    powers = np.geomspace(0.1, 1.5, 15)
    losses = []
    for power in powers:
        each = [run(power, np.random.default_rng(seed)) for seed in range(3)]
        losses.append(-np.mean([np.log(bel[np.arange(len(x)), x]) for bel, x in each]))
    return powers[np.argmin(losses)]


def even_grid(run, rng):
    best, power = np.inf, 0
    for tried in np.arange(0.1, 1.55, 0.1):
        bel, x = run(tried, rng)
        gap = abs(np.mean(bel.max(axis=1) - (bel.argmax(axis=1) == x)))
        best, power = min((best, power), (gap, tried))
    return power


def one_by_one(steps, real, assumed, rng):
    lost = 0
    for _ in range(100):
        _, after, x, _, _ = drive(rng, T=steps, real=(0.8, real), assumed=(0.8, assumed))
        lost += any(after[k, 0, x[k, 0]] < 1e-6 for k in range(steps))
    return lost / 100


RIGHT = [
    ("correct", by_loop),
    ("correct", single_precision),
    ("predict_line", where_from),
    ("predict_line", where_to),
    ("twice_x", least_surprise),
    ("twice_x", even_grid),
    ("moved", ["9.44 %", "4/9", 0.4056, 0.0556]),
]


@pytest.mark.parametrize(("item", "answer"), RIGHT)
def test_a_right_answer_in_another_form_passes(item, answer):
    judged = ITEMS[item].judge(answer)
    assert judged.fraction == 1, judged


def test_robots_may_be_sent_one_by_one():
    settings = ITEMS["zero_x"].settings(np.random.default_rng(1))
    rng = np.random.default_rng(2)
    for steps, real, assumed in settings:
        found = one_by_one(steps, real, assumed, rng)
        wanted = np.mean([ITEMS["zero_x"](steps, real, assumed, rng) for _ in range(20)])
        assert abs(found - wanted) < 0.2  # four standard deviations of a share of 100
