"""Judging: how good is an answer?

Errors, intervals, consistency, studies over many runs. This is the last room of the core, since it
judges what all others make; `localise` runs a whole log from the command line.
"""
