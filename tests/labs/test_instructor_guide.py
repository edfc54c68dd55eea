"""The instructor guide names what is not written yet, and commands that exist."""

import re
from pathlib import Path

from pfkit.labs.grade.__main__ import arguments

ROOT = Path(__file__).parents[2]
GUIDE = (ROOT / "book/instructor.md").read_text(encoding="utf-8")


def numbers(words):
    return {int(n) for n in re.findall(r"\d+", words)}


def test_it_is_true_what_is_not_written_yet():
    told = re.search(r"Chapters ([\d, and]+) and labs ([\d, and]+) are not written yet", GUIDE)
    there = {int(p.name[:2]) for p in (ROOT / "notebooks").glob("[0-9][0-9]_*.ipynb")}
    labs = {int(p.name[3]) for p in (ROOT / "notebooks/labs").glob("lab[0-9]_*.ipynb")}
    assert numbers(told[1]) == set(range(1, 15)) - there
    assert numbers(told[2]) == set(range(1, 7)) - labs


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
