"""The widget's side in the kernel: it answers as the page's engine does, or says one line."""

import json
import sys

import numpy as np
import pytest

from pfkit import widgets
from pfkit.explore.host import Host


@pytest.fixture
def comb(monkeypatch):
    """An explorable, and the list of what it sends to its front end."""
    pytest.importorskip("anywidget")
    monkeypatch.delenv("PFKIT_WIDGETS", raising=False)
    widget = widgets.explore("comb", seed=7)
    sent = []
    monkeypatch.setattr(widget, "send", lambda content, buffers: sent.append((content, buffers)))
    return widget, sent


def test_switched_off_it_is_one_line(monkeypatch):
    monkeypatch.setenv("PFKIT_WIDGETS", "off")
    told = widgets.explore("comb", seed=7)
    assert repr(told).startswith("Explorable 'comb', panel ") and "seed 7" in repr(told)


def test_without_anywidget_it_says_what_to_install(monkeypatch, capsys):
    monkeypatch.delenv("PFKIT_WIDGETS", raising=False)
    monkeypatch.setitem(sys.modules, "anywidget", None)  # importing it fails
    told = widgets.explore("comb")
    assert isinstance(told, widgets.Told) and "pip install" in capsys.readouterr().out


def test_it_computes_what_the_page_computes(comb):
    widget, sent = comb
    operations = [["reset", 3], ["step", 4]]
    widget._answer(None, {"id": 1, "ask": "open", "seed": 3}, None)
    widget._answer(None, {"id": 2, "ask": "run", "operations": operations}, None)
    (opened, no_buffers), (answer, buffers) = sent
    assert opened["id"] == 1 and "error" not in opened and no_buffers == []
    page = Host()
    page.open("k", "comb", widget.about["panel"], 3)
    drawing, report = page.do("k", json.dumps(operations))
    assert answer["id"] == 2 and answer["report"] == json.loads(report) and answer["ms"] >= 0
    np.testing.assert_array_equal(np.frombuffer(buffers[0], np.float32), drawing)


def test_a_mistake_is_answered_with_its_name(comb):
    widget, sent = comb
    widget._answer(None, {"id": 5, "ask": "run", "operations": [["dance", 1]]}, None)
    ((answer, buffers),) = sent
    assert answer["id"] == 5 and buffers == []
    assert answer["error"].startswith("ParameterError: operation ['dance', 1]")


def test_what_is_stored_of_it_is_one_line(comb):
    widget, _ = comb
    bundle = widget._repr_mimebundle_()
    data = bundle[0] if isinstance(bundle, tuple) else bundle
    assert data["text/plain"].startswith("Explorable 'comb'")


def test_its_front_end_is_that_of_the_page(comb):
    script, style = comb[0]._esm, comb[0]._css
    assert widgets.GLUE in str(script) and "PF.Explorable" in str(script) and str(style).strip()
