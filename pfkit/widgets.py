"""Explorables in Jupyter: the same scenes as in the book's page, computed by the kernel.

    import pfkit.widgets as widgets
    widgets.explore("drive", panel="kidnap", seed=3)

The front end is the very JavaScript of the page (`pfkit/explore/web`); only the engine differs. A
widget cannot be stored in a notebook: what is stored of such a cell is one line of text, which also
appears where no front end is listening. With the environment variable ``PFKIT_WIDGETS=off``, which
the tool that executes the course's notebooks sets, no widget is made at all.

In a chapter, write the directive ``explorable`` in a markdown cell (book/_ext/live_page.py tells
how), and after it a code cell with `explore` and the tag ``remove-cell``: the book shows the
directive, Jupyter runs the cell.
"""

from __future__ import annotations

import json
import os
from importlib.resources import files
from typing import Any

from pfkit import palette
from pfkit.explore import FRONT_END, operations, scene
from pfkit.explore.host import Host

GLUE = """
export default {
  render({ model, el }) {
    const waiting = new Map();
    let next = 1;
    const answered = (message, buffers) => {
      const wait = waiting.get(message.id);
      waiting.delete(message.id);
      if (!wait) return;
      if (message.error) return wait.reject(new Error(message.error));
      const b = buffers && buffers[0];
      const drawing = b
        ? new Float32Array(b.buffer.slice(b.byteOffset, b.byteOffset + b.byteLength)) : null;
      wait.resolve({ drawing, report: message.report, ms: message.ms });
    };
    model.on("msg:custom", answered);
    const ask = (content) => new Promise((resolve, reject) => {
      const id = next++;
      waiting.set(id, { resolve, reject });
      model.send({ id, ...content });
    });
    const engine = async () => ({
      open: (key, name, panel, seed) => ask({ ask: "open", seed }),
      run: (key, operations) => ask({ ask: "run", operations }),
      many: (key, ticks, again) => ask({ ask: "many", ticks, again }),
    });
    const root = document.createElement("div");
    root.setAttribute("role", "group");
    root.setAttribute("aria-label", model.get("about").title);
    el.append(root);
    const about = model.get("about");
    const explorable = new PF.Explorable(root, {
      about, seed: about.seed, values: model.get("start"), recording: null, engine, link: false,
    });
    root.pfExplorable = explorable;
    // Keys pressed in our controls are ours, not JupyterLab's; it asks the element itself.
    for (const e of root.querySelectorAll("input, button, select, canvas")) {
      e.setAttribute("data-lm-suppress-shortcuts", "true");
    }
    explorable.touch(0);
    return () => {
      model.off("msg:custom", answered);
      explorable.destroy();
    };
  },
};
"""


class Told:
    """What stands for an explorable where nothing can move: one line of text."""

    def __init__(self, name: str, panel: str, seed: int, title: str):
        self.text = f"Explorable {name!r}, panel {panel!r}, seed {seed}: {title}"

    def __repr__(self) -> str:
        return self.text


def explore(name: str, panel: str | None = None, seed: int = 1) -> Any:
    """Show the explorable `name` under this cell.

    Parameters
    ----------
    name : str
        One of `pfkit.explore.SCENES`, such as "drive", "comb", "proposal", "corridor", "banana".
    panel : str, optional
        One of the scene's panels; its first if left out.
    seed : int
        Seed of the run: the same seed gives the same run, here and in the page.

    Returns
    -------
    A widget, or a line of text where ipywidgets and anywidget are missing or switched off.
    """
    about = scene(name, panel, seed).describe()
    told = Told(name, about["panel"], seed, about["title"])
    if os.environ.get("PFKIT_WIDGETS") == "off":
        return told
    try:
        return _widget_class()(name, about, str(told))
    except ImportError:
        print("pip install 'pfkit[widgets]' to move this explorable in Jupyter")
        return told


def _front_end() -> tuple[str, str]:
    """Script and style of the widget: the page's own files, and the glue to the kernel."""
    web = files("pfkit.explore") / "web"
    scripts = [(web / name).read_text(encoding="utf-8") for name in FRONT_END]
    style = (web / "explorable.css").read_text(encoding="utf-8")
    return "\n".join([palette.script(), operations.script(), *scripts, GLUE]), style


def _widget_class() -> Any:
    """The widget class, made when first needed, so that this module imports without anywidget."""
    import time

    import anywidget
    import traitlets

    script, style = _front_end()

    class Explorer(anywidget.AnyWidget):
        """One scene; the kernel computes, the front end draws."""

        _esm = script
        _css = style
        about = traitlets.Dict().tag(sync=True)
        start = traitlets.Dict().tag(sync=True)

        def __init__(self, name: str, about: dict[str, Any], told: str):
            self.host, self.name, self.told = Host(), name, told
            self.host.open("k", name, about["panel"], about["seed"])
            super().__init__(about=about, start=dict(self.host.runs["k"].worlds[0].values))
            self.on_msg(self._answer)

        def _answer(self, _: Any, message: dict[str, Any], __: Any) -> None:
            answer: dict[str, Any] = {"id": message.get("id")}
            buffers: list[memoryview] = []
            began = time.perf_counter()
            try:
                if message.get("ask") == "open":
                    self.host.open("k", self.name, self.about["panel"], message["seed"])
                else:
                    drawing, report = self._asked(message)
                    buffers = [memoryview(drawing)]
                    answer["report"] = json.loads(report)
            except Exception as problem:
                answer["error"] = f"{type(problem).__name__}: {problem}"
            answer["ms"] = 1000 * (time.perf_counter() - began)
            self.send(answer, buffers)

        def _asked(self, message: dict[str, Any]) -> tuple[Any, str]:
            if message.get("ask") == "many":
                return self.host.many("k", message["ticks"], message["again"])
            return self.host.do("k", json.dumps(message["operations"]))

        def _repr_mimebundle_(self, **kwargs: Any) -> Any:
            bundle = super()._repr_mimebundle_(**kwargs)
            data = bundle[0] if isinstance(bundle, tuple) else bundle
            if data:
                data["text/plain"] = self.told
            return bundle

    return Explorer
