"""Sphinx extension: chapters open in Binder or Colab, once the repository has a public address.

`course_address` in `_config.yml` is that address; while it is empty no page shows a button that
leads nowhere (the theme's own options cannot be given without an address).
"""

from __future__ import annotations

from sphinx.application import Sphinx
from sphinx.config import Config

HOSTS = {
    "notebook_interface": "jupyterlab",
    "binderhub_url": "https://mybinder.org",
    "colab_url": "https://colab.research.google.com",
}


def offer(_app: Sphinx, config: Config) -> None:
    """Hand the theme what its rocket needs, if there is an address to launch from."""
    if config.course_address:
        config.html_theme_options |= {
            "repository_url": config.course_address,
            "repository_branch": "main",
            "launch_buttons": HOSTS,
        }


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the address and what follows from it."""
    app.add_config_value("course_address", "", "html", str)
    app.connect("config-inited", offer, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
