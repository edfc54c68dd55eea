"""The instructor guide names what is not written yet, and commands that exist."""

import re
from pathlib import Path

from pfkit.labs.grade.__main__ import arguments

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "book/instructor.md").read_text(encoding="utf-8")


MAP = (ROOT / "book/map.md").read_text(encoding="utf-8")


def cells(page):
    """The rows of all tables of a page, each a list of cells."""
    rows = [line for line in page.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip()[1:-1].split("|")] for line in rows]


def plans(page):
    """The two plans of the guide: each a list of rows, a row a list of cells."""
    return [cells(part) for part in page.split("\n### ")[1:3]]


def waiting(plan):
    """What the last column of a plan says is still to come."""
    return {name.strip() for _, *_, last in plan[1:] for name in last.split(";") if name.strip()}


def test_the_plans_wait_for_what_the_map_announces():
    coming = {row[1] for row in cells(MAP) if row[2] == "to come"}
    seven, fourteen = plans(GUIDE)
    assert waiting(seven) <= coming
    assert coming - waiting(fourteen) <= {"Appendix: fast"}  # which no week reads


def test_the_plans_read_every_chapter_that_is_ready():
    for plan in plans(GUIDE):
        read = re.findall(r"\(\.\./notebooks/(\d\d_\w+\.ipynb)\)", " ".join(row[1] for row in plan))
        there = [p.name for p in sorted((ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb"))]
        assert read == there[1:]


def test_its_commands_are_understood(tmp_path):
    commands = re.findall(r"python -m pfkit\.labs\.grade (lab3 (?:.|\\\n)+?)\n```", GUIDE)
    assert len(commands) == 2
    for command in commands:
        words = command.replace("\\\n", " ").split()
        words[1] = str(tmp_path)  # the folder of submissions
        words[words.index("-o") + 1] = str(tmp_path / "grades.csv")
        assert arguments(words).lab == "lab3"


def test_every_status_and_output_is_explained():
    for name in ("ok", "errors", "missing", "timeout", "crashed", "malformed", "review"):
        assert f"| `{name}` |" in GUIDE
    for name in ("grades.csv", "grades_items.csv", "grades_reports/", "grades.jsonl"):
        assert f"| `{name}` |" in GUIDE
