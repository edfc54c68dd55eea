"""By hand: a bearing, and a weight."""

import numpy as np

from pfkit.labs import Numeric, Question

HAND = Question("By hand")


def _seen(x, y, robot_x, robot_y, heading):
    """A landmark, a robot with its heading in degrees, and the way to the bearing between them."""
    dx, dy = x - robot_x, y - robot_y
    told = {"x": x, "y": y, "robot_x": robot_x, "robot_y": robot_y, "heading": heading}
    direction = round(float(np.degrees(np.arctan2(dy, dx))), 1)
    raw = round(direction - heading, 1)
    return told | {"dx": dx, "dy": dy, "direction": direction, "raw": raw}


def _elsewhere(rng):
    """Down and to the left of the robot, which looks up and to the left, as in print."""
    (x, y), (dx, dy) = rng.integers(-2, 3, 2), rng.integers(1, 5, 2)
    return _seen(int(x), int(y), int(x + dx), int(y + dy), int(rng.integers(20, 34)) * 5)


def _wrapped(degrees):
    return (degrees + 180) % 360 - 180


hand = Numeric(
    """Bearing, in degrees, of a landmark at ({x}, {y}) from ({robot_x}, {robot_y}), heading
         {heading} degrees
    Which way does the vector from the robot to the landmark point on the map?
    It is ({dx}, {dy}), which points to {direction} degrees. Then subtract the heading.
    {direction} - {heading} = {raw}; add a whole turn.""",
    lambda raw, **_: _wrapped(raw),
    tol=0.5,
    world=_seen(1, -1, 3, 1, 150),
    draw=_elsewhere,
)
hand.wrong("""no-heading: is the direction on the map, not seen from the robot's nose
    The same landmark looks different when the robot turns.
    A bearing is measured from the nose: subtract the heading.
    {direction} - {heading}, wrapped.""")(lambda direction, **_: direction)
hand.wrong("""no-wrap: is not wrapped into (-180, 180]
    Would a sensor report more than half a turn?
    Add or subtract whole turns until it lies between -180 and 180.
    {raw} + 360.""")(lambda raw, **_: raw)
hand.wrong("""half-turn: is half a turn off
    Is the landmark really up and to the right of the robot?
    arctan(dy / dx) forgets both signs, and robot minus landmark turns both round.
    Use atan2({dy}, {dx}) = {direction} degrees.""")(lambda raw, **_: _wrapped(raw + 180))
hand.wrong("""plus-heading: adds the heading instead of subtracting it
    Turn left: does what is in front of you move left or right?
    The bearing falls as the heading grows.
    {direction} - {heading}, wrapped.""")(
    lambda direction, heading, **_: _wrapped(direction + heading)
)
hand.wrong("""radians: is in radians
    Which unit was asked for?
    Degrees, please.
    Multiply by 180 / pi.""")(lambda raw, **_: np.radians(_wrapped(raw)))

ERRORS = np.array([[0.5, 0.0, 3.0, 2.0], [0.5, 3.0, 0.0, 2.0], [2.0, 0.0, 1.0, 0.0]])

_P = np.exp(-0.5 * ERRORS**2)


def _first(p):
    return float(p[0] / p.sum())


weight = Numeric(
    """Weight of guess A after three measurements
    What does the new measurement say about each guess: exp(-e^2 / 2)?
    Multiply: 0.951 * 0.135 for A, 0.014 * 1 for B, and so on.
    The products are 0.129, 0.014, 0.008, 0.022; divide the first by their sum.""",
    _first(_P.prod(axis=0)),
    tol=0.004,
)
weight.wrong("""averages: averages the three likelihoods
    B was three deviations off in bearing. Should one good range excuse that?
    Independent measurements multiply.
    0.951 * 0.135 for A; then the same for the others, and normalise.""")(_first(_P.mean(axis=0)))
weight.wrong("""only-new: uses the last measurement only
    What did the first two measurements say?
    The old weight stays in: multiply it.
    Start from 0.951, 0.014, 0.014, 0.022.""")(_first(_P[2]))
weight.wrong("""not-normalised: is not divided by the sum
    Weights sum to one.
    Add the four products.
    Divide 0.129 by 0.173.""")(float(_P.prod(axis=0)[0] / _P[:2].prod(axis=0).sum()))
weight.wrong("""no-half: uses exp(-e^2) for the new measurement
    Look at the exponent of the Gaussian.
    At two deviations it has fallen to 0.135.
    The exponent is -e^2 / 2.""")(_first(_P[:2].prod(axis=0) * _P[2] ** 2))
