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
        "systematic",
        "is systematic resampling, or draws the rest with a comb",
        (
            "Can a particle get two of the copies that are left to chance? In yours it cannot.",
            "Residual resampling draws what is missing independently.",
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


def sign_error(w, M):
    return 1 - (1 - 1 / M + (w - 1 / M)) ** M, min(1.0, M * w)


def death_not_survival(w, M):
    return (1 - w) ** M, max(0.0, 1 - M * w)


def expected_copies(w, M):
    return M * w, M * w


def above_one(w, M):
    return 1 - (1 - w) ** M, M * w


def swapped_schemes(w, M):
    return min(1.0, M * w), 1 - (1 - w) ** M


def both_alike(w, M):
    return 1 - (1 - w) ** M, 1 - (1 - w) ** M


SURVIVAL = (
    Misconception(
        "sign-error",
        "has the sign of epsilon wrong: 1 - (1 - 1/M + eps)^M, as one printed solution has",
        (
            "Raise w. Should the particle survive more often or less often?",
            "With w = 1/M + eps, the chance to be missed in one draw is 1 - w = 1 - 1/M - eps.",
            "Multinomial survival is 1 - (1 - w)^M.",
        ),
        sign_error,
    ),
    Misconception(
        "complement",
        "gives the probability to die",
        (
            "A particle that holds all the weight: what does your function say?",
            "(1 - w)^M is the probability that M draws all miss.",
            "Take one minus it.",
        ),
        death_not_survival,
    ),
    Misconception(
        "expected-copies",
        "gives the expected number of copies, which is not a probability",
        (
            "Try w = .5 and M = 100.",
            "M w counts copies; two copies of one particle are one survivor.",
            "Systematic: min(1, M w). Multinomial: 1 - (1 - w)^M.",
        ),
        expected_copies,
    ),
    Misconception(
        "above-one",
        "gives a probability above 1 for the comb",
        (
            "What does your second number say for w = .3 and M = 50?",
            "A stretch longer than the gap of the comb is hit for certain.",
            "Systematic survival is min(1, M w).",
        ),
        above_one,
    ),
    Misconception(
        "order",
        "returns systematic first",
        (
            "Which of your two numbers reaches 1 at w = 1/M?",
            "The order asked for is: multinomial, systematic.",
            "return 1 - (1 - w)**M, min(1, M * w).",
        ),
        swapped_schemes,
    ),
    Misconception(
        "both-alike",
        "uses the multinomial formula for both schemes",
        (
            "A comb with gaps of 1/M cannot miss a stretch longer than 1/M.",
            "A stretch shorter than 1/M is hit with a probability equal to its share of the gap.",
            "Systematic survival is min(1, M w).",
        ),
        both_alike,
    ),
)

MUTANTS = {"lab3": {"q4b": SYSTEMATIC, "q4c": RESIDUAL, "q5b": SURVIVAL}}
