"""A chapter's number is that of its file; titles, links and mentions take it from there.

The file `notebooks/NN_topic.ipynb` is chapter NN. A text names a chapter by its topic, and this
tool writes the number, so that readers see it in the book and in Jupyter:

    # N. Title                        the first line of the notebook
    [chapter N](NN_topic.ipynb)       a mention is a link; in a list also [N](NN_topic.ipynb)
    NN_topic                          wherever a page, a README or `_toc.yml` names the file
    | N | ...                         the rows of the map, book/map.md, are counted

To insert a chapter, rename the files behind it, give it a line in `_toc.yml` and a row in the map,
and fill. A chapter of another book is written `ch. 6`. Code finds a notebook by its topic.

    python tools/chapter_numbers.py --check    list what does not agree (default)
    python tools/chapter_numbers.py --fill     write the numbers
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from pathlib import Path

import stamps
from stamps import ROOT

PAGES = (
    *("*.md", "_toc.yml", "book/*.md", "book/*.ipynb", "notebooks/*.ipynb"),
    *("notebooks/labs/*.ipynb", "data/*.md", "benchmarks/*.md", "pfkit/*.md"),
)
MAP = "book/map.md"
TITLE = re.compile(r"# (?:\d+\. )?(?=\S)")
FILE = re.compile(r"(?<!\w)\d\d_(?P<topic>[a-z]\w*)")
LINK = re.compile(
    r"\[(?P<word>(?:[Cc]hapter )?)\d+\]"
    r"(?P<way>\([^()\s]*\d\d_(?P<topic>\w+)\.ipynb(?:#[^()\s]*)?\))"
)
ROW = re.compile(r"^\| *\d+ *(?=\|)", re.MULTILINE)
MENTION = re.compile(r"\b[Cc]hapters?\s\d+")
NOTEBOOK = re.compile(r"(?<!\w)\d\d_(?P<topic>\w+)\.ipynb")


def chapters(root: Path = ROOT) -> dict[str, Path]:
    """Return the file of each topic, in the order of the numbers."""
    files = sorted((root / "notebooks").glob("[0-9][0-9]_*.ipynb"))
    for part in (0, 1):
        shared = Counter(path.stem.split("_", 1)[part] for path in files).most_common(1)
        if shared and shared[0][1] > 1:
            raise ValueError(
                f"{shared[0][1]} notebooks are called {shared[0][0]}: one chapter, one number"
            )
    return {path.stem.split("_", 1)[1]: path for path in files}


def numbers(root: Path = ROOT) -> dict[str, int]:
    """Return the number of each topic; what comes before the first chapter has number 0."""
    return {topic: int(path.name[:2]) for topic, path in chapters(root).items()}


def filled(text: str, number: dict[str, int]) -> str:
    """Write the present numbers into the links and file names of a text."""

    def mention(link: re.Match[str]) -> str:
        known = link["topic"] in number
        return f"[{link['word']}{number[link['topic']]}]{link['way']}" if known else link[0]

    def file(name: re.Match[str]) -> str:
        topic = name["topic"]
        return f"{number[topic]:02}_{topic}" if topic in number else name[0]

    return FILE.sub(file, LINK.sub(mention, text))


def texts(path: Path) -> list[str]:
    """Read the texts of a page: the markdown cells of a notebook, or the one of a file."""
    if path.suffix != ".ipynb":
        return [path.read_text(encoding="utf-8")]
    cells = stamps.read(path)["cells"]
    return [cell["source"] for cell in cells if cell["cell_type"] == "markdown"]


def filled_texts(path: Path, root: Path) -> list[str]:
    """Return the texts of a page as they should read."""
    number = numbers(root)
    new = [filled(text, number) for text in texts(path)]
    if own := number.get(path.stem[3:]) if path.parent == root / "notebooks" else 0:
        new[0] = TITLE.sub(f"# {own}. ", new[0], count=1)
    if path == root / MAP:
        row = iter(range(1, 100))
        new[0] = ROW.sub(lambda _: f"| {next(row)} ", new[0])
    return new


def pages(root: Path = ROOT) -> list[Path]:
    """Return every page that may name a chapter."""
    return sorted({path for top in PAGES for path in root.glob(top)})


def fill(path: Path, root: Path = ROOT) -> bool:
    """Write the numbers into one page; say whether that changed it."""
    new = filled_texts(path, root)
    if new == texts(path):
        return False
    if path.suffix == ".ipynb":
        import notebooks

        notebook = stamps.read(path)
        prose = [cell for cell in notebook["cells"] if cell["cell_type"] == "markdown"]
        for cell, text in zip(prose, new, strict=True):
            cell["source"] = text
        notebooks.write(path, notebook)
    else:
        path.write_text(new[0], encoding="utf-8", newline="\n")
    return True


def problems_of_page(path: Path, root: Path) -> list[str]:
    """List what one page says of a chapter that its file does not say."""
    number, name = numbers(root), path.relative_to(root).as_posix()
    found = []
    for text, new in zip(texts(path), filled_texts(path, root), strict=True):
        rows = zip(text.splitlines(), new.splitlines(), strict=True)
        found += [f"{name}: to be filled: {old[:80]}" for old, row in rows if old != row]
        unbound = MENTION.findall(LINK.sub("", text))
        found += [
            f"{name}: {said} is not bound to a file: write [chapter N](NN_topic.ipynb); "
            f"of another book, ch. N"
            for said in unbound
        ]
        missing = [m[0] for m in NOTEBOOK.finditer(text) if m["topic"] not in number]
        found += [f"{name}: there is no {file}" for file in missing]
    return found


def map_rows(root: Path = ROOT) -> list[str]:
    """Return the rows of the map that stand for chapters, in order."""
    text = (root / MAP).read_text(encoding="utf-8")
    return [line for line in text.splitlines() if ROW.match(line)]


def problems(root: Path = ROOT) -> list[str]:
    """List every place where a number of a chapter is not the number of its file."""
    found = [fault for path in pages(root) for fault in problems_of_page(path, root)]
    listed = re.findall(r"notebooks/(\d\d)_\w+", (root / "_toc.yml").read_text(encoding="utf-8"))
    if listed != sorted(listed):
        found.append(f"_toc.yml: numbers must rise, got {' '.join(listed)}")
    for row, line in enumerate(map_rows(root), start=1):
        for link in NOTEBOOK.finditer(line):
            if numbers(root).get(link["topic"]) != row:
                found.append(f"{MAP}: row {row} is {link[0]}; rows stand in the course's order")
    return found


def main() -> int:
    """Parse the command line and run it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    action = parser.add_mutually_exclusive_group()
    action.add_argument("--check", action="store_true", help="list what does not agree (default)")
    action.add_argument("--fill", action="store_true", help="write the numbers")
    options = parser.parse_args()
    if options.fill:
        for path in filter(fill, pages()):
            print(f"{path.relative_to(ROOT)}: filled")
    found = problems()
    print("\n".join([*found, f"{len(chapters())} files, {len(found)} numbers that do not agree"]))
    return min(len(found), 1)


if __name__ == "__main__":
    sys.exit(main())
