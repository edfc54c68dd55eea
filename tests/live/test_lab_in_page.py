"""Lab cells answered in a real browser: wrong, right, stopped, kept, exported, imported."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from pathlib import Path

import pytest

pytestmark = pytest.mark.page
ROOT = Path(__file__).resolve().parents[2]
AVERAGE = "def circular_mean(theta, w):\n    return np.sum(theta * w) / np.sum(w)\n"
CIRCULAR = (
    "def circular_mean(theta, w):\n"
    "    return np.arctan2((w * np.sin(theta)).sum(), (w * np.cos(theta)).sum())\n"
)
FULL = (
    "Storage.prototype.setItem = () => { throw new DOMException('full', 'QuotaExceededError'); };"
)


class Lab:
    """The lab page and the verbs of its reader."""

    def __init__(self, page):
        self.page, self.tab = page, page.tab
        self.tab.wait_for_function("window.PF && PF.lab", timeout=30_000)

    def find(self, item):
        return f"PF.lab.editors.find(e => e.cell.item === {json.dumps(item)})"

    def write(self, item, source):
        self.tab.evaluate(f"{self.find(item)}.set({json.dumps(source)})")

    def press(self, item, button):
        self.tab.get_by_role("group", name=f"Answer {item}").get_by_role(
            "button", name=button
        ).click()

    def wait(self, item):
        self.tab.wait_for_function(f"!{self.find(item)}.runButton.disabled", timeout=90_000)
        return self.output(item)

    def output(self, item):
        return self.tab.evaluate(f"{self.find(item)}.out.textContent")

    def answer(self, item, source, button="Check"):
        self.write(item, source)
        self.press(item, button)
        return self.wait(item)

    def locked(self, item):
        """Its prediction is (a), 70 % sure, and cannot be changed."""
        group = self.group(item)
        assert group.get_by_label("(a)").is_checked() and group.get_by_label("(b)").is_disabled()
        assert "Locked: (a), 70 % sure." in group.inner_text()
        assert not group.get_by_role("button").count()

    def group(self, item):
        return self.tab.get_by_role("group", name=f"Answer {item}", exact=True)

    def code(self, item):
        return self.tab.evaluate(f"{self.find(item)}.get()")

    def note(self):
        return self.tab.locator(".pf-labbar .pf-note").inner_text()


@pytest.fixture(scope="module")
def lab(open_page):
    """The lab page over http; Python boots with the first answer."""
    return Lab(open_page("lab.html"))


def test_only_answer_cells_become_editors(lab):
    assert lab.tab.locator(".pf-answer").count() == 3
    assert lab.tab.locator("div.cell").count() == 3  # imports, use, print
    assert not [u for u in lab.page.requests if "pyodide" in u]  # nobody asked yet


def test_wrong_gets_its_hint_then_right(lab):
    told = lab.answer("p5b", AVERAGE)
    assert "p5b: wrong" in told and "averages the angles as plain numbers. Hint 1 of 3" in told
    told = lab.answer("p5b", CIRCULAR)
    assert "p5b: passed 3/3" in told
    status = lab.tab.evaluate(f"{lab.find('p5b')}.root.dataset.status")
    assert status == "passed"


def test_unanswered_says_so(lab):
    assert "unanswered" in lab.answer("p1a", "p1a = ...")


def test_an_error_names_the_line(lab):
    assert "ZeroDivisionError: division by zero (line 1)" in lab.answer("p1a", "p1a = 1 / 0")


def test_a_letter_is_chosen_and_writes_the_code(lab):
    from pfkit.labs.lab3 import LAB

    group, options = lab.group("p1a"), LAB.items["p1a"].options
    lab.write("p1a", "p1a = ...")
    assert group.get_by_role("radio").count() == len(options)
    for letter, says in options.items():
        assert group.get_by_label(f"({letter}) {says}").count() == 1
    group.get_by_label("(b)").check()
    assert lab.code("p1a") == 'p1a = "b"'
    group.get_by_role("button", name="Check").click()
    right = LAB.items["p1a"].key == "b"
    assert f"p1a: {'passed' if right else 'wrong'}" in lab.wait("p1a")


def test_the_list_above_is_not_read_twice(lab):
    above = lab.tab.locator("ul", has_text="(a)")
    assert above.count() == 1 and not above.is_visible()


def test_code_and_buttons_say_the_same(lab):
    group = lab.group("p1a")
    lab.write("p1a", "p1a = 'c'  # I think")
    assert group.get_by_label("(c)").is_checked()
    lab.write("p1a", "p1a = ...")
    assert not group.get_by_role("radio", checked=True).count()
    lab.tab.evaluate(f"{lab.find('p1a')}.disclosure.open = false")
    assert not group.locator(".cm-content").is_visible()
    lab.write("p1a", 'p1a = "b".lower()')  # what the buttons cannot show is shown as code
    group.locator(".cm-content").wait_for(state="visible")
    assert not group.get_by_role("radio", checked=True).count()


def test_a_choice_is_made_by_keyboard_alone(lab):
    group, keys = lab.group("p1a"), lab.tab.keyboard
    lab.write("p1a", "p1a = ...")
    lab.tab.evaluate(f"{lab.find('p1a')}.disclosure.open = false")
    group.get_by_role("radio").first.focus()
    keys.press("Space")
    keys.press("ArrowDown")
    assert lab.code("p1a") == 'p1a = "b"' and group.get_by_label("(b)").is_checked()
    names = []
    for _ in range(3):
        keys.press("Tab")
        names.append(lab.tab.evaluate("document.activeElement.textContent"))
    assert names == ["Show code", "Check", "Reset"]


def test_a_prediction_is_locked(lab):
    group = lab.group("p4a")
    group.get_by_label("(a)").check()
    group.get_by_label("How sure are you?").fill("170")
    group.get_by_label("How sure are you?").blur()
    assert lab.code("p4a") == 'p4a = ("a", 100)'
    group.get_by_label("How sure are you?").fill("70")
    group.get_by_role("button", name="Lock prediction").click()
    assert "70 % sure; locked" in lab.wait("p4a")
    assert lab.code("p4a") == 'p4a = ("a", 70)'
    lab.locked("p4a")
    lab.write("p4a", 'p4a = ("b", 70)')
    lab.tab.evaluate(f"{lab.find('p4a')}.run(true)")
    assert "it stays (a)" in lab.wait("p4a")
    lab.locked("p4a")


def test_run_prints_and_keyboard_runs(lab):
    lab.write("p1a", "p1a = 'b'\nprint('hello', 6 * 7)")
    lab.tab.evaluate(f"{lab.find('p1a')}.editor.focus()")
    lab.tab.keyboard.press("Shift+Enter")
    lab.tab.wait_for_function(f"{lab.find('p1a')}.out.textContent.includes('hello 42')")


def test_escape_leaves_the_editor(lab):
    lab.tab.evaluate(f"{lab.find('p5b')}.editor.focus()")
    lab.tab.keyboard.press("Escape")
    lab.tab.keyboard.press("Tab")
    assert lab.tab.evaluate("document.activeElement.textContent") != ""
    assert not lab.tab.evaluate("document.activeElement.classList.contains('cm-content')")


def test_reset_can_be_undone(lab):
    stub = lab.tab.evaluate(f"{lab.find('p5b')}.cell.source")
    lab.write("p5b", AVERAGE)
    lab.press("p5b", "Reset")
    assert lab.code("p5b") == stub
    lab.tab.evaluate(f"{lab.find('p5b')}.editor.focus()")
    lab.tab.keyboard.press("Control+z")
    assert lab.code("p5b") == AVERAGE
    lab.write("p5b", CIRCULAR)


def test_output_is_text_whatever_it_says(lab):
    told = lab.answer("p1a", "print('<img src=x onerror=alert(1)>')", "Run")
    assert "<img" in told and lab.tab.locator("img[src=x]").count() == 0


def test_a_reload_restores_the_answers(lab):
    lab.write("p1a", "p1a = 'b'  # kept")
    lab.write("p5b", CIRCULAR)
    lab.tab.wait_for_function("Object.keys(localStorage).some(k => k.endsWith('/p1a'))")
    lab.tab.wait_for_timeout(400)
    lab.tab.reload()
    lab.tab.wait_for_function("window.PF && PF.lab")
    assert lab.tab.evaluate(f"{lab.find('p1a')}.get()") == "p1a = 'b'  # kept"
    assert lab.tab.evaluate(f"{lab.find('p5b')}.get()") == CIRCULAR
    assert lab.group("p1a").get_by_label("(b)").is_checked()
    lab.locked("p4a")  # before any Python


def test_a_hang_is_stopped_and_names_come_back(lab):
    """By the button, then by the clock; the next check runs the cells above again by itself."""
    lab.write("p5b", "while True:\n    pass")
    lab.press("p5b", "Run")
    stop = lab.tab.get_by_role("group", name="Answer p5b").get_by_role("button", name="Stop")
    lab.tab.wait_for_function(
        f"{lab.find('p5b')}.note.textContent.startsWith('Running')", timeout=90_000
    )
    stop.click()
    assert "stopped by you" in lab.wait("p5b")
    lab.tab.evaluate("PF.lab.limit.seconds = 2")
    lab.press("p5b", "Run")
    assert "stopped after 2 s" in lab.wait("p5b")
    lab.tab.evaluate("PF.lab.limit.seconds = 30")
    assert "p5b: passed" in lab.answer("p5b", CIRCULAR)
    lab.write("p4a", 'p4a = ("c", 70)')
    lab.tab.evaluate(f"{lab.find('p4a')}.run(true)")
    assert "it stays (a)" in lab.wait("p4a")  # the prediction came back too


def test_a_hang_does_not_stop_the_explorables(lab):
    lab.tab.evaluate("window.other = new PF.Python('scenes')")
    lab.tab.evaluate(
        "other.ask({ do: 'open', key: 'k', name: 'comb', panel: null, seed: 1 }).then(() => 1)"
    )
    lab.write("p1a", "while True: pass")
    lab.press("p1a", "Run")
    ticks = lab.tab.evaluate(
        "other.ask({ do: 'run', key: 'k', operations: '[[\"step\", 5]]' })"
        ".then(a => JSON.parse(a.report).ticks)"
    )
    assert ticks == 5
    lab.press("p1a", "Stop")
    lab.wait("p1a")
    lab.tab.evaluate("other.stop()")


def test_export_has_the_schema_of_the_notebook(lab):
    lab.write("p1a", "p1a = 'b'")
    with lab.tab.expect_download() as download:
        lab.tab.get_by_role("button", name="Export answers").click()
    data = json.loads(download.value.path().read_text(encoding="utf-8"))
    assert download.value.suggested_filename == "lab3_answers.json"
    from pfkit.labs.progress import parse

    parsed = parse(json.dumps(data), "lab3")
    assert parsed["answers"]["p5b"]["source"] == CIRCULAR
    assert parsed["predictions"]["p4a"]["choice"] == "a"
    from pfkit.labs.lab3 import LAB

    assert parsed["answers"]["p5b"]["version"] == LAB.items["p5b"].version


def test_an_export_is_graded_like_the_notebook(lab, tmp_path):
    """The page's file and a notebook with the same answers earn the same points."""
    data = lab.tab.evaluate("PF.lab.exportAnswers()")
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
    lab.tab.locator("#pf-import").set_input_files(
        {"name": "a.json", "mimeType": "application/json", "buffer": text.encode()}
    )
    lab.tab.wait_for_function(
        f"document.querySelector('.pf-labbar .pf-note').textContent.includes({json.dumps(why)})"
    )
    assert lab.tab.locator("img[src=x]").count() == 0 and not lab.page.errors


def test_the_notebooks_own_file_is_read_as_well(lab):
    data = {"schema": 1, "lab": "lab3", "answers": {"p1a": {"source": "'b'", "version": "x"}}}
    told = lab.tab.evaluate(
        f"(PF.lab.importAnswers({json.dumps(json.dumps(data))}), {lab.find('p1a')}.get())"
    )
    assert told == "p1a = 'b'" and "earlier version" in lab.note()


def test_an_answer_to_an_older_question_is_offered_not_lost(lab):
    lab.tab.evaluate(
        """localStorage.setItem('where-am-i/1/lab3/p1a',
           JSON.stringify({ source: "p1a = 'old'", version: 'older' }))"""
    )
    lab.tab.evaluate(
        "window.onpagehide = null; PF.lab.editors.forEach(e => { e.save = () => {}; })"
    )
    lab.tab.reload()
    lab.tab.wait_for_function("window.PF && PF.lab")
    group = lab.tab.get_by_role("group", name="Answer p1a")
    assert lab.tab.evaluate(f"{lab.find('p1a')}.get()") == "p1a = ..."
    group.get_by_role("button", name="Use it").click()
    assert lab.tab.evaluate(f"{lab.find('p1a')}.get()") == "p1a = 'old'"


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
    fresh = Lab(page)
    data = {"schema": 1, "lab": "lab3", "answers": {}, "predictions": {"p4a": prediction}}
    fresh.tab.evaluate(f"PF.lab.importAnswers({json.dumps(json.dumps(data))})")
    assert fresh.group("p4a").get_by_label("(c)").is_checked() is locked
    assert fresh.group("p4a").get_by_label("(c)").is_disabled() is locked
    kept = fresh.tab.evaluate("PF.lab.exportAnswers().predictions")
    assert list(kept) == (["p4a"] if locked else []) and not page.errors
    page.tab.context.close()


def test_refused_storage_is_said_and_loses_nothing(open_page):
    page = open_page("lab.html", init=FULL)
    full = Lab(page)
    full.write("p1a", "p1a = 'b'")
    full.tab.wait_for_function(
        "document.querySelector('.pf-labbar .pf-note').textContent.includes('export them')"
    )
    assert full.tab.evaluate(f"{full.find('p1a')}.get()") == "p1a = 'b'"
    page.tab.context.close()
