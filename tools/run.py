"""Every command of the project; `make book` is short for `python tools/run.py book`, and so on.

    book        install what is needed, build the book into _build/html, say how to open it
    serve       build, then serve the book on this machine:  serve [--port 8000]
    test        run every check in order:  test [--keep-going] [--only STAGE ...] [--list]
    check       what two minutes can tell, while you work
    lint        style and format of the code (ruff); lint --fix mends what it can
    notebooks   execute the notebooks whose code, package or data changed:  notebooks [FILE ...]
    numbers     compare the numbers in the prose with the cells:  numbers [--fill] [FILE ...]
    chapters    compare the numbers of chapters with their files:  chapters [--fill]
    options     compare the options in the text with the labs:  options [--fill] [FILE ...]
    replay      how sure is each check of the labs? measure what changed:  replay [--all]
    clean       remove what was built; clean --all also removes the environment and the caches

The first call makes the environment .venv; nothing outside this folder is touched.
"""

import os
import shutil
import subprocess
import sys

from python_version import complaint

if complaint():  # asked before anything is imported that an old Python cannot read
    sys.exit("[course] stopped: " + complaint())

from environment import PYTHON, ROOT, Stop, prepare, say

# command: the environment it needs, the tool that does it, what to tell the tool first
COMMANDS = {
    "book": ("book", "book", ["book"]),
    "serve": ("book", "book", ["serve"]),
    "test": ("all", "checks", ["test"]),
    "check": ("all", "checks", ["check"]),
    "lint": ("all", "checks", ["lint"]),
    "notebooks": ("all", "notebooks", []),
    "numbers": ("all", "prose_numbers", []),
    "chapters": ("all", "chapter_numbers", []),
    "options": ("all", "options", []),
    "replay": ("all", "replay", []),
}


def clean(*flags):
    """Remove built files; with --all the environment and the caches too."""
    names = ["_build", ".pytest_cache", ".ruff_cache", ".mypy_cache", ".hypothesis"]
    names += [".venv", ".cache"] if "--all" in flags else []
    for name in names:
        if (ROOT / name).exists():
            say("removing " + name)
            shutil.rmtree(ROOT / name)


def main(arguments):
    """Prepare the environment, then hand the command to the tool that does it."""
    command, rest = (arguments or ["help"])[0], arguments[1:]
    if command == "clean":
        clean(*rest)
        return 0
    if command not in COMMANDS:
        print(__doc__)
        return 0 if command in ("help", "-h", "--help") else 2
    kind, tool, first = COMMANDS[command]
    prepare(kind)
    script = [str(PYTHON), str(ROOT / "tools" / (tool + ".py"))]
    script.extend(first + rest)
    path = str(PYTHON.parent) + os.pathsep + os.environ.get("PATH", "")
    return subprocess.call(script, cwd=str(ROOT), env=dict(os.environ, PATH=path))


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Stop as reason:
        sys.exit("[course] stopped: " + str(reason))
    except KeyboardInterrupt:
        sys.exit("[course] interrupted")
