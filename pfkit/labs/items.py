"""The six types of item, as declarations.

======  ===============  ====================================================================
letter  class            the student gives
======  ===============  ====================================================================
N       `Numeric`        one or several numbers
C       `Code`           a function
M       `Choice`         a letter
X       `Experiment`     a function that runs an experiment many times
P       `Prediction`     a letter, and how sure: locked before the experiment
R       `Text`           at most three sentences, marked by hand
======  ===============  ====================================================================

An item judges an answer. It knows nothing about notebooks, files or hints already given:
that is `pfkit.labs.lab`.
"""

import dis
import hashlib
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

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


@dataclass(frozen=True, kw_only=True)
class Numeric(Item):
    """N: numbers with a tolerance; the usual wrong values are named.

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
    tol: float
    unit: str = ""
    names: tuple[str, ...] = ()

    def solution(self) -> Any:
        return self.key

    def _told(self) -> tuple:
        return (self.key, self.tol)

    def _numbers(self, answer: Any) -> np.ndarray:
        x = np.asarray(answer)
        if x.dtype.kind not in "iuf" or x.shape != np.shape(self.key):
            raise ValueError
        return x.astype(float)

    def _close(self, x: Any, key: Any) -> np.ndarray:
        # a hair wider than stated, so that a value exactly on the edge is accepted
        return np.abs(np.asarray(x, dtype=float) - key) <= self.tol * (1 + 1e-9)

    def judge(self, answer: Any) -> Judgement:
        wanted = "one number" if np.ndim(self.key) == 0 else f"{np.size(self.key)} numbers"
        try:
            x = self._numbers(answer)
        except Exception:
            return Judgement((Line(f"{wanted} {self.unit}".strip(), False, "not what I got"),))
        names = self.names or tuple(f"number {i + 1}" for i in range(np.size(self.key)))
        if np.ndim(self.key) == 0:
            names = self.names or ("the number",)
        close = np.atleast_1d(self._close(x, self.key))
        lines = tuple(
            Line(f"{name} within {self.tol:g} {self.unit}".strip(), bool(ok), f"you gave {v:.6g}")
            for name, ok, v in zip(names, close, np.atleast_1d(x), strict=True)
        )
        return Judgement(lines, None if close.all() else self._recognise(x))

    def _fits(self, mistake: Misconception, evidence: Any) -> bool:
        if mistake.when is not None:
            return bool(mistake.when(evidence))
        return bool(np.all(self._close(evidence, mistake.example)))


def _letter(answer: Any) -> str:
    return answer.strip().strip("()\"'.").lower() if isinstance(answer, str) else ""


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
            letters = ", ".join(self.options)
            return Judgement((Line(f"a letter out of {letters}", False, "not what I got"),))
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
            raise ValueError(f'give a letter out of {", ".join(self.options)}, or ("a", 70)')
        sure = None if pair[1] is None or pair[1] is Ellipsis else float(pair[1])
        if sure is not None and not 0 <= sure <= 100:
            raise ValueError("how sure you are is a number from 0 to 100 per cent")
        return _letter(pair[0]), sure

    def judge(self, answer: Any) -> Judgement:
        try:
            given, _ = self.parse(answer)
        except (ValueError, TypeError) as error:
            return Judgement((Line("a prediction", False, str(error)),))
        return Judgement((Line(f"({given}) {self.options[given]}", True),), status="predicted")


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
            return Judgement((Line("a text in quotation marks", False, "not what I got"),))
        sentences = [s for s in re.split(r"[.!?]+(?:\s|$)", answer) if s.strip()]
        lines = (
            Line("at least 8 words", len(answer.split()) >= 8),
            Line("at most 3 sentences", len(sentences) <= 3, f"I count {len(sentences)}"),
        )
        return Judgement(lines, status="recorded" if all(x.ok for x in lines) else "")


@dataclass(frozen=True, kw_only=True)
class Code(Item):
    """C: a function that must have the stated properties on random inputs.

    Parameters
    ----------
    reference : callable
        The right answer; lets the notebook carry on.
    properties : tuple of Property
    fingerprint : callable, optional
        ``fingerprint(f)`` -> numbers that tell wrong implementations apart. A function whose
        fingerprint equals that of a misconception's example "behaves like" it.
    atol : float
        Accepted difference between fingerprints.
    """

    letter: ClassVar[str] = "C"
    reference: Any = None
    properties: tuple[Property, ...] = ()
    fingerprint: Callable[[Any], Any] | None = None
    atol: float = 1e-9
    _prints: dict = field(default_factory=dict, repr=False, compare=False)

    def solution(self) -> Any:
        return self.reference

    def _told(self) -> tuple:
        return tuple(p.says for p in self.properties)

    def judge(self, answer: Any) -> Judgement:
        if not callable(answer):
            detail = f"I got a value of type {type(answer).__name__}"
            return Judgement((Line("a function", False, detail),))
        lines = tuple(tested(p, answer) for p in self.properties)
        if all(x.ok for x in lines):
            return Judgement(lines)
        return Judgement(lines, self._recognise(answer))

    def _fits(self, mistake: Misconception, evidence: Any) -> bool:
        if mistake.when is not None:
            return bool(mistake.when(evidence))
        if self.fingerprint is None:
            return False
        if mistake.name not in self._prints:
            self._prints[mistake.name] = np.asarray(self.fingerprint(mistake.example), dtype=float)
        theirs = np.asarray(self.fingerprint(evidence), dtype=float)
        return theirs.shape == self._prints[mistake.name].shape and bool(
            np.allclose(theirs, self._prints[mistake.name], rtol=0, atol=self.atol, equal_nan=True)
        )


def each_run(f: Callable, rng: np.random.Generator, runs: int) -> list:
    """Call ``f(rng)`` once per run, each with a stream of its own."""
    return [f(child) for child in rng.spawn(runs)]


@dataclass(frozen=True, kw_only=True)
class Experiment(Item):
    """X: a claim about many runs of the student's experiment, tested with a declared error rate.

    Parameters
    ----------
    claim : str
        What must be seen, such as "the share falls with the number of particles".
    test : str
        Which statistic decides, and its threshold.
    runs : int
        How many runs a check makes.
    measure : callable
        ``measure(f, rng, runs)`` -> outcomes of the runs, an array whose first axis is the runs.
        By default ``f(rng)`` is called once per run.
    properties : tuple of Property
        Decisions on the outcomes.
    false_fail : float
        Declared bound on the probability that a right experiment fails (at most 1e-3).
    margin : str
        Distance of the truth from the threshold, in standard errors.
    """

    letter: ClassVar[str] = "X"
    claim: str
    test: str
    runs: int
    measure: Callable[[Any, np.random.Generator, int], Any] = each_run
    reference: Any = None
    properties: tuple[Property, ...] = ()
    false_fail: float = 1e-4
    margin: str = ""
    seed: int = 2024

    def solution(self) -> Any:
        return self.reference

    def _told(self) -> tuple:
        return (self.claim, self.test, self.runs)

    def outcomes(self, answer: Any, runs: int, seed: int | None = None) -> np.ndarray:
        """Measured outcomes, shape (runs, ...); raises ValueError if they make no sense."""
        rng = np.random.default_rng(self.seed if seed is None else seed)
        found = np.asarray(self.measure(answer, rng, runs), dtype=float)
        if found.shape[:1] != (runs,):
            raise ValueError(f"expected results of {runs} runs, got shape {found.shape}")
        if not np.isfinite(found).all():
            raise ValueError("some results are nan or infinite")
        return found

    def judge(self, answer: Any) -> Judgement:
        if not callable(answer):
            detail = f"I got a value of type {type(answer).__name__}"
            return Judgement((Line("a function", False, detail),))
        try:
            found = self.outcomes(answer, self.runs)
        except (Exception, SystemExit) as error:
            return Judgement((Line("the experiment runs", False, describe(error)),))
        return self.decide(found)

    def decide(self, found: np.ndarray) -> Judgement:
        """The decision alone, for given outcomes: this is what the replay tests repeat."""
        lines = tuple(tested(p, found) for p in self.properties)
        ok = all(x.ok for x in lines)
        return Judgement(lines, None if ok else self._recognise(found))


def tested(prop: Property, evidence: Any) -> Line:
    """Evaluate one property; an exception is a failure that says what was raised."""
    try:
        found = prop.holds(evidence)
    except (Exception, SystemExit) as error:
        return Line(prop.says, False, describe(error))
    if isinstance(found, str):
        return Line(prop.says, False, found)
    return Line(prop.says, bool(found))
