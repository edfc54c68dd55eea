"""`run` weighs in stages and recovers, if it is asked to."""

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds

MOTION = pf.VelocityMotion((0.005, 0.001, 0.001, 0.005))
SENSOR = pf.RangeBearing(worlds.arena(), 0.1, 0.02)
WIDE = pf.RangeBearing(worlds.arena(), 0.5, 0.1)


def drive(seed=0, **options):
    rng = np.random.default_rng(seed)
    return pf.simulate_log(worlds.ARENA_START, worlds.arena_route(), MOTION, SENSOR, rng, **options)


def found(log, seeds, M, sensor=SENSOR, **options):
    """How many of the filters are within a metre at the end, from anywhere."""
    rng = np.random.default_rng(1)
    bel = pf.uniform_prior((seeds, M), worlds.arena(), rng)
    history = pf.run(log, bel, MOTION, sensor, rng, **options)
    assert np.isfinite(history.log_evidence).all()
    return int((pf.position_error(history.estimate, history.truth)[-1] < 1.0).sum())


def test_stages_find_the_robot_with_few_particles():
    """Forty particles for an arena, sharp sensor: 20 filters; plain weighting loses a third."""
    log = drive(every=4)
    assert found(log, 20, 40, temper=0.5) >= 18
    assert found(log, 20, 40) <= 16


def test_recovery_finds_a_robot_that_was_carried_off():
    log = drive(kidnap={50: [8.0, 6.0, 2.0]})
    assert found(log, 10, 400, sensor=WIDE, recover=worlds.arena()) >= 9
    assert found(log, 10, 400, sensor=WIDE) <= 2


def test_what_is_replaced_has_no_ancestor_and_no_option_changes_nothing():
    log = drive(kidnap={30: [8.0, 6.0, 2.0]})
    bel = pf.gaussian_prior(100, log.start, (0.1, 0.1, 0.1), np.random.default_rng(2))
    new = []
    pf.run(
        log,
        bel,
        MOTION,
        WIDE,
        np.random.default_rng(3),
        recover=worlds.arena(),
        watch=lambda k, bel, info: new.append((info.ancestors < 0).sum()),
    )
    assert sum(new[:30]) < sum(new[30:]) and sum(new) > 50
    one, two = (
        pf.run(log, bel, MOTION, WIDE, np.random.default_rng(3), **options)
        for options in ({}, {"temper": 0.0, "recover": None})
    )
    np.testing.assert_array_equal(one.estimate, two.estimate)
    with pytest.raises(pf.ParameterError, match="keep"):
        pf.run(log, bel, MOTION, WIDE, np.random.default_rng(3), temper=2.0)
