"""One browser a session; a visible reason where there is none, and a failure in CI."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

import browser


@pytest.fixture(scope="session")
def chromium():
    """Start the browser once; skip, saying why, where there is none."""
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


@pytest.fixture
def tab(chromium):
    """Give a fresh tab, with nothing stored from another test."""
    context = chromium.new_context()
    context.set_default_timeout(browser.PATIENCE)
    yield context.new_page()
    context.close()


@pytest.fixture(scope="session")
def book_address():
    """Serve the built book over http."""
    with browser.served(browser.HTML) as address:
        yield address
