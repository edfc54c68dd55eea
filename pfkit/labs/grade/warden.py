"""Watches one submission from outside: how long each cell takes, and that nothing is left.

    python warden.py RUNNER_FOLDER CELL_TIMEOUT WALL   (the job lies in the folder, as job.json)

The grader starts one warden per submission and holds its standard input open: if the grader dies,
the warden stops too. On Linux the warden adopts whatever its runner leaves behind (child
subreaper), so that a process which forked twice and made its own session is found all the same.
Standard library only, and no import of pfkit: it must start fast.
"""

import contextlib
import ctypes
import json
import os
import queue
import secrets
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any, BinaryIO

START = 60.0  # seconds that imports may take on a busy machine
GRACE = 3.0  # seconds between the interrupt and the kill
MOST_OUTPUT = 4_000_000  # bytes of events
SET_CHILD_SUBREAPER = 36


def adopt_orphans() -> bool:
    """Become the parent of all descendants that lose theirs (Linux)."""
    if sys.platform != "linux":
        return False
    return ctypes.CDLL(None).prctl(SET_CHILD_SUBREAPER, 1, 0, 0, 0) == 0


def descendants(of: int, dead: bool = True) -> list[int]:
    """Process ids below a process, from /proc (none without it); ``dead``: also the unreaped."""
    parents: dict[int, list[int]] = {}
    zombies = set[int]()
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError, ValueError, IndexError):
            # the name, in brackets, may hold spaces: count from behind the last bracket
            fields = (entry / "stat").read_text(errors="replace").rpartition(")")[2].split()
            parents.setdefault(int(fields[1]), []).append(int(entry.name))
            if fields[0] in "ZX":
                zombies.add(int(entry.name))
    found, todo = [], [of]
    while todo:
        children = parents.get(todo.pop(), [])
        found += children
        todo += children
    return [p for p in found if dead or p not in zombies]


def kill_all(of: int, spare: frozenset[int] = frozenset()) -> int:
    """Kill and reap every descendant, until there is none; returns how many."""
    killed = set[int]()
    for _ in range(200):
        alive = [p for p in descendants(of) if p not in spare]
        for pid in alive:  # first stop all, so that none can fork meanwhile
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGSTOP)
        for pid in alive:
            with contextlib.suppress(OSError):
                os.kill(pid, signal.SIGKILL)
        killed |= set(alive)
        for pid in alive:
            with contextlib.suppress(OSError):
                os.waitpid(pid, os.WNOHANG)
        if not alive:
            break
        time.sleep(0.01)
    return len(killed)


class Watch:
    """One runner and its events."""

    def __init__(self, folder: str, cell_timeout: float, wall: float) -> None:
        self._cell_timeout, self._end = cell_timeout, time.monotonic() + wall
        self._token = secrets.token_hex(16)
        self._lines: queue.Queue[bytes | None] = queue.Queue(maxsize=10_000)
        self.events: list[dict[str, Any]] = []
        self.timeouts: list[str] = []
        self.strange = 0
        self._orphaned = threading.Event()
        self._runner = subprocess.Popen(
            [sys.executable, "-P", "-m", "pfkit.labs.grade.runner", "job.json"],
            cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.PIPE, start_new_session=True,
        )  # fmt: skip
        assert self._runner.stdin and self._runner.stdout
        with contextlib.suppress(OSError):
            self._runner.stdin.write(self._token.encode() + b"\n")
            self._runner.stdin.close()
        threading.Thread(target=self._read, args=(self._runner.stdout,), daemon=True).start()
        threading.Thread(target=self._wait_for_grader, daemon=True).start()

    def _read(self, stream: BinaryIO) -> None:
        total = 0
        while total < MOST_OUTPUT and (line := stream.readline(100_000)):
            total += len(line)
            self._lines.put(line)
        self._lines.put(None)

    def _wait_for_grader(self) -> None:
        sys.stdin.buffer.read()
        self._orphaned.set()

    def run(self) -> dict[str, Any]:
        """Follow the runner to its end, or end it."""
        began, item, interrupted, ended = time.monotonic(), "", False, False
        limit = max(START, self._cell_timeout)
        while not ended and not self._orphaned.is_set():
            now = time.monotonic()
            if now > self._end:
                self.timeouts.append("all")
                break
            late = now - began - limit
            if late > 0 and not interrupted:
                self.timeouts.append(item)
                interrupted = True
                self._interrupt()
            if late > GRACE:
                break
            with contextlib.suppress(queue.Empty):
                line = self._lines.get(timeout=0.05)
                event = self._event(line)
                ended = line is None or bool(event.get("end"))
                if "begin" in event:
                    began, item, interrupted = time.monotonic(), event["begin"], False
                    limit = self._cell_timeout
            if self._runner.poll() is not None and self._lines.empty():
                time.sleep(0.05)  # the reader may hold a last line
                ended = ended or self._lines.empty()
        return self._stop()

    def _event(self, line: bytes | None) -> dict[str, Any]:
        token, _, text = (line or b"").partition(b" ")
        if token.decode("latin-1") != self._token:
            self.strange += line is not None
            return {}
        event: dict[str, Any] = json.loads(text)
        self.events.append(event)
        return event

    def _interrupt(self) -> None:
        if sys.platform != "win32":
            self._runner.send_signal(signal.SIGINT)

    def _stop(self) -> dict[str, Any]:
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._runner.wait(0 if self.timeouts else 3)
        code = self._runner.poll()
        left = len(descendants(os.getpid(), dead=False)) - (code is None)
        if hasattr(os, "killpg"):
            with contextlib.suppress(OSError):
                os.killpg(self._runner.pid, signal.SIGKILL)
        elif code is None:
            subprocess.run(["taskkill", "/T", "/F", "/PID", str(self._runner.pid)], check=False)
        kill_all(os.getpid())
        self._runner.wait()
        assert self._runner.stderr  # closed by the runner once it runs: holds its first words only
        told = self._runner.stderr.read(100_000).decode(errors="replace").strip().splitlines()
        return {
            "stderr": told[-1] if told else "",
            "events": self.events,
            "timeouts": self.timeouts,
            "strange": self.strange,
            "left": left,
            "exit": code,
        }


def main(folder: str, cell_timeout: str, wall: str) -> None:
    adopt_orphans()
    result = Watch(folder, float(cell_timeout), float(wall)).run()
    sys.stdout.write(json.dumps(result))
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main(*sys.argv[1:])
