"""Third-party files for the built book: MathJax with its fonts.

The built book loads nothing from outside, so MathJax is part of it. What the book needs of its npm
package is laid out in .cache/static, which Sphinx copies; once per lock file.

    python tools/assets.py
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import npm_packages
from environment import ROOT, Stop

STATIC = ROOT / ".cache" / "static"
FONTS = Path("output/chtml/fonts/woff-v2")


def prepare() -> None:
    """Lay out the files unless that has been done for this lock file; fetches them if need be."""
    modules = npm_packages.fetched()
    made_from = npm_packages.digest(*npm_packages.LISTS, Path(__file__))
    stamp = STATIC.parent / "static.stamp"
    if STATIC.exists() and stamp.exists() and stamp.read_text() == made_from:
        return
    shutil.rmtree(STATIC, ignore_errors=True)
    source, target = modules / "mathjax" / "es5", STATIC / "mathjax"
    shutil.copytree(source / FONTS, target / FONTS)
    shutil.copy(source / "tex-chtml-full.js", target)
    shutil.copy(source.parent / "LICENSE", target)
    stamp.write_text(made_from)


if __name__ == "__main__":
    try:
        prepare()
    except Stop as reason:
        sys.exit(f"[course] stopped: {reason}")
