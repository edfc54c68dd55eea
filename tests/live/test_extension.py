"""The Sphinx extension: what it takes from a notebook, and what it refuses."""

from __future__ import annotations

import json
import re
import sys
from importlib import import_module
from pathlib import Path

import pytest

from pfkit.explore import scene
from pfkit.labs.lab3 import LAB as LAB3

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def live_page():
    sys.path.insert(0, str(ROOT / "book" / "_ext"))
    import live_page

    yield live_page
    sys.path.remove(str(ROOT / "book" / "_ext"))


def cell(source, **metadata):
    return {"cell_type": "code", "source": source, "metadata": metadata}


CALLS = [
    ('task.check("p1a", f)', "check"),
    ('task.predict("p1a", f)', "check"),
    ('task.check("p1b", f)', "code"),
    ('other.check("p1a", f)', "code"),
    ('task.use("p1a", f)', "code"),
    ("task.check(", "code"),
]


@pytest.mark.parametrize(("call", "kind"), CALLS)
def test_a_check_is_found_by_its_call(live_page, call, kind):
    cells = [cell("from pfkit.labs import target, lab3 as task"), cell("f = ...", answer="p1a")]
    found = live_page.read_lab([*cells, cell(call)])
    assert (found["lab"], found["alias"], found["cells"][2]["kind"]) == ("lab3", "task", kind)


def test_a_lab_that_was_renamed_says_how_it_was_called(live_page):
    cells = [cell("from pfkit.labs import resampling as lab"), cell("hand = ...", answer="hand")]
    assert live_page.read_lab(cells)["former"] == "ch07"


def test_cells_of_a_lab(live_page):
    cells = [
        cell("from pfkit.labs import lab3 as lab"),
        cell("p1a = ...", answer="p1a"),
        cell('lab.check("p1a", p1a)'),
        cell('lab.predict("p4a", p4a)', check="p4a"),
        {"cell_type": "markdown", "source": "x", "metadata": {}},
        cell("1 + 1"),
    ]
    found = live_page.read_lab(cells)
    assert found["lab"] == "lab3" and found["alias"] == "lab"
    assert found["former"] is None
    kinds = [c["kind"] for c in found["cells"]]
    assert kinds == ["code", "answer", "check", "check", "code"]
    assert [c["index"] for c in found["cells"]] == [0, 1, 2, 3, 5]
    assert len(found["cells"][1]["version"]) >= 8


def test_rubrics_and_worked_answers_come_from_the_lab(live_page):
    cells = [
        cell("from pfkit.labs import lab3 as lab"),
        cell("p3c = ...", answer="p3c"),
        cell("def circular_mean(theta, w): ...", answer="p5b"),
        cell('# folded\nlab.solution("p5b")'),
        cell("p1a = ...", answer="p1a"),
    ]
    _, text, code, shown, letter = live_page.read_lab(cells)["cells"]
    assert text["rubric"] == list(LAB3.items["p3c"].rubric) and code["worked"]
    assert (shown["kind"], shown["item"]) == ("solution", "p5b")
    assert "worked" not in letter and "rubric" not in letter


def test_letters_to_choose_come_from_the_lab(live_page):
    from pfkit.labs.lab3 import LAB

    def asked(item, source):
        return live_page.question("lab3", item, source).get("choose")

    options = [list(pair) for pair in LAB.items["p1a"].options.items()]
    assert asked("p1a", "p1a = ...  # a letter") == {
        "name": "p1a", "options": options, "sure": False
    }  # fmt: skip
    assert asked("p4a", "p4a = ...")["sure"] is True
    assert asked("p5b", "p5b = ...") is None  # wants a function
    assert asked("p1a", "p1a = 1\nprint(p1a)") is None  # no stub that a letter could fill


def test_a_notebook_without_answers_is_no_lab(live_page):
    assert live_page.read_lab([cell("from pfkit.labs import lab3 as lab")]) is None
    assert live_page.read_lab([cell("x = 1", answer="q")]) is None


def build(tmp_path, text, *flags):
    from sphinx.cmd.build import build_main

    (tmp_path / "index.md").write_text(text, encoding="utf-8")
    conf = "extensions = ['myst_parser', 'live_page']\nimport sys\n"
    (tmp_path / "conf.py").write_text(
        conf + f"sys.path.insert(0, {str(ROOT / 'book' / '_ext')!r})\n", encoding="utf-8"
    )
    return build_main(["-q", *flags, "-b", "html", str(tmp_path), str(tmp_path / "out")])


def test_an_unknown_scene_fails_the_build(live_page, tmp_path, capfd):
    assert build(tmp_path, "# T\n\n```{explorable} no_such_scene\n```\n", "-W") != 0
    assert "no explorable is called" in capfd.readouterr().err


def test_without_the_runtime_a_page_keeps_still_and_missions(live_page, tmp_path, monkeypatch):
    monkeypatch.setattr(live_page, "SITE", tmp_path / "nothing")
    assert build(tmp_path, "# T\n\n```{explorable} comb\n:seed: 3\n```\n", "-W") == 0
    page = (tmp_path / "out" / "index.html").read_text(encoding="utf-8")
    assert 'src="live-runs/comb-comb-3.svg"' in page and "two halves" not in page
    assert all(mission.text in page for mission in scene("comb").panel.missions)
    assert (tmp_path / "out" / "live-runs" / "comb-comb-3.svg").exists()
    assert "page.js" not in page


def test_pages_say_the_megabytes_that_were_packed(live_page, tmp_path, monkeypatch):
    monkeypatch.setattr(live_page, "SITE", tmp_path)
    text = "# T\n\nIt loads Python ({python-size}`megabytes`).\n"
    for sizes, said in ((None, "(not part of this copy)"), ([9_100_000, 140_000], "(9.2 mega")):
        if sizes:
            manifest = {f"part{k}": size for k, size in enumerate(sizes)}
            (tmp_path / "manifest.json").write_text(json.dumps(manifest))
        assert build(tmp_path, text, "-W", "-E") == 0
        assert said in (tmp_path / "out" / "index.html").read_text(encoding="utf-8")


def test_no_page_types_in_how_much_python_weighs():
    """Megabytes in prose go stale; the role fills them in."""
    number = re.compile(r"\b(\d[\d.,]*|one|two|five|nine|ten|twenty)\s+(MB\b|megabytes)", re.I)
    pages = [*(ROOT / "book").glob("*.md"), ROOT / "README.md"]
    cells = [
        (path, "".join(cell["source"]))
        for path in (ROOT / "notebooks").rglob("*.ipynb")
        for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]
        if cell["cell_type"] == "markdown"
    ]
    texts = [(path, path.read_text(encoding="utf-8")) for path in pages] + cells
    loads = [(p.name, m[0]) for p, t in texts for m in number.finditer(t) if "Python" in t]
    assert loads == []


def test_the_tours_mistake_has_a_name(tmp_path, monkeypatch):
    """What the tour asks its visitor to type is a mistake that the first chapter knows."""
    tour = (ROOT / "book" / "tour.md").read_text(encoding="utf-8")
    chapter, source = re.search(
        r"notebooks/(\w+)\.ipynb\) and go to .*?```python\n(.+?)\n```", tour, re.S
    ).groups()
    cells = json.loads((ROOT / "notebooks" / f"{chapter}.ipynb").read_text("utf-8"))["cells"]
    item = re.search(r"question `(\w+)`", tour)[1]
    (asked,) = [c for c in cells if c["metadata"].get("answer") == item]
    assert source.split(" =")[0] == "".join(asked["source"]).split(" =")[0]
    loaded = "\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code")
    module = re.search(r"from pfkit\.labs import (\w+)", loaded)[1]
    monkeypatch.chdir(tmp_path)  # a lab keeps its answers beside the notebook
    values: dict = {}
    exec(source, values)
    lab = import_module(f"pfkit.labs.{module}").LAB
    verdict = lab.check(item, values[source.split(" =")[0]])
    assert verdict.status == "wrong" and verdict.misconception == "backwards"


def test_missions_are_the_scenes_own(live_page, tmp_path, capfd):
    """Words of a page's own would be ticked by nothing."""
    assert build(tmp_path, "# T\n\n```{explorable} comb\n\n1. Look.\n```\n", "-W") != 0
    assert "none permitted" in capfd.readouterr().err


def test_a_lab_without_python_keeps_its_cells(live_page, tmp_path, monkeypatch):
    """No network when the book was built: scripts and recordings are there, Python is not."""

    class Builder:
        name = "html"

    app = type("App", (), {"builder": Builder})
    app.env = type("Env", (), {"live_pages": {"lab": {"runs": {}, "lab": {"cells": []}}}})
    monkeypatch.setattr(live_page, "SITE", tmp_path)
    (tmp_path / "page.js").touch()
    for there in (False, True):
        context = {"pathto": lambda name, resource: name}
        if there:
            (tmp_path / "manifest.json").touch()
        live_page.add_scripts(app, "lab", "page.html", context, None)
        assert ("lab.js" in context.get("body", "")) is there
        assert ("explorable.css" in context.get("metatags", "")) is there
