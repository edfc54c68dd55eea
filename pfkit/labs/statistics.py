"""What experiments measure and decide with."""

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray


def shaped(found: ArrayLike, *shape: int) -> NDArray[np.float64]:
    """Numbers as an array of a stated shape; raises ValueError that names both shapes."""
    x = np.asarray(found, dtype=float)
    if x.shape != shape:
        raise ValueError(f"expected numbers of shape {shape}, got shape {x.shape}")
    return x


def rng_of(seed: int) -> np.random.Generator:
    """A fresh generator: checks that must say the same each time use fixed seeds."""
    return np.random.default_rng(seed)


def z_of_mean(x: ArrayLike, mu: float) -> float:
    """How many standard errors the mean of x lies above mu."""
    x = np.asarray(x, dtype=float)
    se = x.std(ddof=1) / math.sqrt(x.size)
    return float((x.mean() - mu) / se) if se > 0 else math.copysign(math.inf, x.mean() - mu)


def z_of_fall(a: ArrayLike, b: ArrayLike) -> float:
    """How many standard errors the share a lies above the share b (two sets of yes and no)."""
    a, b = np.asarray(a, dtype=float), np.asarray(b, dtype=float)
    pooled = (a.sum() + b.sum()) / (a.size + b.size)
    se = math.sqrt(max(pooled * (1 - pooled), 1e-12) * (1 / a.size + 1 / b.size))
    return float((a.mean() - b.mean()) / se)


def z_of_share(x: ArrayLike, p: float) -> float:
    """How many standard errors the share of yes lies above the probability p, 0 < p < 1."""
    x = np.asarray(x, dtype=float)
    return float((x.mean() - p) / math.sqrt(p * (1 - p) / x.size))
