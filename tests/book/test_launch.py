"""Launch buttons appear with the address of the repository, and not before."""

from __future__ import annotations

from types import SimpleNamespace

import launch
import pytest


@pytest.mark.parametrize("address, offered", [("", False), ("https://example.org/a/b", True)])
def test_buttons_need_an_address(address, offered):
    config = SimpleNamespace(course_address=address, html_theme_options={"show_toc_level": 2})
    launch.offer(None, config)
    assert ("launch_buttons" in config.html_theme_options) == offered
    assert config.html_theme_options.get("repository_url", "") == address
    assert config.html_theme_options["show_toc_level"] == 2
