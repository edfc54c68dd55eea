"""Cards of terms on hover and on focus; search that ranks prose over code; time to read."""

from __future__ import annotations

import re

import browser
import glossary_cards
import pytest
import reading_time
import search_prose
from docutils import nodes
from sphinx.search.en import SearchEnglish

CHAPTER = browser.chapter("particle_filter")
LINK = ".bd-article a[href*='glossary.html#term-']"
built = pytest.mark.skipif(not browser.pages(), reason="the book is not built: run make book first")


@pytest.fixture(params=["http", "file"])
def chapter(tab, book_address, request):
    tab.goto((book_address if request.param == "http" else browser.HTML.as_uri() + "/") + CHAPTER)
    return tab


@built
@pytest.mark.page
def test_a_card_comes_with_hover_stays_under_the_pointer_and_goes_with_escape(chapter):
    link, card = chapter.locator(LINK).first, chapter.locator(".pf-card")
    link.scroll_into_view_if_needed()
    link.hover()
    card.wait_for(state="visible")
    assert len(card.inner_text()) > 30
    card.hover()
    chapter.wait_for_timeout(600)
    assert card.is_visible()
    chapter.keyboard.press("Escape")
    assert not card.is_visible()


@built
@pytest.mark.page
@pytest.mark.parametrize("width", [1280, 320])
def test_a_card_comes_with_the_focus_describes_the_link_and_stays_in_the_window(chapter, width):
    chapter.set_viewport_size({"width": width, "height": 700})
    links, card = chapter.locator(LINK), chapter.locator(".pf-card")
    for k in range(min(4, links.count())):
        links.nth(k).scroll_into_view_if_needed()
        chapter.keyboard.press("Tab")  # from here on the focus is that of keys
        links.nth(k).focus()
        card.wait_for(state="visible")
        assert links.nth(k).get_attribute("aria-describedby") == card.get_attribute("id")
        box = card.bounding_box()
        assert box["x"] >= 0 and box["x"] + box["width"] <= width
        assert box["y"] >= 0 and box["y"] + box["height"] <= 700
        links.nth(k).blur()
        assert not card.is_visible()


def test_all_names_of_an_entry_get_its_card_without_links():
    html = (
        '<dl><dt id="term-a">a<a class="headerlink" href="#term-a">#</a></dt>\n'
        '<dt id="term-b">b</dt><dd><p>See <a href="#term-c"><span>c</span></a>.</p></dd></dl>'
    )
    meaning = "<p>See <span>c</span>.</p>"
    assert glossary_cards.cards(html) == {
        "term-a": f"<p><strong>a</strong></p>{meaning}",
        "term-b": f"<p><strong>b</strong></p>{meaning}",
    }


def page_of(prose, code):
    doctree = nodes.section()
    doctree += [nodes.paragraph(text=prose), nodes.literal_block(text=code)]
    return doctree


def test_words_of_code_are_those_that_no_sentence_has():
    lang = SearchEnglish({})
    found = search_prose.code_words(page_of("Weights are copied.", "weight = systematic(w)"), lang)
    assert lang.stem("systematic") in found and lang.stem("weights") not in found


@built
@pytest.mark.page
@pytest.mark.parametrize("word", ["resampling", "landmark", "covariance", "heading"])
def test_search_lists_prose_before_code_and_the_package(word, tab):
    tab.goto(f"{browser.HTML.as_uri()}/search.html?q={word}")
    tab.wait_for_selector("#search-results li")
    tab.wait_for_timeout(2 * browser.SETTLE)
    found = tab.locator("#search-results li a:first-child").evaluate_all(
        "(all) => all.map((a) => a.href)"
    )
    pages = [re.sub(r".*/html/|[?#].*", "", href) for href in found]
    package = [p.startswith("book/api") for p in pages]
    only = tab.evaluate("(w) => pfCodeWords[new Stemmer().stemWord(w)] || []", word)
    code = [p.removesuffix(".html") in only for p in pages]
    assert len(pages) >= 5 and not any(package[:3]) and not any(code[:3])


def test_reading_takes_words_code_and_figures_into_account():
    page = page_of("word " * 600, "x = 1\n" * 59 + "x = 1")
    assert reading_time.minutes(page) == 5
    page += [nodes.image() for _ in range(10)]
    assert reading_time.minutes(page) == 7
    assert reading_time.minutes(nodes.section()) == 1


def test_folded_code_is_not_counted():
    cell = nodes.container(hide_mode="input")
    cell += [nodes.literal_block(text="x\n" * 300), nodes.paragraph(text="word " * 400)]
    assert reading_time.minutes(cell) == 2


@built
def test_the_next_page_says_how_long_it_takes():
    html = (browser.HTML / CHAPTER).read_text(encoding="utf-8")
    told = re.findall(r'<span class="minutes">(\d+) min to read</span>', html)
    assert len(told) == 2 and all(3 <= int(m) <= 60 for m in told)
