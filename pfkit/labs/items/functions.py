"""C and X: functions, run by the check."""

import ast
import contextlib
import copy
import inspect
import textwrap
from collections.abc import Callable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, ClassVar, Self

import numpy as np

from pfkit.labs import response
from pfkit.labs.guard import describe
from pfkit.labs.items.base import Item, Judgement, Misconception, Property, tested
from pfkit.labs.items.counterexample import MOST_CALLS, Call, can_be_told, shown, smallest
from pfkit.labs.verdict import Line

MOST_KEPT = 256  # outcomes of right and wrong programs that are kept for the next answer
ALIKE = 3.0  # standard errors between an answer and the wrong program that it is taken for
IN_PLACE = "It writes into its argument, so the caller's array changes, too: x = x + 1, not x += 1."


class Called:
    """A student's function, as properties see it.

    A list or tuple of numbers comes back as an array; ``wrote`` tells whether an argument was
    written into, ``calls`` what went in and came out.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        self._function, self.wrote = function, False
        self.calls: list[Call] = []

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        arrays = [(a, a.tobytes()) for a in args if isinstance(a, np.ndarray)]
        keep = len(self.calls) < MOST_CALLS and can_be_told(args, kwargs)
        went_in = copy.deepcopy((args, kwargs)) if keep else ((), {})
        try:
            found = self._function(*args, **kwargs)
        except Exception as error:
            if keep:
                self.calls.append(Call(*went_in, raised=describe(error)))
            raise
        self.wrote = self.wrote or any(a.tobytes() != was for a, was in arrays)
        if keep:
            self.calls.append(Call(*went_in, returned=copy.deepcopy(found)))
        return as_array(found)


def as_array(value: Any) -> Any:
    """Numbers in a list or tuple, or parts of one shape, as an array; all else as it is."""
    if not isinstance(value, list | tuple) or not value:
        return value
    if len({np.shape(part) for part in value}) > 1:
        return value
    found = np.asarray(value)
    return found if found.dtype.kind in "biufc" else value


def _named(name: str, value: Any) -> str:
    """``M = 20``, ``scheme = systematic``, ``film = target, circle, low noise, 12 frames``."""
    if source := getattr(value, "source", ""):  # a log
        return f"{name} = {source}, {len(value)} frames"
    return f"{name} = {getattr(value, '__name__', '') or shown(value)}"


def _not_a_function(answer: Any) -> Judgement:
    line = Line("a function", False, f"I got a value of type {type(answer).__name__}")
    return Judgement((line,), None, "Give the function itself, by its name and without brackets.")


@dataclass(eq=False)
class Function(Item):
    """What C and X share: a reference that is decorated with the item, and properties.

    An item called like a function runs its reference.
    """

    reference: Any = field(init=False, default=None)
    properties: list[Property] = field(init=False, default_factory=list)

    def of(self, reference: Callable[..., Any]) -> Self:
        """Take the right answer; what `code` and `experiment` decorate ends here."""
        self.reference = reference
        return self

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return self.reference(*args, **kwargs)

    def holds(self, says: str, predicate: Callable[[Any], Any] | None = None) -> Any:
        """Declare a property, as a decorator or with its predicate; see `Property`."""

        def take(function: Callable[[Any], Any]) -> Callable[[Any], Any]:
            self.properties.append(Property(says, function))
            return function

        return take if predicate is None else take(predicate)

    def solution(self) -> Any:
        return self.reference

    def worked(self) -> str:
        """The reference's source, without what declares the item, after the helpers it calls."""
        source = textwrap.dedent(inspect.getsource(self.reference))
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.FunctionDef):
                lines = source.splitlines()[node.lineno - 1 : node.end_lineno]
                source = textwrap.dedent("\n".join(lines))
                break
            if isinstance(node, ast.Lambda):
                source = f"{self.id} = {ast.unparse(node)}"
                break
        return "\n\n\n".join([*_helpers(self.reference, source), source])


def _helpers(function: Callable[..., Any], source: str) -> list[str]:
    """The sources of its module's own helpers that some source calls, and of those they call."""
    names = {node.id for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Name)}
    found: dict[str, None] = {}  # in order, each once
    for name in sorted(name for name in names if name.startswith("_")):
        helper = getattr(function, "__globals__", {}).get(name)
        if inspect.isfunction(helper) and helper is not function:
            text = inspect.getsource(helper).rstrip()
            found |= dict.fromkeys([*_helpers(helper, text), text])
    return list(found)


@dataclass(eq=False)
class Code(Function):
    """C: a function that must have the stated properties on random inputs.

        @code('''Normalise weights
            What must they sum to?
            Divide by something.
            w / w.sum()''', fingerprint=lambda f: f(np.array([1.0, 2.0, 5.0])))
        def normalise(w):
            return w / w.sum()

        normalise.holds("they sum to one", lambda f: abs(f(np.ones(4)).sum() - 1) < 1e-9)

        @normalise.wrong('''divides by the largest weight
            ...three hints...''')
        def by_max(w):
            return w / w.max()

    Parameters
    ----------
    fingerprint : callable, optional
        ``fingerprint(f)`` -> numbers that tell wrong implementations apart. A function whose
        fingerprint equals that of a misconception's example "behaves like" it.
    atol : float
        Accepted difference between fingerprints.
    """

    letter: ClassVar[str] = "C"
    _: KW_ONLY
    fingerprint: Callable[[Any], Any] | None = None
    atol: float = 1e-9
    _prints: dict[str, np.ndarray] = field(init=False, default_factory=dict, repr=False)

    def _identity(self) -> tuple:
        return tuple(p.says for p in self.properties)

    def judge(self, answer: Any) -> Judgement:
        if not callable(answer):
            return _not_a_function(answer)
        called = Called(answer)
        lines = tuple(tested(p, called) for p in self.properties)
        right = all(x.ok for x in lines)
        mistake = None if right else self._recognise(called)
        if called.wrote:
            lines += (Line("leaves its arguments as they were", False),)
        return Judgement(
            lines,
            mistake,
            IN_PLACE if called.wrote and not mistake else "",
            example="" if right or mistake else smallest(called.calls, self.reference),
        )

    def _fits(self, mistake: Misconception, evidence: Any) -> bool:
        if mistake.when is not None:
            return bool(mistake.when(evidence))
        if self.fingerprint is None:
            return False
        if mistake.name not in self._prints:
            self._prints[mistake.name] = self._print(Called(mistake.example))
        theirs = self._print(evidence)
        return theirs.shape == self._prints[mistake.name].shape and bool(
            np.allclose(theirs, self._prints[mistake.name], rtol=0, atol=self.atol, equal_nan=True)
        )

    def _print(self, function: Called) -> np.ndarray:
        assert self.fingerprint is not None
        return np.asarray(self.fingerprint(function), dtype=float)


def each_run(f: Callable, rng: np.random.Generator, runs: int) -> list:
    """Call ``f(rng)`` once per run, each with a stream of its own."""
    return [f(child) for child in rng.spawn(runs)]


@dataclass(eq=False)
class Experiment(Function):
    """X: a claim about many runs of the student's experiment, tested with a declared error rate.

    Parameters
    ----------
    claim : str
        What must be seen, such as "the share falls with the number of particles".
    test : str
        Which statistic decides, and its threshold.
    runs : int
        How many runs a check makes.
    settings : callable, optional
        ``settings(rng)`` -> the settings of one check, a list of tuples: arguments that the
        student did not choose. ``f(*setting, rng)`` is called ``runs`` times for each, and so is
        the reference, with the same random numbers; outcomes have shape (runs, settings, 2).
        The answer must *respond* as the reference does, see `pfkit.labs.response`.
    together : bool
        With ``settings``: ``f(*setting, rng, runs)`` makes all runs of a setting side by side and
        returns (runs,) numbers, or rows of them; outcomes get a third axis for the rows.
    rows : tuple of int, optional
        Which of many rows are compared; all of them by default.
    measure : callable
        ``measure(f, rng, runs)`` -> outcomes of the runs, an array whose first axis is the runs.
        By default ``f(rng)`` is called once per run. Not together with ``settings``.
    false_fail : float
        Declared bound on the probability that a right experiment fails (at most 1e-3).
    margin : str
        Distance of the truth from the threshold, in standard errors.
    pool : int
        How many independent runs `pfkit.labs.replay` draws its decisions from: fewer where a run
        is slow, and then the margin carries the claim.

    A misconception without ``when`` is recognised by its response: the wrong program runs at the
    same settings, and the answer has the same means and scatter. Of several the nearest counts.
    """

    letter: ClassVar[str] = "X"
    _: KW_ONLY
    claim: str
    test: str
    runs: int
    settings: Callable[[np.random.Generator], Sequence[tuple]] | None = None
    together: bool = False
    rows: tuple[int, ...] = ()
    measure: Callable[[Any, np.random.Generator, int], Any] = each_run
    false_fail: float = 1e-4
    margin: str = ""
    pool: int = 3_000
    seed: int = 2024
    _kept: dict[tuple, np.ndarray] = field(init=False, default_factory=dict, repr=False)

    def earned(self, judged: Judgement) -> float:
        """All or nothing: a constant may have one of several properties."""
        return float(judged.fraction == 1)

    def _enter_another(self, rng: np.random.Generator) -> None:
        self.seed = int(rng.integers(2**31))  # other random numbers, and so other settings

    def _identity(self) -> tuple:
        return (self.claim, self.test, self.runs)

    def outcomes(
        self, answer: Any, runs: int, seed: int | None = None, world: int | None = None
    ) -> np.ndarray:
        """Measured outcomes, shape (runs, ...); raises ValueError if they make no sense.

        Parameters
        ----------
        answer : callable
        runs : int
        seed : int, optional
            Of the random numbers.
        world : int, optional
            Seed of the settings, by default that of the check.
        """
        seed = self.seed if seed is None else seed
        found = self._response(answer, runs, seed, world)
        if self.settings is not None:
            right = self._kept_response(self.reference, runs, seed, world)
            if found.shape != right.shape:
                wanted, got = ((*x.shape[2:], runs) for x in (right, found))
                raise ValueError(f"expected numbers of shape {wanted}, got shape {got}")
            found = self._compared(np.stack([found, right], axis=-1))
        if found.shape[:1] != (runs,):
            raise ValueError(f"expected results of {runs} runs, got shape {found.shape}")
        if not np.isfinite(found).all():
            raise ValueError("some results are nan or infinite")
        return found

    def met(self, world: int | None = None) -> Sequence[tuple]:
        """The settings of the check, or those of another world."""
        assert self.settings is not None
        return self.settings(np.random.default_rng(self.seed if world is None else world))

    def _response(self, answer: Any, runs: int, seed: int, world: int | None) -> np.ndarray:
        """What an answer makes of the settings, or of what ``measure`` hands to it."""
        if self.settings is None:
            return np.asarray(self.measure(answer, np.random.default_rng(seed), runs), dtype=float)
        return response.each_setting(answer, self.met(world), seed, runs, self.together)

    def _kept_response(self, known: Any, runs: int, seed: int, world: int | None) -> np.ndarray:
        """The same of a program of ours, computed once for all answers compared with it."""
        key = (id(known), self.seed if world is None else world, seed, runs)
        if key not in self._kept:
            if len(self._kept) >= MOST_KEPT:
                self._kept.clear()
            self._kept[key] = self._response(known, runs, seed, world)
        return self._kept[key]

    def rivals(
        self, runs: int, seed: int | None = None, world: int | None = None
    ) -> dict[str, np.ndarray]:
        """The responses of the wrong programs that answers are compared with, by name."""
        seed, found = self.seed if seed is None else seed, {}
        for mistake in self.misconceptions:
            if mistake.when is None:
                with contextlib.suppress(Exception):  # one that raises resembles nothing
                    kept = self._kept_response(mistake.example, runs, seed, world)
                    found[mistake.name] = self._compared(kept)
        return found

    def _compared(self, x: np.ndarray) -> np.ndarray:
        return x[:, :, list(self.rows)] if self.rows else x

    def judge(self, answer: Any) -> Judgement:
        if not callable(answer):
            return _not_a_function(answer)
        try:
            found = self.outcomes(answer, self.runs)
        except (Exception, SystemExit) as error:
            line = Line("the experiment runs", False, describe(error))
            return Judgement((line,), example=self._told())
        judged = self.decide(found)
        if judged.fraction < 1:
            judged = self.decide(found, self.rivals(self.runs))
        return judged

    def decide(
        self, found: np.ndarray, rivals: Mapping[str, np.ndarray] | None = None
    ) -> Judgement:
        """The decision alone, for given outcomes: this is what the replay tests repeat."""
        lines = tuple(tested(p, found) for p in self.properties)
        if all(x.ok for x in lines):
            return Judgement(lines, None, self.declaration)
        mistake = self._recognise(found) or self._nearest(found, rivals or {})
        return Judgement(lines, mistake, example="" if mistake else self._told())

    def _nearest(self, found: np.ndarray, rivals: Mapping[str, np.ndarray]) -> Misconception | None:
        """The wrong program that answers alike; None if none does."""
        answer = found if self.settings is None else found[..., 0]
        best, least = None, np.inf
        for mistake in self.misconceptions:
            theirs = rivals.get(mistake.name)
            if theirs is None or theirs.shape != answer.shape:
                continue
            pair = np.stack([answer, theirs], axis=-1)
            apart = float(np.abs(response.distance(pair)).max())
            if apart < min(least, ALIKE) and all(
                same(pair) is True for same in (response.same_mean(ALIKE), response.same_scatter())
            ):
                best, least = mistake, apart
        return best

    def _told(self) -> str:
        """The settings in words: ``Setting 1: M = 20, w = 0.1.``"""
        if self.settings is None:
            return ""
        names = list(inspect.signature(self.reference).parameters)
        return " ".join(
            f"Setting {k}: {', '.join(map(_named, names, setting))}."
            for k, setting in enumerate(self.met(), start=1)
        )

    @property
    def declaration(self) -> str:
        """How it was tested, and how often a right answer would fail: told when it passes."""
        return (
            f"Tested over {self.runs} runs, seed {self.seed}: {self.test}. "
            f"A right answer fails with a probability below {self.false_fail:g} ({self.margin})."
        )


def code(text: str, **declared: Any) -> Callable[[Callable[..., Any]], Code]:
    """Decorate the reference of a `Code` item; the arguments are those of `Code`."""
    return Code(text, **declared).of


def experiment(text: str, **declared: Any) -> Callable[[Callable[..., Any]], Experiment]:
    """Decorate the reference of an `Experiment`; the arguments are those of `Experiment`."""
    return Experiment(text, **declared).of
