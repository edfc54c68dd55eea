"""A notebook's code cells, answered in the page: one namespace, run as far as it is needed.

The page shows an editor for each answer cell. When the reader runs one, the names that it uses must
exist: imports, a world, an earlier answer. `Cells.run` finds the cells above that bind those names,
runs those that have not run yet (or whose source has changed since), and then the cell itself. So a
reader may start with any question, and after a hang was stopped nothing is lost but time.

Pictures belong to the notebook: matplotlib is not in the page, and a stand-in that does nothing
lets cells with figures run for the numbers that they compute.
"""

from __future__ import annotations

import ast
import builtins
import contextlib
import io
import json
import linecache
import symtable
import sys
import traceback
import types
from pathlib import Path
from typing import Any

import numpy as np

MOST_OUTPUT = 20_000  # characters of printed text that the page shows


class Nothing:
    """Absorbs any use: attribute, call, item, context. Stands in for figures and axes."""

    def __getattr__(self, name: str) -> Nothing:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __call__(self, *args: Any, **kwargs: Any) -> Nothing:
        return self

    def __getitem__(self, key: Any) -> Nothing:
        return self

    def __setitem__(self, key: Any, value: Any) -> None:
        return None

    def __iter__(self):
        return iter(())

    def __enter__(self) -> Nothing:
        return self

    def __exit__(self, *args: Any) -> None:
        return None

    def subplots(self, nrows: int = 1, ncols: int = 1, **kwargs: Any) -> tuple[Any, Any]:
        """A figure and its axes in the shape that pyplot gives them."""
        axes = np.empty((nrows, ncols), object)
        axes.fill(Nothing())
        axes = axes if not kwargs.get("squeeze", True) else axes.squeeze()
        return self, axes[()] if axes.ndim == 0 else axes

    def panels(self, n: int, **kwargs: Any) -> tuple[Any, list[Any]]:
        """What `pfkit.plotting.panels` gives: a figure and n axes."""
        return self, [self] * n


def stand_in_for_figures() -> None:
    """Let ``import matplotlib...``, ``pfkit.plotting`` and ``pfkit.widgets`` succeed."""

    def module(name: str) -> types.ModuleType:
        nothing = Nothing()
        made = types.ModuleType(name)
        made.__getattr__ = lambda attribute: getattr(nothing, attribute)  # type: ignore[method-assign]
        made.__path__ = []  # type: ignore[attr-defined]
        return made

    for name in (
        "matplotlib",
        "matplotlib.pyplot",
        "matplotlib.patches",
        "matplotlib.animation",
        "matplotlib.colors",
        "pfkit.plotting",
        "pfkit.widgets",
        "ipywidgets",
        "IPython",
        "IPython.display",
    ):
        sys.modules.setdefault(name, module(name))


def bound_and_used(source: str) -> tuple[set[str], set[str]]:
    """Names that a cell binds at its top level, and global names that it reads.

    What is local to a function counts as neither: an answer may call its log ``log``.
    """
    try:
        top = symtable.symtable(source, "<cell>", "exec")
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set(), set()
    names = top.get_symbols()
    bound = {n.get_name() for n in names if n.is_assigned() or n.is_imported() or n.is_namespace()}
    used = {n.get_name() for n in names if n.is_referenced()}
    used |= bound & {  # ``x += 1`` reads x, of which a table of symbols does not speak
        n.target.id
        for n in ast.walk(ast.parse(source))
        if isinstance(n, ast.AugAssign) and isinstance(n.target, ast.Name)
    }
    inner = list(top.get_children())
    while inner:
        table = inner.pop()
        inner += table.get_children()
        used |= {n.get_name() for n in table.get_symbols() if n.is_global()}
    return bound, used - set(dir(builtins))


class Cells:
    """The namespace of one page."""

    def __init__(self) -> None:
        stand_in_for_figures()
        self.space: dict[str, Any] = {"__name__": "__main__"}
        self.ran: dict[int, str] = {}

    def needed(self, cells: list[dict[str, Any]], index: int) -> list[int]:
        """Cells above `index` that must run before it, in order."""
        wanted: set[int] = set()
        names = {c["index"]: bound_and_used(c["source"]) for c in cells}

        def visit(i: int) -> None:
            for name in names[i][1]:
                above = [j for j in names if j < i and name in names[j][0]]
                if above and max(above) not in wanted:
                    wanted.add(max(above))
                    visit(max(above))

        visit(index)
        return sorted(wanted)

    def run(self, cells: str, index: int) -> str:
        """Run cell `index` and what it needs; a JSON report of what it printed and returned.

        Parameters
        ----------
        cells : str
            JSON list of {"index", "source", "kind", "item"}: all code cells, with the answers as
            they stand; item is unique for cells that belong to no question.
        index : int
        """
        table = {c["index"]: c for c in json.loads(cells)}
        before = []
        for i in self.needed(list(table.values()), index):
            if self.ran.get(i) != table[i]["source"]:
                before.append(i)
                report = self._run_one(i, table[i]["source"])
                if not report["error"]:
                    continue
                if table[i].get("item") == table[index].get("item") or table[i]["kind"] == "code":
                    return json.dumps({**report, "before": before})
                for name in bound_and_used(table[i]["source"])[0]:
                    self.space[name] = ...  # another answer that fails counts as unanswered
        return json.dumps({**self._run_one(index, table[index]["source"]), "before": before})

    def _run_one(self, index: int, source: str) -> dict[str, Any]:
        for later in [i for i in self.ran if i > index]:
            del self.ran[later]  # they may have used what is about to change
        out = io.StringIO()
        name = f"<ipython-input-{index}>"
        linecache.cache[name] = (len(source), None, source.splitlines(True), name)
        value, error = None, ""
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            try:
                value = self._execute(source, name)
                shown = "" if value is None else repr(value)
            except BaseException as problem:
                shown, error = "", self._tell(problem, name)
        if not error:
            self.ran[index] = source
        text = out.getvalue() + shown
        if len(text) > MOST_OUTPUT:
            text = text[:MOST_OUTPUT] + f"\n[{len(text) - MOST_OUTPUT} more characters]"
        return {"text": text, "error": error, "status": getattr(value, "status", "") or ""}

    def _execute(self, source: str, name: str) -> Any:
        """Run statements; the value of a last expression is the cell's result."""
        tree = ast.parse(source, name)
        last = None
        if tree.body and isinstance(tree.body[-1], ast.Expr):
            last = ast.Expression(tree.body.pop().value)  # type: ignore[attr-defined]
        exec(compile(tree, name, "exec"), self.space)
        return eval(compile(last, name, "eval"), self.space) if last else None

    @staticmethod
    def _tell(problem: BaseException, name: str) -> str:
        """The error in one line, with the line of the cell where it happened."""
        if isinstance(problem, SyntaxError) and problem.filename == name:
            return f"SyntaxError in line {problem.lineno}: {problem.msg}"
        lines = [
            f.lineno for f in traceback.extract_tb(problem.__traceback__) if f.filename == name
        ]
        where = f" (line {lines[-1]})" if lines else ""
        return f"{type(problem).__name__}: {str(problem)[:600]}{where}"

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
        exec(f"from pfkit.labs import {lab}", {})
        return sys.modules[f"pfkit.labs.{lab}"].LAB.load(path)
