"""How often would a right experiment fail? Replay the decision and count.

An `Experiment` declares a false-fail probability. `replay` measures it: it makes a pool of
independent runs once, then repeats the check's decision on draws from that pool.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from pfkit.labs.items import Experiment


class Rate(NamedTuple):
    """``fails`` of ``decisions``, and a one-sided 95 % upper bound on the probability."""

    fails: int
    decisions: int
    bound: float
    misconceptions: dict[str, int]

    @property
    def share(self) -> float:
        return self.fails / self.decisions


def upper_bound(fails: int, n: int, alpha: float = 0.05) -> float:
    """Clopper-Pearson: the probability at which so few fails have probability ``alpha``."""
    low, high = fails / n, 1.0
    for _ in range(60):
        mid = (low + high) / 2
        logs = [
            math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1)
            + k * math.log(mid) + (n - k) * math.log1p(-mid)
            for k in range(fails + 1)
        ] if 0 < mid < 1 else [0.0]  # fmt: skip
        low, high = (mid, high) if sum(map(math.exp, logs)) > alpha else (low, mid)
    return high


SIDE_BY_SIDE = 250  # runs of one call: quick, and not too large for memory
WORLDS = 6  # sets of settings that a replay visits


def _joined(parts: list[dict[str, np.ndarray]]) -> dict[str, np.ndarray]:
    """Responses by name, of several calls one below the other."""
    return {
        name: np.concatenate([p[name] for p in parts])
        for name in parts[0]
        if all(name in p for p in parts)
    }


def in_its_own_way(answer: Callable[..., Any]) -> Callable[..., Any]:
    """The same program with other random numbers, as one that draws in another order.

    Beside a reference on the same seeds a copy of it can never fail; this one can.
    """

    def run(*args: Any, **kwargs: Any) -> Any:
        def other(a: Any) -> Any:
            return a.spawn(1)[0] if isinstance(a, np.random.Generator) else a

        return answer(*map(other, args), **{k: other(a) for k, a in kwargs.items()})

    return run


def replay(
    item: Experiment,
    answer: Any,
    decisions: int = 3_000,
    pool: int = 0,
    seed: int = 1,
    fresh: bool = False,
    worlds: int = WORLDS,
) -> Rate:
    """Repeat a check of ``answer`` many times.

    Parameters
    ----------
    item : Experiment
    answer : callable
        The reference, or a mutant.
    decisions : int
        How many checks to imitate.
    pool : int
        How many independent runs to make, by default ``item.pool``; each decision draws
        ``item.runs`` of them without replacement, so the pool should be several times larger.
        An item with settings has such a pool, shared out, in each of ``worlds``.
    seed : int
        Differs from the seed of the check itself.
    fresh : bool
        Make new runs for each decision instead: for answers whose runs are not independent.
    worlds : int
        How many sets of settings a replay visits, if the item has any.

    Notes
    -----
    An answer that raises, or whose outcomes make no sense, fails every decision.
    """
    rng = np.random.default_rng(seed)
    pool = pool or item.pool
    worlds = worlds if item.settings is not None else 1
    pools, others = [], []
    try:
        for w in range(0 if fresh else worlds):
            size = max(2 * item.runs, pool // worlds) if worlds > 1 else pool
            part = max(item.runs, min(size, SIDE_BY_SIDE))
            where = [(part, seed + 1 + k + 1000 * w, seed + w) for k in range(-(-size // part))]
            pools.append(np.concatenate([item.outcomes(answer, *place) for place in where]))
            if answer is not item.reference:
                others.append(_joined([item.rivals(*place) for place in where]))
        fails, names = 0, dict[str, int]()
        for k in range(decisions):
            if fresh:
                drawn = item.outcomes(answer, item.runs, seed=seed + 1 + k, world=seed + k)
            else:
                runs = pools[k % worlds]
                rows = rng.choice(len(runs), item.runs, replace=False)
                drawn = runs[rows]
            judged = item.decide(drawn)
            if judged.fraction < 1 and not fresh and others:
                rivals = {name: x[rows] for name, x in others[k % worlds].items()}
                judged = item.decide(drawn, rivals)
            if judged.fraction < 1:
                fails += 1
                name = judged.misconception.name if judged.misconception else ""
                names[name] = names.get(name, 0) + 1
    except Exception:
        return Rate(decisions, decisions, 1.0, {"": decisions})
    return Rate(fails, decisions, upper_bound(fails, decisions), names)
