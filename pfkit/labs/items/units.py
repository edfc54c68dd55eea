"""Units that a student may write a number in, read where they are right and named where not."""

from __future__ import annotations

import math
import re
from fractions import Fraction

SCALES: dict[str, dict[str, float]] = {
    "": {"": 1.0, "%": 0.01},
    "m": {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0},
    "s": {"s": 1.0, "ms": 0.001, "min": 60.0},
    "rad": {"rad": 1.0, "deg": math.pi / 180},
    "m/s": {"m/s": 1.0, "cm/s": 0.01, "km/h": 1 / 3.6},
    "rad/s": {"rad/s": 1.0, "deg/s": math.pi / 180},
    "nat": {"nat": 1.0, "bit": math.log(2)},
    "px": {"px": 1.0},
}
WORDS = {
    "%": "per cent", "m": "metres", "cm": "centimetres", "mm": "millimetres", "km": "kilometres",
    "s": "seconds", "ms": "milliseconds", "min": "minutes", "rad": "radians", "deg": "degrees",
    "nat": "nats", "bit": "bits", "px": "pixels", "": "a number between 0 and 1",
}  # fmt: skip
SPELLED = {
    "\N{DEGREE SIGN}": "deg", "degree": "deg", "degrees": "deg", "radian": "rad", "radians": "rad",
    "metre": "m", "metres": "m", "meter": "m", "meters": "m", "nats": "nat", "bits": "bit",
    "pixel": "px", "pixels": "px", "per cent": "%", "percent": "%",
    "\N{DEGREE SIGN}/s": "deg/s", "rad s^-1": "rad/s", "m s^-1": "m/s",
}  # fmt: skip
TURN = {"rad": 2 * math.pi, "deg": 360.0}


class NotRead(ValueError):
    """Text that is no number with a unit of the question."""


def words(unit: str) -> str:
    """``metres`` of ``m``; a unit without a word of its own stays as it is."""
    return WORDS.get(unit, unit)


def scales(unit: str) -> dict[str, float]:
    """Units of the same quantity, each with its size in ``unit``."""
    for family in SCALES.values():
        if unit in family:
            return {name: size / family[unit] for name, size in family.items()}
    return {unit: 1.0}


def read(text: str, unit: str) -> float:
    """``"14 cm"`` as .14 where metres are asked, ``"1/3"`` and ``"14 %"`` as numbers.

    Raises
    ------
    NotRead
        If it is no number, or its unit is of another quantity.
    """
    found = re.fullmatch(
        r"\s*([-+]?[\d.]+(?:e[-+]?\d+)?)\s*(?:/\s*([\d.]+))?\s*([^\d\s].*?)?\s*", text, re.I
    )
    if found is None:
        raise NotRead("I got text")
    top, bottom, given = found.groups(default="")
    name = SPELLED.get(given.lower(), given)
    known = scales(unit)
    if name and name not in known:
        raise NotRead(f"I got {words(name)}")
    try:
        value = float(Fraction(top) / Fraction(bottom or "1"))
    except (ValueError, ZeroDivisionError):
        raise NotRead("I got text") from None
    return value * known.get(name, 1.0)


def another(value: float, key: float, tol: float, unit: str) -> str:
    """The unit in which ``value`` would be right although ``unit`` is asked; "" if none."""
    for name, size in scales(unit).items():
        if size != 1 and abs(value * size - key) <= tol * (1 + 1e-9):
            return name
    return ""
