"""Statistical honesty: how often would a right experiment fail, and a wrong one pass?

For every X item the decision of the check is replayed 3,000 times on draws from a pool of
independent runs of the reference, and 200 times for every mutant. Both rates are printed with
their 95 % bounds (run pytest with ``-s``) and held to the declaration.
"""

import pytest

from pfkit.labs import Experiment, lab3, lab4, replay
from pfkit.labs.replay import upper_bound

LABS = {"lab3": lab3.LAB, "lab4": lab4.LAB}
ITEMS = [(lab, i) for lab in LABS for i in LABS[lab].items.values() if isinstance(i, Experiment)]
MUTANTS = [(lab, i, m) for lab, i in ITEMS for m in i.misconceptions]
# how many independent runs are made: 3,000 where a run is cheap; films of hundreds of frames fewer
POOL = {
    "p4b": 500, "p7a": 10_000, "q1b": 250, "q5c": 20_000, "q7b": 500, "q8b": 250,
    "q9b": 500, "q10b": 250, "q11b": 250, "q12a": 500, "q13c": 250, "q14a": 500,
    "q15b": 250, "q16a": 250,
}  # fmt: skip
FRESH = {"one-call"}  # its runs are copies of each other


def name(value):
    return getattr(value, "id", None) or getattr(value, "name", None) or str(value)


@pytest.mark.parametrize(("lab", "item"), ITEMS, ids=name)
def test_a_right_experiment_is_not_failed(lab, item):
    rate = replay(item, item.reference, decisions=3_000, pool=POOL.get(item.id, 3_000))
    print(
        f"{lab} {item.id}: {rate.fails} of {rate.decisions} replays fail, "
        f"below {rate.bound:.1e} with 95 % (declared {item.false_fail:.0e}; {item.margin})"
    )
    assert rate.fails == 0, rate
    assert rate.bound <= 1e-3
    assert item.false_fail <= 1e-3


@pytest.mark.parametrize(("lab", "item", "mutant"), MUTANTS, ids=name)
def test_a_wrong_experiment_is_caught_and_named(lab, item, mutant):
    pool = max(POOL.get(item.id, 600) // 4, 4 * item.runs)
    rate = replay(item, mutant.example, 200, pool, fresh=mutant.name in FRESH)
    named = rate.misconceptions.get(mutant.name, 0) / rate.decisions
    print(
        f"{lab} {item.id} {mutant.name}: caught {rate.share:.3f}, named {named:.3f}, "
        f"missed below {upper_bound(rate.decisions - rate.fails, rate.decisions):.3f} with 95 %"
    )
    assert rate.share >= 0.95
    assert named >= 0.95


def test_upper_bound_is_the_rule_of_three():
    assert upper_bound(0, 3000) == pytest.approx(3 / 3000, rel=0.01)
    assert upper_bound(5, 100) == pytest.approx(0.1023, abs=1e-3)  # Clopper-Pearson, tables
