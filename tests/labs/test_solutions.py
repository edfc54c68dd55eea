"""Published solutions pass, in the scope that the lab's own notebook makes for them."""

import pytest
import solutions

from pfkit.labs import catalogue
from pfkit.labs.grade.notebook import find, steps
from pfkit.labs.grade.submission import Answers


@pytest.fixture(params=catalogue.names())
def pristine(request):
    found = find(request.param)
    found.lab.forget()
    yield found
    found.lab.forget()


def test_solutions_pass(pristine, monkeypatch):
    """The cells that the grader would run, in their order, in one namespace."""
    monkeypatch.setenv("PFKIT_LABS_STRICT", "1")
    monkeypatch.chdir(pristine.path.parent)
    published, space = solutions.published(pristine.lab.name), {"__name__": "__main__"}
    assert sorted(published) == sorted(pristine.lab.items), "one block per item, nothing left out"
    for step in steps(pristine, Answers(sources=published)):
        if step["do"] == "check":
            pristine.lab.check(step["item"], eval(step["source"], space))
        else:
            exec(step["source"], space)
    assert pristine.lab.verdicts.keys() == pristine.lab.items.keys()


def test_no_file_of_solutions_belongs_to_no_lab():
    assert sorted(p.stem for p in solutions.FOLDER.glob("*.py")) == list(catalogue.names())
