"""A page in a tab, and a reader of a lab: they type on the keyboard, one key after the other.

Nothing here sets a text by script, and the page offers no way to do so.
"""

from __future__ import annotations

import json

STARTED = "window.PF && PF.lab"


class Page:
    """A tab that notes script errors and requests that leave the book."""

    def __init__(self, context, base: str, page: str):
        self.tab, self.base = context.new_page(), base
        self.errors: list[str] = []
        self.requests: list[str] = []
        self.tab.on("pageerror", lambda error: self.errors.append(str(error)))
        self.tab.on("request", lambda request: self.requests.append(request.url))
        self.tab.on("dialog", lambda dialog: (self.errors.append("dialog"), dialog.dismiss()))
        self.tab.goto(base + page)

    def outside(self) -> list[str]:
        return [u for u in self.requests if not u.startswith((self.base, "data:", "blob:"))]

    def explorable(self, number: int = 0):
        """Scroll to an explorable and wait until it is more than a still."""
        self.tab.locator(".pf-explorable").nth(number).scroll_into_view_if_needed()
        at = f"document.querySelectorAll('.pf-explorable')[{number}]"
        self.tab.wait_for_function(f"{at}.pfExplorable")
        return at + ".pfExplorable"

    def live(self, number: int = 0) -> str:
        """Bring an explorable to life; returns the script that names it."""
        x = self.explorable(number)
        self.tab.evaluate(f"{x}.touch()")
        self.tab.wait_for_function(f"{x}.mode === 'live'", timeout=90_000)
        return x


class Reader:
    """The lab page and the verbs of its reader."""

    def __init__(self, page):
        self.page, self.tab = page, page.tab
        self.tab.wait_for_function(STARTED, timeout=60_000)

    def group(self, item):
        return self.tab.get_by_role("group", name=f"Answer {item}", exact=True)

    # ---- looking ---------------------------------------------------------------------------
    def code(self, item):
        return self.tab.evaluate(f"PF.lab.text({json.dumps(item)})")

    def output(self, item):
        return self.group(item).locator(".pf-out").text_content()

    def verdict(self, item):
        return self.group(item).locator(".pf-verdict").text_content()

    def said(self, item):
        return self.group(item).locator(".pf-note[role=status]").first.text_content()

    def status(self, item):
        return self.group(item).get_attribute("data-status")

    def bar(self):
        return self.tab.locator(".pf-labbar .pf-note").inner_text()

    # ---- writing ---------------------------------------------------------------------------
    def focus(self, item):
        """Click into the editor; one that is folded away is opened first."""
        content = self.group(item).locator(".cm-content")
        if not content.is_visible():
            self.group(item).locator("summary", has_text="Show code").click()
        content.click()

    def type(self, item, source, delay=0):
        """Replace what stands in the editor; line by line, and no further in than it has to be."""
        keys = self.tab.keyboard
        self.focus(item)
        keys.press("Control+a")
        keys.press("Delete")
        for number, line in enumerate(source.split("\n")):
            text = line.lstrip(" ")
            if number:
                keys.press("Enter")
                self._indent(item, len(line) - len(text))
            keys.type(text, delay=delay)
        assert self.code(item) == source, self.code(item)

    def _indent(self, item, wanted):
        """The editor indents by itself; bring the new line to where it is wanted."""
        for _ in range(20):
            here = len(self.code(item).split("\n")[-1])
            if here == wanted:
                return
            self.tab.keyboard.press("Backspace" if here > wanted else "Space")
        raise AssertionError(f"cannot indent to {wanted} spaces: {self.code(item)!r}")

    # ---- pressing --------------------------------------------------------------------------
    def press(self, item, button):
        self.group(item).get_by_role("button", name=button, exact=True).click()

    def wait(self, item):
        """Until the run is over."""
        stop = self.group(item).locator(".pf-stop")
        stop.wait_for(state="hidden", timeout=120_000)
        return self.output(item)

    def answer(self, item, source, button="Check"):
        self.type(item, source)
        self.press(item, button)
        return self.wait(item)

    def choose(self, item, letter, sure=None):
        group = self.group(item)
        group.get_by_label(f"({letter})").check()
        if sure is not None:
            field = group.get_by_label("How sure are you?")
            field.click()
            self.tab.keyboard.press("Control+a")
            self.tab.keyboard.press("Delete")
            self.tab.keyboard.type(str(sure))

    def locked(self, item):
        """Its prediction is (a), 70 % sure, and cannot be changed."""
        group = self.group(item)
        assert group.get_by_label("(a)").is_checked() and group.get_by_label("(b)").is_disabled()
        assert "Locked: (a), 70 % sure." in self.verdict(item)
        assert not group.get_by_role("button").count()
