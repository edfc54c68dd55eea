"""How sure is each check? Replay right and wrong answers, and keep the rates in a table.

    make replay                        every item whose rates are out of date
    python tools/run.py replay --all   all of them (weekly; some twenty minutes)
    python tools/run.py replay --check the table is true: what is out of date is replayed and
                                       compared with the declaration, and so is a tenth of the rest

For a function (C) the near-right programs must be refused, for an experiment (X) the reference must
pass 3,000 times, each lazy answer must be refused (with its own hint or none) and each
misconception named in at least 95 % of 200 replays. All of the first 60 are enough: with 95 %
confidence that is a share above 95 %. The table, `tests/labs/rates.json`, is stamped
by the modules that a lab loads; the page *How sure is a check?* is filled from it.
"""

from __future__ import annotations

import argparse
import datetime
import hashlib
import json
import subprocess
import sys
import time
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from environment import ROOT, say
from stamps import file_digest

TABLE = ROOT / "tests" / "labs" / "rates.json"
PAGE = ROOT / "book" / "how_sure_is_a_check.md"
START, END = "<!-- rates: filled by make replay -->", "<!-- end of rates -->"
DECISIONS, TRIES, ENOUGH = 3_000, 200, 60
FEWER = 3  # sets of settings for a wrong answer: it is replayed beside a dozen others
LEAST = 0.95  # share of replays in which a wrong answer must be refused, or named
LAZY = {"C": 3, "X": 5}  # wrong answers an item must be known to refuse
COPIES = {"one-call"}  # wrong answers whose runs are copies of each other
PARTS = 10  # that the weeks take turns with
# Labs whose chapters are still to be rebuilt: their items need not have such lists yet.
PENDING = ("sensing", "outliers", "real_robot")
# Labs whose rates are still to be measured: the replays of their long films take an hour.
UNMEASURED = ("lab3", "lab4")
# Answers that are refused, or named, in fewer replays than we ask: (lab, item, what it says).
# The page shows them, and the tests that each is still short.
SHORT = {("particle_filter", "frozen_x", "moves the copies apart with noise")}


def rates_of(item: Any) -> dict[str, Any]:
    """Replay one item: how often a right answer fails, a wrong one is refused and named."""
    from pfkit.labs import Experiment, replay
    from pfkit.labs.replay import in_its_own_way

    if not isinstance(item, Experiment):
        return {
            "right": [sum(item.judge(item.reference).fraction < 1 for _ in range(2)), 2],
            "refused": {r.says: _judged(item, r.example, r.named) for r in item.refused},
            "named": {m.name: _judged(item, m.example, m.name) for m in item.misconceptions},
        }
    alike = item.settings is not None  # beside itself on the same seeds nothing can fail
    right = replay(item, in_its_own_way(item.reference) if alike else item.reference, DECISIONS)
    pool = max(min(item.pool, 600) // 4, 3 * item.runs)

    def share(example: Any, name: str, tries: int) -> float:
        rate = replay(item, example, tries, pool, fresh=name in COPIES, worlds=FEWER)
        return round(rate.misconceptions.get(name, 0) / rate.decisions, 3)

    def wrong(example: Any, name: str) -> float:
        first = share(example, name, ENOUGH)
        return first if first == 1 else share(example, name, TRIES)

    return {
        "right": [right.fails, right.decisions],
        "refused": {r.says: wrong(r.example, r.named) for r in item.refused},
        "named": {m.name: wrong(m.example, m.name) for m in item.misconceptions},
    }


def _judged(item: Any, example: Any, name: str) -> float:
    """Share of tries in which a program is refused, and earns the hint it must (or none)."""
    import numpy as np

    hits = 0
    for seed in range(3):
        np.random.seed(seed)  # noqa: NPY002  programs that draw from the global generator
        judged = item.judge(example)
        found = judged.misconception.name if judged.misconception else ""
        hits += judged.fraction < 1 and found == name
    return round(hits / 3, 3)


def measure(lab: str, wanted: Iterable[str] | None = None) -> dict[str, Any]:
    """Rates of a lab's C and X items, and the modules that it loads. Runs in this process."""
    from importlib import import_module

    items = import_module(f"pfkit.labs.{lab}").LAB.items
    found = {}
    for name, item in items.items():
        if item.letter in LAZY and (wanted is None or name in wanted):
            start = time.monotonic()
            found[name] = {"letter": item.letter, "title": item.title, **rates_of(item)}
            say(f"{lab} {name}: {time.monotonic() - start:.1f} s")
    loaded = (getattr(m, "__file__", None) for n, m in sys.modules.items() if n.startswith("pfkit"))
    files = sorted(str(ROOT.joinpath(f).relative_to(ROOT)) for f in loaded if f)
    return {"files": files, "items": found}


def stamp(files: Iterable[str]) -> str:
    """Hash the program of the modules that a lab loads."""
    digest = hashlib.sha256()
    for name in files:
        path = ROOT / name
        digest.update(f"{name} {file_digest(path) if path.is_file() else 'missing'}\n".encode())
    return digest.hexdigest()[:16]


def read_table() -> dict[str, Any]:
    """The committed table; empty if there is none."""
    return json.loads(TABLE.read_text(encoding="utf-8")) if TABLE.exists() else {}


def stale_labs(table: dict[str, Any], labs: Iterable[str]) -> list[str]:
    """Labs whose rates are missing or were measured on another program."""
    return [n for n in labs if n not in table or stamp(table[n]["files"]) != table[n]["stamp"]]


def in_a_process(lab: str, items: Iterable[str] = ()) -> subprocess.Popen:
    """Measure one lab in a process of its own, so that it loads what it needs and no more."""
    command = [sys.executable, __file__, "--lab", lab, "--items", *items]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)


def two_at_a_time(jobs: list[tuple[str, list[str]]]) -> dict[str, dict[str, Any]]:
    """Run jobs (lab, items) on two cores; raises RuntimeError if one fails."""

    def one(job: tuple[str, list[str]]) -> tuple[str, dict[str, Any]]:
        lab, items = job
        process = in_a_process(lab, items)
        text, _ = process.communicate()
        if process.returncode:
            raise RuntimeError(f"replaying {lab} failed; its reason is above")
        return lab, json.loads(text.splitlines()[-1])

    with ThreadPoolExecutor(2) as pool:
        found = dict(pool.map(one, jobs))
    return found


def problems(lab: str, items: dict[str, Any]) -> list[str]:
    """What the rates of a lab's items fail to hold."""
    found = []
    for name, rates in items.items():
        where = f"{lab} {name}"
        if rates["right"][0]:
            found.append(
                f"{where}: a right answer fails {rates['right'][0]} of {rates['right'][1]}"
            )
        for kind in ("refused", "named"):
            for says, share in rates[kind].items():
                if share < LEAST and (lab, name, says) not in SHORT:
                    found.append(f"{where}: {kind} in only {100 * share:.0f} %: {says}")
        wrong = len(rates["refused"]) + (len(rates["named"]) if rates["letter"] == "C" else 0)
        least = LAZY[rates["letter"]]
        if lab not in PENDING and wrong < least:
            found.append(f"{where}: knows {wrong} answers that must not pass, not {least}")
    return found


def page_table(table: dict[str, Any]) -> str:
    """The table of the page, a row an item."""
    rows = [
        "| lab | item | type | right answers that fail | lazy or near-right answers refused "
        "| misconceptions named |",
        "|---|---|---|---|---|---|",
    ]
    for lab in sorted(table):
        for name, rates in sorted(table[lab]["items"].items()):
            fails, of = rates["right"]
            refused, named = rates["refused"].values(), rates["named"].values()
            right = f"{fails} of {of:,}" if rates["letter"] == "X" else "none: same every time"
            rows.append(
                f"| {lab} | {name} | {rates['letter']} | {right} | {_least(refused)} "
                f"| {_least(named)} |"
            )
    return "\n".join(rows)


def _least(shares: Iterable[float]) -> str:
    """``7, at least 98 %``."""
    all_of = list(shares)
    return f"{len(all_of)}, at least {100 * min(all_of):.0f} %" if all_of else "not known yet"


def shortfalls(table: dict[str, Any]) -> str:
    """A list of what is refused or named less often than we ask."""
    rows = []
    for lab, name, says in sorted(SHORT):
        rates = table[lab]["items"][name]
        kind = "named" if says in rates["named"] else "refused"
        rows.append(f"* {lab} `{name}`, {kind} in {100 * rates[kind][says]:.0f} %: {says}")
    return "\n".join(["", "Known to fall short:", "", *rows, ""]) + "\n" if rows else "\n"


def fill_page(table: dict[str, Any]) -> str:
    """The page's text with the table of now."""
    text = PAGE.read_text(encoding="utf-8")
    head, _, rest = text.partition(START)
    missing = f"Not measured yet: {', '.join(UNMEASURED)}.\n" if UNMEASURED else ""
    filled = "\n".join([START, page_table(table), shortfalls(table) + missing + END])
    return head + filled + rest.partition(END)[2]


def write(table: dict[str, Any]) -> None:
    """Store the table and fill the page."""
    text = json.dumps(table, indent=1, sort_keys=True, ensure_ascii=False)
    TABLE.write_text(text + "\n", encoding="utf-8")
    PAGE.write_text(fill_page(table), encoding="utf-8")


def renew(labs: list[str]) -> int:
    """Measure labs anew, store what was found, and say what does not hold."""
    table = read_table()
    found = two_at_a_time([(lab, []) for lab in labs])
    for lab, new in found.items():
        table[lab] = {**new, "stamp": stamp(new["files"])}
    write(table)
    return tell([p for lab in labs for p in problems(lab, table[lab]["items"])])


def check(names: list[str]) -> int:
    """Replay what is out of date and this week's tenth of the rest; compare with the table."""
    table = read_table()
    wrong = [p for lab in table for p in problems(lab, table[lab]["items"])]
    wrong += [f"{lab} is in the table and gone" for lab in table if lab not in names]
    if table and PAGE.read_text(encoding="utf-8") != fill_page(table):
        wrong.append(f"{PAGE.name} shows another table: make replay")
    stale = stale_labs(table, names)
    week = datetime.date.today().isocalendar().week % PARTS
    rest = [(lab, i) for lab in names if lab not in stale for i in table[lab]["items"]]
    chosen: dict[str, list[str]] = {lab: [] for lab in stale}
    again = rest[week::PARTS]
    say(f"{len(stale)} labs changed; of the other {len(rest)} items {len(again)} are tried again")
    for lab, item in again:
        chosen.setdefault(lab, []).append(item)
    for lab, new in two_at_a_time(list(chosen.items())).items():
        wrong += problems(lab, new["items"])
        kept = table.get(lab, {"items": {}})["items"]
        if lab not in stale:
            wrong += [
                f"{lab} {i}: another outcome than the table's: make replay ARGS=--all"
                for i, rates in new["items"].items()
                if not _alike(rates, kept[i])
            ]
    if stale:
        say(f"rates are out of date, renew them with make replay: {', '.join(stale)}")
    return tell(wrong)


def _alike(a: dict[str, Any], b: dict[str, Any]) -> bool:
    """The same lists, and shares that agree but for the last digits of another processor."""
    return all(
        a[kind].keys() == b[kind].keys()
        and all(abs(a[kind][says] - b[kind][says]) <= 0.03 for says in a[kind])
        for kind in ("refused", "named")
    )


def tell(wrong: list[str]) -> int:
    """Print what does not hold; the exit status."""
    print("\n".join(wrong))
    say(f"{len(wrong)} problems" if wrong else "both error rates of every item hold")
    return 1 if wrong else 0


def main() -> int:
    """Parse the command line and run it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--all", action="store_true", help="measure every lab")
    parser.add_argument("--check", action="store_true", help="compare with the table")
    parser.add_argument("--lab", help="measure one lab and print its rates as JSON")
    parser.add_argument("--items", nargs="*", default=[], help="with --lab: only these")
    options = parser.parse_args()
    if options.lab:
        sys.stdout, out = sys.stderr, sys.stdout
        print(json.dumps(measure(options.lab, options.items or None)), file=out)
        return 0
    from pfkit.labs import catalogue

    names = [name for name in catalogue.names() if name not in UNMEASURED]
    if options.check:
        return check(names)
    return renew(names if options.all else stale_labs(read_table(), names))


if __name__ == "__main__":
    sys.exit(main())
