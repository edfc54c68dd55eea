"""Every page of the built book, over http and from disk, wide and narrow, in a real browser."""

from __future__ import annotations

import re

import browser
import pytest

PAGES = browser.pages()
pytestmark = [
    pytest.mark.page,
    pytest.mark.skipif(not PAGES, reason="the book is not built: run make book first"),
]
# What a page loads at once: scripts, pictures, style sheets. Links to follow are welcome.
LOADS = re.compile(
    r"""<(?:script|img|iframe|source|video|audio)\b[^>]*\bsrc\s*=\s*["'](?:https?:)?//[^"']+"""
    r"""|<link\b(?![^>]*rel=["']?(?:canonical|license|author|search))[^>]*\bhref\s*=\s*["'](?:https?:)?//[^"']+"""
)


def outside_loads(html: str) -> list[str]:
    """List the addresses outside the book that a page would load by itself."""
    return LOADS.findall(html)


@pytest.mark.parametrize("page", PAGES)
def test_page_over_http(page, tab, book_address):
    listing = page.startswith("_modules/")  # thousands of coloured words, the same at each width
    narrow = browser.BUT_COLOURS if listing else browser.EVERYTHING
    browser.require_nothing(browser.look(tab, book_address, page, narrow=narrow))


@pytest.mark.parametrize("page", PAGES)
def test_page_from_disk(page, tab):
    base = browser.HTML.as_uri() + "/"
    browser.require_nothing(browser.look(tab, base, page, None, None))


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.startswith(("book/", "notebooks/"))]
)
def test_page_in_the_dark(page, chromium, book_address):
    context = chromium.new_context(color_scheme="dark")
    context.set_default_timeout(browser.PATIENCE)
    tab = context.new_page()
    browser.require_nothing(browser.look(tab, book_address, page, browser.COLOURS, None))
    context.close()


def test_no_page_names_an_outside_load():
    texts = {page: (browser.HTML / page).read_text(encoding="utf-8") for page in PAGES}
    assert {page: found for page, text in texts.items() if (found := outside_loads(text))} == {}


def test_the_top_forwards_to_the_front_page(tab, book_address):
    tab.goto(book_address)
    tab.wait_for_url("**/book/index.html")
    assert tab.locator("h1").count() == 1


def test_search_finds_a_word_from_disk(tab):
    tab.goto(f"{browser.HTML.as_uri()}/search.html?q=particle")
    tab.wait_for_selector("#search-results li")
    assert tab.locator("#search-results li").count() >= 1
