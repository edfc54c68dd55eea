"""Pages are made to be read: line length, code, captions, the dark, paper, no JavaScript."""

from __future__ import annotations

import io

import browser
import pytest
from PIL import Image

CHAPTERS = [p for p in browser.pages() if p.startswith("notebooks/")]
pytestmark = [
    pytest.mark.page,
    pytest.mark.skipif(not CHAPTERS, reason="the book is not built: run make book first"),
]
NUMBERED = [p for p in CHAPTERS if p.split("/")[1][0].isdigit()]  # labs may have longer lines
CHAPTER = browser.chapter("particle_filter")
# Characters of each line of prose that is followed by another line of its paragraph.
LINES = """() => [...document.querySelectorAll('.bd-article section > p')].flatMap((p) => {
  const tops = [], walk = document.createTreeWalker(p, NodeFilter.SHOW_TEXT);
  if (p.querySelector('.math')) return [];
  for (let text = walk.nextNode(); text; text = walk.nextNode()) {
    for (let k = 0; k < text.length; k++) {
      const range = document.createRange();
      range.setStart(text, k);
      range.setEnd(text, k + 1);
      const box = range.getBoundingClientRect();
      if (box.height) tops.push(Math.round(box.bottom / 8));
    }
  }
  const rows = [];
  for (const top of tops) {
    if (rows.length && Math.abs(rows.at(-1)[0] - top) < 2) rows.at(-1)[1]++;
    else rows.push([top, 1]);
  }
  return rows.slice(0, -1).map(([, n]) => n);
})"""
BARE = """[...document.querySelectorAll('.cell_output img')]
  .filter((i) => !i.closest('figure')?.querySelector('figcaption')?.textContent.trim())
  .map((i) => i.alt.slice(0, 60))"""


@pytest.fixture
def chapter(tab, book_address):
    tab.set_viewport_size(browser.WIDE)
    tab.goto(book_address + CHAPTER)
    return tab


def test_a_line_of_prose_has_66_to_72_characters(chapter):
    counts = sorted(chapter.evaluate(LINES))
    assert len(counts) > 30
    assert 66 <= counts[len(counts) // 2] <= 72, counts


@pytest.mark.parametrize("page", NUMBERED)
def test_code_has_14_px_and_fits_the_page(page, tab, book_address):
    tab.set_viewport_size(browser.WIDE)
    tab.goto(book_address + page)
    tab.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    seen = tab.evaluate(
        """[...document.querySelectorAll('.cell_input pre')].filter((e) => e.clientWidth)
          .map((e) => [getComputedStyle(e).fontSize, e.scrollWidth - e.clientWidth,
            e.textContent.slice(0, 60)])"""
    )
    assert seen and {size for size, _, _ in seen} == {"14px"}
    assert [code for _, excess, code in seen if excess > 1] == []


@pytest.mark.parametrize("page", CHAPTERS)
def test_every_figure_has_a_caption(page, tab):
    tab.goto(f"{browser.HTML.as_uri()}/{page}")
    assert tab.evaluate(BARE) == []
    assert tab.locator("figcaption .caption-number").count() == 0, "nothing refers to its number"


def test_set_up_and_drawing_are_folded_and_the_code_that_teaches_is_not(chapter):
    folded = chapter.locator("details.hide")
    told = set(folded.locator("> summary .collapsed").all_inner_texts())
    assert {"Show what is imported", "Show the code that draws"} <= told
    assert not chapter.get_by_text("import matplotlib").first.is_visible()
    folded.first.locator("summary").click()
    assert chapter.get_by_text("matplotlib.pyplot").first.is_visible()
    assert chapter.locator(".cell_input:visible").count() > 5


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_ground_of_a_figure_is_that_of_the_page(scheme, chromium, book_address):
    context = chromium.new_context(color_scheme=scheme)
    tab = context.new_page()
    tab.goto(book_address + CHAPTER)
    picture = tab.locator("figure img").first
    picture.scroll_into_view_if_needed()
    tab.wait_for_timeout(browser.SETTLE)
    shot = Image.open(io.BytesIO(picture.screenshot())).convert("L")
    corner = shot.getpixel((shot.width - 12, 12))
    assert corner > 240 if scheme == "light" else corner < 40
    darkest, brightest = shot.getextrema()
    assert brightest - darkest > 150, "nothing can be told apart"
    context.close()


def test_on_paper_nothing_is_cut_and_nothing_is_to_be_pressed(chapter):
    chapter.wait_for_selector(".pf-answer")
    chapter.emulate_media(media="print")
    assert chapter.locator("button:visible, .bd-sidebar-primary:visible").count() == 0
    cut = """[...document.querySelectorAll('.bd-article :is(pre, div.math, .wide-table)')]
      .filter((e) => e.checkVisibility() && e.scrollWidth > e.clientWidth + 1
        && getComputedStyle(e).overflowX !== 'visible').map((e) => e.textContent.slice(0, 60))"""
    chapter.set_viewport_size({"width": 680, "height": 900})
    assert chapter.evaluate(cut) == []


def test_without_javascript_the_page_says_so_and_formulas_are_readable(chromium):
    context = chromium.new_context(java_script_enabled=False)
    tab = context.new_page()
    tab.goto(f"{browser.HTML.as_uri()}/{CHAPTER}")
    assert tab.locator(".no-script").is_visible()
    formula = tab.locator("div.math mjx-math").first
    assert formula.is_visible() and formula.bounding_box()["width"] > 100
    assert "\\(" not in tab.locator("article").inner_text()
    context.close()
