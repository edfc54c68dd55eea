"""Sensing: questions on what a measurement says about a pose."""

from pfkit.labs.lab import Lab
from pfkit.labs.sensing import by_hand, experiments, ideas, predictions, score, there_and_back

LAB = Lab.of(__name__, "Sensing", predictions, by_hand, ideas, there_and_back, score, experiments)
__getattr__ = LAB.verb
