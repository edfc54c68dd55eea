"""The lab notebooks: complete, silent when empty, passed by the solutions, failed by stubs."""

import json
import time
from pathlib import Path

import pytest

from pfkit.labs import Prediction, lab3, lab4

nbformat = pytest.importorskip("nbformat")
nbclient = pytest.importorskip("nbclient")

ROOT = Path(__file__).parents[2]
BOOKS = {
    "lab3": (lab3.LAB, ROOT / "notebooks/labs/lab3_particle_filter.ipynb"),
    "lab4": (lab4.LAB, ROOT / "notebooks/labs/lab4_tuning_outliers.ipynb"),
}


def read(name):
    return nbformat.read(BOOKS[name][1], as_version=4)


def answer_cells(book):
    return {c.metadata["answer"]: c for c in book.cells if "answer" in c.metadata}


def execute(book, strict, allow_errors=False):
    """Run in the notebook's folder; returns seconds and the errors by cell."""
    setup = f"import os\nos.environ['PFKIT_LABS_STRICT'] = '{int(strict)}'"
    book.cells.insert(0, nbformat.v4.new_code_cell(setup))
    client = nbclient.NotebookClient(
        book,
        timeout=120,
        kernel_name="python3",
        allow_errors=allow_errors,
        resources={"metadata": {"path": str(ROOT / "notebooks/labs")}},
    )
    start = time.perf_counter()
    client.execute()
    return time.perf_counter() - start


def text_of(cell):
    shown = ""
    for out in cell.get("outputs", []):
        shown += out.get("text", "") + out.get("data", {}).get("text/plain", "")
        shown += out.get("evalue", "")
    return shown


@pytest.mark.parametrize("name", BOOKS)
def test_each_item_has_a_stub_and_a_check(name):
    lab, _ = BOOKS[name]
    book = read(name)
    cells = [c for c in book.cells if c.cell_type == "code"]
    order = [c.metadata["answer"] for c in cells if "answer" in c.metadata]
    assert order == list(lab.items), "answer cells follow the order of the items"
    for k, cell in enumerate(cells):
        if "answer" in cell.metadata:
            assert "..." in cell.source, f"{cell.metadata['answer']} is not a stub"
            item = cell.metadata["answer"]
            verb = "predict" if isinstance(lab.items[item], Prediction) else "check"
            assert cells[k + 1].source.startswith(f'lab.{verb}("{item}", ')


@pytest.mark.parametrize("name", BOOKS)
def test_stored_notebooks_are_unanswered_and_hold_no_widget(name):
    raw = BOOKS[name][1].read_text(encoding="utf-8")
    assert "jupyter.widget" not in raw and "widgets" not in json.loads(raw)["metadata"]
    for cell in read(name).cells:
        if "check" in cell.metadata and cell.outputs:
            assert ": unanswered: no" in text_of(cell)


@pytest.mark.parametrize("name", BOOKS)
def test_an_empty_lab_fails_under_the_strict_switch(name):
    """Every check of a stub raises, and nothing else does. Also times Run All."""
    lab, _ = BOOKS[name]
    book = read(name)
    seconds = execute(book, strict=True, allow_errors=True)
    failed = [c for c in book.cells if any(o.output_type == "error" for o in c.get("outputs", []))]
    assert [c.metadata.get("check") for c in failed] == list(lab.items)
    assert all("LabError" in c.outputs[-1].ename for c in failed)
    assert seconds < 60, f"Run All must take under 60 s, took {seconds:.0f}"
