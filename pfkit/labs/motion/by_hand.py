"""A quarter circle, and a drift: two sums for pencil and paper."""

from pfkit.labs import Numeric, Question

HAND = Question("By hand")

hand = Numeric(
    """A quarter circle to the right
    The robot drives a quarter of a circle. How long is the whole circle?
    Half a metre is a quarter of the circle, so its circumference is 2 m.
    The radius is 2 / (2 pi) = 0.318 m, and a quarter to the right ends at (radius, -radius).""",
    (0.318, -0.318),
    tol=0.002,
    unit="m",
    names=("x", "y"),
)
hand.wrong("""drive-then-turn: drives straight on and turns at the end
    When does the robot turn: during the second, or after it?
    It turns all the time, so its track bends to the right.
    The track is a quarter of a circle with a circumference of 2 m.""")((0.5, 0.0))
hand.wrong("""turn-then-drive: turns first and drives afterwards
    Does the robot know its final heading from the first moment on?
    It starts towards +x and only ends towards -y.
    The track is a quarter of a circle with a radius of 0.318 m.""")((0.0, -0.5))
hand.wrong("""full-chord: goes the whole half metre in the middle direction
    The direction is right. Is the straight way as long as the bent one?
    The chord of an arc is shorter than the arc.
    The chord is 0.5 sin(pi/4) / (pi/4) = 0.450 m.""")((0.354, -0.354))
hand.wrong("""left: turns left
    Which way does a positive turn rate turn?
    Counter-clockwise is positive, and this one is negative.
    The robot ends at a negative y.""")((0.318, 0.318))

drift = Numeric(
    """Sideways spread after ten steps
    How far does the robot still drive after the first turn? And after the last?
    The turns act over 10, 9, ... 1 m; independent errors add as squares.
    0.02 times the root of 1 + 4 + 9 + ... + 100, which is the root of 385.""",
    0.392,
    tol=0.004,
    unit="m",
)
drift.wrong("""linear: adds the errors as if all had the same sign
    Do ten independent errors all point the same way?
    Variances add, standard deviations do not.
    Take the root of the sum of squares, 385, not the sum, 55.""")(1.1)
drift.wrong("""final-heading: lets the final heading error act on all ten metres
    Was the heading as wrong at the start as it is at the end?
    The last turn acts on one metre only.
    The levers are 10, 9, ... 1 m.""")(0.632)
drift.wrong("""no-lever: lets each turn act on its own metre only
    After a wrong turn, which of the later metres point the right way?
    A wrong turn is never taken back: it acts on all metres that follow.
    The levers are 10, 9, ... 1 m, not 1 m each.""")(0.0632)
