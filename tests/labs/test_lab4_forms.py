"""Lab 4: right answers that look different are right, too."""

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import lab4 as lab

MIXED = pf.OutlierMixture(pf.Position(5.0), 0.5, 1 / lab.AREA)


def one_at_a_time(variance, M, rng, runs):
    """A loop over runs, without a batch, and a list of floats."""
    found = []
    for _ in range(runs):
        bel = lab.around(lab.film.start[:2], M, rng, sigma=100.0)
        sensor = pf.Position(float(variance) ** 0.5)
        run = lab.track(lab.film[:120], bel, pf.FixedTarget(1.4), sensor, rng)
        found.append(float(np.mean(run.error[50:120])))
    return found


def steps_by_hand(model, M, rng, runs):
    """No lab.track: predict, update, resample, a stream of its own."""
    own = rng.spawn(1)[0]
    noise = {"fixed": (6.0, 0.0), "line": (1.0, 0.05), "circle": (0.5, 0.01)}[model]
    motion, sensor = lab.model_of(model, *noise), pf.Position(20.0)
    bel, errors = lab.start_of(model, lab.circle, (runs, M), own), []
    for k, (_, u, z, _) in enumerate(lab.circle[:150]):
        bel, _ = pf.update(pf.predict(bel, u, motion, own), z, sensor)
        mean = (bel.w * bel.state[:2]).sum(axis=-1)
        errors.append(np.hypot(*(mean - lab.circle.truth[:2, k, None])))
        bel = pf.take(bel, pf.systematic(bel.w, own))
    return tuple(np.mean(errors[50:], axis=0))


def a_list_of_rows(variance, M, frames, rng, runs):
    bel = lab.around(lab.film.start[:2], (runs, M), rng.spawn(1)[0], sigma=100.0)
    motion = pf.FixedTarget(variance**0.5)
    error = lab.track(lab.film[:frames], bel, motion, pf.Position(5.0), rng).error
    return [list(np.average(error, axis=0)), list(np.average(error[frames - 100 :], axis=0))]


def seeds_of_another_kind(model, sigma, M, rng, runs):
    films = lab.target_log("circle", "high", seed=int(rng.random() * 1e9), runs=runs)
    bel = lab.start_of(model, films, (runs, M), rng)
    motion = lab.model_of(model, sigma, {"line": 0.05, "circle": 0.01}.get(model, 0.0))
    error = lab.track(films[:150], bel, motion, pf.Position(20.0), rng).error
    return error[50:].mean(axis=0), lab.measurement_error(films)[50:150].mean(axis=0)


def log_likelihood(film, M, rng, runs):
    bel = lab.start_of("circle", film, (runs, 50), rng)
    return np.log(lab.track(film, bel, lab.model_of("circle", 2.0), MIXED, rng).likelihood)


def by_the_controls(film, M, rng, runs):
    """No filter: where start and controls lead, and how far off the measurement is."""
    state, found = film.start[:, None], []
    for _, u, z, _ in film:
        state = lab.model_of("circle", 0.0).mean(state, u)
        found.append([-np.hypot(*(z[:, 0] - state[:2, 0]))] * runs)
    return found


def gate_by_a_loop(likelihood, threshold):
    total = 0.0
    for p in likelihood:
        total += p / len(likelihood)
    return total < threshold


RIGHT = {
    "runs in a loop": ("q9b", one_at_a_time),
    "rows in lists": ("q10b", a_list_of_rows),
    "steps by hand": ("q12a", steps_by_hand),
    "a gate by a loop": ("q13a", gate_by_a_loop),
    "a gate that gives 0 or 1": ("q13a", lambda p, t: int(p.sum() < t * p.size)),
    "a gate by not": ("q13a", lambda p, t: not np.average(p) >= t),
    "a mixture in a list": ("q13b", lambda p, e, a: [x + e * (1 / a - x) for x in p.tolist()]),
    "logarithms": ("q13c", log_likelihood),
    "the controls alone": ("q13c", by_the_controls),
    "another seed": ("q14a", seeds_of_another_kind),
    "a variance in text": ("q15c", "1591.5 px^2"),
    "a whole number": ("q15c", 1592),
}


@pytest.mark.parametrize("name", RIGHT)
def test_right_in_another_form(name):
    item, answer = RIGHT[name]
    judged = lab.LAB.items[item].judge(answer)
    assert judged.fraction == 1, [str(x) for x in judged.lines if not x.ok]


def test_the_films_of_the_detector_hold_no_labels():
    """Neither the labels nor the truth can be read off."""
    seen = []

    def look(film, M, rng, runs):
        seen.append(film)
        return np.zeros((len(film), runs))

    lab.LAB.items["q13c"].outcomes(look, 2)
    assert len(seen) == 2
    for film in seen:
        assert film.outlier is None and np.ptp(film.truth, axis=1).max() == 0


def test_measurement_error_of_one_film_and_of_many():
    one = lab.measurement_error(lab.circle)
    many = lab.measurement_error(lab.target_log("circle", "high", seed=1, runs=3))
    assert one.shape == (688, 1) and many.shape == (688, 3)
    z = np.array(lab.circle.z)[:, :, 0].T
    assert np.allclose(one[:, 0], np.hypot(*(z - lab.circle.truth[:2])))
