"""Before the course: ten questions, to see whether the course starts where you stand."""

import math

from pfkit.labs import Choice, Lab, Numeric, Question

ARRAYS = Question("Arrays")

column = Choice("""What does np.arange(6).reshape(2, 3)[:, 1] give?
    a  array([3, 4, 5])
       = That is the second row, [1, :]. The colon stands where everything is taken.
    b* array([1, 4])
       = Yes, the second column. In this course the first axis is the components of a state, so
         cloud[:, 1] is the second particle of a cloud.
    c  array([0, 3])
       = That is the first column. Counting starts at 0.
    d  the number 1
       = The colon takes all rows, so two numbers are left.""")

CHANCE = Question("Probability")


def _detector(share, hit, false):
    """Share of doors in the corridor; how often the detector fires at a door, and at a wall."""
    doors, walls = share * hit, (1 - share) * false
    told = {"share": share, "hit": hit, "false": false, "rest": 1 - share}
    return {k: round(v, 4) for k, v in {**told, "doors": doors, "walls": walls}.items()}


door = Numeric(
    """Probability of a door after the detector fired: {share} of the corridor are doors, it fires
         at {hit} of the doors and at {false} of the walls
    Of 100 places, how many are doors that fire, and how many are walls that fire?
    Doors that fire: {share} times {hit}. Walls that fire: {rest} times {false}.
    {doors} / ({doors} + {walls}).""",
    lambda doors, walls, **_: doors / (doors + walls),
    tol=0.005,
    world=_detector(0.25, 0.8, 0.2),
    draw=lambda rng: _detector(
        rng.choice([0.1, 0.2, 0.25, 0.3, 0.4]),
        rng.choice([0.7, 0.75, 0.8, 0.9]),
        rng.choice([0.1, 0.15, 0.2, 0.25]),
    ),
)
door.wrong("""forgets-the-prior: is how often a door makes the detector fire, not how often
         firing means a door
    {rest} of the corridor are walls. Where are they in your answer?
    Weigh {hit} by the share of doors and {false} by the share of walls.
    {share} * {hit} / ({share} * {hit} + {rest} * {false}).""")(lambda hit, **_: hit)
door.wrong("""not-normalised: is the probability of a door and a firing, not yet divided by that
         of a firing
    Door and wall, both after a firing, must sum to one.
    Divide by {doors} + {walls}.
    {doors} / ({doors} + {walls}).""")(lambda doors, **_: doors)
door.wrong("""ignores-the-firing: is what you knew before the detector fired
    What does the firing change?
    A door fires more often than a wall.
    {share} * {hit} / ({share} * {hit} + {rest} * {false}).""")(lambda share, **_: share)

spread = Numeric(
    """Variance of one range; standard deviation of the mean of 100
    A variance is a square; a mean of n independent values has a variance n times smaller.
    0.1 squared; then the root of 0.01 / 100.
    0.01 m², and 0.1 / 10 = 0.01 m. That the numbers agree is an accident; the units differ.""",
    (0.01, 0.01),
    tol=0.0005,
    names=("variance [m²]", "sd of the mean [m]"),
)
spread.wrong("""divides-by-n: divides the standard deviation by 100 instead of by its root
    Which of the two gets 100 times smaller, variance or standard deviation?
    The variance does. Take the root afterwards.
    0.1 / √100.""")((0.01, 0.001))
spread.wrong("""variance-of-the-mean: gives the variance of the mean where its standard
         deviation is asked
    Which unit has your second number?
    It is in m². Take its root.
    √0.0001.""")((0.01, 0.0001))
spread.wrong("""sd-as-variance: calls the standard deviation a variance
    A variance of a length has the unit m².
    Square 0.1 m.
    0.1² = 0.01.""")((0.1, 0.01))

PLANE = Question("Geometry")

landmark = Numeric(
    """Where is the landmark, and at which bearing?
    Straight ahead is where the robot looks.
    Three metres along +y from (1, 2). A bearing is measured from the robot's nose.
    (1, 2 + 3), and straight ahead is bearing 0.""",
    (1.0, 5.0, 0.0),
    tol=0.01,
    names=("x [m]", "y [m]", "bearing [rad]"),
)
landmark.wrong("""bearing-from-the-map: measures the bearing from the x axis of the map
    Where does the robot look?
    A bearing is the direction on the map minus the robot's heading.
    Both are a quarter turn here, so the bearing is 0.""")((1.0, 5.0, math.pi / 2))
landmark.wrong("""ahead-is-x: takes straight ahead for the x axis of the map
    The robot faces along +y.
    Its heading is a quarter turn: ahead is (0, 1).
    (1, 2) + 3 * (0, 1).""")((4.0, 2.0, 0.0))

heading = Choice("""What is the average of the headings 359° and 1°?
    a  180°
       = That is the average of the numbers. It points backwards.
    b* 0°
       = Yes. Add unit vectors and take the direction of the sum.
    c  2°
       = That is how far the two are apart.
    d  there is none
       = Two opposite headings have none; these two are nearly the same.""")


MORE = Question("What the chapters use")

density = Choice("""A place is uniform over 2 cm. How large is its density there, per metre?
    a  0.02
       = That is the width. Density times width must be one.
    b* 50
       = Yes: 50 per metre times 0.02 m is one; a density may exceed one, a probability may not.
    c  1, because a probability cannot exceed 1
       = A density is no probability: it becomes one when it is multiplied by a width.
    d  0, because a single place has no probability
       = The probability of a single place is zero, but its density is not.""")

turned = Numeric(
    """The vector (2, 1), turned to the left by 90 degrees
    Where does the x axis point after the turn? And the y axis?
    (x cos a - y sin a, x sin a + y cos a), with cos a = 0 and sin a = 1.
    (-1, 2).""",
    (-1.0, 2.0),
    tol=0.01,
    names=("x", "y"),
)
turned.wrong("""to-the-right: turns to the right
    Counterclockwise is to the left.
    The x axis turns into the y axis.
    (-y, x)""")((1.0, -2.0))
turned.wrong("""exchanged: exchanges the two coordinates, which is a mirror
    Where does (1, 0) go? And (0, 1)?
    (0, 1) goes to (-1, 0): one sign changes.
    (-y, x)""")((1.0, 2.0))

summed = Numeric(
    """Variance of a + b, and of a - b, for variances 4 and 1 and a covariance of 1.5
    Independent errors only add their variances. These err together.
    Var(a + b) = Var a + Var b + 2 Cov(a, b).
    4 + 1 + 3, and 4 + 1 - 3.""",
    (8.0, 2.0),
    tol=0.01,
    names=("variance of a + b", "variance of a - b"),
)
summed.wrong("""independent: adds the variances only
    Do the two err independently?
    Their covariance counts twice.
    5 + 2 * 1.5, and 5 - 2 * 1.5""")((5.0, 5.0))
summed.wrong("""once: counts the covariance once
    How often does the mixed term occur in (a + b)²?
    Twice: 2 a b.
    5 + 2 * 1.5""")((6.5, 3.5))
summed.wrong("""subtracts: subtracts the variances in the difference
    Does the error of b make a - b better known?
    The sign is squared away; only the mixed term keeps it.
    4 + 1 - 3""")((8.0, 0.0))

pooled = Numeric(
    """Two measured lengths, 10 m with variance 1 m² and 13 m with variance 2 m²: mean and variance
         of the product of their densities
    Weigh each by one over its variance.
    The weights are 1 and 1/2, their sum 3/2.
    (10 + 13 / 2) / (3/2), and 1 / (3/2).""",
    (11.0, 2 / 3),
    tol=0.01,
    names=("mean", "variance"),
)
pooled.wrong("""plain-mean: takes the plain mean of the two
    Which of them is better known?
    One over the variance is the weight.
    (10 * 1 + 13 * 0.5) / 1.5""")((11.5, 2 / 3))
pooled.wrong("""swapped: weighs the worse one more
    A large variance: much or little weight?
    One over it.
    (10 * 1 + 13 * 0.5) / 1.5""")((12.0, 2 / 3))
pooled.wrong("""adds: adds the variances
    Do two measurements together know less than one?
    The weights add, 1 + 1/2; the variance is one over that.
    1 / 1.5""")((11.0, 3.0))

scaled = Numeric(
    """x is uniform from 0 to 1 and y = 3 x. The density of y at 2, and its probability to lie
         between 2 and 2.3
    Over which range is y spread, and evenly?
    From 0 to 3. The density must integrate to one.
    1/3, and 1/3 times 0.3.""",
    (1 / 3, 0.1),
    tol=0.003,
    names=("density", "probability"),
)
scaled.wrong("""unchanged: keeps the density of x
    What is 1 times the length of the new range?
    Stretched by 3, the density falls to a third.
    1 / 3""")((1.0, 0.3))
scaled.wrong("""wrong-way: multiplies by the stretch instead of dividing
    Does a stretched density become higher or lower?
    Its area must stay one.
    1 / 3""")((3.0, 0.9))


LAB = Lab.of(__name__, "Prerequisites")
__getattr__ = LAB.verb
