"""Wheels, odometers, and printed equations to read."""

from pfkit.labs import Choice, Numeric, Question

VEHICLES = Question("Vehicles and odometers")

wheels = Numeric(
    """Speed, turn rate and radius of a robot with two wheels
    How fast does each wheel's rim run? Radius times rad/s.
    The rims run at 0.8 and 1.2 m/s; the middle of the axle at their mean.
    The turn rate is the difference, 0.4 m/s, over the axle; the radius is v / omega.""",
    (1.0, 0.8, 1.25),
    tol=0.005,
    names=("speed in m/s", "turn rate in rad/s", "radius in m"),
)
wheels.wrong("""sum: adds the wheels instead of averaging them
    If both rims ran at 1 m/s, how fast would the robot be?
    The middle of the axle moves at the mean of the two rims.
    v = (0.8 + 1.2) / 2.""")((2.0, 0.8, 2.5))
wheels.wrong("""half-axle: takes half of the difference over the axle
    If the left wheel stood still, about which point would the robot turn?
    About the left wheel, and the right one is a whole axle away.
    omega = (1.2 - 0.8) / 0.5.""")((1.0, 0.4, 2.5))
wheels.wrong("""sign: turns to the wrong side
    The right wheel is faster. To which side does the robot turn?
    To the left, and left is positive.
    omega is right minus left.""")((1.0, -0.8, -1.25), when=lambda x: abs(x[1] + 0.8) < 0.005)

odometry = Numeric(
    """Turn, drive, turn
    Draw the two poses. In which direction of the map lies the second?
    The way goes by (-1, 1): that is 135 degrees on the map, and the nose points to 90.
    rot1 = 135 - 90; rot2 = -150 - 90 - rot1, wrapped.""",
    (45.0, 1.414, 75.0),
    tol=0.1,
    names=("rot1 in degrees", "trans in m", "rot2 in degrees"),
)
odometry.wrong("""no-wrap: turns nearly all the way round at the end
    Is there a shorter turn to the same heading?
    A turn of -285 degrees ends where one of 75 does, but nobody drives it.
    Wrap every difference of angles.""")((45.0, 1.414, -285.0))
odometry.wrong("""map-direction: gives the direction on the map, not the turn
    Where does the robot look before it moves?
    It already looks at 90 degrees, so it has to turn less.
    Subtract the first heading from the direction of the way.""")(
    (135.0, 1.414, 75.0), when=lambda x: abs(x[0] - 135) < 0.1
)
odometry.wrong("""arctan: takes an arctangent that cannot tell front from back
    In which quadrant does the way (-1, 1) lie?
    arctan(1 / -1) and arctan(-1 / 1) are the same number.
    Use atan2(1, -1), which is 135 degrees.""")(
    (-135.0, 1.414, -105.0), when=lambda x: abs(x[0] + 135) < 0.1
)

vehicle = Choice("""Which robot moves like the assignment's equation?
    a  a bicycle: it turns only while it rolls
       = Put d = 0: the equation still turns the robot, and no bicycle can do that.
    b* a robot that drives along its old heading and then turns on the spot
       = Yes: position uses the old heading only, and the turn comes with no condition.
    c  a robot that turns on the spot and then drives along its new heading
       = The equation's cosine holds the old heading, not the new one.
    d  a robot with two driven wheels, on an exact arc
       = On an arc the chord points halfway between old and new heading.""")

literal = Choice("""What does the printed equation do?
    a  it is the usual motion model
       = Look for the previous state on the right-hand side.
    b* it forgets where the robot was, and pushes it along one diagonal only
       = Yes: no previous position is added, and x and y share one number as their noise.
    c  it forgets the noise of the heading
       = The third row has a noise of its own.
    d  it turns the robot twice as fast as its wheels say
       = The third row is the right turn for one second; what is it added to?""")
