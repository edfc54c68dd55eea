"""Logs, recorded and simulated: what a robot did and saw.

Readers of real logs, a file format of our own, robots whose truth we know, and odometry with its
drift and its calibration.
"""
