"""The same from a folder on disk, where a page may fetch nothing."""

from __future__ import annotations

import json

import pytest

from pfkit.explore.host import Host

pytestmark = pytest.mark.page


@pytest.fixture(scope="module")
def folder(site):
    return site.as_uri() + "/"


def test_explorable_records_boots_and_agrees(open_page, folder):
    page = open_page("scenes.html", base=folder)
    x = page.explorable()
    page.tab.wait_for_function(f"{x}.frames.length > 10")
    assert not [u for u in page.requests if "bundle" in u]
    page.live()
    operations = json.dumps([["step", 30], ["set", "sigma_r", 0.7], ["step", 30]])
    there = page.tab.evaluate(
        """async (operations) => {
          await PF.scenes.ask({ do: "open", key: "t", name: "drive", panel: null, seed: 8 });
          return JSON.parse((await PF.scenes.ask({ do: "run", key: "t", operations })).report);
        }""",
        operations,
    )
    host = Host()
    host.open("k", "drive", None, 8)
    here = json.loads(host.do("k", operations)[1])
    assert there["readouts"] == pytest.approx(here["readouts"], rel=1e-9, abs=1e-9)
    assert not page.errors and not page.outside()
    page.tab.context.close()


def test_lab_is_checked(open_page, folder):
    page = open_page("lab.html", base=folder)
    page.tab.wait_for_function("window.PF && PF.lab", timeout=30_000)
    page.tab.evaluate("PF.lab.editors[0].set(\"p1a = 'a'\")")
    page.tab.evaluate("PF.lab.editors[0].run(true)")
    assert page.tab.evaluate("PF.lab.editors[0].out.textContent").startswith("p1a: ")
    assert page.tab.evaluate("PF.lab.editors[0].root.dataset.status") in ("passed", "wrong")
    assert not page.errors and not page.outside()
    page.tab.context.close()
