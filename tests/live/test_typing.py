"""Keys reach what has the focus: every character, dead keys, composition, Tab, Escape, undo."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from reader import Reader

pytestmark = pytest.mark.page
PRINTABLE = [chr(k) for k in range(33, 127)]
CLOSES = {"(": ")", "[": "]", "{": "}", "'": "'", '"': '"'}  # the editor writes the second half
SEARCH = "document.activeElement.name === 'q' || Boolean(document.querySelector('dialog[open]'))"
FOCUS = "document.activeElement.outerHTML.slice(0, 60)"


@pytest.fixture
def reader(open_page):
    """A lab page in a new browser context: nothing kept, nothing loaded."""
    page = open_page("lab.html")
    yield Reader(page)
    assert not page.errors and not page.outside()
    page.tab.context.close()


def clear(reader, item):
    reader.focus(item)
    reader.tab.keyboard.press("Control+a")
    reader.tab.keyboard.press("Delete")


def test_every_printable_character_arrives(reader):
    clear(reader, "p5b")
    for k, character in enumerate(PRINTABLE):
        if k:
            reader.tab.keyboard.press("Control+End")
            reader.tab.keyboard.press("Enter")
        reader.tab.keyboard.press(character)
    lines = [line.lstrip() for line in reader.code("p5b").split("\n")]
    assert lines == [c + CLOSES.get(c, "") for c in PRINTABLE]
    assert not reader.tab.evaluate(SEARCH)


def test_a_line_of_code_arrives_as_it_was_typed(reader):
    source = "x = 1/2 # a/b\ny = [n // 2 for n in (1, 2)]\nz = {'a': \"b\"}  # ok?"
    reader.type("p5b", source, delay=5)
    assert reader.code("p5b") == source


@pytest.mark.parametrize("item", ["p1a", "p5b"])
def test_keys_of_editing_edit(reader, item):
    keys = reader.tab.keyboard
    clear(reader, item)
    keys.type("ab")
    keys.press("ArrowLeft")
    keys.type("/")
    assert reader.code(item) == "a/b"
    keys.press("Home")
    keys.press("Tab")
    assert reader.code(item) == "    a/b"
    keys.press("Shift+Tab")
    assert reader.code(item) == "a/b"
    reader.tab.wait_for_timeout(600)  # a pause starts another step of undo
    keys.press("End")
    keys.type("cd")
    keys.press("Control+z")
    assert reader.code(item) == "a/b"
    keys.press("Control+y")
    assert reader.code(item) == "a/bcd"
    keys.press("Control+k")
    keys.press("Control+/")
    keys.press("Control+/")
    assert reader.code(item) == "a/bcd" and not reader.tab.evaluate(SEARCH)
    keys.press("Escape")
    assert "cm-content" not in reader.tab.evaluate(FOCUS)
    keys.press("Tab")
    assert reader.code(item) == "a/bcd"


def test_composed_characters_arrive_once(reader):
    """Dead keys and input methods: a composition is shown, changed and then inserted."""
    clear(reader, "p5b")
    session = reader.tab.context.new_cdp_session(reader.tab)
    for step in ("´", "é"):
        session.send("Input.imeSetComposition", dict(text=step, selectionStart=1, selectionEnd=1))
    session.send("Input.insertText", {"text": "é"})
    for step in ("に", "にほ", "日本"):
        session.send("Input.imeSetComposition",
                     dict(text=step, selectionStart=len(step), selectionEnd=len(step)))  # fmt: skip
    session.send("Input.insertText", {"text": "日本"})
    reader.tab.keyboard.type("/ok")
    reader.tab.wait_for_function("PF.lab.text('p5b').endsWith('/ok')")
    assert reader.code("p5b") == "é日本/ok"
    reader.tab.keyboard.insert_text("ß€")  # what a keyboard without that key sends
    assert reader.code("p5b") == "é日本/okß€"


FOCUSABLE = (
    "input, select, textarea, button, summary, [contenteditable=true], [role=application], "
    "[tabindex='0']"
)
KEYS = ["/", "Control+k", "s", "Escape", "ArrowLeft", "ArrowRight"]


@pytest.mark.parametrize("where", ["lab.html", "scenes.html"])
def test_no_shortcut_of_the_site_acts_in_a_control(open_page, where):
    page = open_page(where)
    tab = page.tab
    if where == "scenes.html":
        page.explorable(0)
    else:
        Reader(page)
    home = ".pf-explorable" if where == "scenes.html" else ".pf-answer"
    tab.evaluate(
        """() => {
          window.heard = [];
          document.addEventListener("keydown", (e) => window.heard.push(e.key));
        }"""
    )
    controls = tab.locator(f":is({home}) :is({FOCUSABLE})")
    tried = 0
    for k in range(min(controls.count(), 40)):
        control = controls.nth(k)
        if not control.is_visible() or not control.is_enabled():
            continue
        for key in ("/", "Control+k"):
            control.focus()
            tab.keyboard.press(key)
            assert not tab.evaluate(SEARCH), (key, control.evaluate("e => e.outerHTML")[:200])
        tried += 1
    assert tried > 5
    assert tab.evaluate("heard") == []  # the site heard nothing at all
    assert tab.url == page.base + where
    tab.locator("body").click(position={"x": 2, "y": 2})
    tab.evaluate("document.activeElement.blur()")
    tab.keyboard.press("Control+k")
    assert tab.evaluate(SEARCH)  # elsewhere shortcuts act
    page.tab.context.close()


def test_the_site_hears_none_of_its_keys_from_an_editor(reader):
    reader.tab.evaluate(
        """() => {
          window.heard = [];
          document.addEventListener("keydown", (e) => window.heard.push(e.key));
        }"""
    )
    for key in KEYS:
        reader.focus("p5b")
        reader.tab.keyboard.press(key)
    assert reader.tab.evaluate("heard") == [] and not reader.tab.evaluate(SEARCH)


def test_a_page_offers_no_way_to_set_a_text(reader):
    """Tests type: `PF.lab` shows what stands in an editor, and holds nothing that could write."""
    names = reader.tab.evaluate("Object.keys(PF.lab)")
    assert sorted(names) == ["limit", "text"] and reader.tab.evaluate("Object.isFrozen(PF.lab)")
    before = reader.code("p5b")
    reader.tab.evaluate("PF.lab.text('p5b', 'other')")
    assert reader.code("p5b") == before


def test_no_test_of_the_page_sets_a_text_by_script():
    forbidden = re.compile(
        r"\.fill\(|\.set_content\(|press_sequentially|innerHTML\s*=|execCommand|"
        r"\.dispatch\(|\.setValue\(|editors?\b.*\.set\("
    )
    for path in sorted(Path(__file__).parent.glob("*.py")):
        if path != Path(__file__):
            found = forbidden.findall(path.read_text(encoding="utf-8"))
            assert not found, f"{path.name}: {json.dumps(found)}"
