"""Lab 3, Q2 to Q8: right answers in forms that nobody asked for are right."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import lab3 as lab


def in_two_pi(state, dt):
    x, y, theta, v, omega = state
    ahead = [x + v * dt * np.cos(theta), y + v * dt * np.sin(theta)]
    return [*ahead, np.mod(theta + omega * dt, 2 * np.pi), v, omega]


def by_arctan(state, dt):
    theta, v, omega = state[2:]
    later = theta + omega * dt
    ahead = state[:2] + v * dt * np.stack([np.cos(theta), np.sin(theta)])
    return np.concatenate([ahead, np.arctan2(np.sin(later), np.cos(later))[None], state[3:]])


def particle_by_particle(z, state, sigma):
    constant = np.log(2 * np.pi) + 2 * np.log(sigma)
    return [-0.5 * ((z[0] - x) ** 2 + (z[1] - y) ** 2) / sigma**2 - constant for x, y in state.T]


def axis_by_axis(z, state, sigma):
    one = np.log(np.sqrt(2 * np.pi) * sigma)
    return sum(-0.5 * ((z[k] - state[k]) / sigma) ** 2 - one for k in (0, 1))


def walking_comb(w, rng):
    M, offset = len(w), rng.uniform(0, 1 / len(w))
    c, i, found = w[0], 0, []
    for k in range(M):
        while offset + k / M > c and i < M - 1:
            i += 1
            c += w[i]
        found.append(i)
    return found


def backwards(w, rng):
    M = len(w)
    teeth = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), teeth, side="right"), M - 1)[::-1]


def last_edge_at_one(w, rng):
    edges = np.cumsum(w)
    edges[-1] = 1.0
    return np.searchsorted(edges, (np.arange(len(w)) + rng.uniform()) / len(w))


def by_counts(w, rng):
    M = len(w)
    copies = np.floor(M * w * (1 + 1e-12)).astype(int)
    left = M - copies.sum()
    if left:
        rest = np.clip(M * w - copies, 0, None)
        copies = copies + rng.multinomial(left, rest / rest.sum())
    return list(np.repeat(np.arange(M), copies))


def three_from_one_cloud(M, sigma, rng, runs):
    bel, motion, sensor = lab.anywhere((runs, M), rng), pf.FixedTarget(1.4), pf.Position(sigma)
    c, b, a = (
        lab.track(lab.film[:200], bel, motion, sensor, rng, **options).error[100:].mean(axis=0)
        for options in ({}, {"scheme": None}, {"scheme": None, "weighted": False})
    )
    return [a, b, c]


def counted(scheme, w, M, rng):
    weights = np.array([w] + [(1 - w) / (M - 1)] * (M - 1))
    return float(np.bincount(scheme(weights, rng), minlength=M)[0] > 0)


RIGHT = [
    ("q2a", "219.0 px"),
    ("q2a", 219),
    ("q2c", in_two_pi),
    ("q2c", by_arctan),
    ("q3c", particle_by_particle),
    ("q3c", axis_by_axis),
    ("q3d", lambda log_l: [np.exp(a - np.logaddexp.reduce(log_l)) for a in log_l]),
    ("q4a", [5, 5, 1, 2]),
    ("q4b", walking_comb),
    ("q4b", backwards),
    ("q4b", last_edge_at_one),
    ("q4c", by_counts),
    ("q4d", lambda state, w, a: [np.take(state, a, axis=1), [1 / len(a)] * len(a)]),
    ("q5a", ("70.1 %", "39.4 %", "100 %", "1/2")),
    ("q5b", lambda w, M: [1 - (1 - w) ** M, np.clip(M * w, 0, 1)]),
    ("q5b", lambda w, M: (1 - np.prod(np.full(M, 1 - w)), 1.0 if w >= 1 / M else w * M)),
    ("q5c", counted),
    ("q6b", lambda state, sigma, rng: rng.normal(state, sigma)),
    ("q6b", lambda state, sigma, rng: [[x + rng.normal(0, sigma) for x in r] for r in state]),
    ("q8b", three_from_one_cloud),
]


@pytest.mark.parametrize(("item", "answer"), RIGHT, ids=lambda v: v if isinstance(v, str) else "")
def test_right_in_another_form(item, answer):
    lab.LAB.forget()
    lab.predict("q8a", ("a", 60))
    verdict = lab.check(item, answer)
    lab.LAB.forget()
    assert verdict.status == "passed", str(verdict)
