"""Make what lets a page of the book compute: Python, NumPy, pfkit and the cell editor.

    python tools/live/build.py

From npm come Pyodide, NumPy for it, CodeMirror, and esbuild, which joins CodeMirror into one file
(see tools/npm_packages.py). This happens once per lock file; the rest takes a second and happens
when pfkit or our scripts change.
The result lies in .cache/live/site, and book/_ext/live_page.py copies it to the book's folder
`live`. Without network or Node this says what is missing and succeeds: the book then shows its
recorded runs and pictures, made by Python alone.

A page on a web host fetches the single files. A page opened from a folder may not fetch anything,
so bundle.js repeats them all as text (gzip, base64) in a classic script.

All output is byte-reproducible: fixed dates, sorted names, no paths.
"""

from __future__ import annotations

import base64
import gzip
import hashlib
import io
import json
import re
import runpy
import shutil
import sys
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
import npm_packages  # noqa: E402
from environment import Stop  # noqa: E402

CACHE = ROOT / ".cache" / "live"
SITE = CACHE / "site"
PARTS = CACHE / "parts"
# Modules that hand a table of theirs to the page; they need no other part of pfkit.
SPOKEN = (ROOT / "pfkit" / "palette.py", ROOT / "pfkit" / "explore" / "operations.py")
OURS = (ROOT / "pfkit" / "explore" / "web", ROOT / "book" / "live")
DATA = (".txt", ".dat", ".csv")
RUNTIME = ("pyodide.js", "pyodide.asm.js", "pyodide.asm.wasm", "python_stdlib.zip")
EDGE: dict[str, tuple[str, ...]] = runpy.run_path(str(ROOT / "pfkit" / "rooms.py"))["EDGE"]
# What needs matplotlib, ipywidgets or nbformat stays behind: the page does not have them.
NOT_IN_PAGE = tuple(part.replace(".", "/") for part, needs in EDGE.items() if needs)
# What only NumPy's own developers need. (Its import does need _multiarray_tests*.so.)
NOT_NEEDED = re.compile(r"/(tests|include|f2py|distutils|_examples|_pyinstaller)/|\.(pyi|a)$")
HOOK = HERE / "distributor_init.py"


def digest(*paths: Path) -> str:
    """Hash names and contents of files and folders."""
    total = hashlib.sha256()
    for top in paths:
        for path in sorted(top.rglob("*")) if top.is_dir() else [top]:
            if path.is_file() and "__pycache__" not in path.parts:
                total.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return total.hexdigest()


def write_zip(target: Path, files: dict[str, bytes]) -> None:
    """A zip whose bytes depend on the files' names and contents alone."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(files):
            info = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(info, files[name])


def numpy_files(package: Path) -> dict[str, bytes]:
    """The files of NumPy that a page needs, with our hook among them."""
    source = next((package / "pkg").glob("*.tar.gz"))
    prefix = "lib/python3.12/site-packages/"
    files = {}
    with tarfile.open(source) as archive:
        for member in archive.getmembers():
            name = member.name.removeprefix("./").removeprefix(prefix)
            if not name.startswith("numpy/") or not member.isfile() or NOT_NEEDED.search(name):
                continue
            handle = archive.extractfile(member)
            files[name] = handle.read() if handle else b""
    files["numpy/_distributor_init_local.py"] = HOOK.read_bytes()
    return files


def build_runtime(parts: Path) -> None:
    """From npm: Pyodide, NumPy and the editor."""
    modules = npm_packages.fetched()
    shutil.rmtree(parts, ignore_errors=True)
    parts.mkdir(parents=True)
    for name in RUNTIME:
        shutil.copyfile(modules / "pyodide" / name, parts / name)
    lock = json.loads((modules / "pyodide" / "pyodide-lock.json").read_text())
    lock["packages"] = {}  # nothing may be fetched by name
    (parts / "pyodide-lock.json").write_text(json.dumps(lock, sort_keys=True))
    write_zip(parts / "numpy.zip", numpy_files(modules / "@emscripten-forge" / "numpy"))
    options = ("--bundle", "--minify", "--format=iife", "--target=es2020", "--legal-comments=none")
    entry = npm_packages.FOLDER / "editor.mjs"  # beside the packages that it imports
    shutil.copyfile(HERE / "editor.mjs", entry)
    esbuild = modules / "esbuild" / "bin" / "esbuild"
    output = f"--outfile={parts / 'editor.js'}"
    npm_packages.run("node", str(esbuild), str(entry), *options, output, folder=entry.parent)
    licences = {"pyodide": "MPL-2.0", "numpy": "BSD-3-Clause", "codemirror": "MIT"}
    text = "".join(f"{name}: {licence}\n" for name, licence in licences.items())
    (parts / "LICENCES.txt").write_text("Third-party parts in this folder\n\n" + text)


def logs_in_use() -> list[Path]:
    """The folders below data/ from which some notebook reads, as its stamp says."""
    stamps = [json.loads(p.read_text(encoding="utf-8"))["metadata"].get("pfkit", {})
              for p in sorted((ROOT / "notebooks").rglob("*.ipynb"))]  # fmt: skip
    opened = {name for stamp in stamps for name in stamp.get("files", [])}
    return sorted({(ROOT / name).parent for name in opened if name.startswith("data/")})


def pfkit_files() -> dict[str, bytes]:
    """The part of pfkit that runs in a page, and the logs beside it, where its loaders look."""
    package = ROOT / "pfkit"
    logs = [p for top in logs_in_use() for p in top.rglob("*") if p.suffix in DATA]
    names = [p for p in package.rglob("*") if p.suffix in (".py", ".json", ".npz", ".csv", ".txt")]
    return {
        "pfkit/" + p.relative_to(package).as_posix(): p.read_bytes()
        for p in names
        if not p.relative_to(package).with_suffix("").as_posix().startswith(NOT_IN_PAGE)
        and "__pycache__" not in p.parts
    } | {p.relative_to(ROOT).as_posix(): p.read_bytes() for p in logs}


def packed(path: Path) -> str:
    """gzip and base64 of one file; fast, because the zips inside do not shrink any more."""
    level = 1 if path.suffix == ".zip" else 9
    buffer = io.BytesIO()
    with gzip.GzipFile(fileobj=buffer, mode="wb", compresslevel=level, mtime=0) as out:
        out.write(path.read_bytes())
    return base64.b64encode(buffer.getvalue()).decode("ascii")


def write_bundle(site: Path, names: list[str]) -> None:
    """All files as one classic script, for pages opened from a folder."""
    lines = []
    for name in names:
        path = site / name
        kept = CACHE / "packed" / hashlib.sha256(path.read_bytes()).hexdigest()
        if not kept.exists():
            kept.parent.mkdir(parents=True, exist_ok=True)
            kept.write_text(packed(path))
        lines.append(f"{json.dumps(name)}:{json.dumps(kept.read_text())}")
    (site / "bundle.js").write_text("window.pfBundle={" + ",\n".join(lines) + "};\n")


def build_site(site: Path, live: bool) -> None:
    """Lay out the folder the book will carry."""
    shutil.rmtree(site, ignore_errors=True)
    site.mkdir(parents=True)
    for folder in OURS:
        for path in sorted(folder.glob("*.*")):
            shutil.copyfile(path, site / path.name)
    for module in SPOKEN:
        script = runpy.run_path(str(module))["script"]()
        (site / f"{module.stem}.js").write_text(script, encoding="utf-8", newline="\n")
    if not live:
        return
    for path in sorted(PARTS.iterdir()):
        shutil.copyfile(path, site / path.name)
    write_zip(site / "pfkit.zip", pfkit_files())
    names = [*RUNTIME, "pyodide-lock.json", "numpy.zip", "pfkit.zip"]
    sizes = {name: (site / name).stat().st_size for name in names}
    (site / "manifest.json").write_text(json.dumps(sizes))
    write_bundle(site, [*names, "manifest.json", "worker.js"])


def main() -> int:
    """Bring .cache/live/site up to date."""
    reason = ""
    made_from = digest(*npm_packages.LISTS, HERE / "editor.mjs", HOOK, Path(__file__))
    stamp = CACHE / "parts.stamp"
    if not (PARTS.exists() and stamp.exists() and stamp.read_text() == made_from):
        try:
            build_runtime(PARTS)
            stamp.write_text(made_from)
        except Stop as problem:
            reason = str(problem)
            shutil.rmtree(PARTS, ignore_errors=True)
    state = made_from + digest(ROOT / "pfkit", *logs_in_use(), *OURS) + reason
    if not (SITE.exists() and (CACHE / "site.stamp").exists()
            and (CACHE / "site.stamp").read_text() == state):  # fmt: skip
        CACHE.mkdir(parents=True, exist_ok=True)
        build_site(SITE, live=not reason)
        (CACHE / "site.stamp").write_text(state)
    if reason:
        print(f"[live] missing: {reason}")
        print("[live] pages keep their recorded runs and pictures but cannot compute")
    return 0


if __name__ == "__main__":
    sys.exit(main())
