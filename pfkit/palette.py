"""One name, one meaning, one colour: for figures, explorables and the page.

Each named thing has a colour on a light and one on a dark ground. `pfkit.plotting` draws the book's
figures with the light ones, `pfkit.explore` its stills, and `script` hands both to the renderer in
the page, so that no colour is written twice.

Against its ground every colour has a contrast of at least 3:1, and those in `READABLE` of at least
4.5:1: only these are used for words. A meaning never rests on colour alone; `pfkit.plotting` lists
the shape that goes with each.

The first seven colours are those of Okabe and Ito or near them, told apart by colour-blind readers.

Source: Okabe and Ito, Color Universal Design (2008); contrast as in WCAG 2.1, success criteria
1.4.3 and 1.4.11.
"""

from __future__ import annotations

import json

COLOURS: dict[str, tuple[str, str]] = {  # on a light ground, on a dark one
    "truth": ("#000000", "#ffffff"),
    "estimate": ("#0072B2", "#5db5f0"),
    "dead reckoning": ("#D55E00", "#ff9152"),
    "particles": ("#6b6b6b", "#b4b9bf"),
    "landmarks": ("#009E73", "#3fd0a3"),
    "exact": ("#9467BD", "#c5a5ea"),
    "measurement": ("#B87800", "#e3b341"),
    "false reading": ("#b91c1c", "#ff8a8a"),
    "particle 1": ("#2563a8", "#7db4f5"),
    "particle 2": ("#b45309", "#ffb65c"),
    "particle 3": ("#15803d", "#63d68c"),
    "particle 4": ("#9d3a8f", "#f0a0e2"),
    "particle 5": ("#64717f", "#a7b3c0"),
    "wall": ("#64717f", "#8493a3"),
    "ink": ("#1d2733", "#eef2f6"),
    "muted": ("#5b6775", "#a7b3c0"),
    "grid": ("#cfd6de", "#3a4653"),  # frames and rulings, which carry no meaning
    "paper": ("#fbfcfd", "#12181f"),
}
READABLE = ("ink", "muted", "particle 1", "particle 2", "particle 3", "particle 4", "particle 5")


def script() -> str:
    """The palette as a classic script, for the page and for Jupyter: it sets ``PF.palette``."""
    light, dark = ({name: pair[k] for name, pair in COLOURS.items()} for k in (0, 1))
    data = json.dumps({"styles": list(COLOURS), "light": light, "dark": dark})
    return f"(globalThis.PF = globalThis.PF || {{}}).palette = {data};\n"
