"""Numbers in another form are read where they are right, and named where they are not."""

import numpy as np
import pytest

from pfkit.labs import Numeric
from pfkit.labs.items import units


def judged(key, answer, unit="", tol=0.005):
    return Numeric("A number", key, tol=tol, unit=unit).judge(answer)


@pytest.mark.parametrize(
    ("key", "unit", "answer"),
    [
        (0.14, "m", "14 cm"),
        (0.14, "m", "0.14 m"),
        (0.14, "m", "140 millimetres".replace("millimetres", "mm")),
        (0.14, "", "14 %"),
        (0.14, "", "14 per cent"),
        (1 / 3, "", "1/3"),
        (0.5, "s", "500 ms"),
        (np.pi / 2, "rad", "90 degrees"),
        (np.pi / 2, "rad", "90°"),
        (-3.0, "rad", -3.0 + 2 * np.pi),
        (350.0, "deg", -10.0),
        (1.0, "m/s", "3.6 km/h"),
        (np.log(2), "nat", "1 bit"),
        ((0.1, 0.2), "m", ("10 cm", 0.2)),
    ],
)
def test_read_where_it_is_right(key, unit, answer):
    assert judged(key, answer, unit).fraction == 1


@pytest.mark.parametrize(
    ("key", "unit", "answer", "says"),
    [
        (0.14, "m", 14, "Right in centimetres; the question asks for metres."),
        (0.14, "m", 140, "Right in millimetres; the question asks for metres."),
        (0.14, "", 14, "Right in per cent; the question asks for a number between 0 and 1."),
        (np.pi / 2, "rad", 90, "Right in degrees; the question asks for radians."),
        (0.5, "s", 500, "Right in milliseconds; the question asks for seconds."),
        ((0.1, 0.2), "m", (10, 20), "Right in centimetres; the question asks for metres."),
    ],
)
def test_named_where_it_is_not(key, unit, answer, says):
    found = judged(key, answer, unit)
    assert found.fraction < 1 and found.feedback == says


@pytest.mark.parametrize("answer", ["3 s", "banana", "1/0", "", "14 cm cm", "--3"])
def test_what_is_no_such_number_is_refused_with_a_remedy(answer):
    found = judged(0.14, answer, "m")
    assert found.fraction == 0 and "metres" in found.feedback


def test_a_length_is_not_per_cent_and_a_large_number_is_not_either():
    assert "per cent" not in judged(0.14, 14, "m").feedback
    assert "per cent" not in judged(5.0, 500).feedback
    assert judged(0.2, 0.9).feedback == ""


def test_scales_are_relative_to_the_unit_that_is_asked():
    assert units.scales("cm")["m"] == pytest.approx(100)
    assert units.scales("px^2") == {"px^2": 1.0}
