"""Worlds of one's own: other numbers for other students, the same difficulty for all."""

import numpy as np
import pytest

from pfkit.labs import Choice, Lab, Numeric, Prediction, Question
from pfkit.labs.catalogue import all_labs

LABS = all_labs()
DRAWN = [
    (name, item)
    for name, lab in LABS.items()
    for item in lab.items.values()
    if isinstance(item, Numeric) and item.draw
]


def name(value):
    return getattr(value, "id", None) or str(value)


@pytest.fixture
def lab():
    n = Numeric(
        """Chance that {n} particles miss one of {rooms} rooms
        h1
        h2
        (1 - 1/{rooms})^{n}""",
        lambda n, rooms: (1 - 1 / rooms) ** n,
        id="n",
        tol=0.002,
        world={"n": 4, "rooms": 4},
        draw=lambda rng: {"n": int(rng.integers(3, 8)), "rooms": int(rng.integers(3, 7))},
    )
    n.wrong("""complement: is the chance that it is not empty
        with {n} particles
        h2
        h3""")(lambda n, rooms: 1 - (1 - 1 / rooms) ** n)
    c = Choice(
        """Pick
        a  one
           = No one.
        b* two
           = Yes, two.
        c  three
           = No three.""",
        id="c",
    )
    p = Prediction(
        """Guess
        a  one
        b* two
        c  three""",
        id="p",
    )
    return Lab("mine", "Mine", [Question("Q", "q", [n, c, p])])


def test_two_students_differ_and_one_student_does_not(lab):
    seen = {}
    for who in ("jo", "kim", "lee", "ann", "JO "):
        lab.student(who)
        seen[who] = (
            lab.items["n"].key,
            lab.items["n"].title,
            tuple(lab.items["c"].options.items()),
        )
    assert seen["jo"] == seen["JO "]
    assert len({seen[w] for w in ("jo", "kim", "lee", "ann")}) > 1
    lab.student("jo", term="2027-spring")
    spring = lab.items["n"].title
    lab.student("jo", term="2027-autumn")
    titles = {spring, lab.items["n"].title, seen["jo"][1]}
    assert len(titles) > 1


def test_the_public_world_comes_back(lab):
    public = lab.items["n"].key
    lab.student("jo")
    lab.student("")
    assert lab.items["n"].key == public and lab.items["n"].origin is None


def test_right_and_wrong_answers_are_those_of_the_students_world(lab):
    lab.student("kim")
    item = lab.items["n"]
    assert lab.check("n", item.key).status == "passed"
    verdict = lab.check("n", item.misconceptions[0].example)
    assert verdict.misconception == "complement" and "with" in verdict.hint
    assert "{" not in verdict.hint
    assert verdict.message == f"your question: {item.title}", "the printed numbers are others"


def test_versions_are_those_of_the_public_question(lab):
    before = {k: i.version for k, i in lab.items.items()}
    lab.student("lee")
    assert {k: i.version for k, i in lab.items.items()} == before


def test_letters_mean_what_is_printed(lab):
    """Options keep their order: a student reads them in the text and in the page."""
    printed = {k: dict(lab.items[k].options) for k in ("c", "p")}
    lab.student("kim")
    assert {k: lab.items[k].options for k in printed} == printed
    assert lab.check("c", "b").status == "passed"


def test_said_twice_it_unlocks_nothing(lab):
    """Run All runs the cell again: what was predicted stays locked."""
    lab.student("kim")
    lab.predict("p", ("a", 70))
    lab.student("kim ")
    assert "it stays (a)" in str(lab.predict("p", ("b", 70)))
    lab.student("ann")
    assert not lab.predictions, "another student starts afresh"


def test_a_saved_file_brings_the_students_world_back(lab, tmp_path):
    lab.student("kim", "spring")
    key = lab.items["n"].key
    lab.check("n", key)
    lab.save(tmp_path / "a.json")
    lab.forget()
    lab.load(tmp_path / "a.json")
    assert (lab.who, lab.term, lab.items["n"].key) == ("kim", "spring", key)
    lab.student("ann")
    lab.load(tmp_path / "a.json")
    assert lab.who == "ann", "who was named stays"


def test_asking_shows_the_students_numbers_and_options(lab, capsys):
    lab.student("ann")
    lab.ask("n")
    lab.ask("c")
    told = capsys.readouterr().out
    assert lab.items["n"].title in told and "(a)" in told and "three" in told
    lab.ask("nothing")
    assert "has no item 'nothing'" in capsys.readouterr().out


def test_every_lab_asks_something_of_ones_own():
    """Each chapter at least one number; of labs 3 and 4 all numbers."""
    assert {lab for lab, _ in DRAWN} == set(LABS)
    for lab in ("lab3", "lab4"):
        assert not [i.id for i in LABS[lab].items.values() if isinstance(i, Numeric) and not i.draw]


@pytest.mark.parametrize(("lab_name", "item"), DRAWN, ids=name)
def test_difficulty_is_the_same_in_500_worlds(lab_name, item):
    """The reference passes, every misconception is refused and named, whatever the numbers."""
    keys = set()
    for k in range(500):
        mine = item.personal(np.random.default_rng(k))
        assert mine.judge(mine.key).fraction == 1
        for mistake in mine.misconceptions:
            found = mine.judge(mistake.example)
            assert found.fraction < 1, (k, mine.title, mistake.name)
            assert found.misconception and found.misconception.name == mistake.name, (k, mine.title)
        keys.add(str(mine.key))
    assert len(keys) >= 5, "two students hardly ever get the same numbers"
