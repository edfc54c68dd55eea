"""The grader's parts, without running anything: what is read, suspected, run and reported."""

import json
from pathlib import Path

import numpy as np
import pytest
import solutions
import submissions

from pfkit.labs import lab3
from pfkit.labs.grade import cells, report, suspicion
from pfkit.labs.grade.batch import Batch, Limits, student
from pfkit.labs.grade.notebook import NoSuchLab, find, steps
from pfkit.labs.grade.seal import Unchanged
from pfkit.labs.grade.submission import Answers, read

LAB = lab3.LAB


@pytest.fixture(scope="module")
def pristine():
    return find("lab3")


# -- which cells run -----------------------------------------------------------------------------


def test_names_changed():
    source = "import numpy as np\nx = [f(y) for y in z]\nx.append(1)\ndef g(a):\n    return a + b"
    assert cells.names_changed(source) == {"np", "x", "g"}
    assert cells.names_changed("a.b[0].c = 1") == cells.names_changed("a.sort()") == {"a"}
    assert cells.names_changed("for k in a:\n    b[k] = 1") == {"b", "k"}
    assert cells.names_changed("plt.show()") == cells.names_changed("def (") == set()


def test_names_surely_bound():
    assert cells.surely_bound("a, b[c] = 1, 2\ndef f(): ...\nif d:\n    e = 1") == {"a", "f"}


def test_names_needed():
    assert cells.names_needed("x = f(y)\nz = x + 1\ndef g(a):\n    return a + b") == {"f", "y", "b"}
    assert cells.names_needed("for i, j in pairs:\n    k = i\n    n += k") == {"pairs", "n"}
    assert cells.names_needed("for x in x:\n    pass\nx") == {"x"}
    assert cells.names_needed("w /= w.sum()") == {"w"} and cells.names_needed("def (") == set()


def test_every_answer_runs_and_is_checked_and_figures_are_left_out(pristine):
    run = steps(pristine, Answers(sources=solutions.published("lab3")))
    done = [s["item"] for s in run if s["do"] == "answer"]
    assert done == [s["item"] for s in run if s["do"] == "check"] == list(LAB.items)
    ours = [s["source"] for s in run if s["do"] == "ours"]
    assert any("import numpy" in s for s in ours)
    assert not any("plt.show" in s for s in ours)


def test_a_cell_runs_if_an_answer_reads_what_it_binds(pristine):
    def texts(answer):
        run = steps(pristine, Answers(sources=pristine.stubs | {"p2b": answer}))
        return "\n".join(s["source"] for s in run if s["do"] in ("ours", "use"))

    assert "rng = np.random" not in texts("def estimate(v, t, p):\n    return 1")
    assert "rng = np.random" in texts("def estimate(v, t, p):\n    return rng.normal()")


def test_unknown_labs_are_named():
    with pytest.raises(NoSuchLab, match="lab4"):
        find("os.path")


# -- what is read --------------------------------------------------------------------------------


def test_exports_become_cells(pristine, tmp_path):
    version = LAB.items["p1a"].version
    data = submissions.export({"p1a": "'c'", "p2b": submissions.RIGHT["p2b"], "zz": "1"})
    data["answers"]["p1a"]["version"] = version
    data["predictions"] = {"p4a": {"choice": "c", "sure": 70, "version": ""}}
    path = tmp_path / "a.json"
    path.write_text(json.dumps(data))
    answers = read(path, LAB, pristine.stubs, pristine.variables)
    assert answers.sources["p1a"].endswith("p1a = 'c'")
    assert answers.sources["p2b"] == submissions.RIGHT["p2b"]
    assert answers.sources["p4a"] == "p4a = ('c', 70.0)"
    assert answers.sources["p1b"] == pristine.stubs["p1b"] and answers.missing == []
    assert answers.notes == [
        "p2b: answers another version of the question",
        "unknown item 'zz' ignored",
    ]


def test_a_split_cell_is_joined(pristine, tmp_path):
    head, body = "w0 = 3", submissions.RIGHT["p1a"]
    path = tmp_path / "a.ipynb"
    submissions.write(path, submissions.answered(submissions.twice(body), p1a=head))
    answers = read(path, LAB, pristine.stubs, pristine.variables)
    assert answers.sources["p1a"] == f"{head}\n\n{body}" and answers.doubts == []


# -- what is suspected ---------------------------------------------------------------------------

SUSPECT = [
    "lab.LAB.items", "lab.use('p2b', 1)", "lab.resamplers", "lab.check = print", "np.abs = max",
    "from pfkit.labs import lab4", "import pfkit.labs.lab3.weights", "import gc",
    "from inspect import stack", "setattr(np, 'abs', max)", "eval('1')", "f.__globals__",
    "getattr(f, '__code__')", "import sys\nsys.modules['pfkit']", "pf.labs.lab3", "np = 3",
    "import mylab as lab", "x = 'pfkit.labs.lab'", "del lab.check", "lab._private",
]  # fmt: skip
INNOCENT = [
    "p1a = 'c'", "import numpy as np", "from math import sqrt as root", "plt.rcParams['x'] = 1",
    "from pfkit.labs import lab3 as lab", "import sys\nsys.exit()", "x = lab.film.truth",
    "lab.check('p1a', 'c')", "plt.gca().set_title('__')", "def f(x):\n    x.weight = 2",
    "if __name__ == '__main__': pass", "run = lab.track(lab.film, bel, m, s, rng)", "def (",
]  # fmt: skip


@pytest.mark.parametrize("source", SUSPECT)
def test_reaching_for_the_checker_is_seen(source):
    assert suspicion.doubts("q", source, LAB, lab3)


@pytest.mark.parametrize("source", [*INNOCENT, *solutions.published("lab3").values()])
def test_ordinary_answers_are_not_suspected(source):
    assert suspicion.doubts("q", source, LAB, lab3) == []


def test_changes_of_the_checker_are_seen(monkeypatch):
    picture = Unchanged(LAB)
    assert picture.changes() == []
    with monkeypatch.context() as patch:
        patch.setattr(np, "allclose", max)
        patch.setattr(type(LAB), "check", max)
        patch.setitem(LAB.items, "p1a", LAB.items["p1b"])
        patch.setitem(vars(LAB.items["p1b"]), "tol", 1e9)
        patch.setattr(lab3.track, "__code__", (lambda: 0).__code__)
        found = " ".join(picture.changes())
    for part in ("numpy.allclose", "Lab.check", "the items.p1a", "item p1b.tol", "code of"):
        assert part in found
    assert picture.changes() == []


# -- what is reported ----------------------------------------------------------------------------


def record(name, **items):
    got = {
        i: {"status": "passed" if s else "wrong", "score": s, "choice": c, "misconception": m}
        for i, (s, c, m) in items.items()
    }
    score = sum(g["score"] for g in got.values())
    return {
        "student": name, "file": f"{name}.ipynb", "status": "ok", "score": score, "max": 64.0,
        "items": got, "texts": {}, "ticked": {}, "world": "", "detail": "", "seconds": 1.0,
        "version": "v", "sha256": "ab",
    }  # fmt: skip


def test_statistics_of_items_by_hand():
    """Facility and discrimination recomputed with NumPy from the same four students."""
    p1b, p2b = np.array([1.0, 1, 0, 0]), np.array([2.0, 1.5, 1, 0])
    records = [
        record(str(k), p1b=(a, "", "" if a else "all-rooms"), p2b=(b, "", ""), p1a=(1.0, "c", ""))
        for k, (a, b) in enumerate(zip(p1b, p2b, strict=True))
    ]
    ungraded = record("x", p1b=(1.0, "", "")) | {"score": None, "status": "crashed"}
    rows = dict(
        line.split(",", 1) for line in report.statistics([*records, ungraded], LAB).splitlines()
    )
    r = round(float(np.corrcoef(p1b, 1 + p2b)[0, 1]), 3)
    assert f",4,0,2,0.5,{r},,all-rooms 2" in rows["p1b"]
    assert rows["p1a"].endswith(",4,0,4,1,,c 4,")
    assert ",0,4,0,,,," in rows["q1a"], "nobody reached it: no facility, not 0"


def test_a_spreadsheet_computes_nothing():
    row = report.rows([record("=1+1") | {"detail": "@x\n\x1b[0m"}], LAB).splitlines()
    assert len(row) == 2 and row[1].startswith("'=1+1,'=1+1.ipynb") and ",'@x" in row[1]


def test_names_that_are_no_text_can_be_written(tmp_path):
    odd = record("caf\udce9") | {"detail": "\ud800"}
    report.write(tmp_path / "a.csv", report.rows([odd], LAB))
    report.write(tmp_path / "a.md", report.page(odd, LAB))
    assert "caf" in (tmp_path / "a.csv").read_text() and "caf" in (tmp_path / "a.md").read_text()


def test_a_fault_of_the_grader_costs_one_row(pristine, tmp_path, monkeypatch):
    def fail(*_):
        raise KeyError("ours")

    for name in ("a.ipynb", "b.ipynb"):
        submissions.write(tmp_path / name, submissions.answered())
    with Batch(pristine, tmp_path, Limits()) as batch:
        monkeypatch.setattr(batch, "_run", fail)
        rows = list(batch.grade(sorted(tmp_path.iterdir()), jobs=2))
    assert [r["status"] for r in rows] == ["crashed"] * 2
    assert all(r["score"] is None and "KeyError: 'ours'" in r["detail"] for r in rows)


def test_a_page_shows_markup_as_text():
    got = record("<b>ann|", p1b=(0.0, "", "all-rooms"))
    got["texts"] = {"p3c": "p3c = '''\n```\n# not a heading\n'''"}
    text = report.page(got, LAB)
    assert r"\<b\>ann\|" in text and "````python" in text
    assert text.count("* [ ] ") == len(LAB.items["p3c"].rubric) and "Model: " in text
    names = report.page_names([record("A b"), record("a_b"), record("../x"), record("é" * 300)])
    assert len({n.lower() for n in names.values()}) == 4
    assert all("/" not in n and len(n.encode()) < 200 for n in names.values())


# -- what a student said beside the answers ------------------------------------------------------


def test_literals_of_a_verb_are_read_and_nothing_else_is():
    source = "lab.student('jo', term='spring')\nlab.tick('p3c', 1, 2)\nlab.tick(f(), 3)\nstudent(1)"
    assert cells.said(source, "student") == [("jo", "spring")]
    assert cells.said(source, "tick") == [("p3c", 1, 2)] and cells.said("def (", "tick") == []


def test_ticks_and_the_world_are_read_from_a_notebook_and_from_an_export(pristine, tmp_path):
    book = submissions.answered()
    cell = {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": None}
    book["cells"] += [
        cell | {"source": 'lab.student("jo17", "spring")'},
        cell | {"source": 'lab.tick("p3c", 1)\nlab.tick("p3c", 1, 2)'},
    ]
    submissions.write(tmp_path / "a.ipynb", book)
    told = {"ticks": {"p3c": [1, 2]}, "student": {"who": "jo17", "term": "spring"}}
    empty = {"schema": 1, "lab": "lab3", "answers": {}, "predictions": {}}
    (tmp_path / "b.json").write_text(json.dumps(empty | told))
    for name in ("a.ipynb", "b.json"):
        found = read(tmp_path / name, LAB, pristine.stubs, pristine.variables)
        assert found.ticks == {"p3c": [1, 2]} and found.student == ("jo17", "spring")


def test_a_student_is_judged_by_the_numbers_of_their_own_world(pristine, tmp_path):
    try:
        LAB.student("jo17", "spring")
        mine, printed = LAB.items["p1b"].key, LAB.items["p1b"].origin.key
    finally:
        LAB.forget()
    assert mine != printed
    with Batch(pristine, tmp_path, Limits()) as batch:
        for given, status in ((mine, "passed"), (printed, "wrong")):
            sources = pristine.stubs | {"p1b": f"p1b = {given!r}"}
            found = batch._run(Answers(sources=sources, student=("jo17", "spring")))
            (event,) = [e for e in found["events"] if e.get("item") == "p1b" and "status" in e]
            assert event["status"] == status or (status == "wrong" and event["status"] == "partial")


def test_the_students_ticks_stand_beside_the_teachers():
    got = record("ann", p3c=(0.0, "", "")) | {"ticked": {"p3c": [2]}, "world": "jo17 spring"}
    got["texts"] = {"p3c": "p3c = 'nobody is near the truth any more'"}
    lines = report.page(got, LAB).splitlines()
    boxes = [x for x in lines if x.startswith("* [ ]")]
    assert [x.endswith("(ticked by the student)") for x in boxes] == [False, True]
    assert "* Questions of: jo17 spring" in lines
    header, row = report.rows([got], LAB).splitlines()
    assert "p3c: 2,jo17 spring" in row and "ticked,world" in header


def test_what_was_left_out_is_one_line():
    text = report.page(record("ann", p1b=(0.5, "", "")), LAB)
    assert "| p1b |" in text and "| p1a |" in text, "not reached is not the same as blank"
    blank = record("ann") | {"items": {i: {"status": "unanswered"} for i in LAB.items}}
    blank["texts"] = {"p3c": 'p3c = "..."'}
    text = report.page(blank, LAB)
    assert f"Not answered: {', '.join(LAB.items)}." in text and "Model" not in text


@pytest.mark.parametrize(
    ("path", "name"),
    [
        ("ann.ipynb", "ann"),
        ("ann/lab3.ipynb", "ann"),
        ("group 1/ann/Lab_3 particle.ipynb", "group 1/ann"),
        ("group 1/ann.json", "group 1/ann"),
        ("lab3.ipynb", "lab3"),
    ],
)
def test_whose_file_is_it(path, name):
    assert student(Path(path), "lab3") == name


def test_a_chapter_in_a_folder_is_named_by_the_folder():
    for file in ("08 Particle filter.ipynb", "particle_filter_answers.json"):
        assert student(Path("ann") / file, "particle_filter") == "ann"
