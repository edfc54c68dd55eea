"""The published solutions: answer cells by item, from the percent-format files."""

import re
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "solutions"


def published(lab: str) -> dict[str, str]:
    text = (FOLDER / f"{lab}.py").read_text(encoding="utf-8")
    parts = re.split(r"^# %% (\w+)\n", text, flags=re.MULTILINE)[1:]
    return dict(zip(parts[::2], (p.strip() for p in parts[1::2]), strict=True))
