"""A batch of honest, broken and hostile submissions: one row each, and nothing is left."""

import contextlib
import csv
import json
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import submissions

from pfkit.labs import catalogue, lab3
from pfkit.labs.grade.batch import Batch, CannotGrade, Limits
from pfkit.labs.grade.notebook import find

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="limits are those of Linux")

COMMAND = [sys.executable, "-m", "pfkit.labs.grade", "lab3"]


def processes(*marks):
    """Command lines of processes that show one of the marks in arguments or environment."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if int(entry.name) != os.getpid():
                told = (entry / "cmdline").read_bytes() + (entry / "environ").read_bytes()
                if any(m.encode() in told for m in marks):
                    found.append((entry / "cmdline").read_bytes())
    return found


def command(folder, output, *more):
    words = [*COMMAND, str(folder), "-o", str(output), "--jobs", "2", *more]
    room = output.parent / "room"
    room.mkdir(exist_ok=True)
    return words, {**os.environ, "TMPDIR": str(room)}


def table(path):
    with path.open(encoding="utf-8", newline="") as file:
        return {row["file"]: row for row in csv.DictReader(file)}


def snapshot(folder):
    return {
        p.relative_to(folder): (p.lstat().st_size, p.read_bytes() if p.stat().st_size < 1e6 else 0)
        for p in folder.rglob("*")
        if p.is_file() and not p.is_symlink()
    }


@pytest.fixture(scope="module")
def batch(tmp_path_factory):
    """All cases graded by the command, as an instructor would."""
    top = tmp_path_factory.mktemp("grader")
    precious, folder = top / "precious", top / "submitted files"
    precious.mkdir()
    (precious / "file.txt").write_text("keep me")
    tag = f"9876.{os.getpid()}{random.randrange(10**6)}"
    cases = submissions.cases(precious, tag)
    for name, (content, _, _) in cases.items():
        submissions.write(folder / name, content)
    untouched = snapshot(precious), snapshot(folder)
    words, env = command(folder, top / "grades.csv", "--cell-timeout", "5", "--wall", "25")
    start = time.monotonic()
    ran = subprocess.run(words, env=env, capture_output=True, text=True, timeout=400)
    print(f"{len(cases)} submissions in {time.monotonic() - start:.0f} s\n{ran.stdout}{ran.stderr}")
    left = processes(str(top / "room"), tag)
    return top, cases, ran, untouched == (snapshot(precious), snapshot(folder)), left


def test_one_row_each_and_exit_code_zero(batch):
    top, cases, ran, _, _ = batch
    assert ran.returncode == 0, ran.stderr
    assert len(cases) >= 30 and set(table(top / "grades.csv")) == set(cases)
    assert f"{len(cases)} submissions to grade" in ran.stderr  # a bar only where one can be seen


def test_each_has_its_status(batch):
    top, cases, _, _, _ = batch
    rows = table(top / "grades.csv")
    wrong = {
        name: (rows[name]["status"], rows[name]["detail"])
        for name, (_, status, part) in cases.items()
        if rows[name]["status"] != status or part not in rows[name]["detail"]
    }
    assert wrong == {}


def test_a_score_stands_only_where_it_was_graded(batch):
    for name, row in table(batch[0] / "grades.csv").items():
        assert (row["score"] != "") == (row["status"] in ("ok", "errors")), name


def test_scores(batch):
    rows = table(batch[0] / "grades.csv")
    full = sum(i.points for i in lab3.LAB.items.values() if i.letter != "R")
    assert float(rows["all right.ipynb"]["score"]) == float(rows["right.ipynb"]["max"]) == full
    assert float(rows["wrong.ipynb"]["score"]) == 0 and rows["wrong.ipynb"]["p2a"] == ""
    assert float(rows["syntax.ipynb"]["score"]) == submissions.RIGHT_POINTS - 1
    for name in ("right.ipynb", "export.json", "magic.ipynb", "Zoë O'Neil/lab 3 (final).ipynb",
                 "stub beside answer.ipynb", "prints a gigabyte.ipynb"):  # fmt: skip
        assert float(rows[name]["score"]) == submissions.RIGHT_POINTS, name


def test_other_items_count_after_an_interrupted_cell(batch):
    row = table(batch[0] / "grades.csv")["loop.ipynb"]
    assert (row["p1a"], row["p1b"], row["p2b"]) == ("1", "0", "2")


def test_nothing_is_left_and_nothing_outside_is_touched(batch):
    top, _, _, untouched, left = batch
    assert left == [] and untouched
    assert list((top / "room").iterdir()) == []


def test_statistics_and_a_page_each(batch):
    top, cases, _, _, _ = batch
    with (top / "grades_items.csv").open(encoding="utf-8") as file:
        rows = {r["item"]: r for r in csv.DictReader(file)}
    graded = [r for r in table(top / "grades.csv").values() if r["score"]]
    assert list(rows) == list(lab3.LAB.items)
    assert int(rows["p1a"]["answered"]) + int(rows["p1a"]["blank"]) == len(graded)
    assert rows["p1a"]["choices"].startswith("a 1, c ")
    assert len(list((top / "grades_reports").glob("*.md"))) == len(cases)


@pytest.mark.parametrize("name", catalogue.names())
def test_every_lab_can_be_graded(name, tmp_path):
    with Batch(find(name), tmp_path, Limits()) as rehearsed:
        rehearsed.rehearse()


def test_a_letter_without_a_confidence_counts_as_it_did(tmp_path):
    """Notebooks and files from before a prediction asked how sure: they load and are graded."""
    folder = tmp_path / "in"
    folder.mkdir()
    book = json.loads(find("lab3").path.read_text(encoding="utf-8"))
    for cell in book["cells"]:
        if cell["metadata"].get("answer") == "p4a":
            cell["source"] = 'p4a = "a"'
    (folder / "ann.ipynb").write_text(json.dumps(book), encoding="utf-8")
    guess = {"p4a": {"choice": "c", "sure": None, "version": "x"}}
    kept = {"schema": 1, "lab": "lab3", "answers": {}, "predictions": guess}
    (folder / "bob.json").write_text(json.dumps(kept), encoding="utf-8")
    words, env = command(folder, tmp_path / "grades.csv")
    subprocess.run(words, env=env, capture_output=True, check=True, timeout=400)
    rows = table(tmp_path / "grades.csv")
    assert [rows[name]["p4a"] for name in ("ann.ipynb", "bob.json")] == ["1", "1"]


def test_a_broken_installation_is_said_once(tmp_path, monkeypatch):
    (tmp_path / "numpy.py").write_text("raise ImportError('no numpy here')")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with Batch(find("lab3"), tmp_path, Limits()) as broken:
        with pytest.raises(CannotGrade, match="no numpy here"):
            broken.rehearse()


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_resume_goes_on_where_it_was_interrupted(tmp_path, how):
    folder, output = tmp_path / "in", tmp_path / "grades.csv"
    submissions.write(folder / "a.ipynb", b"")
    submissions.write(folder / "b.ipynb", submissions.answered())
    submissions.write(folder / "c.ipynb", submissions.before("import time\ntime.sleep(600)"))
    words, env = command(folder, output, "--cell-timeout", "500")
    running = subprocess.Popen(
        words,
        env=env,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
        # A shell starts its background jobs deaf to Ctrl-C, and children inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    while not output.exists() or len(table(output)) < 2:
        assert running.poll() is None
        time.sleep(0.1)
    running.send_signal(how)
    assert running.wait(30) == (130 if how == signal.SIGINT else -how)
    until = time.monotonic() + 20  # the wardens notice that the grader is gone
    while processes(str(tmp_path / "room")) and time.monotonic() < until:
        time.sleep(0.1)
    assert processes(str(tmp_path / "room")) == []
    journal = tmp_path / "grades.jsonl"
    journal.write_text(journal.read_text() + '{"file": "c.ip')  # killed while it wrote
    submissions.write(folder / "c.ipynb", submissions.answered())
    submissions.write(folder / "a.ipynb", b"[]")
    again = subprocess.run([*words, "--resume"], env=env, capture_output=True, text=True)
    assert again.returncode == 0, again.stderr
    assert "2 submissions to grade, 1 kept" in again.stderr
    rows = table(output)
    assert {n: r["status"] for n, r in rows.items()} == {
        "a.ipynb": "malformed", "b.ipynb": "ok", "c.ipynb": "ok",
    }  # fmt: skip
    assert "list" in rows["a.ipynb"]["detail"], "a changed file is graded again"
    assert json.loads(journal.read_text().splitlines()[0])["file"] == "b.ipynb"
