"""What came of a submission: its status, its score, and everything there is to say."""

import re
from collections.abc import Iterable
from typing import Any

from pfkit.labs.grade.submission import Answers
from pfkit.labs.items import Text
from pfkit.labs.lab import Lab

Record = dict[str, Any]
GRADED = ("ok", "errors")


def judge(
    lab: Lab, answers: Answers, found: dict[str, Any], cell_timeout: float, wall: float
) -> Record:
    """The part of a record that a run decides.

    Parameters
    ----------
    lab : Lab
    answers : Answers
        What was read from the file.
    found : dict
        What the warden saw: events, timeouts, processes left, exit code.
    cell_timeout, wall : float
        Limits in seconds, for the words.
    """
    events = found["events"]
    items = {i: {"status": "missing", "detail": "no answer cell"} for i in answers.missing}
    items |= {e["item"]: e for e in events if e.get("item") in lab.items and "status" in e}
    items = {i: items[i] for i in lab.items if i in items}
    doubts = answers.doubts + [e["doubt"] for e in events if "doubt" in e]
    if found["strange"]:
        doubts.append("wrote to the channel of the grader")
    if found["left"] > 0 and not found["timeouts"]:
        doubts.append(f"{found['left']} of its processes ran on and were ended")
    late = [_late(item, cell_timeout, wall) for item in found["timeouts"]]
    status, told = _status(answers, found, items, late, dict.fromkeys(doubts))
    score = sum(e.get("score") or 0.0 for e in items.values())
    texts = [i.id for i in lab.items.values() if isinstance(i, Text)]
    return {
        "status": status,
        "score": round(score, 3) if status in GRADED else None,
        "items": items,
        "texts": {i: answers.sources[i] for i in texts if i in answers.sources},
        "ticked": {i: answers.ticks[i] for i in texts if i in answers.ticks},
        "world": " ".join(filter(None, answers.student)),
        "detail": "; ".join(dict.fromkeys(told + answers.notes))[:1000],
    }


def _late(item: str, cell_timeout: float, wall: float) -> str:
    if item == "all":
        return f"not done in {wall:g} s"
    return f"{item or 'a cell'}: not done in {cell_timeout:g} s"


def _status(
    answers: Answers, found: dict[str, Any], items: Record, late: list[str], doubts: Iterable[str]
) -> tuple[str, list[str]]:
    """The first that applies, worst first, and everything there is to say."""
    ended = any("end" in e for e in found["events"])
    at = next((e["begin"] for e in reversed(found["events"]) if "begin" in e), "")
    raised = {}
    for item, e in items.items():
        if e["status"] == "error" or e.get("raised") or _lost(e["detail"], answers):
            raised[item] = e.get("raised") or e["detail"]
    blank = not raised and all(
        e["status"] in ("unanswered", "locked", "missing") for e in items.values()
    )
    ways = {
        "timeout": late,
        "crashed": []
        if ended or late
        else [f"Python ended with code {found['exit']} in {at or 'the first cell'}"],
        "review": list(doubts),
        "missing": [f"no answer cell for {', '.join(answers.missing)}"] * bool(answers.missing)
        + ["nothing is answered"] * (ended and blank),
        "errors": [f"{i}: {_where(words, answers)}" for i, words in raised.items()],
    }
    status = next((name for name, reasons in ways.items() if reasons), "ok")
    return status, [reason for reasons in ways.values() for reason in reasons]


def _lost(words: str, answers: Answers) -> str:
    """A name that an answer misses and that a cell that is not run would have made."""
    found = re.findall(r"NameError: name '(\w+)'", words)
    return next((name for name in found if name in answers.elsewhere), "")


def _where(words: str, answers: Answers) -> str:
    name = _lost(words, answers)
    if not name:
        return words[:300]
    return f"NameError: {name} is made in a cell that is no answer cell, and is not run"
