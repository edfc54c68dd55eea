"""`Lab`: the verbs a student uses, and the memory of what was answered.

    from pfkit.labs import lab3 as lab

    lab.check("q4b", systematic)              # a verdict; never raises
    systematic = lab.use("q4b", systematic)   # your answer if it passes, else the reference
    lab.predict("q7a", ("b", 70))             # locked: (b), 70 % sure; not without the 70
    lab.solution("q4b")                       # worked code, once it passed or after three hints
    lab.tick("q5c", 1, 3)                     # what of the rubric holds of your text
    lab.student("jo17")                       # numbers and data of your own; lab.ask("q4a")
    lab.summary()                             # points, and your calibration
    lab.save(), lab.load()

With the environment variable ``PFKIT_LABS_STRICT=1`` a check that is not passed raises
`LabError`: the tests use it to prove that solutions pass and that stubs do not.
"""

import hashlib
import inspect
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from pfkit.labs import controls, executed, progress
from pfkit.labs.guard import guarded
from pfkit.labs.items import Experiment, Item, Judgement, Prediction, Text, is_unanswered
from pfkit.labs.summary import Summary, Tally
from pfkit.labs.verdict import Line, Verdict

FINE = ("passed", "recorded", "predicted")
HINTS = 3  # after which the solution may be seen


class LabError(AssertionError):
    """Raised by `Lab.check` under the strict switch only."""


@dataclass(eq=False)
class Question:
    """A question of the lab, such as P3; the items bound after it belong to it.

    Parameters
    ----------
    title : str
    id : str
        By default the name that its module binds it to, in small letters.
    """

    title: str
    id: str = ""
    items: list[Item] = field(default_factory=list)


class Lab:
    """Questions, and one student's answers to them.

    Parameters
    ----------
    name : str
        ``"lab3"``; also names the progress file.
    title : str
    questions : sequence of Question
        `Lab.of` collects them from modules.
    """

    def __init__(self, name: str, title: str, questions: Sequence[Question]) -> None:
        self.name, self.title, self.questions = name, title, tuple(questions)
        self.items: dict[str, Item] = {}
        for item in (i for q in self.questions for i in q.items):
            if item.id in self.items:
                raise ValueError(f"{name} has two items called {item.id!r}: rename one")
            if item.after and item.after not in self.items.values():
                raise ValueError(f"{item.id!r} comes after a prediction that stands below it")
            self.items[item.id] = item
        self.asks_how_sure = True  # the grader takes a bare letter, as older labs did
        self._executed = executed.watch()
        self.forget()

    @classmethod
    def of(cls, name: str, title: str, *modules: ModuleType) -> "Lab":
        """Collect the questions and items that modules bind, in the order in which they do.

        Parameters
        ----------
        name : str
            ``__name__`` of the module that publishes the lab; its last part names the lab.
        title : str
        *modules
            Where the questions stand; by default the module called ``name``.
        """
        questions: list[Question] = []
        for module in modules or (sys.modules[name],):
            for bound, value in list(vars(module).items()):
                if isinstance(value, Question) and value not in questions:
                    value.id = value.id or bound.lower()
                    questions.append(value)
                elif isinstance(value, Item) and not any(value in q.items for q in questions):
                    value.id = value.id or bound
                    if not questions:
                        raise ValueError(f"{value.id!r} stands above the first question: add one")
                    questions[-1].items.append(value)
        return cls(name.rpartition(".")[2], title, questions)

    def forget(self) -> None:
        """Start afresh, as a new student in the world that is printed."""
        self.verdicts: dict[str, Verdict] = {}
        self.answers: dict[str, dict[str, Any]] = {}
        self.predictions: dict[str, dict[str, Any]] = {}
        self.ticks: dict[str, list[int]] = {}
        self._rungs: dict[tuple[str, str], int] = {}
        self.who = self.term = ""
        self.items = {item.id: item.origin or item for item in self.items.values()}

    VERBS = (
        "check", "use", "predict", "answer", "ask", "tick", "solution", "student", "summary",
        "save", "load",
    )  # fmt: skip

    def verb(self, name: str) -> Callable[..., Any]:
        """The ``__getattr__`` of a module of questions: ``lab.check`` is `Lab.check`."""
        if name not in self.VERBS:
            raise AttributeError(f"{self.name} has no {name!r}, only {', '.join(self.VERBS)}")
        return getattr(self, name)

    # -- a world of one's own ----------------------------------------------------------------

    def student(self, who: str, term: str = "") -> str:
        """Ask this student's own numbers and data from now on.

        Said again of the same student it changes nothing, so that what was locked stays locked.

        Parameters
        ----------
        who : str
            An id, such as the one of the university. The same id gives the same questions; ""
            gives those that are printed.
        term : str
            Such as ``"2027-spring"``: makes the questions of another term differ.
        """
        who, term = str(who).strip(), str(term).strip()
        if (who, term) != (self.who, self.term):
            self._enter(who, term)
        if not self.who:
            return f"{self.title}: the questions as printed."
        return f'{self.title}: the questions of {self.who}. lab.ask("...") shows one.'

    def _enter(self, who: str, term: str) -> None:
        self.forget()
        self.who, self.term = who, term
        for name, item in self.items.items() if who else ():
            text = "/".join((self.term, self.who.casefold(), self.name, name))
            seed = int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big")
            self.items[name] = item.personal(np.random.default_rng(seed))

    def ask(self, item_id: str) -> None:
        """Print a question with the numbers of the student's own world."""
        item = self.items.get(item_id) if isinstance(item_id, str) else None
        print(f"{item_id}: {item.asked()}" if item else self._unknown(item_id))

    # -- answering ---------------------------------------------------------------------------

    def check(self, item_id: str, answer: Any = ...) -> Verdict:
        """Judge an answer. Never raises, unless the strict switch is on.

        Parameters
        ----------
        item_id : str
            Such as ``"q4b"``.
        answer : object
            A function, number, letter or text, as the question asks.
        """
        item = self.items.get(item_id) if isinstance(item_id, str) else None
        if item is None:
            verdict = self._unknown(item_id)
        elif isinstance(item, Prediction):
            verdict = self._predict(item, answer)
        else:
            verdict = self._check(item, answer)
        if verdict.status == "unanswered" and item is not None:
            controls.offer(self, item)
        if os.environ.get("PFKIT_LABS_STRICT") == "1" and verdict.status not in FINE:
            raise LabError(str(verdict))
        return verdict

    answer = check  # reads better for a letter, a number or a text

    def predict(self, item_id: str, answer: Any = ...) -> Verdict:
        """Lock a prediction, ``("a", 70)``: the letter, and how sure in per cent.

        A letter alone is not locked, since a lock stays. Files and notebooks that hold one from
        before still load and are graded.
        """
        return self.check(item_id, answer)

    def use(self, item_id: str, answer: Any = ...) -> Any:
        """Your answer if it passes, otherwise the reference, so that the notebook carries on."""
        item = self.items.get(item_id) if isinstance(item_id, str) else None
        if item is None:
            print(self._unknown(item_id))
            return answer
        if self._judge(item, answer)[1] in FINE:
            print(f"{item_id}: carrying on with your answer")
            return answer
        print(f"{item_id}: carrying on with the reference")
        return item.solution()

    def _unknown(self, item_id: Any) -> Verdict:
        names = ", ".join(self.items)
        given = repr(item_id)[:40] if isinstance(item_id, str) else type(item_id).__name__
        return Verdict("?", "unknown", message=f"{self.name} has no item {given}, only {names}")

    def tick(self, item_id: str, *lines: int) -> None:
        """Note which lines of a text's rubric hold of your answer; kept beside the teacher's.

        Parameters
        ----------
        item_id : str
        *lines : int
            Numbers of the lines, from 1; none takes all ticks away.
        """
        item = self.items.get(item_id) if isinstance(item_id, str) else None
        if not isinstance(item, Text):
            print(f"{item_id} is no text with a rubric")
            return
        good = sorted({k for k in lines if k in range(1, len(item.rubric) + 1)})
        self.ticks[item_id] = good
        print(f"{item_id}: ticked {', '.join(map(str, good)) or 'none'} of {len(item.rubric)}")

    def solution(self, item_id: str) -> None:
        """Print the worked answer, once yours passed or after the last hint."""
        item = self.items.get(item_id) if isinstance(item_id, str) else None
        if item is None:
            print(self._unknown(item_id))
        elif self._may_see(item):
            print(item.worked())
        else:
            print(f"{item_id}: the solution is shown once yours passed, or after three hints")

    def _may_see(self, item: Item) -> bool:
        verdict = self.verdicts.get(item.id)
        shown = sum(n for (name, _), n in self._rungs.items() if name == item.id)
        return (verdict is not None and verdict.status in FINE) or shown >= HINTS

    def _judge(self, item: Item, answer: Any) -> tuple[Judgement, str]:
        """Judgement and status, safe against whatever the answer does."""
        if told := self._executed.outdated(item.id):
            return _not_judged(told), "wrong"

        def judge() -> Judgement | None:
            return None if is_unanswered(answer) else item.judge(answer)

        ran = guarded(judge)
        if ran.error:
            return _not_judged(ran.error), "wrong"
        if ran.value is None:
            return Judgement(()), "unanswered"
        full, some = ran.value.fraction == 1, ran.value.fraction > 0
        return ran.value, ran.value.status or ("passed" if full else "partial" if some else "wrong")

    def _check(self, item: Item, answer: Any) -> Verdict:
        judged, status = self._judge(item, answer)
        if status == "unanswered":
            return self._keep(Verdict(item.id, status, 0.0, item.points, "no answer yet"))
        if item.after and item.after.id not in self.predictions:
            told = f'predict first: lab.predict("{item.after.id}", ...)'
            return self._keep(Verdict(item.id, "locked", 0.0, item.points, told))
        self.answers[item.id] = {"source": _source(answer), "version": item.version}
        by_hand = isinstance(item, Text)
        verdict = Verdict(
            item.id,
            status,
            0.0 if by_hand else item.points * item.earned(judged),
            item.points,
            "kept for marking by hand"
            if status == "recorded"
            else self._own_question(item, status),
            judged.lines,
            self._hint(item, judged, status),
            judged.misconception.name if judged.misconception else "",
        )
        return self._keep(verdict)

    def _own_question(self, item: Item, status: str) -> str:
        """The question with the student's numbers, which differ from those in print."""
        personal = item.origin is not None and item.title != item.origin.title
        return f"your question: {item.title}" if personal and status not in FINE else ""

    def _keep(self, verdict: Verdict) -> Verdict:
        self.verdicts[verdict.item] = verdict
        return verdict

    def _hint(self, item: Item, judged: Judgement, status: str) -> str:
        """One rung of one ladder; the next check of the same mistake shows the next rung."""
        if status in FINE or judged.feedback:
            return judged.feedback
        mistake = judged.misconception
        ladder = mistake.hints if mistake else item.hints
        if not any(ladder):
            return ""
        key = (item.id, mistake.name if mistake else "")
        rung = min(self._rungs.get(key, 0), len(ladder) - 1)
        self._rungs[key] = rung + 1
        unknown = f"I do not recognise this mistake. {judged.example}".rstrip()
        named = f"Your answer {mistake.words}." if mistake else unknown
        return f"{named} Hint {rung + 1} of {len(ladder)}: {ladder[rung]}"

    def _predict(self, item: Prediction, answer: Any) -> Verdict:
        judged, status = self._judge(item, answer)
        locked = self.predictions.get(item.id)
        if status != "predicted" and not locked:
            told = "no prediction yet" if status == "unanswered" else ""
            return self._keep(Verdict(item.id, status, 0.0, item.points, told, judged.lines))
        note = "locked; now run the experiment"
        if locked is None:
            choice, sure = item.parse(answer)
            if sure is None and self.asks_how_sure:
                line = Line("how sure you are, too", False, f'write ("{choice}", 70) for 70 %')
                return self._keep(Verdict(item.id, "wrong", 0.0, item.points, "", (line,)))
            locked = {"choice": choice, "sure": sure, "version": item.version}
            self.predictions[item.id] = locked
            self.answers[item.id] = {"source": _source(answer), "version": item.version}
        elif status == "predicted" and item.parse(answer)[0] != locked["choice"]:
            note = f"it stays ({locked['choice']}): a prediction is locked once made"
        how = "" if locked["sure"] is None else f", {locked['sure']:.0f} % sure"
        told = f"({locked['choice']}){how}; {note}"
        return self._keep(Verdict(item.id, "predicted", item.points, item.points, told))

    # -- looking back ------------------------------------------------------------------------

    def report(self) -> dict[str, dict[str, Any]]:
        """Status, score and detail of every item, ready for JSON: what the grader reads."""
        found = {}
        for item in self.items.values():
            v = self.verdicts.get(item.id) or Verdict(item.id, "unanswered", 0.0, item.points)
            found[item.id] = {
                "letter": item.letter,
                "status": v.status,
                "score": v.score,
                "max": item.points,
                "misconception": v.misconception,
                "choice": self.predictions.get(item.id, {}).get("choice", ""),
                "detail": "; ".join(x.says for x in v.lines if not x.ok),
                "ticks": self.ticks.get(item.id, []),
                "version": item.version,
            }
        return found

    def guesses(self) -> list[tuple[str, float | None, bool]]:
        """Predictions whose experiment was checked: (item, sure, right?)."""
        tried = {
            i.after.id
            for i in self.items.values()
            if i.after
            and isinstance(i, Experiment)
            and i.id in self.verdicts
            and self.verdicts[i.id].status in ("passed", "partial", "wrong")
        }
        return [
            (name, kept["sure"], kept["choice"] == item.key)
            for name, kept in self.predictions.items()
            if name in tried and isinstance(item := self.items[name], Prediction)
        ]

    def summary(self) -> Summary:
        """Points per question, and how well your sureness matched what happened."""
        report = self.report()
        rows = [
            Tally(f"{q.id.upper()} {q.title}", [report[i.id] for i in q.items])
            for q in self.questions
        ]
        return Summary(self.title, rows, self.guesses())

    # -- keeping -----------------------------------------------------------------------------

    def save(self, path: str | Path | None = None) -> str:
        """Write answers and predictions to ``<lab>_answers.json`` (or ``path``)."""
        file = Path(path or f"{self.name}_answers.json")
        if not self.answers:
            return "There is nothing to save yet."
        note = ""
        if file.exists():
            old, told = progress.read(file, self.name)
            note = "" if old is not None else f" {told}"
        kept: dict[str, Any] = {"answers": self.answers, "predictions": self.predictions}
        if self.ticks:
            kept["ticks"] = self.ticks
        if self.who:
            kept["student"] = {"who": self.who, "term": self.term}
        progress.write(file, progress.empty(self.name) | kept)
        return f"Saved {len(self.answers)} answers to {file.name}.{note}"

    def load(self, path: str | Path | None = None) -> str:
        """Read them back. A file that cannot be read is set aside and named.

        With it comes back the student whose questions were answered, unless one was named before.
        """
        data, told = progress.read(Path(path or progress.file_of(self.name)), self.name)
        if data and "student" in data and not self.who:
            self.student(**data["student"])
        for name, kept in (data or {}).get("answers", {}).items():
            if name in self.items:
                self.answers.setdefault(name, kept)
        for name, kept in (data or {}).get("ticks", {}).items():
            if isinstance(self.items.get(name), Text):
                self.ticks.setdefault(name, kept)
        for name, kept in (data or {}).get("predictions", {}).items():
            item = self.items.get(name)
            if isinstance(item, Prediction) and kept["choice"] in item.options:
                self.predictions.setdefault(name, kept)
        return told


def _not_judged(why: str) -> Judgement:
    line = Line("your answer can be run", False, why)
    return Judgement((line,), None, "Mend this first: nothing else was judged.")


def _source(answer: Any, limit: int = 20_000) -> str:
    """The text of an answer: a function's source if Python can find it, else its repr."""

    def find() -> str:
        if inspect.isfunction(answer):
            return inspect.getsource(answer)
        return repr(answer)

    ran = guarded(find, seconds=2.0)
    return (ran.value if isinstance(ran.value, str) else f"<{type(answer).__name__}>")[:limit]
