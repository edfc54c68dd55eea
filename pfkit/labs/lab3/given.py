"""What a student is given in lab 3: two films, and a filter to run on them."""

from pfkit.labs.target import anywhere, around, target_log, track

film = target_log("fixed", "low")  # a target that stands still, seen with little noise
line = target_log("line", "high")  # one that moves along a line, seen with much

__all__ = ["anywhere", "around", "film", "line", "target_log", "track"]
