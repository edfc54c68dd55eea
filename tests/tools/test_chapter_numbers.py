"""Renaming files renumbers the course: tried on a copy of it, and on texts with each fault."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

import chapter_numbers as tool
import pytest
import stamps
from stamps import ROOT

NUMBER = {"tea": 3, "cake": 11}


def test_every_number_is_that_of_its_file():
    assert tool.problems() == []


def test_code_names_no_chapter_by_its_number():
    topics = "|".join(tool.chapters())
    named = re.compile(rf"(?<!\w)\d\d_(?:{topics})(?!\w)|\b[Cc]hapters? \d")
    tops = ("pfkit", "tests", "tools", "book/_ext", "book/live", "benchmarks")
    files = {path for top in tops for path in (ROOT / top).rglob("*.*")} - {Path(__file__)}
    code = [path for path in files if path.suffix in (".py", ".pyi", ".js", ".css")]
    assert len(code) > 100
    found = {path.name: hit for path in code if (hit := named.findall(path.read_text("utf-8")))}
    assert found == {}


# ---------------------------------------------------------------- texts


@pytest.mark.parametrize(
    ("written", "reads"),
    [
        ("[chapter 9](09_tea.ipynb) and more", "[chapter 3](03_tea.ipynb) and more"),
        ("[Chapter 3](../03_cake.ipynb#bake)", "[Chapter 11](../11_cake.ipynb#bake)"),
        ("[0](00_tea.ipynb) to [0](0/00_cake.ipynb)", "[3](03_tea.ipynb) to [11](0/11_cake.ipynb)"),
        ("[a good cup](44_tea.ipynb)", "[a good cup](03_tea.ipynb)"),
        ("  - file: notebooks/44_tea", "  - file: notebooks/03_tea"),
        ("[chapter 9](09_teapot.ipynb), 2019_tea, x09_tea",) * 2,
        ("ch. 6, Table 4.4 and 09 tea",) * 2,
    ],
)
def test_filling_a_text(written, reads):
    assert tool.filled(written, NUMBER) == reads
    assert tool.filled(reads, NUMBER) == reads


# ---------------------------------------------------------------- a copy of the course


@pytest.fixture
def course(tmp_path):
    """A copy of every page that may name a chapter."""
    for path in tool.pages():
        copy = tmp_path / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, copy)
    assert tool.problems(tmp_path) == []
    return tmp_path


def rename(course: Path, step: int, first: int = 1) -> None:
    """Give every chapter from `first` on another number, touching no text."""
    files = [path for path in tool.chapters(course).values() if int(path.name[:2]) >= first]
    for path in sorted(files, reverse=step > 0):
        path.rename(path.with_name(f"{int(path.name[:2]) + step:02}{path.name[2:]}"))


def fill(course: Path) -> None:
    for path in tool.pages(course):
        tool.fill(path, course)


def words(course: Path) -> dict[str, str]:
    """All texts, by topic, without the digits."""
    return {
        re.sub(r"\d", "", path.name): re.sub(r"\d", "", "\n".join(tool.texts(path)))
        for path in tool.pages(course)
    }


def programs(course: Path) -> list[str]:
    """All code cells with their outputs."""
    return [json.dumps(stamps.code_cells(stamps.read(p))) for p in tool.chapters(course).values()]


def add_line_behind(path: Path, mark: str, line: str) -> None:
    """Insert a line behind the one line that holds the mark."""
    rows = path.read_text(encoding="utf-8").splitlines()
    (place,) = (n for n, row in enumerate(rows) if mark in row)
    path.write_text("\n".join([*rows[: place + 1], line, *rows[place + 1 :], ""]), "utf-8")


def test_a_chapter_is_inserted_by_renaming_and_filling(course):
    before, code = words(course), programs(course)
    old = tool.numbers(course)
    behind = list(old)[2]
    new = old[behind] + 1
    rename(course, 1, first=new)
    text = "# Afternoon tea\n\nSee [chapter 0](00_resampling.ipynb)."
    cell = {"cell_type": "markdown", "id": "a", "metadata": {}, "source": text}
    page = {"cells": [cell], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    target = course / "notebooks" / f"{new:02}_tea.ipynb"
    target.write_text(json.dumps(page), "utf-8")
    add_line_behind(course / "_toc.yml", f"_{behind}", f"      - file: notebooks/{new:02}_tea")
    row = "| 0 | [Afternoon tea](../notebooks/00_tea.ipynb) | ready | pour |"
    add_line_behind(course / tool.MAP, f"_{behind}.ipynb", row)
    assert len(tool.problems(course)) > 20
    fill(course)
    assert tool.problems(course) == []
    assert tool.texts(target) == [
        f"# {new}. Afternoon tea\n\nSee [chapter {old['resampling'] + 1}]"
        f"({old['resampling'] + 1:02}_resampling.ipynb)."
    ]
    now = tool.numbers(course)
    assert {t: now[t] - old[t] for t in old} == {t: int(old[t] >= new) for t in old}
    for topic, path in tool.chapters(course).items():
        assert now[topic] == 0 or tool.texts(path)[0].startswith(f"# {now[topic]}. ")
    target.unlink()
    assert programs(course) == code  # no cell has become stale
    after = words(course)
    assert {name for name in before if before[name] != after[name]} == {"_toc.yml", "map.md"}


def test_taken_back_no_byte_has_changed(course):
    before = {path.name: path.read_bytes() for path in tool.pages(course)}
    original = (course / tool.MAP).read_text(encoding="utf-8")
    longer = original.replace("| 1 |", "| 0 | Before everything | to come | wait |\n| 1 |", 1)
    for step, table in ((1, longer), (-1, original)):
        rename(course, step)
        (course / tool.MAP).write_text(table, "utf-8", newline="\n")
        fill(course)
        assert tool.problems(course) == []
    assert {path.name: path.read_bytes() for path in tool.pages(course)} == before


def test_filling_again_changes_nothing(course):
    assert not any(tool.fill(path, course) for path in tool.pages(course))


@pytest.mark.parametrize(
    ("page", "old", "new", "fault"),
    [
        ("book/tour.md", "# ", "# As chapter 8 says: ", "not bound to a file"),
        ("book/tour.md", "# ", "# [Chapter 8](08_dinner.ipynb) ", "there is no 08_dinner.ipynb"),
        ("book/tour.md", "# ", "# [Chapter 99](99_resampling.ipynb) ", "to be filled"),
        ("README.md", "# ", "# [99](99_resampling.ipynb) ", "to be filled"),
        ("book/map.md", "| 1 |", "| 4 |", "to be filled"),
        ("_toc.yml", "notebooks/01_", "notebooks/99_", "numbers must rise"),
    ],
)
def test_each_fault_is_found(course, page, old, new, fault):
    path = course / page
    path.write_text(path.read_text(encoding="utf-8").replace(old, new, 1), "utf-8")
    assert fault in " ".join(tool.problems(course))


def test_rows_of_the_map_out_of_order_are_found(course):
    path = course / tool.MAP
    rows = path.read_text(encoding="utf-8").splitlines()
    a, b = [n for n, row in enumerate(rows) if "| ready |" in row and tool.ROW.match(row)][:2]
    rows[a], rows[b] = rows[b], rows[a]
    path.write_text("\n".join(rows), "utf-8")
    fill(course)
    assert "rows stand in the course's order" in " ".join(tool.problems(course))


@pytest.mark.parametrize("name", ["09_tea.ipynb", "44_resampling.ipynb"])
def test_one_number_and_one_topic_belong_to_one_chapter(course, name):
    (course / "notebooks" / name).write_text("{}", "utf-8")
    with pytest.raises(ValueError, match="one chapter, one number"):
        tool.chapters(course)
