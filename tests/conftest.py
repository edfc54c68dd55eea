"""One browser for all tests that look at pages: two in one process would not start."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "book"))

import browser


@pytest.fixture(scope="session")
def chromium():
    """Start the browser once; skip, saying why, where there is none, and fail in CI."""
    program = browser.find_browser()
    if program is None:
        reason = "no Chromium on this machine (apt install chromium, or set PFKIT_BROWSER)"
        if os.environ.get("CI"):
            pytest.fail(f"page tests must run in CI: {reason}")
        pytest.skip(reason)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        running = playwright.chromium.launch(executable_path=program, args=browser.FLAGS)
        yield running
        running.close()
