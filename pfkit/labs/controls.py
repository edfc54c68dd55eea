"""Radio buttons for choices and predictions, where a front end can show them.

`offer` is called when a choice is still unanswered. It shows controls only if the cell was run by
a person in a front end: JupyterLab, Notebook 7 and VS Code send the id of the cell with each
request, programs that execute notebooks (nbclient, nbval, the grader) do not. So a stored notebook
of the course never holds a widget that nothing drives; one that a student saved shows a sentence
where no kernel runs (GitHub, nbviewer). Plain calls always work. ``PFKIT_WIDGETS=off`` switches
controls off, as it does for explorables.

With the keyboard: Tab from option to option, Space to choose, Tab and Space for the button
(tried in JupyterLab, which keeps the arrow keys for itself).
"""

from __future__ import annotations

import os
from html import escape
from typing import Any, Protocol

from pfkit.labs.executed import shell
from pfkit.labs.items import Choice, Item, Prediction
from pfkit.labs.verdict import Verdict


class Checker(Protocol):
    """What the controls need of a lab: the verb they press."""

    def check(self, item_id: str, answer: Any) -> Verdict: ...


def front_end_present() -> bool:
    """Did a person's front end send the request that is running now?"""
    kernel = getattr(shell(), "kernel", None)
    if kernel is None:
        return False
    try:
        return bool(kernel.get_parent("shell").get("metadata", {}).get("cellId"))
    except Exception:  # a kernel without that method is no front end we know
        return False


def offer(lab: Checker, item: Item) -> bool:
    """Show controls for a choice or a prediction; False where that is not possible."""
    off = os.environ.get("PFKIT_WIDGETS") == "off"
    if off or not isinstance(item, Choice | Prediction) or not front_end_present():
        return False
    try:
        import ipywidgets
        from IPython.display import display
    except ImportError:
        return False
    bundle = build(lab, item, ipywidgets)._repr_mimebundle_()
    words = f"(a control of a running kernel; without it write {item.id} = ... in the cell above)"
    display({**bundle, "text/plain": words}, raw=True)
    return True


def _number(text: str) -> float | str | None:
    """What was typed into the field: a number, nothing yet, or a text that the lab refuses."""
    try:
        value = float(text.strip(" %")) if text.strip(" %") else None
        return int(value) if value is not None and value.is_integer() else value
    except ValueError:
        return text


def build(lab: Checker, item: Choice | Prediction, widgets: Any) -> Any:
    """The control: one radio button per option, a field for sureness, a button, the verdict."""
    radio = widgets.RadioButtons(
        options=[(f"({k}) {text}", k) for k, text in item.options.items()],
        value=None,
        layout=widgets.Layout(width="max-content"),
    )
    is_guess = isinstance(item, Prediction)
    sure = widgets.Text(placeholder="0 to 100", description="sure, %")
    button = widgets.Button(description="Lock" if is_guess else "Check")
    told = widgets.HTML()

    def press(_: Any) -> None:
        given = (radio.value, _number(sure.value)) if is_guess else radio.value
        verdict = lab.check(item.id, given if radio.value else ...)
        hand_in = f"To hand it in, write {item.id} = {given!r} in the cell above."
        done = radio.value and (verdict.status == "predicted" or not is_guess)
        told.value = verdict._repr_html_() + (f"<p>{escape(hand_in)}</p>" if done else "")

    button.on_click(press)
    parts = [radio, sure, button, told] if is_guess else [radio, button, told]
    return widgets.VBox(parts)
