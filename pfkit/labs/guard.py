"""Run a student's code so that nothing it does can end the lesson.

A check calls functions that students wrote an hour ago. They raise, recurse without end, print a
megabyte, call ``sys.exit`` or never return. `guarded` turns each of these into a short sentence.

Afterwards the working folder, NumPy's and Python's global generators, warnings and the printed
stream are what they were before.

It is a seat belt, not a sandbox: code that kills the process, or writes a file, does so, and one
endless operation inside C (``10**10**10``) hears no alarm: restart the kernel.
"""

import contextlib
import io
import os
import random
import signal
import sys
import threading
import traceback
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from types import FrameType
from typing import Any

import numpy as np

PRINT_LIMIT = 2_000  # characters of a student's output that we keep
TIME_LIMIT = 10.0  # seconds of computing, where the platform has an alarm clock
PAGE_LIMIT = 30  # seconds of a cell in a page, which has none: there its Python is ended
PATIENCE = 6.0  # the wall clock may show so many times more: machines are busy, code may sleep


class TooSlow(BaseException):
    """The alarm rang. Not an `Exception`, so that ``except Exception`` does not swallow it."""


class Capped(io.TextIOBase):
    """A text stream that keeps the first characters and counts the rest."""

    def __init__(self, limit: int) -> None:
        self.kept: list[str] = []
        self.room, self.dropped = limit, 0

    def writable(self) -> bool:
        return True

    def write(self, text: str) -> int:
        head = text[: self.room]
        self.kept.append(head)
        self.room -= len(head)
        self.dropped += len(text) - len(head)
        return len(text)

    def getvalue(self) -> str:
        more = f"\n[{self.dropped} more characters]" if self.dropped else ""
        return "".join(self.kept) + more


@contextlib.contextmanager
def _alarm(seconds: float) -> Iterator[None]:
    """Raise `TooSlow` after some seconds; does nothing off the main thread or off Unix.

    Two clocks: computing time, so that a busy machine does not fail a right answer, and, later,
    wall time, so that code which only waits is stopped as well.
    """
    can = hasattr(signal, "setitimer") and threading.current_thread() is threading.main_thread()
    if not can:
        yield
        return

    def ring(*_: object) -> None:
        raise TooSlow

    clocks = (
        (signal.SIGPROF, signal.ITIMER_PROF, seconds),
        (signal.SIGALRM, signal.ITIMER_REAL, seconds * PATIENCE),
    )
    before = [signal.signal(number, ring) for number, _, _ in clocks]
    for _, timer, limit in clocks:
        signal.setitimer(timer, limit, 0.5)  # rings again if a bare except ate it
    try:
        yield
    finally:
        for (number, timer, _), handler in zip(clocks, before, strict=True):
            signal.setitimer(timer, 0)
            signal.signal(number, handler)


@contextlib.contextmanager
def hushed(limit: int = PRINT_LIMIT) -> Iterator[Capped]:
    """Catch what is printed, and silence warnings of Python and NumPy."""
    stream = Capped(limit)
    with (
        contextlib.redirect_stdout(stream),
        contextlib.redirect_stderr(stream),
        warnings.catch_warnings(),
        np.errstate(all="ignore"),
    ):
        warnings.simplefilter("ignore")
        yield stream


@contextlib.contextmanager
def _as_before() -> Iterator[None]:
    """Put back what a student's code may have changed for everybody after it."""
    depth, state = sys.getrecursionlimit(), random.getstate()
    numpy_state = np.random.get_state()  # noqa: NPY002  students use the global generator
    folder = ""
    with contextlib.suppress(OSError):
        folder = os.getcwd()
    try:
        yield
    finally:
        sys.setrecursionlimit(depth)
        random.setstate(state)
        np.random.set_state(numpy_state)  # noqa: NPY002
        with contextlib.suppress(OSError):  # a folder that is gone
            os.chdir(folder)


@contextlib.contextmanager
def _listening() -> Iterator[list[int]]:
    """Note whether a person pressed interrupt, to tell it from ``raise KeyboardInterrupt``."""
    heard: list[int] = []
    before = signal.getsignal(signal.SIGINT)
    if not callable(before) or threading.current_thread() is not threading.main_thread():
        yield heard
        return

    def ring(number: int, frame: FrameType | None) -> None:
        heard.append(number)
        before(number, frame)

    signal.signal(signal.SIGINT, ring)
    try:
        yield heard
    finally:
        if signal.getsignal(signal.SIGINT) is ring:
            signal.signal(signal.SIGINT, before)


@dataclass(frozen=True)
class Ran:
    """What came of a call: a value, or an error in words, and what was printed."""

    value: Any = None
    error: str = ""
    printed: str = ""


def describe(error: BaseException) -> str:
    """One line about an exception: its type, its message, the line of the student's code."""
    if isinstance(error, TooSlow):
        return f"stopped, it took longer than {TIME_LIMIT:.0f} s: does a loop never end?"
    if isinstance(error, RecursionError):
        return "it calls itself without end (RecursionError)" + _where(error)
    if isinstance(error, MemoryError):
        return "it asks for more memory than there is (MemoryError)" + _where(error)
    if isinstance(error, ValueError) and (words := _of_numpy(error)):
        return words + _where(error)
    try:
        message = " ".join(str(error).split())[:200]
    except BaseException:
        message = "(its message cannot be printed)"
    return f"{type(error).__name__}: {message}".rstrip(": ") + _where(error)


def _of_numpy(error: ValueError) -> str:
    """Messages of NumPy that beginners meet daily, in plainer words; "" for others."""
    told = error.args[0] if error.args and isinstance(error.args[0], str) else ""
    if "inhomogeneous" in told:
        return "parts of its result differ in length, so they form no array"
    if told.startswith(("array is too big", "Maximum allowed dimension")):
        return "its array needs more memory than there is"
    if told.startswith("The truth value of an array"):
        return "an array stands where one True or False is needed"
    return ""


def _where(error: BaseException) -> str:
    """``, line 3 of your function f``: the last frame that is not a file of a library."""
    theirs = None
    for frame in traceback.extract_tb(error.__traceback__):
        if "<ipython-input" in frame.filename or "ipykernel_" in frame.filename:
            theirs = frame
    if theirs is None:
        return ""
    inside = "" if theirs.name == "<module>" else f", in {theirs.name}"
    return f" (line {theirs.lineno} of the cell{inside})"


def guarded(call: Callable[[], Any], seconds: float = TIME_LIMIT) -> Ran:
    """Run ``call()``; whatever happens, come back with a `Ran`, unless a person interrupts."""
    with _as_before(), hushed() as stream, _listening() as interrupted:
        try:
            with _alarm(seconds):
                value = call()
            return Ran(value, "", stream.getvalue())
        except BaseException as error:
            if interrupted and isinstance(error, KeyboardInterrupt):
                raise
            return Ran(None, describe(error), stream.getvalue())
