"""Fonts cut to the characters that the book shows, so that a page carries no more."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from fontTools import subset


def cut(source: Path, characters: Iterable[str], target: Path) -> None:
    """Write `source` with these characters alone, as WOFF; the same bytes at each build."""
    options = subset.Options()
    options.flavor = "woff"
    options.recalc_timestamp = False
    options.notdef_outline = True
    options.layout_features = []
    options.drop_tables += ["FFTM"]  # when FontForge wrote it
    font = subset.load_font(str(source), options)
    cutter = subset.Subsetter(options)
    cutter.populate(text="".join(characters))
    cutter.subset(font)
    subset.save_font(font, str(target), options)
