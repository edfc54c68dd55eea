"""The page checks are tried on pages that are broken on purpose, one fault each."""

from __future__ import annotations

import random

import browser
import course_page
import pytest
from test_pages import outside_loads

GOOD = """<!DOCTYPE html><html lang="en"><head><title>Page</title></head><body><main>
<h1>Page</h1><h2>Part</h2><p>Text <a href="https://example.org/">a link</a></p>
<img src="data:image/gif;base64,R0lGODlhAQABAAAAACw=" alt="A single grey pixel.">
</main></body></html>"""
pytestmark = pytest.mark.page

BROKEN = {
    "no alt text": ('alt="A single grey pixel."', ""),
    "a file name is no alt text": ("A single grey pixel.", "plot.png"),
    "two h1": ("<h2>Part</h2>", "<h1>Part</h1>"),
    "a heading jump": ("<h2>Part</h2>", "<h4>Part</h4>"),
    "sideways scroll": ("<p>Text", '<p style="width: 2000px">Text'),
    "a script error": ("<p>Text", "<script>nothing.here()</script><p>Text"),
    "an outside request": ("<p>Text", '<img alt="A map of it." src="https://example.org/a.png">'),
    "a missing file": ("<p>Text", '<script src="gone.js"></script><p>Text'),
    "a formula as its source": ("<p>Text", '<p><span class="math">\\(x_t\\)</span> Text'),
    "no language": ('<html lang="en">', "<html>"),
    "too little contrast": ("<p>Text", '<p style="color: #ccc; background: #fff">Text'),
}


def look(tab, folder, html):
    (folder / "page.html").write_text(html, encoding="utf-8")
    with browser.served(folder) as address:
        return browser.look(tab, address, "page.html")


def test_a_good_page_passes(tab, tmp_path):
    assert look(tab, tmp_path, GOOD) == []


@pytest.mark.parametrize("fault", BROKEN)
def test_each_fault_is_seen(fault, tab, tmp_path):
    html = GOOD.replace(*BROKEN[fault])
    assert html != GOOD
    assert look(tab, tmp_path, html) != []


def test_a_colour_on_its_way_is_waited_for(tab, tmp_path):
    fading = "<style>p { animation: in 2s } @keyframes in { from { color: #eee } }</style><p>"
    assert look(tab, tmp_path, GOOD.replace("<p>", fading)) == []


def test_colours_alone_and_all_but_colours(tab, tmp_path):
    html = GOOD.replace(*BROKEN["too little contrast"]).replace('<html lang="en">', "<html>")
    (tmp_path / "page.html").write_text(html, encoding="utf-8")
    with browser.served(tmp_path) as address:
        colours = browser.look(tab, address, "page.html", browser.COLOURS, None)
        others = browser.look(tab, address, "page.html", browser.BUT_COLOURS, None)
    assert [text.split()[1] for text in colours] == ["color-contrast"]
    assert [text.split()[1] for text in others] == ["html-has-lang"]


def test_a_large_page_is_seen(tab, tmp_path):
    assert "kB of its own" in look(tab, tmp_path, GOOD.replace("Text", "Text " * 150_000))[-1]


def test_a_heavy_visit_is_seen_though_all_of_it_is_shared(tab, tmp_path):
    (tmp_path / "_static").mkdir()
    noise = random.Random(1).randbytes(1_000_000)
    (tmp_path / "_static" / "font.png").write_bytes(noise)
    (tmp_path / "_static" / "zeros.js").write_bytes(b" " * 5_000_000)
    light = GOOD.replace("<p>", '<script src="_static/zeros.js"></script><p>')
    assert look(tab, tmp_path, light) == []
    heavy = GOOD.replace("<p>", '<img src="_static/font.png" alt="Noise in grey."><p>')
    assert "before any click" in look(tab, tmp_path, heavy)[0]


@pytest.mark.parametrize(
    "html",
    [
        '<script src="https://cdn.example.org/x.js"></script>',
        '<link rel="stylesheet" href="//fonts.example.org/x.css">',
        '<img alt="x" src="http://example.org/x.png">',
    ],
)
def test_an_outside_load_is_seen_in_the_source(html):
    assert outside_loads(html)


def test_links_to_follow_are_no_loads():
    assert (
        outside_loads('<a href="https://example.org">x</a><link rel="license" href="https://y">')
        == []
    )


def test_a_theme_that_changed_under_the_mends_is_seen():
    html, missing = course_page.mend("<html><body><p>A new theme</p></body></html>")
    assert html.count("<p>") == 1
    assert len(missing) == sum(mend.expected for mend in course_page.MENDS)
