"""Executing a notebook twice changes no byte; what a reader would miss is listed."""

from __future__ import annotations

import base64
import io
import json

import nbformat
import pytest
import stamps

import notebooks

FIGURE = """import matplotlib.pyplot as plt
plt.plot([1, 4, 9])
plt.show()
print("peak = 9")"""


def make(path, *code, alt="A line that rises from one over four to nine."):
    """Write a small notebook: a title and some code cells, the last with an alt text."""
    cells = [nbformat.v4.new_markdown_cell("# A page")]
    cells += [nbformat.v4.new_code_cell(text) for text in code]
    cells[-1].metadata["mystnb"] = {"image": {"alt": alt}, "figure": {"caption": "A line."}}
    for number, cell in enumerate(cells):
        cell.id = f"cell-{number}"
    nbformat.write(nbformat.v4.new_notebook(cells=cells), path)
    return path


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """An empty repository with a data file, so that nothing here depends on the real one."""
    monkeypatch.setattr(notebooks, "ROOT", tmp_path)
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "ranges.txt").write_text("1 2 3\n")
    (tmp_path / "notebooks").mkdir()
    return tmp_path


def test_executing_again_changes_no_byte(repository):
    read = "print(open('../data/ranges.txt').read())"
    noisy = "import random, time\nfor i in range(3):\n    print(i, flush=True); time.sleep(0.02)"
    widget = "import ipywidgets\nipywidgets.IntSlider(description='M')"
    path = make(repository / "notebooks" / "a.ipynb", read, noisy, widget, FIGURE)
    notebooks.refresh(path)
    first = path.read_bytes()
    notebooks.refresh(path)
    assert path.read_bytes() == first
    stored = stamps.read(path)
    assert stored["metadata"]["pfkit"]["files"] == ["data/ranges.txt"]
    assert stamps.why_stale(stored, repository) == ""
    (repository / "data" / "ranges.txt").write_text("1 2 4\n")
    assert "changed" in stamps.why_stale(stored, repository)
    (repository / "data" / "ranges.txt").unlink()
    assert "gone: data/ranges.txt" in stamps.why_stale(stored, repository)
    assert notebooks.faults(stored) == ["cell cell-3: a stored widget is dead in the page"]


def test_a_warning_on_stderr_stops_the_refresh(repository):
    path = make(repository / "notebooks" / "b.ipynb", "import sys\nprint('hm', file=sys.stderr)")
    before = path.read_bytes()
    with pytest.raises(RuntimeError, match="stderr: hm"):
        notebooks.refresh(path)
    assert path.read_bytes() == before


def test_dependencies_are_named_from_the_top_and_programs_count_as_everything(repository):
    (repository / "pfkit").mkdir()
    module = repository / "pfkit" / "motion.py"
    module.write_text("x = 1\n")
    data = repository / "data" / "ranges.txt"
    own = repository / "notebooks" / "a.ipynb"
    opened = [str(data), str(own), "/etc/hostname"]
    assert notebooks.dependencies(opened, [], own) == ["data/ranges.txt"]
    assert notebooks.dependencies([], [str(module)], own) == ["pfkit/motion.py"]
    assert notebooks.dependencies(["<program>"], [], own) == ["data/ranges.txt", "pfkit/motion.py"]


def notebook(**cell):
    title = {"cell_type": "markdown", "source": "# A page", "id": "t", "metadata": {}}
    code = {"cell_type": "code", "source": "", "id": "c", "metadata": {}, "outputs": []}
    return {"cells": [title, {**code, **cell}], "metadata": {}}


ALT, CAPTION = {"alt": "Five particles under one curve."}, {"caption": "Five particles."}


def picture(**about):
    shown = [{"output_type": "display_data", "data": {"image/png": ""}}]
    return notebook(outputs=shown, metadata={"mystnb": about})


@pytest.mark.parametrize(
    ("broken", "expected"),
    [
        (picture(figure=CAPTION), "no alt text"),
        (picture(image={"alt": "plot"}, figure=CAPTION), "no alt text"),
        (picture(image=ALT), "no caption"),
        (picture(image=ALT, figure={"caption": " "}), "no caption"),
        (notebook(outputs=[{"output_type": "error"}]), "error"),
        (notebook(id="t"), "ids"),
        ({"cells": notebook()["cells"][1:], "metadata": {}}, "title"),
    ],
)
def test_what_a_reader_would_miss_is_listed(broken, expected):
    (fault,) = notebooks.faults(broken)
    assert expected in fault


def test_a_good_notebook_has_no_fault():
    assert notebooks.faults(picture(image=ALT, figure=CAPTION)) == []


def test_a_notebook_never_executed_is_stale():
    assert "never executed" in stamps.why_stale(notebook())


def test_only_the_program_of_a_module_counts():
    plain = "def f(x):\n    return '# no comment'\n"
    dressed = (
        '"""Half a page."""\n\ndef f(x):\n    """Doc."""\n\n    return \'# no comment\'  # why\n'
    )
    assert stamps.program_text(dressed) == stamps.program_text(plain)
    assert stamps.program_text(plain.replace("no", "a")) != stamps.program_text(plain)


def test_pictures_become_small_and_stay_the_same():
    from PIL import Image

    picture = Image.effect_noise((80, 60), 40).convert("RGBA")
    out = io.BytesIO()
    picture.save(out, "PNG")
    data = base64.b64encode(out.getvalue()).decode()
    small = notebooks.small_png(data)
    assert len(small) < len(data)
    assert notebooks.small_png(data) == small
    assert Image.open(io.BytesIO(base64.b64decode(small))).size == (80, 60)


def test_streams_that_arrive_in_pieces_are_joined():
    pieces = [{"output_type": "stream", "name": "stdout", "text": text} for text in ("a", "b")]
    error = {"output_type": "stream", "name": "stderr", "text": "c"}
    joined = notebooks.merge_streams([*pieces, error])
    assert [output["text"] for output in joined] == ["ab", "c"]


def test_widget_ids_are_numbered_in_order():
    data = {"application/vnd.jupyter.widget-view+json": {"model_id": "f" * 32}}
    result = notebooks.renumber_widgets({"cells": [data], "state": {"f" * 32: "a" * 32}})
    assert "f" * 32 not in json.dumps(result)
    assert f"{1:032x}" in result["state"]
