"""Every number in the prose comes from a cell, and this tool sees to it.

A result is written in the text with a comment behind it that names the line of output it is from:

    The filter stays within 0.06<!--= RMSE --> m of the truth.

Readers, in the book and in Jupyter, see `0.06`. The comment names what stands before the number
in a printed line, from the start of that line (`RMSE of filter` in `RMSE of filter = 0.0581 m`);
case and punctuation do not matter. Further forms: `label [2]` is the second number behind the
label, `label * 100` a percentage, `particle_filter#label` a line of the notebook on that topic. The
number must be the printed one, rounded to the decimals the text shows.

Numbers without a comment must occur in the code or output of the notebook, except whole numbers up
to 20, years, and numbers that name something (Figure 7, Table 4.4). A fact that no cell can give,
say from a paper, is marked `1,354<!--given-->`.

    python tools/prose_numbers.py --check [FILE ...]    list what does not agree
    python tools/prose_numbers.py --fill  [FILE ...]    write the printed values into the text
    python tools/prose_numbers.py --labels FILE         list the lines a notebook offers
"""

from __future__ import annotations

import argparse
import math
import re
import sys
from pathlib import Path
from typing import NamedTuple

import stamps
from stamps import ROOT

NUMBER = r"[-−+]?(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?(?:[eE][-+]?\d+)?|[-−+]?\.\d+"
MARK = re.compile(rf"(?P<number>{NUMBER})(?P<tail>[*_%°]*)<!--(?P<rule>=[^>]*?|given\s*)-->")
RULE = re.compile(
    r"=\s*(?:(?P<page>[\w/]+)#)?(?P<label>.+?)\s*(?:\[(?P<nth>\d+)\])?\s*(?:\*\s*(?P<times>[\d.]+))?\s*$"
)
FREE_UP_TO = 20
# Text in which numbers mean something else: options of a question, which tools/options.py writes,
# code, mathematics, links, names of things, dates.
NOT_PROSE = re.compile(
    r"<!--options of \w+-->\n(?:\* [^\n]*(?:\n|\Z))*|"
    r"```.*?```|`[^`]*`|\$\$.*?\$\$|\$[^$]*\$|<!--.*?-->|\{[\w:-]+\}`[^`]*`|\]\([^)]*\)|<[^>]+>"
    r"|^:[\w-]+:.*?$|^#+ .*?$|^\([\w-]+\)=$|\bv?\d+\.\d+\.\d+\b|[A-Za-z]+[-_]?\d[\w.]*"
    r"|\b(?:1[89]|20)\d\d\b"
    r"|\b(?:[Cc]hapter|[Ll]ab|[Tt]able|[Ff]igure|[Ee]quation|[Ss]ection|[Pp]art|[Ss]eed|pages?|pp?\.)s?"
    r" \d[\d.]*(?:(?:,| and| to|-|–) ?\d[\d.]*)*",
    re.DOTALL | re.MULTILINE,
)


class Fault(NamedTuple):
    """A number in the prose that does not come from a cell."""

    cell: str
    text: str
    reason: str


def value(text: str) -> float:
    """Read a number as people write it: thousands commas, a true minus sign."""
    return float(text.replace(",", "").replace("−", "-"))


def decimals(text: str) -> int:
    """Count the decimals shown."""
    return len(text.split(".")[1]) if "." in text else 0


def agrees(shown: str, exact: float) -> bool:
    """Say whether the shown number is the exact one, rounded to the decimals shown."""
    if "e" in shown.lower():
        return math.isclose(value(shown), exact, rel_tol=0.05)
    half = 0.5 * 10.0 ** -decimals(shown)
    return abs(value(shown) - exact) <= half * (1 + 1e-9) + 1e-12 * abs(exact)


def slug(label: str) -> str:
    """Reduce a label to its words, so that case and punctuation do not matter."""
    return " ".join(re.findall(r"[^\W_]+", label.lower().replace("_", " ")))


def printed(cell: dict) -> str:
    """Return the text a cell printed or showed as its result."""
    parts = []
    for output in cell["outputs"]:
        parts.append(output.get("text", "") if output.get("name") == "stdout" else "")
        parts.append(output.get("data", {}).get("text/plain", ""))
    return "\n".join(parts)


def lines(notebook: dict) -> list[str]:
    """Return every line that the cells of a notebook print, each once."""
    cells = stamps.code_cells(notebook)
    return list(dict.fromkeys(line for cell in cells for line in printed(cell).splitlines()))


def numbers_behind(label: str, line: str) -> list[float]:
    """Return the numbers of a line behind its label, or none if the line has another label."""
    words = r"[\W_]+".join(map(re.escape, slug(label).split()))
    start = re.match(rf"[\W_]*{words}(?![^\W_])[^A-Za-z]*?(?=(?:{NUMBER}))", line, re.IGNORECASE)
    rest = line[start.end() :] if start else ""
    return [value(match) for match in re.findall(rf"(?<![\w.])(?:{NUMBER})", rest)]


def notebook_on(topic: str, folder: Path) -> Path:
    """Return the chapter on a topic, or another notebook by its name; LookupError if none."""
    found = [*folder.glob(f"[0-9][0-9]_{topic}.ipynb"), *folder.glob(f"{topic}.ipynb")]
    if len(found) != 1:
        raise LookupError(f"there is no notebook on {topic}")
    return found[0]


def look_up(rule: str, notebook: dict, folder: Path) -> float:
    """Return the printed value that a comment names; raise LookupError with the reason if none."""
    match = RULE.match(rule)
    if match is None:
        raise LookupError("the comment does not read <!--= label -->")
    if match["page"]:
        notebook = stamps.read(notebook_on(match["page"], folder))
    rows = [row for line in lines(notebook) if (row := numbers_behind(match["label"], line))]
    if not rows:
        raise LookupError(f"no cell prints a line that starts with {match['label'].strip()!r}")
    nth = int(match["nth"] or 1)
    choices = {row[nth - 1] for row in rows if len(row) >= nth}
    if len(choices) != 1:
        raise LookupError(f"lines that start with it give {sorted(choices) or 'no such number'}")
    return choices.pop() * float(match["times"] or 1)


def in_cells(notebook: dict) -> set[float]:
    """Collect every number that occurs in the code or the output of a notebook."""
    text = "\n".join(cell["source"] + "\n" + printed(cell) for cell in stamps.code_cells(notebook))
    text = text.replace("_", "")
    return {value(match) for match in re.findall(rf"(?:{NUMBER})", text)}


def faults_of_text(text: str, name: str, notebook: dict, folder: Path) -> list[Fault]:
    """List the numbers of one text that their comment contradicts, or that no cell contains."""
    found = []
    for mark in MARK.finditer(text):
        if mark["rule"].startswith("given"):
            continue
        try:
            exact = look_up(mark["rule"], notebook, folder)
        except LookupError as error:
            found.append(Fault(name, mark.group(), str(error)))
            continue
        if not agrees(mark["number"], exact):
            found.append(Fault(name, mark.group(), f"the cell prints {exact:g}"))
    if notebook["cells"]:
        found += [Fault(name, shown, "occurs in no cell") for shown in unmarked(text, notebook)]
    return found


def unmarked(text: str, notebook: dict) -> list[str]:
    """List the numbers without a comment that occur in no code cell and no output."""
    known = in_cells(notebook)
    prose = NOT_PROSE.sub(" ", MARK.sub(" ", text))
    missing = []
    for match in re.finditer(rf"(?<![\w.,])(?:{NUMBER})(?P<percent> ?%)?", prose):
        shown = match.group().rstrip(" %").lstrip("-−+")
        exact = value(shown)
        if exact == int(exact) and exact <= FREE_UP_TO and not decimals(shown):
            continue
        scales = (1.0, 100.0) if match["percent"] else (1.0,)
        if not any(agrees(shown, abs(k) * scale) for k in known for scale in scales):
            missing.append(shown)
    return missing


def texts(path: Path) -> tuple[dict, list[tuple[str, str]]]:
    """Read a page: its notebook (empty for Markdown) and its texts with a name each."""
    if path.suffix == ".md":
        return {"cells": []}, [(path.name, path.read_text(encoding="utf-8"))]
    notebook = stamps.read(path)
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "markdown"]
    return notebook, [(cell.get("id", "?"), cell["source"]) for cell in cells]


def check(path: Path) -> list[Fault]:
    """List the faults of one page."""
    notebook, parts = texts(path)
    folder = ROOT / "notebooks"
    return [fault for name, text in parts for fault in faults_of_text(text, name, notebook, folder)]


def filled(text: str, notebook: dict, folder: Path) -> str:
    """Write the printed value, with as many decimals as before, in front of each comment."""

    def fill(mark: re.Match[str]) -> str:
        if mark["rule"].startswith("given"):
            return mark.group()
        exact = look_up(mark["rule"], notebook, folder)
        if agrees(mark["number"], exact):
            return mark.group()
        comma = "," if "," in mark["number"] or abs(exact) >= 10_000 else ""
        return f"{exact:{comma}.{decimals(mark['number'])}f}{mark['tail']}<!--{mark['rule']}-->"

    return MARK.sub(fill, text)


def fill_file(path: Path) -> None:
    """Bring the marked numbers of one page up to date."""
    folder = ROOT / "notebooks"
    if path.suffix == ".md":
        text = path.read_text(encoding="utf-8")
        path.write_text(filled(text, {"cells": []}, folder), encoding="utf-8", newline="\n")
        return
    import notebooks

    notebook = stamps.read(path)
    for cell in notebook["cells"]:
        if cell["cell_type"] == "markdown":
            cell["source"] = filled(cell["source"], notebook, folder)
    notebooks.write(path, notebook)


def pages() -> list[Path]:
    """Return every page that may hold numbers: notebooks and Markdown."""
    tops = (
        ("book", "*.md"),
        *((top, "*.ipynb") for top in ("book", "notebooks", "notebooks/labs")),
    )
    return sorted(path for top, kind in tops for path in (ROOT / top).glob(kind))


def main() -> int:
    """Parse the command line and run it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="*", type=Path)
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--check", action="store_true", help="list what does not agree (default)")
    action.add_argument("--fill", action="store_true", help="write the printed values")
    action.add_argument("--labels", action="store_true", help="list the lines with numbers")
    options = parser.parse_args()
    chosen = options.files or pages()
    bad = 0
    for path in chosen:
        if options.labels:
            print("\n".join(line for line in lines(stamps.read(path)) if re.search(r"\d", line)))
            continue
        if options.fill:
            fill_file(path)
        for fault in check(path):
            bad += 1
            print(f"{path.name}, cell {fault.cell}: {fault.text}: {fault.reason}")
    if not options.labels:
        print(f"{len(chosen)} pages, {bad} numbers that do not come from a cell")
    return min(bad, 1)


if __name__ == "__main__":
    sys.exit(main())
