"""A progress bar on standard error; a line now and then where that is not a terminal."""

import sys
import time
from typing import TextIO

WIDTH = 24


class Bar:
    """How many of ``total`` are done, and how long the rest will take."""

    def __init__(self, total: int, stream: TextIO | None = None) -> None:
        self._total, self._done, self._stream = total, 0, stream or sys.stderr
        self._began = self._shown = time.monotonic()
        self._live = self._stream.isatty()

    def step(self, told: str) -> None:
        """One more is done."""
        self._done += 1
        now = time.monotonic()
        last = self._done == self._total
        if not self._live and not last and now - self._shown < 10:
            return
        self._shown = now
        left = (now - self._began) / self._done * (self._total - self._done)
        filled = WIDTH * self._done // max(self._total, 1)
        text = f"[{'#' * filled:<{WIDTH}}] {self._done}/{self._total}, {left:.0f} s left: {told}"
        text = f"\r{text[:99]:<99}" if self._live else text + "\n"
        self._stream.write(text + ("\n" if self._live and last else ""))
        self._stream.flush()
