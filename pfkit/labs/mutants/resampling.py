"""Resamplers that are biased, or are not what they are called."""

import numpy as np

from pfkit.labs.items import Misconception


def multinomial_in_disguise(w, rng):
    return np.searchsorted(np.cumsum(w), np.sort(rng.random(len(w))))


def stratified_in_disguise(w, rng):
    M = len(w)
    return np.searchsorted(np.cumsum(w), (np.arange(M) + rng.random(M)) / M)


def off_by_one(w, rng):
    M = len(w)
    edges = np.concatenate([[0.0], np.cumsum(w)[:-1]])  # the left edges, not the right ones
    return np.minimum(np.searchsorted(edges, (np.arange(M) + rng.random()) / M), M - 1)


def stretched_comb(w, rng):
    M = len(w)
    u = rng.random() / M + np.arange(M) / (M - 1)
    return np.minimum(np.searchsorted(np.cumsum(w), u), M - 1)


def long_offset(w, rng):
    M = len(w)
    u = rng.random() + np.arange(M) / M
    return np.minimum(np.searchsorted(np.cumsum(w), u), M - 1)


def own_generator(w, rng):
    M = len(w)
    own = np.random.default_rng()
    return np.minimum(np.searchsorted(np.cumsum(w), (np.arange(M) + own.random()) / M), M - 1)


def _ignores_rng(scheme):
    """Is it random, although it leaves the given generator where it was?"""
    rng, w = np.random.default_rng(1), np.full(7, 1 / 7) + np.linspace(-0.1, 0.1, 7)
    before = str(rng.bit_generator.state)
    found = {tuple(scheme(w, rng)) for _ in range(30)}
    return len(found) > 1 and str(rng.bit_generator.state) == before


def no_chance(w, rng):
    M = len(w)
    return np.searchsorted(np.cumsum(w), (np.arange(M) + 0.5) / M)


SYSTEMATIC = (
    Misconception(
        "multinomial",
        "is multinomial resampling: every draw is independent",
        (
            "How many random numbers does one call use? A comb needs one.",
            "A comb moves as a whole: one offset, then equal steps.",
            "Points are (k + U)/M for k = 0 .. M-1, with a single U = rng.random().",
        ),
        multinomial_in_disguise,
    ),
    Misconception(
        "stratified",
        "is stratified resampling: it draws a fresh offset for every tooth",
        (
            "Are the distances between your points all equal?",
            "Stratified takes M random numbers, systematic takes one.",
            "Call rng.random() once, without a size, and add it to every k.",
        ),
        stratified_in_disguise,
    ),
    Misconception(
        "off-by-one",
        "is one place off in the cumulative sum: it picks the neighbour of the right particle",
        (
            "Give all weight to particle 0. Which particle do you copy?",
            "Particle i owns the stretch that ends at w_0 + ... + w_i, its own weight included.",
            "Compare the points with np.cumsum(w) itself: the first i with cumsum >= u.",
        ),
        off_by_one,
    ),
    Misconception(
        "stretched-comb",
        "spaces the teeth by 1/(M-1) instead of 1/M",
        (
            "Where does your last tooth lie? It must stay below 1.",
            "M teeth share the interval from 0 to 1, so each owns a stretch of 1/M.",
            "Points are (k + U)/M: divide by M.",
        ),
        stretched_comb,
    ),
    Misconception(
        "long-offset",
        "draws the offset from the whole interval, so the teeth run past 1",
        (
            "Where do your last teeth lie if the offset is .9?",
            "The offset moves the comb within the first gap only.",
            "The offset is U/M, between 0 and 1/M.",
        ),
        long_offset,
    ),
    Misconception(
        "no-chance",
        "uses no random number at all",
        (
            "Call it twice. Should the result always be the same?",
            "A particle with a small weight must survive sometimes, or the scheme is biased.",
            "Replace the fixed offset by one U = rng.random().",
        ),
        no_chance,
    ),
    Misconception(
        "own-generator",
        "draws from another generator than the one it is given",
        (
            "Call it twice with np.random.default_rng(1). Should the results agree?",
            "Nobody can repeat a run whose chance comes from elsewhere.",
            "Draw with rng.random(), not with np.random.",
        ),
        own_generator,
        _ignores_rng,
    ),
)


def fraction_of_w(w, rng):
    M = len(w)
    copies = np.floor(M * w).astype(int)
    rest = np.clip(w - copies, 0, None)  # as printed in a popular library
    rest = np.cumsum(rest)
    rest = rest / rest[-1] if rest[-1] > 0 else np.ones(M)
    drawn = np.searchsorted(rest, rng.random(M - copies.sum()))
    return np.concatenate([np.repeat(np.arange(M), copies), np.minimum(drawn, M - 1)])


def rest_from_w(w, rng):
    M = len(w)
    copies = np.floor(M * w).astype(int)
    drawn = rng.choice(M, M - copies.sum(), p=w / w.sum())
    return np.concatenate([np.repeat(np.arange(M), copies), drawn])


def rest_to_the_heaviest(w, rng):
    M = len(w)
    copies = np.floor(M * w).astype(int)
    copies[np.argmax(w)] += M - copies.sum()
    return np.repeat(np.arange(M), copies)


def comb_for_the_rest(w, rng):
    M = len(w)
    points = (np.arange(M) + rng.random()) / M
    return np.minimum(np.searchsorted(np.cumsum(w), points), M - 1)


def rest_for_all_alike(w, rng):
    M = len(w)
    copies = np.floor(M * w + 1e-12).astype(int)
    return np.concatenate([np.repeat(np.arange(M), copies), rng.integers(0, M, M - copies.sum())])


RESIDUAL = (
    Misconception(
        "rest-uniform",
        "draws the rest with equal chances for all",
        (
            "In w = (.40, .25, .15, .12, .08) particle 0 has all it is owed. Can it get one more?",
            "Some particles are owed more of the rest than others.",
            "Draw with p = rest / rest.sum(), rest = M w - floor(M w).",
        ),
        rest_for_all_alike,
    ),
    Misconception(
        "no-repeat",
        "never gives a particle two of the copies that are left: it is a comb, or draws without "
        "replacement",
        (
            "Two copies are left to chance. Can one particle get both? In yours it cannot.",
            "Residual resampling draws what is missing independently, with replacement.",
            "Draw the rest with rng.choice(M, left, p=rest / rest.sum()).",
        ),
        comb_for_the_rest,
    ),
    Misconception(
        "fraction-of-w",
        "subtracts the copies from w, where M w is meant (a slip printed in a popular library)",
        (
            "For w = (.40, .25, .15, .12, .08) and M = 5: which particles can get the last draws?",
            "Copies are counted in particles, weights in shares. Bring both to one unit.",
            "The rest is M w - floor(M w).",
        ),
        fraction_of_w,
    ),
    Misconception(
        "rest-from-w",
        "draws the rest from w itself, so heavy particles are paid twice",
        (
            "Particle 0 expects 2.0 copies and has 2 already. Should it take part in the rest?",
            "What a particle still has to get is its expected number minus what it has.",
            "Draw the rest with weights M w - floor(M w), normalised.",
        ),
        rest_from_w,
    ),
    Misconception(
        "rest-to-heaviest",
        "gives what is left to the heaviest particle",
        (
            "Can a particle with M w < 1 ever survive in your scheme?",
            "Unbiased means E[copies] = M w, for small weights too.",
            "Draw the rest at random with weights M w - floor(M w), normalised.",
        ),
        rest_to_the_heaviest,
    ),
)

MUTANTS = {"lab3": {"q4b": SYSTEMATIC, "q4c": RESIDUAL}}
