"""Replays: how often a right answer fails and a wrong one passes; the committed table of rates.

Most rates are measured by `tools/replay.py`, in a stage of its own.
"""

import pytest
import replay as tool

from pfkit.labs import Experiment, catalogue
from pfkit.labs.replay import upper_bound

LABS = catalogue.all_labs()
ITEMS = [
    (lab, i)
    for lab in LABS
    for i in LABS[lab].items.values()
    if i.letter in tool.LAZY and lab not in tool.UNMEASURED
]


def test_upper_bound_is_the_rule_of_three():
    assert upper_bound(0, 3000) == pytest.approx(3 / 3000, rel=0.01)
    assert upper_bound(5, 100) == pytest.approx(0.1023, abs=1e-3)  # Clopper-Pearson, tables


@pytest.mark.parametrize(("lab", "item"), ITEMS, ids=lambda x: getattr(x, "id", x))
def test_an_item_whose_rates_are_not_known_cannot_be_published(lab, item):
    rates = tool.read_table()[lab]["items"][item.id]
    assert rates["refused"].keys() == {r.says for r in item.refused}
    assert rates["named"].keys() == {m.name for m in item.misconceptions}
    assert tool.problems(lab, {item.id: rates}) == []
    if isinstance(item, Experiment):
        assert item.false_fail <= 1e-3 and item.margin
        assert rates["right"] == [0, tool.DECISIONS]
        assert upper_bound(*rates["right"]) <= 1e-3


def test_labs_that_are_pending_are_those_that_still_lack_lists():
    rates = {lab: tool.read_table()[lab]["items"] for lab in tool.PENDING}
    for lab, items in rates.items():
        few = [i for i, r in items.items() if len(r["refused"]) < tool.LAZY[r["letter"]]]
        assert few, f"{lab} is complete: take it from PENDING"


def test_what_is_known_to_fall_short_still_does():
    for lab, item, says in tool.SHORT:
        rates = tool.read_table()[lab]["items"][item]
        assert (rates["refused"] | rates["named"])[says] < tool.LEAST, f"{says}: take it from SHORT"


def rates(**changed):
    good = {
        "letter": "X", "title": "t", "right": [0, 3000],
        "refused": {f"lazy {k}": 1.0 for k in range(5)}, "named": {"slip": 0.97},
    }  # fmt: skip
    return {"x": good | changed}


@pytest.mark.parametrize(
    ("changed", "says"),
    [
        ({"right": [3, 3000]}, "a right answer fails 3 of 3000"),
        ({"refused": {"a constant": 0.5}}, "refused in only 50 %: a constant"),
        ({"named": {"slip": 0.9}}, "named in only 90 %: slip"),
        ({"refused": {}}, "knows 0 answers that must not pass, not 5"),
    ],
)
def test_each_fault_is_told(changed, says):
    assert any(says in p for p in tool.problems("resampling", rates(**changed)))
    assert tool.problems("resampling", rates()) == []


def test_the_page_shows_the_table():
    assert tool.PAGE.read_text(encoding="utf-8") == tool.fill_page(tool.read_table())
    row = tool.page_table({"resampling": {"items": rates()}}).splitlines()[-1]
    assert row == "| resampling | x | X | 0 of 3,000 | 5, at least 100 % | 1, at least 97 % |"


def test_a_changed_module_makes_its_labs_stale():
    table = {"a": {"files": ["pfkit/labs/replay.py"], "stamp": ""}}
    assert tool.stale_labs(table, ["a", "b"]) == ["a", "b"]
    table["a"]["stamp"] = tool.stamp(table["a"]["files"])
    assert tool.stale_labs(table, ["a"]) == []
