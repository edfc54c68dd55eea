"""What all items share: their declaration, and how a judgement is put."""

import dis
import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

from pfkit.labs.guard import describe
from pfkit.labs.verdict import Line

Ladder = tuple[str, str, str]


@dataclass(frozen=True)
class Property:
    """One thing that must be true of a right answer.

    ``holds(answer)`` (for an experiment: ``holds(outcomes)``) returns True, or False,
    or a string that says what was found instead.
    """

    says: str
    holds: Callable[[Any], Any]


@dataclass(frozen=True)
class Misconception:
    """A wrong idea, how to recognise it, and three hints from a nudge to nearly the answer.

    Parameters
    ----------
    name : str
        Short and unique within the item, such as ``"arithmetic-mean"``.
    words : str
        What the wrong answer does, to follow "Your answer": "averages the angles as numbers".
    hints : three str
        Shown one at a time.
    example : object
        A wrong answer that must earn this hint and no other. The tests run it.
    when : callable, optional
        ``when(answer)`` for numbers and code, ``when(outcomes)`` for experiments.
        Without it, the answer must equal the example (numbers) or behave like it (code).
    """

    name: str
    words: str
    hints: Ladder
    example: Any
    when: Callable[[Any], bool] | None = None


@dataclass(frozen=True)
class Judgement:
    """Which properties hold, which misconception was recognised, and a sentence of feedback."""

    lines: tuple[Line, ...]
    misconception: Misconception | None = None
    feedback: str = ""
    status: str = ""

    @property
    def fraction(self) -> float:
        return sum(x.ok for x in self.lines) / len(self.lines) if self.lines else 0.0


@dataclass(frozen=True, kw_only=True)
class Item:
    """What all items share."""

    letter: ClassVar[str] = ""
    id: str
    title: str
    points: float = 1.0
    hints: Ladder = ("", "", "")
    misconceptions: tuple[Misconception, ...] = ()
    after: str = ""  # the prediction that must be locked first

    def judge(self, answer: Any) -> Judgement:
        raise NotImplementedError

    def solution(self) -> Any:
        """A right answer, which also lets an unanswered notebook carry on."""
        raise NotImplementedError

    @property
    def version(self) -> str:
        """Changes when the question changes, so that stored answers can be told apart."""
        told = (self.letter, self.id, self.title, *self._told())
        return hashlib.sha256(repr(told).encode()).hexdigest()[:8]

    def _told(self) -> tuple:
        return ()

    def _recognise(self, evidence: Any) -> Misconception | None:
        """The first misconception that fits; one that cannot be evaluated does not fit."""
        for mistake in self.misconceptions:
            try:
                if self._fits(mistake, evidence):
                    return mistake
            except (Exception, SystemExit):
                continue
        return None

    def _fits(self, mistake: Misconception, evidence: Any) -> bool:
        return mistake.when is not None and bool(mistake.when(evidence))


def _is_blank(answer: Any) -> bool:
    return isinstance(answer, str) and not answer.strip(". \n")


def is_unanswered(answer: Any) -> bool:
    """Is this still the stub: ``...``, nothing, or a function whose body is only ``...``?"""
    if answer is None or answer is Ellipsis or _is_blank(answer):
        return True
    if isinstance(answer, tuple | list) and 0 < len(answer) <= 20:
        return all(is_unanswered(part) for part in answer)
    code = getattr(answer, "__code__", None)
    if code is None or not hasattr(code, "co_code"):
        return False
    steps = list(dis.get_instructions(code))
    idle = {"RESUME", "NOP", "CACHE", "POP_TOP", "LOAD_CONST", "RETURN_VALUE", "RETURN_CONST"}
    consts = [s.argval for s in steps if s.opname in ("LOAD_CONST", "RETURN_CONST")]
    return all(s.opname in idle for s in steps) and all(c in (None, Ellipsis) for c in consts)


def tested(prop: Property, evidence: Any) -> Line:
    """Evaluate one property; an exception is a failure that says what was raised."""
    try:
        found = prop.holds(evidence)
    except (Exception, SystemExit) as error:
        return Line(prop.says, False, describe(error))
    if isinstance(found, str):
        return Line(prop.says, False, found)
    return Line(prop.says, bool(found))
