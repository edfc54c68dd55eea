"""What the page on access says is done by test, and is not tested elsewhere."""

from __future__ import annotations

import re

import browser
import pytest

HTML_PAGES = browser.pages()
PAGES = [
    "book/map.html",
    "book/glossary.html",
    browser.chapter("particle_filter"),
    "notebooks/labs/lab3_particle_filter.html",
]
built = pytest.mark.skipif(not HTML_PAGES, reason="the book is not built: run make book first")
on_pages = pytest.mark.parametrize("page", PAGES)
CRITERIA = """
1.1.1 1.2.1 1.2.2 1.2.3 1.2.4 1.2.5 1.3.1 1.3.2 1.3.3 1.3.4 1.3.5 1.4.1 1.4.2 1.4.3 1.4.4
1.4.5 1.4.10 1.4.11 1.4.12 1.4.13 2.1.1 2.1.2 2.1.4 2.2.1 2.2.2 2.3.1 2.4.1 2.4.2 2.4.3
2.4.4 2.4.5 2.4.6 2.4.7 2.4.11 2.5.1 2.5.2 2.5.3 2.5.4 2.5.7 2.5.8 3.1.1 3.1.2 3.2.1 3.2.2
3.2.3 3.2.4 3.2.6 3.3.1 3.3.2 3.3.3 3.3.4 3.3.7 3.3.8 4.1.2 4.1.3
""".split()
SPACING = """* { line-height: 1.5 !important; letter-spacing: 0.12em !important;
  word-spacing: 0.16em !important } p { margin-bottom: 2em !important }"""
# Texts that a box with hidden overflow cuts off.
CUT = """[...document.querySelectorAll('.bd-article :is(p, li, summary, h1, h2, button, label)')]
  .filter((e) => e.checkVisibility() && !e.closest('.pf-sr, .cm-editor')
    && ['hidden', 'clip'].includes(getComputedStyle(e).overflowY)
    && e.scrollHeight > e.clientHeight + 2).map((e) => e.textContent.slice(0, 60))"""
TARGETS = {"runOnly": ["target-size"]}


def test_the_page_goes_through_all_criteria_in_order():
    text = (browser.ROOT / "book" / "access.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (\d\.\d\.\d+) [^|]+ \| ([^|]+) \| ([^|]{8,}) \|$", text, re.M)
    assert [number for number, _, _ in rows] == CRITERIA
    assert {state for _, state, _ in rows} == {"met", "partly", "does not apply"}


def opened(tab, address, page, width=1280, height=900):
    tab.set_viewport_size({"width": width, "height": height})
    tab.goto(address + page)
    tab.wait_for_timeout(browser.SETTLE)
    return tab


@built
@pytest.mark.page
@on_pages
@pytest.mark.parametrize("width", [320, 640])
def test_a_narrow_window_and_200_per_cent_lose_nothing(page, width, tab, book_address):
    opened(tab, book_address, page, width, 512)
    assert browser.check_width(tab) == [] and tab.evaluate(CUT) == []


@built
@pytest.mark.page
@on_pages
def test_text_can_be_spaced(page, tab, book_address):
    opened(tab, book_address, page)
    tab.add_style_tag(content=SPACING)
    assert browser.check_width(tab) == [] and tab.evaluate(CUT) == []


@built
@pytest.mark.page
@on_pages
def test_targets_are_large_enough(page, tab, book_address):
    opened(tab, book_address, page, 390, 844)
    assert browser.check_access(tab, TARGETS) == []


@built
@pytest.mark.page
def test_the_first_stop_leads_to_the_text(tab, book_address):
    opened(tab, book_address, PAGES[2])
    tab.keyboard.press("Tab")
    assert "Skip to main content" in tab.evaluate("document.activeElement.textContent")
    tab.keyboard.press("Enter")
    tab.keyboard.press("Tab")
    assert tab.evaluate("Boolean(document.activeElement.closest('main'))")


@built
@pytest.mark.page
def test_no_stop_of_a_chapter_lies_under_the_bar_at_the_top(tab, book_address):
    opened(tab, book_address, PAGES[2], 1280, 632)
    tab.wait_for_selector(".pf-answer")
    tab.evaluate("document.querySelector('#main-content').focus()")
    for step in ("Tab", "Shift+Tab"):
        for _ in range(25):
            tab.keyboard.press(step)
            hidden = tab.evaluate(
                """() => {
                  const at = document.activeElement, box = at.getBoundingClientRect();
                  const bar = document.querySelector('.bd-header-article').getBoundingClientRect();
                  const hidden = box.bottom <= bar.bottom || box.top >= innerHeight;
                  return hidden && at.closest('.bd-article') ? at.outerHTML.slice(0, 120) : '';
                }"""
            )
            assert hidden == ""


@built
@pytest.mark.page
def test_chosen_colours_keep_text_and_what_is_folded(chromium, book_address):
    context = chromium.new_context(forced_colors="active", viewport=browser.WIDE)
    tab = opened(context.new_page(), book_address, PAGES[2])
    seen = tab.evaluate(
        """[...document.querySelectorAll('.bd-article :is(p, summary p, mjx-c, figcaption span)')]
          .filter((e) => e.checkVisibility()).slice(0, 300).map((e) => {
            let ground = e;
            while (ground && getComputedStyle(ground).backgroundColor === 'rgba(0, 0, 0, 0)')
              ground = ground.parentElement;
            return [getComputedStyle(e).color,
              ground ? getComputedStyle(ground).backgroundColor : 'rgb(255, 255, 255)'];
          })"""
    )
    assert len(seen) > 100 and all(ink != ground for ink, ground in seen)
    context.close()


@built
@pytest.mark.page
def test_nothing_moves_where_that_is_asked_for(chromium, book_address):
    context = chromium.new_context(reduced_motion="reduce", viewport=browser.WIDE)
    tab = opened(context.new_page(), book_address, PAGES[2])
    tab.locator("details.hide summary").first.click()
    tab.locator(".pf-explorable").first.scroll_into_view_if_needed()
    tab.wait_for_function("document.querySelector('.pf-explorable').pfExplorable")
    assert not tab.evaluate("document.querySelector('.pf-explorable').pfExplorable.playing")
    lasting = "document.getAnimations().filter((a) => a.effect.getComputedTiming().duration > 10)"
    tab.wait_for_timeout(50)
    assert tab.evaluate(f"{lasting}.map((a) => a.effect.target.outerHTML.slice(0, 80))") == []
    context.close()
