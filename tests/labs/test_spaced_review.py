"""Reviews: equal gaps, few at a time, other numbers each time, silent where nothing is due."""

import datetime
import json
import os

import pytest

from pfkit import labs
from pfkit.labs import resampling, spaced_review
from pfkit.labs.spaced_review import GAP, SITTING, TIMES, due, judged, problem, reviewable

LAB = resampling.LAB
TODAY = datetime.date(2027, 3, 1)
ITEM = reviewable(LAB)[0]


def ago(days):
    return (TODAY - datetime.timedelta(days=days)).isoformat()


@pytest.fixture
def folder(tmp_path):
    """A folder with saved answers to all that can come back, a week old."""
    entry = {"source": "0", "version": "x"}
    answers = {i: entry for i in reviewable(LAB)} | {next(iter(LAB.items)): entry}
    data = {"schema": 1, "lab": "resampling", "answers": answers, "predictions": {}}
    file = tmp_path / "resampling_answers.json"
    file.write_text(json.dumps(data))
    then = datetime.datetime.fromisoformat(ago(GAP) + "T12:00").timestamp()
    os.utime(file, (then, then))
    return tmp_path


def say(folder, capsys, *args, today=TODAY, **options):
    labs.review(*args, folder=folder, today=today, **options)
    return capsys.readouterr().out


def test_due_after_the_same_gap_each_time_and_three_at_most():
    items = {f"a/{k}": {"day": ago(GAP + k), "times": 0} for k in range(-2, 6)}
    assert due(items, TODAY) == ["a/5", "a/4", "a/3"] and SITTING == 3
    items = {"a/x": {"day": ago(GAP - 1), "times": 0}, "a/y": {"day": ago(99), "times": TIMES}}
    assert due(items, TODAY) == []


def test_every_review_has_other_numbers_and_a_right_answer():
    keys = set()
    for times in range(TIMES):
        mine = problem(LAB, ITEM, times)
        assert judged(mine, mine.key)[0]
        assert not judged(mine, mine.misconceptions[0].example)[0]
        assert mine.misconceptions[0].words in judged(mine, mine.misconceptions[0].example)[1]
        keys.add(str(mine.key))
    assert len(keys) > 1


def test_numbers_typed_in_one_line_are_read():
    mine = problem(LAB, ITEM, 0)
    typed = ", ".join(map(str, mine.key)) if isinstance(mine.key, tuple) else str(mine.key)
    assert judged(mine, typed)[0]


def test_what_was_answered_a_week_ago_is_asked_answered_and_comes_back(folder, capsys):
    told = say(folder, capsys)
    name = f"resampling/{ITEM}"
    assert f"{name}: {problem(LAB, ITEM, 0).asked()}" in told
    assert next(iter(LAB.items)) + ":" not in told, "what has no numbers does not come back"
    assert "right" not in say(folder, capsys, name, -7.0)
    assert name in say(folder, capsys), "a wrong answer may be tried again"
    assert f"right. It comes back in {GAP} days" in say(
        folder, capsys, name, problem(LAB, ITEM, 0).key
    )
    assert name not in say(folder, capsys)
    later = TODAY + datetime.timedelta(days=GAP)
    assert problem(LAB, ITEM, 1).asked() in say(folder, capsys, today=later)


def test_it_can_be_switched_off_and_on(folder, capsys):
    say(folder, capsys, off=True)
    assert say(folder, capsys) == "Reviews are off.\n"
    say(folder, capsys, off=False)
    assert ITEM in say(folder, capsys)


def test_without_answers_and_with_a_damaged_file_it_says_so(tmp_path, capsys):
    assert say(tmp_path, capsys) == "Reviews are done.\n"
    (tmp_path / spaced_review.FILE).write_text("{")
    told = say(tmp_path, capsys)
    assert "could not read review.json" in told and list(tmp_path.glob("*.damaged-1"))
    assert "no problem under review" in say(tmp_path, capsys, "a/b", 1)
