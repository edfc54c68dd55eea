"""The picture, its sentence, time and main controls on one screen; time told and scrubbed."""

from __future__ import annotations

import pytest

from pfkit.explore import SCENES, scene

pytestmark = pytest.mark.page
SCREENS = [(1280, 632), (1366, 768), (1536, 730), (390, 844)]
TOGETHER = """(root) => {
  root.scrollIntoView({ block: "start", behavior: "instant" });
  const top = document.querySelector(".bd-header-article").getBoundingClientRect().bottom;
  return [".pf-stage", ".pf-says", ".pf-transport", ".pf-main"].map((name) => {
    const box = root.querySelector(name).getBoundingClientRect();
    return [name, Math.round(box.top - top), Math.round(innerHeight - box.bottom), box.width > 150];
  });
}"""


@pytest.fixture(scope="module")
def page(open_page):
    """A live explorable, paused at a known seed."""
    opened = open_page("scenes.html", width=1366, height=768)
    opened.x = opened.live()
    yield opened
    assert not opened.errors and not opened.outside()


def settle(page) -> None:
    page.tab.wait_for_function(f"!{page.x}.busy && !{page.x}.pending.length && !{page.x}.fresh")


def begin(page, seed: int = 3) -> None:
    """The first explorable in sight (what nobody sees stands still), at rest, at its start."""
    page.explorable(0)
    page.tab.evaluate(f"{page.x}.setPlaying(false), {page.x}.restart({seed})")
    settle(page)
    page.tab.wait_for_function(f"{page.x}.report.ticks === 0")


@pytest.mark.parametrize(("width", "height"), SCREENS)
def test_all_that_belongs_together_is_on_the_screen_together(open_page, width, height):
    page = open_page("all.html", width=width, height=height)
    numbers = [k for k, name in enumerate(SCENES) if scene(name).panel.controls]  # no films
    for number in numbers:
        x = page.explorable(number)
        page.tab.wait_for_function(f"{x}.frames.length > 10 && {x}.report")
        page.tab.wait_for_timeout(300)
        root = page.tab.locator(".pf-explorable").nth(number).element_handle()
        for name, above, below, wide in page.tab.evaluate(TOGETHER, root):
            assert above >= 0 and below >= 0 and wide, (number, name, above, below)
        stage = page.tab.locator(".pf-stage").nth(number).bounding_box()
        assert stage["height"] >= 200
    page.tab.context.close()


def test_the_keyboard_is_in_the_picture_after_three_stops(open_page):
    page = open_page("scenes.html", width=1366, height=768)
    page.tab.keyboard.press("Tab")
    page.tab.keyboard.press("Tab")
    assert page.tab.evaluate("document.activeElement.textContent") == "Skip to the moving picture"
    page.tab.keyboard.press("Enter")
    page.tab.wait_for_function("document.activeElement.className.includes('pf-canvas')")
    box = page.tab.locator(".pf-canvas").first.bounding_box()
    assert 0 <= box["y"] < 768 / 2
    page.tab.context.close()


def test_at_most_five_controls_stand_beside_the_picture(page):
    for number in (0, 1):
        page.explorable(number)
        root = page.tab.locator(".pf-explorable").nth(number)
        assert 1 <= root.locator(".pf-main > .pf-control").count() <= 5


def test_a_recorded_run_moves_between_its_frames(open_page):
    page = open_page("scenes.html")
    x = page.explorable()
    page.tab.wait_for_function(f"{x}.frames.length > 10 && {x}.position > 1")
    drawn = page.tab.evaluate(
        f"""async () => {{
          const seen = new Set(), x = {x}, real = x.renderer.draw, began = performance.now();
          x.renderer.draw = function (d) {{ seen.add(d.join()); real.call(this, d); }};
          const from = x.position;
          await new Promise((r) => setTimeout(r, 1500));
          x.renderer.draw = real;
          return [seen.size, x.position - from, performance.now() - began];
        }}"""
    )
    assert drawn[0] > 2 * drawn[1] > 0  # more pictures than stored frames
    page.tab.context.close()


def test_by_phase_each_phase_is_told_and_stands(page):
    begin(page)
    page.tab.get_by_label("Speed").first.select_option("phase")
    page.tab.evaluate(f"{page.x}.setPlaying(true)")
    now = "document.querySelector('.pf-now')?.textContent"
    for name in ("predict", "weigh", "resample", "predict"):  # it stands long enough to be seen
        page.tab.wait_for_function(
            f"{page.x}.report.phase.name === '{name}' && {now} === '{name}'"
            f" && {page.x}.status.textContent.startsWith('{name.capitalize()}')"
        )
    page.tab.get_by_label("Speed").first.select_option("1")
    page.tab.evaluate(f"{page.x}.setPlaying(false)")


def test_next_phase_is_one_sentence_with_its_numbers(page):
    begin(page)
    said = []
    for _ in range(3):
        page.tab.get_by_role("button", name="Next phase").first.click()
        page.tab.wait_for_function(
            f"{page.x}.report.phase.count === {len(said) + 1} && !{page.x}.busy"
        )
        page.tab.wait_for_function(
            f"{page.x}.status.textContent === {page.x}.report.phase.sentences[0]"
        )
        said.append(page.tab.evaluate(f"{page.x}.status.textContent"))
    assert [s.split(":")[0] for s in said] == ["Predict", "Weigh", "Resample"]
    assert " of 500 particles are nearly weightless" in said[1]


def test_the_last_minute_can_be_scrubbed_and_goes_on_from_there(page):
    begin(page)
    page.tab.evaluate(f"{page.x}.setPlaying(true)")
    page.tab.wait_for_function(f"{page.x}.ticks > 90")
    page.tab.evaluate(f"{page.x}.setPlaying(false)")
    settle(page)
    last = page.tab.evaluate(f"{page.x}.ticks")
    bar = page.tab.get_by_label("Time, the last minute").first
    bar.focus()
    for _ in range(30):
        page.tab.keyboard.press("ArrowLeft")
    page.tab.wait_for_function(f"{page.x}.report.ticks === {last - 30}")
    settle(page)
    assert "ago" in page.tab.locator(".pf-time").first.inner_text()
    assert page.tab.evaluate(f"{page.x}.report.kept[1]") == last
    page.tab.evaluate(f"{page.x}.change('kidnap', true)")
    page.tab.wait_for_function(f"{page.x}.report.kept[1] === {last - 30}")
    assert page.tab.evaluate(f"{page.x}.history.at(-1).slice(0, 3)") == [last - 30, "set", "kidnap"]


def test_two_worlds_side_by_side_differ_in_one_control(page):
    begin(page)
    page.tab.get_by_label("Compare").first.select_option("M")
    page.tab.wait_for_function(f"{page.x}.report.readouts.length === 2 && {page.x}.ticks > 30")
    other = page.tab.get_by_label("Particles M, right").first
    assert page.tab.evaluate(f"[{page.x}.report.values.M, {page.x}.report.other.M]") == [500, 5000]
    other.focus()
    page.tab.keyboard.press("Home")
    page.tab.wait_for_function(f"{page.x}.report.other.M === 10")
    assert page.tab.evaluate(f"{page.x}.report.values.M") == 500
    assert page.tab.evaluate(f"{page.x}.renderer.views.length") == 2
    cells = page.tab.locator(".pf-readouts dd").first.inner_text()
    assert "|" in cells
    page.tab.get_by_label("Compare").first.select_option("")
    page.tab.wait_for_function(f"{page.x}.report.readouts.length === 1")
    assert other.count() == 0


def test_a_hundred_seeds_fill_a_histogram_while_the_picture_goes_on(page):
    comb = page.live(1)
    page.tab.evaluate(f"{comb}.setPlaying(true)")
    root = page.tab.locator(".pf-explorable").nth(1)
    root.get_by_role("button", name="Run 100 seeds").click()
    before = page.tab.evaluate(f"{comb}.ticks")
    page.tab.wait_for_function(f"{comb}.many.done === 100", timeout=120_000)
    assert page.tab.evaluate(f"{comb}.ticks") > before
    assert " of 100 runs." in root.locator(".pf-many p").inner_text()
    assert not root.get_by_role("button", name="Stop").is_visible()


def test_time_that_slows_says_so(page):
    said = page.tab.evaluate(
        """() => {
          const t = new PF.Transport("t", 60, {}, false), now = performance.now;
          let at = 1000;
          performance.now = () => at;
          const out = [];
          for (const [ticks, ms] of [[0, 5], [120, 5], [180, 30], [300, 5]]) {
            t.pace(ticks, ms);
            out.push(t.late.hidden ? "" : t.late.textContent);
            at += 2001;
          }
          performance.now = now;
          return out;
        }"""
    )
    assert said[:2] == ["", ""] and said[3] == ""
    assert said[2] == "Time runs at 50 % of its pace: a step takes 30 ms on this machine."


# ---- films ------------------------------------------------------------------------------------


def test_a_film_plays_with_one_button_and_without_python(open_page):
    page = open_page("film.html", width=1366, height=768)
    x = page.explorable()
    page.tab.wait_for_function(f"{x}.frames.length > 20")
    stages = []
    for stage in ("anywhere", "a ring", "two places", "here"):
        page.tab.evaluate(f"{x}.position = Math.max({x}.position, 0)")
        page.tab.wait_for_function(f"{x}.report.phase.name === '{stage}'")
        stages.append(page.tab.locator(".pf-status").first.inner_text())
    assert [s.split(":")[0].lower() for s in stages[1:]] == ["a ring", "two places", "here"]
    root = page.tab.locator(".pf-explorable").first
    assert root.get_by_role("button").count() == 1
    wide = page.tab.evaluate("""[...document.querySelectorAll(".pf-explorable")].map((e) =>
        e.querySelector(".pf-stage").clientWidth / e.clientWidth)""")
    assert wide[0] == 1
    root.get_by_role("button").click()
    at = page.tab.evaluate(f"{x}.position")
    page.tab.wait_for_timeout(300)
    assert page.tab.evaluate(f"{x}.position") == at
    page.tab.get_by_label("Time, the last minute").first.focus()
    page.tab.keyboard.press("Home")
    page.tab.wait_for_function(f"{x}.at === 0 && {x}.report.phase.name !== 'here'")
    assert not [u for u in page.requests if "pyodide" in u] and not page.errors
    page.tab.context.close()


def test_a_caption_makes_a_film_of_any_panel(open_page):
    page = open_page("film.html")
    x = page.explorable(1)
    root = page.tab.locator(".pf-explorable").nth(1)
    page.tab.wait_for_function(f"{x}.frames.length > 10 && {x}.position > 0")
    assert root.locator(".pf-caption").inner_text() == "Four clouds, one after the other gone."
    assert root.locator(".pf-controls, .pf-missions").count() == 0
    bare = open_page("film.html", java_script_enabled=False)
    assert bare.tab.get_by_text("one after the other gone").is_visible()
    assert bare.tab.locator("img.pf-still").count() == 2
    bare.tab.context.close()
    page.tab.context.close()
