"""What archives read agrees with the citation and with the package."""

from __future__ import annotations

import json
import re

import metadata
import pytest

CITATION, PROJECT = metadata.facts()


def test_the_files_are_current():
    assert metadata.main(["--check"]) == 0


def test_a_changed_fact_is_seen(monkeypatch, capsys):
    other = (CITATION | {"title": "Another"}, PROJECT)
    monkeypatch.setattr(metadata, "facts", lambda: other)
    assert metadata.main(["--check"]) == 1
    assert "codemeta.json" in capsys.readouterr().out


def test_versions_agree():
    log = (metadata.ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    released = re.findall(r"^## (\d+\.\d+\.\d+)", log, re.M)
    assert CITATION["version"] == PROJECT["version"]
    assert not released or released[0] == PROJECT["version"]


def test_the_citation_has_what_the_format_requires():
    """Citation File Format 1.2.0: these four, and each author a name."""
    assert {"cff-version", "message", "title", "authors"} <= CITATION.keys()
    assert CITATION["cff-version"] == "1.2.0"
    assert all(metadata.names(CITATION))


@pytest.mark.parametrize("name, required", [
    ("codemeta.json", {"@context", "@type", "name", "version", "license", "author", "description"}),
    (".zenodo.json", {"title", "description", "upload_type", "creators", "license", "version"}),
])  # fmt: skip
def test_what_readers_of_each_file_require_is_there(name, required):
    record = json.loads((metadata.ROOT / name).read_text(encoding="utf-8"))
    assert all(record.get(key) for key in required)
