"""A sensor's mounting and clock are found, with honest standard errors, or named as unseen."""

from dataclasses import replace

import numpy as np
import pytest

import pfkit as pf
from pfkit import worlds
from pfkit.judging.localise import localise, score, settings_for
from pfkit.logs.seat import fit_seat

MOTION = pf.VelocityMotion((0.005, 0.001, 0.001, 0.005))
ANGLES = np.linspace(-2, 2, 41)
BEAMS = pf.BeamModel(worlds.office(), ANGLES, 8.0, 0.03, 1.0, 0.9, 0.03, 0.03, 0.04)
MARKS = pf.RangeBearing(worlds.arena(), 0.1, 0.02)


def drive(mount=(0.0, 0.0, 0.0), flipped=False, laser=False, seed=0):
    """A log whose rig does not tell of the mounting."""
    rng = np.random.default_rng(seed)
    sensor = pf.Mounted(BEAMS if laser else MARKS, mount, flipped)
    if laser:
        driver = pf.PurePursuit(worlds.OFFICE_ROUTE, v=0.5, dt=0.2)
        log = pf.simulate_log(worlds.OFFICE_START, driver, MOTION, sensor, rng, steps=140)
    else:
        route = worlds.arena_route() * np.array([[1.0], [1.0], [1.0]])
        log = pf.simulate_log(worlds.ARENA_START, route, MOTION, sensor, rng)
    return replace(log, rig=replace(log.rig, mount=(0, 0, 0)))


@pytest.mark.parametrize("mount", [(0, 0, 0), (0.2, 0.1, 0.05), (-0.3, 0.0, -0.4)])
def test_landmarks_tell_where_the_camera_sits_and_how_surely(mount):
    """Twenty drives: four standard errors at most, and errors of the size that is claimed."""
    scores = []
    for seed in range(20):
        seat = fit_seat(drive(mount, seed=seed))
        scores.append((seat.value - np.append(mount, 0.0)) / seat.sd)
    scores = np.array(scores)
    assert np.abs(scores).max() < 4 and (scores.std(axis=0) < 1.5).all()
    assert (scores.std(axis=0) > 0.1).all()  # and not absurdly wide


@pytest.mark.parametrize("mount", [(0.22, 0.0, 0.08), (0.1, -0.05, 1.2)])
def test_a_laser_finds_its_seat_by_the_walls(mount):
    seat = fit_seat(drive(mount, laser=True))
    np.testing.assert_allclose(seat.value[:3], mount, atol=0.04)
    assert seat.value[3] == pytest.approx(0, abs=0.05) and (seat.sd < 0.05).all()


def test_calibration_seats_the_laser_and_the_filter_is_right_again():
    log = drive((0.22, 0.0, 0.3), laser=True)
    calibration = pf.calibrate(log)
    np.testing.assert_allclose(calibration.mount, (0.22, 0, 0.3), atol=0.06)
    errors = []
    for fitted in (None, calibration):
        settings = settings_for(log, fitted)
        told = log if fitted is None else fitted.apply(log)
        track = localise(told, np.random.default_rng(0), M=300, settings=settings)
        errors.append(float(score(log, track.estimate, settings.limit).rmse[0]))
    assert errors[1] < 0.06 and errors[0] > 3 * errors[1]


def test_a_late_clock_is_found_and_one_speed_on_one_line_cannot_tell_it_from_the_seat():
    log = drive()
    late = replace(log, z=[log.z[0][:, :0], *log.z[:-1]])  # a quarter of a second
    seat = fit_seat(late)
    assert seat.value[3] == pytest.approx(0.25, abs=4 * seat.sd[3]) and seat.alike == ()
    u = np.tile(np.array([[0.3], [0.0], [0.2]]), 100)
    still = pf.VelocityMotion((0, 0, 0, 0))
    line = pf.simulate_log([2.0, 3.0, 0.0], u, still, MARKS, np.random.default_rng(0))
    seat = fit_seat(line)
    assert seat.alike == ("mount x and clock",) and seat.confused.tolist() == [1, 0, 0, 1]
    assert "cannot tell mount x and clock apart" in str(seat)


def test_calibration_reports_what_it_found_with_its_errors():
    found = pf.calibrate(drive((0.2, 0.0, 0.1)))
    np.testing.assert_allclose(found.mount, (0.2, 0, 0), atol=0.05)  # its yaw is the bearing's bias
    assert found.bearing_bias == pytest.approx(-0.1, abs=0.02)
    for word in ("speed x", "+-", "sideways slip", "mount yaw", "clock"):
        assert word in str(found)


def test_a_truth_without_headings_is_refused():
    log = drive()
    truth = np.vstack((log.truth[:2], np.full(len(log), np.nan)))
    with pytest.raises(pf.DataError, match="truth with headings"):
        fit_seat(replace(log, truth=truth))
