"""Fresh tabs, and the built book over http."""

from __future__ import annotations

import browser
import pytest


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
