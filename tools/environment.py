"""The project's virtual environment: made once, renewed when what it is made from changes.

`prepare("book")` installs what the book needs, `prepare("all")` everything that the tests and
Jupyter need as well. A stamp inside the environment remembers the hash of what it was made from, so
that the second call returns at once. Only the standard library is used here.

    python tools/environment.py book|all|lock
"""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
import sysconfig
import tomllib
import venv
from pathlib import Path

from python_version import THIS, complaint

ROOT = Path(__file__).resolve().parent.parent
VENV = ROOT / ".venv"
PYTHON = VENV / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
SCRIPTS = Path(sysconfig.get_path("scripts"))  # of the Python that runs this, .venv's or another
LOCKS = {"book": ROOT / "requirements-book.lock", "all": ROOT / "requirements.lock"}


class Stop(Exception):
    """A reason to stop, in one line a newcomer can act on."""


def say(text: str) -> None:
    """Print one line of progress at once."""
    print("[course] " + text, flush=True)


def require_python() -> None:
    """Stop unless this Python is one of those the lock file was made for."""
    if complaint():
        raise Stop(complaint())


def fingerprint(kind: str) -> str:
    """Hash what an environment is made from: Python, lock file, what pip reads of the project."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    tools = project.get("tool", {}).get("setuptools", {})
    read_by_pip = [project["project"], project["build-system"], tools]
    digest = hashlib.sha256(THIS.encode() + json.dumps(read_by_pip, sort_keys=True).encode())
    digest.update(LOCKS[kind].read_bytes().replace(b"\r\n", b"\n"))
    return digest.hexdigest()


def is_ready(kind: str) -> bool:
    """Say whether the environment already holds `kind` (everything includes the book)."""
    for name in ("all",) if kind == "all" else ("all", "book"):
        stamp = VENV / ("stamp-" + name)
        if PYTHON.exists() and stamp.exists() and stamp.read_text() == fingerprint(name):
            return True
    return False


def _pip(*arguments: str) -> None:
    """Run pip in the environment; turn its last error line into ours."""
    command = [str(PYTHON), "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    command += ["--progress-bar", "off", *arguments]
    done = subprocess.run(command, cwd=str(ROOT), stderr=subprocess.PIPE, text=True)
    if done.returncode:
        errors = [line for line in done.stderr.splitlines() if line.startswith("ERROR")]
        reason = (errors or done.stderr.splitlines() or ["no message"])[0]
        hint = "Is there a network? " if "from versions: none" in done.stderr else ""
        if "NewConnectionError" in done.stderr or "ConnectionError" in done.stderr:
            hint = "Is there a network? "
        raise Stop("packages could not be installed. " + hint + "pip said: " + reason)


def prepare(kind: str) -> None:
    """Make sure that .venv exists and holds the locked packages and pfkit itself."""
    require_python()
    if is_ready(kind):
        return
    if not PYTHON.exists():
        say(f"creating the environment .venv with Python {THIS}")
        try:
            venv.create(str(VENV), with_pip=True)
        except (OSError, subprocess.CalledProcessError) as error:
            raise Stop(
                f"the environment .venv could not be created ({error}). "
                "On Debian and Ubuntu: apt install python3-venv"
            ) from error
    lock = LOCKS[kind]
    say(f"installing the packages pinned in {lock.name} (once; a minute or two)")
    _pip("--no-compile", "--no-deps", "--requirement", str(lock))
    _pip("--no-compile", "--no-deps", "--no-build-isolation", "--editable", str(ROOT))
    (VENV / ("stamp-" + kind)).write_text(fingerprint(kind))


def lock() -> None:
    """Resolve requirements.txt and the book extra for Python 3.11 to 3.13 on every platform."""
    prepare("all")
    say("installing uv, the resolver")
    _pip("uv")
    uv = [str(PYTHON), "-m", "uv", "pip", "compile", "--quiet", "--universal", "--no-header"]
    uv += ["--python-version", "3.11", "--fork-strategy", "fewest"]
    everything, book = str(LOCKS["all"].name), str(LOCKS["book"].name)
    for command in (
        [*uv, "--upgrade", "requirements.txt", "--output-file", everything],
        [*uv, "--extra", "book", "pyproject.toml", "-c", everything, "--output-file", book],
    ):
        if subprocess.run(command, cwd=str(ROOT), stdout=subprocess.DEVNULL).returncode:
            raise Stop("uv could not resolve the requirements; its reason is above")
    say(f"wrote {everything} and {book}")


if __name__ == "__main__":
    what = sys.argv[1] if len(sys.argv) == 2 else ""
    if what not in ("book", "all", "lock"):
        sys.exit(__doc__)
    try:
        lock() if what == "lock" else prepare(what)
    except Stop as reason:
        sys.exit(f"[course] stopped: {reason}")
