"""The particle filter and its relatives: predict, update, resample.

One step, the loop over a log, and what helps when a plain filter fails: fresh particles for a
kidnapped robot, as many particles as the belief needs, a likelihood that is tempered at first.
"""
