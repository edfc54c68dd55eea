"""A change makes stale what reaches it, and nothing else: four modules, every notebook.

What a notebook can reach is worked out from the sources alone: the names its cells take from the
package, the modules they stand in, and what those import. The stamps come from what was loaded when
the notebook ran. The two must agree.
"""

from __future__ import annotations

import re

import pytest
import stamps
from test_rooms import FILES, imports, longest

import notebooks
from pfkit.rooms import HOME

ROOT = stamps.ROOT
ALL = notebooks.find([])
SOURCES = {name: path.read_text(encoding="utf-8") for name, path in FILES.items()}


def named(source: str) -> set[str]:
    """The modules that some code names: by import, or as a name of the package."""
    used = {full.removeprefix("pfkit.") for full, _ in imports(source) if full.startswith("pfkit.")}
    used |= {
        HOME[n].removeprefix("pfkit.") for n in re.findall(r"\bpf\.(\w+)", source) if n in HOME
    }
    used |= {"worlds.arenas"} if "worlds." in source else set()
    used |= {"judging.study"} if "pf.study" in source else set()
    return {longest(name, SOURCES) for name in used} & set(SOURCES)


def reach(start: set[str]) -> set[str]:
    """Everything that these modules import, by whatever way."""
    found, todo = set(), set(start)
    while todo:
        name = todo.pop()
        found.add(name)
        todo |= named(SOURCES[name]) - found
    return found


def code_of(notebook: dict) -> str:
    lines = "\n".join(cell["source"] for cell in stamps.code_cells(notebook)).splitlines()
    return "\n".join(line for line in lines if not line.startswith("%"))


def stale_after_an_edit(module: str, monkeypatch) -> set[str]:
    """The notebooks that are stale when one line is added to a module."""
    real = stamps.file_digest
    monkeypatch.setattr(
        stamps, "file_digest", lambda p: "edited" if p == FILES[module] else real(p)
    )
    return {path.name for path in ALL if stamps.why_stale(stamps.read(path))}


@pytest.mark.parametrize(
    "module", ["filters.kld", "exact.gridfilter", "particles.genealogy", "judging.localise"]
)
def test_one_changed_line_makes_stale_what_reaches_it_and_nothing_else(module, monkeypatch):
    books = {path.name: stamps.read(path) for path in ALL}
    may = {n for n, book in books.items() if module in reach(named(code_of(book)))}
    must = {n for n, book in books.items() if module in named(code_of(book))}
    stale = stale_after_an_edit(module, monkeypatch)
    assert must <= stale <= may < set(books)
    assert stale or module == "filters.kld", "the check needs a module that some notebook uses"


def test_the_names_of_the_table_are_no_dependency(tmp_path):
    table, module = FILES["rooms"], FILES["geometry"]
    found = notebooks.dependencies([], [str(table), str(module)], tmp_path / "a.ipynb")
    assert found == ["pfkit/geometry.py"]
