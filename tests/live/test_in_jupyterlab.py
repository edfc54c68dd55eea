"""An explorable in JupyterLab: a real browser moves a control, the kernel computes, it follows."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import re
import subprocess
import sys
import time
import urllib.request

import pytest

pytestmark = pytest.mark.page


@pytest.fixture
def jupyter(tmp_path):
    """A JupyterLab on this machine, with one notebook; yields its address."""
    if importlib.util.find_spec("jupyterlab") is None:
        pytest.skip("JupyterLab is not installed (pip install jupyterlab)")
    import nbformat

    cell = nbformat.v4.new_code_cell(
        'import pfkit.widgets as widgets\nwidgets.explore("comb", seed=7)', id="c0"
    )
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    notebook = nbformat.v4.new_notebook(cells=[cell], metadata={"kernelspec": kernel})
    nbformat.write(notebook, tmp_path / "one.ipynb")
    settings = {"JUPYTER_CONFIG_DIR": str(tmp_path / "config"), "IPYTHONDIR": str(tmp_path / "ip")}
    environment = {**os.environ, **settings, "JUPYTER_RUNTIME_DIR": str(tmp_path / "run")}
    environment.pop("PFKIT_WIDGETS", None)
    log = (tmp_path / "log").open("w+")
    server = subprocess.Popen(
        [sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root", "--port=0",
         "--ServerApp.token=", "--ServerApp.password=", f"--ServerApp.root_dir={tmp_path}",
         "--LabApp.news_url=None", "--LabApp.check_for_updates_class="
         "jupyterlab.NeverCheckForUpdate"],
        stdout=log, stderr=log, env=environment, cwd=tmp_path,
    )  # fmt: skip
    address = None
    for _ in range(240):
        time.sleep(0.25)
        found = re.search(r"http://(127\.0\.0\.1|localhost):(\d+)", (tmp_path / "log").read_text())
        if found:
            address = f"http://127.0.0.1:{found.group(2)}"
            try:
                urllib.request.urlopen(address + "/api", timeout=2)
                break
            except OSError:
                continue
    assert address, (tmp_path / "log").read_text()[-2000:]
    yield address
    server.terminate()
    server.wait(20)
    log.close()


def test_a_control_moved_in_jupyterlab_is_followed(chromium, jupyter):
    from playwright.sync_api import TimeoutError

    context = chromium.new_context(viewport={"width": 1200, "height": 900})
    tab = context.new_page()
    ask = tab.locator(".jp-Dialog")  # a slow machine is asked which kernel; the default is right
    tab.add_locator_handler(ask, lambda dialog: dialog.locator(".jp-mod-accept").click())
    tab.goto(jupyter + "/lab/tree/one.ipynb?reset", wait_until="load")
    tab.locator(".jp-Notebook .jp-CodeCell").first.wait_for(timeout=90_000)
    idle = ".jp-Notebook-ExecutionIndicator[data-status='idle']"
    tab.locator(idle).first.wait_for(state="attached", timeout=90_000)
    root = tab.locator(".pf-explorable")
    for _ in range(8):  # a kernel that has just become idle may still ignore the first request
        tab.locator(".jp-Notebook .jp-CodeCell .cm-content").first.click()
        tab.keyboard.press("Shift+Enter")
        with contextlib.suppress(TimeoutError):
            root.wait_for(timeout=15_000)
            break
    root.wait_for(timeout=1000)
    x = "document.querySelector('.pf-explorable').pfExplorable"
    tab.wait_for_function(f"{x} && {x}.mode === 'live' && {x}.ticks > 2", timeout=60_000)
    assert tab.evaluate(f"{x}.values.n") == 5
    slider = root.get_by_role("slider", name="Teeth n")
    slider.focus()
    slider.press("ArrowRight")
    tab.wait_for_function(f"{x}.values.n === 6 && {x}.report.values.n === 6", timeout=30_000)
    root.get_by_role("application").scroll_into_view_if_needed()  # what nobody sees stands still
    tab.wait_for_function(f"{x}.ticks > 2")
    assert tab.evaluate(f"{x}.report.readouts[0].draws") > 0
    context.close()
