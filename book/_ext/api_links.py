"""A name in a docstring of pfkit leads to what it names: `wrap`, `history.run`, `survival`.

Docstrings say `systematic`, not `pfkit.particles.resampling.systematic`. Sphinx asks here when it
does not find a name by itself; we offer the only thing of pfkit that ends so, and nothing if there
are two.
"""

from __future__ import annotations

from typing import Any

from docutils import nodes
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment


def resolve(
    app: Sphinx, env: BuildEnvironment, node: pending_xref, shown: nodes.TextElement
) -> nodes.reference | None:
    if (node.get("refdomain"), node.get("reftype")) != ("py", "obj"):
        return None
    domain: Any = env.get_domain("py")
    ending = "." + node["reftarget"].removeprefix("pfkit.")
    found = [name for name in domain.objects if name.startswith("pfkit.") and name.endswith(ending)]
    shortest = [name for name in found if name.count(".") == min(n.count(".") for n in found)]
    if len(shortest) != 1:
        return None
    return domain.resolve_xref(env, node["refdoc"], app.builder, "obj", shortest[0], node, shown)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("missing-reference", resolve)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
