"""The layer table of the package, enforced by reading every import of every module.

A module may import from modules that stand before it in the table, in a lower layer or earlier in
its own. So there are no cycles, and a reader can take the package in this order. The core (L0 to
L5) uses NumPy and the standard library only; what the edge may use besides is written beside it.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "pfkit"

LAYERS: dict[str, list[str]] = {
    "L0": ["errors", "chi2", "geometry"],
    "L1": [
        *[
            "particles",
            "priors",
            "log",
            "maps",
            "map_files",
            "occupancy",
            "worlds",
            "distance",
            "raycast",
        ],
        *["resampling", "roulette", "survival", "triggers", "genealogy"],
    ],
    "L2": [
        *["motion", "odometry_motion", "wheels", "targets", "sensors", "landmark_sensors"],
        *[
            "association",
            "beams",
            "beam_fit",
            "likelihood_field",
            "robust",
            "faults",
            "intermittent",
        ],
    ],
    "L3": [
        *["estimators", "density", "modes"],
        "filters",
        "history",
        *["recovery", "kld", "roughening"],
        *["kalman", "gaussian", "smoother"],
        *["histogram", "posegrid", "gridfilter"],
        "oracle",
        "tempering",
    ],
    "L4": [
        *["odometry", "routes", "driving", "simulate", "datasets", "logfile"],
        *["comparison", "table"],
        *["diagnostics", "calibration", "consistency"],
        *["symmetry", "localise"],
    ],
    "L5": ["study"],
}
# The edge stands above the whole core. A package counts as one module here.
EDGE: dict[str, set[str]] = {
    "palette": set(),
    "plotting": {"matplotlib"},
    "explore": set(),
    "labs": set(),
    "labs.grade": {"nbformat", "nbclient", "jupyter_client"},
    "labs.release": {"nbformat", "nbclient"},
    "widgets": {"anywidget", "ipywidgets", "traitlets", "IPython"},
    "__main__": {"matplotlib"},
}
# Parts of the edge that another part may build on.
EDGE_USES = {
    "plotting": {"palette"},
    "explore": {"palette"},
    "labs": {"explore"},
    "widgets": {"explore", "palette"},
    "__main__": {"plotting"},
}
OPTIONAL_FRONT_ENDS = {"labs": {"ipywidgets", "IPython"}}  # inside a function, behind a fallback
ORDER = {name: i for i, name in enumerate(m for layer in LAYERS.values() for m in layer)}


def module_of(path: Path, package: Path = PACKAGE) -> str:
    """Name the entry of the table that a file belongs to."""
    parts = path.relative_to(package).with_suffix("").parts
    dotted = ".".join(parts[:2])
    return dotted if dotted in EDGE else parts[0]


def imports(source: str, inside: str = "pfkit") -> Iterator[tuple[str, bool]]:
    """Yield each imported module of some source, and whether the import is at the top level."""
    tree = ast.parse(source)
    guarded = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")
        for inner in ast.walk(node)
    }
    top = {id(node) for node in tree.body}
    for node in ast.walk(tree):
        if id(node) in guarded:
            continue
        if isinstance(node, ast.Import):
            for name in node.names:
                yield name.name, id(node) in top
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                raise ValueError(f"line {node.lineno}: import by full name: from {inside}.x import")
            full = node.module or ""
            for name in node.names:
                yield f"{full}.{name.name}" if full == inside else full, id(node) in top


def may_use(user: str, used: str) -> bool:
    """Say whether one entry of the table may import another."""
    if user == used:
        return True
    if user in ORDER:
        return used in ORDER and ORDER[used] < ORDER[user]
    same_package = used.split(".")[0] == user.split(".")[0]
    return used in ORDER or same_package or used in EDGE_USES.get(user.split(".")[0], set())


def violations(name: str, source: str) -> list[str]:
    """List the imports of one module that the table forbids, each with the remedy."""
    if name not in ORDER and name not in EDGE:
        return [f"pfkit.{name} is not in the layer table: give it a line in tests/test_layers.py"]
    allowed = EDGE.get(name, set()) | {"numpy", "pfkit"} | sys.stdlib_module_names
    found = []
    for full, at_top in imports(source):
        first = full.split(".")[0]
        optional = not at_top and first in OPTIONAL_FRONT_ENDS.get(name, set())
        if first not in allowed and not optional:
            found.append(f"pfkit.{name} imports {first}: only {sorted(EDGE.get(name, {'numpy'}))}")
        used = ".".join(full.split(".")[1:])
        parts = used.split(".")
        entry = ".".join(parts[:2]) if ".".join(parts[:2]) in EDGE else parts[0]
        if first != "pfkit" or (not used and name in EDGE):
            continue  # the edge may use the package as a reader does: import pfkit as pf
        if not may_use(name, entry):
            found.append(f"pfkit.{name} imports pfkit.{entry or '__init__'}, which stands after it")
    return found


MODULES = sorted(p for p in PACKAGE.rglob("*.py") if p != PACKAGE / "__init__.py")


@pytest.mark.parametrize("path", MODULES, ids=lambda p: p.relative_to(PACKAGE).as_posix())
def test_module_imports_only_what_stands_before_it(path):
    assert violations(module_of(path), path.read_text(encoding="utf-8")) == []


def test_the_package_itself_re_exports_the_core_only():
    source = (PACKAGE / "__init__.py").read_text(encoding="utf-8")
    used = {name.split(".")[1] for name, _ in imports(source) if name.startswith("pfkit.")}
    assert used <= set(ORDER)


def test_the_table_names_no_module_that_is_gone():
    assert {*ORDER, *EDGE} - {"labs.grade", "labs.release"} <= {module_of(p) for p in MODULES}


@pytest.mark.parametrize(
    ("name", "source", "expected"),
    [
        ("geometry", "from pfkit.particles import Particles", "stands after it"),
        ("motion", "from pfkit.filters import run", "stands after it"),
        ("filters", "import scipy.stats", "imports scipy"),
        ("filters", "import matplotlib.pyplot as plt", "imports matplotlib"),
        ("filters", "def f():\n    import pandas", "imports pandas"),
        ("filters", "from pfkit.plotting import cloud", "stands after it"),
        ("filters", "import pfkit as pf", "stands after it"),
        ("brand_new", "import numpy", "not in the layer table"),
        ("labs", "import ipywidgets", "imports ipywidgets"),
        ("explore", "from pfkit.labs import Lab", "stands after it"),
    ],
)
def test_a_violation_is_seen(name, source, expected):
    (message,) = violations(name, source)
    assert expected in message


def test_what_the_table_allows_passes():
    assert (
        violations("filters", "import math\nimport numpy as np\nfrom pfkit.motion import x") == []
    )
    assert violations("labs", "import pfkit as pf\ndef f():\n    import ipywidgets") == []


def test_a_relative_import_is_refused():
    with pytest.raises(ValueError, match="full name"):
        list(imports("from . import errors"))
