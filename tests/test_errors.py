"""The named errors and the checks that raise them: what was wrong, the value, the remedy."""

from datetime import date
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from pfkit import errors


def test_every_error_is_a_value_error_of_ours():
    kinds = [k for k in vars(errors).values() if isinstance(k, type) and issubclass(k, Exception)]
    assert len(kinds) == 6
    assert all(issubclass(kind, errors.PfkitError) for kind in kinds)
    assert issubclass(errors.PfkitError, ValueError)


@pytest.mark.parametrize("value", [1, 2.5, True, [1, 2], (3.0,), np.float32(1), np.arange(3)])
def test_numbers_pass_as_floats(value):
    array = errors.as_numbers("v", value)
    assert array.dtype == float
    np.testing.assert_array_equal(array, value)


@pytest.mark.parametrize(
    "value",
    ["1", None, [1, None], 1j, np.array([1j]), date.today(), [Fraction(1)], {}],
)
def test_what_is_not_a_real_number_is_named(value):
    with pytest.raises(errors.ParameterError, match=r"speed must be real numbers, got .*pass"):
        errors.as_numbers("speed", value)


def test_a_float_array_is_not_copied():
    array = np.zeros(3)
    assert errors.require_array("v", array) is array
    assert errors.require_array("v", array, (3, ...)) is array


CASES = [
    (errors.require_array, (np.nan,), "finite, got nan"),
    (errors.require_array, ([0, -np.inf],), "finite, got -inf"),
    (errors.require_array, (0, (), "finite and > 0"), "> 0, got 0"),
    (errors.require_array, ([1, -2], (2,), "finite and > 0"), "> 0, got -2"),
    (errors.require_array, (np.inf, (), "finite and >= 0"), "finite and >= 0, got inf"),
    (errors.require_number, (-1e-9, "finite and >= 0"), ">= 0, got -1e-09"),
    (errors.require_number, (1.1, "in [0, 1]"), r"\[0, 1\], got 1.1"),
    (errors.require_number, (0.0, "in (0, 1]"), r"\(0, 1\], got 0.0"),
    (errors.require_number, (1.0, "in [0, 1)"), r"\[0, 1\), got 1.0"),
    (errors.require_number, (1.0, "in (0, 1)"), r"\(0, 1\), got 1.0"),
    (errors.require_number, (2.5, "whole"), "whole, got 2.5"),
    (errors.require_number, (0, "whole and >= 1"), ">= 1, got 0"),
    (errors.require_number, (np.nan, "a number"), "a number, got nan"),
    (errors.require_count, (0,), ">= 1, got 0"),
    (errors.require_count, (2.0,), "whole number >= 1, got 2.0"),
    (errors.require_count, (True,), "whole number >= 1, got True"),
    (errors.require_count, (4, 5), "whole number >= 5, got 4"),
    (errors.require_shape, ((3, 0),), "whole number >= 1, got 0"),
]


@pytest.mark.parametrize("rule", errors.RULES.keys() - {"not infinite"})
def test_no_other_rule_lets_nan_through_and_each_names_a_remedy(rule):
    with pytest.raises(errors.ParameterError, match=r"got nan; .+"):
        errors.require_number("noise", np.nan, rule)


def test_the_unknown_may_pass():
    assert np.isnan(errors.require_number("truth", np.nan, "not infinite"))
    with pytest.raises(errors.ParameterError, match="not infinite, got -inf"):
        errors.require_number("truth", -np.inf, "not infinite")


def test_infinity_switches_a_bound_off():
    assert errors.require_number("gate", np.inf, "> 0") == np.inf
    assert errors.require_array("length", [0.0, np.inf], rule=">= 0").tolist() == [0.0, np.inf]


@pytest.mark.parametrize("shape", [(), (4,), (3, 4), (3, 2, 4)])
def test_a_shape_is_wanted_as_the_docstrings_write_it(shape):
    fits = {
        (...,): True,
        shape: True,
        (3, ...): shape[:1] == (3,),
        (..., "M"): shape != (),
        (3, "B", "M"): shape == (3, 2, 4),
        ("D", "M", ...): len(shape) >= 2,
        (5, ...): False,
    }
    for wanted, expected in fits.items():
        try:
            errors.require_array("v", np.zeros(shape), wanted)
            fitted = True
        except errors.ShapeError:
            fitted = False
        assert fitted == expected, (shape, wanted)


def test_a_named_axis_is_not_empty():
    with pytest.raises(errors.ShapeError, match=r"shape \(2, L\), L >= 1, got \(2, 0\)"):
        errors.require_array("positions", np.empty((2, 0)), (2, "L"))
    assert errors.require_array("pose", np.empty((3, 0)), (3, ...)).shape == (3, 0)


def test_one_number_is_no_array_of_one():
    with pytest.raises(errors.ShapeError, match=r"noise must have shape \(\), got \(1,\)"):
        errors.require_number("noise", [0.5])


@pytest.mark.parametrize("check, arguments, words", CASES)
def test_each_check_says_what_it_got(check, arguments, words):
    with pytest.raises(errors.ParameterError, match=f"noise must be .*{words}"):
        check("noise", *arguments)


def test_checks_hand_back_the_value():
    assert errors.require_count("n", np.int64(3)) == 3
    assert errors.require_number("f", 0, "in [0, 1]") == 0.0
    assert errors.require_shape("M", 4) == (4,)
    assert errors.require_shape("M", (2, np.int32(4))) == (2, 4)
    assert errors.require_bounds((0, 1, 0, 2)) == (0.0, 1.0, 0.0, 2.0)


def test_components_first_and_the_hint_to_transpose():
    with pytest.raises(errors.ShapeError, match=r"\(3, \.\.\.\), got \(5, 3\); transpose it"):
        errors.require_array("pose", np.zeros((5, 3)), (3, ...))
    with pytest.raises(errors.ShapeError, match=r"got \(\): 1.0$"):
        errors.require_array("pose", 1.0, (3, ...))
    with pytest.raises(errors.DataError, match="z must be finite, got nan"):
        errors.require_array("z", [np.nan, 0.0], (2, ...), error=errors.DataError)


@pytest.mark.parametrize("stand_in", [None, 7, np.random, np.random.RandomState(0)])
def test_only_a_generator_is_a_generator(stand_in):
    with pytest.raises(errors.ParameterError, match="default_rng"):
        errors.require_rng(stand_in)
    errors.require_rng(np.random.default_rng())


def test_the_fields_of_an_object_are_one_number_each():
    thing = SimpleNamespace(sigma=0.0, share=0.5)
    errors.require_fields(thing, sigma="finite and >= 0", share="in [0, 1]")
    with pytest.raises(errors.ParameterError, match="sigma must be finite and > 0, got 0"):
        errors.require_fields(thing, sigma="finite and > 0")
