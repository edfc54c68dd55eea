"""Survival probabilities in closed form, against counting."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import pfkit as pf

W = np.array((0.0, 0.3, 0.02, 0.08, 0.25, 0.05, 0.1, 0.2))


@pytest.mark.parametrize("n", [None, 3, 30])
@pytest.mark.parametrize("name", pf.SCHEMES)
def test_the_formula_agrees_with_counting(name, n):
    """Fixed seed; |z| < 4.5 on 8 particles has a false-fail rate below 6e-5 a case."""
    runs = 8_000
    ancestors = pf.SCHEMES[name](np.tile(W, (runs, 1)), np.random.default_rng(2), n)
    alive = np.array([(ancestors == m).any(axis=1).mean() for m in range(W.size)])
    chance = pf.survival_probability(W, name, n)
    sure = (chance == 0) | (chance == 1)
    np.testing.assert_array_equal(alive[sure], chance[sure])
    z = (alive - chance)[~sure] / np.sqrt(chance * (1 - chance) / runs)[~sure]
    assert np.abs(z).max(initial=0) < 4.5


@given(
    w=arrays(float, st.integers(1, 20), elements=st.floats(0, 10)).filter(lambda w: w.sum() > 1e-3),
    n=st.integers(1, 40),
)
def test_no_scheme_beats_systematic_and_none_falls_below_multinomial(w, n):
    chance = {name: pf.survival_probability(w, name, n) for name in pf.SCHEMES}
    expected = n * w / w.sum()
    for values in chance.values():
        assert (values >= 0).all() and (values <= np.minimum(1, expected) + 1e-9).all()
        assert (values <= chance["systematic"] + 1e-9).all()
    for name in ("residual", "stratified"):
        assert (chance[name] >= chance["multinomial"] - 1e-9).all()


def test_equal_weights():
    w = np.full(1000, 1e-3)
    assert pf.survival_probability(w, "multinomial") == pytest.approx(1 - np.exp(-1), abs=2e-4)
    for name in ("residual", "stratified", "systematic"):
        assert pf.survival_probability(w, name) == pytest.approx(1.0, abs=1e-9)


def test_whole_expectations_leave_nothing_to_chance():
    np.testing.assert_array_equal(
        pf.survival_probability([1, 2, 0, 1], "residual", 4), [1, 1, 0, 1]
    )
