"""Write what follows from the table of rooms: the stub for editors, the pages on the package.

    python tools/rooms.py            write pfkit/__init__.pyi, book/api*.md
    python tools/rooms.py --check    write nothing; list what is out of date

The table is pfkit/rooms.py. A title of a page is the first words of the room's own docstring.
"""

from __future__ import annotations

import ast
import re
import runpy
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TABLE = runpy.run_path(str(ROOT / "pfkit" / "rooms.py"))
CORE: dict[str, dict[str, str]] = TABLE["CORE"]
GROUND = """The ground: errors, angles, densities.

Errors that name the remedy, poses in the plane, and the densities that all models are built from.
"""
PAGE = """\
# {title}

{about}
"""
ENTRY = """
## {name}

```{{eval-rst}}
.. automodule:: pfkit.{module}
   :members:
```
"""


def about(room: str) -> str:
    """The docstring of a room, or what stands for it where a room is no folder."""
    path = ROOT / "pfkit" / room / "__init__.py"
    if not path.exists():
        return GROUND
    return ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""


def title(room: str) -> str:
    """What stands before the first colon."""
    return about(room).partition(":")[0]


def page(room: str) -> str:
    """The page of a room: what it is for, then its modules in the order of the table."""
    text = "```{eval-rst}\n" + about(room).partition("\n\n")[2].strip() + "\n```"
    entries = (ENTRY.format(name=m.rpartition(".")[2], module=m) for m in CORE[room])
    return PAGE.format(title=title(room), about=text) + "".join(entries)


def contents() -> str:
    """The list of pages for book/api.md."""
    rows = []
    for room, modules in CORE.items():
        names = ", ".join(f"`{m.rpartition('.')[2]}`" for m in modules)
        rows.append(f"| [{title(room)}](api_{room}.md) | {names} |")
    return "| room | its modules, in reading order |\n|---|---|\n" + "\n".join(rows)


def stub() -> str:
    """The stub of the package: every public name, imported from where it stands."""
    lines = ["# Written by tools/rooms.py from pfkit/rooms.py: what the package loads on demand."]
    for modules in CORE.values():
        for module, names in modules.items():
            listed = sorted(names.split())
            lines += [f"from pfkit.{module} import {name} as {name}" for name in listed]
    for name, module in TABLE["MODULES"].items():
        lines.append(f"from {module.rpartition('.')[0]} import {name} as {name}")
    return "\n".join([*lines, "", "__version__: str", "__all__: list[str]", ""])


def targets() -> dict[Path, str]:
    """Each file that is written, and what belongs in it."""
    overview = ROOT / "book" / "api.md"
    marks = r"(<!-- rooms -->\n).*?(\n<!-- /rooms -->)"
    filled = re.sub(
        marks,
        lambda m: m[1] + contents() + m[2],
        overview.read_text(encoding="utf-8"),
        flags=re.DOTALL,
    )
    pages = {ROOT / "book" / f"api_{room}.md": page(room) for room in CORE}
    return {ROOT / "pfkit" / "__init__.pyi": stub(), overview: filled, **pages}


def stale() -> list[Path]:
    """Files that are missing or differ, and pages of rooms that are gone."""
    wanted = targets()
    found = [p for p, text in wanted.items() if not p.exists() or p.read_text("utf-8") != text]
    return found + [p for p in (ROOT / "book").glob("api_*.md") if p not in wanted]


def main() -> int:
    """Write, or check."""
    wanted, due = targets(), stale()
    for path in due:
        print(f"{path.relative_to(ROOT)}: does not follow from pfkit/rooms.py")
        if "--check" in sys.argv:
            continue
        if path in wanted:
            path.write_text(wanted[path], encoding="utf-8", newline="\n")
        else:
            path.unlink()
    return min(len(due), 1) if "--check" in sys.argv else 0


if __name__ == "__main__":
    sys.exit(main())
