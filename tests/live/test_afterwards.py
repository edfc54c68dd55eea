"""What the page offers after a check: rubric to tick, worked answer, and numbers of one's own."""

from __future__ import annotations

import json

import pytest
from reader import Reader

from pfkit.labs import spaced_review
from pfkit.labs.lab3 import LAB

pytestmark = pytest.mark.page
TEXT = 'p3c = "No particle is left near the truth and the narrow cloud does not warn us."'
WRONG = "def circular_mean(theta, w):\n    return np.sum(theta * w)"


def typed(lab, field, text):
    """Put a text into a field as a reader does: what stands there is selected, then keys."""
    field.click()
    lab.tab.keyboard.press("Control+a")
    lab.tab.keyboard.type(text)


@pytest.fixture(scope="module")
def lab(open_page):
    return Reader(open_page("afterwards.html"))


def export(lab):
    with lab.tab.expect_download() as download:
        lab.tab.get_by_role("button", name="Export answers").first.click()
    return json.loads(download.value.path().read_text(encoding="utf-8"))


def test_before_a_check_nothing_is_given_away(lab):
    assert not lab.group("p3c").get_by_role("checkbox").first.is_visible()
    assert not lab.group("p5b").locator(".pf-worked").is_visible()
    assert lab.tab.locator("div.cell", has_text="lab.solution").count() == 0, "a dead cell"


def test_the_rubric_is_ticked_by_keyboard_kept_and_exported(lab):
    assert "p3c: recorded" in lab.answer("p3c", TEXT)
    boxes = lab.group("p3c").get_by_role("checkbox")
    assert boxes.count() == len(LAB.items["p3c"].rubric)
    boxes.nth(1).focus()
    lab.tab.keyboard.press("Space")
    assert export(lab)["ticks"] == {"p3c": [2]}
    lab.tab.reload()
    again = Reader(lab.page)
    boxes = again.group("p3c").get_by_role("checkbox")
    assert [boxes.nth(k).is_checked() for k in (0, 1)] == [False, True]
    assert boxes.nth(1).is_visible()


def test_the_worked_answer_comes_after_three_hints_and_stays(lab):
    worked = lab.group("p5b").locator(".pf-worked")
    for seen in (False, False, True):
        assert "p5b: " in lab.answer("p5b", WRONG)
        assert worked.is_visible() is seen
    worked.locator("summary").click()
    worked.locator("pre", has_text="def circular_mean").wait_for()
    assert worked.locator("pre").text_content() == LAB.items["p5b"].worked()
    lab.tab.reload()
    Reader(lab.page)
    assert worked.is_visible()


def test_numbers_of_ones_own_are_asked_judged_kept_and_exported(lab):
    try:
        LAB.student("jo17", "spring")
        mine, asked = LAB.items["p1b"].key, LAB.items["p1b"].asked()
    finally:
        LAB.forget()
    printed = f"p1b = {LAB.items['p1b'].key!r}"
    assert "p1b: passed" in lab.answer("p1b", printed)
    lab.tab.locator(".pf-student summary").click()
    typed(lab, lab.tab.get_by_label("Your id"), "jo17")
    typed(lab, lab.tab.get_by_label("Term"), "spring")
    lab.tab.keyboard.press("Enter")
    question = lab.group("p1b").locator(".pf-own")
    question.wait_for()
    assert question.text_content() == f"Your question: {asked}"
    assert not lab.status("p1b"), "what was judged was another question"
    assert lab.status("p3c") == "recorded", "what asks the same of all stays judged"
    lab.tab.reload()
    lab = Reader(lab.page)
    assert question.text_content() == f"Your question: {asked}"
    assert "p1b: passed" not in lab.answer("p1b", printed)
    assert "p1b: passed" in lab.answer("p1b", f"p1b = {mine!r}")
    assert export(lab)["student"] == {"who": "jo17", "term": "spring"}
    assert not lab.page.errors and not lab.page.outside()


WEEK = 7 * 86_400_000
OLD = (
    "() => localStorage.setItem('where-am-i/1/lab3/*review', JSON.stringify({ items: { p1b: "
    f"{{ day: new Date(Date.now() - {WEEK}).toISOString().slice(0, 10), times: 1 }} }} }}))"
)


def test_a_solved_problem_comes_back_after_a_week_with_other_numbers(lab):
    review = lab.tab.locator(".pf-review")
    assert not review.is_visible(), "it was solved a minute ago"
    assert export(lab)["review"]["items"]["p1b"]["times"] == 0
    lab.tab.evaluate(OLD)
    lab.tab.reload()
    lab = Reader(lab.page)
    review.locator("summary").focus()
    lab.tab.keyboard.press("Enter")
    mine = problem_of("jo17", "p1b", 1)
    review.get_by_text(mine.asked()).wait_for()
    form = review.get_by_role("form", name="Review p1b")
    typed(lab, form.get_by_label("Your answer"), "7, 7, 7")
    lab.tab.keyboard.press("Enter")
    form.locator(".pf-note", has_text="not yet").wait_for()
    typed(lab, form.get_by_label("Your answer"), ", ".join(map(str, mine.key)))
    lab.tab.keyboard.press("Enter")
    form.locator(".pf-note", has_text="right. It comes back in 7 days.").wait_for()
    assert export(lab)["review"]["items"]["p1b"]["times"] == 2
    lab.tab.reload()
    Reader(lab.page)
    assert not review.is_visible()


def test_reviews_can_be_switched_off(lab):
    lab.tab.evaluate(OLD)
    lab.tab.reload()
    review = lab.tab.locator(".pf-review")
    review.locator("summary").click()
    review.get_by_label("Do not offer reviews").check()
    assert export(lab)["review"]["off"] is True
    lab.tab.reload()
    Reader(lab.page)
    assert not review.is_visible()


def problem_of(who, item, times):
    try:
        LAB.student(who, "spring")
        return spaced_review.problem(LAB, item, times)
    finally:
        LAB.forget()


@pytest.mark.parametrize(
    "told",
    [
        {"ticks": {"p3c": ["<img>", 9, 1]}, "student": {"who": "<img src=x>", "term": 7}},
        {"ticks": [], "student": "jo"},
        {"ticks": {"__proto__": [1]}, "student": {"who": {}}},
    ],
)
def test_ticks_and_ids_of_a_file_are_data(lab, told):
    empty = {"schema": 1, "lab": "lab3", "answers": {}, "predictions": {}}
    lab.tab.locator("#pf-import").set_input_files(
        {"name": "a.json", "mimeType": "application/json",
         "buffer": json.dumps(empty | told).encode()}
    )  # fmt: skip
    lab.tab.locator(".pf-labbar .pf-note", has_text="Imported 0").wait_for()
    assert set(export(lab)["ticks"].get("p3c", [])) <= {1, 2}
    assert lab.tab.locator("img[src=x]").count() == 0 and not lab.page.errors
