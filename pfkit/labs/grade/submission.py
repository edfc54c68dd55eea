"""What a submitted file holds: answers by item, or the reason why it cannot be read.

Reading is plain JSON, so that no submission can run anything here.
"""

import ast
import hashlib
import json
import stat
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from pfkit.labs import catalogue, progress
from pfkit.labs.grade.cells import labs_imported, parsed, said
from pfkit.labs.lab import Lab
from pfkit.labs.names import bound_and_used

BIGGEST = 20_000_000  # bytes; a lab with all its figures has about one million
SUFFIXES = (".ipynb", ".json")


class Malformed(ValueError):
    """The file is not a submission of this lab; the message is for the instructor."""


@dataclass
class Answers:
    """Answer cells of one submission.

    Parameters
    ----------
    sources : dict
        Item id to source text.
    missing : list of str
        Items whose answer cell is not in the notebook.
    notes : list of str
        What the instructor should know, such as a cell that occurs twice.
    doubts : list of str
        Reasons for the status ``review``.
    elsewhere : set of str
        Names bound in cells that are not answer cells; they are not executed.
    ticks : dict
        Item id to the numbers of the lines of its rubric that the student ticked.
    student : tuple of two str
        Id and term of a world of the student's own; empty for the questions as printed.
    """

    sources: dict[str, str] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    doubts: list[str] = field(default_factory=list)
    elsewhere: set[str] = field(default_factory=set)
    ticks: dict[str, list[int]] = field(default_factory=dict)
    student: tuple[str, str] = ("", "")


def collect(folder: Path) -> list[Path]:
    """Every file below the folder, hidden ones and checkpoints left out, in order."""
    return sorted(
        p
        for p in folder.rglob("*")
        if not (p.is_dir() and not p.is_symlink())
        and not any(part.startswith(".") for part in p.relative_to(folder).parts)
    )


def fingerprint(path: Path) -> str:
    """SHA-256 of a regular file; "" for anything else."""
    try:
        if not stat.S_ISREG(path.lstat().st_mode):
            return ""
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""


def read(path: Path, lab: Lab, stubs: dict[str, str], variables: dict[str, str]) -> Answers:
    """Take the answers out of a file.

    Parameters
    ----------
    path : Path
    lab : Lab
        The lab that is graded.
    stubs : dict
        Item id to the unanswered cell.
    variables : dict
        Item id to the name its check cell judges.

    Raises
    ------
    Malformed
        With the reason in one sentence.
    """
    data = _load(path)
    if not isinstance(data, dict):
        raise Malformed(f"its JSON is a {type(data).__name__}, neither a notebook nor answers")
    if "cells" in data or "nbformat" in data or path.suffix == ".ipynb":
        return _from_notebook(data, lab, stubs)
    return _from_export(data, lab, stubs, variables)


def _load(path: Path) -> Any:
    try:
        about = path.lstat()
        if not stat.S_ISREG(about.st_mode):
            raise Malformed("not a regular file (a link, a pipe or a device)")
        with path.open("rb") as file:
            if file.read(4) == b"PK\x03\x04":
                raise Malformed("an archive: unpack it first")
        if path.suffix not in SUFFIXES:
            raise Malformed("neither a notebook (.ipynb) nor exported answers (.json)")
        if about.st_size > BIGGEST:
            size, most = about.st_size / 1e6, BIGGEST / 1e6
            raise Malformed(f"{size:.0f} MB, and the limit is {most:.0f}: clear the outputs")
        raw = path.read_bytes()
    except OSError as error:
        raise Malformed(f"cannot be read: {error.strerror}") from None
    if not raw.strip():
        raise Malformed("the file is empty")
    try:
        return json.loads(raw.decode("utf-8-sig"))
    except UnicodeDecodeError:
        raise Malformed("the text is not UTF-8") from None
    except (ValueError, RecursionError) as error:
        raise Malformed(f"not valid JSON: {' '.join(str(error).split())[:120]}") from None


def _from_notebook(data: dict[str, Any], lab: Lab, stubs: dict[str, str]) -> Answers:
    if data.get("nbformat") != 4:
        raise Malformed(f"nbformat is {str(data.get('nbformat'))[:20]}, and 4 is needed")
    pairs = list(_code(data.get("cells")))
    _same_lab([source for _, source in pairs], lab.name)
    found, answers = dict[str, list[str]](), Answers()
    told = progress.empty(lab.name)
    for _, source in pairs:
        for who, *term in said(source, "student"):
            told["student"] = {"who": who, "term": term[0] if term else ""}
        for item, *lines in said(source, "tick"):
            told["ticks"] = told.get("ticks", {}) | {item: lines}
    _personal(answers, progress.parse(json.dumps(told), lab.name))
    for item, source in pairs:
        if item in stubs:
            found.setdefault(item, []).append(source)
        elif item:
            answers.notes.append(f"unknown answer cell {item[:40]!r} ignored")
        else:
            answers.elsewhere |= bound_and_used(source)[0]
    for item in stubs:
        if item in found:
            answers.sources[item] = _joined(item, found[item], stubs[item], answers)
        else:
            answers.missing.append(item)
    return answers


def _code(cells: Any) -> Iterable[tuple[str, str]]:
    """Yield (item id or "", source) of code cells, checking every type on the way."""
    if not isinstance(cells, list) or not all(isinstance(c, dict) for c in cells):
        raise Malformed("its cells are not a list of cells")
    for cell in cells:
        source, about = cell.get("source", ""), cell.get("metadata", {})
        if isinstance(source, list) and all(isinstance(line, str) for line in source):
            source = "".join(source)
        if not isinstance(source, str) or not isinstance(about, dict):
            raise Malformed("a cell has no text as its source, or no table as its metadata")
        item = about.get("answer", "")
        if cell.get("cell_type") == "code":
            yield (item if isinstance(item, str) else repr(item)), source


def _same_lab(sources: list[str], lab: str) -> None:
    named = {progress.present_name(n) for s in sources for n in labs_imported(s)}
    others = sorted(named.intersection(catalogue.names()))
    if lab not in named:
        raise Malformed(
            f"it is the notebook of {others[0] if others else 'something else'}, not of {lab}"
        )


def _joined(item: str, cells: list[str], stub: str, answers: Answers) -> str:
    """One source out of several cells of one item, in order, as Run All would do."""
    written = list(dict.fromkeys(c for c in cells if c.strip() and c.strip() != stub.strip()))
    if len(cells) > 1:
        answers.notes.append(f"{item}: {len(cells)} answer cells, {len(written)} different")
    target = bound_and_used(stub)[0]
    complete = [c for c in written if target and target <= bound_and_used(c)[0]]
    if len(complete) > 1:
        answers.doubts.append(f"{item}: {len(complete)} answers compete; the last one was run")
    return "\n\n".join(written) if written else (cells[0] if len(cells) == 1 else stub)


def _from_export(
    data: dict[str, Any], lab: Lab, stubs: dict[str, str], variables: dict[str, str]
) -> Answers:
    """Answers that the page or `Lab.save` wrote: unanswered items are simply not in them."""
    try:
        kept = progress.parse(json.dumps(data), lab.name)
    except (ValueError, RecursionError, TypeError, AttributeError) as error:
        raise Malformed(" ".join(str(error).split())[:160]) from None
    answers = Answers(sources=dict(stubs))
    _personal(answers, kept)
    for item, guess in kept["predictions"].items():
        if item in stubs:
            pair = (guess["choice"], guess["sure"])
            answers.sources[item] = f"{variables[item]} = {pair!r}"
    for item, entry in kept["answers"].items():
        if item in stubs:
            answers.sources[item] = _as_cell(entry["source"], variables[item])
            if entry["version"] != lab.items[item].version:
                answers.notes.append(f"{item}: answers another version of the question")
        else:
            answers.notes.append(f"unknown item {item[:40]!r} ignored")
    return answers


def _personal(answers: Answers, kept: dict[str, Any]) -> None:
    """The student's own ticks, and the world whose questions were answered."""
    answers.ticks = kept.get("ticks", {})
    told = kept.get("student", {"who": "", "term": ""})
    answers.student = told["who"], told["term"]


def _as_cell(source: str, variable: str) -> str:
    """A cell stays; a bare value, as `Lab.save` keeps it, is given its name."""
    body = parsed(source.strip()).body
    if len(body) != 1 or not isinstance(body[0], ast.Expr):
        return source
    return f"from numpy import array, float64, inf, int64, nan\n{variable} = {source.strip()}"
