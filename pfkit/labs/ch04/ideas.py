"""What a likelihood is."""

import numpy as np

from pfkit.labs.items import Choice, Misconception, Numeric, Text

likelihood = Choice(
    id="likelihood",
    title="The likelihood of a range at a particle is 0.8. What may you say?",
    options={
        "a": "the robot is at the particle with probability 0.8",
        "b": "if the robot were there, a reading like this one would have density 0.8 per metre",
        "c": "the particle is the best guess, because 0.8 is close to one",
        "d": "the likelihoods of all particles sum to one, so 0.2 is left for the others",
    },
    key="b",
    feedback={
        "a": "That is p(x | z); it also takes the prior, and the sum over all other places.",
        "b": "Yes: p(z | x) is a density of readings, with x given.",
        "c": "Densities have units and no ceiling: with a sharper sensor it could be 80.",
        "d": "Likelihoods sum to nothing in particular; normalised weights sum to one.",
    },
)

sd = Numeric(
    id="sd",
    title="How many times more the second particle weighs if 3 is a standard deviation",
    key=float(np.exp(4)),
    tol=0.5,
    hints=(
        "Write exp(-e^2 / (2 sigma^2)) twice, with sigma^2 = 9 and with sigma^2 = 3.",
        "The exponents are -36 / 18 = -2 and -36 / 6 = -6.",
        "exp(-2) / exp(-6).",
    ),
    misconceptions=(
        Misconception(
            "no-half",
            "leaves out the one half in the exponent",
            (
                "Look at the exponent of the Gaussian.",
                "It is e^2 over twice the variance.",
                "The exponents are -2 and -6.",
            ),
            float(np.exp(8)),
            lambda x: abs(x - np.exp(8)) < 10,
        ),
        Misconception(
            "inverse",
            "is the other way round",
            (
                "Which bell is wider?",
                "A deviation of 3 m is a variance of 9, the more forgiving one.",
                "Turn the fraction over.",
            ),
            float(np.exp(-4)),
            lambda x: abs(x - np.exp(-4)) < 0.005,
        ),
        Misconception(
            "keeps-constants",
            "compares densities; relative to the perfect particle the constants cancel",
            (
                "What does the perfect particle weigh in either case?",
                "The factor 1 / (sigma sqrt(2 pi)) is in both particles' weights.",
                "Only the exponents are left: -2 and -6.",
            ),
            float(np.exp(4) / np.sqrt(3)),
        ),
    ),
)

field = Choice(
    id="field",
    title="A beam would have to fly through one wall to end exactly at the next. Who objects?",
    options={
        "a": "both models",
        "b": "only the beam model",
        "c": "only the likelihood field",
        "d": "neither",
    },
    key="b",
    feedback={
        "a": "The field looks at the end of the beam only, and the end is at a wall.",
        "b": "Yes: it knows how far the beam should fly. The field only knows where it ends.",
        "c": "The other way round: the field is happy with any end that touches a wall.",
        "d": "The beam model compares with the first wall, and finds the reading too long.",
    },
)

why = Text(
    id="why",
    title="Why multiply, and why in logarithms?",
    rubric=(
        "says that the measurements are independent given the pose, so that densities multiply",
        "says that an average lets one good measurement excuse an impossible one",
        "says that products of small numbers underflow to zero and sums of logarithms do not",
    ),
    model=(
        "Given the pose the errors of the measurements are independent, so their densities "
        "multiply. An average adds densities of different units, and lets one good reading excuse "
        "an impossible one. Products of many small numbers round to zero, while their logarithms "
        "only add up."
    ),
)
