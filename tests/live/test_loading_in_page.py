"""From a press to Python: seen where it was pressed, told in few words, tried again when cut."""

from __future__ import annotations

import pytest

pytestmark = pytest.mark.page
SAID = """
addEventListener("DOMContentLoaded", () => {
  window.said = [];
  new MutationObserver((changes) => {
    for (const c of changes) {
      const e = c.target.nodeType === 1 ? c.target : c.target.parentElement;
      const live = e && e.closest("[aria-live], [role=status], [role=alert]");
      if (live && !e.closest("[aria-hidden=true]")) said.push(live.textContent);
    }
  }).observe(document, { subtree: true, childList: true, characterData: true });
});
"""


@pytest.fixture
def page(open_page):
    opened = open_page("scenes.html", init=SAID)
    opened.x = opened.explorable()
    opened.tab.wait_for_function(f"{opened.x}.frames.length > 10 && {opened.x}.report")
    yield opened
    assert not opened.errors and not opened.outside()
    opened.tab.context.close()


CONTROLS = [
    ("button", "Go live"),
    ("button", "Next phase"),
    ("button", "New seed"),
    ("button", "Kidnap the robot"),
    ("radio", "bearing"),
    ("button", "Run 100 seeds"),
]


def hold_python(page):
    """Let no file of Python come through; returns how to let them."""
    pattern = "**/live/*.zip*"
    waiting: list = []
    page.tab.context.route(pattern, lambda route: waiting.append(route))

    def release():
        for route in waiting:
            route.continue_()
        waiting.clear()
        page.tab.context.unroute(pattern)

    return release


@pytest.mark.parametrize(("role", "name"), CONTROLS)
def test_the_pressed_control_shows_at_once_that_it_works(page, role, name):
    release = hold_python(page)
    control = page.tab.locator(".pf-explorable").first.get_by_role(role, name=name, exact=True)
    control.scroll_into_view_if_needed()
    seen = page.tab.evaluate(
        """(e) => { e.click();
          const box = document.querySelector(".pf-loading");
          const [a, b] = [e, box].map((x) => x.getBoundingClientRect());
          return { busy: e.getAttribute("aria-busy"),
            apart: Math.max(b.top - a.bottom, a.top - b.bottom, b.left - a.right, 0),
            inside: b.left >= 0 && b.right <= innerWidth, text: box.textContent } }""",
        control.element_handle(),
    )
    assert seen["busy"] == "true" and seen["text"] and seen["inside"]
    assert seen["apart"] < 60, "the progress is not beside the control"
    page.tab.wait_for_function("document.querySelector('.pf-loading').textContent.includes('MB')")
    release()
    page.tab.wait_for_function(f"{page.x}.mode === 'live'", timeout=90_000)
    assert page.tab.locator(".pf-loading, [aria-busy]").count() == 0


@pytest.mark.parametrize("how", ["cut", "stalled"])
def test_a_download_that_fails_can_be_tried_again(page, how):
    assert page.tab.evaluate("PF.patience.seconds") == 15
    page.tab.evaluate("PF.patience.seconds = 3")
    pattern = "**/live/numpy.zip*"
    page.tab.context.route(pattern, lambda r: r.abort("failed") if how == "cut" else None)
    page.tab.get_by_role("button", name="Kidnap the robot").click()
    again = page.tab.get_by_role("button", name="Try again")
    again.wait_for(timeout=60_000)
    why = page.tab.locator(".pf-failed").inner_text()
    assert ("cut" if how == "cut" else "nothing arrived for 3 seconds") in why
    assert page.tab.locator("[aria-busy]").count() == 0
    box = page.tab.get_by_role("button", name="Kidnap the robot").bounding_box()
    assert abs(again.bounding_box()["y"] - box["y"]) < 160, "it is not beside the control"
    page.tab.context.unroute(pattern)
    page.tab.evaluate("PF.patience.seconds = 15")
    again.click()
    page.tab.wait_for_function(f"{page.x}.mode === 'live'", timeout=90_000)
    page.tab.wait_for_function(f"{page.x}.history.some((h) => h[2] === 'kidnap')")


def test_loading_is_told_in_four_messages_and_events_in_one_each(page):
    page.tab.wait_for_timeout(300)
    page.tab.evaluate("said.length = 0")
    page.live()
    assert 1 <= len(page.tab.evaluate("said")) <= 4, page.tab.evaluate("said")
    page.tab.get_by_role("button", name="Kidnap the robot").click()
    page.tab.wait_for_function("said.some((text) => text.includes('carried off'))")
    assert page.tab.evaluate("said.filter((text) => text.includes('carried off')).length") == 1


def test_a_run_is_not_silent_though_nothing_happens(page):
    page.live(1)
    comb = page.explorable(1)
    page.tab.evaluate(f"{comb}.news.length = 0, said.length = 0, {comb}.saidAt -= 60000")
    page.tab.wait_for_function("said.some((text) => text.includes('founders are left'))")


# ---- ticks ------------------------------------------------------------------------------------

DONE = "[...document.querySelectorAll('.pf-explorable')[1].querySelectorAll('.pf-done')].length"


def test_ticks_outlive_restart_seeds_reload_and_reach_another_tab(page):
    comb = page.live(1)
    assert page.tab.evaluate(DONE) == 0
    other = page.tab.context.new_page()
    other.goto(page.tab.url)
    other.locator(".pf-explorable").nth(1).scroll_into_view_if_needed()
    other.wait_for_function("document.querySelectorAll('.pf-explorable')[1].pfExplorable")
    page.tab.bring_to_front()
    page.tab.evaluate(f"{comb}.change('pace', 100)")
    page.tab.wait_for_function(f"{DONE} === 1")
    assert "Done" in page.tab.locator(".pf-done").first.inner_text()
    for button in ("Restart", "New seed"):
        page.tab.locator(".pf-explorable").nth(1).get_by_role("button", name=button).click()
        page.tab.wait_for_function(f"{comb}.ticks > 2")
        assert page.tab.evaluate(DONE) == 1
    other.bring_to_front()
    other.wait_for_function(f"{DONE} === 1")
    page.tab.bring_to_front()
    page.tab.reload()
    page.explorable(1)
    page.tab.wait_for_function(f"{DONE} === 1")


def test_without_storage_ticks_last_as_long_as_the_page(open_page):
    refuse = """for (const verb of ["setItem", "getItem"]) {
      const real = Storage.prototype[verb];
      Storage.prototype[verb] = function (key, ...rest) {
        if (key.startsWith("where-am-i")) throw new DOMException("refused", "SecurityError");
        return real.call(this, key, ...rest);
      };
    }"""
    page = open_page("scenes.html", init=refuse)
    comb = page.live(1)
    page.tab.evaluate(f"{comb}.change('pace', 100)")
    page.tab.wait_for_function(f"{DONE} === 1")
    assert not page.errors
    page.tab.context.close()


# ---- what is seen -----------------------------------------------------------------------------


def test_the_marker_of_the_mean_hides_neither_robot_nor_cloud(page):
    """Pixels at the common place: the robot's colour in the middle, the cloud's inside the ring."""
    here = page.tab.evaluate(
        """() => {
          const S = PF.palette.styles, at = (name) => S.indexOf(name);
          const canvas = document.createElement("canvas"), r = new PF.Renderer(canvas, [600, 600]);
          const cloud = [];
          for (let k = 0; k < 1200; k++) cloud.push(((k * 7919) % 1000) / 1000);
          const y = cloud.map((_, k) => ((k * 104729) % 1000) / 1000);
          const robots = (style, radius, open) => [8, at(style), 5, radius, open, 0.5, 0.5, 0];
          r.resize(600);
          const read = (x, y) => [...r.context.getImageData(
            Math.round(x * r.ratio), Math.round(y * r.ratio), 1, 1).data].slice(0, 3);
          const draw = (...records) => r.draw(Float32Array.from(
            [1, at("paper"), 10, 0, 0, 1, 1, 0, 1, 0, 1, 1, 0,
              2, at("particles"), 2401, 12, ...cloud, ...y, ...records]));
          draw();
          const bare = read(300, 265);
          draw(...robots("estimate", 0.1, 1), ...robots("truth", 0.03, 0));
          return { bare, ring: read(300, 265), robot: read(300, 300) };
        }"""
    )
    assert here["ring"] == here["bare"] != [251, 252, 253] and here["robot"] == [0, 0, 0]


@pytest.mark.parametrize(
    ("value", "decimals", "text"),
    [(0.001, 2, "0.00"), (1e-7, 2, "0.00"), (-0.001, 2, "0.00"), (9.996, 2, "10.00"),
     (0, 2, "0.00"), (123.456, 2, "123.46"), (-1.5, 1, "\u22121.5"), (12345, 0, "12\u2009345"),
     (12345.678, 2, "12\u2009345.68"), ("cell 3", 0, "cell 3")],
)  # fmt: skip
def test_a_number_keeps_its_decimals(page, value, decimals, text):
    assert page.tab.evaluate("([v, d]) => PF.written(v, d)", [value, decimals]) == text


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_disabled_buttons_are_legible(open_page, theme):
    page = open_page("scenes.html", color_scheme=theme)
    page.explorable()
    page.tab.evaluate("document.documentElement.dataset.theme = " + repr(theme))
    page.tab.wait_for_timeout(400)
    contrast = page.tab.evaluate(
        """() => {
          const button = document.querySelector(".pf-tools button:last-of-type");
          button.disabled = true;
          const light = (c) => {
            const [r, g, b] = c.match(/[\\d.]+/g).slice(0, 3).map((v) => v / 255)
              .map((v) => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
            return 0.2126 * r + 0.7152 * g + 0.0722 * b;
          };
          const style = getComputedStyle(button);
          const [a, b] = [style.color, style.backgroundColor].map(light).sort((x, y) => y - x);
          return (a + 0.05) / (b + 0.05) * (style.opacity === "1" ? 1 : 0);
        }"""
    )
    assert contrast >= 4.5
    page.tab.context.close()


def test_chosen_colours_keep_switches_choices_and_ticks(open_page):
    """With the reader's own colours, on and off look different, and neither is invisible."""
    page = open_page("scenes.html", forced_colors="active")
    page.explorable()
    root = page.tab.locator(".pf-explorable").first
    root.locator(".pf-more summary").click()
    switch = root.get_by_role("switch", name="Autopilot")
    switch.scroll_into_view_if_needed()
    looks = []
    for checked in (True, False):
        switch.evaluate("(e, on) => { e.checked = on; }", checked)
        looks.append(switch.screenshot())
    assert looks[0] != looks[1]
    colours = page.tab.evaluate(
        """() => {
          const root = document.querySelector(".pf-explorable");
          const look = (e) => ["backgroundColor", "color"].map((c) => getComputedStyle(e)[c]);
          const [on, off] = [":checked", ":not(:checked)"].map((w) =>
            look(root.querySelector(`.pf-segments input${w} + span`)));
          const row = root.querySelector(".pf-missions li"), mark = row.querySelector(".pf-mark");
          const open = look(mark);
          row.classList.add("pf-done");
          const edge = getComputedStyle(root.querySelector(".pf-is-toggle input")).borderTopStyle;
          const slider = root.querySelector("input[type=range]").getBoundingClientRect();
          return { on, off, open, done: look(mark), edge, slider: slider.width };
        }"""
    )
    assert colours["on"] != colours["off"] and colours["open"] != colours["done"]
    assert colours["edge"] == "solid" and colours["slider"] > 50
    page.tab.context.close()
