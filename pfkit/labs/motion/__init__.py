"""Motion: questions on arcs, wheels, odometry, and where the errors enter."""

from pfkit.labs.lab import Lab
from pfkit.labs.motion import arcs, by_hand, clouds, experiments, predictions, vehicles

LAB = Lab.of(__name__, "Motion", predictions, by_hand, vehicles, arcs, clouds, experiments)
__getattr__ = LAB.verb
