"""Execute the notebooks whose outputs are out of date, so that doing it again changes no byte.

    make notebooks                          execute what is stale, two at a time
    python tools/notebooks.py FILE ...      only these (still only if stale)
    python tools/notebooks.py --force ...   execute even what is up to date
    python tools/notebooks.py --check       execute nothing; list what is stale or badly formed

A notebook runs in its own folder, in a fresh kernel. What would differ between two runs is removed:
execution times, widget ids, versions of the kernel, the way text arrives in pieces. Pictures are
reduced to at most 128 colours. The stamp (tools/stamps.py) records what the outputs were made from.
"""

from __future__ import annotations

import argparse
import base64
import concurrent.futures
import io
import json
import os
import re
import sys
import time
from pathlib import Path

import stamps
from stamps import ROOT

FOLDERS = ("book", "notebooks", "notebooks/labs")
KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}
LANGUAGE = {"name": "python", "pygments_lexer": "ipython3", "file_extension": ".py"}
QUIET = {
    "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    "PYTHONHASHSEED": "0",
    "PFKIT_WIDGETS": "off",  # explorables leave a line of text in a stored notebook, no widget
}
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
# Says where a name is defined. A name has one definition (tests/test_rooms.py), so no output can
# change with this file alone, and a new name makes no notebook stale.
NAMES = "pfkit/rooms.py"
COLOURS = 128
SHORTEST_ALT = 20  # characters: less cannot describe a figure

# Runs before the first cell and leaves no name behind: notes files opened and programs started.
WATCH = """
def _watch(event, args, seen=__import__("sys").__dict__.setdefault("_course_seen", set())):
    if event == "open" and isinstance(args[0], str) and "w" not in str(args[1] or "r"):
        seen.add(__import__("os").path.abspath(args[0]))
    elif event == "subprocess.Popen":
        seen.add("<program>")
__import__("sys").addaudithook(_watch)
del _watch
"""
# Runs after the last cell: prints what was opened and which modules of the package were imported.
REPORT = """
import sys, json
print(json.dumps([sorted(sys._course_seen), [m.__file__ for n, m in list(sys.modules.items())
      if n.split(".")[0] == "pfkit" and getattr(m, "__file__", None)]]))
"""


def find(names: list[str]) -> list[Path]:
    """Return the notebooks named, or all of the course."""
    if names:
        return [Path(name).resolve() for name in names]
    return sorted(path for top in FOLDERS for path in (ROOT / top).glob("*.ipynb"))


def dependencies(opened: list[str], modules: list[str], notebook: Path) -> list[str]:
    """Name, from the top of the repository, every file the outputs depend on."""
    found = {Path(name).resolve() for name in modules}
    found |= {Path(name).resolve() for name in opened if Path(name).suffix not in (".py", ".pyc")}
    if "<program>" in opened:  # what a started program reads cannot be seen: count everything
        found |= {p for top in ("pfkit", "data") for p in (ROOT / top).rglob("*")}
    kept = {path for path in found if path.is_relative_to(ROOT) and path.is_file()}
    kept -= {notebook.resolve(), ROOT / NAMES}
    names = {path.relative_to(ROOT).as_posix() for path in kept}
    return sorted(n for n in names if not n.startswith((".", "_")) and "__pycache__" not in n)


def execute(notebook: dict, path: Path, timeout: int) -> tuple[dict, list[str]]:
    """Run all cells in a fresh kernel; return the notebook with outputs and what it used."""
    import nbformat
    from nbclient import NotebookClient

    node = nbformat.from_dict(notebook)
    node.metadata.pop("widgets", None)
    node.cells.insert(0, nbformat.v4.new_code_cell(WATCH))
    node.cells.append(nbformat.v4.new_code_cell(REPORT))
    NotebookClient(
        node,
        timeout=timeout,
        kernel_name="python3",
        extra_arguments=["--IPKernelApp.log_level=40"],
        resources={"metadata": {"path": path.parent}},
    ).execute()
    opened, modules = json.loads(node.cells[-1].outputs[0].text)
    node.cells = node.cells[1:-1]
    return json.loads(json.dumps(node)), dependencies(opened, modules, path)


def small_png(data: str) -> str:
    """Reduce a PNG (base64) to COLOURS colours and no metadata, if that makes it smaller."""
    from PIL import Image

    raw = base64.b64decode(data)
    picture = Image.open(io.BytesIO(raw))
    flat = Image.new("RGB", picture.size, "white")
    flat.paste(picture, mask=picture.getchannel("A") if "A" in picture.getbands() else None)
    out = io.BytesIO()
    flat.quantize(COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(
        out, "PNG", optimize=True
    )
    best = out.getvalue() if len(out.getvalue()) < len(raw) else raw
    return base64.b64encode(best).decode() + "\n"


def merge_streams(outputs: list[dict]) -> list[dict]:
    """Join neighbouring pieces of the same stream: how text is cut depends on timing."""
    merged: list[dict] = []
    for output in outputs:
        last = merged[-1] if merged else {}
        if output["output_type"] == "stream" == last.get("output_type"):
            if output["name"] == last["name"]:
                last["text"] += output["text"]
                continue
        merged.append(output)
    return merged


def renumber_widgets(notebook: dict) -> dict:
    """Replace the random ids of widgets by numbers in order of appearance."""
    text = json.dumps(notebook)
    ids = dict.fromkeys(re.findall(r'"model_id": "([0-9a-f]{32})"', text))
    ids |= dict.fromkeys(re.findall(r"IPY_MODEL_([0-9a-f]{32})", text))
    for number, name in enumerate(ids, start=1):
        text = text.replace(name, f"{number:032x}")
    return json.loads(text)


def normalise(notebook: dict) -> dict:
    """Remove everything from an executed notebook that another run would change."""
    count = 0
    for cell in notebook["cells"]:
        cell["metadata"].pop("execution", None)
        if cell["cell_type"] != "code":
            continue
        count += 1
        cell["execution_count"] = count
        cell["outputs"] = merge_streams(cell["outputs"])
        for output in cell["outputs"]:
            if "execution_count" in output:
                output["execution_count"] = count
            data = output.get("data", {})
            if "image/png" in data:
                data["image/png"] = small_png(data["image/png"])
            output.get("metadata", {}).pop("image/png", None)
    own = {key: notebook["metadata"][key] for key in ("pfkit", "widgets", "mystnb") if
           key in notebook["metadata"]}  # fmt: skip
    notebook["metadata"] = {"kernelspec": KERNEL, "language_info": LANGUAGE, **own}
    notebook.update(nbformat=4, nbformat_minor=5)
    return renumber_widgets(notebook)


def write(path: Path, notebook: dict) -> None:
    """Write a notebook in the one form the repository knows: sorted keys, lists of lines."""
    import nbformat

    node = nbformat.from_dict(notebook)
    nbformat.validate(node)
    text = json.dumps(
        nbformat.v4.rwbase.split_lines(node), indent=1, sort_keys=True, ensure_ascii=False
    )
    path.write_text(text + "\n", encoding="utf-8", newline="\n")


def refresh(path: Path, timeout: int = 120) -> str:
    """Execute one notebook, stamp it and write it back; return a line of report."""
    os.environ.update({**QUIET, **dict.fromkeys(THREADS, "1")})
    start = time.monotonic()
    notebook, files = execute(stamps.read(path), path, timeout)
    for cell in stamps.code_cells(notebook):
        if noise := stderr_of(cell):
            raise RuntimeError(f"cell {cell.get('id')} writes to stderr: {noise[:200]}")
    notebook = normalise(notebook)
    notebook["metadata"]["pfkit"] = {"files": files, "stamp": stamps.stamp(notebook, files, ROOT)}
    write(path, notebook)
    return f"{path.relative_to(ROOT)}: executed in {time.monotonic() - start:.1f} s"


def stderr_of(cell: dict) -> str:
    """Return what a cell wrote to stderr, unless it is tagged as allowed to."""
    if "nbval-ignore-output" in cell["metadata"].get("tags", []):
        return ""
    return "".join(o["text"] for o in cell["outputs"] if o.get("name") == "stderr")


def faults(notebook: dict) -> list[str]:
    """List what a reader would miss: alt text, caption, title, unique cell ids, working outputs."""
    found = []
    ids = [cell.get("id", "") for cell in notebook["cells"]]
    if len(set(ids)) != len(ids) or "" in ids:
        found.append("cells need ids, each of them different")
    first = notebook["cells"][0] if notebook["cells"] else {}
    if first.get("cell_type") != "markdown" or not first["source"].startswith("# "):
        found.append("the first cell must start with the title: # Title")
    for cell in stamps.code_cells(notebook):
        kinds = {kind for output in cell["outputs"] for kind in output.get("data", {})}
        alt = cell["metadata"].get("mystnb", {}).get("image", {}).get("alt", "")
        if kinds & {"image/png", "image/svg+xml"} and len(alt) < SHORTEST_ALT:
            found.append(f"cell {cell.get('id')}: no alt text (metadata mystnb.image.alt)")
        caption = cell["metadata"].get("mystnb", {}).get("figure", {}).get("caption", "")
        if kinds & {"image/png", "image/svg+xml"} and not caption.strip():
            found.append(f"cell {cell.get('id')}: no caption (metadata mystnb.figure.caption)")
        if "application/vnd.jupyter.widget-view+json" in kinds:
            found.append(f"cell {cell.get('id')}: a stored widget is dead in the page")
        if any(output["output_type"] == "error" for output in cell["outputs"]):
            found.append(f"cell {cell.get('id')}: ends in an error")
    return found


def check(paths: list[Path]) -> int:
    """Print what is stale or badly formed; return how many notebooks that concerns."""
    bad = 0
    for path in paths:
        notebook = stamps.read(path)
        reasons = faults(notebook)
        if reason := stamps.why_stale(notebook):
            reasons.append(f"stale: {reason}; run make notebooks")
        for reason in reasons:
            print(f"{path.relative_to(ROOT)}: {reason}")
        bad += bool(reasons)
    print(f"{len(paths)} notebooks, {bad} with problems")
    return bad


def main() -> int:
    """Parse the command line and run it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="*")
    parser.add_argument("--check", action="store_true", help="execute nothing, list problems")
    parser.add_argument("--force", action="store_true", help="execute even what is up to date")
    parser.add_argument("--most", type=int, help="execute at most so many, list the others")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--cell-timeout", type=int, default=120, help="seconds for one cell")
    options = parser.parse_args()
    paths = find(options.files)
    if options.check:
        return min(check(paths), 1)
    due = [p for p in paths if options.force or stamps.why_stale(stamps.read(p))]
    print(f"{len(paths)} notebooks, {len(due)} to execute")
    if options.most is not None:
        for path in due[options.most :]:
            print(f"{path.name}: stale, left for make notebooks")
        due = due[: options.most]
    failed = 0
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        jobs = {pool.submit(refresh, path, options.cell_timeout): path for path in due}
        for job in concurrent.futures.as_completed(jobs):
            failed += job.exception() is not None
            name, error = jobs[job].name, job.exception()
            print(f"{name}: FAILED\n{error}" if error else job.result(), flush=True)
    return min(failed, 1)


if __name__ == "__main__":
    sys.exit(main())
