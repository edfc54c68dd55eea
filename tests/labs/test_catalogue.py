"""Labs, notebooks: none is forgotten on either side."""

import json
from pathlib import Path

from pfkit.labs import catalogue

NOTEBOOKS = Path(__file__).parents[2] / "notebooks"


def test_each_notebook_asks_the_questions_of_one_lab_and_each_lab_is_asked():
    paths = [*NOTEBOOKS.glob("[0-9][0-9]_*.ipynb"), *NOTEBOOKS.glob("labs/lab[0-9]_*.ipynb")]
    asked = []
    for path in paths:
        imported = catalogue.asked_in(json.loads(path.read_text(encoding="utf-8")))
        assert len(imported) == 1, f"{path.name} imports {sorted(imported) or 'no lab'}"
        asked += imported
    assert sorted(asked) == list(catalogue.names())


def test_a_lab_is_called_as_its_module():
    assert {name: lab.name for name, lab in catalogue.all_labs().items()} == {
        name: name for name in catalogue.names()
    }
