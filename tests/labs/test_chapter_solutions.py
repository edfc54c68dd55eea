"""Published solutions pass their chapter's checks, one block per item and nothing left out."""

import importlib
import json
import re
from pathlib import Path

import numpy as np
import pytest

import pfkit as pf
from pfkit.labs import target

ROOT = Path(__file__).parents[2]
SELF_CONTAINED = ("ch00", "ch01", "ch05", "ch06", "ch07", "ch10")


def chapter_functions(topic):
    """The functions that a chapter defines, for solutions that call them."""
    (path,) = (ROOT / "notebooks").glob(f"[0-9][0-9]_{topic}.ipynb")
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    code = ["".join(c["source"]) for c in cells if c["cell_type"] == "code"]
    return [c for c in code if c.startswith("def ") and "..." not in c]


@pytest.mark.parametrize("name", SELF_CONTAINED)
def test_solutions_pass(name):
    lab = importlib.import_module(f"pfkit.labs.{name}").LAB
    scope = {"np": np, "pf": pf, "target": target}
    if name == "ch01":
        n, hit, false = 10, 0.8, 0.1
        doors = np.isin(np.arange(n), (1, 2, 6))
        kernel = pf.shift_kernel(1, undershoot=0.1, overshoot=0.1)
        scope |= {"n": n, "hit": hit, "false": false, "doors": doors, "kernel": kernel}
        exec(
            next(c for c in chapter_functions("bayes_filter") if c.startswith("def drive(")), scope
        )
    text = (ROOT / "tests" / "solutions" / f"{name}.py").read_text(encoding="utf-8")
    assert re.findall(r"^# %% (\w+)$", text, flags=re.M) == list(lab.items)
    exec(text, scope)
    lab.forget()
    for item in lab.items.values():
        verdict = lab.check(item.id, scope[item.id])
        assert verdict.status in ("passed", "recorded", "predicted"), str(verdict)
    lab.forget()
