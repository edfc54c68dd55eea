"""A lab that was renamed: what a browser kept, and what was exported, under the name it had."""

from __future__ import annotations

import json

import pytest

pytestmark = pytest.mark.page
CODE = "def circular_mean(theta, w):\n    return 0.0\n"
PREDICTIONS = {"p4a": {"choice": "a", "sure": 70, "version": "x"}}


def opened(open_page, kept):
    """The lab page as if lab3 had been called ch99, in a browser that kept something."""
    page = open_page("scenes.html")
    tab = page.tab
    tab.evaluate(
        "kept => { for (const [k, v] of kept) localStorage.setItem(k, JSON.stringify(v)); }",
        [[f"where-am-i/1/{name}", value] for name, value in kept.items()],
    )

    def rename(route):
        body = route.fetch().text()
        assert '"former": null' in body
        route.fulfill(
            body=body.replace('"former": null', '"former": "ch99"'), content_type="text/html"
        )

    tab.route("**/lab.html", rename)
    tab.goto(page.base + "lab.html")
    tab.wait_for_function("window.PF && PF.lab")
    return page


def code_of(tab, item):
    return tab.evaluate("item => PF.lab.text(item)", item)


def test_what_was_kept_under_the_former_name_is_there(open_page):
    from pfkit.labs.lab3 import LAB

    def record(item, source):
        return {"source": source, "version": LAB.items[item].version}

    page = opened(
        open_page,
        {
            "ch99/p5b": record("p5b", CODE),
            "ch99/p1a": record("p1a", "p1a = 'a'"),
            "lab3/p1a": record("p1a", "p1a = 'b'"),
            "ch99/*predictions": {
                "schema": 1, "lab": "ch99", "answers": {}, "predictions": PREDICTIONS
            },
        },
    )  # fmt: skip
    assert code_of(page.tab, "p5b") == CODE
    assert code_of(page.tab, "p1a") == "p1a = 'b'", "what was kept since counts"
    group = page.tab.get_by_role("group", name="Answer p4a", exact=True)
    assert "Locked: (a), 70 % sure." in group.inner_text()
    assert not page.errors
    page.tab.context.close()


def test_a_file_exported_under_the_former_name_is_read(open_page):
    page = opened(open_page, {})
    answers = {"p5b": {"source": CODE, "version": "x"}}
    note = page.tab.locator(".pf-labbar .pf-note")
    for name, told in (("ch98", "Nothing was imported"), ("ch99", "Imported 1")):
        data = {"schema": 1, "lab": name, "answers": answers, "predictions": {}}
        page.tab.locator("#pf-import").set_input_files(
            {
                "name": "a.json",
                "mimeType": "application/json",
                "buffer": json.dumps(data).encode(),
            }
        )
        note.filter(has_text=told).wait_for()
        assert (code_of(page.tab, "p5b") == CODE) is (name == "ch99")
    page.tab.context.close()
