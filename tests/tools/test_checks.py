"""The stages of make test, tried on something broken: each must be able to fail."""

from __future__ import annotations

import subprocess
import sys

import checks
import nbformat
import pytest
from checks import Stage

import book

GOOD, BAD = [sys.executable, "-c", "pass"], [sys.executable, "-c", "raise SystemExit(3)"]


def test_a_failure_stops_the_rest_unless_told_to_keep_going(capfd):
    three = [Stage("one", "", [GOOD]), Stage("two", "", [GOOD, BAD]), Stage("three", "", [GOOD])]
    assert not checks.run_all(three, keep_going=False)
    said = capfd.readouterr().out
    assert "two        FAILED" in said and "three      not run" in said
    assert "make test ARGS='--only two'" in said
    assert not checks.run_all(three, keep_going=True)
    assert "three      passed" in capfd.readouterr().out
    assert checks.run_all([three[0], three[2]], keep_going=False)


def test_what_failed_is_tried_once_more_and_only_where_the_stage_says_so(monkeypatch, capfd):
    monkeypatch.setattr(checks, "files_that_failed", lambda: ["tests/book/test_pages.py"])
    assert checks.run(Stage("pages", "", [BAD], again=GOOD))[0]
    assert "runs once more, by itself: tests/book/test_pages.py" in capfd.readouterr().out
    assert not checks.run(Stage("pages", "", [BAD], again=BAD))[0]
    assert not checks.run(Stage("unit", "", [BAD]))[0]
    monkeypatch.setattr(checks, "files_that_failed", lambda: [])  # it did not even start
    assert not checks.run(Stage("pages", "", [BAD], again=GOOD))[0]
    assert [stage.name for stage in checks.stages() if stage.again] == ["pages"]


def test_failures_are_remembered_by_file(monkeypatch, tmp_path):
    monkeypatch.setattr(checks, "ROOT", tmp_path)
    assert checks.files_that_failed() == []
    folder = tmp_path / checks.MEMORY / "v" / "cache"
    folder.mkdir(parents=True)
    (folder / "lastfailed").write_text('{"t.py::x[1::2]": true, "t.py::y": true, "gone.py": true}')
    (tmp_path / "t.py").touch()
    assert checks.files_that_failed() == ["t.py"]


def test_what_one_stage_leaves_out_another_runs():
    stages = {stage.name: stage for stage in checks.stages()}
    (unit,) = stages.pop("unit").commands
    left_out = {word.removeprefix("--ignore=") for word in unit if word.startswith("--ignore=")}
    elsewhere = {word for stage in stages.values() for words in stage.commands for word in words}
    assert left_out and left_out <= elsewhere
    assert all(path.as_posix() in " ".join(elsewhere) for path in checks.ROOT.glob("notebooks/*_*"))


@pytest.mark.slow
def test_a_stored_number_that_executing_does_not_give_is_seen(tmp_path):
    cells = []
    for stored in ("0.0581", "0.0582"):
        cell = nbformat.v4.new_code_cell("print('RMSE = 0.0581 m')", execution_count=1)
        cell.outputs = [nbformat.v4.new_output("stream", text=f"RMSE = {stored} m\n")]
        cells.append(cell)
    path = tmp_path / "a.ipynb"
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    done = subprocess.run([*checks.PYTEST, *checks.NBVAL, path], capture_output=True, text=True)
    assert done.returncode == 1 and "1 failed, 1 passed" in done.stdout


@pytest.mark.slow
def test_a_warning_fails_the_book(tmp_path):
    pytest.importorskip("jupyter_book")
    (tmp_path / "_config.yml").write_text("title: A book\nonly_build_toc_files: true\n")
    (tmp_path / "_toc.yml").write_text("format: jb-book\nroot: page\n")
    (tmp_path / "page.md").write_text("# A page\n\n{doc}`page`, {doc}`no-such-page`\n")
    done = subprocess.run(book.BUILD, cwd=tmp_path, capture_output=True, text=True)
    said = book.explain(done.stdout + done.stderr)
    assert done.returncode and said.count("WARNING") == 1 and "no-such-page" in said
