"""A thumb on the picture: a tap acts, a held handle moves, a swipe scrolls and nothing else."""

from __future__ import annotations

import pytest

pytestmark = pytest.mark.page
PHONE = {"width": 390, "height": 844}
STATE = """x => ({ seed: x.seed, values: x.values, history: x.history, pending: x.pending,
  mode: x.mode, starting: Boolean(x.starting) })"""


class Thumb:
    """One finger, moved as the browser's own input: pages scroll, gestures are recognised."""

    def __init__(self, page):
        self.tab = page.tab
        self.wire = page.tab.context.new_cdp_session(page.tab)

    def touch(self, kind: str, *points: tuple[float, float]) -> None:
        touches = [{"x": x, "y": y, "id": k} for k, (x, y) in enumerate(points)]
        self.wire.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})

    def drag(self, start: tuple[float, float], by: tuple[float, float], steps: int = 12) -> None:
        self.touch("touchStart", start)
        for k in range(1, steps + 1):
            self.touch("touchMove", (start[0] + by[0] * k / steps, start[1] + by[1] * k / steps))
            self.tab.wait_for_timeout(16)
        self.tab.wait_for_timeout(200)  # a finger that rests throws nothing
        self.touch("touchMove", (start[0] + by[0], start[1] + by[1]))
        self.touch("touchEnd")
        self.tab.wait_for_timeout(250)

    def tap(self, at: tuple[float, float]) -> None:
        self.touch("touchStart", at)
        self.tab.wait_for_timeout(40)
        self.touch("touchEnd")


@pytest.fixture(scope="module", params=["host", "folder"])
def phone(request, open_page, site):
    """A recorded explorable on a phone, with room to scroll both ways."""
    base = {} if request.param == "host" else {"base": site.as_uri() + "/"}
    page = open_page("scenes.html", has_touch=True, is_mobile=True, **PHONE, **base)
    page.x = page.explorable()
    page.tab.add_style_tag(content="body { padding-block: 900px }")
    page.tab.wait_for_function(f"{page.x}.frames.length > 10 && {page.x}.report")
    page.thumb = Thumb(page)
    yield page
    assert not page.errors and not page.outside()
    page.tab.context.close()


@pytest.fixture(scope="module")
def live_phone(open_page):
    page = open_page("scenes.html", has_touch=True, is_mobile=True, **PHONE)
    page.x = page.live()
    page.tab.add_style_tag(content="body { padding-block: 900px }")
    page.thumb = Thumb(page)
    return page


def middle(page, selector: str) -> tuple[float, float]:
    """Scroll an element into the middle of the screen and return its own middle."""
    at = page.tab.locator(selector).first
    at.evaluate("e => e.scrollIntoView({ block: 'center', behavior: 'instant' })")
    page.tab.wait_for_timeout(100)
    box = at.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def scrolled(page) -> float:
    return page.tab.evaluate("document.scrollingElement.scrollTop")


def follows(page, top: float, by: float) -> None:
    """Wait until the page has scrolled by a finger's way; Chromium keeps up to 60 px of it."""
    page.tab.wait_for_function(
        "([top, by]) => Math.abs(document.scrollingElement.scrollTop - top - by)"
        " <= 60 + 0.1 * Math.abs(by)",
        arg=[top, by],
    )


def free_place(page) -> tuple[float, float]:
    """A place in the picture, 45 pixels from all that can be held."""
    return tuple(
        page.tab.evaluate(
            f"""(() => {{
              const x = {page.x}, box = x.canvas.getBoundingClientRect();
              const r = x.renderer, v = r.views[0];
              const held = r.handles.map((h) => r.place(h.x, h.y, h.view));
              for (let i = 1; i < 10; i++) for (let j = 1; j < 10; j++) {{
                const p = [box.left + v.left + i / 10 * v.width,
                  box.top + v.bottom - j / 10 * v.height];
                if (held.every(([a, b]) => Math.hypot(a - p[0], b - p[1]) > 45)) return p;
              }}
            }})()"""
        )
    )


def handle(page, name: str) -> tuple[float, float]:
    """Where something that can be dragged is on the page."""
    return tuple(
        page.tab.evaluate(
            f"""(() => {{
              const r = {page.x}.renderer, h = r.handles.find((one) => one.name === {name!r});
              return r.place(h.x, h.y, h.view);
            }})()"""
        )
    )


def settle(page) -> None:
    page.tab.wait_for_function(f"!{page.x}.busy && !{page.x}.pending.length && !{page.x}.fresh")


def pause(page, seed: int | None = None) -> None:
    """Stop the run, begun again from a seed if one is given, with the robot standing."""
    page.tab.evaluate(f"{page.x}.setPlaying(false), {page.x}.hand.letGo('cancel')")
    if seed is not None:
        page.tab.evaluate(f"{page.x}.restart({seed})")
    settle(page)
    page.tab.wait_for_timeout(50)
    settle(page)


SWIPED = [
    ".pf-canvas",
    ".pf-control input[type=range]",
    ".pf-segments label",
    ".pf-is-button button",
    ".pf-transport button:nth-of-type(2)",
    ".pf-scrub input",
    ".pf-tools button:nth-of-type(2)",
    ".pf-missions li",
]


@pytest.mark.parametrize("selector", SWIPED)
@pytest.mark.parametrize("up", [True, False])
def test_a_swipe_scrolls_and_loads_nothing(phone, selector, up):
    at = middle(phone, selector)
    if selector == ".pf-canvas":
        at = free_place(phone)
    asked, before = len(phone.requests), phone.tab.evaluate(f"({STATE})({phone.x})")
    top = scrolled(phone)
    phone.thumb.drag(at, (0, -150 if up else 150))
    follows(phone, top, 150 if up else -150)
    assert phone.tab.evaluate(f"({STATE})({phone.x})") == before
    assert len(phone.requests) == asked


def test_a_finger_moves_a_slider_sideways(live_phone):
    page = live_phone
    at = middle(page, ".pf-control input[type=range]")
    before = page.tab.evaluate(f"{page.x}.values.M")
    page.thumb.drag(at, (60, 4))
    page.tab.wait_for_function(f"{page.x}.values.M > {1.5 * before}")
    page.thumb.tap(at)
    page.tab.wait_for_function(f"{page.x}.values.M < {1.5 * before}")


def test_a_swipe_over_a_live_picture_changes_nothing(live_phone):
    page = live_phone
    pause(page)
    middle(page, ".pf-canvas")
    for by in ((0, -140), (0, 140), (6, -140)):
        before = page.tab.evaluate(f"[{page.x}.ticks, {page.x}.history, {page.x}.report]")
        top = scrolled(page)
        page.thumb.drag(free_place(page), by)
        follows(page, top, -by[1])
        settle(page)
        assert page.tab.evaluate(f"[{page.x}.ticks, {page.x}.history, {page.x}.report]") == before


@pytest.mark.parametrize("name", ["landmark 2", "robot", "range noise", "threshold"])
def test_a_held_handle_moves_and_the_page_stays(live_phone, name):
    page = live_phone
    pause(page, seed=3)
    middle(page, ".pf-canvas")
    start, top = handle(page, name), scrolled(page)
    by = (30 if start[0] < 190 else -30, 40 if start[1] < 420 else -40)
    page.thumb.drag(start, by)
    settle(page)
    end = handle(page, name)
    if name == "threshold":
        assert page.tab.evaluate(f"{page.x}.values.threshold") != 0.5
        assert end[1] == pytest.approx(start[1] + by[1], abs=6)
    elif name == "range noise":
        assert page.tab.evaluate(f"{page.x}.values.sigma_r") != 0.3
        shown = page.tab.get_by_label("Range noise").first.get_attribute("aria-valuetext")
        assert shown.startswith(f"{page.tab.evaluate(page.x + '.values.sigma_r'):.2f}")
    else:
        assert end == pytest.approx((start[0] + by[0], start[1] + by[1]), abs=6)
    if name == "robot":
        page.tab.evaluate(f"{page.x}.setPlaying(true)")
        page.tab.wait_for_function(f"{page.x}.status.textContent.includes('carried off')")
    assert scrolled(page) == top


def test_a_tap_sends_the_robot_there(live_phone):
    page = live_phone
    pause(page, seed=3)
    middle(page, ".pf-canvas")
    place = free_place(page)
    page.thumb.tap(place)
    page.tab.wait_for_function(f"{page.x}.history.some((h) => h[1] === 'hold' && h[5] === 'tap')")
    page.tab.evaluate(f"{page.x}.change('autopilot', false), {page.x}.setPlaying(true)")
    page.tab.wait_for_function(
        f"""(() => {{
          const r = {page.x}.renderer, h = r.handles.find((one) => one.name === "robot");
          const [x, y] = r.place(h.x, h.y, h.view);
          return Math.hypot(x - {place[0]}, y - {place[1]}) < 16;
        }})()"""
    )
    page.tab.evaluate(f"{page.x}.change('autopilot', true), {page.x}.setPlaying(false)")


def test_a_tap_on_a_recorded_picture_starts_python_and_acts(phone):
    middle(phone, ".pf-canvas")
    phone.thumb.tap(free_place(phone))
    phone.tab.wait_for_function(f"{phone.x}.mode === 'live'")
    assert phone.tab.evaluate(f"{phone.x}.history.map(h => [h[1], h[5]])") == [["hold", "tap"]]


# The last on this page: it stays magnified.
def test_two_fingers_and_a_sideways_swipe_change_nothing(live_phone):
    page = live_phone
    pause(page)
    middle(page, ".pf-canvas")
    before = page.tab.evaluate(f"{page.x}.report")
    x, y = free_place(page)
    page.thumb.drag((x, y), (70, 0))
    page.thumb.touch("touchStart", (x, y))
    page.thumb.touch("touchStart", (x, y), (x + 40, y + 40))
    page.thumb.touch("touchMove", (x - 30, y - 30), (x + 70, y + 70))
    page.thumb.touch("touchEnd")
    page.tab.wait_for_timeout(200)
    settle(page)
    assert page.tab.evaluate(f"{page.x}.report") == before


# ---- keys -------------------------------------------------------------------------------------


def test_no_key_of_the_picture_acts_on_a_focused_control(open_page):
    """h, k, r, full stop: pressed in any control of the explorable, nothing happens to it."""
    page = open_page("scenes.html")
    x = page.live()
    page.x = x
    pause(page)
    page.tab.locator(".pf-more summary").first.click()
    controls = page.tab.locator(".pf-explorable").first.locator("button, input, select")
    for k in range(controls.count()):
        control = controls.nth(k)
        if not control.is_visible() or control.get_attribute("type") == "number":
            continue
        control.focus()
        before = page.tab.evaluate(f"({STATE})({x})")
        for key in ("h", "k", "r", ".", "/"):
            page.tab.keyboard.press(key)
        assert page.tab.evaluate(f"({STATE})({x})") == before
        assert page.tab.evaluate("document.activeElement") is not None
    seed = page.tab.locator(".pf-seed input").first
    seed.focus()
    ticks = page.tab.evaluate(f"{x}.ticks")
    page.tab.keyboard.type("1.r k")
    assert page.tab.evaluate(f"{x}.ticks") == ticks
    page.tab.context.close()


def test_the_keyboard_takes_hold_of_every_handle_and_puts_it_down(open_page):
    page = open_page("scenes.html")
    page.x = page.live()
    tab, x = page.tab, page.x
    pause(page, seed=3)
    tab.evaluate(f"{x}.canvas.focus()")
    names = tab.evaluate(f"{x}.renderer.handles.map((h) => h.name)")
    assert {"landmark 1", "range noise", "robot", "threshold"} <= set(names)
    for name in names:
        tab.keyboard.press("h")
        assert tab.evaluate(f"{x}.renderer.held") == name
        assert f"You hold: {name}." in tab.evaluate(f"{x}.status.textContent")
        settle(page)
    tab.keyboard.press("Escape")
    settle(page)
    assert tab.evaluate(f"{x}.renderer.held") == ""
    tab.keyboard.press("h")  # the first one again
    before = handle(page, "landmark 1")
    for _ in range(4):
        tab.keyboard.press("ArrowUp")
        settle(page)
    tab.keyboard.press("Enter")
    settle(page)
    tab.wait_for_timeout(50)
    after = handle(page, "landmark 1")
    assert after == pytest.approx((before[0], before[1] - 32), abs=2)
    assert not page.errors
    tab.context.close()
