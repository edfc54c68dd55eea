"""Every chapter and lab is in the table of contents, and everything in it exists."""

from __future__ import annotations

import re

from browser import ROOT

ENTRIES = re.findall(
    r"^\s*(?:root:|- file:)\s*(\S+)", (ROOT / "_toc.yml").read_text(encoding="utf-8"), re.MULTILINE
)


def test_every_entry_exists_once():
    assert len(set(ENTRIES)) == len(ENTRIES)
    missing = [
        e for e in ENTRIES if not any((ROOT / f"{e}{end}").exists() for end in (".ipynb", ".md"))
    ]
    assert missing == []


def test_nothing_written_is_left_out():
    tops = ("notebooks/*.ipynb", "notebooks/labs/*.ipynb", "book/*.md", "book/*.ipynb")
    pages = {p.relative_to(ROOT).with_suffix("").as_posix() for top in tops for p in ROOT.glob(top)}
    assert pages - set(ENTRIES) == set()
