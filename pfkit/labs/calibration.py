"""Were you as right as you were sure? A calibration plot, drawn as SVG by hand.

SVG from strings, because the page has no plotting library.
"""

from collections.abc import Sequence
from html import escape

BINS = ((0, 55), (55, 65), (65, 75), (75, 85), (85, 95), (95, 101))


def table(guesses: Sequence[tuple[float, bool]]) -> list[tuple[float, float, int]]:
    """Group (sure in per cent, right?) into rows (mean sureness, share right, how many)."""
    rows = []
    for low, high in BINS:
        inside = [(s, r) for s, r in guesses if low <= s < high]
        if inside:
            n = len(inside)
            rows.append((sum(s for s, _ in inside) / n, sum(r for _, r in inside) / n, n))
    return rows


def brier(guesses: Sequence[tuple[float, bool]]) -> float:
    """Mean squared distance of sureness from what happened: 0 is perfect, 0.25 is a coin."""
    return sum((s / 100 - r) ** 2 for s, r in guesses) / len(guesses)


def svg(guesses: Sequence[tuple[float, bool]], size: int = 240) -> str:
    """The plot: circles (area = number of predictions) against the diagonal of honest doubt."""
    rows, pad = table(guesses), 36
    span = size - 2 * pad

    def at(sure: float, share: float) -> tuple[float, float]:
        return pad + span * sure / 100, size - pad - span * share

    told = "; ".join(f"{s:.0f} % sure, {100 * r:.0f} % right of {n}" for s, r, n in rows)
    (x0, y0), (x1, y1) = at(0, 0), at(100, 1)
    marks = "".join(
        f'<circle cx="{at(s, r)[0]:.1f}" cy="{at(s, r)[1]:.1f}" r="{4 + 2 * n**0.5:.1f}" '
        'fill="none" stroke="currentColor" stroke-width="2"/>'
        for s, r, n in rows
    )
    words = (
        f'<text x="{size / 2}" y="{size - 8}" text-anchor="middle">how sure you were, 0 to 100 %'
        f'</text><text x="{pad}" y="{pad - 12}">share right, 0 to 100 %</text>'
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size} {size}" width="{size}" '
        f'height="{size}" role="img" font-size="12" fill="currentColor">'
        f"<title>{escape('Calibration of your predictions: ' + (told or 'none yet'))}</title>"
        f'<rect x="{pad}" y="{pad}" width="{span}" height="{span}" fill="none" '
        'stroke="currentColor"/>'
        f'<line x1="{x0}" y1="{y0}" x2="{x1}" y2="{y1}" stroke="currentColor" '
        f'stroke-dasharray="4 4"/>{marks}{words}</svg>'
    )
