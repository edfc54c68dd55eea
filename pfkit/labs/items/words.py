"""M, P and R: letters and sentences."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

from pfkit.labs.items.base import Item, Judgement
from pfkit.labs.verdict import Line


def _letter(answer: Any) -> str:
    """``"a"`` of a, A, (a), a), "a) with the text of the option"; "" for anything else."""
    found = re.match(r"\s*\(?([A-Za-z])(?:[).:]|\s*$)", answer) if isinstance(answer, str) else None
    return found.group(1).lower() if found else ""


@dataclass(frozen=True, kw_only=True)
class Choice(Item):
    """M: one letter of several; each distractor has one sentence of feedback."""

    letter: ClassVar[str] = "M"
    options: Mapping[str, str]
    key: str
    feedback: Mapping[str, str]

    def solution(self) -> Any:
        return self.key

    def _told(self) -> tuple:
        return (tuple(self.options.items()), self.key)

    def judge(self, answer: Any) -> Judgement:
        given = _letter(answer)
        if given not in self.options:
            line = Line(f"a letter out of {', '.join(self.options)}", False, "I got something else")
            return Judgement((line,), None, 'Write it in quotation marks, such as "a".')
        right = given == self.key
        line = Line(f"({given}) {self.options[given]}", right)
        return Judgement((line,), None, self.feedback.get(given, ""))


@dataclass(frozen=True, kw_only=True)
class Prediction(Item):
    """P: what will the experiment show? Locked when given; earns its points by being made."""

    letter: ClassVar[str] = "P"
    options: Mapping[str, str]
    key: str

    def solution(self) -> Any:
        return (self.key, 75)

    def _told(self) -> tuple:
        return (tuple(self.options.items()), self.key)

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


@dataclass(frozen=True, kw_only=True)
class Text(Item):
    """R: at most three sentences, kept for marking by hand against a rubric."""

    letter: ClassVar[str] = "R"
    rubric: tuple[str, ...]
    model: str  # a model answer

    def solution(self) -> Any:
        return self.model

    def _told(self) -> tuple:
        return self.rubric

    def judge(self, answer: Any) -> Judgement:
        if not isinstance(answer, str):
            return Judgement((Line("a text in quotation marks", False, "I got something else"),))
        sentences = [s for s in re.split(r"[.!?]+(?:\s|$)", answer) if s.strip()]
        lines = (
            Line("at least 8 words", len(answer.split()) >= 8),
            Line("at most 3 sentences", len(sentences) <= 3, f"I count {len(sentences)}"),
        )
        return Judgement(lines, status="recorded" if all(x.ok for x in lines) else "")
