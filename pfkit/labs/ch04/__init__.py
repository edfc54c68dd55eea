"""Sensing. Questions on what a measurement says about a pose."""

from pfkit.labs.ch04 import by_hand, experiments, ideas, score, there_and_back
from pfkit.labs.lab import Lab, Question

QUESTIONS = (
    Question("predict", "Predictions", (experiments.average, experiments.beams)),
    Question("hand", "By hand", (by_hand.hand, by_hand.weight)),
    Question("idea", "What a likelihood is", (ideas.likelihood, ideas.sd, ideas.field)),
    Question("code", "Code", (there_and_back.expected, there_and_back.place, score.score)),
    Question("break", "Experiments", (experiments.average_x, experiments.beams_x, ideas.why)),
)
LAB = Lab("ch04", "Sensing", list(QUESTIONS))
check, use, predict, answer, summary, save, load = LAB.verbs()
