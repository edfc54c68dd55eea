"""The chapter template: sections, objectives, items, counts and alt text (book/build_notes.md).

`problems(notebook, name)` returns one sentence per fault, so that the test can also show that
each kind of fault is found.
"""

import copy
import importlib
import json
import re
from pathlib import Path

import pytest

from pfkit.labs import catalogue

ROOT = Path(__file__).resolve().parents[1]
NOTEBOOKS = ROOT / "notebooks"
CHAPTERS = sorted({*NOTEBOOKS.glob("[0-9][0-9]_*.ipynb")} - {*NOTEBOOKS.glob("00_*.ipynb")})

SECTIONS = [
    "What you will be able to do",
    "Predict first",
    "By hand",
    "The idea",
    "Code by hand",
    "The same with pfkit",
    "The picture to remember",
    "Play",
    "Break it",
    "Check yourself",
    "What you can now say",
    "Sources",
]
LIMITS = {
    "words": (2200, 3200),
    "code cells": (12, 20),
    "display equations": (10, 20),
    "figures": (6, 8),
    "explorables": (1, 1),
    "films": (0, 6),
    "items": (8, 40),
    "item types": (4, 6),
    "predictions": (2, 10),
    "experiments": (2, 10),
}
# (topic, what): (least, most, why)
EXCEPTIONS: dict[tuple[str, str], tuple[int, int, str]] = {
    ("exact_beliefs", "words"): (2200, 4000, "two sittings: cells, then Kalman's filter"),
    ("exact_beliefs", "code cells"): (12, 24, "two sittings"),
}

LAB_CALL = re.compile(r"\blab\.(check|use|predict|answer)\(\s*[\"']([\w.-]+)[\"']")


def text(cell):
    return "".join(cell["source"])


def is_lab_cell(cell):
    """Answer, check and solution cells are the student's; a removed cell is for Jupyter alone."""
    removed = "remove-cell" in cell["metadata"].get("tags", [])
    shown = text(cell).startswith(("lab.solution(", "lab.ask(", "lab.student("))
    return removed or shown or "answer" in cell["metadata"] or bool(LAB_CALL.search(text(cell)))


def has_figure(cell):
    return any("image/png" in out.get("data", {}) for out in cell.get("outputs", []))


def measure(notebook, items):
    """Count what the norms speak of."""
    prose = [text(c) for c in notebook["cells"] if c["cell_type"] == "markdown"]
    code = [c for c in notebook["cells"] if c["cell_type"] == "code"]
    everything = "\n".join(prose)
    read = re.sub(r"<!--.*?-->|(?<=\])\([^()\s]*\)", "", everything, flags=re.S)  # no targets
    used = {i for c in code for _, i in LAB_CALL.findall(text(c)) if i in items}
    kinds = [type(items[i]).__name__ for i in used]
    moving = re.findall(r"^[`:]{3,}\{explorable\}.*?^[`:]{3,}$", everything, flags=re.M | re.S)
    films = [directive for directive in moving if "\n:caption:" in directive]
    displayed = re.findall(r"\$\$.+?\$\$|```\{math\}", everything, flags=re.S)
    return {
        "words": len(re.findall(r"[A-Za-z']+", read)),
        "code cells": sum(not is_lab_cell(c) for c in code),
        "display equations": len(displayed),
        "figures": sum(map(has_figure, code)),
        "explorables": len(moving) - len(films),
        "films": len(films),
        "items": len(used),
        "item types": len(set(kinds)),
        "predictions": kinds.count("Prediction"),
        "experiments": kinds.count("Experiment"),
    }


def problems(notebook, name, items):
    """Every departure from the template, one sentence each."""
    found = []
    cells = notebook["cells"]
    fence = re.compile(r"```.*?```", re.S)
    headings = [
        (len(m[1]), m[2].strip())
        for c in cells
        if c["cell_type"] == "markdown"
        for m in re.finditer(r"^(#{1,6}) (.+)$", fence.sub("", text(c)), re.M)
    ]
    if [h for level, h in headings if level == 1] != [headings[0][1]]:
        found.append("the notebook must start with its only h1")
    second = [h for level, h in headings if level == 2]
    order = [h for h in second if h in SECTIONS]
    if order != SECTIONS:
        found.append(f"sections must be {SECTIONS}, got {order}")
    for key, value in measure(notebook, items).items():
        least, most, _ = EXCEPTIONS.get((name, key), (*LIMITS[key], ""))
        if not least <= value <= most:
            found.append(f"{key}: {value}, norm {least} to {most}")
    for cell in cells:
        if cell["cell_type"] != "code":
            continue
        lines = [line for line in text(cell).splitlines() if line.strip()]
        if len(lines) > 12 and not is_lab_cell(cell):
            found.append(f"cell {cell['id']} has {len(lines)} lines, norm 12")
        found += [
            f"cell {cell['id']} has a line longer than 88 characters: it would need scrolling"
            for line in lines
            if len(line) > 88
        ]
        alt = cell["metadata"].get("mystnb", {}).get("image", {}).get("alt", "")
        if has_figure(cell) and len(alt) < 30:
            found.append(f"figure in cell {cell['id']} needs alt text that says what it shows")
    return found + objective_problems(cells, items)


def objective_problems(cells, items):
    """Each objective names items that exist and that the chapter asks."""
    asked = {i for c in cells if c["cell_type"] == "code" for _, i in LAB_CALL.findall(text(c))}
    section = "\n".join(text(c) for c in cells if c["cell_type"] == "markdown")
    section = section.partition("## What you will be able to do")[2].partition("\n## ")[0]
    objectives = re.findall(r"^[-*\d.]+ (.+(?:\n  .+)*)", section, flags=re.M)
    found = [] if len(objectives) >= 3 else [f"only {len(objectives)} objectives, norm 3 or more"]
    for objective in objectives:
        named = re.search(r"\(checked by (.+?)\)", objective, flags=re.S)
        ids = re.findall(r"`([\w.-]+)`", named[1]) if named else []
        if not ids or any(i not in items or i not in asked for i in ids):
            found.append(f"objective names no item that is asked here: {objective[:60]}")
    return found


def load(path):
    """Return a chapter and the items of the module that its own cells import."""
    notebook = json.loads(path.read_text(encoding="utf-8"))
    (lab,) = catalogue.asked_in(notebook)
    return notebook, importlib.import_module(f"pfkit.labs.{lab}").LAB.items


@pytest.mark.parametrize("path", CHAPTERS, ids=lambda p: p.stem)
def test_chapter_follows_the_template(path):
    notebook, items = load(path)
    assert problems(notebook, path.stem[3:], items) == []


@pytest.mark.skipif(not CHAPTERS, reason="no chapter yet")
def test_each_kind_of_fault_is_found():
    path = CHAPTERS[0]
    good, items = load(path)

    def fault(change):
        broken = copy.deepcopy(good)
        change(broken["cells"])
        return " ".join(problems(broken, path.stem[3:], items))

    def drop_alt(cells):
        next(c for c in cells if has_figure(c))["metadata"] = {}

    def long_cell(cells):
        next(c for c in cells if has_figure(c))["source"] = [f"x{i} = {i}\n" for i in range(13)]

    def drop_section(cells):
        for c in cells:
            c["source"] = [line.replace("## Break it", "## Brake it") for line in c["source"]]

    def drop_item(cells):
        for c in cells:
            c["source"] = [line.replace("(checked by", "(held by") for line in c["source"]]

    assert "alt text" in fault(drop_alt)
    assert "norm 12" in fault(long_cell)
    assert "sections must be" in fault(drop_section)
    assert "names no item" in fault(drop_item)
    assert "words" in fault(lambda cells: cells.pop(2) and cells.__delitem__(slice(20, None)))
