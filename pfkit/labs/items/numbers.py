"""N: numbers with a tolerance."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, ClassVar

import numpy as np

from pfkit.labs.items import units
from pfkit.labs.items.base import Item, Judgement, Misconception
from pfkit.labs.verdict import Line

MOST_DRAWS = 100  # of numbers for a world of one's own


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
    key : float or tuple of float, or a function of the numbers in ``world``
    tol : float
        Accepted absolute difference, stated in the question.
    unit : str
    names : tuple of str
        One name per number, where there are several.
    world : dict, optional
        The numbers of the question in print; text, hints and names may hold ``{name}`` of them,
        and keys and wrong values may be functions of them.
    draw : callable, optional
        ``draw(rng)`` -> such numbers of another world, for a student of one's own. Its questions
        must be as hard: the tests try 500.

    ::

        power = Numeric('''Probability that {n} particles all miss one of {rooms} rooms
            Each misses it with one chance.
            They are independent.
            (1 - 1/{rooms})^{n}''',
            lambda n, rooms: (1 - 1 / rooms) ** n, tol=0.002,
            world={"n": 4, "rooms": 4},
            draw=lambda rng: {"n": int(rng.integers(3, 8)), "rooms": int(rng.integers(3, 7))})

        power.wrong('''complement: is the chance that the room is not empty
            ...three hints...''')(lambda n, rooms: 1 - (1 - 1 / rooms) ** n)
    """

    letter: ClassVar[str] = "N"
    key: Any
    _: KW_ONLY
    tol: float
    unit: str = ""
    names: tuple[str, ...] = ()
    world: dict[str, Any] | None = None
    draw: Callable[[np.random.Generator], dict[str, Any]] | None = None
    declared: tuple[Any, ...] = field(init=False, default=())

    def __post_init__(self, text: str) -> None:
        super().__post_init__(text)
        self.declared = (self.title, self.hints, self.names, self.key, [])
        self._enter(self.world)

    def wrong(self, text: str, when: Callable[[Any], bool] | None = None) -> Callable[..., Any]:
        declare = super().wrong(text, when)

        def take(example: Any, **more: Any) -> Any:
            declare(example, **more)
            self.declared[-1].append(self.misconceptions.pop())
            self._enter(self.world)
            return example

        return take

    def _enter_another(self, rng: np.random.Generator) -> None:
        """Draw numbers until no wrong value is right, or another wrong one, by coincidence."""
        for _ in range(MOST_DRAWS if self.draw is not None else 0):
            self._enter(self.draw(rng))
            if self._tells_apart():
                return

    def _tells_apart(self) -> bool:
        judged = ((m, self.judge(m.example)) for m in self.misconceptions)
        return all(j.fraction < 1 and j.misconception is m for m, j in judged)

    def _enter(self, world: dict[str, Any] | None) -> None:
        """Fill the numbers of a world into all that was declared."""
        title, hints, names, key, mistakes = self.declared

        def told(text: str) -> str:
            return text if world is None else text.format(**world)

        def value(of: Any) -> Any:
            return of(**(world or {})) if callable(of) else of

        self.title, self.hints = told(title), tuple(map(told, hints))
        self.names, self.key = tuple(map(told, names)), value(key)
        self.misconceptions = [
            Misconception(
                m.name, told(m.words), tuple(map(told, m.hints)), value(m.example), m.when
            )
            for m in mistakes
        ]

    def solution(self) -> Any:
        return self.key

    def _identity(self) -> tuple:
        return (self.key, self.tol)

    def _numbers(self, answer: Any) -> np.ndarray:
        """The answer in the shape of the key; raises NotNumbers."""
        try:
            x = np.asarray(self._read(answer))
            if x.dtype.kind == "O":
                x = x.astype(float)  # fractions and decimals are numbers, too
        except units.NotRead as wrong:
            asked = f"Write plain numbers, in {units.words(self.unit)}." if self.unit else ""
            raise NotNumbers(str(wrong), asked or "Write plain numbers.") from None
        except Exception:
            raise NotNumbers("not all of it is a number", "Fill in every place.") from None
        if x.dtype.kind not in "iuf":
            kind = type(answer).__name__
            raise NotNumbers(f"I got a value of type {kind}", "Write it as a plain number.")
        if x.size != np.size(self.key):
            raise NotNumbers(f"I got {x.size}", "Separate several numbers by commas.")
        return x.reshape(np.shape(self.key)).astype(float)

    def _read(self, answer: Any) -> Any:
        """Text such as "14 cm" or "1/3" as the number that it says."""
        if isinstance(answer, str):
            return units.read(answer, self.unit)
        if isinstance(answer, list | tuple):
            return [self._read(part) for part in answer]
        return answer

    def _off(self, x: Any, key: Any) -> np.ndarray:
        off = np.asarray(x, dtype=float) - key
        if self.unit in units.TURN:  # angles are the same a turn further
            turn = units.TURN[self.unit]
            off = off - turn * np.round(off / turn)
        return np.abs(off)

    def _close(self, x: Any, key: Any) -> np.ndarray:
        # a hair wider than stated, so that a value exactly on the edge is accepted
        return self._off(x, key) <= self.tol * (1 + 1e-9)

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
        named = {units.another(v, k, self.tol, self.unit) for k, v in zip(key, given, strict=True)}
        if len(named) == 1 and (unit := named.pop()) and (unit != "%" or np.abs(key).max() <= 1):
            asked = units.words(self.unit)
            return f"Right in {units.words(unit)}; the question asks for {asked}."
        if np.unique(key).size == key.size and self._close(np.sort(given), np.sort(key)).all():
            return "The right numbers, in another order than the question asks for."
        return ""

    def _fits(self, mistake: Misconception, evidence: Any) -> bool:
        if mistake.when is not None:
            return bool(mistake.when(evidence))
        # where a wrong value is small, the tolerance of the right one would name all that is small
        narrow = np.where(np.equal(mistake.example, 0), self.tol, 0.05 * np.abs(mistake.example))
        return bool(
            np.all(
                self._off(evidence, mistake.example) <= np.minimum(self.tol, narrow) * (1 + 1e-9)
            )
        )


def _is_rounded(value: float, key: float) -> bool:
    """Is it the key, rounded to 2 to 4 digits or places?"""
    forms = [float(f"{key:.{n}g}") for n in (2, 3, 4)] + [round(key, n) for n in (2, 3, 4)]
    return value != 0 and any(abs(value - form) <= 1e-9 * abs(form) for form in forms)
