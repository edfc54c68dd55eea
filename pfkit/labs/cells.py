"""A notebook's code cells, answered in the page: what stands in the cells is what is run.

The page shows an editor for each answer cell. When the reader runs one, the names that it uses must
exist: imports, a world, an earlier answer. `Cells.run` finds the cells above that bind those names,
runs those that have not run yet (or whose source has changed since), and then the cell itself. So a
reader may start with any question, and after a hang was stopped nothing is lost but time.

The namespace is laid out anew for each run, from what those cells bound and from nothing else: no
name outlives the code that defined it. A check judges its answer cell as it stands: the names it
looks at are cleared, the cell runs, and only then the check.
"""

from __future__ import annotations

import ast
import contextlib
import io
import json
import linecache
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from pfkit.labs import spaced_review
from pfkit.labs.guard import Capped, describe
from pfkit.labs.lab import Lab
from pfkit.labs.names import bound_and_used
from pfkit.labs.stand_in import Nothing, stand_in_for_figures
from pfkit.labs.verdict import Verdict

MOST_OUTPUT = 20_000  # characters of printed text that the page shows
WIDEST = 72  # characters of a line that is shown with a caret
NO_FIGURES = (
    "Figures are not drawn in this page: run the cell in Jupyter to see them. "
    "What it computes and prints is the same there."
)
UNBOUND = "The cell binds no {name}: keep the name that stood there, it is what the check looks at."
NO_MODULE = (
    "{name} is not in this page, which has NumPy, pfkit and most of Python's own modules: "
    "run the cell in Jupyter, or do without it"
)


class Cell(NamedTuple):
    """One code cell as the page sends it.

    ``owed`` are the names that an answer must bind, whatever a reader made of it: those of its
    stub. ``bound`` holds them, too, and ``used`` what the cell reads.
    """

    index: int
    kind: str
    item: str
    source: str
    owed: set[str]
    bound: set[str]
    used: set[str]

    @classmethod
    def of(cls, told: dict[str, Any]) -> Cell:
        owed = bound_and_used(told.get("stub", ""))[0]
        bound, used = bound_and_used(told["source"])
        about = (told["index"], told["kind"], told["item"], told["source"])
        return cls(*about, owed, bound | owed, used)


class Made(NamedTuple):
    """What a cell bound when it ran, and the source that did it."""

    source: str
    names: dict[str, Any]


class NobodyThere(io.TextIOBase):
    """Stands for the keyboard in a page that has none."""

    def readline(self, size: int | None = -1, /) -> str:  # type: ignore[override]
        raise EOFError("input() has nobody to ask in this page: write the value into the cell")

    read = readline  # type: ignore[assignment]


class Cells:
    """The namespace of one page."""

    def __init__(self) -> None:
        stand_in_for_figures()
        self.space: dict[str, Any] = {}
        self.made: dict[int, Made] = {}

    def needed(self, cells: dict[int, Cell], index: int) -> set[int]:
        """Cells above `index` that must run before it."""
        wanted: set[int] = set()

        def visit(i: int) -> None:
            for name in cells[i].used:
                above = [j for j in cells if j < i and name in cells[j].bound]
                if above and max(above) not in wanted:
                    wanted.add(max(above))
                    visit(max(above))

        visit(index)
        return wanted

    def run(self, cells: str, index: int) -> str:
        """Run cell `index` and what it needs; a JSON report of what it printed and returned.

        Parameters
        ----------
        cells : str
            JSON list of {"index", "source", "kind", "item", "stub"}: all code cells, with the
            answers as they stand; item is unique for cells that belong to no question, and only
            answers have a stub.
        index : int
        """
        table = {c["index"]: Cell.of(c) for c in json.loads(cells)}
        changed = [i for i, made in self.made.items() if made.source != table[i].source]
        self._forget(min(changed, default=max(table) + 1))
        cell, before = table[index], []
        judged = self._judged(table, cell)
        wanted = self.needed(table, index)
        if judged:
            wanted |= self.needed(table, judged.index) | {judged.index}
        self.space.clear()
        self.space["__name__"] = "__main__"
        for one in (table[i] for i in sorted(wanted)):
            if one.index in self.made and one is not judged:
                self.space.update(self.made[one.index].names)
                continue
            report = self._run_one(one)
            before.append(one.index)
            missing = {name for name in one.owed if name not in self.space}
            if one is judged and not report["error"] and (lost := missing & cell.used):
                report["error"] = UNBOUND.format(name=" or ".join(sorted(lost)))
            if report["error"] and (one is judged or one.kind == "code"):
                return json.dumps({**report, "before": before})
            for name in one.owed if report["error"] else missing:
                self.space[name] = ...  # another answer that fails counts as unanswered
        return json.dumps({**self._run_one(cell), "before": before})

    @staticmethod
    def _judged(table: dict[int, Cell], check: Cell) -> Cell | None:
        """The answer that a check looks at; None if the cell is no check."""
        answers = (c for c in table.values() if c.kind == "answer" and c.item == check.item)
        return next(answers, None) if check.kind == "check" else None

    def _forget(self, first: int) -> None:
        """What cells made from `first` on may rest on what has changed."""
        self.made = {i: made for i, made in self.made.items() if i < first}

    def _run_one(self, cell: Cell) -> dict[str, Any]:
        self._forget(cell.index)
        for name in cell.owed:
            self.space.pop(name, None)
        was, calls, out = dict(self.space), Nothing.calls, Capped(MOST_OUTPUT)
        name = f"<ipython-input-{cell.index}>"
        linecache.cache[name] = (len(cell.source), None, cell.source.splitlines(True), name)
        value, error = None, ""
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out), no_keyboard():
            try:
                value = self._execute(cell.source, name)
                if value is not None and not isinstance(value, Nothing):
                    out.write(repr(value))
            except BaseException as problem:
                value, error = None, _words(problem, cell.source, name)
        if not error:
            self.made[cell.index] = Made(cell.source, self._new(was, cell.bound))
        verdict = value if isinstance(value, Verdict) else Verdict(cell.item, "")
        return {
            "text": out.getvalue(),
            "error": error,
            "status": verdict.status,
            "headline": verdict.headline,
            "note": NO_FIGURES if Nothing.calls > calls and cell.kind != "code" else "",
        }

    def _new(self, was: dict[str, Any], bound: set[str]) -> dict[str, Any]:
        """What a cell bound: names with another value, and names bound to the same one again."""
        return {
            name: value
            for name, value in self.space.items()
            if name in bound or name not in was or was[name] is not value
        }

    def _execute(self, source: str, name: str) -> Any:
        """Run statements; the value of a last expression is the cell's result."""
        tree = ast.parse(source, name)
        last = None
        if tree.body and isinstance(tree.body[-1], ast.Expr):
            last = ast.Expression(tree.body.pop().value)  # type: ignore[attr-defined]
        exec(compile(tree, name, "exec"), self.space)
        return eval(compile(last, name, "eval"), self.space) if last else None

    # ---- what the reader predicted, kept by the page -----------------------------------------
    def progress(self, lab: str) -> str:
        """Answers and predictions of the lab as the JSON that `Lab.save` writes; "" if none."""
        module = sys.modules.get(f"pfkit.labs.{lab}")
        if module is None or not module.LAB.answers:
            return ""
        path = Path("/tmp") / f"{lab}_answers.json"
        module.LAB.save(path)
        return path.read_text(encoding="utf-8")

    def restore(self, lab: str, text: str) -> str:
        """Give the lab back what `progress` returned; says what came of it."""
        path = Path("/tmp") / f"{lab}_answers.json"
        path.write_text(text, encoding="utf-8")
        return lab_called(lab).load(path)

    def student(self, lab: str, who: str, term: str) -> str:
        """Ask a student's own questions: JSON of item -> question, for those that differ."""
        found = lab_called(lab)
        found.student(who, term)
        asked = ((i.id, i.asked(), i.origin) for i in found.items.values() if i.origin)
        own = {item: text for item, text, printed in asked if text != printed.asked()}
        return json.dumps(own)

    def solution(self, lab: str, item: str) -> str:
        """The worked answer; whether it may be seen is for the page to know."""
        return lab_called(lab).items[item].worked()

    def review(self, lab: str, item: str, times: int) -> str:
        """A problem that comes back, in words."""
        return spaced_review.problem(lab_called(lab), item, times).asked()

    def reviewed(self, lab: str, item: str, times: int, answer: str) -> str:
        """JSON of whether the answer to it is right, and what to say."""
        asked = spaced_review.problem(lab_called(lab), item, times)
        return json.dumps(spaced_review.judged(asked, answer))


def lab_called(name: str) -> Lab:
    """The lab of a page, loaded if no cell has loaded it yet."""
    return import_module(f"pfkit.labs.{name}").LAB


@contextlib.contextmanager
def no_keyboard() -> Iterator[None]:
    """Let ``input()`` say that nobody is there."""
    before, sys.stdin = sys.stdin, NobodyThere()
    try:
        yield
    finally:
        sys.stdin = before


def _words(problem: BaseException, source: str, name: str) -> str:
    """An error in a sentence, with the line of the cell where it happened."""
    if isinstance(problem, SyntaxError) and problem.filename == name:
        return with_caret(problem, source)
    if isinstance(problem, SystemExit):
        return describe(SystemExit("it asked Python to end").with_traceback(problem.__traceback__))
    if isinstance(problem, ModuleNotFoundError) and problem.name:
        top = problem.name.split(".")[0].lstrip("_")
        if top == "matplotlib":
            return NO_FIGURES
        return describe(ModuleNotFoundError(NO_MODULE.format(name=top)).with_traceback(
            problem.__traceback__))  # fmt: skip
    return describe(problem)


def with_caret(problem: SyntaxError, source: str) -> str:
    """What a parser says, the line, and a ^ below the column where it gave up."""
    told = f"{type(problem).__name__} in line {problem.lineno}: {problem.msg}"
    lines = source.split("\n")[max(0, (problem.lineno or 1) - 1) :]
    line = (problem.text or lines[0] if lines else "").rstrip("\n")
    if not line.strip():
        return told
    if line.lstrip().startswith(("%", "!")):
        told += ". Lines that start with % or ! are commands of Jupyter, not Python"
    column = len(line[: max(0, (problem.offset or 1) - 1)].expandtabs(4))
    start = max(0, column - WIDEST + 8)
    return f"{told}\n  {line.expandtabs(4)[start : start + WIDEST]}\n  {' ' * (column - start)}^"
