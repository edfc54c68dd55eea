"""The same from a folder on disk, where a page may fetch nothing."""

from __future__ import annotations

import json

import pytest
from reader import Reader

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
    assert there["readouts"][0] == pytest.approx(here["readouts"][0], rel=1e-9, abs=1e-9)
    assert not page.errors and not page.outside()
    page.tab.context.close()


def test_lab_is_checked(open_page, folder):
    page = open_page("lab.html", base=folder)
    reader = Reader(page)
    assert reader.answer("p1a", "p1a = 'a'  # 1/2").startswith("p1a: ")
    assert reader.status("p1a") in ("passed", "wrong")
    reader.type("p1a", "p1a = 'a'  # 1/3")
    assert reader.verdict("p1a").endswith(", edited since")
    assert "line 1" in reader.answer("p1a", "p1a = = 2") and reader.status("p1a") == ""
    page.tab.reload()
    assert Reader(page).code("p1a") == "p1a = = 2"
    assert not page.errors and not page.outside()
    page.tab.context.close()
