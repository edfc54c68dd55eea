"""Answers and predictions in a small JSON file, the same for notebook, page and grader.

    {"schema": 1, "lab": "lab3",
     "answers": {"q2a": {"source": "...", "version": "1f0c..."}},
     "predictions": {"q7a": {"choice": "b", "sure": 70.0, "version": "..."}},
     "ticks": {"p3c": [1, 2]}, "student": {"who": "jo17", "term": "2027-spring"}}

The last two are there if a rubric was ticked, or if the questions were a student's own.
``version`` is that of the question, so that an answer to an older question can be told apart.
A file that cannot be read is renamed, never overwritten. One that was kept when labs of chapters
were called by numbers belongs to the lab of today's name, see `FORMER_NAMES`.
"""

import json
import os
from pathlib import Path
from typing import Any

SCHEMA = 1
LONGEST = 100  # characters of a student's id
BIGGEST = 5_000_000  # bytes; a lab's answers are some ten thousand
FORMER_NAMES = {
    "bayes_filter": "ch01",
    "global_localisation": "ch11",
    "importance_weights": "ch05",
    "motion": "ch03",
    "outliers": "ch10",
    "particle_filter": "ch06",
    "prerequisites": "ch00",
    "real_robot": "ch14",
    "resampling": "ch07",
    "sensing": "ch04",
}


def present_name(lab: str) -> str:
    """The name that a lab has today, of the one that it had or has."""
    return next((new for new, old in FORMER_NAMES.items() if old == lab), lab)


def file_of(lab: str) -> Path:
    """Where a lab is kept in this folder; the file of its former name if only that is there."""
    now, before = (Path(f"{n}_answers.json") for n in (lab, FORMER_NAMES.get(lab, lab)))
    return before if before.exists() and not now.exists() else now


def empty(lab: str) -> dict[str, Any]:
    return {"schema": SCHEMA, "lab": lab, "answers": {}, "predictions": {}}


def parse(text: str, lab: str) -> dict[str, Any]:
    """Read stored progress; raises ValueError that says what is wrong. Content is data only."""
    data = json.loads(text)
    if not isinstance(data, dict) or data.get("schema") != SCHEMA:
        found = data.get("schema") if isinstance(data, dict) else None
        raise ValueError(f"its schema is {found!r}, and this version reads {SCHEMA}")
    if present_name(str(data.get("lab"))) != lab:
        raise ValueError(f"it belongs to {str(data.get('lab'))[:40]!r}, not to {lab!r}")
    clean = empty(lab)
    for item, kept in _entries(data, "answers"):
        clean["answers"][item] = {k: str(kept.get(k, "")) for k in ("source", "version")}
    for item, kept in _entries(data, "predictions"):
        sure = kept.get("sure")
        clean["predictions"][item] = {
            "choice": str(kept.get("choice", "")),
            "sure": float(sure) if _is_per_cent(sure) else None,
            "version": str(kept.get("version", "")),
        }
    ticks = data.get("ticks", {})
    if not isinstance(ticks, dict):
        raise ValueError("its part 'ticks' is not a table")
    good = {
        str(item): [k for k in x if isinstance(k, int)]
        for item, x in ticks.items()
        if isinstance(x, list)
    }
    if good:
        clean["ticks"] = good
    told = data.get("student")
    if isinstance(told, dict) and told.get("who"):
        clean["student"] = {k: str(told.get(k, ""))[:LONGEST].strip() for k in ("who", "term")}
    return clean


def _is_per_cent(sure: Any) -> bool:
    return isinstance(sure, int | float) and 0 <= sure <= 100  # nan is no number of per cent


def _entries(data: dict[str, Any], part: str) -> list[tuple[str, dict[str, Any]]]:
    found = data.get(part, {})
    if not isinstance(found, dict) or not all(isinstance(x, dict) for x in found.values()):
        raise ValueError(f"its part {part!r} is not a table of answers")
    return list(found.items())


def read(path: Path, lab: str) -> tuple[dict[str, Any] | None, str]:
    """The stored progress, or None, with a sentence. Sets a damaged file aside."""
    if not path.exists():
        return None, f"There is no {path.name} yet."
    try:
        if path.stat().st_size > BIGGEST:
            raise ValueError(f"it has more than {BIGGEST} bytes")
        data = parse(path.read_text(encoding="utf-8"), lab)
    except (ValueError, RecursionError) as error:  # includes bad JSON and bad UTF-8
        aside = set_aside(path)
        reason = " ".join(str(error).split())[:160]
        return None, f"I could not read {path.name} ({reason}). I kept it as {aside.name}."
    return data, f"Loaded {len(data['answers'])} answers from {path.name}."


def set_aside(path: Path) -> Path:
    """Rename a file that we cannot use to the first free ``name.damaged-N``."""
    n = 1
    while (aside := path.with_name(f"{path.name}.damaged-{n}")).exists():
        n += 1
    os.replace(path, aside)
    return aside


def write(path: Path, data: dict[str, Any]) -> None:
    """Write in one step, so that a crash leaves the old file or the new one."""
    beside = path.with_name(path.name + ".part")
    text = json.dumps(data, indent=1, sort_keys=True, ensure_ascii=False)
    beside.write_text(text + "\n", encoding="utf-8")
    os.replace(beside, path)
