"""One name, one meaning, one colour: in figures, stills and the page, readable in both themes."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from pfkit import palette, plotting
from pfkit.explore import SCENES, scene
from pfkit.explore.pen import STYLES, records

ROOT = Path(__file__).resolve().parents[2]
DRAWN = [*(ROOT / "pfkit" / "explore").glob("*.py"), *(ROOT / "pfkit/explore/web").glob("*.js")]
PANELS = [(name, panel) for name in SCENES for panel in type(scene(name)).panels]
DECORATION = {"grid", "paper"}


def luminance(colour: str) -> float:
    """Relative luminance of "#rrggbb" (WCAG 2.1)."""
    channels = (int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5))
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: str, b: str) -> float:
    dark, light = sorted((luminance(a), luminance(b)))
    return (light + 0.05) / (dark + 0.05)


def test_contrast_is_that_of_the_standard():
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("theme", [0, 1])
@pytest.mark.parametrize("name", [n for n in palette.COLOURS if n not in DECORATION])
def test_every_colour_stands_out_in_both_themes(name, theme):
    ratio = contrast(palette.COLOURS[name][theme], palette.COLOURS["paper"][theme])
    assert ratio >= (4.5 if name in palette.READABLE else 3.0)


def test_figures_and_explorables_name_the_same_colours():
    named = {
        "truth": plotting.TRUTH,
        "estimate": plotting.ESTIMATE,
        "dead reckoning": plotting.DEAD_RECKONING,
        "particles": plotting.PARTICLES,
        "landmarks": plotting.LANDMARKS,
        "exact": plotting.EXACT,
        "measurement": plotting.MEASUREMENT,
    }
    assert named == {name: palette.COLOURS[name][0] for name in named}
    assert tuple(palette.COLOURS) == STYLES


@pytest.mark.parametrize("path", [*DRAWN, ROOT / "pfkit" / "plotting.py"], ids=lambda p: p.name)
def test_no_colour_is_written_twice(path):
    assert not re.findall(r"#[0-9a-fA-F]{6}\b", path.read_text(encoding="utf-8"))


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_words_are_readable_and_shapes_are_those_of_the_figures(name, panel):
    s = scene(name, panel, 3)
    for _ in range(26):
        s.step()
    for op, style, numbers in records(s.frame()[0]):
        if op in ("text", "ticks"):
            # digits in the colour of the paper stand on the five particles of the comb
            assert style in palette.READABLE or (style == "paper" and name == "comb")
        if op == "robots":
            assert bool(numbers[1]) == (style != "truth")
        if style == "landmarks":
            assert op in ("symbols", "ellipses") or name in ("corridor", "kalman")


def test_every_style_is_used():
    used = set()
    for path in (ROOT / "pfkit" / "explore").glob("*.py"):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        used |= {n.value for n in ast.walk(tree) if isinstance(n, ast.Constant)}
    assert {s for s in STYLES if s not in used and not s.startswith("particle ")} == set()
