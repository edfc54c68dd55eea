"""What a student has earned, and how well sureness matched what happened."""

from collections.abc import Sequence
from html import escape
from typing import Any, NamedTuple

from pfkit.labs import calibration


class Tally(NamedTuple):
    """A question, and the entries of its items in `Lab.report`."""

    title: str
    items: Sequence[dict[str, Any]]

    @property
    def points(self) -> tuple[float, float]:
        """Earned and possible."""
        return sum(r["score"] for r in self.items), sum(r["max"] for r in self.items)

    @property
    def note(self) -> str:
        waiting = sum(r["status"] == "recorded" for r in self.items)
        return f"{waiting} waiting for marking by hand" if waiting else ""


def _of(earned: float, possible: float) -> str:
    return f"{round(earned, 2):g} of {possible:g}"


class Summary:
    """What `Lab.summary` shows: text first, the same in HTML with the plot.

    Parameters
    ----------
    title : str
    tallies : sequence of Tally
        One per question.
    guesses : sequence of (item, sure in per cent or None, right?)
        Predictions whose experiment was checked.
    """

    def __init__(
        self,
        title: str,
        tallies: Sequence[Tally],
        guesses: Sequence[tuple[str, float | None, bool]],
    ) -> None:
        self._title, self._guesses = title, guesses
        earned, possible = (
            sum(column) for column in zip(*(t.points for t in tallies), strict=True)
        )
        self._rows = [(t.title, _of(*t.points), t.note) for t in tallies]
        self._rows.append(("Total", _of(earned, possible), ""))
        self._sure = [(sure, right) for _, sure, right in guesses if sure is not None]

    @property
    def _told(self) -> list[str]:
        if not self._guesses:
            return ["Predictions: none tested yet."]
        right, n = sum(r for _, _, r in self._guesses), len(self._guesses)
        lines = [f"Predictions: {right} of {n} right."]
        for s, share, k in calibration.table(self._sure):
            lines.append(f"  when {s:.0f} % sure: {100 * share:.0f} % right ({k})")
        if self._sure:
            score = calibration.brier(self._sure)
            lines.append(f"  Brier score {score:.3f} (0 perfect, 0.25 a coin)")
        return lines

    def __repr__(self) -> str:
        width = max(len(a) for a, _, _ in self._rows)
        rows = [f"{a:<{width}}  {b}  {c}".rstrip() for a, b, c in self._rows]
        return "\n".join([self._title, *rows, *self._told])

    def _repr_html_(self) -> str:
        rows = "".join(
            f'<tr><th scope="row">{escape(a)}</th><td>{escape(b)}</td><td>{escape(c)}</td></tr>'
            for a, b, c in self._rows
        )
        told = "".join(f"<p>{escape(x)}</p>" for x in self._told)
        plot = calibration.svg(self._sure) if self._sure else ""
        return (
            f'<div role="status" class="pfkit-summary"><table><caption>{escape(self._title)}'
            f"</caption>{rows}</table>{told}{plot}</div>"
        )
