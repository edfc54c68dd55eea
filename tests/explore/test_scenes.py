"""Every scene keeps the promises of the protocol, whatever it shows."""

from __future__ import annotations

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from pfkit.errors import ParameterError
from pfkit.explore import SCENES, scene
from pfkit.explore.host import Host
from pfkit.explore.operations import OPERATIONS
from pfkit.explore.pen import Pen, handles, records, words
from pfkit.explore.record import record, to_script
from pfkit.explore.scene import MOST_CONTROLS
from pfkit.explore.still import Still, to_svg

ROOT = Path(__file__).parents[2]
PANELS = [(name, panel) for name in SCENES for panel in type(scene(name)).panels]
LARGEST_RUN = 150_000  # bytes


def run(name, panel, seed=5, steps=40):
    s = scene(name, panel, seed)
    for _ in range(steps):
        s.step()
    return s


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_same_seed_same_history(name, panel):
    (a, told), (b, again) = (run(name, panel).frame() for _ in range(2))
    assert np.array_equal(a, b, equal_nan=True) and told == again
    assert not np.array_equal(a, run(name, panel, seed=6).frame()[0], equal_nan=True)


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_reset_forgets_everything(name, panel):
    s = run(name, panel)
    s.reset(5)
    for _ in range(40):
        s.step()
    assert np.array_equal(s.frame()[0], run(name, panel).frame()[0], equal_nan=True)


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_drawing_is_float32_and_made_of_known_records(name, panel):
    drawing, readouts = run(name, panel).frame()
    assert drawing.dtype == np.float32 and drawing.ndim == 1
    assert {op for op, _, _ in records(drawing)} <= {o.name for o in OPERATIONS}
    assert sum(3 + n.size for _, _, n in records(drawing)) == drawing.size
    assert readouts and all(isinstance(v, str | float) for v in readouts.values())


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_every_number_says_how_it_is_written(name, panel):
    s = run(name, panel)
    for control in ("outliers", "defence"):  # they add readouts
        if control in s.by_name:
            s.set(control, 30 if control == "outliers" else "gate")
    numbers = {k for k, v in s.readouts().items() if isinstance(v, float)}
    about = s.describe()
    assert numbers <= set(about["units"]) == set(about["decimals"])


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_what_can_be_held_is_in_its_view_and_takes_every_touch(name, panel):
    s = run(name, panel)
    drawing, _ = s.frame()
    names = []
    for op, _, d in records(drawing):
        if op == "view":
            x0, x1, y0, y1 = d[4:8]
        if op == "handle":
            names.append(words(d[3:]))
            assert x0 <= d[0] <= x1 and y0 <= d[1] <= y1, names[-1]
    assert len(set(names)) == len(names)
    for handle in names:
        for touch, reach in (("press", 0.0), ("drag", 0.2), ("release", 0.2), ("tap", 0.0)):
            x, y = handles(drawing)[handle]
            s.hold(handle, x + reach, y + reach, touch)
            s.step()
        s.hold(handle, x, y, "press")
        s.hold(handle, x, y, "cancel")
    with pytest.raises(ParameterError, match="that can be held"):
        s.hold("moon", 0.0, 0.0, "press")
    with pytest.raises(ParameterError, match="give one of"):
        s.hold("", 0.0, 0.0, "poke")


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_every_control_of_a_panel_can_be_moved_to_its_ends(name, panel):
    s = scene(name, panel, 2)
    for control in (s.by_name[n] for n in (*s.panel.controls, *s.panel.more)):
        ends = {
            "range": [control.lo, min(control.hi, 2000), control.default],
            "choice": [key for key, _ in control.choices],
            "toggle": [not control.default, control.default],
            "button": [True],
        }[control.kind]
        for value in ends:
            s.set(control.name, value)
            for _ in range(13):
                s.step()
            s.frame()


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_has_three_missions_an_alt_text_and_help(name, panel):
    s = scene(name, panel)
    film = not s.panel.controls  # a film is only looked at
    assert len(s.panel.missions) == (0 if film else 3) and len(s.panel.alt) > 60
    names = (*s.panel.controls, *s.panel.more)
    assert len(s.panel.controls) <= MOST_CONTROLS and len(set(names)) == len(names)
    assert all(s.by_name[n].label and s.by_name[n].help for n in names)
    json.dumps(s.describe(), allow_nan=False)


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_recorded_run_is_small_and_shows_the_live_run(name, panel):
    s = scene(name, panel, 3)
    recording = record(s)
    assert len(to_script(recording, "x")) < LARGEST_RUN
    ticks = [frame[2] for frame in recording["frames"]]
    assert ticks[0] == 0 and ticks[-1] <= s.record_steps
    live = run(name, panel, seed=3, steps=ticks[-1]).readouts()
    for key, value in recording["frames"][-1][3].items():
        if not isinstance(value, str):
            assert value == pytest.approx(live[key], rel=1e-3, abs=1e-3)


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_still_is_an_svg(name, panel):
    s = run(name, panel)
    svg = to_svg(s.frame()[0], s.size, "a < b")
    assert ElementTree.fromstring(svg).tag.endswith("svg") and "nan" not in svg
    assert len(svg) < 120_000


@pytest.mark.parametrize(
    ("value", "why"),
    [(float("nan"), "finite"), ("5", "finite"), (True, "finite"), (None, "finite")],
)
def test_a_control_refuses_what_is_not_its_kind(value, why):
    with pytest.raises(ParameterError, match=why):
        scene("comb").set("n", value)


def test_a_control_clips_and_names_its_choices():
    s = scene("comb")
    s.set("n", 1e9)
    assert s.values["n"] == 20
    with pytest.raises(ParameterError, match="choose one of"):
        s.set("weights", "<script>")
    with pytest.raises(ParameterError, match="no control"):
        s.set("__class__", 1)
    with pytest.raises(ParameterError, match="whole number"):
        s.reset(-1)
    with pytest.raises(ParameterError, match="no panel"):
        scene("drive", "nowhere")
    with pytest.raises(ParameterError, match="no explorable"):
        scene("os.system")


def test_host_applies_operations_in_order_and_reports():
    host = Host()
    about = json.loads(host.open("k", "comb", None, 7))
    assert about["name"] == "comb" and about["seed"] == 7
    drawing, told = host.do("k", '[["set", "n", 8], ["step", 3]]')
    told = json.loads(told)
    assert told["ticks"] == 3 and told["values"]["n"] == 8 and drawing.dtype == np.float32
    for bad in (
        '[["eval", "1"]]',
        '[["step", -1]]',
        '[["phase", 1e9]]',
        '["step"]',
        '[["other", 1]]',
    ):
        with pytest.raises(ParameterError):
            host.do("k", bad)


# ---- phases -----------------------------------------------------------------------------------


def phase_ends(s, ticks):
    """(tick, phase) of each phase that ends in so many ticks, and the sentences."""
    ends, told = [], []
    while s.ticks < ticks:
        if s.to_phase(1):
            ends.append((s.ticks, s.phase))
            told.append(s.sentence)
    return ends, told


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_phases_are_told_in_sentences_with_numbers(name, panel):
    s = scene(name, panel, 2)
    ends, told = phase_ends(s, int(max(3, s.rate)))
    if s.panel.controls:  # the phases of a film are its chapters
        assert {phase for _, phase in ends} == set(s.phases())
    assert all(w.endswith(".") and len(w) < 160 for w in told)
    assert told and sum(bool(re.search(r"\d", w)) for w in told) > 0.6 * len(told)


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_phase_by_phase_is_the_same_run(name, panel):
    whole, parts = run(name, panel), scene(name, panel, 5)
    phase_ends(parts, 40)
    assert np.array_equal(whole.frame()[0], parts.frame()[0], equal_nan=True)
    assert whole.ended >= parts.ended > 0  # a phase of the tick that has begun may be missing


@pytest.mark.parametrize(("name", "panel"), PANELS)
def test_phases_end_in_the_same_ticks_whatever_the_controls_are(name, panel):
    plain, _ = phase_ends(scene(name, panel, 2), 30)
    for control in scene(name, panel).panel.controls:
        s = scene(name, panel, 2)
        spec = s.by_name[control]
        if spec.kind == "button" or (name, control) == ("corridor", "auto"):
            continue
        value = {"range": spec.lo, "toggle": not s.values[control]}.get(spec.kind)
        s.set(control, value if spec.kind != "choice" else spec.choices[-1][0])
        assert phase_ends(s, 30)[0] == plain, control


def test_pen_broadcasts():
    pen = Pen()
    pen.segments("ink", 0, 0, [1, 2], 3)
    ((op, style, numbers),) = records(pen.array())
    assert (op, style) == ("segments", "ink")
    assert numbers.tolist() == [1.5, 0, 0, 0, 0, 1, 2, 3, 3]


def test_each_operation_is_drawn_in_the_page_and_in_a_still():
    script = (ROOT / "pfkit/explore/web/render.js").read_text(encoding="utf-8")
    for operation in OPERATIONS[1:]:  # a view sets the scale and draws nothing
        assert re.search(rf"^    {operation.name}\([d\[]", script, re.M), operation.name
        assert hasattr(Still, operation.name)
