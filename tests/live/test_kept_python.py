"""Python of the explorables is kept for the next page, where the browser lets it."""

from __future__ import annotations

import pytest

pytestmark = pytest.mark.page
BIG = ("numpy.zip", "pyodide.asm.wasm")


def fetched(page):
    return [url for url in page.requests if url.split("?")[0].endswith(BIG)]


@pytest.fixture
def page(open_page):
    opened = open_page("scenes.html")
    opened.live()
    if not opened.tab.evaluate("PF.scenes.shared"):
        pytest.skip("this browser ends a shared worker with its last page")
    yield opened
    assert not opened.errors and not opened.outside()
    opened.tab.context.close()


def test_the_next_page_finds_python_running(page):
    assert not page.tab.evaluate("PF.scenes.kept") and len(fetched(page)) == len(BIG)
    page.tab.goto(page.base + "plain.html")
    page.tab.goto(page.base + "scenes.html")
    x = page.live(1)
    assert page.tab.evaluate("PF.scenes.kept") and len(fetched(page)) == len(BIG)
    page.tab.wait_for_function(f"{x}.ticks > 2")


def test_tabs_share_python_and_nothing_else(page):
    here = page.live()
    other = page.tab.context.new_page()
    other.goto(page.tab.url)
    other.wait_for_function("document.querySelector('.pf-explorable').pfExplorable")
    other.evaluate(f"{here}.touch()")
    other.wait_for_function(f"{here}.mode === 'live'", timeout=90_000)
    assert other.evaluate("PF.scenes.kept")
    other.evaluate(f"{here}.restart(99)")
    other.wait_for_function(f"{here}.seed === 99 && {here}.ticks > 2")
    page.tab.bring_to_front()
    assert page.tab.evaluate(f"{here}.seed") == 3
    other.close()
    ticks = page.tab.evaluate(f"{here}.ticks")
    page.tab.wait_for_function(f"{here}.ticks > {ticks + 3}")


def test_where_nothing_can_be_kept_each_page_starts_its_own(open_page):
    page = open_page("scenes.html", init="delete window.SharedWorker;")
    x = page.live()
    assert not page.tab.evaluate("PF.scenes.shared")
    page.tab.wait_for_function(f"{x}.ticks > 2")
    assert not page.errors
    page.tab.context.close()
