"""What a likelihood is."""

import numpy as np

from pfkit.labs import Choice, Numeric, Question

IDEA = Question("What a likelihood is")

likelihood = Choice("""The likelihood of a range at a particle is 0.8. What may you say?
    a  the robot is at the particle with probability 0.8
       = That is p(x | z); it also takes the prior, and the sum over all other places.
    b* if the robot were there, a reading like this one would have density 0.8 per metre
       = Yes: p(z | x) is a density of readings, with x given.
    c  the particle is the best guess, because 0.8 is close to one
       = Densities have units and no ceiling: with a sharper sensor it could be 80.
    d  the likelihoods of all particles sum to one, so 0.2 is left for the others
       = Likelihoods sum to nothing in particular; normalised weights sum to one.""")

sd = Numeric(
    """How many times more the second particle weighs if 3 is a standard
         deviation
    Write exp(-e^2 / (2 sigma^2)) twice, with sigma^2 = 9 and with sigma^2 = 3.
    The exponents are -36 / 18 = -2 and -36 / 6 = -6.
    exp(-2) / exp(-6).""",
    float(np.exp(4)),
    tol=0.5,
)
sd.wrong("""no-half: leaves out the one half in the exponent
    Look at the exponent of the Gaussian.
    It is e^2 over twice the variance.
    The exponents are -2 and -6.""")(float(np.exp(8)), when=lambda x: abs(x - np.exp(8)) < 10)
sd.wrong("""inverse: is the other way round
    Which bell is wider?
    A deviation of 3 m is a variance of 9, the more forgiving one.
    Turn the fraction over.""")(float(np.exp(-4)), when=lambda x: abs(x - np.exp(-4)) < 0.005)
sd.wrong("""keeps-constants: compares densities; relative to the perfect particle the constants
         cancel
    What does the perfect particle weigh in either case?
    The factor 1 / (sigma sqrt(2 pi)) is in both particles' weights.
    Only the exponents are left: -2 and -6.""")(float(np.exp(4) / np.sqrt(3)))

field = Choice("""A beam would have to fly through one wall to end exactly at the next. Who
         objects?
    a  both models
       = The field looks at the end of the beam only, and the end is at a wall.
    b* only the beam model
       = Yes: it knows how far the beam should fly. The field only knows where it ends.
    c  only the likelihood field
       = The other way round: the field is happy with any end that touches a wall.
    d  neither
       = The beam model compares with the first wall, and finds the reading too long.""")
