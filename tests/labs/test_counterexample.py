"""A mistake that nobody foresaw is shown: input, what came out, what should have."""

import numpy as np
import pytest

from pfkit.labs import code
from pfkit.labs.items.counterexample import Call, can_be_told, shown, smallest


def double(x):
    return 2 * np.asarray(x)


@pytest.fixture
def item():
    @code("""Double
        h1
        h2
        h3""")
    def doubled(x):
        return 2 * x

    doubled.holds("doubles ones", lambda f: np.array_equal(f(np.ones(5)), np.full(5, 2.0)))
    doubled.holds("doubles a number", lambda f: f(np.array([3.0]))[0] == 6)
    return doubled


def test_the_smallest_input_is_shown(item):
    judged = item.judge(lambda x: 3 * x)
    assert judged.example == "For x = [3.] you returned [9.]; expected [6.]."


def test_a_right_answer_needs_none(item):
    assert item.judge(lambda x: x + x).example == ""


def test_an_exception_is_shown_with_its_input(item):
    assert "x = [3.] it raised ZeroDivisionError" in item.judge(lambda x: 1 // 0).example


def test_a_long_array_is_shortened_to_where_it_differs():
    def almost(x):
        y = 2 * x
        y[17] = 0
        return y

    x = np.arange(40.0)
    text = smallest([Call((x,), {}, almost(x))], double)
    assert "you returned 0 at index 17; expected 34 there (1 of 40 numbers differ)" in text


def test_another_shape_is_named():
    text = smallest([Call((np.ones(3),), {}, 2.0)], double)
    assert "shape ()" in text and "of (3,)" in text


def test_chance_is_called_chance():
    def draw(w, rng):
        return rng.choice(len(w), 3)

    rng = np.random.default_rng(1)
    text = smallest([Call((np.ones(4), rng), {}, np.zeros(3, int))], draw)
    assert "a right answer with the same random numbers can return" in text
    assert "rng" not in text.partition("you returned")[0]


def test_arguments_that_were_written_into_are_told_as_they_came(item):
    def spoil(x):
        x *= 3
        return x

    assert "x = [3.]" in item.judge(spoil).example


def test_what_cannot_be_told_is_left_out():
    assert not can_be_told((lambda: 0,), {})
    assert not can_be_told((np.zeros(10_000),), {})
    assert can_be_told((np.zeros(3), 2, [1, 2]), {"rng": np.random.default_rng(0)})
    assert smallest([], double) == ""


def test_an_input_that_the_reference_refuses_shows_nothing():
    def picky(x):
        raise ValueError("no")

    assert smallest([Call((1.0,), {}, 2.0)], picky) == ""


def test_numbers_are_short():
    assert shown(0.123456) == "0.1235"
    assert len(shown(np.arange(1000))) < 60


def test_results_of_several_parts_differ_where_a_part_does():
    @code(
        """Weights, and their sum
        h1
        h2
        h3""",
        id="parts",
    )
    def parts(w):
        return w / w.sum(), w.sum()

    parts.holds("weights and sum", lambda f: np.isclose(f(np.array([3.0, 1.0]))[1], 4.0))
    told = parts.judge(lambda w: (w / w.sum(), w.size)).example
    assert "in part 2 of the result you returned 2; expected 4" in told
    ragged = parts.judge(lambda w: (w / w.sum(),)).example
    assert "1 parts; expected 2" in ragged or "shape" in ragged
