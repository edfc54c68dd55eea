"""The same pages in Firefox: Debian's build speaks WebDriver BiDi over a socket, no driver needed.

Where no Firefox is found (PFKIT_FIREFOX names another), this is skipped with the reason.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import time

import pytest

from pfkit.explore.host import Host

pytestmark = pytest.mark.page
FIREFOX = os.environ.get("PFKIT_FIREFOX") or next(
    filter(None, map(shutil.which, ("firefox-esr", "firefox"))), None
)
X = "document.querySelector('.pf-explorable').pfExplorable"
OPERATIONS = json.dumps([["step", 30], ["set", "sigma_r", 0.7], ["step", 30]])
READOUTS = f"""(async () => {{
  await PF.scenes.ask({{ do: "open", key: "t", name: "drive", panel: null, seed: 8 }});
  const told = await PF.scenes.ask({{ do: "run", key: "t", operations: {OPERATIONS!r} }});
  return JSON.parse(told.report).readouts[0];
}})()"""
ARROW_DOWN = "\ue015"  # WebDriver's code of that key
PATIENCE = 90  # seconds: a busy machine is slow, not wrong


class Firefox:
    """As much of WebDriver BiDi as these tests need."""

    def __init__(self, address: str):
        websocket = pytest.importorskip("websocket")
        self.socket = websocket.create_connection(
            address + "/session", timeout=PATIENCE, suppress_origin=True
        )
        self.sent = 0
        self.events: list[dict] = []
        self.ask("session.new", capabilities={})
        self.ask("session.subscribe", events=["log.entryAdded", "network.beforeRequestSent"])
        self.tab = self.ask("browsingContext.getTree")["contexts"][0]["context"]

    def ask(self, method: str, **params):
        self.sent += 1
        self.socket.send(json.dumps({"id": self.sent, "method": method, "params": params}))
        while True:
            message = json.loads(self.socket.recv())
            if message.get("id") != self.sent:
                self.events.append(message)
                continue
            assert message["type"] == "success", message
            return message["result"]

    def goto(self, url: str) -> None:
        self.ask("browsingContext.navigate", context=self.tab, url=url, wait="complete")

    def evaluate(self, script: str):
        """The value of an expression, awaited."""
        wrapped = f"(async () => JSON.stringify((await ({script})) ?? null))()"
        told = self.ask(
            "script.evaluate", expression=wrapped, awaitPromise=True, target={"context": self.tab}
        )
        assert told["type"] == "success", told
        return json.loads(told["result"]["value"])

    def wait(self, script: str) -> None:
        end = time.monotonic() + PATIENCE
        while not self.evaluate(f"Boolean({script})"):
            assert time.monotonic() < end, f"waited in vain for {script}"
            time.sleep(0.1)

    def press(self, *keys: str) -> None:
        """Press and release keys, one after the other: real ones, as a keyboard sends them."""
        held = [{"type": kind, "value": key} for key in keys for kind in ("keyDown", "keyUp")]
        actions = [{"type": "key", "id": "keyboard", "actions": held}]
        self.ask("input.performActions", context=self.tab, actions=actions)

    def click(self, element: str) -> None:
        """Bring an element into view and press the pointer on it."""
        place = self.evaluate(
            f"""(() => {{
              {element}.scrollIntoView({{ block: "center", behavior: "instant" }});
              const r = {element}.getBoundingClientRect();
              return [r.x + Math.min(r.width / 2, 20), r.y + Math.min(r.height / 2, 10)];
            }})()"""
        )
        x, y = map(round, place)
        move = {"type": "pointerMove", "x": x, "y": y}
        press = [{"type": kind, "button": 0} for kind in ("pointerDown", "pointerUp")]
        steps = [move, *press]
        actions = [{"type": "pointer", "id": "mouse", "actions": steps}]
        self.ask("input.performActions", context=self.tab, actions=actions)

    def outside(self, base: str) -> list[str]:
        """Requests that left the book."""
        requests = [e for e in self.events if e["method"] == "network.beforeRequestSent"]
        urls = [e["params"]["request"]["url"] for e in requests]
        return [url for url in urls if not url.startswith((base, "data:", "blob:"))]

    def errors(self) -> list[str]:
        """Script errors of the page; what it only writes to the console is no error."""
        entries = [e["params"] for e in self.events if e["method"] == "log.entryAdded"]
        return [e["text"] for e in entries if e["level"] == "error" and e["type"] == "javascript"]


@pytest.fixture(scope="module")
def firefox(tmp_path_factory):
    if FIREFOX is None:
        pytest.skip("no Firefox on this machine (apt install firefox-esr)")
    home = tmp_path_factory.mktemp("firefox")
    log = home / "log"
    command = [FIREFOX, "--headless", "--no-remote", "--profile", home, "--remote-debugging-port=0"]
    with log.open("w") as out:
        process = subprocess.Popen(
            command, stdout=out, stderr=out, env={**os.environ, "HOME": str(home)}
        )
    end = time.monotonic() + PATIENCE
    while not (found := re.search(r"listening on (ws://\S+)", log.read_text())):
        assert process.poll() is None and time.monotonic() < end, log.read_text()[-2000:]
        time.sleep(0.1)
    browser = Firefox(found[1])
    yield browser
    browser.socket.close()
    process.terminate()
    process.wait(30)


@pytest.mark.parametrize("where", ["host", "folder"])
def test_explorables_and_answers_work(firefox, site, address, where):
    base = address if where == "host" else site.as_uri() + "/"
    firefox.events.clear()
    firefox.goto(base + "scenes.html")
    firefox.evaluate("document.querySelector('.pf-explorable').scrollIntoView()")
    firefox.wait(f"{X} && {X}.frames.length > 10")
    firefox.evaluate(f"{X}.touch()")
    firefox.wait(f"{X}.mode === 'live' && {X}.framesDrawn > 5")
    host = Host()
    host.open("k", "drive", None, 8)
    here = json.loads(host.do("k", OPERATIONS)[1])["readouts"][0]
    assert firefox.evaluate(READOUTS) == pytest.approx(here, rel=1e-9, abs=1e-9)
    firefox.evaluate(f"{X}.change('kidnap', true)")
    firefox.wait(f"{X}.status.textContent.includes('carried off')")
    firefox.wait("!document.querySelector('.pf-loading, [aria-busy]')")
    firefox.evaluate(f"{X}.change('fresh', 5)")
    firefox.wait("document.querySelector('.pf-done')")  # found again, and ticked off
    firefox.goto(base + "scenes.html")
    firefox.evaluate("document.querySelector('.pf-explorable').scrollIntoView()")
    firefox.wait("document.querySelector('.pf-done')")
    firefox.goto(base + "lab.html")
    firefox.wait("window.PF && PF.lab")
    firefox.click("document.querySelector('[name=pf-choice-p1a][value=a]')")
    firefox.press(ARROW_DOWN)
    firefox.wait("PF.lab.text('p1a') === 'p1a = \"b\"'")
    answer = "document.querySelector('[aria-label=\"Answer p5b\"]')"
    firefox.click(f"{answer}.querySelector('.cm-content')")
    firefox.press(*"a/b#?")
    firefox.wait("PF.lab.text('p5b').includes('a/b#?')")
    firefox.click(f"{answer}.querySelector('.pf-check')")
    firefox.wait(f"{answer}.querySelector('.pf-verdict').textContent === 'could not be judged'")
    told = firefox.evaluate(f"{answer}.querySelector('.pf-out').textContent")
    assert "in line " in told and told.endswith("^")
    assert not firefox.outside(base) and not firefox.errors()
