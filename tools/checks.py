"""Every check of the project, in the order in which they are cheapest to fail.

    make test                                      all of them; stops at the first that fails
    make check                                     what two minutes can tell, while you work
    python tools/run.py test --keep-going          runs the rest as well
    python tools/run.py test --only rooms unit    only these
    python tools/run.py test --list                says what there is
    python tools/run.py lint [--fix]               style and format alone

It ends with a summary: what passed, what failed, what was skipped and why, and how long it took.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from typing import Any, NamedTuple

from environment import ROOT, say

PYTHON = sys.executable
PYTEST = [PYTHON, "-m", "pytest", "-p", "no:cacheprovider"]
TWO_CORES = ["-n", "2", "--dist", "loadfile"]
BOTH: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
MEMORY = ".cache/pytest"  # what failed, so that it can run once more
CODE = [name for name in ("pfkit", "tests", "tools", "book/_ext") if (ROOT / name).exists()]
NBVAL = [
    *["--nbval", "--nbval-current-env", "--nbval-cell-timeout", "60"],
    *["-W", "ignore::DeprecationWarning"],
]


class Stage(NamedTuple):
    """One check: its name, what it shows, the commands that must succeed.

    `again`, if given, runs the files with a failure once more, one after the other; that is for
    browsers, which a busy machine can keep waiting too long. What is broken fails twice.
    """

    name: str
    shows: str
    commands: list[list[str]]
    again: list[str] | None = None


def ruff(fix: bool = False) -> list[list[str]]:
    """Return the style commands, mending or only looking."""
    check, form = (["--fix"], []) if fix else ([], ["--check"])
    return [
        [PYTHON, "-m", "ruff", "check", "--quiet", *check, *CODE],
        [PYTHON, "-m", "ruff", "format", "--quiet", *form, *CODE],
    ]


def unit(*words: str) -> list[str]:
    """Return the command that runs the tests without a stage of their own."""
    apart = ["tests/test_rooms.py", "tests/test_stamps.py", "tests/book", "tests/live"]
    return [*PYTEST, *TWO_CORES, *words, "tests", *(f"--ignore={name}" for name in apart)]


def compared(tool: str) -> list[str]:
    """Return the command with which a tool says whether what it fills in is up to date."""
    return [PYTHON, f"tools/{tool}.py", "--check"]


AGREEING = [compared(tool) for tool in ("prose_numbers", "chapter_numbers", "options")]


def stages(lax: bool = False) -> list[Stage]:
    """List all checks in order; lax: the last digits of stored outputs may differ."""
    nbval = ["--nbval-lax" if word == "--nbval" else word for word in NBVAL] if lax else NBVAL
    memory = [word for word in PYTEST if word not in ("-p", "no:cacheprovider")]
    memory += ["-o", f"cache_dir={MEMORY}", "-rs"]
    browser = [name for name in ("tests/book", "tests/live") if list((ROOT / name).glob("test_*"))]
    notebooks = ["book/index.ipynb", *map(str, sorted((ROOT / "notebooks").rglob("*_*.ipynb")))]
    return [
        Stage("lint", "style and format (ruff)", ruff()),
        Stage("types", "types of pfkit (mypy)", [[PYTHON, "-m", "mypy"]]),
        Stage("rooms", "who may import whom", [[*PYTEST, "tests/test_rooms.py"]]),
        Stage("unit", "unit, property and oracle tests", [unit()]),
        Stage(
            "replays",
            "both error rates of the labs' checks hold",
            [compared("replay")],
        ),
        Stage(
            "stamps",
            "stored outputs are up to date",
            [[*PYTEST, "tests/test_stamps.py"], compared("notebooks"), *AGREEING],
        ),
        Stage(
            "notebooks",
            "executing each notebook gives its stored outputs (nbval, strict)",
            [[*PYTEST, *TWO_CORES, *nbval, *notebooks]],
        ),
        Stage("book", "the book builds without a warning", [[PYTHON, "tools/book.py", "book"]]),
        Stage(
            "pages",
            "every page in a browser, over http and from disk",
            [[*memory, *TWO_CORES, *browser]],
            again=memory,
        ),
    ]


def quick_stages() -> list[Stage]:
    """List what a developer runs between two edits: nothing slow, no browser, two notebooks."""
    quick = [stage for stage in stages() if stage.name in ("lint", "types", "rooms")]
    return [
        *quick,
        Stage("unit", "unit tests that are not slow", [unit("-m", "not slow")]),
        Stage("stamps", "numbers, chapters and options agree", AGREEING),
        Stage(
            "notebooks",
            "at most two stale notebooks executed, the others named",
            [[PYTHON, "tools/notebooks.py", "--most", "2"]],
        ),
    ]


def files_that_failed() -> list[str]:
    """Name the test files in which pytest remembers a failure: tests of a file share a page."""
    memory = ROOT / MEMORY / "v" / "cache" / "lastfailed"
    names = json.loads(memory.read_text(encoding="utf-8")) if memory.exists() else {}
    files = {name.partition("::")[0] for name in names}
    return sorted(name for name in files if (ROOT / name).exists())


def run(stage: Stage, quiet: bool = False) -> tuple[bool, float]:
    """Run one check; return whether it passed and how long it took.

    A quiet one prints one line; what its commands said follows only if it failed.
    """
    if not quiet:
        say(f"{stage.name}: {stage.shows}")
    start = time.monotonic()
    environment = {**os.environ, "MPLBACKEND": "agg", "PYTHONHASHSEED": "0", "PFKIT_WIDGETS": "off"}
    if stage.name == "notebooks":
        environment["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"

    def succeeds(command: list[str]) -> bool:
        if not quiet:
            return subprocess.call(command, cwd=ROOT, env=environment) == 0
        done = subprocess.run(command, cwd=ROOT, env=environment, text=True, **BOTH)
        told.append(done.stdout)
        return done.returncode == 0

    told: list[str] = []
    passed = all(map(succeeds, stage.commands))
    if quiet:
        word, seconds = ("passed" if passed else "FAILED"), time.monotonic() - start
        last = next((t.strip().splitlines()[-1] for t in reversed(told) if t.strip()), "")
        say(f"{stage.name:10s} {word} {seconds:4.0f} s  {last if passed else ''}".rstrip())
        if not passed:
            print("\n".join(told))
    if not passed and stage.again and (files := files_that_failed()):
        say(f"{stage.name}: what failed runs once more, by itself: {', '.join(files)}")
        passed = succeeds([*stage.again, *files])
    return passed, time.monotonic() - start


def run_all(chosen: list[Stage], keep_going: bool) -> bool:
    """Run checks in order, print the summary, and say whether all passed."""
    lines = []
    good = True
    for stage in chosen:
        if not good and not keep_going:
            lines.append(f"  {stage.name:10s} not run")
            continue
        passed, seconds = run(stage)
        good &= passed
        lines.append(f"  {stage.name:10s} {'passed' if passed else 'FAILED'} {seconds:6.0f} s")
    say("summary")
    print("\n".join(lines))
    failed = [line.split()[0] for line in lines if "FAILED" in line]
    if failed:
        say(f"failed: {', '.join(failed)}; again with: make test ARGS='--only {failed[0]}'")
    return good


def main() -> int:
    """Parse the command line and run it."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("command", choices=("test", "lint", "check"))
    parser.add_argument("--fix", action="store_true", help="lint: mend what can be mended")
    parser.add_argument("--keep-going", action="store_true", help="run all stages, fail at the end")
    parser.add_argument("--only", nargs="+", metavar="STAGE", help="run only these stages")
    parser.add_argument("--list", action="store_true", help="list the stages")
    parser.add_argument("--lax", action="store_true", help="other platform: outputs may differ")
    options = parser.parse_args()
    everything = stages(options.lax)
    if options.command == "lint":
        return 0 if run(Stage("lint", "style and format (ruff)", ruff(options.fix)))[0] else 1
    if options.command == "check":
        return 0 if all([run(stage, quiet=True)[0] for stage in quick_stages()]) else 1
    names = [stage.name for stage in everything]
    unknown = set(options.only or []) - set(names)
    if unknown or options.list:
        print("\n".join(f"{stage.name:10s} {stage.shows}" for stage in everything))
        return 2 if unknown else 0
    chosen = [stage for stage in everything if stage.name in (options.only or names)]
    return 0 if run_all(chosen, options.keep_going) else 1


if __name__ == "__main__":
    sys.exit(main())
