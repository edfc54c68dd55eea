"""Motion. Questions on arcs, wheels, odometry, and where the errors enter."""

from pfkit.labs.ch03 import arcs, by_hand, clouds, experiments, vehicles
from pfkit.labs.lab import Lab, Question

QUESTIONS = (
    Question("predict", "Predictions", (experiments.rigid, experiments.split)),
    Question("hand", "By hand", (by_hand.hand, by_hand.drift)),
    Question(
        "vehicles",
        "Vehicles and odometers",
        (vehicles.wheels, vehicles.odometry, vehicles.vehicle, vehicles.literal),
    ),
    Question("code", "Code", (arcs.arc, clouds.sample)),
    Question("break", "Experiments", (experiments.rigid_x, experiments.split_x, experiments.why)),
)
LAB = Lab("ch03", "Motion", list(QUESTIONS))
check, use, predict, answer, summary, save, load = LAB.verbs()
