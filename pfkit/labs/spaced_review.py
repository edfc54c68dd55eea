"""Review: problems come back at equal gaps, a few at a time, each time with other numbers.

    from pfkit import labs

    labs.review()                         # what is due: three problems at most, three minutes
    labs.review("resampling/share", 0.3)  # your answer to one of them
    labs.review(off=True)                 # nothing is ever due; off=False takes it back

What can come back is a number with numbers to draw, so that nobody answers from memory. Nothing
asks by itself. In Jupyter the dates stand in ``review.json`` beside the saved answers, in the page
in the browser; both count with `GAP`, `SITTING` and `TIMES`.
"""

from __future__ import annotations

import datetime
import hashlib
import json
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from pfkit.labs import progress
from pfkit.labs.items import Item, Numeric
from pfkit.labs.lab import Lab

GAP = 7  # days between two reviews of a problem, always the same
SITTING = 3  # problems at a time
TIMES = 4  # a problem comes back
FILE = "review.json"


def reviewable(lab: Lab) -> list[str]:
    """Ids of the items that can come back with other numbers."""
    return [i for i, x in lab.items.items() if isinstance(x.origin or x, Numeric) and x.draw]


def problem(lab: Lab, item_id: str, times: int) -> Item:
    """The item with the numbers of its next review, after ``times`` that went well."""
    item = lab.items[item_id]
    text = "/".join(("review", lab.who.casefold(), lab.name, item_id, str(times)))
    seed = int.from_bytes(hashlib.sha256(text.encode()).digest()[:8], "big")
    return (item.origin or item).personal(np.random.default_rng(seed))


def judged(item: Item, answer: Any) -> tuple[bool, str]:
    """Is the answer right, and what to say of it."""
    if isinstance(answer, str) and "," in answer:
        answer = [part.strip() for part in answer.split(",")]
    found = item.judge(answer)
    if found.fraction == 1:
        return True, "right"
    if found.misconception:
        return False, f"your answer {found.misconception.words}. {found.misconception.hints[0]}"
    return False, found.feedback or f"not yet. {item.hints[0]}"


def review(
    name: str = "",
    answer: Any = ...,
    off: bool | None = None,
    folder: str | Path = ".",
    today: datetime.date | None = None,
) -> None:
    """Show what is due, or judge an answer to it.

    Parameters
    ----------
    name : str
        Lab and item, such as ``"resampling/share"``; empty to see what is due.
    answer : object
        As for the item itself.
    off : bool, optional
        True switches reviews off, False on again.
    folder : path
        Where answers were saved.
    today : date, optional
        For tests.
    """
    today = today or datetime.date.today()
    file = Path(folder) / FILE
    kept = _read(file)
    if off is not None:
        kept["off"] = off
        print("Reviews are off." if off else "Reviews are on.")
    elif name:
        _answer(kept, name, answer, today)
    else:
        _enlist(kept["items"], Path(folder))
        _show(kept, today)
    progress.write(file, kept)


def due(items: dict[str, dict[str, Any]], today: datetime.date) -> list[str]:
    """Names of what has waited for `GAP` days or more, the longest wait first."""
    latest = (today - datetime.timedelta(days=GAP)).isoformat()
    waiting = [n for n, x in items.items() if x["day"] <= latest and x["times"] < TIMES]
    return sorted(waiting, key=lambda n: (items[n]["day"], n))[:SITTING]


def _read(file: Path) -> dict[str, Any]:
    """What was kept; a file that cannot be read is set aside, and said."""
    kept: dict[str, Any] = {"off": False, "items": {}}
    if not file.exists():
        return kept
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
        for name, x in found["items"].items():
            day = datetime.date.fromisoformat(x["day"]).isoformat()
            kept["items"][name] = {"day": day, "times": int(x["times"])}
        kept["off"] = bool(found["off"])
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        aside = progress.set_aside(file)
        print(f"I could not read {file.name} ({error}). I kept it as {aside.name}.")
    return kept


def _enlist(items: dict[str, dict[str, Any]], folder: Path) -> None:
    """Answered items of the labs saved in this folder, from the day they were saved."""
    for file in sorted(folder.glob("*_answers.json")):
        name = progress.present_name(file.name.removesuffix("_answers.json"))
        if not name.isidentifier() or not find_spec(f"pfkit.labs.{name}"):
            continue
        data, _ = progress.read(file, name)
        if data is None:
            continue
        day = datetime.date.fromtimestamp(file.stat().st_mtime).isoformat()
        for item in set(reviewable(_lab(name))) & data["answers"].keys():
            items.setdefault(f"{name}/{item}", {"day": day, "times": 0})


def _lab(name: str) -> Lab:
    return import_module(f"pfkit.labs.{name}").LAB


def _asked(name: str, times: int) -> Item:
    lab, _, item = name.partition("/")
    return problem(_lab(lab), item, times)


def _show(kept: dict[str, Any], today: datetime.date) -> None:
    names = [] if kept["off"] else due(kept["items"], today)
    if not names:
        waiting = [x["day"] for x in kept["items"].values() if x["times"] < TIMES]
        after = datetime.timedelta(days=GAP)
        first = datetime.date.fromisoformat(min(waiting)) + after if waiting else None
        when = f" The next one is due on {first}." if first and not kept["off"] else ""
        print(f"Reviews are {'off' if kept['off'] else 'done'}.{when}")
        return
    for name in names:
        print(f"{name}: {_asked(name, kept['items'][name]['times']).asked()}")
    print(f'Answer with labs.review("{names[0]}", ...).')


def _answer(kept: dict[str, Any], name: str, answer: Any, today: datetime.date) -> None:
    if name not in kept["items"]:
        print(f"{name!r} is no problem under review: labs.review() shows which are due")
        return
    entry = kept["items"][name]
    right, told = judged(_asked(name, entry["times"]), answer)
    if right:
        entry.update(day=today.isoformat(), times=entry["times"] + 1)
        told += f". It comes back in {GAP} days" if entry["times"] < TIMES else ". It is done"
        told += "."
    print(f"{name}: {told}")
