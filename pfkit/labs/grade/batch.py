"""One record per submission: read it, run it under a warden, say what came of it."""

import hashlib
import importlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pfkit
from pfkit.labs.grade import outcome, submission, suspicion, warden
from pfkit.labs.grade.notebook import Pristine, steps
from pfkit.labs.grade.submission import Answers, Malformed
from pfkit.labs.items import Text
from pfkit.labs.lab import Lab

Record = dict[str, Any]
KEPT_FROM_OUTSIDE = ("PATH", "LANG", "LC_ALL", "LD_LIBRARY_PATH", "SYSTEMROOT", "VIRTUAL_ENV")


class CannotGrade(RuntimeError):
    """Even the unanswered notebook does not run: the fault is ours, not a student's."""


@dataclass(frozen=True)
class Limits:
    """What one submission may use: seconds per cell, seconds in all, bytes of memory."""

    cell_timeout: float = 60.0
    wall: float = 300.0
    memory: int = 4_000_000_000


def version_of(lab: Lab) -> str:
    """Package and questions: rows of one version may be compared."""
    told = ",".join(i.version for i in lab.items.values())
    return f"{pfkit.__version__}+{lab.name}.{hashlib.sha256(told.encode()).hexdigest()[:8]}"


class Batch:
    """Grades files of one folder, some at a time, and leaves nothing behind.

    Use it as a context manager: leaving it ends what still runs and removes the folders.
    """

    def __init__(self, pristine: Pristine, folder: Path, limits: Limits) -> None:
        self.pristine, self.folder, self.limits = pristine, folder, limits
        self._module = importlib.import_module(f"pfkit.labs.{pristine.lab.name}")
        self._lock, self._stopped = threading.Lock(), False
        self._wardens: set[subprocess.Popen[bytes]] = set()
        self._pool: ThreadPoolExecutor | None = None
        self.version = version_of(pristine.lab)

    def __enter__(self) -> "Batch":
        self._room = Path(tempfile.mkdtemp(prefix="pfkit-grade-"))
        warden.adopt_orphans()  # of a warden that an answer managed to kill
        self._not_ours = frozenset(warden.descendants(os.getpid()))
        return self

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._stopped = True
            for running in self._wardens:
                running.stdin.close()  # type: ignore[union-attr]
        if self._pool:
            self._pool.shutdown(wait=True, cancel_futures=True)
        remove(self._room)

    def rehearse(self) -> float:
        """Run the unanswered notebook; returns seconds, raises CannotGrade if it fails."""
        began = time.monotonic()
        found = self._run(Answers(sources=dict(self.pristine.stubs)))
        checked = {e["item"]: e["status"] for e in found["events"] if e.get("status")}
        unlike = {i: s for i, s in checked.items() if s not in ("unanswered", "locked")}
        unlike |= {i: "not reached" for i in self.pristine.lab.items if i not in checked}
        if unlike or found["timeouts"]:
            why = next((e["broken"] for e in found["events"] if "broken" in e), "")
            why = why or found["stderr"] or str(unlike)
            raise CannotGrade(f"the unanswered {self.pristine.path.name} does not run: {why[:300]}")
        return time.monotonic() - began

    def grade(self, files: list[Path], jobs: int) -> Iterator[Record]:
        """Yield records as they are done."""
        self._pool = ThreadPoolExecutor(jobs)
        for done in as_completed([self._pool.submit(self._one, file) for file in files]):
            yield done.result()

    def _one(self, path: Path) -> Record:
        began = time.monotonic()
        record = self._blank(path)
        try:
            record |= self._judged(path)
        except Malformed as error:
            record |= {"status": "malformed", "detail": str(error)}
        except Exception as error:  # one row each: a fault of ours must not stop the batch
            told = f"the grader itself failed, {type(error).__name__}: {error}"
            record |= {"status": "crashed", "detail": told[:300]}
        return record | {"seconds": round(time.monotonic() - began, 1)}

    def _judged(self, path: Path) -> Record:
        lab, stubs, variables = self.pristine.lab, self.pristine.stubs, self.pristine.variables
        answers = submission.read(path, lab, stubs, variables)
        for item, source in answers.sources.items():
            answers.doubts += suspicion.doubts(item, source, lab, self._module)
        found = self._run(answers)
        return outcome.judge(lab, answers, found, self.limits.cell_timeout, self.limits.wall)

    def _blank(self, path: Path) -> Record:
        lab = self.pristine.lab
        name = path.relative_to(self.folder)
        return {
            "student": student(name, lab.name),
            "file": name.as_posix(),
            "status": "",
            "score": None,
            "max": sum(i.points for i in lab.items.values() if not isinstance(i, Text)),
            "items": {},
            "texts": {},
            "ticked": {},
            "world": "",
            "detail": "",
            "seconds": 0.0,
            "version": self.version,
            "sha256": submission.fingerprint(path),
        }

    # -- one run -----------------------------------------------------------------------------

    def _run(self, answers: Answers) -> dict[str, Any]:
        folder = Path(tempfile.mkdtemp(dir=self._room))
        job = {
            "lab": self.pristine.lab.name,
            "steps": steps(self.pristine, answers),
            "variables": self.pristine.variables,
            "student": answers.student,
            "memory": self.limits.memory,
            "wall": self.limits.wall,
        }
        (folder / "job.json").write_text(json.dumps(job), encoding="utf-8")
        try:
            return self._under_warden(folder)
        finally:
            remove(folder)

    def _under_warden(self, folder: Path) -> dict[str, Any]:
        lost = {"events": [], "timeouts": [], "strange": 0, "left": 0, "exit": None, "stderr": ""}
        command = [sys.executable, "-I", warden.__file__, str(folder)]
        command += [str(self.limits.cell_timeout), str(self.limits.wall)]
        with self._lock:
            if self._stopped:
                return lost
            running = subprocess.Popen(
                command, env=self._environment(folder), start_new_session=True,
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
            )  # fmt: skip
            self._wardens.add(running)
        last_resort = threading.Timer(self.limits.wall + 30, running.kill)
        last_resort.daemon = True
        last_resort.start()
        assert running.stdout and running.stdin
        told = running.stdout.read()
        running.wait()
        last_resort.cancel()
        with self._lock:
            self._wardens.discard(running)
            running.stdout.close()
            running.stdin.close()
            if not told:
                self._sweep()
        return json.loads(told) if told else lost

    def _sweep(self) -> None:
        """A warden was killed: end what it watched, and spare what the others watch."""
        alive = {w.pid for w in self._wardens}
        spare = alive.union(*(warden.descendants(pid) for pid in alive)) | self._not_ours
        warden.kill_all(os.getpid(), frozenset(spare))

    def _environment(self, folder: Path) -> dict[str, str]:
        """Little of ours: no tokens, no home folder, one thread per submission."""
        package = str(Path(pfkit.__file__).parents[1])
        paths = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
        threads = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
        return {
            **{k: os.environ[k] for k in KEPT_FROM_OUTSIDE if k in os.environ},
            **dict.fromkeys(threads, "1"),
            **dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP"), str(folder)),
            "PYTHONPATH": os.pathsep.join([package, *paths]),
            "PYTHONDONTWRITEBYTECODE": "1",
            "PYTHONHASHSEED": "0",
            "MPLBACKEND": "Agg",
            "MPLCONFIGDIR": str(self._room / "matplotlib"),
            "PFKIT_WIDGETS": "off",
        }


def student(name: Path, lab: str) -> str:
    """``ann.ipynb`` and ``ann/lab3_final.ipynb`` are ann's; other folders stay in the name."""
    stem, lab = (re.sub(r"^\d+|[\W_]+", "", words.lower()) for words in (name.stem, lab))
    same = len(name.parts) > 1 and stem.startswith(lab)
    return (name.parent if same else name.with_suffix("")).as_posix()


def remove(folder: Path) -> None:
    """Delete a folder, even if an answer took away the right to do so."""

    def retry(function: Any, path: str, _: object) -> None:
        os.chmod(os.path.dirname(path), 0o700)
        if os.path.isdir(path) and not os.path.islink(path):
            os.chmod(path, 0o700)
            shutil.rmtree(path, ignore_errors=True)
        else:
            function(path)

    shutil.rmtree(folder, onerror=retry)
