"""What do you expect? Locked before the experiments."""

from pfkit.labs import Prediction, Question

PREDICT = Question("Predictions")

average = Prediction("""Averaging likelihoods instead of multiplying them
    a  as wide: both use all four numbers
    b  wider by a few per cent
    c* three to five times as wide
    d  narrower, because averaging removes noise""")

beams = Prediction("""Share of weights that are exactly zero after five laser beams
    a  none: a Gaussian is never zero
    b  about one in a hundred
    c  about one in ten
    d* more than half""")
