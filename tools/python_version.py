"""Is this Python one of those the lock files were made for?

Every Python since 2.7 can read this module and tools/run.py, which asks it first: a wrong Python
gets a clear line and not a syntax error.
"""

import sys

OLDEST, NEWEST = (3, 11), (3, 13)
THIS = ".".join(str(number) for number in sys.version_info[:2])


def complaint():
    """Return one line that says which Python is needed, or nothing if this one will do."""
    if OLDEST <= sys.version_info[:2] <= NEWEST:
        return ""
    return (
        "Python 3.11, 3.12 or 3.13 is needed, but this is " + THIS + " (" + sys.executable + "). "
        "Install one of them, or name it: make PYTHON=/path/to/python3.11"
    )
