"""Lab cells answered in a real browser: wrong, right, broken, stopped, exported, imported."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest
from reader import Reader

pytestmark = pytest.mark.page
ROOT = Path(__file__).resolve().parents[2]
AVERAGE = "def circular_mean(theta, w):\n    return np.sum(theta * w) / np.sum(w)\n"
CIRCULAR = (
    "def circular_mean(theta, w):\n"
    "    return np.arctan2((w * np.sin(theta)).sum(), (w * np.cos(theta)).sum())\n"
)
# Ways to break an answer that has passed, by the keys that a hand would press in it.
BREAK = {
    "colon deleted": ("ArrowUp", "ArrowUp", "End", "Backspace"),
    "retrun": ("ArrowUp", "Home", "Control+ArrowRight", "Backspace", "Backspace", "n", "r"),
    "emptied": ("Control+a", "Delete"),
    "renamed": ("Control+Home", "End", *["ArrowLeft"] * 11, "Backspace"),
    "pass": ("ArrowUp", "Home", "Shift+End", *"pass"),
    "dots": ("ArrowUp", "Home", "Shift+End", *"..."),
    "only a comment": ("Control+Home", "#", "ArrowDown", "Home", "#"),
    "indentation": ("ArrowUp", "Home", "Shift+Tab"),
    "None": ("Control+a", *"circular_mean = None"),
    "unknown name": ("Control+Home", *"nothing", "Enter"),
    "bracket deleted": ("ArrowUp", "End", "Backspace"),
    "one line deleted": ("ArrowUp", "Shift+ArrowUp", "Shift+Home", "Delete"),
    "raises": ("Control+End", *"1/0"),
}


@pytest.fixture(scope="module")
def lab(open_page):
    """The lab page over http; Python boots with the first answer."""
    return Reader(open_page("lab.html"))


def press(lab, keys):
    for key in keys:
        lab.tab.keyboard.press("Space" if key == " " else key)


def test_only_answer_cells_become_editors(lab):
    assert lab.tab.locator(".pf-answer").count() == 3
    assert lab.tab.locator("div.cell").count() == 3  # imports, use, print
    assert not [u for u in lab.page.requests if "pyodide" in u]  # nobody asked yet


@pytest.mark.parametrize("how", ["cut", "stalled"])
def test_a_download_that_fails_can_be_tried_again(open_page, how):
    page = open_page("lab.html")
    reader = Reader(page)
    page.tab.evaluate("() => { PF.patience.seconds = 5; }")
    page.tab.route("**/numpy.zip*", lambda route: route.abort() if how == "cut" else None)
    reader.type("p1a", "6 * 7")
    reader.press("p1a", "Run")
    again = reader.group("p1a").get_by_role("button", name="Try again")
    again.wait_for()
    assert "Python could not be loaded" in reader.said("p1a")
    page.tab.unroute("**/numpy.zip*")
    page.tab.evaluate("() => { PF.patience.seconds = 60; }")
    again.click()
    assert "42" in reader.wait("p1a") and not again.is_visible()
    page.tab.context.close()


def test_few_words_while_loading_then_wrong_gets_its_hint(lab):
    """A screen reader hears at most four sentences; the numbers that run are only seen."""
    lab.type("p5b", AVERAGE)
    lab.tab.evaluate(
        """() => {
          window.said = [];
          const live = "[aria-live], [role=status], [role=alert]";
          new MutationObserver((changes) => {
            for (const { target } of changes) {
              const at = target.nodeType === 1 ? target : target.parentElement;
              const region = at && at.closest(live);
              if (region && region.textContent) window.said.push(region.textContent);
            }
          }).observe(document.body, { childList: true, characterData: true, subtree: true });
        }"""
    )
    lab.press("p5b", "Check")
    told = lab.wait("p5b")
    assert "p5b: wrong" in told and "averages the angles as plain numbers. Hint 1 of 3" in told
    said = lab.tab.evaluate("window.said")
    assert 2 <= len(said) <= 4, said
    assert said[0] == "Starting Python." and said[-1].startswith("Checked: wrong")


def test_then_right(lab):
    told = lab.answer("p5b", CIRCULAR)
    assert "p5b: passed 3/3" in told
    assert lab.status("p5b") == "passed" and lab.verdict("p5b") == "passed 3/3"
    assert lab.said("p5b").startswith("Checked: passed 3/3.")


@pytest.mark.parametrize("how", BREAK)
def test_a_broken_answer_does_not_pass(lab, how):
    """Not even when it has passed before; mended, it passes again."""
    if lab.code("p5b") != CIRCULAR:
        lab.type("p5b", CIRCULAR)
    lab.press("p5b", "Check")
    assert "p5b: passed" in lab.wait("p5b")
    lab.focus("p5b")
    press(lab, ["Control+End", *BREAK[how]])
    assert lab.code("p5b") != CIRCULAR
    assert lab.verdict("p5b") == "passed 3/3, edited since"
    assert lab.group("p5b").get_attribute("data-stale") is not None
    lab.press("p5b", "Check")
    told = lab.wait("p5b")
    assert "passed" not in told and lab.status("p5b") != "passed", told
    assert "passed" not in lab.verdict("p5b")


def test_what_does_not_parse_is_told_with_its_line_and_a_caret(lab):
    told = lab.answer("p5b", "def circular_mean(theta, w)\n    return 1")
    line = "def circular_mean(theta, w)"
    assert told == f"SyntaxError in line 1: expected ':'\n  {line}\n  {' ' * len(line)}^"


def test_another_cell_does_not_answer_for_an_empty_one(lab):
    assert "passed" in lab.answer("p5b", CIRCULAR)
    lab.answer("p1a", "p1a = 'c'\n" + CIRCULAR, "Run")
    assert "binds no circular_mean" in lab.answer("p5b", "")
    assert "passed" in lab.answer("p5b", CIRCULAR)


def test_a_verdict_is_about_the_text_it_judged(lab):
    """Grey when the text changes, back with the text, and marked as earlier after a reload."""
    lab.focus("p5b")
    press(lab, ["Control+End", *"# x"])
    assert lab.verdict("p5b") == "passed 3/3, edited since"
    press(lab, ["Backspace"] * 3)
    assert lab.verdict("p5b") == "passed 3/3"
    lab.press("p5b", "Reset")
    assert lab.verdict("p5b") == "passed 3/3, edited since"
    lab.focus("p5b")
    press(lab, ["Control+z"])
    assert lab.code("p5b") == CIRCULAR and lab.verdict("p5b") == "passed 3/3"
    lab.tab.wait_for_timeout(500)
    lab.tab.reload()
    Reader(lab.page)
    assert lab.verdict("p5b") == "earlier: passed 3/3" and lab.status("p5b") == "passed"
    lab.press("p5b", "Check")
    lab.wait("p5b")
    assert lab.verdict("p5b") == "passed 3/3"


def test_unanswered_says_so(lab):
    assert "unanswered" in lab.answer("p1a", "p1a = ...")


def test_an_error_names_the_line(lab):
    told = lab.answer("p1a", "p1a = 1 / 0")
    assert "ZeroDivisionError: division by zero (line 1 of the cell)" in told


def test_a_letter_is_chosen_and_writes_the_code(lab):
    from pfkit.labs.lab3 import LAB

    group, options = lab.group("p1a"), LAB.items["p1a"].options
    lab.type("p1a", "p1a = ...")
    assert group.get_by_role("radio").count() == len(options)
    for letter, says in options.items():
        assert group.get_by_label(f"({letter}) {says}").count() == 1
    group.get_by_label("(b)").check()
    assert lab.code("p1a") == 'p1a = "b"'
    lab.press("p1a", "Check")
    right = LAB.items["p1a"].key == "b"
    assert f"p1a: {'passed' if right else 'wrong'}" in lab.wait("p1a")


def test_the_list_above_is_not_read_twice(lab):
    above = lab.tab.locator("ul", has_text="(a)")
    assert above.count() == 1 and not above.is_visible()


def test_code_and_buttons_say_the_same(lab):
    group = lab.group("p1a")
    lab.type("p1a", "p1a = 'c'  # I think")
    assert group.get_by_label("(c)").is_checked()
    lab.type("p1a", "p1a = ...")
    assert not group.get_by_role("radio", checked=True).count()
    lab.type("p1a", 'p1a = "b".lower()')  # what the buttons cannot show is shown as code
    assert group.locator(".cm-content").is_visible()
    assert not group.get_by_role("radio", checked=True).count()
    group.locator("summary", has_text="Show code").click()
    assert not group.locator(".cm-content").is_visible()


def test_a_choice_is_made_by_keyboard_alone(lab):
    group, keys = lab.group("p1a"), lab.tab.keyboard
    lab.type("p1a", "p1a = ...")
    group.locator("summary", has_text="Show code").click()
    group.get_by_role("radio").first.focus()
    keys.press("Space")
    keys.press("ArrowDown")
    assert lab.code("p1a") == 'p1a = "b"' and group.get_by_label("(b)").is_checked()
    names = []
    for _ in range(3):
        keys.press("Tab")
        names.append(lab.tab.evaluate("document.activeElement.textContent"))
    assert names == ["Show code", "Check", "Reset"]


@pytest.mark.parametrize(
    ("sure", "told"),
    [
        (None, "First say how sure you are"),
        ("250", "from 0 to 100 per cent, such as 70. 250 is not."),
        ("-3", "-3 is not."),
        ("0.7", "Write 70, not 0.7."),
        ("e", "from 0 to 100"),
    ],
)
def test_a_prediction_without_a_confidence_is_not_locked(lab, sure, told):
    group, field = lab.group("p4a"), lab.group("p4a").get_by_label("How sure are you?")
    lab.choose("p4a", "a", sure or "")
    lab.press("p4a", "Lock prediction")
    assert told in lab.said("p4a")
    assert told in group.locator(".pf-problem-text").inner_text()
    assert field.evaluate("e => e === document.activeElement")
    assert field.get_attribute("aria-invalid") == "true"
    assert group.get_by_label("(b)").is_enabled()


def test_code_with_a_bare_letter_is_not_locked_either(lab):
    lab.type("p4a", 'p4a = "a".lower()')
    lab.press("p4a", "Lock prediction")
    assert "how sure" in lab.wait("p4a") and lab.group("p4a").get_by_label("(b)").is_enabled()
    lab.press("p4a", "Reset")
    lab.group("p4a").locator("summary", has_text="Show code").click()


def test_a_prediction_is_locked(lab):
    lab.choose("p4a", "a", "70")
    lab.press("p4a", "Lock prediction")
    assert "70 % sure; locked" in lab.wait("p4a")
    assert lab.code("p4a") == 'p4a = ("a", 70)'
    lab.locked("p4a")


def test_a_locked_prediction_stays_whatever_the_code_says(lab):
    group = lab.group("p4a")
    lab.type("p4a", 'p4a = ("b", 70)')
    lab.press("p4a", "Lock prediction")
    assert "it stays (a)" in lab.wait("p4a")
    group.locator("summary", has_text="Show code").click()
    lab.locked("p4a")


def test_run_prints_and_keyboard_runs(lab):
    lab.type("p1a", "p1a = 'b'\nprint('hello', 6 * 7)")
    lab.tab.keyboard.press("Shift+Enter")
    lab.group("p1a").locator(".pf-out", has_text="hello 42").wait_for()


def test_output_is_text_whatever_it_says(lab):
    told = lab.answer("p1a", "print('<img src=x onerror=alert(1)>')", "Run")
    assert "<img" in told and lab.tab.locator("img[src=x]").count() == 0


@pytest.mark.parametrize(
    ("source", "told"),
    [
        ("p1a = input('Which? ')", "input() has nobody to ask in this page"),
        ("import pandas as pd", "pandas is not in this page"),
        ("import matplotlib.pyplot as plt\nplt.plot([1, 2])", "run the cell in Jupyter to see"),
        ("def f(): return f()\nf()", "it calls itself without end"),
        ("while True: print('x' * 999_999)", "Stopped after"),
        ("for k in range(10**5): print(k)", "more characters]"),
        ("type('Odd', (), {'status': np})()", "<__main__.Odd object"),
        ("raise SystemExit", "SystemExit"),
        ("import os\nos._exit(3)", "Python starts anew with your next run"),
    ],
)
def test_sentences_instead_of_stack_traces(lab, source, told):
    lab.tab.evaluate("PF.lab.limit.seconds = 6")
    said = lab.answer("p1a", source, "Run")
    assert told in said and "Traceback" not in said and len(said) < 21_000
    assert "42" in lab.answer("p1a", "6 * 7", "Run")  # the page goes on
    lab.tab.evaluate("PF.lab.limit.seconds = 30")


def test_a_hang_is_stopped_and_names_come_back(lab):
    """By the button, then by the clock; the next check runs the cells above again by itself."""
    lab.type("p5b", "while True: pass")
    lab.press("p5b", "Run")
    lab.group("p5b").locator(".pf-note", has_text="Running").wait_for()
    lab.press("p5b", "Stop")
    assert "Stopped by you" in lab.wait("p5b")
    lab.tab.evaluate("PF.lab.limit.seconds = 2")
    lab.press("p5b", "Run")
    assert "Stopped after 2 s" in lab.wait("p5b")
    lab.tab.evaluate("PF.lab.limit.seconds = 30")
    assert "p5b: passed" in lab.answer("p5b", CIRCULAR)
    lab.type("p4a", 'p4a = ("c", 70)')
    lab.press("p4a", "Lock prediction")
    assert "it stays (a)" in lab.wait("p4a")  # the prediction came back too
    lab.group("p4a").locator("summary", has_text="Show code").click()


def test_a_hang_does_not_stop_the_explorables(lab):
    lab.tab.evaluate("window.other = new PF.Python('scenes')")
    lab.tab.evaluate(
        "other.ask({ do: 'open', key: 'k', name: 'comb', panel: null, seed: 1 }).then(() => 1)"
    )
    lab.type("p1a", "while True: pass")
    lab.press("p1a", "Run")
    ticks = lab.tab.evaluate(
        "other.ask({ do: 'run', key: 'k', operations: '[[\"step\", 5]]' })"
        ".then(a => JSON.parse(a.report).ticks)"
    )
    assert ticks == 5
    lab.press("p1a", "Stop")
    lab.wait("p1a")
    lab.tab.evaluate("other.stop()")


def export(lab):
    with lab.tab.expect_download() as download:
        lab.tab.get_by_role("button", name="Export answers").first.click()
    assert download.value.suggested_filename == "lab3_answers.json"
    return json.loads(download.value.path().read_text(encoding="utf-8"))


def test_export_has_the_schema_of_the_notebook(lab):
    from pfkit.labs.lab3 import LAB
    from pfkit.labs.progress import parse

    lab.type("p1a", "p1a = 'b'")
    parsed = parse(json.dumps(export(lab)), "lab3")
    assert parsed["answers"]["p5b"]["source"] == CIRCULAR
    assert parsed["predictions"]["p4a"]["choice"] == "a"
    assert parsed["answers"]["p5b"]["version"] == LAB.items["p5b"].version


def test_an_export_is_graded_like_the_notebook(lab, tmp_path):
    """The page's file and a notebook with the same answers earn the same points."""
    data = export(lab)
    (course,) = (ROOT / "notebooks" / "labs").glob("lab3_*.ipynb")
    notebook = json.loads(course.read_text(encoding="utf-8"))
    for cell in notebook["cells"]:
        item = cell["metadata"].get("answer")
        if item in data["answers"]:
            cell["source"] = data["answers"][item]["source"]
    folder = tmp_path / "handed_in"
    folder.mkdir()
    (folder / "page.json").write_text(json.dumps(data), encoding="utf-8")
    (folder / "desk.ipynb").write_text(json.dumps(notebook), encoding="utf-8")
    grades = tmp_path / "grades.csv"
    command = [sys.executable, "-m", "pfkit.labs.grade", "lab3", str(folder), "-o", str(grades)]
    subprocess.run([*command, "--jobs", "2"], check=True, capture_output=True)
    with grades.open(encoding="utf-8", newline="") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert {row["status"] for row in rows.values()} == {"ok"}, rows
    assert rows["page"]["score"] == rows["desk"]["score"]
    assert float(rows["page"]["score"]) > 0 and rows["page"]["p5b"] == rows["desk"]["p5b"]


def import_file(lab, text):
    """Choose a file, as a reader does; returns what the page says of it."""
    note = lab.tab.locator(".pf-labbar .pf-note")
    before = note.evaluate("(e) => { e.textContent = ''; }")
    assert before is None
    lab.tab.locator("#pf-import").set_input_files(
        {"name": "a.json", "mimeType": "application/json", "buffer": text.encode()}
    )
    lab.tab.wait_for_function("document.querySelector('.pf-labbar .pf-note').textContent")
    return note.inner_text()


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("{", "Nothing was imported"),
        ("[]", "schema is not 1"),
        ('{"schema": 1, "lab": "lab9", "answers": {}}', "another lab"),
        ('{"schema": 1, "lab": "lab3"}', "no answers"),
        ('{"schema": 1, "lab": "lab3", "answers": {"p1a": {"source": 7}}}', "Imported 0"),
        ('{"schema": 1, "lab": "lab3", "answers": {"__proto__": {"source": "x"}}}', "Imported 0"),
        (
            '{"schema": 1, "lab": "lab3", "answers": {"p1a": {"source": '
            '"</script><img src=x onerror=alert(1)>", "version": "<b>"}}}',
            "Imported 1",
        ),
    ],
)
def test_a_hostile_file_is_data_only(lab, text, why):
    assert why in import_file(lab, text)
    assert lab.tab.locator("img[src=x]").count() == 0 and not lab.page.errors


def test_the_notebooks_own_file_is_read_as_well(lab):
    data = {"schema": 1, "lab": "lab3", "answers": {"p1a": {"source": "'b'", "version": "x"}}}
    assert "earlier version" in import_file(lab, json.dumps(data))
    assert lab.code("p1a") == "p1a = 'b'"


def test_nothing_left_the_page(lab):
    assert not lab.page.outside() and not lab.page.errors


@pytest.mark.parametrize(
    ("prediction", "locked"),
    [
        ({"choice": "<b>", "sure": 50}, False),
        ({"choice": "z", "sure": 50}, False),
        (["a"], False),
        ("a", False),
        ({"choice": "c", "sure": "<img src=x onerror=alert(1)>", "version": {}}, True),
    ],
)
def test_predictions_are_imported_as_data(open_page, prediction, locked):
    page = open_page("lab.html")
    fresh = Reader(page)
    data = {"schema": 1, "lab": "lab3", "answers": {}, "predictions": {"p4a": prediction}}
    import_file(fresh, json.dumps(data))
    assert fresh.group("p4a").get_by_label("(c)").is_checked() is locked
    assert fresh.group("p4a").get_by_label("(c)").is_disabled() is locked
    assert list(export(fresh)["predictions"]) == (["p4a"] if locked else []) and not page.errors
    page.tab.context.close()
