"""Statistical honesty: how often would a right experiment fail, and a wrong one pass?

For every X item the decision of the check is replayed 3,000 times on draws from a pool of
independent runs of the reference, and 200 times for every wrong example. Both rates are printed
with their 95 % bounds (run pytest with ``-s``) and held to the declaration.
"""

import pytest

from pfkit.labs import Experiment, catalogue, replay
from pfkit.labs.replay import in_its_own_way, upper_bound

LABS = catalogue.all_labs()
ITEMS = [(lab, i) for lab in LABS for i in LABS[lab].items.values() if isinstance(i, Experiment)]
MISTAKES = [(lab, i, m) for lab, i in ITEMS for m in i.misconceptions]
REFUSED = [(lab, i, r) for lab, i in ITEMS for r in i.refused]
FRESH = {"one-call"}  # its runs are copies of each other


def name(value):
    names = (getattr(value, kind, None) for kind in ("id", "name", "says"))
    return next(filter(None, names), str(value))


@pytest.mark.parametrize(("lab", "item"), ITEMS, ids=name)
def test_a_right_experiment_is_not_failed(lab, item):
    right = in_its_own_way(item.reference) if item.settings else item.reference
    rate = replay(item, right)
    print(
        f"{lab} {item.id}: {rate.fails} of {rate.decisions} replays fail, "
        f"below {rate.bound:.1e} with 95 % (declared {item.false_fail:.0e}; {item.margin})"
    )
    assert rate.fails == 0, rate
    assert rate.bound <= 1e-3
    assert item.false_fail <= 1e-3 and item.margin


@pytest.mark.parametrize(("lab", "item", "mistake"), MISTAKES, ids=name)
def test_a_wrong_experiment_is_caught_and_named(lab, item, mistake):
    pool = max(min(item.pool, 600) // 4, 3 * item.runs)
    rate = replay(item, mistake.example, 200, pool, fresh=mistake.name in FRESH)
    named = rate.misconceptions.get(mistake.name, 0) / rate.decisions
    print(
        f"{lab} {item.id} {mistake.name}: caught {rate.share:.3f}, named {named:.3f}, "
        f"missed below {upper_bound(rate.decisions - rate.fails, rate.decisions):.3f} with 95 %"
    )
    assert rate.share >= 0.95
    assert named >= 0.95


@pytest.mark.parametrize(("lab", "item", "refused"), REFUSED, ids=name)
def test_a_lazy_experiment_is_refused(lab, item, refused):
    pool = max(min(item.pool, 600) // 4, 3 * item.runs)
    rate = replay(item, refused.example, 200, pool)
    print(f"{lab} {item.id} {refused.says}: refused {rate.share:.3f}")
    assert rate.share >= 0.95
    assert rate.misconceptions.get(refused.named, 0) >= 0.95 * rate.fails


def test_upper_bound_is_the_rule_of_three():
    assert upper_bound(0, 3000) == pytest.approx(3 / 3000, rel=0.01)
    assert upper_bound(5, 100) == pytest.approx(0.1023, abs=1e-3)  # Clopper-Pearson, tables
