"""What is done is counted beside each link; the map goes on where the reader was."""

from __future__ import annotations

import json

import pytest

pytestmark = pytest.mark.page
KEPT = "where-am-i/1/"
WRITE = "([k, v]) => localStorage.setItem(k, v)"
COUNT = "nav.bd-links a[href*='lab.html'] .pf-count, nav.bd-links a[href='#'] .pf-count"


@pytest.fixture
def page(open_page):
    opened = open_page("book/map.html")
    yield opened
    assert not opened.errors and not opened.outside()
    opened.tab.context.close()


def keep(page, **values):
    """Put what an earlier visit kept into the browser, and load the page again."""
    for name, value in values.items():
        page.tab.evaluate(
            "([k, v]) => localStorage.setItem(k, v)", [KEPT + name, json.dumps(value)]
        )
    page.tab.reload()


def versions(page):
    return page.tab.evaluate("Object.fromEntries(pfTasks.find((t) => t.page === 'lab').items)")


def record(page, item, source="x = 1", status="passed", judged="x = 1"):
    verdict = {"source": judged, "status": status, "told": "passed 3/3"}
    return {"source": source, "version": versions(page)[item], "judged": verdict}


def said(page):
    return page.tab.locator(".pf-progress > p").all_inner_texts()


def test_at_first_nothing_is_done_and_the_map_says_where_to_begin(page):
    assert page.tab.locator(".pf-back").inner_text() == "Begin: A lab"
    assert page.tab.locator(".pf-count").count() == 0
    assert any(text.startswith("0 of ") for text in said(page))


def test_answers_predictions_and_ticks_are_counted_once_each(page):
    lock = {"schema": 1, "predictions": {"p4a": {"choice": "a", "sure": 70, "version": "x"}}}
    keep(page, **{"lab3/p1a": record(page, "p1a"), "lab3/*predictions": lock})
    assert page.tab.locator(COUNT).inner_text() == "2 of 3"
    assert page.tab.locator(".bd-article table .pf-count").inner_text() == "2 of 3"
    keep(page, **{"missions/comb/comb": ["one", "two"]})
    scenes = page.tab.locator("nav.bd-links a[href*='scenes.html'] .pf-count")
    assert scenes.inner_text().startswith("2 of ")
    assert any(text.startswith("4 of ") for text in said(page))


@pytest.mark.parametrize("change", ["status", "source", "version", "judged"])
def test_what_is_not_passed_as_it_stands_is_not_done(page, change):
    kept = record(page, "p1a")
    if change == "status":
        kept["judged"]["status"] = "failed"
    else:
        kept[change] = {"source": "x = 2", "version": "an earlier one", "judged": None}[change]
    keep(page, **{"lab3/p1a": kept})
    assert page.tab.locator(".pf-count").count() == 0


def test_a_check_that_passes_counts_while_the_page_stands(open_page):
    page = open_page("lab.html")
    assert page.tab.locator(".pf-count").count() == 0
    page.tab.evaluate("([k, v]) => localStorage.setItem(k, v)",
                      [KEPT + "lab3/p1a", json.dumps(record(page, "p1a"))])  # fmt: skip
    page.tab.locator(".pf-count").first.wait_for(timeout=20_000)
    page.tab.context.close()


def test_the_map_goes_on_where_the_reader_was(page):
    page.tab.goto(page.base + "lab.html")
    page.tab.wait_for_selector(".pf-answer")
    page.tab.goto(page.base + "book/map.html")
    back = page.tab.locator(".pf-back")
    assert back.inner_text() == "Continue: A lab"
    back.click()
    page.tab.wait_for_url("**/lab.html")


def exported(page, tmp_path):
    with page.tab.expect_download() as download:
        page.tab.get_by_role("button", name="Export everything").click()
    path = tmp_path / "progress.json"
    download.value.save_as(path)
    return path


def take_in(page, path):
    page.tab.set_input_files(".pf-progress input[type=file]", path)
    page.tab.wait_for_function("document.querySelector('.pf-progress [role=status]').textContent")
    return page.tab.locator(".pf-progress [role=status]").inner_text()


def test_everything_goes_into_a_file_and_comes_back_elsewhere(page, open_page, tmp_path):
    lock = {"schema": 1, "predictions": {"p4a": {"choice": "a", "sure": 70, "version": "x"}}}
    keep(page, **{"lab3/p1a": record(page, "p1a"), "lab3/*predictions": lock,
                  "missions/comb/comb": ["one"]})  # fmt: skip
    path = exported(page, tmp_path)
    other = open_page("book/map.html")
    keep(other, **{"missions/comb/comb": ["two"]})
    assert "new here" in take_in(other, path)
    assert any(text.startswith("4 of ") for text in said(other))
    other.tab.context.close()


def test_an_import_overwrites_neither_answers_nor_locks(page, open_page, tmp_path):
    theirs = {"schema": 1, "predictions": {"p4a": {"choice": "b", "sure": 9, "version": "x"}}}
    keep(page, **{"lab3/p1a": record(page, "p1a"), "lab3/*predictions": theirs})
    path = exported(page, tmp_path)
    other = open_page("book/map.html")
    mine = {"schema": 1, "predictions": {"p4a": {"choice": "a", "sure": 70, "version": "x"}}}
    keep(other, **{"lab3/p1a": record(other, "p1a", source="x = 7"), "lab3/*predictions": mine})
    assert "1 answers differ" in take_in(other, path)
    kept = other.tab.evaluate("PF.Store.everything()")
    assert json.loads(kept["lab3/p1a"])["source"] == "x = 7"
    assert json.loads(kept["lab3/p1a/aside"])["source"] == "x = 1"
    assert json.loads(kept["lab3/*predictions"])["predictions"]["p4a"]["choice"] == "a"
    other.tab.goto(other.base + "lab.html")
    other.tab.get_by_text("The other version is kept, too").wait_for()
    other.tab.context.close()


@pytest.mark.parametrize(
    "text", ["", "[]", "null", '{"schema": 1}', '{"schema": 2, "course": "where-am-i", "kept": {}}']
)
def test_another_file_is_refused(page, tmp_path, text):
    path = tmp_path / "other.json"
    path.write_text(text)
    before = page.tab.evaluate("JSON.stringify(localStorage)")
    assert take_in(page, path).startswith("Nothing was imported")
    assert page.tab.evaluate("JSON.stringify(localStorage)") == before


def test_a_file_writes_nothing_outside_the_course_and_runs_nothing(page, tmp_path):
    path = tmp_path / "hostile.json"
    kept = {"../../theme": '"dark"', "lab3/p1a": "<script>alert(1)</script>", "__proto__": "[1]",
            "lab3/p5b": json.dumps({"source": "</pre><img src=x onerror=alert(1)>"})}  # fmt: skip
    path.write_text(json.dumps({"schema": 1, "course": "where-am-i", "kept": kept}))
    take_in(page, path)
    keys = page.tab.evaluate("Object.keys(localStorage)")
    assert all(key.startswith(KEPT) or key in ("mode", "theme") for key in keys)
    page.tab.goto(page.base + "lab.html")
    page.tab.wait_for_selector(".pf-answer")


def test_a_browser_that_keeps_nothing_shows_the_map_all_the_same(open_page):
    refuse = "{ get() { throw new DOMException('no'); } }"
    init = f"Object.defineProperty(window, 'localStorage', {refuse});"
    page = open_page("book/map.html", init=init)
    assert page.tab.locator(".pf-back").inner_text() == "Begin: A lab"
    page.tab.context.close()
