r"""Motion and sensing: the two densities of the course.

:math:`p(x_t \mid u_t, x_{t-1})` and :math:`p(z_t \mid x_t)`, each a small frozen class that can
tell its mean, draw a sample and give a density.
"""
