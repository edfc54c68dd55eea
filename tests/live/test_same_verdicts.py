"""The same answer gets the same verdict in the page's Python as in the reader's own.

Every right answer and one wrong one of each item, in one Python that boots once. With
``PFKIT_EVERY_EXAMPLE=1`` (weekly) all wrong ones.
"""

from __future__ import annotations

import json
import os

import pytest

from pfkit.labs.catalogue import names

pytestmark = [pytest.mark.page, pytest.mark.slow]
EVERY = os.environ.get("PFKIT_EVERY_EXAMPLE") == "1"
# What runs in both: the answers come from the package, so only numbers and names go out.
SCRIPT = """
import json
from importlib import import_module

def told(lab, item, answer):
    lab.forget()
    if item.after:
        lab.predict(item.after.id, (item.after.key, 60))
    verdict = lab.check(item.id, answer)
    return verdict.status + ":" + verdict.misconception + ":" + "".join(
        "yn"[not x.ok] for x in verdict.lines)

def verdicts(name, item, every):
    lab = import_module("pfkit.labs." + name).LAB
    item = lab.items[item]
    wrong = [x.example for x in (*item.misconceptions, *item.refused)]
    wrong += [k for k in getattr(item, "options", ()) if k != item.key]
    answers = [item.solution(), *(wrong if every else wrong[:1])]
    found = [told(lab, item, answer) for answer in answers]
    lab.forget()
    return found
"""
ASK = """async ([source]) => {
  window.judge = window.judge || new PF.Python("cells");
  const cells = JSON.stringify([{ index: 0, kind: "code", item: "c", source, stub: "" }]);
  return JSON.parse(await window.judge.ask({ do: "cell", cells, index: 0 }));
}"""


@pytest.fixture(scope="module")
def tab(open_page):
    page = open_page("lab.html")
    page.tab.set_default_timeout(600_000)
    page.tab.wait_for_function("Boolean(window.PF && PF.Python)")
    yield page.tab
    page.tab.context.close()


@pytest.mark.parametrize("name", names())
def test_the_page_judges_as_python_does(tab, name):
    space: dict = {}
    exec(SCRIPT, space)
    unlike = {}
    for item in space["import_module"](f"pfkit.labs.{name}").LAB.items:
        call = f"\nprint(json.dumps(verdicts({name!r}, {item!r}, {EVERY})))"
        report = tab.evaluate(ASK, [SCRIPT + call])
        assert not report["error"], f"{item}: {report['error']}"
        page, here = json.loads(report["text"]), space["verdicts"](name, item, EVERY)
        if page != here:
            unlike[item] = [pair for pair in zip(here, page, strict=True) if pair[0] != pair[1]]
    assert not unlike
