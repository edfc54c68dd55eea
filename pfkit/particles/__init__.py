"""Beliefs, and who survives: weighted sets of particles.

A belief is a set of poses with weights. These modules hold it, draw it from a prior, weigh it,
decide who has children and when, and read answers off it.
"""
