"""The named errors and the checks that raise them: what was wrong, the value, the remedy."""

from datetime import date
from fractions import Fraction

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
    ["1", None, [1, None], [[1], [2, 3]], 1j, np.array([1j]), date.today(), [Fraction(1)], {}],
)
def test_what_is_not_a_real_number_is_named(value):
    with pytest.raises(errors.ParameterError, match=r"speed must be real numbers, got .*pass"):
        errors.as_numbers("speed", value)


def test_a_float_array_is_not_copied():
    array = np.zeros(3)
    assert errors.require_finite("v", array) is array
    assert errors.require_components("v", array, 3) is array


CASES = [
    (errors.require_finite, (np.nan,), "finite, got nan"),
    (errors.require_finite, ([0, -np.inf],), "finite, got -inf"),
    (errors.require_positive, (0,), "> 0, got 0"),
    (errors.require_positive, ([1, -2],), "> 0, got -2"),
    (errors.require_non_negative, (-1e-9,), ">= 0, got -1e-09"),
    (errors.require_fraction, (1.1,), r"\[0, 1\], got 1.1"),
    (errors.require_fraction, ([0.5],), r"one number .* got \[0.5\]"),
    (errors.require_count, (0,), ">= 1, got 0"),
    (errors.require_count, (2.0,), "whole number >= 1, got 2.0"),
    (errors.require_count, (True,), "whole number >= 1, got True"),
    (errors.require_count, (4, 5), "whole number >= 5, got 4"),
    (errors.require_shape, ((3, 0),), "whole number >= 1, got 0"),
    (errors.require_shape, ((),), r"got \(\)"),
]


@pytest.mark.parametrize("check, arguments, words", CASES)
def test_each_check_says_what_it_got(check, arguments, words):
    with pytest.raises(errors.ParameterError, match=f"noise must be .*{words}"):
        check("noise", *arguments)


def test_checks_hand_back_the_value():
    assert errors.require_count("n", np.int64(3)) == 3
    assert errors.require_fraction("f", 0) == 0.0 and errors.require_fraction("f", 1) == 1.0
    assert errors.require_shape("M", 4) == (4,)
    assert errors.require_shape("M", (2, np.int32(4))) == (2, 4)
    assert errors.require_non_negative("a", 0) == 0


def test_components_first_and_the_hint_to_transpose():
    with pytest.raises(errors.ShapeError, match=r"\(3, \.\.\.\), got \(5, 3\); transpose it"):
        errors.require_components("pose", np.zeros((5, 3)), 3)
    with pytest.raises(errors.ShapeError, match=r"got \(\)$"):
        errors.require_components("pose", 1.0, 3)
    with pytest.raises(errors.DataError, match="z must be finite, got nan"):
        errors.require_components("z", [np.nan, 0.0], 2, errors.DataError)


@pytest.mark.parametrize("stand_in", [None, 7, np.random, np.random.RandomState(0)])
def test_only_a_generator_is_a_generator(stand_in):
    with pytest.raises(errors.ParameterError, match="default_rng"):
        errors.require_rng(stand_in)
    errors.require_rng(np.random.default_rng())


def test_a_model_is_known_by_its_methods():
    errors.require_method("list", [], "append", "pop")
    with pytest.raises(errors.ParameterError, match=r"motion must have a method sample.*got 3"):
        errors.require_method("motion", 3, "sample")
