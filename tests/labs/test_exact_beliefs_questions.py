"""Right answers to the questions on exact beliefs in forms that their author did not think of."""

import math

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import exact_beliefs as lab

ITEMS = lab.LAB.items


def by_precisions(mean, var, u, var_u, z, var_z):
    mean, var = mean + u, var + var_u
    precision = 1 / var + 1 / var_z
    S = var + var_z
    evidence = math.exp(-((z - mean) ** 2) / (2 * S)) / math.sqrt(2 * math.pi * S)
    return [(mean / var + z / var_z) / precision, 1 / precision, evidence]


def by_library(mean, var, u, var_u, z, var_z):
    bel = pf.kalman_predict(pf.Gaussian([mean], [[var]]), [[1]], [[var_u]], [u])
    bel, log_evidence, _ = pf.kalman_update(bel, [z], [[1]], [[var_z]])
    return bel.mean[0], bel.Sigma[0, 0], math.exp(log_evidence)


def kl_by_loop(p, q):
    total = 0.0
    for a, b in zip(p, q, strict=True):
        if a > 0:
            total += math.inf if b == 0 else a * math.log(a / b)
    return total


def each_robot_alone(doors, rates, steps, rng, runs):
    cell, z = lab.robots(doors, steps, rng, runs, rates)
    rows = []
    for r in range(runs):
        bel = [lab.even(1), lab.even(1)]
        for k in range(steps):
            bel = [lab.look(lab.move(b) if k else b, doors, z[k, r : r + 1], rates) for b in bel]
            bel[1] = lab.bell(*lab.match(bel[1]))
        rows.append([math.log(b[0, cell[-1, r]]) for b in bel])
    return np.transpose(rows)


def one_reading_at_a_time(h, sigma, rng, runs):
    lost = []
    for _ in range(runs):
        x = 3 + 4 * rng.random()
        z = rng.normal(x, sigma)
        like = np.exp(-0.5 * ((z - (np.arange(0, 10, h) + h / 2)) / sigma) ** 2)
        exact = -0.5 * ((z - x) / sigma) ** 2 - math.log(sigma * math.sqrt(2 * math.pi))
        lost.append(exact - math.log(like[int(x // h)] / like.sum() / h))
    return lost


RIGHT = [
    ("product", ["8.5", 9 / 10]),
    ("kalman_1d", by_precisions),
    ("kalman_1d", by_library),
    ("kl", kl_by_loop),
    ("lost", "0.357"),
    ("coarse_x", one_reading_at_a_time),
]


@pytest.mark.parametrize(("item", "answer"), RIGHT)
def test_a_right_answer_in_another_form_passes(item, answer):
    judged = ITEMS[item].judge(answer)
    assert judged.fraction == 1, judged


def test_robots_may_be_followed_one_by_one():
    settings = ITEMS["gauss_x"].settings(np.random.default_rng(1))[1]
    alone = each_robot_alone(*settings, np.random.default_rng(2), 12)
    together = ITEMS["gauss_x"](*settings, np.random.default_rng(2), 12)
    assert np.allclose(alone, together)


def test_the_loss_of_wide_cells_is_the_law_of_the_text():
    for ratio in (1, 2):
        loss = ITEMS["coarse_x"](0.2 * ratio, 0.2, np.random.default_rng(3), 40_000)
        assert abs(loss.mean() - ratio**2 / 24) < 4 * loss.std() / 200 + 0.002
