"""What do you expect? Locked before the experiments."""

from pfkit.labs import Prediction, Question

PREDICT = Question("Predictions")

rigid = Prediction("""One error for the whole cloud, twelve steps long
    a  as wide: the errors are equally large
    b  half as wide
    c* as wide as at the start: it has not grown at all
    d  wider, because the errors no longer cancel""")

split = Prediction("""Four seconds in one step, or in sixteen
    a  the same: it is the same robot
    b* four times as large with the single step
    c  sixteen times as large with the single step
    d  four times as large with the sixteen steps""")
