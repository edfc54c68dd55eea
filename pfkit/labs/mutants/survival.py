"""Survival of a particle, with a sign, a case or a bound wrong."""

from pfkit.labs.items import Misconception


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

MUTANTS = {"lab3": {"q5b": SURVIVAL}}
