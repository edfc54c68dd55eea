"""Answers in the browser's store: kept, shared by tabs, never overwritten; refusals are said."""

from __future__ import annotations

import json
from contextlib import contextmanager

import pytest
from reader import Page, Reader

pytestmark = pytest.mark.page
FULL = """
window.real = Storage.prototype.setItem;
Storage.prototype.setItem = function (key, value) {
  if (key.startsWith("where-am-i/1/lab3")) throw new DOMException("full", "QuotaExceededError");
  window.real.call(this, key, value);
};"""
REFUSED = (
    "Object.defineProperty(window, 'localStorage', { get() { throw new DOMException('no'); } });"
)
PAUSE = 500  # ms after which an answer is kept


@contextmanager
def browser(chromium, base, init="", **options):
    """A new browser context; yields a function that opens tabs of the lab page in it."""
    options = {"viewport": {"width": 1280, "height": 800}, **options}
    context = chromium.new_context(**options)
    context.set_default_timeout(90_000)
    if init:
        context.add_init_script(init)
    pages = []

    def tab() -> Reader:
        pages.append(Page(context, base, "lab.html"))
        return Reader(pages[-1])

    yield tab
    # Where storage is refused altogether, the theme's own scripts complain as well.
    assert not [e for page in pages for e in page.errors if init != REFUSED or e != "no"]
    context.close()


@pytest.fixture(params=["http", "file"])
def base(request, site, address):
    return address if request.param == "http" else site.as_uri() + "/"


def more(reader, item, text, delay=0):
    """Go on typing at the end."""
    reader.focus(item)
    reader.tab.keyboard.press("Control+End")
    reader.tab.keyboard.type(text, delay=delay)


def settle(reader):
    reader.tab.wait_for_timeout(PAUSE)


def kept(reader):
    """The store, by what stands after the lab's name."""
    pairs = reader.tab.evaluate("Object.entries(localStorage)")
    return {k.split("/lab3/")[1]: json.loads(v) for k, v in pairs if "/lab3/" in k}


def test_a_reload_restores_the_answers(chromium, base):
    with browser(chromium, base) as tab:
        one = tab()
        one.type("p1a", "p1a = 'b'  # kept")
        one.tab.reload()  # at once: leaving the page keeps what the pause has not
        one = Reader(one.page)
        assert one.code("p1a") == "p1a = 'b'  # kept"
        assert one.group("p1a").get_by_label("(b)").is_checked()
        assert list(kept(one)) == ["p1a"]  # only what was edited


def test_an_unedited_tab_follows_and_overwrites_nothing(chromium, base):
    with browser(chromium, base) as tab:
        one, two = tab(), tab()
        one.type("p5b", "x = 1")
        settle(one)
        assert two.code("p5b") == "x = 1" and "another tab" in two.said("p5b")
        two.tab.close()
        assert kept(one)["p5b"]["source"] == "x = 1"
        one.tab.reload()
        assert Reader(one.page).code("p5b") == "x = 1"


def test_work_goes_on_in_the_other_tab(chromium, base):
    with browser(chromium, base) as tab:
        one, two = tab(), tab()
        one.type("p5b", "x = 1")
        settle(one)
        more(two, "p5b", "23")
        settle(two)
        assert one.code("p5b") == two.code("p5b") == "x = 123"
        assert not two.group("p5b").locator(".pf-conflict").is_visible()


def conflict(tab):
    """Two tabs that both changed the answer before either heard of the other."""
    one, two = tab(), tab()
    one.type("p5b", "mine = 0")
    settle(one)
    two.tab.evaluate("() => { PF.lab.limit.pause = 1e6; }")  # still thinking, while
    more(two, "p5b", "222222")
    more(one, "p5b", "1")  # the other tab keeps its text
    settle(one)
    return one, two


@pytest.mark.parametrize("take", ["Keep this one", "Take the other"])
def test_a_conflict_keeps_both_and_says_so(chromium, base, take):
    with browser(chromium, base) as tab:
        one, two = conflict(tab)
        assert one.code("p5b") == "mine = 01" and two.code("p5b") == "mine = 0222222"
        box = two.group("p5b").locator(".pf-conflict")
        assert "changed in another tab" in box.inner_text()
        box.get_by_text("Show the other version").click()
        assert box.locator("pre").inner_text() == "mine = 01"
        assert not one.group("p5b").locator(".pf-conflict").is_visible()
        store = kept(two)
        assert store["p5b"]["source"] == "mine = 01"
        assert store["p5b/aside"]["source"] == "mine = 0222222"
        box.get_by_role("button", name=take).click()
        settle(two)
        wanted = "mine = 0222222" if take == "Keep this one" else "mine = 01"
        assert one.code("p5b") == two.code("p5b") == wanted and not box.is_visible()
        assert kept(two)["p5b"]["source"] == wanted and "p5b/aside" not in kept(two)
        if take == "Take the other":
            two.tab.keyboard.press("Control+z")
            assert two.code("p5b") == "mine = 0222222"


def test_a_conflict_outlives_the_tab(chromium, base):
    with browser(chromium, base) as tab:
        one, two = conflict(tab)
        more(two, "p5b", "3")
        two.tab.close()
        assert kept(one)["p5b"]["source"] == "mine = 01"
        one.tab.reload()
        one = Reader(one.page)
        box = one.group("p5b").locator(".pf-conflict")
        assert one.code("p5b") == "mine = 01" and "Two tabs" in box.inner_text()
        box.get_by_role("button", name="Take the other").click()
        settle(one)
        assert one.code("p5b") == "mine = 02222223"
        assert kept(one)["p5b"]["source"] == "mine = 02222223" and "p5b/aside" not in kept(one)


def test_an_answer_to_an_older_question_is_offered_not_lost(chromium, base):
    with browser(chromium, base) as tab:
        one = tab()
        old = json.dumps({"source": "p1a = 'old'", "version": "older"})
        one.tab.evaluate(f"localStorage.setItem('where-am-i/1/lab3/p1a', {json.dumps(old)})")
        one.tab.reload()
        one = Reader(one.page)
        assert one.code("p1a") == "p1a = ..."
        one.type("p1a", "p1a = 'b'")  # answering anew does not overwrite it either
        settle(one)
        one.tab.reload()
        one = Reader(one.page)
        assert one.code("p1a") == "p1a = 'b'"
        one.press("p1a", "Use it")
        assert one.code("p1a") == "p1a = 'old'"


@pytest.mark.parametrize("init", [FULL, REFUSED], ids=["full", "refused"])
def test_refused_storage_is_said_beside_the_editor_at_hand_once(chromium, base, init):
    with browser(chromium, base, init) as tab:
        one = tab()
        more(one, "p5b", "  # x")
        warning = one.group("p5b").locator(".pf-warning")
        warning.wait_for()
        assert "export them" in warning.inner_text()
        below = warning.bounding_box()["y"]
        editor = one.group("p5b").locator(".pf-editor").bounding_box()
        assert 0 <= below - editor["y"] - editor["height"] < 8  # beside the editor, px
        one.tab.evaluate(
            """() => {
              window.changes = 0;
              const warning = document.querySelector("[aria-label='Answer p5b'] .pf-warning");
              new MutationObserver((found) => { window.changes += found.length; })
                .observe(warning, { childList: true, subtree: true, characterData: true });
            }"""
        )
        more(one, "p5b", "yz")
        settle(one)
        assert one.tab.evaluate("window.changes") == 0  # said once
        with one.tab.expect_download() as download:
            warning.get_by_role("button", name="Export answers").click()
        data = json.loads(download.value.path().read_text(encoding="utf-8"))
        assert data["answers"]["p5b"]["source"].endswith("  # xyz")
        assert "Exported 1 answers" in one.said("p5b")
        one.type("p1a", "p1a = 'b'")
        settle(one)
        assert one.group("p1a").locator(".pf-warning").is_visible()
        assert not warning.is_visible()  # at hand is the other one now


def test_storage_that_works_again_is_used(chromium, address):
    with browser(chromium, address, FULL) as tab:
        one = tab()
        more(one, "p5b", "  # x")
        warning = one.group("p5b").locator(".pf-warning")
        warning.wait_for()
        one.tab.evaluate("() => { Storage.prototype.setItem = window.real; }")
        more(one, "p5b", "y")
        warning.wait_for(state="hidden")
        assert kept(one)["p5b"]["source"].endswith("  # xy")


def test_a_lock_is_seen_in_the_other_tab_and_stays(chromium, address):
    with browser(chromium, address) as tab:
        one, two = tab(), tab()
        one.choose("p4a", "a", "70")
        one.press("p4a", "Lock prediction")
        one.wait("p4a")
        one.locked("p4a")
        settle(two)
        two.locked("p4a")
        one.tab.reload()
        Reader(one.page).locked("p4a")  # before any Python


@pytest.mark.parametrize("colours", ["active", "none"])
def test_controls_stay_legible(chromium, address, colours):
    """While a cell runs, its buttons can be read; with forced colours, a choice can be seen."""
    with browser(chromium, address, forced_colors=colours) as tab:
        one = tab()
        one.type("p5b", "while True: pass")
        one.press("p5b", "Run")
        button = one.group("p5b").get_by_role("button", name="Check")
        assert button.is_disabled()
        if colours == "none":
            assert contrast(button) >= 4.5
        one.press("p5b", "Stop")
        one.wait("p5b")
        one.group("p1a").get_by_label("(b)").check()
        shown = (
            one.group("p1a")
            .get_by_label("(b)")
            .evaluate("e => ({ ...getComputedStyle(e), width: e.offsetWidth })")
        )
        assert shown["appearance"] == "auto" and shown["width"] >= 10  # the browser's own control
        assert shown["visibility"] == "visible" and shown["opacity"] == "1"


def contrast(locator) -> float:
    """WCAG's ratio of text to background, of two opaque colours."""
    colours = locator.evaluate(
        "e => [getComputedStyle(e).color, getComputedStyle(e).backgroundColor]"
    )
    light = []
    for colour in colours:
        parts = [float(x) / 255 for x in colour[colour.index("(") + 1 : -1].split(",")]
        assert len(parts) == 3, f"{colour} is not opaque"
        linear = [p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts]
        light.append(0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2])
    return (max(light) + 0.05) / (min(light) + 0.05)
