"""Explorables in a real browser: recorded, then live, and the same numbers as on the desktop."""

from __future__ import annotations

import json

import pytest

from pfkit.explore import SCENES, scene
from pfkit.explore.host import Host

pytestmark = pytest.mark.page
PANELS = [(name, panel) for name in SCENES for panel in type(scene(name)).panels]
MOVES = {  # a control that changes the run, and one that restarts it
    "drive": [["set", "sigma_r", 0.7], ["set", "M", 700]],
    "comb": [["set", "pace", 20], ["set", "n", 8]],
    "proposal": [["set", "sigma", 1.3], ["set", "M", 500]],
    "corridor": [["set", "hit", 0.95], ["set", "doors", "three"]],
    "banana": [["set", "a1", 0.4], ["set", "route", "corner"]],
    "exact": [["set", "sigma_r", 0.9], ["set", "M", 300]],
    "square": [["set", "axle", 1.5], ["set", "way", "cw"]],
    "office": [["set", "sigma_hit", 0.4], ["set", "model", "beam"], ["set", "M", 300]],
}


@pytest.fixture(scope="module")
def page(open_page):
    """The page with explorables over http, Python running: booted once for this module."""
    opened = open_page("scenes.html")
    opened.x = opened.live()
    return opened


def run_in_page(page, name, panel, seed, operations):
    return page.tab.evaluate(
        """async ([name, panel, seed, operations]) => {
          await PF.scenes.ask({ do: "open", key: "t", name, panel, seed });
          const a = await PF.scenes.ask({ do: "run", key: "t", operations });
          return { report: a.report, drawing: [...a.drawing].map(v => Number.isNaN(v) ? null : v) };
        }""",
        [name, panel, seed, json.dumps(operations)],
    )


def test_recorded_run_plays_before_any_python_is_fetched(open_page):
    fresh = open_page("scenes.html")
    x = fresh.explorable()
    fresh.tab.wait_for_function(f"{x}.frames.length > 10")
    first = fresh.tab.evaluate(f"{x}.at")
    fresh.tab.wait_for_function(f"{x}.at !== {first}")
    assert fresh.tab.evaluate(f"{x}.mode") == "recorded"
    assert not [u for u in fresh.requests if "pyodide" in u or "numpy" in u]
    assert not fresh.errors and not fresh.outside()


def test_live_run_goes_on_from_the_frame_on_the_screen(open_page):
    fresh = open_page("scenes.html")
    x = fresh.explorable()
    fresh.tab.wait_for_function(f"{x}.at > 2")
    fresh.tab.evaluate(f"{x}.setPlaying(false)")
    before = fresh.tab.evaluate(f"({{ ticks: {x}.ticks, readouts: {x}.report.readouts[0] }})")
    fresh.tab.evaluate(f"{x}.autoplay = false")
    fresh.live()
    after = fresh.tab.evaluate(f"({{ ticks: {x}.ticks, readouts: {x}.report.readouts[0] }})")
    assert after["ticks"] == before["ticks"] > 0
    assert after["readouts"] == pytest.approx(before["readouts"], rel=1e-3, abs=1e-3)
    assert fresh.tab.evaluate("PF.scenes.bootMs") > 0
    fresh.tab.context.close()


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_readouts_agree_with_native_python(page, name, panel):
    steps = 6 if name == "exact" else 30
    operations = [["step", steps], *MOVES.get(name, [])[:2], ["step", steps]]
    host = Host()
    host.open("k", name, panel, 11)
    drawing, told = host.do("k", json.dumps(operations))
    there = run_in_page(page, name, panel, 11, operations)
    here, there["report"] = json.loads(told), json.loads(there["report"])
    assert there["report"]["phase"] == here["phase"]
    for key, value in here["readouts"][0].items():
        if isinstance(value, str):
            assert there["report"]["readouts"][0][key] == value
        else:
            assert there["report"]["readouts"][0][key] == pytest.approx(value, rel=1e-9, abs=1e-9)
    assert there["report"]["ticks"] == here["ticks"] and len(there["drawing"]) == drawing.size


@pytest.mark.parametrize("name", list(MOVES))
def test_a_control_changes_the_run(page, name):
    plain = run_in_page(page, name, None, 4, [["step", 13]])
    for move in MOVES[name]:
        moved = run_in_page(page, name, None, 4, [move, ["step", 13]])
        assert moved["drawing"] != plain["drawing"]


def test_kidnap_and_recover(page):
    operations = [["set", "fresh", 5], ["step", 60], ["set", "kidnap", True], ["step", 1]]
    lost = json.loads(run_in_page(page, "drive", "kidnap", 2, operations)["report"])
    assert lost["readouts"][0]["error"] > 1
    found = json.loads(
        run_in_page(page, "drive", "kidnap", 2, [*operations, ["step", 500]])["report"]
    )
    assert found["readouts"][0]["error"] < 0.6


def test_large_temporaries_do_not_end_python(page):
    """NumPy calls `backtrace` for temporaries over 256 KiB; without our hook that is fatal."""
    operations = [["set", "M", 20000], ["step", 26]]
    told = json.loads(run_in_page(page, "drive", "localise", 1, operations)["report"])
    assert told["values"]["M"] == 20000 and told["readouts"][0]["resampled"] >= 1


def test_frame_rate_is_reported(page, capsys):
    """Measured and printed, not judged: it depends on the machine and on who else works on it."""
    rates = {}
    for M in (1000, 10000):
        page.tab.evaluate(f"{page.x}.change('M', {M})")
        page.tab.wait_for_function(f"{page.x}.values.M === {M} && {page.x}.ticks > 10")
        begun = page.tab.evaluate(f"[{page.x}.framesDrawn, performance.now()]")
        page.tab.wait_for_timeout(2000)
        ended = page.tab.evaluate(f"[{page.x}.framesDrawn, performance.now()]")
        rates[M] = 1000 * (ended[0] - begun[0]) / (ended[1] - begun[1])
    boot = page.tab.evaluate("PF.scenes.bootMs") / 1000
    with capsys.disabled():
        shown = ", ".join(f"{r:.0f} frames/s at {M} particles" for M, r in rates.items())
        print(f"\n[live] boot {boot:.1f} s; {shown}")
    assert min(rates.values()) > 0


def test_timing_is_shown_on_demand(page):
    page.tab.get_by_role("button", name="Timing").first.click()
    page.tab.wait_for_function(f"{page.x}.timing.textContent.includes('frames/s')")
    assert "Python" in page.tab.evaluate(f"{page.x}.timing.textContent")


def test_a_scene_that_raises_says_so_and_starts_again(page):
    page.tab.evaluate(f"{page.x}.pending.push(['set', 'nonsense', 1])")
    problem = page.tab.locator(".pf-problem").first
    problem.wait_for(state="visible")
    assert "no control 'nonsense'" in problem.inner_text()
    page.tab.get_by_role("button", name="Start it again").click()
    page.tab.wait_for_function(f"{page.x}.mode === 'live'")
    assert not problem.is_visible()


def test_keyboard_alone_is_enough(page):
    tab = page.tab
    tab.evaluate(f"{page.x}.setPlaying(false)")
    tab.evaluate(f"{page.x}.canvas.focus()")
    before = tab.evaluate(f"{page.x}.ticks")
    phases = tab.evaluate(f"{page.x}.report.phase.count")
    tab.keyboard.press(".")
    tab.wait_for_function(f"{page.x}.report.phase.count === {phases + 1}")
    assert before <= tab.evaluate(f"{page.x}.ticks") <= before + 12
    tab.keyboard.down("ArrowUp")
    tab.wait_for_function(f"{page.x}.values.throttle === 1")
    tab.keyboard.up("ArrowUp")
    tab.wait_for_function(f"{page.x}.values.throttle === 0")
    tab.keyboard.press(" ")
    assert tab.evaluate(f"{page.x}.playing") is False
    names = []
    for _ in range(10):
        tab.keyboard.press("Tab")
        names.append(tab.evaluate("document.activeElement.textContent.trim()"))
    assert names[:2] == ["Play", "Next phase"]
    outline = tab.evaluate(
        "getComputedStyle(document.activeElement).outlineStyle + document.activeElement.tagName"
    )
    assert not outline.startswith("none")


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_words_stay_inside_a_narrow_picture(page, name, panel):
    cut = page.tab.evaluate(
        """async ([name, panel]) => {
          const { size } = await (async () => JSON.parse(
            await PF.scenes.ask({ do: "open", key: "t", name, panel, seed: 3 })))();
          const { drawing } = await PF.scenes.ask(
            { do: "run", key: "t", operations: '[["step", 12]]' });
          const renderer = new PF.Renderer(document.createElement("canvas"), size), cut = [];
          renderer.context.fillText = function (text, x) {
            const { actualBoundingBoxLeft: left, actualBoundingBoxRight: right }
              = this.measureText(text);
            if (x - left < 0 || x + right > renderer.width) cut.push(text);
          };
          renderer.resize(356);
          renderer.draw(drawing);
          return cut;
        }""",
        [name, panel],
    )
    assert cut == []


def test_the_picture_stays_in_sight_beside_the_control_that_moves_it(page):
    tab = page.tab
    last = tab.locator(".pf-explorable").first.locator(".pf-main input").last
    last.focus()
    tab.wait_for_timeout(200)
    stage = tab.locator(".pf-stage").first.bounding_box()
    control = last.bounding_box()
    assert 0 <= stage["y"] and stage["x"] + stage["width"] <= control["x"]
    assert control["y"] + control["height"] <= 900


def test_pointer_drives_the_robot(page):
    tab = page.tab
    tab.evaluate(f"{page.x}.restart(3)")
    tab.evaluate(f"{page.x}.setPlaying(true)")
    tab.locator(".pf-canvas").first.scroll_into_view_if_needed()
    box = tab.locator(".pf-canvas").first.bounding_box()
    tab.mouse.move(box["x"] + 200, box["y"] + 200)
    tab.mouse.down()
    tab.wait_for_function(f"{page.x}.history.some(h => h[1] === 'hold')")
    tab.mouse.up()
    tab.wait_for_function(f"{page.x}.history.some(h => h[5] === 'release')")


def test_nothing_leaves_the_page(page):
    assert not page.outside() and not page.errors


def test_worker_cannot_fetch_once_it_runs(page):
    """What the page computes stays in the page: the worker has lost its means to send it."""
    gone = page.tab.evaluate(
        """async () => {
          const py = new PF.Python("cells");
          const source = "import js\\n[hasattr(js, n) and getattr(js, n) is not None for n in "
            + "('fetch', 'XMLHttpRequest', 'WebSocket', 'EventSource', 'importScripts')]";
          const cells = JSON.stringify([{ index: 0, kind: "code", item: "a", source }]);
          const told = JSON.parse(await py.ask({ do: "cell", cells, index: 0 }));
          const big = JSON.stringify([{ index: 0, kind: "code", item: "a",
            source: "import numpy as np\\nfloat((np.ones(100000) * 2 + 1).sum())" }]);
          const sum = JSON.parse(await py.ask({ do: "cell", cells: big, index: 0 }));
          py.stop();
          return [told.text || told.error, sum.text];
        }"""
    )
    assert gone == ["[False, False, False, False, False]", "300000.0"]


# ---- the exact run in the address -------------------------------------------------------------


def test_a_link_repeats_the_exact_run(page, open_page):
    tab, x = page.tab, page.explorable()
    tab.evaluate(f"{x}.restart(5), {x}.setPlaying(true)")
    tab.wait_for_function(f"{x}.ticks > 20 && {x}.seed === 5")
    tab.evaluate(f"{x}.change('sigma_r', 0.9)")
    tab.wait_for_function(f"{x}.history.length >= 1 && {x}.ticks > 60")
    tab.evaluate(f"{x}.setPlaying(false)")
    tab.wait_for_function(f"!{x}.busy && !{x}.pending.length && !{x}.fresh")
    tab.get_by_role("button", name="Link to this run").first.click()
    link, readouts = tab.evaluate(f"[location.hash, {x}.report.readouts[0]]")
    other = open_page("scenes.html" + link)
    y = other.explorable()
    other.tab.wait_for_function(f"{y}.mode === 'live'", timeout=90_000)
    other.tab.wait_for_function(f"{y}.ticks === {tab.evaluate(x + '.ticks')}")
    assert other.tab.evaluate(f"{y}.report.readouts[0]") == pytest.approx(readouts, rel=1e-9)
    assert other.tab.evaluate(f"{y}.values.sigma_r") == 0.9
    other.tab.context.close()


HOSTILE = [
    '{"id":"explorable-drive-localise-3","seed":"<img src=x onerror=alert(1)>","v":{"M":1e99}}',
    '{"id":"explorable-drive-localise-3","v":{"__proto__":{"x":1},"sense":"<b>","M":"5"},"h":7}',
    '{"id":"explorable-drive-localise-3","n":1e15,"h":[[0,"constructor",1],[0,"set","kidnap",2],null]}',
    '{"id":"explorable-drive-localise-3","n":9,"h":[[0,"hold","robot",1,1,"poke"],[1,"toString"]]}',
    '"><script>alert(1)</script>',
    "{" * 3000,
]


@pytest.mark.parametrize("state", HOSTILE)
def test_a_hostile_address_is_data_only(open_page, state):
    from urllib.parse import quote

    hostile = open_page("scenes.html#run=" + quote(state))
    x = hostile.explorable()
    hostile.tab.wait_for_timeout(300)
    assert not hostile.errors and not hostile.outside()
    values = hostile.tab.evaluate(f"({{ seed: {x}.seed, M: {x}.initial.M, s: {x}.initial.sense }})")
    assert values["seed"] == 3 and values["s"] == "both"
    assert hostile.tab.locator("img[src=x]").count() == 0
    hostile.tab.context.close()


# ---- pages ------------------------------------------------------------------------------------


def test_a_page_without_live_parts_loads_only_what_counts_progress(open_page):
    plain = open_page("plain.html")
    loaded = {u.partition("/live/")[2].partition("?")[0] for u in plain.requests if "/live/" in u}
    assert loaded <= {"store.js", "tasks.js", "progress.js"} and not plain.outside()


def test_without_scripts_there_is_a_still_with_a_text(open_page):
    bare = open_page("scenes.html", java_script_enabled=False)
    stills = bare.tab.locator("img.pf-still")
    assert stills.count() == 2
    for k in range(2):
        assert len(stills.nth(k).get_attribute("alt")) > 20
        stills.nth(k).scroll_into_view_if_needed()
        assert stills.nth(k).bounding_box()["height"] > 100
    assert bare.tab.get_by_text("Make two weights equal to one half").is_visible()


def test_who_asked_for_no_motion_gets_none(open_page):
    calm = open_page("scenes.html", reduced_motion="reduce")
    x = calm.explorable()
    calm.tab.wait_for_function(f"{x}.frames.length > 10 && {x}.report")
    at = calm.tab.evaluate(f"{x}.at")
    calm.tab.wait_for_timeout(600)
    assert calm.tab.evaluate(f"{x}.at") == at and not calm.tab.evaluate(f"{x}.playing")


@pytest.mark.parametrize("page_name", ["scenes.html", "lab.html"])
@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_axe_finds_nothing_and_nothing_scrolls_sideways(open_page, page_name, theme, width):
    from browser import AXE, SEVERE, check_width

    if not AXE.exists():
        pytest.skip("axe-core is not fetched (python tools/npm_packages.py)")
    seen = open_page(page_name, width=width, color_scheme=theme)
    if page_name == "scenes.html":
        seen.explorable(0), seen.explorable(1)
    else:
        seen.tab.wait_for_function("window.PF && PF.lab")
    seen.tab.evaluate(AXE.read_text(encoding="utf-8"))
    mine = "document.querySelectorAll('.pf-explorable, .pf-answer, .pf-labbar')"
    found = seen.tab.evaluate(SEVERE.replace("axe.run(document,", f"axe.run([...{mine}],"))
    assert not found and not check_width(seen.tab)
    seen.tab.context.close()
