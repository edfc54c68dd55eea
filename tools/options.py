"""The options of a choice or a prediction are written once, in the lab, and copied into the text.

A list in a notebook's text that stands under a comment with the name of an item is this tool's:

    <!--options of clock-->
    * (a) never, the weights are equal
    * (b) about 10

Write the comment alone, and let the tool write the list.

    python tools/options.py --check [FILE ...]    list what does not agree
    python tools/options.py --fill  [FILE ...]    write the lists
"""

from __future__ import annotations

import argparse
import importlib
import re
import sys
from pathlib import Path

import stamps
from stamps import ROOT

import notebooks
from pfkit.labs import catalogue
from pfkit.labs.lab import Lab

OPTION = r"\* \([a-z]\) .*(?:\n|\Z)"
BLOCK = re.compile(
    rf"^<!--options of (?P<item>\w+)-->(?:\n|\Z)(?P<list>(?:{OPTION})*)", re.MULTILINE
)


def lab_of(notebook: dict) -> Lab | None:
    """Return the lab whose questions a notebook asks."""
    for name in catalogue.asked_in(notebook):
        return importlib.import_module(f"pfkit.labs.{name}").LAB
    return None


def listed(item: object) -> str:
    """Return the list of an item's options as Markdown; nothing for an item without options."""
    options = getattr(item, "options", {}).items()
    return "\n".join(f"* ({letter}) {text}" for letter, text in options)


def filled(text: str, lab: Lab) -> str:
    """Write the options under each comment that names an item with options."""

    def fill(block: re.Match[str]) -> str:
        wanted = listed(lab.items.get(block["item"]))
        end = "\n" if block.group().endswith("\n") else ""
        return f"<!--options of {block['item']}-->\n{wanted}{end}" if wanted else block.group()

    return BLOCK.sub(fill, text)


def faults(notebook: dict) -> list[str]:
    """Say what does not agree, one sentence each."""
    lab = lab_of(notebook)
    if lab is None:
        return []
    texts = [cell["source"] for cell in notebook["cells"] if cell["cell_type"] == "markdown"]
    blocks = [block for text in texts for block in BLOCK.finditer(text)]
    named = [block["item"] for block in blocks]
    asked = [item.id for item in lab.items.values() if listed(item)]
    found = [
        f"{name}: its options are missing from the text" for name in asked if name not in named
    ]
    found += [f"{name}: no item with options" for name in named if name not in asked]
    found += [
        f"{name}: listed {named.count(name)} times"
        for name in {n for n in named if named.count(n) > 1}
    ]
    found += [
        f"{block['item']}: the text has other options than the lab"
        for block in blocks
        if block["item"] in asked and block["list"].rstrip("\n") != listed(lab.items[block["item"]])
    ]
    typed = [
        m.group() for text in texts for m in re.finditer(rf"^{OPTION}", BLOCK.sub("", text), re.M)
    ]
    found += [f"typed by hand, without a comment above: {line.strip()}" for line in typed]
    return found


def main() -> int:
    """Parse the command line and run it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="*", type=Path)
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--check", action="store_true", help="list what does not agree (default)")
    action.add_argument("--fill", action="store_true", help="write the lists")
    asked = parser.parse_args()
    chosen = asked.files or sorted((ROOT / "notebooks").rglob("*_*.ipynb"))
    bad = 0
    for path in chosen:
        notebook = stamps.read(path)
        lab = lab_of(notebook)
        if asked.fill and lab:
            for cell in notebook["cells"]:
                if cell["cell_type"] == "markdown":
                    cell["source"] = filled(cell["source"], lab)
            notebooks.write(path, notebook)
        for fault in faults(notebook):
            bad += 1
            print(f"{path.name}: {fault}")
    print(f"{len(chosen)} notebooks, {bad} lists of options that are not the lab's")
    return min(bad, 1)


if __name__ == "__main__":
    sys.exit(main())
