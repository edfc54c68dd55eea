"""The build of the live parts: reproducible, frank about what is missing, no host names."""

from __future__ import annotations

import importlib.util
import json
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "tools" / "live" / "build.py"
LARGEST_SITE = 20_000_000  # bytes, without the bundle for file://


@pytest.fixture
def build():
    spec = importlib.util.spec_from_file_location("live_build", TOOL)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_without_node_it_says_so_and_succeeds(build, tmp_path, monkeypatch, capsys):
    for name, folder in (("CACHE", "c"), ("SITE", "c/site"), ("PARTS", "c/parts")):
        monkeypatch.setattr(build, name, tmp_path / folder)
    monkeypatch.setattr(build.npm_packages, "FOLDER", tmp_path / "npm")
    monkeypatch.setattr(build.shutil, "which", lambda *a, **k: None)
    assert build.main() == 0
    told = capsys.readouterr().out
    assert "missing: npm is not installed" in told and "recorded runs" in told
    names = {p.name for p in (tmp_path / "c/site").iterdir()}
    assert {"render.js", "explorable.js", "explorable.css", "page.js"} <= names
    assert "manifest.json" not in names


def test_two_builds_are_equal_byte_for_byte(build, tmp_path, monkeypatch):
    if not build.PARTS.exists():
        pytest.skip("the runtime is not fetched (python tools/live/build.py)")
    made = []
    for k in range(2):
        monkeypatch.setattr(build, "CACHE", tmp_path / str(k))
        build.build_site(tmp_path / f"site{k}", live=True)
        made.append({p.name: p.read_bytes() for p in (tmp_path / f"site{k}").iterdir()})
    assert made[0] == made[1]
    weight = sum(len(data) for name, data in made[0].items() if name != "bundle.js")
    assert weight < LARGEST_SITE
    for name, data in made[0].items():
        if name != "bundle.js":
            assert str(ROOT).encode() not in data, name


def test_the_lock_pins_by_integrity_and_names_no_host(build):
    lock = json.loads(build.npm_packages.LISTS[1].read_text(encoding="utf-8"))
    packages = {name: p for name, p in lock["packages"].items() if name}
    assert packages and all(p["integrity"].startswith("sha512-") for p in packages.values())
    assert not any("resolved" in p for p in packages.values())


def test_the_zip_depends_on_names_and_contents_alone(build, tmp_path):
    for name, files in (("a", {"x": b"1", "y": b"2"}), ("b", {"y": b"2", "x": b"1"})):
        build.write_zip(tmp_path / name, files)
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()
