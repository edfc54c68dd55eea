"""M, P and R: letters and sentences."""

import re
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, ClassVar

from pfkit.labs.items.base import Item, Judgement, Ladder
from pfkit.labs.verdict import Line


def _letter(answer: Any) -> str:
    """``"a"`` of a, A, (a), a), "a) with the text of the option"; "" for anything else."""
    found = re.match(r"\s*\(?([A-Za-z])(?:[).:]|\s*$)", answer) if isinstance(answer, str) else None
    return found.group(1).lower() if found else ""


FEWEST_WORDS = 5


@dataclass(eq=False)
class Options(Item):
    """What M and P share: options, a line each, the right one with a star at its letter.

    An indented line that starts with ``=`` is the feedback on the option above it.
    """

    options: dict[str, str] = field(init=False, default_factory=dict)
    feedback: dict[str, str] = field(init=False, default_factory=dict)
    key: str = field(init=False, default="")

    def read(self, lines: Ladder) -> None:
        for line in lines:
            option = re.fullmatch(r"([a-z])(\*?) +(.*?)(?:\n= (.*))?", line, re.DOTALL)
            if option is None or option.group(1) in self.options:
                raise ValueError(f"{self.title!r}: {line!r} is no new option such as 'a  its text'")
            letter, star, text, feedback = option.groups()
            self.options[letter] = text
            if feedback:
                self.feedback[letter] = feedback
            if star:
                self.key = letter
        if not self.key:
            raise ValueError(f"{self.title!r}: mark the right option with a star, 'b* its text'")

    def _identity(self) -> tuple:
        return (tuple(self.options.items()), self.key)

    def asked(self) -> str:
        return "\n".join([self.title, *(f"  ({k}) {text}" for k, text in self.options.items())])


@dataclass(eq=False)
class Choice(Options):
    """M: one letter of several; each option has one sentence of feedback.

    what = Choice('''What is a particle?
        a  A measurement
           = Measurements score particles.
        b* A hypothesis with a weight
           = Yes: one guess at the state.''')
    """

    letter: ClassVar[str] = "M"

    def solution(self) -> Any:
        return self.key

    def judge(self, answer: Any) -> Judgement:
        given = _letter(answer)
        if given not in self.options:
            line = Line(f"a letter out of {', '.join(self.options)}", False, "I got something else")
            return Judgement((line,), None, 'Write it in quotation marks, such as "a".')
        right = given == self.key
        line = Line(f"({given}) {self.options[given]}", right)
        return Judgement((line,), None, self.feedback.get(given, ""))


@dataclass(eq=False)
class Prediction(Options):
    """P: what will the experiment show? Locked when given; earns its points by being made."""

    letter: ClassVar[str] = "P"

    def solution(self) -> Any:
        return (self.key, 75)

    def parse(self, answer: Any) -> tuple[str, float | None]:
        """``"a"`` or ``("a", 70)`` -> letter and sureness in per cent; raises ValueError."""
        pair = answer if isinstance(answer, tuple | list) else (answer, None)
        if len(pair) != 2 or _letter(pair[0]) not in self.options:
            letters = ", ".join(self.options)
            raise ValueError(f'give a letter out of {letters}, and how sure: ("a", 70)')
        sure = None if pair[1] is None or pair[1] is Ellipsis else _per_cent(pair[1])
        return _letter(pair[0]), sure

    def judge(self, answer: Any) -> Judgement:
        try:
            given, _ = self.parse(answer)
        except ValueError as error:
            return Judgement((Line("a prediction", False, str(error)),))
        return Judgement((Line(f"({given}) {self.options[given]}", True),), status="predicted")


def _per_cent(sure: Any) -> float:
    """``80``, ``"80"`` or ``"80 %"``; a share such as .8 is refused, since a prediction stays."""
    wanted = "how sure you are is a number from 0 to 100 per cent, such as 70"
    try:
        value = float(sure.rstrip(" %") if isinstance(sure, str) else sure)
    except (ValueError, TypeError):
        raise ValueError(wanted) from None
    if 0 < value <= 1:
        raise ValueError(f"{wanted}, not .7")
    if not 0 <= value <= 100:
        raise ValueError(wanted)
    return value


@dataclass(eq=False)
class Text(Item):
    """R: at most three sentences, kept for marking by hand.

    The lines under its title are the rubric; ``model`` is a model answer.
    """

    letter: ClassVar[str] = "R"
    _: KW_ONLY
    model: str

    def read(self, lines: Ladder) -> None:
        self.rubric = lines

    def solution(self) -> Any:
        return self.model

    def _identity(self) -> tuple:
        return self.rubric

    def judge(self, answer: Any) -> Judgement:
        if not isinstance(answer, str):
            return Judgement((Line("a text in quotation marks", False, "I got something else"),))
        sentences = [s for s in re.split(r"[.!?]+(?:\s|$)", answer) if s.strip()]
        words = {w.lower() for w in re.findall(r"[^\W\d_]{2,}", answer)}
        lines = (
            Line(f"at least {FEWEST_WORDS} different words", len(words) >= FEWEST_WORDS),
            Line("at most 3 sentences", len(sentences) <= 3, f"I count {len(sentences)}"),
        )
        if not all(x.ok for x in lines):
            return Judgement(lines)
        return Judgement(lines, None, self.told, status="recorded")

    @property
    def told(self) -> str:
        """Rubric and model answer, for the student to compare with once it is recorded."""
        rubric = "\n".join(f"  {k}. {line}" for k, line in enumerate(self.rubric, start=1))
        numbers = ", ".join(str(k) for k in range(1, len(self.rubric) + 1))
        return (
            f"What a good answer does:\n{rubric}\nA model answer: {self.model}\n"
            f'Tick what holds of yours, in the same cell: lab.tick("{self.id}", {numbers})'
        )
