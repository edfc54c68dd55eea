"""What a check says: the message first, one line per property, one hint.

Plain text is the primary form. The HTML form says the same words, with ``role="status"`` so that
a screen reader announces them; nothing is told by colour.
"""

from dataclasses import dataclass
from html import escape

STATUSES = (
    "passed", "partial", "wrong", "unanswered", "recorded", "predicted", "locked", "unknown",
)  # fmt: skip


@dataclass(frozen=True)
class Line:
    """One property: what it says, whether it holds, what happened instead."""

    says: str
    ok: bool
    detail: str = ""

    def __str__(self) -> str:
        tail = f" -- {self.detail}" if self.detail and not self.ok else ""
        return f"  [{'ok' if self.ok else 'no'}] {self.says}{tail}"


@dataclass(frozen=True, repr=False)
class Verdict:
    """The answer of `Lab.check`. Its text is what the student reads.

    Parameters
    ----------
    item : str
        Which item was checked.
    status : str
        One of `STATUSES`.
    score, max_score : float
        Points earned and points possible (points marked by hand are not in ``score``).
    message : str
        What to say after the status, where lines would be too much.
    lines : tuple of Line
    hint : str
        At most one.
    misconception : str
        The name of the misconception that the hint belongs to, for tests and statistics.
    """

    item: str
    status: str
    score: float = 0.0
    max_score: float = 0.0
    message: str = ""
    lines: tuple[Line, ...] = ()
    hint: str = ""
    misconception: str = ""

    @property
    def headline(self) -> str:
        count = f" {sum(x.ok for x in self.lines)}/{len(self.lines)}" if self.lines else ""
        tail = f": {self.message}" if self.message else ""
        return f"{self.item}: {self.status}{count}{tail}"

    def __repr__(self) -> str:
        parts = [self.headline, *map(str, self.lines)]
        return "\n".join(parts + ([self.hint] if self.hint else []))

    __str__ = __repr__

    def _repr_html_(self) -> str:
        rows = "".join(f"<li>{escape(str(x).strip())}</li>" for x in self.lines)
        hint = f"<p>{escape(self.hint)}</p>" if self.hint else ""
        return (
            '<div role="status" class="pfkit-verdict">'
            f"<p><strong>{escape(self.headline)}</strong></p>"
            + (f"<ul>{rows}</ul>" if rows else "")
            + hint
            + "</div>"
        )
