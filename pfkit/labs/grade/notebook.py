"""The lab's own notebook, and the steps to run for one submission.

Everything that an answer does not need is left out (worked examples, figures), so that a
submission takes seconds: a cell of ours runs only if it binds a name that a later step reads.
"""

import importlib
import json
from dataclasses import dataclass
from pathlib import Path

from pfkit.labs import catalogue
from pfkit.labs.grade.cells import (
    VERBS,
    code_cells,
    lab_calls,
    names_changed,
    names_needed,
    surely_bound,
)
from pfkit.labs.grade.submission import Answers
from pfkit.labs.lab import Lab

ROOT = Path(__file__).resolve().parents[3]


class NoSuchLab(ValueError):
    """The lab or its notebook cannot be found; the message says what to do."""


@dataclass(frozen=True)
class Pristine:
    """The unanswered notebook: its code cells in order, and the name each item is answered in."""

    lab: Lab
    path: Path
    cells: tuple[tuple[str, str], ...]  # (item id or "", source)
    variables: dict[str, str]  # item id -> the expression its check cell judges

    @property
    def stubs(self) -> dict[str, str]:
        return {item: source for item, source in self.cells if item}


def find(name: str, path: Path | None = None) -> Pristine:
    """Load a lab's module and its notebook.

    Parameters
    ----------
    name : str
        A module of `pfkit.labs`, such as ``"lab3"`` or ``"resampling"``.
    path : Path, optional
        The unanswered notebook; by default the one of this course that imports the module.

    Raises
    ------
    NoSuchLab
        Says which labs there are, or how to name the notebook.
    """
    if name not in catalogue.names():
        raise NoSuchLab(f"there is no lab {name!r}; there are {', '.join(catalogue.names())}")
    lab = importlib.import_module(f"pfkit.labs.{name}").LAB
    path = path or _search(name)
    cells = tuple(code_cells(json.loads(path.read_text(encoding="utf-8"))))
    variables = {}
    for _, source in cells:
        for verb, item, value in lab_calls(source):
            if verb in VERBS:
                variables[item] = value
    lost = [i for i in lab.items if i not in variables or i not in dict(cells)]
    if lost:
        raise NoSuchLab(f"{path.name} has no answer and check cell for {', '.join(lost)}")
    return Pristine(lab, path, cells, variables)


def _search(name: str) -> Path:
    for path in sorted((ROOT / "notebooks").rglob("*.ipynb")):
        if ".ipynb_checkpoints" in path.parts:
            continue
        if name in catalogue.asked_in(json.loads(path.read_text(encoding="utf-8"))):
            return path
    raise NoSuchLab(f"no notebook below {ROOT / 'notebooks'} imports {name}: name it by --notebook")


def steps(pristine: Pristine, answers: Answers) -> list[dict[str, str]]:
    """What the runner executes, in order: cells of ours, answers, checks and uses.

    A check is left out where the answer is missing; `batch` reports those.
    """
    every: list[dict[str, str]] = []
    for item, source in pristine.cells:
        calls = [(verb, i) for verb, i, _ in lab_calls(source) if i in pristine.lab.items]
        if item:
            if item in answers.sources:
                every.append({"do": "answer", "item": item, "source": answers.sources[item]})
        elif calls and calls[0][0] in VERBS:
            if calls[0][1] in answers.sources:
                value = pristine.variables[calls[0][1]]
                every.append({"do": "check", "item": calls[0][1], "source": value})
        elif calls and calls[0][0] == "use":
            every.append({"do": "use", "item": calls[0][1], "source": source})
        else:
            every.append({"do": "ours", "item": "", "source": source})
    return _needed(every)


def _needed(every: list[dict[str, str]]) -> list[dict[str, str]]:
    kept, wanted = [], set[str]()
    for step in reversed(every):
        if step["do"] in ("ours", "use"):
            if not names_changed(step["source"]) & wanted:
                continue
        wanted -= surely_bound(step["source"])
        wanted |= names_needed(step["source"])
        kept.append(step)
    return kept[::-1]
