"""What all items share: their declaration, and how a judgement is put."""

import copy
import dis
import hashlib
import inspect
import re
from collections.abc import Callable
from dataclasses import KW_ONLY, InitVar, dataclass, field
from typing import Any, ClassVar, TypeVar

import numpy as np

from pfkit.labs.guard import describe
from pfkit.labs.verdict import Line

Ladder = tuple[str, ...]
T = TypeVar("T")


def written_lines(text: str) -> Ladder:
    """The lines of a text in triple quotes; an indented line continues the one before it.

    One that starts with ``=`` continues it on a line of its own.
    """
    found: list[str] = []
    for line in inspect.cleandoc(text).splitlines():
        if line[:1].isspace() and found:
            more = line.strip()
            found[-1] += ("\n" if more.startswith("= ") else " ") + more
        elif line:
            found.append(line.rstrip())
    return tuple(found)


def name_of(function: Any) -> str:
    """``off-by-one`` of a function called ``off_by_one`` or ``_off_by_one``."""
    return getattr(function, "__name__", "").strip("_").replace("_", "-")


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
class Refused:
    """An answer that must not pass, although no misconception need recognise it.

    Parameters
    ----------
    says : str
        What is wrong with it: "a constant at the right value".
    example : object
    named : str
        The misconception it must earn; empty if none may.
    """

    says: str
    example: Any
    named: str = ""


@dataclass(frozen=True)
class Judgement:
    """Which properties hold, which misconception was recognised, and a sentence of feedback.

    ``example`` shows a mistake that was not recognised: input, what came out, what should have.
    """

    lines: tuple[Line, ...]
    misconception: Misconception | None = None
    feedback: str = ""
    status: str = ""
    example: str = ""

    @property
    def fraction(self) -> float:
        return sum(x.ok for x in self.lines) / len(self.lines) if self.lines else 0.0


@dataclass(eq=False)
class Item:
    """What all items share.

    Parameters
    ----------
    text : str
        The first line is the title. What the others are depends on the type of item: hints, the
        options of a choice, the rubric of a text.
    id : str
        By default the name that its module binds it to, see `Lab.of`.
    points : float
    after : Prediction, optional
        What must be locked before this item is checked.
    """

    letter: ClassVar[str] = ""
    text: InitVar[str]
    _: KW_ONLY
    id: str = ""
    points: float = 1.0
    after: "Item | None" = None
    title: str = field(init=False)
    hints: Ladder = field(init=False, default=())
    misconceptions: list[Misconception] = field(init=False, default_factory=list)
    refused: list[Refused] = field(init=False, default_factory=list)
    origin: "Item | None" = field(init=False, default=None)  # what a personal item was made from

    def __post_init__(self, text: str) -> None:
        self.title, *rest = written_lines(text)
        self.read(tuple(rest))

    def read(self, lines: Ladder) -> None:
        """Take the lines under the title: hints, unless a type of item has another use."""
        self.hints = lines

    def judge(self, answer: Any) -> Judgement:
        raise NotImplementedError

    def solution(self) -> Any:
        """A right answer, which also lets an unanswered notebook carry on."""
        raise NotImplementedError

    def earned(self, judged: Judgement) -> float:
        """Share of the points."""
        return judged.fraction

    def worked(self) -> str:
        """The solution as a student would write it."""
        return f"{self.id} = {self.solution()!r}"

    def asked(self) -> str:
        """The question in words, with the numbers and options of its world."""
        return self.title

    def personal(self, rng: np.random.Generator) -> "Item":
        """The same question in another world: other numbers or data."""
        new = copy.copy(self)
        new.origin = self
        new._enter_another(rng)
        return new

    def _enter_another(self, rng: np.random.Generator) -> None:
        """Take what is personal from ``rng``; nothing, unless a type of item says what."""

    # -- declaring ---------------------------------------------------------------------------

    def wrong(self, text: str, when: Callable[[Any], bool] | None = None) -> Callable[..., Any]:
        """Declare a misconception; the wrong answer follows, as a decorated function or a call.

        Parameters
        ----------
        text : str
            What the wrong answer does, to follow "Your answer", and three hints, a line each.
            A name may stand in front, ``sum-of-squares: is the sum of squares itself``; else
            the wrong function's name is taken.
        when : callable, optional
            As in `Misconception`; may also stand beside the wrong answer.
        """

        def take(example: T, when: Callable[[Any], bool] | None = when) -> T:
            says, *hints = written_lines(text)
            named = re.match(r"([a-z0-9-]+): ", says)
            name = named.group(1) if named else name_of(example)
            words = says[named.end() :] if named else says
            self.misconceptions.append(Misconception(name, words, tuple(hints), example, when))
            return example

        return take

    def refuses(self, says: str, named: str = "") -> Callable[[T], T]:
        """Declare an answer that must not pass, and which misconception it must earn, if any."""

        def take(example: T) -> T:
            self.refused.append(Refused(says, example, named))
            return example

        return take

    @property
    def version(self) -> str:
        """Changes when the question changes, so that stored answers can be told apart."""
        if self.origin is not None:
            return self.origin.version
        identity = (self.letter, self.id, self.title, *self._identity())
        return hashlib.sha256(repr(identity).encode()).hexdigest()[:8]

    def _identity(self) -> tuple:
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
        return (
            Line(prop.says, False, found)
            if isinstance(found, str)
            else Line(prop.says, bool(found))
        )
    except (Exception, SystemExit) as error:
        return Line(prop.says, False, describe(error))
