"""Hand out a lab: its unanswered notebook, and the versions it was made with.

    python -m pfkit.labs.release lab3 OUT/

The folder OUT then holds the notebook, ``requirements.txt`` with this version of pfkit, and
``release.json`` with what a row of the grades is compared with. Nothing is released that holds an
answer, an output of a check, or a stub that the lab does not know.
"""

import argparse
import hashlib
import importlib.metadata
import json
import sys
from pathlib import Path

import pfkit
from pfkit.labs.grade.batch import version_of
from pfkit.labs.grade.notebook import NoSuchLab, Pristine, find

WITH = ("numpy", "matplotlib", "ipywidgets", "jupyterlab")


def faults(pristine: Pristine) -> list[str]:
    """Why a notebook must not be handed out, one sentence each; empty if it may."""
    book = json.loads(pristine.path.read_text(encoding="utf-8"))
    found = []
    seen = [c["metadata"].get("answer") for c in book["cells"] if "answer" in c["metadata"]]
    if sorted(seen) != sorted(pristine.lab.items):
        found.append("its answer cells are not the items of the lab, each once")
    for cell in book["cells"]:
        item, source = cell["metadata"].get("answer"), "".join(cell["source"])
        if item and "..." not in source:
            found.append(f"{item} is answered")
        if "BEGIN SOLUTION" in source:
            found.append(f"a cell holds a solution: {source[:40]!r}")
        told = json.dumps(cell.get("outputs", []))
        if any(f": {status}" in told for status in ("passed", "partial", "wrong", "predicted")):
            found.append(f"a check is stored with its verdict: {source[:40]!r}")
    return found


def release(pristine: Pristine, out: Path, source: str = "") -> list[Path]:
    """Write the files; raises ValueError that names every fault, and then writes nothing."""
    if problems := faults(pristine):
        raise ValueError(f"{pristine.path.name} cannot be released: " + "; ".join(problems))
    out.mkdir(parents=True, exist_ok=True)
    content = pristine.path.read_bytes()
    about = {
        "lab": pristine.lab.name,
        "version": version_of(pristine.lab),
        "notebook": pristine.path.name,
        "sha256": hashlib.sha256(content).hexdigest(),
        "points": sum(i.points for i in pristine.lab.items.values()),
    }
    files = {
        pristine.path.name: content,
        "requirements.txt": "\n".join([_pinned(source), *_with(), ""]).encode(),
        "release.json": (json.dumps(about, indent=1) + "\n").encode(),
    }
    for name, data in files.items():
        if (out / name).exists() and (out / name).read_bytes() != data:
            raise ValueError(f"{out / name} exists and differs: name another folder")
    for name, data in files.items():
        (out / name).write_bytes(data)
    return [out / name for name in files]


def _pinned(source: str) -> str:
    return f"pfkit @ {source}" if source else f"pfkit=={pfkit.__version__}"


def _with() -> list[str]:
    """What a student needs beside pfkit, in the versions that are installed here."""
    found = []
    for name in WITH:
        try:
            found.append(f"{name}=={importlib.metadata.version(name)}")
        except importlib.metadata.PackageNotFoundError:
            found.append(name)
    return found


def main(words: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(
        prog="python -m pfkit.labs.release", description="Write what students get of a lab."
    )
    parser.add_argument("lab", help="such as lab3 or resampling")
    parser.add_argument("folder", type=Path, help="is made if need be")
    parser.add_argument("--notebook", type=Path, help="if it is not this course's")
    parser.add_argument(
        "--pfkit",
        default="",
        metavar="SOURCE",
        help="where pip finds pfkit, such as git+https://...@v0.1.0; default: the package index",
    )
    asked = parser.parse_args(words)
    try:
        written = release(find(asked.lab, asked.notebook), asked.folder, asked.pfkit)
    except (NoSuchLab, ValueError, OSError) as error:
        print(f"pfkit.labs.release: {error}", file=sys.stderr)
        return 2
    print("\n".join(str(path) for path in written))
    return 0


if __name__ == "__main__":
    sys.exit(main())
