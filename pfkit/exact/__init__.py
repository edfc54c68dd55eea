"""Exact and rival answers: histograms and grids; Kalman filters and a smoother.

A particle filter approximates. Here is what it approximates, on worlds that are small enough, and
what a Gaussian makes of the same log.
"""
