"""Every module of the core has its place on an API page."""

from __future__ import annotations

import re

from browser import ROOT


def test_every_core_module_is_documented():
    text = "\n".join(path.read_text(encoding="utf-8") for path in ROOT.glob("book/api_*.md"))
    shown = re.findall(r"automodule:: pfkit\.(\w+)", text)
    assert len(shown) == len(set(shown))
    modules = {p.stem for p in (ROOT / "pfkit").glob("*.py") if not p.stem.startswith("__")}
    packages = {p.parent.name for p in (ROOT / "pfkit").glob("*/__init__.py")}
    edge = {"plotting", "palette", "widgets", "explore", "labs"}
    assert (modules | packages) - edge == set(shown)
