"""Tables and pages: one row per submission, one per item, one page per student."""

import csv
import io
import os
import re
from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from pfkit.labs.items import Choice, Item, Prediction, Text
from pfkit.labs.lab import Lab

Record = dict[str, Any]
COLUMNS = ("student", "file", "status", "score", "max")
AFTER = ("ticked", "world", "detail", "seconds", "version", "sha256")
BLANK = ("unanswered", "locked", "missing")
RIGHT = ("passed", "predicted")


def write(path: Path, text: str) -> None:
    """Replace a file in one step, so that an interruption leaves the old one or the new one."""
    beside = path.with_name(path.name + ".part")
    beside.write_text(text, encoding="utf-8", newline="", errors="backslashreplace")
    os.replace(beside, path)


def _table(header: Iterable[str], rows: Iterable[Iterable[Any]]) -> str:
    out = io.StringIO()
    csv.writer(out, lineterminator="\n").writerows(
        [list(header), *([_cell(c) for c in row] for row in rows)]
    )
    return out.getvalue()


def _cell(value: Any) -> Any:
    """Text that a spreadsheet would take for a formula gets an apostrophe in front."""
    if value is None:
        return ""
    if isinstance(value, str):
        value = "".join(c if c.isprintable() else " " for c in value)
        return "'" + value if value[:1] in ("=", "+", "-", "@") else value
    return f"{value:g}" if isinstance(value, float) else value


def rows(records: list[Record], lab: Lab) -> str:
    """The grades, as CSV: what was earned stands in the column of its item."""
    body = [
        [r[c] for c in COLUMNS]
        + [points(r, i) for i in lab.items.values()]
        + [_ticked(r[c]) if c == "ticked" else r[c] for c in AFTER]
        for r in sorted(records, key=lambda r: r["file"])
    ]
    return _table([*COLUMNS, *lab.items, *AFTER], body)


def _ticked(ticks: dict[str, list[int]]) -> str:
    """``p3c: 1 2`` means that the student ticked the first two lines of the rubric of p3c."""
    return "; ".join(f"{item}: {' '.join(map(str, lines))}" for item, lines in ticks.items())


def points(record: Record, item: Item) -> float | None:
    """Points earned; None where nothing was judged, and for text, which a person marks."""
    got = record["items"].get(item.id)
    if not got or isinstance(item, Text) or got["status"] in BLANK:
        return None
    return float(got.get("score") or 0.0)


# -- statistics of the items ---------------------------------------------------------------------

STATISTICS = ("item", "type", "title", "answered", "blank", "right", "facility",
              "discrimination", "choices", "misconceptions")  # fmt: skip


def statistics(records: list[Record], lab: Lab) -> str:
    """One row per item, over the submissions that were graded, as CSV.

    ``facility`` is the mean share of the points among those who answered; ``discrimination`` the
    correlation of that share with the points for all other items.
    """
    graded = [r for r in records if r["score"] is not None]
    return _table(STATISTICS, [_statistics(item, graded) for item in lab.items.values()])


def _statistics(item: Item, graded: list[Record]) -> list[Any]:
    got = [(r, r["items"][item.id]) for r in graded if item.id in r["items"]]
    got = [(r, g) for r, g in got if g["status"] not in BLANK]
    shares = [(g.get("score") or 0.0) / item.points for _, g in got]
    rest = [r["score"] - (g.get("score") or 0.0) for r, g in got]
    choices = Counter(g["choice"] for _, g in got if g.get("choice"))
    if not isinstance(item, Choice | Prediction):
        choices = Counter()
    named = Counter(g["misconception"] for _, g in got if g.get("misconception"))
    by_hand = isinstance(item, Text)
    return [
        item.id, item.letter, item.title, len(got), len(graded) - len(got),
        None if by_hand else sum(g["status"] in RIGHT for _, g in got),
        None if by_hand or not got else round(sum(shares) / len(got), 3),
        None if by_hand else correlation(shares, rest),
        _counts(choices), _counts(named),
    ]  # fmt: skip


def _counts(found: Counter[str]) -> str:
    return ", ".join(f"{name} {n}" for name, n in sorted(found.items()))


def correlation(x: list[float], y: list[float]) -> float | None:
    """Pearson's; None for fewer than three pairs or where one of them does not vary."""
    n = len(x)
    if n < 3:
        return None
    mx, my = sum(x) / n, sum(y) / n
    vx, vy = sum((a - mx) ** 2 for a in x), sum((b - my) ** 2 for b in y)
    if vx < 1e-12 or vy < 1e-12:
        return None
    return round(sum((a - mx) * (b - my) for a, b in zip(x, y, strict=True)) / (vx * vy) ** 0.5, 3)


# -- a page per student --------------------------------------------------------------------------


def page(record: Record, lab: Lab) -> str:
    """What one student earned and why, in Markdown; text answers stand beside their rubric."""
    score = "not graded" if record["score"] is None else f"{record['score']:g} of {record['max']:g}"
    by_hand = sum(i.points for i in lab.items.values() if isinstance(i, Text))
    head = [
        f"# {_plain(record['student'])}",
        "",
        f"* {lab.title}",
        f"* Score: **{score}**" + (f", and {by_hand:g} points by hand" if by_hand else ""),
        f"* Status: {record['status']}",
        f"* File: {_plain(record['file'])}, SHA-256 {record['sha256'][:12] or 'none'}",
        f"* Version: {record['version']}",
    ]
    if record["world"]:
        head.append(f"* Questions of: {_plain(record['world'])}")
    if record["detail"]:
        head.append(f"* To look at: {_plain(record['detail'])}")
    if not record["items"]:
        return "\n".join(head) + "\n"
    table = ["", "| item | question | points | what happened |", "|---|---|---|---|"]
    done = [i for i in lab.items.values() if _status(record, i) not in BLANK]
    table += [_row(record, item) for item in done]
    blank = [i.id for i in lab.items.values() if i not in done]
    table += ["", f"Not answered: {', '.join(blank)}."] if blank else []
    return "\n".join(head + table + _texts(record, lab)) + "\n"


def _status(record: Record, item: Item) -> str:
    return str(record["items"].get(item.id, {"status": "not reached"})["status"])


def _row(record: Record, item: Item) -> str:
    got = record["items"].get(item.id, {})
    told = [_status(record, item), got.get("detail"), got.get("hint")]
    earned = points(record, item)
    shown = "by hand" if isinstance(item, Text) else "none" if earned is None else f"{earned:g}"
    words = " ".join(x if x[-1] in ".?!" else x + "." for x in told if x)
    return f"| {item.id} | {_plain(item.title)} | {shown} of {item.points:g} | {_plain(words)} |"


def _texts(record: Record, lab: Lab) -> list[str]:
    lines: list[str] = []
    for name, source in record["texts"].items():
        item = lab.items[name]
        if not isinstance(item, Text) or _status(record, item) in BLANK:
            continue
        fence = "`" * max(3, 1 + max(map(len, re.findall("`+", source)), default=0))
        lines += ["", f"## {name}: {_plain(item.title)} ({item.points:g} by hand)", ""]
        lines += [fence + "python", source.strip()[:5000], fence, ""]
        ticked = record["ticked"].get(name, [])
        lines += [
            f"* [ ] {_plain(line)}" + " (ticked by the student)" * (k in ticked)
            for k, line in enumerate(item.rubric, start=1)
        ]
        lines += ["", f"Model: {_plain(item.model)}"]
    return lines


def _plain(text: str) -> str:
    """One line that Markdown shows as it is, HTML and tables included."""
    return re.sub(r"([\\`*_|<>\[\]])", r"\\\1", " ".join(text.split()))


def page_names(records: list[Record]) -> dict[str, str]:
    """File name of each submission's page; different ones for different submissions."""
    names: dict[str, str] = {}
    for r in sorted(records, key=lambda r: r["file"]):
        base = re.sub(r"[^\w.-]+", "_", r["file"]).strip("._")[:80] or "submission"
        name, n = f"{base}.md", 2
        while name.lower() in (x.lower() for x in names.values()):
            name, n = f"{base}-{n}.md", n + 1
        names[r["file"]] = name
    return names
