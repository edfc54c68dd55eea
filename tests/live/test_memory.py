"""A cell that takes all memory: told in a sentence, and the memory comes back."""

from __future__ import annotations

import time
from pathlib import Path

import pytest
from reader import Page, Reader

pytestmark = pytest.mark.page
MOST = 700e6  # bytes of the page's process after the run
BOMBS = {
    "too big to count": "x = np.ones((20_000, 20_000))",
    "one array": "x = np.ones((10_000, 10_000))",
    "a list": "x = []\nwhile True: x.append(bytes(10**7))",
    "kept": "x = np.ones(80_000_000)",
    "a long text": "x = 'ab' * 10**9",
    "deep": "import sys\nsys.setrecursionlimit(10**6)\ndef f(n): return f(n + 1)\nf(0)",
    "deep in C": "x = []\nfor k in range(10**6): x = [x]\nrepr(x)",
}


def largest(chromium) -> float:
    """Resident bytes of the largest page process."""
    session = chromium.new_browser_cdp_session()
    processes = session.send("SystemInfo.getProcessInfo")["processInfo"]
    session.detach()
    sizes = [0.0]
    for one in processes:
        status = Path(f"/proc/{one['id']}/status")
        if one["type"] == "renderer" and status.exists():
            line = next(x for x in status.read_text().splitlines() if x.startswith("VmRSS"))
            sizes.append(1024 * float(line.split()[1]))
    return max(sizes)


def test_memory_comes_back_with_a_sentence(chromium, address):
    if not Path("/proc/self/status").exists():
        pytest.skip("memory of a process is read from /proc")
    context = chromium.new_context(viewport={"width": 1280, "height": 800})
    context.set_default_timeout(120_000)
    page = Page(context, address, "lab.html")
    reader = Reader(page)
    for name, source in BOMBS.items():
        told = reader.answer("p5b", source, "Run")
        said = f"{told} {reader.said('p5b')}"
        # On a busy machine deep recursion may last until it is stopped: a sentence as well.
        words = ("memory", "calls itself", "more characters", "Stopped after")
        assert any(w in said for w in words), (name, said)
        end = time.monotonic() + 20
        while largest(chromium) > MOST and time.monotonic() < end:
            time.sleep(0.5)
        print(f"{name}: {largest(chromium) / 1e6:.0f} MB; {said[:140]!r}")
        assert largest(chromium) < MOST, (name, largest(chromium), said)
        assert "42" in reader.answer("p1a", "6 * 7", "Run"), name
    assert not page.errors
    context.close()
