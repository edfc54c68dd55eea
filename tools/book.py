"""Build the book and serve it; called by tools/run.py in the project's environment.

The build is skipped when nothing it reads has changed since the last good one. Sphinx's log goes to
.cache/book.log; only warnings and errors are shown, and any warning fails the build.
"""

from __future__ import annotations

import argparse
import functools
import hashlib
import http.server
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import npm_packages
from environment import ROOT, SCRIPTS, Stop, say

HTML = ROOT / "_build" / "html"
LOG = ROOT / ".cache" / "book.log"
BUILD = [str(SCRIPTS / "jupyter-book"), "build", ".", "-W", "--keep-going", "--all"]
INPUTS = ("book", "notebooks", "pfkit", "data", "tools", "CHANGELOG.md", "_config.yml", "_toc.yml")


def fingerprint() -> str:
    """Hash all files the build reads, and the lock file that fixes the builder."""
    digest = hashlib.sha256()
    names = (*INPUTS, "requirements-book.lock", "pyproject.toml", ".cache/live/site.stamp")
    for top in (ROOT / name for name in names):
        files = sorted(top.rglob("*")) if top.is_dir() else [top]
        for path in files:
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(path.relative_to(ROOT).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()


def build_live_parts() -> None:
    """Build what makes pages compute; if that fails, the book does without."""
    script = ROOT / "tools" / "live" / "build.py"
    if script.exists() and subprocess.call([sys.executable, str(script)], cwd=ROOT):
        say("the live parts could not be built: the pages will show their recorded pictures only")


def build() -> None:
    """Build the book unless the last good build was made from the same files."""
    stamp = ROOT / ".cache" / "book.stamp"
    npm_packages.fetched()
    build_live_parts()
    made_from = fingerprint()
    if HTML.exists() and stamp.exists() and stamp.read_text() == made_from:
        say("the book is up to date")
        return
    say("building the book (every warning is an error)")
    shutil.rmtree(ROOT / "_build", ignore_errors=True)  # pages that are no more would stay
    start = time.monotonic()
    done = subprocess.run(BUILD, cwd=ROOT, capture_output=True, text=True, encoding="utf-8")
    LOG.write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode:
        print(explain(done.stdout + done.stderr))
        raise Stop(f"the book has warnings or errors (above; all of it in {LOG.name} in .cache)")
    stamp.write_text(made_from)
    say(f"built in {time.monotonic() - start:.0f} s")


def explain(log: str) -> str:
    """Pick the warnings and errors out of Sphinx's log, each once."""
    telling = re.compile(r"WARNING|ERROR|^\w*(?:Error|Exception): .")
    lines = [line for line in log.splitlines() if telling.search(line)]
    return "\n".join(dict.fromkeys(lines)) or "\n".join(log.splitlines()[-15:])


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *args: object) -> None:
        """Keep the terminal free: requests are not news."""


def serve(port: int) -> None:
    """Serve the built book on this machine until interrupted."""
    handler = functools.partial(_Quiet, directory=str(HTML))
    try:
        server = http.server.ThreadingHTTPServer(("127.0.0.1", port), handler)
    except OSError as error:
        raise Stop(f"port {port} is taken ({error}); try --port {port + 1}") from error
    say(f"serving the book at http://127.0.0.1:{server.server_port}/  (Ctrl+C stops)")
    server.serve_forever()


def main() -> None:
    """Parse the command and run it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("command", choices=("book", "serve"))
    parser.add_argument("--port", type=int, default=8000)
    options = parser.parse_args()
    build()
    if options.command == "serve":
        serve(options.port)
    else:
        index = Path("_build/html/index.html")
        say(f"open {index} in a browser, or run: make serve")


if __name__ == "__main__":
    try:
        main()
    except Stop as reason:
        sys.exit(f"[course] stopped: {reason}")
    except KeyboardInterrupt:
        sys.exit(1)  # tools/run.py says so
