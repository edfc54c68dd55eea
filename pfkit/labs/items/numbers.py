"""N: numbers with a tolerance."""

from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np

from pfkit.labs.items.base import Item, Judgement, Misconception
from pfkit.labs.verdict import Line


class NotNumbers(ValueError):
    """What the student gave instead of the numbers, and what to write: two sentences."""


@dataclass(eq=False)
class Numeric(Item):
    """N: numbers with a tolerance; the usual wrong values are named.

        ess = Numeric('''Effective sample size of (.5, .25, .25)
            Square the weights first.
            Then sum.
            ESS = 1 / sum of w squared.''', 2.667, tol=0.005)

        ess.wrong('''sum-of-squares: is the sum of squares itself
            How many particles is that?
            Turn the fraction over.
            1 / 0.375.''')(0.375)

    A tuple, a list and an array are the same answer. Numbers that are right in another form
    (rounded too far, in per cent, in another order) are not accepted, and told apart from wrong
    ones without spending a hint.

    Parameters
    ----------
    key : float or tuple of float
    tol : float
        Accepted absolute difference, stated in the question.
    unit : str
    names : tuple of str
        One name per number, where there are several.
    """

    letter: ClassVar[str] = "N"
    key: float | tuple[float, ...]
    _: KW_ONLY
    tol: float
    unit: str = ""
    names: tuple[str, ...] = ()

    def solution(self) -> Any:
        return self.key

    def _identity(self) -> tuple:
        return (self.key, self.tol)

    def _numbers(self, answer: Any) -> np.ndarray:
        """The answer in the shape of the key; raises NotNumbers."""
        try:
            x = np.asarray(answer)
            if x.dtype.kind == "O":
                x = x.astype(float)  # fractions and decimals are numbers, too
        except Exception:
            raise NotNumbers("not all of it is a number", "Fill in every place.") from None
        if x.dtype.kind == "U":
            raise NotNumbers("I got text", "Write numbers without quotation marks.")
        if x.dtype.kind not in "iuf":
            kind = type(answer).__name__
            raise NotNumbers(f"I got a value of type {kind}", "Write it as a plain number.")
        if x.size != np.size(self.key):
            raise NotNumbers(f"I got {x.size}", "Separate several numbers by commas.")
        return x.reshape(np.shape(self.key)).astype(float)

    def _close(self, x: Any, key: Any) -> np.ndarray:
        # a hair wider than stated, so that a value exactly on the edge is accepted
        return np.abs(np.asarray(x, dtype=float) - key) <= self.tol * (1 + 1e-9)

    def judge(self, answer: Any) -> Judgement:
        count = np.size(self.key)
        try:
            x = self._numbers(answer)
        except NotNumbers as wrong:
            wanted = "one number" if np.ndim(self.key) == 0 else f"{count} numbers"
            unit = f", in {self.unit}" if self.unit else ""
            found, remedy = wrong.args
            return Judgement((Line(wanted + unit, False, found),), None, remedy)
        default = ("the number",) if count == 1 else tuple(f"number {i + 1}" for i in range(count))
        close = np.atleast_1d(self._close(x, self.key))
        lines = tuple(
            Line(f"{name} within {self.tol:g} {self.unit}".strip(), bool(ok), f"you gave {v:.6g}")
            for name, ok, v in zip(self.names or default, close, np.atleast_1d(x), strict=True)
        )
        if close.all():
            return Judgement(lines)
        mistake = self._recognise(x)
        return Judgement(lines, mistake, "" if mistake else self._in_another_form(x, close))

    def _in_another_form(self, x: np.ndarray, close: np.ndarray) -> str:
        """A sentence if the numbers are right but for their form, else nothing."""
        key, given = np.atleast_1d(self.key).astype(float), np.atleast_1d(x)
        wrong = [(k, v) for k, v, ok in zip(key, given, close, strict=True) if not ok]
        if all(_is_rounded(v, k) for k, v in wrong):
            return f"Right, but rounded too far: give it to within {self.tol:g}."
        if np.abs(key).max() <= 1 and self._close(given / 100, key).all():
            return "Right in per cent; the question asks for a number between 0 and 1."
        if self._close(np.sort(given), np.sort(key)).all():
            return "The right numbers, in another order than the question asks for."
        return ""

    def _fits(self, mistake: Misconception, evidence: Any) -> bool:
        if mistake.when is not None:
            return bool(mistake.when(evidence))
        return bool(np.all(self._close(evidence, mistake.example)))


def _is_rounded(value: float, key: float) -> bool:
    """Is it the key, rounded to 2 to 4 digits or places?"""
    forms = [float(f"{key:.{n}g}") for n in (2, 3, 4)] + [round(key, n) for n in (2, 3, 4)]
    return value != 0 and any(abs(value - form) <= 1e-9 * abs(form) for form in forms)
